/** The fitness curves of the run looked at and of those it is compared with. */

import { h, identify } from "../common/dom.js";
import { COLOURS, Chart, swatch } from "../common/chart.js";

export class Curves {
  /** @type {?import("./protocol.js").CurvesMessage} */
  #own = null;
  /** @type {import("./protocol.js").OtherCurve[]} */
  #others = [];

  constructor() {
    this.chart = new Chart("curves", "Objects collected over generations");
    this.legend = h("div", { class: "chart-legend" });
    identify(this.legend, "curves-legend");
    this.node = h("div", { class: "curves", hidden: true }, this.chart.node, this.legend);
  }

  /** @param {import("./protocol.js").CurvesMessage} message */
  update(message) {
    this.#own = message;
    this.#draw();
  }

  /** @param {import("./protocol.js").ComparedMessage} message */
  compare({ runs }) {
    this.#others = runs;
    this.#draw();
  }

  #draw() {
    const own = this.#own;
    const x = own?.generation ?? [];
    const others = this.#others
      .map((other, i) => ({ ...other, colour: COLOURS[i] }))
      .filter(({ name, generation }) => name !== own?.run && generation.length)
      .map(({ name, generation, best_so_far: y, colour }) => ({ label: name, kind: "other", colour, x: generation, y }));
    const lines = x.length
      ? [
          { label: "best so far", kind: "best-so-far", x, y: own.best_so_far },
          { label: "best of generation", kind: "best", x, y: own.best },
          { label: "mean", kind: "mean", x, y: own.mean },
        ]
      : [];
    lines.push(...others);
    this.node.hidden = lines.length === 0;
    const levels = (own?.references ?? []).map(({ name, mean }) => ({ label: name, y: mean }));
    levels.sort((a, b) => b.y - a.y);
    this.chart.show({ lines, levels, marks: together(own?.marks ?? []) });
    this.legend.replaceChildren(...lines.map((line) => h("span", {}, swatch(line), line.label)));
  }
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
