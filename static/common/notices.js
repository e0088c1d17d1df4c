/** Messages above the table; errors stay until they are dismissed, or what they are about is over. */

import { h, icon, iconButton } from "./dom.js";

const INFO_STAYS = 6000;
const OTHERS_STAY = 5000;
const LOST = "Connection lost, reconnecting… What you type is kept.";
const LEAST_SHOWN = 2000; // ms for which an error is seen, also if it is over at once

export class Notices {
  #told = 0;
  #timer = null;

  /** @param {Element} root */
  constructor(root) {
    this.list = h("div", { class: "notice-list" });
    this.offline = h(
      "div",
      { class: "notice offline", role: "status", "data-testid": "offline", hidden: true },
      h("span", { class: "spinner", "aria-hidden": "true" }),
      h("span", { class: "notice-text" }, LOST),
    );
    this.others = h("div", { class: "others", role: "status", "data-testid": "others", hidden: true });
    root.append(this.offline, this.list, this.others);
  }

  /**
   * @param {"error" | "info"} level
   * @param {string} text May have several lines; all are shown.
   * @param {string} [about] What it is about: see `forget`.
   */
  show(level, text, about = "") {
    const dismiss = iconButton("remove", "Dismiss", () => notice.remove());
    dismiss.dataset.testid = "dismiss";
    const notice = h(
      "div",
      {
        class: `notice ${level}`,
        role: level === "error" ? "alert" : "status",
        "data-testid": `notice-${level}`,
        "data-about": about,
        "data-shown": performance.now(),
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

  /**
   * What errors are about is over.
   *
   * @param {string} [about] By default what was asked for last: something else is asked for now.
   */
  forget(about = "") {
    for (const notice of this.list.querySelectorAll(".error")) {
      if (notice.dataset.about !== about) continue;
      setTimeout(() => notice.remove(), notice.dataset.shown - performance.now() + LEAST_SHOWN);
    }
  }

  /**
   * Say at the lower edge what somebody else did; the newest stands for all that have just been.
   *
   * @param {string} who
   * @param {string} what
   */
  tell(who, what) {
    const count = this.others.hidden ? 1 : this.#told + 1;
    this.#told = count;
    const more = count > 1 ? h("span", { class: "count" }, `${count} changes`) : "";
    this.others.replaceChildren(h("b", {}, who), ` ${what} `, more);
    this.others.hidden = false;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => (this.others.hidden = true), OTHERS_STAY);
  }

  connected(yes) {
    if (yes) this.#sayOffline(LOST);
    this.offline.hidden = yes;
    document.body.classList.toggle("disconnected", !yes);
  }

  /** There is no connection, and why. */
  refused(why) {
    this.#sayOffline(`Refused: ${why}`);
  }

  #sayOffline(text) {
    const said = this.offline.querySelector(".notice-text");
    if (said.textContent !== text) said.textContent = text;
  }

  /** Point at the connection notice: something could not be done without a connection. */
  stress() {
    this.offline.animate([{ transform: "scale(1.02)" }, {}], { duration: 200 });
  }
}
