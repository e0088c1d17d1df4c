/** Curves over generations, as SVG: lines, dashed levels, marks, and the values under the pointer. */

import { h, identify, svg } from "./dom.js";
import { axis, figure } from "./figures.js";

/** Okabe and Ito's colours without yellow and black: told apart by the colour-blind, on any ground. */
export const COLOURS = ["#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#0072b2"];

const HEIGHT = 212;
const [LEFT, RIGHT, TOP, BOTTOM] = [52, 8, 6, 30];
const LABEL = 14; // px between the labels of two levels

/**
 * @typedef {object} Line
 * @property {string} label
 * @property {string} kind CSS class.
 * @property {string} [colour] Instead of that of the class.
 * @property {number[]} x Ascending.
 * @property {number[]} y
 *
 * @typedef {object} Data
 * @property {Line[]} lines The first one's values of x are those that can be pointed at.
 * @property {{label: string, y: number}[]} levels
 * @property {{x: number, y: ?number, text: string}[]} marks
 * @property {string} [label] What the values are.
 */

export class Chart {
  /** @type {Data} */
  #data = { lines: [], levels: [], marks: [] };
  #at = null;
  #scale = null;

  constructor(testid, label) {
    this.picture = svg("svg", { class: "chart", height: HEIGHT, tabindex: 0, role: "img" });
    identify(this.picture, testid, label);
    this.cursor = svg("g", { class: "cursor" });
    this.tip = h("div", { class: "chart-tip", hidden: true, "data-testid": `${testid}-tip` });
    this.node = h("div", { class: "chart-frame" }, this.picture, this.tip);
    this.picture.addEventListener("pointermove", (event) => this.#point(event));
    this.picture.addEventListener("pointerleave", () => this.#leave());
    this.picture.addEventListener("keydown", (event) => this.#walk(event));
    this.picture.addEventListener("blur", () => this.#leave());
    new ResizeObserver(() => this.#paint()).observe(this.node);
  }

  /** @param {Data} data */
  show(data) {
    this.#data = data;
    this.#paint();
  }

  #paint() {
    const width = this.node.clientWidth;
    const { lines, levels, marks, label = "fitness" } = this.#data;
    if (!width || !lines.some((line) => line.x.length)) {
      this.picture.replaceChildren();
      return;
    }
    const across = axis([0, ...lines.map(({ x }) => x.at(-1) ?? 0)]);
    const up = axis([0, ...lines.flatMap(({ y }) => y), ...levels.map(({ y }) => y)]);
    const x = (value) => LEFT + ((width - LEFT - RIGHT) * across.percent(value)) / 100;
    const y = (value) => HEIGHT - BOTTOM - ((HEIGHT - TOP - BOTTOM) * up.percent(value)) / 100;
    this.#scale = { x, y, width };
    this.picture.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
    this.picture.replaceChildren(
      ...grid(across.ticks, up.ticks, x, y, width, label),
      ...levels.map((level) => levelLine(level, y, width)),
      ...lines.map((line) => curve(line, x, y)).reverse(),
      ...levels.map((level, i) => levelName(level, levels.slice(0, i), y)),
      ...marks.map((mark) => markLine(mark, x, y)),
      this.cursor,
    );
    this.#showValues();
  }

  #point(event) {
    const { x } = this.#data.lines[0] ?? { x: [] };
    if (!this.#scale || !x.length) return;
    const left = event.clientX - this.picture.getBoundingClientRect().left;
    const distances = x.map((value) => Math.abs(this.#scale.x(value) - left));
    this.#at = distances.indexOf(Math.min(...distances));
    this.#showValues();
  }

  #leave() {
    this.#at = null;
    this.#showValues();
  }

  #walk(event) {
    const last = (this.#data.lines[0]?.x.length ?? 0) - 1;
    const from = this.#at ?? last;
    const to = { ArrowLeft: from - 1, ArrowRight: from + 1, Home: 0, End: last }[event.key];
    if (to === undefined || last < 0) return;
    event.preventDefault();
    this.#at = Math.max(0, Math.min(last, to));
    this.#showValues();
  }

  /** What every line is worth where the pointer is. */
  #showValues() {
    const { lines, marks } = this.#data;
    const at = lines[0]?.x[this.#at ?? -1];
    this.tip.hidden = at === undefined;
    this.cursor.replaceChildren();
    if (at === undefined) return;
    const { x, y, width } = this.#scale;
    const here = lines.map((line) => ({ line, value: valueAt(line, at) })).filter(({ value }) => value !== undefined);
    const near = marks.filter((mark) => Math.abs(x(mark.x) - x(at)) < 4);
    this.tip.replaceChildren(
      h("b", {}, `generation ${at}`),
      ...here.map(({ line, value }) => tipRow(line, value)),
      ...near.map((mark) => h("div", { class: "tip-mark" }, `${mark.x}: ${mark.text}`)),
    );
    this.cursor.append(svg("line", { x1: x(at), x2: x(at), y1: TOP, y2: HEIGHT - BOTTOM }));
    for (const { line, value } of here) {
      const dot = svg("circle", { class: `dot ${line.kind}`, cx: x(at), cy: y(value), r: 3 });
      tint(dot, line);
      this.cursor.append(dot);
    }
    const right = x(at) < width / 2;
    this.tip.style.setProperty("left", right ? `${x(at) + 10}px` : "auto");
    this.tip.style.setProperty("right", right ? "auto" : `${width - x(at) + 10}px`);
  }
}

/** A short piece of a line, to name it by. */
export function swatch(line) {
  const node = h("i", { class: `swatch ${line.kind}`, "aria-hidden": "true" });
  tint(node, line);
  return node;
}

function tint(node, { colour }) {
  if (colour) node.style.setProperty("--ink", colour);
}

function tipRow(line, value) {
  return h("div", { class: "tip-row" }, swatch(line), h("span", {}, line.label), h("b", {}, figure(value)));
}

/** @returns {number | undefined} The value at the last x that is not beyond; none outside the line. */
function valueAt({ x, y }, at) {
  if (!x.length || at < x[0] || at > x.at(-1)) return undefined;
  let [low, high] = [0, x.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (x[middle] <= at) low = middle;
    else high = middle - 1;
  }
  return y[low];
}

function curve(line, x, y) {
  const points = line.x.map((value, i) => `${x(value).toFixed(1)} ${y(line.y[i]).toFixed(1)}`);
  const path = svg("path", { class: `line ${line.kind}`, d: `M${points.join("L")}` });
  tint(path, line);
  return path;
}

function text(words, attributes) {
  const node = svg("text", attributes);
  node.textContent = words;
  return node;
}

function grid(across, up, x, y, width, label) {
  const bottom = HEIGHT - BOTTOM;
  return [
    ...up.map((tick) => svg("line", { class: "grid", x1: LEFT, x2: width - RIGHT, y1: y(tick), y2: y(tick) })),
    ...up.map((tick) => text(String(tick), { class: "tick up", x: LEFT - 5, y: y(tick) + 3 })),
    ...across.map((tick) => svg("line", { class: "grid", x1: x(tick), x2: x(tick), y1: TOP, y2: bottom })),
    ...across.map((tick) => text(String(tick), { class: "tick", x: x(tick), y: bottom + 12 })),
    text("generation", { class: "tick", x: (LEFT + width - RIGHT) / 2, y: HEIGHT - 5 }),
    text(label, { class: "tick", transform: `translate(10 ${(TOP + bottom) / 2}) rotate(-90)` }),
  ];
}

/** A dashed line across. */
function levelLine({ y: value }, y, width) {
  return svg("line", { class: "level", x1: LEFT, x2: width - RIGHT, y1: y(value), y2: y(value) });
}

/** The level's name above its line, or below where another level's name is; no curve crosses it. */
function levelName({ label, y: value }, others, y) {
  const taken = others.some((other) => other.y >= value && y(value) - y(other.y) < LABEL);
  const at = y(value) + (taken ? LABEL - 4 : -3);
  return text(`${label} ${figure(value)}`, { class: "level-name", x: LEFT + 5, y: at });
}

/** A thin line where something was done, with a dot where rules entered. */
function markLine(mark, x, y) {
  const at = x(mark.x);
  const words = svg("title");
  words.textContent = `Generation ${mark.x}: ${mark.text}`;
  const entered = mark.y !== null;
  const node = svg("g", { class: entered ? "mark entered" : "mark", "data-testid": "mark" }, words);
  node.append(svg("line", { x1: at, x2: at, y1: TOP, y2: HEIGHT - BOTTOM }));
  node.append(svg("path", { d: `M${at - 4} ${TOP}h8l-4 6z` }));
  if (entered) node.append(svg("circle", { cx: at, cy: y(mark.y), r: 4 }));
  return node;
}
