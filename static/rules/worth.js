/** What each piece of the rules is worth: a bar at every rule and element. */

import { h, icon, identify, svg } from "../common/dom.js";
import { decimalsFor, interval, signed } from "../common/figures.js";
import { request } from "./protocol.js";

const HEIGHT = 9; // px of a bar's picture

/**
 * @typedef {object} Scale
 * @property {number} least What the longest bar reaches to the left.
 * @property {number} most And to the right.
 * @property {number} decimals Of the numbers beside the bars.
 * @property {string} unit Of these numbers.
 * @property {boolean} maximise More of the objective is better.
 */

/**
 * One scale for all bars. Worth counts to the right: what is lost without the piece.
 *
 * @param {import("./protocol.js").WeighedPiece[]} pieces
 * @param {{unit: string, maximise: boolean}} objective
 * @returns {Scale}
 */
function scaleOf(pieces, { unit, maximise }) {
  const reaches = pieces.flatMap((piece) => Object.values(lost(piece, maximise)));
  const [least, most] = [Math.min(0, ...reaches), Math.max(0, ...reaches)];
  const decimals = decimalsFor(reaches);
  return { least, most: Math.max(most, least + 10 ** (1 - decimals)), decimals, unit, maximise };
}

/** What is lost without a piece, and the ends of its interval; negative if it is gained. */
function lost({ difference, low, high }, maximise) {
  return maximise ? { loss: -difference, from: -high, to: -low } : { loss: difference, from: low, to: high };
}

/** @returns {"needed" | "harmful" | "idle"} "idle" if the interval holds zero. */
const kindOf = ({ from, to }) => (from > 0 ? "needed" : to < 0 ? "harmful" : "idle");

const keyOf = (rule, part, at) => (part === "rule" ? `${rule}` : `${rule} ${part} ${at}`);

/**
 * @param {import("./protocol.js").WeighedPiece} piece
 * @param {Scale} scale
 * @param {string} name What the piece is called.
 */
export function worthBar(piece, { least, most, decimals, unit, maximise }, name) {
  const { difference, low, high } = piece;
  const { loss, from, to } = lost(piece, maximise);
  const kind = kindOf({ from, to });
  const percent = (worth) => (100 * (worth - least)) / (most - least);
  const [zero, end] = [percent(0), percent(loss)];
  const line = (of, x1, x2, y1, y2) => svg("line", { class: of, x1: `${x1}%`, x2: `${x2}%`, y1, y2 });
  const bar = { x: `${Math.min(zero, end)}%`, width: `${Math.abs(end - zero)}%`, y: 1, height: HEIGHT - 2, rx: 1.5 };
  const picture = svg("svg", { height: HEIGHT, "aria-hidden": "true" }, svg("rect", bar));
  picture.append(line("reach", percent(from), percent(to), HEIGHT / 2, HEIGHT / 2));
  picture.append(line("zero", zero, zero, 0, HEIGHT));
  const effect = { needed: "worse", harmful: "better", idle: "no clear difference" }[kind];
  const reach = interval(low, high, decimals);
  const change = `${signed(difference, decimals)} ${unit} (${effect})`;
  const words = `Without ${name}: ${change}, 95 % interval ${reach}`;
  const number = h("b", {}, signed(difference, decimals));
  return h("span", { class: `worth ${kind}`, title: words, role: "img", "aria-label": words }, picture, number);
}

/** The button that starts the evaluation, its progress, and the bars in the table. */
export class Worth {
  /** @type {?import("./protocol.js").WorthMessage} */
  #shown = null;
  #rules = "";
  #changed = 0;
  #objective = { unit: "", maximise: true };

  /**
   * @param {import("./session.js").Session} session
   * @param {import("./table.js").RuleTable} table
   */
  constructor(session, table) {
    this.table = table;
    const button = (id, label, onclick, ...children) =>
      h("button", { type: "button", class: "quiet", "data-testid": id, "aria-label": label, onclick }, ...children);
    const words = [h("span", { class: "long" }, "What is each piece worth?"), h("span", { class: "short" }, "What is each worth?")];
    this.start = button("worth-start", "What is each piece worth?", () => session.command(request.worthStart()), ...words);
    this.start.title = "Takes every rule and element out in turn and runs the swarm without it";
    this.hide = button("worth-hide", "Hide what each piece is worth", () => this.#show(null), "Hide worth");
    this.count = h("span", { class: "runs", role: "status", "data-testid": "worth-progress" });
    this.bar = h("progress", { "aria-label": "Pieces evaluated" });
    const cancel = () => session.command(request.worthCancel());
    this.cancel = button("worth-cancel", "Stop evaluating the pieces", cancel, icon("remove"), "Cancel");
    this.running = h("span", { class: "worth-tools", hidden: true }, this.bar, this.count, this.cancel);
    this.node = h("span", { class: "worth-tools" }, this.start, this.running, this.hide);
    this.hide.hidden = true;
    this.legend = h("div", { class: "worth-legend", hidden: true });
    identify(this.legend, "worth-legend");
    this.title = h("span", { class: "title" });
    this.legend.append(this.title, h("span", { class: "needed" }, "needed"));
    this.legend.append(h("span", { class: "harmful" }, "harmful"), h("span", {}, "no clear difference"));
  }

  /** @param {import("./protocol.js").ObjectiveOffer} objective */
  measure({ expression, unit, maximise }) {
    this.#objective = { unit: unit || expression, maximise };
    this.title.textContent = `Gained or lost without the piece (${unit || expression}):`;
  }

  /**
   * Bars belong to the rules they were measured on.
   *
   * @param {import("./protocol.js").RulesMessage} message
   */
  rulesChanged({ version, rule_set: { rules } }) {
    const text = JSON.stringify(rules.map((rule) => ({ ...rule, comment: "" })));
    if (text === this.#rules) return;
    if (this.#rules) this.#changed = version;
    this.#rules = text;
    this.#show(null);
  }

  /** @param {import("./protocol.js").WorthMessage} message */
  update(message) {
    if (message.version < this.#changed) return;
    this.running.hidden = !message.busy;
    this.bar.max = Math.max(1, message.total);
    this.bar.value = message.done;
    this.count.textContent = `${message.done} of ${message.total}`;
    this.#show(message);
  }

  /** Put the bars where they belong, or take them away. */
  #show(message) {
    const pieces = message?.pieces ?? [];
    if (!message) this.running.hidden = true;
    const busy = !this.running.hidden;
    const had = this.#shown !== null;
    this.#shown = pieces.length ? message : null;
    this.start.hidden = busy || pieces.length > 0;
    this.hide.hidden = busy || pieces.length === 0;
    this.legend.hidden = pieces.length === 0;
    if (!had && !pieces.length) return;
    const scale = scaleOf(pieces, this.#objective);
    const found = new Map(pieces.map((piece) => [keyOf(piece.rule, piece.part, piece.at), piece]));
    const bar = (name, ...place) => {
      const piece = found.get(keyOf(...place));
      return piece ? worthBar(piece, scale, name) : null;
    };
    for (const card of this.table.cards) card.showWorth(bar);
  }
}
