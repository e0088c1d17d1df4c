/** The rules as a state machine: a picture in which the swarm is seen to move, and its transitions. */

import { h, iconButton, identify } from "../common/dom.js";
import { RateWindow } from "./live.js";
import { MachinePicture } from "./machine.js";

const LEGEND =
  "A state fills with the robots in it, a dot is a robot on its way. p: probability per control step of 0.1 s. " +
  "R: the rules behind it. Pink: what happens besides, for example a walk that begins afresh.";

/**
 * What is looked at: a state (`target` is null), all transitions between two states (`at` is null),
 * or one of them.
 *
 * @typedef {{source: number, target: ?number, at: ?number}} Chosen
 */

export class StatesTab {
  /** @type {?import("./protocol.js").StatesMessage} */
  #machine = null;
  /** @type {?Chosen} */
  #chosen = null;
  #rates = new RateWindow();
  #rows = new Map();
  #awaited = null;

  /**
   * @param {Element} root
   * @param {import("./session.js").Session} session
   * @param {import("./table.js").RuleTable} table
   * @param {() => void} openTable Brings the table into view.
   */
  constructor(root, session, table, openTable) {
    Object.assign(this, { root, session, table, openTable });
    this.picture = new MachinePicture(session, (chosen) => this.#pick(chosen));
    this.elsewhere = h("p", { class: "elsewhere", role: "status", hidden: true });
    this.details = h("div", { class: "machine-details", "aria-live": "polite" });
    identify(this.details, "machine-details");
    root.append(this.picture.node, this.elsewhere, this.details, h("p", { class: "machine-legend" }, LEGEND));
    this.note = h("div", { class: "behind-note", role: "status", hidden: true });
    identify(this.note, "behind-note");
    table.list.before(this.note);
  }

  /** @param {import("./protocol.js").StatesMessage} message */
  update(message) {
    const chosen = this.#machine && this.#chosen && this.#sameIn(message);
    this.#machine = message;
    this.#rates.clear();
    this.picture.draw(message);
    const initial = message.states.findIndex((state) => state.initial);
    this.#choose(chosen || { source: initial, target: null, at: null });
    this.#mark(this.note.hidden ? [] : this.#behind());
  }

  /** @param {import("./protocol.js").ActivityMessage} message */
  live({ time, robots, taken, swarm }) {
    if (taken.length !== this.#machine?.transitions.length) return;
    const { since, rates } = this.#rates.add(time, taken, swarm);
    const lost = swarm - robots.reduce((sum, count) => sum + count, 0);
    this.elsewhere.hidden = lost === 0;
    this.elsewhere.textContent = `${share(lost, swarm)} in none of these states: left in another by rules before. The key R starts again.`;
    if (this.root.hidden) return;
    this.picture.show(robots, since, swarm);
    const here = this.details.querySelector(".count-here");
    if (here) here.textContent = share(robots[this.#chosen.source], swarm);
    for (const [at, row] of this.#rows) {
      const rate = rates?.[at] ?? null;
      row.rate.textContent = rate === null ? "" : `${rate.toFixed(rate < 9.95 ? 1 : 0)}/min`;
      row.node.classList.toggle("taken", since[at] > 0);
    }
  }

  /** The table comes into view: the rules behind the transition that was chosen last do, too. */
  tableShown() {
    this.#awaited?.node.scrollIntoView({ block: "center" });
    this.#awaited = null;
  }

  /** @returns {?Chosen} What stands for what is chosen in another machine, if there is such a thing. */
  #sameIn({ states, transitions }) {
    const find = (at) => states.findIndex(({ label }) => label === this.#machine.states[at].label);
    const source = find(this.#chosen.source);
    if (source < 0 || this.#chosen.target === null) return source < 0 ? null : { source, target: null, at: null };
    const target = find(this.#chosen.target);
    const there = transitions.some((entry) => entry.source === source && entry.target === target);
    return there ? { source, target, at: null } : null;
  }

  /** @param {Chosen} chosen */
  #choose(chosen) {
    this.#chosen = chosen;
    this.picture.choose(chosen);
    this.#describe(chosen);
  }

  /** Something was clicked. */
  #pick(chosen) {
    this.#choose(chosen);
    this.details.firstElementChild.scrollIntoView({ block: "nearest" });
    this.#awaited = this.#mark(this.#behind());
  }

  /** The transitions of what is chosen whose rules are to be marked: none for a state. */
  #behind() {
    return this.#chosen.target === null ? [] : this.#entries(this.#chosen, this.#chosen.at);
  }

  /** The transitions of what is chosen, or the one at an index, with their indices. */
  #entries({ source, target }, only = null) {
    return this.#machine.transitions
      .map((entry, at) => ({ ...entry, at }))
      .filter((entry) => entry.source === source && (target === null || entry.target === target))
      .filter(({ at }) => only === null || at === only);
  }

  #describe(chosen) {
    const { states } = this.#machine;
    const { source, target, at } = chosen;
    const entries = this.#entries(chosen);
    const name = (state) => h("b", {}, this.#lamp(state), states[state].label);
    const title = h("h2", { "data-testid": "machine-title" }, name(source));
    if (target === null) title.append(h("span", { class: "count-here" }));
    else title.append(h("span", { class: "to", "aria-label": "to" }, "→"), name(target));
    const { means, initial } = states[source];
    const start = initial ? " Robots start here." : "";
    const never = entries.length ? "" : " Nothing leads away.";
    const words = target === null ? [h("p", { class: "means" }, `Robots in it are ${means}.${start}${never}`)] : [];
    this.#rows = new Map(entries.map((entry) => [entry.at, this.#row(entry, target === null, entry.at === at)]));
    const list = h("ul", { class: "ways" }, ...[...this.#rows.values()].map(({ node }) => node));
    this.details.replaceChildren(title, ...words, list);
  }

  /** One transition: its condition, how likely it is, what it does, and the rules behind it. */
  #row({ at, target, when, rate, effects, rules }, ends, chosen) {
    const condition = h("b", { class: "when" }, when === "always" ? when : `when ${when}`);
    const end = ends ? [h("span", { class: "end" }, "→ ", this.#lamp(target), this.#machine.states[target].label)] : [];
    const taken = h("span", { class: "rate", title: "taken per robot and simulated minute" });
    const does = effects.map((effect) => h("span", { class: "effect" }, effect));
    const numbers = rules.map((rule) => this.#ruleButton(rule, at));
    const first = h("div", { class: "way-line" }, condition, ...end, h("span", { class: "way-rules" }, ...numbers));
    const second = h("div", { class: "way-line quieter" }, h("span", {}, rate), ...does, taken);
    const node = h("li", { class: chosen ? "way chosen" : "way", "data-testid": `way-${at}` }, first, second);
    return { node, rate: taken };
  }

  #ruleButton(rule, at) {
    const open = () => {
      this.#mark(this.#entries(this.#chosen, at));
      this.#awaited = this.table.cards[rule - 1] ?? null;
      this.openTable();
      this.table.cards[rule - 1]?.toggle.focus({ preventScroll: true });
    };
    const button = h("button", { type: "button", class: "rule-link", onclick: open }, h("i", {}, "R"), h("sub", {}, String(rule)));
    identify(button, `way-${at}-rule-${rule}`, `Show rule ${rule} in the table`);
    return button;
  }

  #lamp(state) {
    const lamp = h("span", { class: "lamp", "aria-hidden": "true" });
    lamp.style.setProperty("--led", this.session.colour(this.#machine.states[state].behaviour));
    return lamp;
  }

  /**
   * Mark the rules behind transitions in the table, and say so above it.
   *
   * @returns {?import("./card.js").RuleCard} The first of them.
   */
  #mark(entries) {
    const rules = new Set(entries.flatMap((entry) => entry.rules));
    const cards = this.table.cards.filter((card) => rules.has(card.index + 1));
    for (const card of this.table.cards) card.node.classList.toggle("behind", cards.includes(card));
    this.note.hidden = cards.length === 0;
    if (!cards.length) return null;
    const [source, target] = [entries[0].source, entries[0].target].map((at) => this.#machine.states[at].label);
    const words = `Behind ${source} → ${target}${entries.length === 1 ? `, ${entries[0].when}` : ""}`;
    const clear = iconButton("remove", "No longer mark these rules", () => this.#mark([]));
    this.note.replaceChildren(h("span", {}, words), clear);
    return cards[0];
  }
}

/** @returns {string} "2 of 4 robots" */
const share = (count, swarm) => `${count} of ${swarm} ${swarm === 1 ? "robot" : "robots"}`;
