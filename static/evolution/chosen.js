/** The rules of the individual that was clicked. */

import { h, iconButton, identify } from "../common/dom.js";
import { figure } from "../common/figures.js";
import { request } from "./protocol.js";

export class ChosenRules {
  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   */
  constructor(root, send) {
    this.root = root;
    this.title = h("h2", { "data-testid": "chosen-title" });
    this.from = h("p", { class: "note" });
    const close = iconButton("remove", "Close", () => send(request.forget()));
    identify(close, "chosen-close");
    const onclick = () => send(request.load());
    const load = h("button", { type: "button", class: "button first", onclick }, "Load into the table");
    identify(load, "load");
    const beside = () => send(request.compareWith());
    const title = "Run it in the arena beside the rules of the table, same seed, same clock";
    const compare = h("button", { type: "button", class: "button", title, onclick: beside }, "Compare in the arena");
    identify(compare, "compare-with");
    this.rules = h("ol", { class: "chosen-rules", "data-testid": "chosen-rules" });
    root.setAttribute("aria-label", "Rules of the individual");
    root.append(h("div", { class: "chosen-head" }, this.title, close), this.from, h("div", { class: "chosen-tools" }, load, compare), this.rules);
  }

  /** @param {import("./protocol.js").ChosenMessage} message */
  update({ individual, rules }) {
    this.root.hidden = individual === null;
    if (individual === null) return;
    const { run, generation, key, fitness } = individual;
    this.title.textContent = `Generation ${generation}, individual ${key}`;
    this.from.textContent = `fitness ${figure(fitness)} · ${run}`;
    const one = ({ text, english }) => h("li", {}, h("p", {}, english), h("pre", {}, text));
    this.rules.replaceChildren(...rules.map(one));
  }
}
