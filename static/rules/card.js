/** One rule in the paper's layout: explanation, then preconditions, behaviours and actions. */

import { focusAnswer, h, icon, iconButton, identify, reconcile } from "../common/dom.js";
import { menuButton } from "../common/menu.js";
import { ActionChip, BehaviourChip, PreconditionChip, actionChoices, precondition, says } from "./chips.js";
import { makeDraggable } from "./drag.js";
import { draftField, growing } from "./field.js";
import { findingLine } from "./finding.js";
import { edits } from "./protocol.js";
import { isTruth, offered, plainTerm, written } from "./terms.js";

const PARTS = [
  {
    part: "preconditions",
    letter: "P",
    Chip: PreconditionChip,
    empty: "always",
    hint: "all must hold",
  },
  {
    part: "behaviours",
    letter: "B",
    Chip: BehaviourChip,
    empty: "any behaviour",
    hint: "the current one must be among them",
  },
  {
    part: "actions",
    letter: "A",
    Chip: ActionChip,
    empty: "no action yet",
    hint: "each drawn on its own, in this order",
  },
];

/** One row of a rule: label, chips, "+". */
class PartRow {
  chips = [];

  constructor(card, { part, letter, Chip, empty, hint }) {
    Object.assign(this, { card, part, Chip, singular: part.slice(0, -1) });
    this.subscript = h("sub");
    this.label = h(
      "div",
      { class: "part-label", title: `${part}: ${hint}` },
      h("i", {}, letter),
      this.subscript,
      h("span", { class: "part-word" }, part),
    );
    const epsilon = part === "actions" ? [] : [h("i", {}, "ε"), " "];
    this.empty = h("span", { class: "empty" }, ...epsilon, empty);
    this.list = h("span", { class: "chips" });
    this.plus = menuButton({ class: "tool plus" }, () => card.additions(part), icon("add"));
    this.node = h("div", { class: "part", role: "group" }, this.label);
    this.node.append(h("div", { class: "part-body" }, this.empty, this.list, this.plus));
  }

  update(items) {
    const before = this.chips.length;
    this.chips = reconcile(this.list, this.chips, items, () => new this.Chip(this.card));
    const rule = this.card.index + 1;
    this.subscript.textContent = rule;
    this.empty.hidden = items.length > 0;
    this.plus.hidden = this.part !== "actions" && this.card.absent(this.part).length === 0;
    this.plus.title = `Add ${this.singular}`;
    identify(this.node, `rule-${rule}-${this.part}`, `Rule ${rule}, ${this.part}`);
    identify(this.plus, `rule-${rule}-add-${this.singular}`, `Add ${this.singular} to rule ${rule}`);
    if (items.length <= before) return;
    const { p } = this.chips.at(-1);
    if (this.awaited && p) focusAnswer(this.plus, p);
    this.awaited = false;
  }
}

export class RuleCard {
  index = -1;

  /** @param {import("./session.js").Session} session */
  constructor(session) {
    this.session = session;
    this.rows = Object.fromEntries(PARTS.map((part) => [part.part, new PartRow(this, part)]));
    this.node = h("article", { class: "rule" });
    this.node.append(this.#gutter(), this.#heading(), this.#tools());
    this.node.append(...Object.values(this.rows).map((row) => row.node));
    this.findings = h("ul", { class: "findings" });
    this.node.append(this.findings);
  }

  /**
   * @param {(rule: number) => ?object} make Makes the edit, given where this rule is by then.
   * @param {() => void} [refused] Called if it was not made.
   * @returns {boolean} False if there is no connection.
   */
  edit(make, refused) {
    return this.session.edit(() => (this.index < 0 ? null : make(this.index)), refused);
  }

  move(by) {
    const last = this.session.state.rule_set.rules.length - 1;
    this.edit((rule) => {
      const to = rule + by;
      return to < 0 || to > last ? null : edits.moveRule(rule, to);
    });
  }

  duplicate() {
    this.edit((rule) => edits.duplicateRule(rule));
  }

  remove() {
    this.edit((rule) => edits.removeRule(rule));
  }

  /** Vocabulary entries of a part that this rule does not mention yet, or can mention again. */
  absent(part) {
    const present = new Set(this.rule[part].map((element) => (element.percept ?? element).name));
    const again = ({ arguments: taken, values }) => taken.length > 0 || (values && !isTruth(values));
    return this.session.vocabulary[part].filter((entry) => again(entry) || !present.has(entry.name));
  }

  /** @returns {import("./protocol.js").RuleFinding[]} */
  findingsAt(element) {
    return this.session.state.findings.filter(
      (finding) => finding.rule === this.index + 1 && (!element || finding.element === element),
    );
  }

  /** What the "+" of a part offers. */
  additions(part) {
    const { vocabulary } = this.session;
    if (part === "preconditions") {
      return this.absent(part).flatMap((entry) => {
        const wanted = isTruth(entry.values) ? [true, false] : [null];
        return wanted.map((truth) => {
          const element = precondition(entry, truth);
          return {
            id: `${entry.name}-${element.value}`,
            label: `${written(element.percept)} ${element.comparison} ${element.value}`,
            detail: says(entry, element),
            choose: () => this.#add(part, element),
          };
        });
      });
    }
    if (part === "behaviours") {
      return this.absent(part).map((entry) => ({
        ...offered(entry),
        choose: () => this.#add(part, plainTerm(entry)),
      }));
    }
    return actionChoices(vocabulary, (element) => this.#add(part, { p: 1, ...element }));
  }

  update(rule, index) {
    this.rule = rule;
    this.index = index;
    const { rule_set, english = [] } = this.session.state;
    const last = rule_set.rules.length - 1;
    const shown = JSON.stringify([rule, index, index === last, this.findingsAt(), english[index]]);
    if (shown === this.shown && !this.node.querySelector("[data-draft]")) return;
    this.shown = shown;
    const number = index + 1;
    identify(this.node, `rule-${number}`, `Rule ${number}`);
    this.node.classList.toggle("off", !rule.enabled);
    this.number.textContent = number;
    identify(this.handle, `rule-${number}-handle`);
    identify(this.rate, `rule-${number}-rate`);
    identify(this.toggle, `rule-${number}-enabled`, `Rule ${number} is switched on`);
    this.toggle.setAttribute("aria-checked", String(rule.enabled));
    identify(this.comment, `rule-${number}-comment`, `Explanation of rule ${number}`);
    this.draft.update(rule.comment);
    this.english.textContent = english[index] ?? "";
    identify(this.english, `rule-${number}-english`);
    for (const [name, button] of Object.entries(this.tools)) {
      identify(button, `rule-${number}-${name}`, `${button.title} ${number}`);
    }
    this.tools.up.disabled = index === 0;
    this.tools.down.disabled = index === last;
    for (const [part, row] of Object.entries(this.rows)) row.update(rule[part]);
    this.#showFindings();
  }

  /** True while somebody types in this rule; a cursor alone is moved on by what this page asked for. */
  get typing() {
    const { chips } = this.rows.actions;
    return this.draft.typing(!this.session.asking) || chips.some((chip) => chip.typing);
  }

  /** This rule is gone. */
  drop() {
    this.draft.giveUp(!this.session.asking);
    for (const chip of this.rows.actions.chips) chip.drop();
  }

  /** @param {number} heat Times that the rule has just fired, per robot. */
  showFiring(heat) {
    this.node.classList.toggle("fired", heat > 0);
    if (heat > 0) this.node.style.setProperty("--heat", (0.35 + 0.65 * Math.min(1, heat)).toFixed(2));
  }

  /** @param {?number} rate Times per robot and simulated minute; null while unknown. */
  showRate(rate) {
    const text = rate === null || !this.rule.enabled ? "" : `${rate.toFixed(rate < 9.95 ? 1 : 0)}/min`;
    if (this.rate.textContent !== text) this.rate.textContent = text;
  }

  /** @param {(name: string, rule: number, part: string, at?: number) => ?Element} bar */
  showWorth(bar) {
    const whole = bar(`rule ${this.index + 1}`, this.index, "rule");
    if (whole) {
      whole.append(h("span", { class: "worth-words" }, "without this rule"));
      identify(whole, `rule-${this.index + 1}-worth`);
    }
    this.whole.replaceChildren(...(whole ? [whole] : []));
    for (const row of Object.values(this.rows)) {
      for (const chip of row.chips) {
        const { part, singular, index, id } = chip;
        chip.weigh(bar(`${singular} ${index + 1} of rule ${this.index + 1}`, this.index, part, index), id);
      }
    }
  }

  #add(part, element) {
    this.rows[part].awaited = true;
    this.edit((rule) => edits.add(rule, part, this.rule[part].length, element));
  }

  #gutter() {
    this.number = h("sub");
    this.rate = h("span", { class: "rate", title: "fired per robot and simulated minute" });
    this.toggle = h(
      "button",
      {
        type: "button",
        class: "switch",
        role: "switch",
        title: "Switch this rule on or off",
        onclick: () =>
          this.edit((rule) => edits.setEnabled(rule, !this.rule.enabled)),
      },
      h("span", { class: "knob" }),
    );
    const handle = { class: "badge", title: "Drag to move this rule" };
    this.handle = h("div", handle, h("i", {}, "R"), this.number);
    makeDraggable(this, this.handle);
    return h("div", { class: "gutter" }, this.handle, this.rate, this.toggle);
  }

  #heading() {
    this.comment = h("textarea", {
      rows: 1,
      cols: 1,
      class: "comment",
      placeholder: "Say what this rule is for",
      spellcheck: "false",
    });
    const wrapper = growing(this.comment);
    this.draft = draftField(this.comment, {
      tidy: (text) => text.trim(),
      commit: (comment, refused) => this.edit((rule) => edits.setComment(rule, comment), refused),
      keep: (text, cursor) =>
        this.session.keep({
          what: `The explanation of R${this.index + 1}`,
          text,
          cursor,
          rule: this.rule,
          edit: (comment, rule) => edits.setComment(rule, comment),
        }),
      changed: wrapper.fit,
    });
    this.english = h("p", { class: "english" });
    this.whole = h("div", { class: "whole" });
    return h("div", { class: "heading" }, wrapper.node, this.english, this.whole);
  }

  #tools() {
    this.tools = {
      up: iconButton("up", "Move up rule", () => this.move(-1)),
      down: iconButton("down", "Move down rule", () => this.move(1)),
      duplicate: iconButton("duplicate", "Duplicate rule", () => this.duplicate()),
      delete: iconButton("trash", "Delete rule", () => this.remove()),
    };
    const toggle = () => {
      this.node.classList.toggle("show-hints");
      this.#showFindings();
    };
    this.hints = h("button", { type: "button", class: "tool hints" });
    this.hints.addEventListener("click", toggle);
    return h("div", { class: "tools" }, this.hints, ...Object.values(this.tools));
  }

  /** Hints are true but harmless: they wait behind a button. */
  #showFindings() {
    const all = this.findingsAt();
    const hints = all.filter((finding) => finding.severity === "hint").map(sayFinding);
    const open = this.node.classList.contains("show-hints");
    const shown = open ? all : all.filter((finding) => finding.severity !== "hint");
    this.findings.replaceChildren(
      ...shown.map((finding) => findingLine(finding.severity, sayFinding(finding))),
    );
    this.findings.hidden = shown.length === 0;
    this.hints.replaceChildren(icon("hint"), String(hints.length));
    this.hints.hidden = hints.length === 0;
    this.hints.title = hints.join("\n");
    this.hints.setAttribute("aria-expanded", String(open));
    const number = this.index + 1;
    const label = `Hints on rule ${number}: ${hints.length}`;
    identify(this.hints, `rule-${number}-hints`, label);
  }
}

const sayFinding = ({ element, message }) => (element ? `${element}: ${message}` : message);
