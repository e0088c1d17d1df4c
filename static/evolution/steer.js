/** What can be changed while the evolution runs, and what has been. */

import { h, identify } from "../common/dom.js";
import { readable } from "./form.js";
import { request } from "./protocol.js";

const PROBABILITY = { min: 0, max: 1, step: 0.01 };
const RANGES = {
  scaling: { min: 0, max: 10, step: 0.1 },
  tournament: { min: 1, max: 20, step: 1 },
};

export class Steer {
  #knobs = new Map();

  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   */
  constructor(root, send) {
    this.send = send;
    this.knobs = h("div", { class: "knobs" });
    this.idle = h("p", { class: "note" }, "No evolution is running: start one, or resume one of the runs.");
    const onclick = () => send(request.inject());
    this.inject = h("button", { type: "button", class: "button", onclick }, "Inject the edited rules");
    identify(this.inject, "inject");
    const words = "The rules of the table enter the population with the next generation, in place of the worst.";
    this.injection = h("div", { class: "injection" }, this.inject, h("p", { class: "note" }, words));
    this.log = h("ol", { class: "log", "data-testid": "steering-log" });
    this.done = h("div", {}, h("h3", {}, "Done so far"), this.log);
    root.append(this.idle, this.knobs, this.injection, this.done);
  }

  /** @param {import("./protocol.js").FormMessage} message */
  build({ fields }) {
    if (this.#knobs.size) return;
    const steerable = fields.filter((field) => field.steerable);
    this.#knobs = new Map(steerable.map((field) => [field.name, this.#knob(field)]));
    this.knobs.replaceChildren(...[...this.#knobs.values()].map(({ node }) => node));
  }

  /** @param {import("./protocol.js").EvolutionMessage} message */
  update({ active, settings, idle }) {
    const ready = Object.keys(settings).length > 0; // a run has been opened
    this.idle.hidden = active;
    this.knobs.hidden = this.injection.hidden = !ready;
    for (const [name, { node, slider, number }] of this.#knobs) {
      node.hidden = !(name in settings) || idle.includes(name);
      if (node.hidden || slider.dataset.moving || number.dataset.moving) continue;
      slider.value = number.value = settings[name];
    }
  }

  /** @param {import("./protocol.js").CurvesMessage} message */
  showMarks({ marks }) {
    this.done.hidden = marks.length === 0;
    const entry = ({ generation, text }) => h("li", {}, h("b", {}, `Generation ${generation}`), ` ${text}`);
    this.log.replaceChildren(...[...marks].reverse().map(entry));
  }

  /** A slider and a number that say the same. */
  #knob({ name, help }) {
    const range = RANGES[name] ?? PROBABILITY;
    const label = readable(name);
    const input = (type, testid, more) => {
      const node = h("input", { type, ...range, ...more });
      identify(node, testid, label);
      return node;
    };
    const slider = input("range", `slider-${name}`, {});
    const number = input("number", `steer-${name}`, { step: "any" });
    const follow = (from, to) => {
      from.addEventListener("input", () => {
        from.dataset.moving = "yes";
        to.value = from.value;
      });
      from.addEventListener("change", () => {
        delete from.dataset.moving;
        this.send(request.steer(name, Number(from.value)));
      });
      from.addEventListener("blur", () => delete from.dataset.moving);
    };
    follow(slider, number);
    follow(number, slider);
    const node = h("div", { class: "knob", title: `${help} Takes effect with the next generation.` });
    node.append(h("span", { class: "knob-name" }, label), slider, number);
    return { node, slider, number };
  }
}
