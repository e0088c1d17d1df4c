/** What the swarm is doing: time, robots in each behaviour, and how often each rule fires. */

import { h, identify } from "../common/dom.js";

const WINDOW = 60; // s of simulated time over which rates are taken
const SPACING = 1; // s between the samples that are kept
const LEAST = 2; // s before a rate is shown
const SECONDS = new Intl.NumberFormat("en", { minimumFractionDigits: 1, maximumFractionDigits: 1 });
const AFTERGLOW = 400; // ms without a message after which no rule glows: the swarm is paused

/** Cumulative counts of the last simulated minute. */
export class RateWindow {
  #samples = [];

  clear() {
    this.#samples = [];
  }

  /**
   * @param {number} time Simulated time, s.
   * @param {number[]} fired Cumulative count per rule; counts that fall start a new window.
   * @param {number} robots
   * @returns {{since: number[], rates: ?number[]}} Counts since the last message, and times per
   *   robot and simulated minute, null while the window is too short.
   */
  add(time, fired, robots) {
    const last = this.#samples.at(-1);
    const fell = last && (time < last.time || fired.some((count, i) => count < last.fired[i]));
    if (fell || (last && fired.length !== last.fired.length)) this.clear();
    const previous = this.#samples.at(-1)?.fired ?? fired;
    const since = fired.map((count, i) => count - previous[i]);
    this.#keep({ time, fired });
    const first = this.#samples[0];
    const minutes = ((time - first.time) / 60) * robots;
    const long = time - first.time >= LEAST && robots > 0;
    return { since, rates: long ? fired.map((count, i) => (count - first.fired[i]) / minutes) : null };
  }

  #keep(sample) {
    const kept = this.#samples;
    // The last sample is always the newest; it is replaced until it is far enough from the one before.
    if (kept.length > 1 && sample.time - kept.at(-2).time < SPACING) kept.pop();
    kept.push(sample);
    while (kept.length > 2 && sample.time - kept[0].time > WINDOW) kept.shift();
  }
}

export class Live {
  #rates = new RateWindow();
  #rules = "";
  #afterglow = null;

  constructor() {
    this.bar = h("div", { class: "share-bar", "aria-hidden": "true" });
    this.legend = h("div", { class: "legend" });
    this.time = h("span", { class: "time", "data-testid": "time", title: "simulated time" });
    this.node = h("div", { class: "live", "data-testid": "live", hidden: true });
    this.node.append(this.bar, h("div", { class: "live-line" }, this.legend, this.time));
  }

  /** @param {import("./protocol.js").VocabularyMessage} vocabulary */
  name({ behaviours }) {
    this.counts = behaviours.map(() => h("b", {}, "0"));
    this.shares = behaviours.map(({ colour }) => led(h("span", { class: "share" }), colour));
    const entries = behaviours.map(({ name, doing, colour }, i) => {
      const lamp = led(h("span", { class: "lamp", "aria-hidden": "true" }), colour);
      identify(this.counts[i], `live-${name}`);
      return h("span", { class: "legend-entry", title: doing }, lamp, this.counts[i], name);
    });
    this.bar.replaceChildren(...this.shares);
    this.legend.replaceChildren(...entries);
  }

  /** Rates belong to the rules they were counted for: start again when the rules change. */
  rulesChanged(rules) {
    const text = JSON.stringify(rules);
    if (text !== this.#rules) this.#rates.clear();
    this.#rules = text;
  }

  /**
   * @param {import("./protocol.js").LiveMessage} message
   * @param {import("./card.js").RuleCard[]} cards
   */
  update({ time, fired, behaviours, robots }, cards) {
    this.node.hidden = false;
    this.time.textContent = `${SECONDS.format(time)} s`;
    behaviours.forEach((count, i) => {
      this.counts[i].textContent = count;
      this.shares[i].style.setProperty("flex-grow", count);
    });
    const { since, rates } = this.#rates.add(time, fired, robots);
    cards.forEach((card, i) => {
      card.showFiring((since[i] ?? 0) / Math.max(1, robots));
      card.showRate(rates?.[i] ?? null);
    });
    clearTimeout(this.#afterglow);
    this.#afterglow = setTimeout(() => cards.forEach((card) => card.showFiring(0)), AFTERGLOW);
  }
}

function led(node, colour) {
  node.style.setProperty("--led", colour);
  return node;
}
