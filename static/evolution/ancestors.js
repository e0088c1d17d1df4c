/** Whom the best descends from: everybody as a picture, the line of first parents as a list. */

import { h, identify, svg } from "../common/dom.js";
import { axis, figure } from "../common/figures.js";
import { request } from "./protocol.js";
import { Rows } from "./rows.js";

const HEIGHT = 176;
const [LEFT, RIGHT, TOP, BOTTOM] = [52, 8, 8, 30];

export class Ancestors {
  #chosen = null;
  /** @type {?import("./protocol.js").AncestorsMessage} */
  #family = null;

  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   */
  constructor(root, send) {
    this.picture = svg("svg", { class: "family", height: HEIGHT, role: "img" });
    identify(this.picture, "family", "Ancestors of the best by generation and fitness");
    this.rows = new Rows("ancestor", COLUMNS, ([generation, key]) => send(request.choose(generation, key)));
    this.words = h("p", { class: "note" });
    this.filled = h("div", { hidden: true }, this.words, this.picture, this.rows.node);
    this.empty = h("p", { class: "note" }, "There is no best individual yet: start an evolution, or open one of the runs.");
    root.append(this.empty, this.filled);
    new ResizeObserver(() => this.#draw()).observe(this.filled);
  }

  /** @param {import("./protocol.js").AncestorsMessage} message */
  update(message) {
    const { all, line } = message;
    this.#family = message;
    this.filled.hidden = line.length === 0;
    this.empty.hidden = line.length > 0;
    if (line.length === 0) return;
    this.words.textContent = `The best, from the top down: its first parent, that one's first parent and so on. ${counted(all.length)}`;
    this.#draw();
    this.rows.show(line, ([generation, , fitness, how, codons]) => [String(generation), figure(fitness), [bred(how)], String(codons)]);
    this.rows.mark(this.#chosen);
  }

  /** @param {?{generation: number, key: number}} individual */
  choose(individual) {
    this.#chosen = individual;
    this.rows.mark(individual);
  }

  #draw() {
    const width = this.filled.clientWidth;
    const { all, line } = this.#family ?? { all: [], line: [] };
    if (!width || !line.length) return;
    const across = axis([Math.min(...all.map(([generation]) => generation)), ...line.map(([generation]) => generation)]);
    const up = axis(all.map(([, , fitness]) => fitness));
    const x = (generation) => LEFT + ((width - LEFT - RIGHT) * across.percent(generation)) / 100;
    const y = (fitness) => HEIGHT - BOTTOM - ((HEIGHT - TOP - BOTTOM) * up.percent(fitness)) / 100;
    const places = new Map(all.map(([generation, key, fitness]) => [`${generation} ${key}`, [x(generation), y(fitness)]]));
    const edges = all.flatMap(([generation, key, , parents]) =>
      parents.map((birth) => [places.get(`${generation} ${key}`), places.get(birth.join(" "))]).filter(([, from]) => from),
    );
    const known = line.filter(([generation, key]) => places.has(`${generation} ${key}`));
    const trunk = known.map(([generation, key]) => places.get(`${generation} ${key}`).join(" "));
    this.picture.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
    this.picture.replaceChildren(
      ...across.ticks.map((tick) => label(tick, { class: "tick", x: x(tick), y: HEIGHT - BOTTOM + 14 })),
      ...up.ticks.map((tick) => label(tick, { class: "tick up", x: LEFT - 6, y: y(tick) + 3 })),
      label("generation", { class: "tick", x: (LEFT + width - RIGHT) / 2, y: HEIGHT - 4 }),
      label("fitness", { class: "tick", transform: `translate(10 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)` }),
      ...edges.map(([[x1, y1], [x2, y2]]) => svg("line", { class: "edge", x1, y1, x2, y2 })),
      ...[...places.values()].map(([cx, cy]) => svg("circle", { cx, cy, r: 2 })),
      svg("path", { class: "trunk", d: `M${trunk.join("L")}` }),
      ...known.map(([generation, key, , how]) => {
        const [cx, cy] = places.get(`${generation} ${key}`);
        return svg("circle", { class: how, cx, cy, r: 3 });
      }),
    );
  }
}

const COLUMNS = {
  Generation: "In which it was bred",
  Fitness: "Of the objective per run, mean of its evaluations",
  "Bred by": "What made it out of its parents",
  Codons: "Length of its genome",
};

const counted = (count) => (count > 1 ? `The picture shows ${count - 1} ancestors.` : "");

function bred(how) {
  return h("span", { class: `bred ${how}` }, how);
}

function label(value, attributes) {
  const node = svg("text", attributes);
  node.textContent = String(value);
  return node;
}
