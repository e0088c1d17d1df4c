/** The rules made simpler, in a window over the page. */

import { dialog } from "../common/dialog.js";
import { h, identify } from "../common/dom.js";
import { request } from "./protocol.js";

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
      this.#asked = session.command(request.simplify());
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
    if (this.session.command(request.takeSimplified(version))) this.node.close();
  }
}
