/** Messages above the table; errors stay until they are dismissed. */

import { h, icon, iconButton } from "./dom.js";

const INFO_STAYS = 6000;

export class Notices {
  /** @param {Element} root */
  constructor(root) {
    this.list = h("div", { class: "notice-list" });
    this.offline = h(
      "div",
      { class: "notice offline", role: "status", "data-testid": "offline", hidden: true },
      h("span", { class: "spinner", "aria-hidden": "true" }),
      h("span", { class: "notice-text" }, "Connection lost, reconnecting… What you type is kept."),
    );
    root.append(this.offline, this.list);
  }

  /**
   * @param {"error" | "info"} level
   * @param {string} text May have several lines; all are shown.
   */
  show(level, text) {
    const dismiss = iconButton("remove", "Dismiss", () => notice.remove());
    dismiss.dataset.testid = "dismiss";
    const notice = h(
      "div",
      {
        class: `notice ${level}`,
        role: level === "error" ? "alert" : "status",
        "data-testid": `notice-${level}`,
      },
      ...(level === "error" ? [icon("warning")] : []),
      h("span", { class: "notice-text" }, text),
      dismiss,
    );
    for (const old of [...this.list.children]) {
      if (old.querySelector(".notice-text").textContent === text) old.remove();
    }
    this.list.append(notice);
    if (level === "info") setTimeout(() => notice.remove(), INFO_STAYS);
  }

  connected(yes) {
    this.offline.hidden = yes;
    document.body.classList.toggle("disconnected", !yes);
  }

  /** Point at the connection notice: something could not be done without a connection. */
  stress() {
    this.offline.animate([{ transform: "scale(1.02)" }, {}], { duration: 200 });
  }
}
