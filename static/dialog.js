/** Windows over the page: the keys, and the rules made simpler. */

import { h, iconButton, identify } from "./dom.js";

/** An empty dialog with a title and a button to close it; Esc closes it as well. */
function dialog(testid, title) {
  const close = iconButton("remove", "Close", () => node.close());
  const head = h("div", { class: "dialog-head" }, h("h2", {}, title), close);
  const node = h("dialog", { class: "dialog" }, head);
  identify(node, testid, title);
  node.addEventListener("click", (event) => event.target === node && node.close());
  document.body.append(node);
  return node;
}

const KEYS = [
  ["↑ ↓ ← →", "Go from cell to cell"],
  ["Home, End", "First and last cell of the row; with Ctrl of the table"],
  ["Enter", "Edit the cell or open its menu"],
  ["Esc", "Take back what was typed, leave the cell"],
  ["Delete", "Remove the element, or the rule if its heading has the focus"],
  ["Alt ↑, Alt ↓", "Move the rule"],
  ["Ctrl D", "Duplicate the rule"],
  ["Ctrl C, Ctrl X, Ctrl V", "Copy, cut and paste rules, also between windows"],
  ["Ctrl Z, Ctrl Shift Z", "Undo, redo"],
  ["Ctrl S", "Save as a file"],
  ["Ctrl Enter", "Apply the text (Text tab)"],
  ["P, O, X", "Arena: play, pause, step"],
  ["F, R", "Arena: fast-forward, reset"],
  ["?", "Show these keys"],
];

export class Help {
  constructor() {
    this.node = dialog("help-keys", "Keys");
    const rows = KEYS.flatMap(([keys, does]) => {
      const caps = keys.split(", ").flatMap((combination, i) => [
        ...(i ? [" "] : []),
        h("span", { class: "combination" }, ...combination.split(" ").map((key) => h("kbd", {}, key))),
      ]);
      return [h("dt", {}, ...caps), h("dd", {}, does)];
    });
    this.node.append(h("dl", { class: "keys" }, ...rows));
    this.button = h("button", { type: "button", class: "quiet key", title: "Keys (?)" }, "?");
    this.button.addEventListener("click", () => this.open());
    identify(this.button, "help", "Show the keys");
  }

  open() {
    if (!this.node.open) this.node.showModal();
  }
}

/** The shortest rules with exactly the same behaviour, shown before they are taken. */
export class Simplify {
  #asked = false;
  /** @type {?import("./protocol.js").SimplifiedMessage} */
  #offer = null;

  /** @param {import("./session.js").Session} session */
  constructor(session) {
    this.session = session;
    this.button = h("button", { type: "button", class: "quiet", hidden: true });
    this.button.addEventListener("click", () => {
      this.#asked = session.command({ type: "simplify" });
    });
    this.node = dialog("simplified", "Simpler, with exactly the same behaviour");
    this.removed = h("ul", { class: "removed", "data-testid": "simplified-removed" });
    this.text = h("pre", { class: "rule-text", tabindex: 0, "data-testid": "simplified-text" });
    this.late = h("p", { class: "late", role: "status" }, "The rules have changed meanwhile: ask again.");
    const choice = (id, label, act) => {
      const button = h("button", { type: "button", class: "button", "data-testid": id }, label);
      button.addEventListener("click", act);
      return button;
    };
    this.take = choice("take-simplified", "Take", () => this.#take());
    this.take.classList.add("first");
    const leave = choice("leave-simplified", "Leave as it is", () => this.node.close());
    const heading = (words) => h("h3", {}, words);
    this.node.append(heading("Can go"), this.removed, heading("What remains"), this.text);
    this.node.append(this.late, h("div", { class: "dialog-foot" }, leave, this.take));
  }

  /** @param {import("./protocol.js").RulesMessage} message */
  rulesChanged({ simpler = 0 }) {
    this.button.hidden = simpler === 0;
    this.button.textContent = `Simplify (−${simpler})`;
    const label = `Simplify: ${simpler} elements can go without changing the behaviour`;
    this.button.title = label;
    identify(this.button, "simplify", label);
    this.#fresh();
  }

  /** @param {import("./protocol.js").SimplifiedMessage} message */
  offer(message) {
    if (!this.#asked) return;
    this.#asked = false;
    this.#offer = message;
    this.removed.replaceChildren(...message.removed.map((words) => h("li", {}, words)));
    this.text.textContent = message.text;
    this.#fresh();
    this.node.showModal();
    this.take.focus();
  }

  #fresh() {
    const late = this.#offer !== null && this.#offer.version !== this.session.state?.version;
    this.late.hidden = !late;
    this.take.disabled = late;
  }

  #take() {
    const { version } = this.#offer;
    if (this.session.command({ type: "take_simplified", version })) this.node.close();
  }
}
