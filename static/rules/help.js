/** The keys, in a window over the page, and where more is written. */

import { dialog } from "../common/dialog.js";
import { h, identify } from "../common/dom.js";

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

const GUIDE = [
  ["scenarios", "Scenario files"],
  ["terms", "All terms"],
  ["own-terms", "Own terms"],
  ["missions", "Missions"],
  ["automode", "AutoMoDe"],
  ["commands", "Commands"],
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
    const pages = GUIDE.flatMap(([name, title]) => [
      " · ",
      h("a", { href: `../guide/${name}.html${location.search}`, target: "_blank" }, title),
    ]);
    this.node.append(h("dl", { class: "keys" }, ...rows), h("p", { class: "guide" }, "Guide", ...pages));
    this.button = h("button", { type: "button", class: "quiet key", title: "Keys (?)" }, "?");
    this.button.addEventListener("click", () => this.open());
    identify(this.button, "help", "Show the keys");
  }

  open() {
    if (!this.node.open) this.node.showModal();
  }
}
