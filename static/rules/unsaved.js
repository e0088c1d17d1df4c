/** Rules that were not saved before the dashboard was killed: bring them back, or discard them. */

import { h, icon, identify } from "../common/dom.js";
import { request } from "./protocol.js";

export class UnsavedRules {
  /**
   * @param {Element} root
   * @param {import("./session.js").Session} session
   */
  constructor(root, session) {
    this.session = session;
    this.node = h("div", {});
    root.append(this.node);
  }

  /** @param {import("./protocol.js").UnsavedRules[]} left */
  update(left) {
    this.node.replaceChildren(...left.map((rules) => this.#notice(rules)));
  }

  #notice({ file, name, rules, edited }) {
    const when = new Date(edited * 1000).toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
    const words = `Not saved when the dashboard was killed: ${name || "rules without a name"}, ${rules} rules, edited ${when}.`;
    const choice = (id, label, message) => {
      const button = h("button", { type: "button", class: "button" }, label);
      button.addEventListener("click", () => this.session.command(message));
      identify(button, id);
      return button;
    };
    const notice = h(
      "div",
      { class: "notice offline unsaved", role: "status" },
      icon("warning"),
      h("span", { class: "notice-text" }, words),
      choice("bring-back", "Bring them back", request.bringBack(file)),
      choice("discard", "Discard", request.discard(file)),
    );
    identify(notice, "unsaved");
    return notice;
  }
}
