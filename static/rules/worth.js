/** What each piece of the rules is worth: a bar at every rule and element. */

import { h, icon, identify, svg } from "../common/dom.js";
import { interval, signed } from "../common/figures.js";
import { request } from "./protocol.js";

const HEIGHT = 9; // px of a bar's picture

/** @typedef {{least: number, most: number}} Scale What the longest bars reach on either side. */

/**
 * One scale for all bars. Worth counts to the right: what is lost without the piece.
 *
 * @param {import("./protocol.js").WeighedPiece[]} pieces
 * @returns {Scale}
 */
function scaleOf(pieces) {
  const least = Math.min(0, ...pieces.map((piece) => -piece.high));
  const most = Math.max(0, ...pieces.map((piece) => -piece.low));
  return { least, most: Math.max(most, least + 1) };
}

/** @returns {"needed" | "harmful" | "idle"} "idle" if the interval holds zero. */
const kindOf = ({ low, high }) => (high < 0 ? "needed" : low > 0 ? "harmful" : "idle");

const keyOf = (rule, part, at) => (part === "rule" ? `${rule}` : `${rule} ${part} ${at}`);

/**
 * @param {import("./protocol.js").WeighedPiece} piece
 * @param {Scale} scale
 * @param {string} name What the piece is called.
 */
export function worthBar(piece, { least, most }, name) {
  const { difference, low, high } = piece;
  const percent = (worth) => (100 * (worth - least)) / (most - least);
  const [zero, end] = [percent(0), percent(-difference)];
  const line = (kind, from, to, y1, y2) =>
    svg("line", { class: kind, x1: `${from}%`, x2: `${to}%`, y1, y2 });
  const bar = { x: `${Math.min(zero, end)}%`, width: `${Math.abs(end - zero)}%`, y: 1, height: HEIGHT - 2, rx: 1.5 };
  const picture = svg("svg", { height: HEIGHT, "aria-hidden": "true" }, svg("rect", bar));
  picture.append(line("reach", percent(-high), percent(-low), HEIGHT / 2, HEIGHT / 2));
  picture.append(line("zero", zero, zero, 0, HEIGHT));
  const effect = { needed: "worse", harmful: "better", idle: "no clear difference" }[kindOf(piece)];
  const words = `Without ${name}: ${signed(difference)} (${effect}), 95 % interval ${interval(low, high)}`;
  const number = h("b", {}, signed(difference));
  return h("span", { class: `worth ${kindOf(piece)}`, title: words, role: "img", "aria-label": words }, picture, number);
}

/** The button that starts the evaluation, its progress, and the bars in the table. */
export class Worth {
  /** @type {?import("./protocol.js").WorthMessage} */
  #shown = null;
  #rules = "";
  #changed = 0;

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
    const title = h("span", { class: "title" }, "Objects gained or lost without the piece:");
    this.legend.append(title, h("span", { class: "needed" }, "needed"));
    this.legend.append(h("span", { class: "harmful" }, "harmful"), h("span", {}, "no clear difference"));
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
    const scale = scaleOf(pieces);
    const found = new Map(pieces.map((piece) => [keyOf(piece.rule, piece.part, piece.at), piece]));
    const bar = (name, ...place) => {
      const piece = found.get(keyOf(...place));
      return piece ? worthBar(piece, scale, name) : null;
    };
    for (const card of this.table.cards) card.showWorth(bar);
  }
}
