/** The population of the last generation: how good, how big, how different, and everybody in it. */

import { h, identify, svg } from "../common/dom.js";
import { decimal, decimalsFor, figure } from "../common/figures.js";
import { request } from "./protocol.js";
import { Rows } from "./rows.js";

const HEIGHT = 34; // px of a histogram

export class Population {
  /** @type {?import("./protocol.js").PopulationMessage} */
  #waiting = null;
  #chosen = null;

  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   */
  constructor(root, send) {
    this.tiles = h("div", { class: "tiles" });
    this.shares = h("div", { class: "shares" });
    identify(this.shares, "behaviours");
    this.rows = new Rows("individual", COLUMNS, ([generation, key]) => send(request.choose(generation, key)));
    this.note = h("p", { class: "note" });
    this.filled = h("div", { hidden: true }, this.tiles, this.shares, this.rows.node, this.note);
    this.empty = h("p", { class: "note" }, "There is no population yet: start an evolution, or open one of the runs.");
    root.append(this.empty, this.filled);
    // What the pointer is aimed at must not move away from under it.
    this.rows.node.addEventListener("pointerleave", () => this.#waiting && this.update(this.#waiting));
  }

  /** @param {import("./protocol.js").PopulationMessage} message */
  update(message) {
    const held = this.rows.node.matches(":hover") && this.rows.length > 0;
    this.#waiting = held ? message : null;
    this.filled.hidden = message.size === 0;
    this.empty.hidden = message.size > 0;
    if (message.size === 0) return;
    this.#summarise(message);
    if (held) return;
    const colours = new Map(message.coloured.map(([number, , colour]) => [number, colour]));
    this.rows.show(message.members, (member, i) => cells(member, i, colours));
    this.rows.mark(this.#chosen);
    const more = message.size - message.members.length;
    this.note.textContent = more > 0 ? `and ${more} more` : "";
  }

  /** @param {?{generation: number, key: number}} individual */
  choose(individual) {
    this.#chosen = individual;
    this.rows.mark(individual);
  }

  #summarise({ generation, size, invalid, behaviours, diversity, coloured, fitness, codons }) {
    const valid = invalid ? `${invalid} invalid` : "all valid";
    this.tiles.replaceChildren(
      tile("size", String(size), `individuals of generation ${generation}, ${valid}`),
      tile("behaviours", String(behaviours), "distinct behaviours", BEHAVIOURS),
      tile("diversity", decimal(diversity), "effective number of them", DIVERSITY),
      plot("fitness", "fitness", fitness, decimalsFor([fitness.low, fitness.high])),
      plot("codons", "size in codons", codons, 0, 1),
    );
    const rest = size - invalid - coloured.reduce((sum, [, count]) => sum + count, 0);
    const parts = coloured.map(([number, count, colour]) => share(count, colour, `behaviour ${number}: ${count}`));
    if (rest > 0) parts.push(share(rest, "", `other behaviours: ${rest}`));
    this.shares.replaceChildren(...parts);
  }
}

const COLUMNS = {
  "#": "Rank: by fitness; where individuals are evaluated again, less what may be luck, and copies of a behaviour last",
  Fitness: "Of the objective per run, mean of its evaluations",
  "Eval.": "How often it was evaluated",
  Codons: "Length of its genome",
  Rules: "How many rules it has",
  "Behav.": "Individuals with the same number decide the same in every situation; common ones have a colour. A behaviour keeps both for as long as anybody has it",
  Bred: "Generation in which it was bred",
};
const BEHAVIOURS = "Individuals whose robots decide the same in every situation have one behaviour";
const DIVERSITY = "As many equally frequent behaviours would be as diverse (exp of Shannon's entropy)";

/** The common behaviours have colours, the others are grey. */
function cells([generation, , fitness, told, codons, rules, behaviour], i, colours) {
  const patch = h("span", { class: "patch", "aria-hidden": "true" });
  if (colours.has(behaviour)) patch.style.setProperty("--patch", colours.get(behaviour));
  const number = behaviour === null ? ["invalid"] : [patch, String(behaviour)];
  return [String(i + 1), figure(fitness), `${told}×`, String(codons), rules === null ? "–" : String(rules), number, String(generation)];
}

function tile(id, value, words, title = null) {
  return h("div", { class: "tile", title, "data-testid": `tile-${id}` }, h("b", {}, value), h("span", {}, words));
}

/** A histogram with its ends and its mean. */
function plot(id, words, { low, high, mean, counts }, decimals, ofMean = decimals) {
  const most = Math.max(1, ...counts);
  const bars = counts.map((count, i) => {
    const height = count ? Math.max(1.5, ((HEIGHT - 1) * count) / most) : 0;
    return svg("rect", { x: i + 0.08, width: 0.84, y: HEIGHT - height, height });
  });
  const attributes = { viewBox: `0 0 ${counts.length} ${HEIGHT}`, preserveAspectRatio: "none", height: HEIGHT, "aria-hidden": "true" };
  const ends = h("div", { class: "ends" }, h("span", {}, decimal(low, decimals)), h("span", {}, decimal(high, decimals)));
  const title = h("span", {}, `${words}, mean ${decimal(mean, ofMean)}`);
  return h("div", { class: "tile plot", "data-testid": `plot-${id}` }, svg("svg", attributes, ...bars), ends, title);
}

function share(count, colour, title) {
  const node = h("span", { class: "share", title });
  node.style.setProperty("flex-grow", count);
  if (colour) node.style.setProperty("--patch", colour);
  return node;
}
