/** Did the edit make the rules better? Full runs of these rules beside those of others. */

import { h, iconButton, identify, svg } from "../common/dom.js";
import { axis, decimal, decimalsFor, interval, mean, pValue, quantile, signed } from "../common/figures.js";

const HEIGHT = 15; // px of one row's plot
const GOLDEN = 0.618; // spreads equal values without chance

/** @typedef {"better" | "worse" | "even" | "same"} Judgement */

/**
 * @param {import("./protocol.js").RoleComparison} comparison
 * @param {boolean} [maximise] More is better.
 * @returns {Judgement} "even" if the interval holds zero, "same" if no run differs.
 */
export function judge({ difference, low, high }, maximise = true) {
  if (difference === 0 && low === 0 && high === 0) return "same";
  if (low <= 0 && high >= 0) return "even";
  return low > 0 === maximise ? "better" : "worse";
}

const SIGNS = { better: "▲", worse: "▼", even: "≈", same: "=" };

export class Verdict {
  /** @type {?import("./protocol.js").VerdictMessage} */
  #shown = null;
  #changed = 0;
  #rules = "";
  #maximise = true;
  #decimals = 1;

  constructor() {
    this.mean = h("b", { "data-testid": "verdict-mean" });
    this.answer = h("span", { class: "answer", "data-testid": "verdict-answer" });
    this.progress = h("span", { class: "runs", "data-testid": "verdict-progress" });
    this.said = h("span", { class: "unseen", role: "status" });
    this.fold = iconButton("fold", "Hide the runs", () => this.#fold());
    identify(this.fold, "verdict-fold");
    this.unit = h("span", { class: "unit" });
    const line = h("div", { class: "verdict-line" }, this.mean, this.unit, this.answer);
    line.append(this.progress, this.fold, this.said);
    this.bar = h("div", { class: "progress", "aria-hidden": "true" }, h("span"));
    this.rows = h("tbody");
    this.caption = h("caption", { class: "unseen" });
    this.table = h("table", { class: "verdict-table" }, this.caption, this.rows);
    this.node = h("section", { class: "verdict", hidden: true });
    identify(this.node, "verdict", "Verdict on these rules");
    this.node.append(line, this.bar, this.table);
  }

  /** @param {import("./protocol.js").ObjectiveOffer} objective */
  measure({ expression, unit, label, maximise }) {
    this.#maximise = maximise;
    this.unit.textContent = unit || expression;
    this.unit.title = maximise ? label : `${label}: less is better`;
    this.caption.textContent = `${label} in each run`;
  }

  /**
   * Other rules make the figures old; other comments and names do not.
   *
   * @param {import("./protocol.js").RulesMessage} message
   */
  rulesChanged({ version, rule_set: { rules } }) {
    const text = JSON.stringify(rules.map((rule) => ({ ...rule, comment: "" })));
    if (text === this.#rules) return;
    if (this.#rules) this.#changed = version;
    this.#rules = text;
    this.#dim();
  }

  /** @param {import("./protocol.js").VerdictMessage} message */
  update(message) {
    const current = message.samples.find((sample) => sample.role === "current");
    const done = current?.fitness.length ?? 0;
    if (current) this.#showProgress(message, done);
    // The figures before the edit stay, dimmed, until the first run of the new rules is in.
    if (done > 0) this.#show(message, current);
    else this.#dim(this.#shown !== null);
  }

  #show(message, current) {
    this.#shown = message;
    this.node.hidden = false;
    const values = message.samples.flatMap((sample) => sample.fitness);
    this.#decimals = decimalsFor(values);
    this.mean.textContent = decimal(mean(current.fitness), this.#decimals);
    this.#answer(message);
    const scale = axis(values);
    const comparisons = new Map(message.comparisons.map((entry) => [entry.role, entry]));
    const rows = message.samples.map((sample) => this.#row(sample, comparisons.get(sample.role), scale));
    this.rows.replaceChildren(...rows, axisRow(scale));
    this.#dim();
  }

  /** The comparison that matters most: before the edit if there was one. */
  #answer({ samples, comparisons, busy }) {
    const [first] = comparisons;
    const comparison = comparisons.find(({ role }) => role === "before") ?? first;
    this.answer.hidden = !comparison;
    if (!comparison) return;
    const judgement = judge(comparison, this.#maximise);
    const { name } = samples.find((sample) => sample.role === comparison.role);
    const by = signed(comparison.difference, this.#decimals);
    const words = {
      better: `${by} vs ${name}`,
      worse: `${by} vs ${name}`,
      even: `${by} vs ${name}, no clear difference`,
      same: `the same as ${name}`,
    }[judgement];
    this.answer.className = `answer ${judgement}`;
    this.answer.textContent = `${SIGNS[judgement]} ${words}`;
    this.answer.title = this.#describe(comparison, name);
    this.said.textContent = busy ? "" : `${this.mean.textContent} ${this.unit.textContent}. ${this.answer.title}`;
  }

  #showProgress({ busy, runs, scenario }, done) {
    this.progress.textContent = busy ? `${done} of ${runs} runs` : `${done} runs`;
    this.progress.title = `full runs of the scenario ${scenario}, the same seeds for all rules`;
    this.bar.firstChild.style.setProperty("width", `${(100 * done) / Math.max(1, runs)}%`);
    this.node.classList.toggle("busy", busy);
  }

  #dim(stale = this.#shown !== null && this.#shown.version < this.#changed) {
    this.node.classList.toggle("stale", stale);
  }

  /** The comparison in a sentence. */
  #describe({ difference, low, high, p_value }, name) {
    const reach = `95 % interval ${interval(low, high, this.#decimals)}`;
    const figures = [reach, pValue(p_value)].filter(Boolean).join(", ");
    const by = `${signed(difference, this.#decimals)} ${this.unit.textContent}`;
    return `These rules make ${by} compared with ${name}: ${figures}`;
  }

  #row({ role, name, fitness }, comparison, scale) {
    const average = fitness.length ? decimal(mean(fitness), this.#decimals) : "–";
    const cells = [
      h("th", { scope: "row" }, name),
      h("td", { class: "mean", "data-testid": `verdict-${role}-mean` }, average),
      h("td", { class: "plot" }, plot(fitness, scale)),
      this.#difference(role, name, comparison),
    ];
    return h("tr", { class: `sample ${role}`, "data-testid": `verdict-${role}` }, ...cells);
  }

  #difference(role, name, comparison) {
    const cell = h("td", { class: "difference", "data-testid": `verdict-${role}-difference` });
    if (!comparison) return cell;
    const judgement = judge(comparison, this.#maximise);
    cell.classList.add(judgement);
    cell.title = this.#describe(comparison, name);
    if (judgement === "same") {
      cell.append("= the same");
      return cell;
    }
    const { difference: by, low, high, p_value } = comparison;
    const reach = interval(low, high, this.#decimals);
    cell.append(h("b", {}, `${SIGNS[judgement]} ${signed(by, this.#decimals)}`), ` ${reach}`);
    if (pValue(p_value)) cell.append(h("span", { class: "p-value" }, `, ${pValue(p_value)}`));
    return cell;
  }

  #fold() {
    this.table.hidden = !this.table.hidden;
    this.node.classList.toggle("folded", this.table.hidden);
    const label = this.table.hidden ? "Show the runs" : "Hide the runs";
    this.fold.title = label;
    identify(this.fold, "verdict-fold", label);
  }
}


/** A dot for every run, a box over the middle half, a line at the mean. */
function plot(fitness, { ticks, percent }) {
  const at = (value) => `${percent(value).toFixed(2)}%`;
  const grid = ticks.map((tick) => svg("line", { class: "grid", x1: at(tick), x2: at(tick), y1: 0, y2: HEIGHT }));
  const picture = svg("svg", { height: HEIGHT, "aria-hidden": "true" }, ...grid);
  if (!fitness.length) return picture;
  const [low, high] = [0.25, 0.75].map((share) => percent(quantile(fitness, share)));
  const box = { x: `${low}%`, width: `${Math.max(0.2, high - low)}%`, y: 2, height: HEIGHT - 4 };
  const dots = fitness.map((value, i) => {
    const cy = (2.5 + ((i * GOLDEN) % 1) * (HEIGHT - 5)).toFixed(1);
    return svg("circle", { cx: at(value), cy, r: 1.7 });
  });
  const average = at(mean(fitness));
  const line = svg("line", { class: "average", x1: average, x2: average, y1: 0, y2: HEIGHT });
  picture.append(svg("rect", { class: "box", rx: 2, ...box }), ...dots, line);
  return picture;
}

function axisRow({ ticks, percent }) {
  const labels = ticks.map((tick) => {
    const text = svg("text", { x: `${percent(tick)}%`, y: 9 });
    text.textContent = String(tick);
    return text;
  });
  const picture = svg("svg", { height: 12, "aria-hidden": "true" }, ...labels);
  const legend = h("td", { class: "difference legend-cell" }, "difference, 95 % interval");
  legend.append(h("span", { class: "p-value" }, ", p"));
  const plotCell = h("td", { class: "plot" }, picture);
  return h("tr", { class: "axis", "aria-hidden": "true" }, h("td"), h("td"), plotCell, legend);
}
