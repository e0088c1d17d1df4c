/**
 * The fitness curves of the run looked at and of those that are compared: each of these has the colour of
 * its box and goes by the name of the run, the one looked at as well.
 */

import { h, identify } from "../common/dom.js";
import { COLOURS, Chart, swatch } from "../common/chart.js";

export class Curves {
  /** @type {?import("./protocol.js").CurvesMessage} */
  #own = null;
  /** @type {import("./protocol.js").OtherCurve[]} */
  #others = [];

  constructor() {
    this.chart = new Chart("curves", "Fitness over generations");
    this.legend = h("div", { class: "chart-legend" });
    identify(this.legend, "curves-legend");
    this.node = h("div", { class: "curves", hidden: true }, this.chart.node, this.legend);
  }

  /** @param {import("./protocol.js").CurvesMessage} message */
  update(message) {
    this.#own = message;
    this.#draw();
  }

  /** @param {import("./protocol.js").ComparedRunsMessage} message */
  compare({ runs }) {
    this.#others = runs;
    this.#draw();
  }

  #draw() {
    const own = this.#own;
    const x = own?.generation ?? [];
    const ticked = this.#others.find(({ name }) => name === own?.run);
    const named = ticked && { label: labelOf(ticked), colour: COLOURS[ticked.colour] };
    const lines = x.length
      ? [
          { label: bestWords(own.reevaluated), kind: "best-so-far", x, y: own.best_so_far, ...named },
          { label: "best of generation", kind: "best", x, y: own.best },
          { label: "mean", kind: "mean", x, y: own.mean },
        ]
      : [];
    const others = this.#others.filter(({ name, generation }) => name !== own?.run && generation.length);
    lines.push(...others.map(otherLine));
    this.node.hidden = lines.length === 0;
    const levels = (own?.references ?? []).map(({ name, mean }) => ({ label: name, y: mean }));
    levels.sort((a, b) => b.y - a.y);
    const label = own?.label ?? "";
    this.chart.show({ lines, levels, marks: together(own?.marks ?? []), label });
    this.legend.replaceChildren(...lines.map((line) => h("span", {}, swatch(line), line.label)));
  }
}

/** @param {boolean} reevaluated @returns {string} What the curve of the best is, which can fall then. */
const bestWords = (reevaluated) => (reevaluated ? "best, re-evaluated" : "best so far");

const labelOf = ({ name, reevaluated }) => `${name}, ${bestWords(reevaluated)}`;

function otherLine(other) {
  return { label: labelOf(other), kind: "other", colour: COLOURS[other.colour], x: other.generation, y: other.best_so_far };
}

/** One mark for all that was done before a generation. */
function together(marks) {
  const found = new Map();
  for (const { generation: x, text, fitness } of marks) {
    const before = found.get(x);
    found.set(x, { x, text: before ? `${before.text}; ${text}` : text, y: fitness ?? before?.y ?? null });
  }
  return [...found.values()];
}
