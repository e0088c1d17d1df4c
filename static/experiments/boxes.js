/** What was compared: for each scenario a table with a box plot of each rule set. */

import { h, icon, identify, svg } from "../common/dom.js";
import { axis, decimal, decimalsFor, quantile } from "../common/figures.js";

const HEIGHT = 24; // px of a box plot
const GOLDEN = 0.618; // spreads equal values without chance
const SIGNIFICANT = 0.001;
const KINDS = ["html", "csv", "json"];

export class Boxes {
  /** @param {HTMLElement} root */
  constructor(root) {
    this.title = h("h2", { "data-testid": "compared-title" });
    const links = KINDS.map((kind) => {
      const name = `comparison.${kind}`;
      const link = h("a", { class: "quiet", href: `files/${name}`, download: name }, icon("save"), kind.toUpperCase());
      identify(link, `save-${kind}`, `Save as ${kind.toUpperCase()}`);
      return link;
    });
    this.error = h("div", { class: "failure", role: "alert", hidden: true, "data-testid": "compare-failure" });
    this.tables = h("div", {});
    this.explanation = h("p", { class: "note", "data-testid": "explanation" });
    const head = h("div", { class: "compared-head" }, this.title, ...links);
    this.node = h("div", { class: "compared", hidden: true }, head, this.tables, this.explanation);
    identify(this.node, "compared");
    root.append(this.error, this.node);
  }

  /** @param {import("./protocol.js").ComparedMessage} message */
  update({ scenarios, runs, seed, against, explanation, error }) {
    this.error.textContent = error;
    this.error.hidden = !error;
    this.node.hidden = scenarios.length === 0;
    const objectives = new Set(scenarios.map(({ objective }) => objective));
    this.title.textContent = `${[...objectives].join(" / ")}, ${runs} runs each, seed ${seed}`;
    this.tables.replaceChildren(...scenarios.map((scenario) => table(scenario, against)));
    const colour = `In colour, better or worse: p Holm < ${SIGNIFICANT}.`;
    this.explanation.textContent = explanation && `${explanation} ${colour}`;
  }
}

const HEADINGS = ["mean", "median", "sd", "p", "p Holm", "effect"];

function table({ name, results }, against) {
  const values = results.flatMap(({ fitness }) => fitness);
  const scale = { ...axis(values), decimals: decimalsFor(values) };
  const heads = HEADINGS.map((heading) => h("th", { scope: "col" }, heading));
  const head = h("tr", {}, h("th", { scope: "col", class: "scenario" }, name), h("td", {}), ...heads);
  const rows = results.map((result) => row(result, scale, result.rules === against));
  const body = h("tbody", {}, ...rows, axisRow(scale));
  const node = h("table", { class: "boxes" }, h("thead", {}, head), body);
  identify(node, `boxes-${name}`);
  return node;
}

function row(result, scale, isReference) {
  const figures = [result.mean, result.median, result.sd].map((value) => decimal(value, scale.decimals));
  const compared = [p(result.p_value), p(result.p_holm), result.effect === null ? "" : result.effect.toFixed(2)];
  const cells = [...figures, ...compared].map((text) => h("td", {}, text));
  const clear = result.p_holm !== null && result.p_holm < SIGNIFICANT;
  const kind = isReference ? "reference" : clear ? (result.effect > 0.5 ? "better" : "worse") : "";
  cells[5].className = kind;
  const name = h("th", { scope: "row", title: result.rules }, result.rules);
  return h("tr", { class: `box-row ${kind}` }, name, h("td", { class: "plot" }, plot(result, scale)), ...cells);
}

/** @returns {string} A p-value as short as it can be read. */
function p(value) {
  if (value === null) return "";
  return value < 0.001 ? "<0.001" : value.toFixed(3);
}

/** A dot for every run, a box over the middle half, a line at the median, whiskers. */
function plot({ rules, fitness, median }, { ticks, percent, decimals }) {
  const at = (value) => `${percent(value).toFixed(2)}%`;
  const [low, high] = [0.25, 0.75].map((share) => quantile(fitness, share));
  const reach = 1.5 * (high - low);
  const within = fitness.filter((value) => low - reach <= value && value <= high + reach);
  const [least, most] = [Math.min(...within), Math.max(...within)];
  const middle = HEIGHT / 2;
  const line = (kind, x1, x2, y1, y2) => svg("line", { class: kind, x1: at(x1), x2: at(x2), y1, y2 });
  const dots = fitness.map((value, i) => {
    const cy = (3 + ((i * GOLDEN) % 1) * (HEIGHT - 6)).toFixed(1);
    return svg("circle", { cx: at(value), cy, r: 1.6 });
  });
  const width = `${Math.max(0.2, percent(high) - percent(low)).toFixed(2)}%`;
  const told = (value) => decimal(value, decimals);
  const words = `${rules}: median ${told(median)}, middle half ${told(low)} to ${told(high)}`;
  return svg(
    "svg",
    { height: HEIGHT, role: "img", "aria-label": words },
    ...ticks.map((tick) => line("grid", tick, tick, 0, HEIGHT)),
    line("whisker", least, low, middle, middle),
    line("whisker", high, most, middle, middle),
    ...[least, most].map((end) => line("whisker", end, end, middle - 4, middle + 4)),
    svg("rect", { class: "box", x: at(low), width, y: 4, height: HEIGHT - 8, rx: 2 }),
    ...dots,
    line("median", median, median, 3, HEIGHT - 3),
  );
}

function axisRow({ ticks, percent }) {
  const labels = ticks.map((tick) => {
    const text = svg("text", { x: `${percent(tick)}%`, y: 9 });
    text.textContent = String(tick);
    return text;
  });
  const picture = svg("svg", { height: 12, "aria-hidden": "true" }, ...labels);
  return h("tr", { class: "axis", "aria-hidden": "true" }, h("td", {}), h("td", { class: "plot" }, picture));
}
