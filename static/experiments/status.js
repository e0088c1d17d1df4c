/** The campaign under way: how far it is, how long it will take, and the button that stops it. */

import { h, identify } from "../common/dom.js";
import { duration } from "./duration.js";
import { request } from "./protocol.js";

export class Status {
  /** @param {(message: object) => boolean} send */
  constructor(send) {
    this.send = send;
    this.line = h("span", { class: "status-words" });
    identify(this.line, "status");
    this.stop = h("button", { type: "button", class: "button", onclick: () => send(request.stop()) }, "Stop");
    this.goOn = h("button", { type: "button", class: "button", onclick: () => send(request.resume(this.name)) }, "Go on");
    identify(this.stop, "stop");
    identify(this.goOn, "go-on");
    this.progress = h("progress", { "aria-label": "Campaign done", max: 1, value: 0 });
    this.error = h("div", { class: "failure", role: "alert", hidden: true, "data-testid": "failure" });
    const line = h("div", { class: "status-line" }, this.line, this.stop, this.goOn);
    this.node = h("div", { class: "status", hidden: true }, this.progress, line, this.error);
  }

  /** @param {import("./protocol.js").CampaignStatusMessage} message */
  update({ phase, name, share, doing, seconds_left: left, error }) {
    const active = phase === "RUNNING";
    const halted = phase === "STOPPED" || phase === "FAILED";
    this.name = name;
    this.node.hidden = !active && !halted;
    this.progress.value = share;
    this.stop.hidden = !active;
    this.goOn.hidden = !halted;
    const done = `${(100 * share).toFixed(1)} %`;
    const words = active ? [done, doing, left === null ? "" : `${duration(left)} left`] : [done, "stopped"];
    this.line.textContent = `${name}: ${words.filter(Boolean).join(" · ")}`;
    this.error.textContent = error ? `The campaign failed: ${error}` : "";
    this.error.hidden = !error;
  }
}
