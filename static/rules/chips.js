/** The elements of a rule: preconditions, behaviours and actions, each as a chip. */

import { h, iconButton, identify } from "../common/dom.js";
import { menuButton } from "../common/menu.js";
import { parseProbability, probabilityField } from "./probability.js";
import { edits } from "./protocol.js";
import { Arguments, ValueButton, entryOf, fill, isTruth, middle, named, offered, plainTerm, written } from "./terms.js";

/** What all chips have in common: a place in a rule, a remove button and findings. */
class Chip {
  index = -1;

  /**
   * @param {import("./card.js").RuleCard} card
   * @param {import("./protocol.js").RulePart} part
   */
  constructor(card, part) {
    this.card = card;
    this.part = part;
    this.singular = part.slice(0, -1);
    this.body = h("span", { class: "chip-body" });
    this.removeButton = iconButton("remove", "Remove", () => this.remove(), { class: "chip-remove" });
    this.node = h("span", { class: `chip ${this.singular}`, role: "group" });
    this.node.append(this.body, this.removeButton);
  }

  /**
   * @param {(element: any) => any} change Makes the new element from the present one.
   * @param {() => void} [refused] Called if it was not made.
   */
  set(change, refused) {
    return this.card.edit((rule) => {
      const element = change(this.item);
      const same = JSON.stringify(element) === JSON.stringify(this.item);
      return same || this.index < 0 ? null : edits.set(rule, this.part, this.index, element);
    }, refused);
  }

  remove() {
    return this.card.edit((rule) => (this.index < 0 ? null : edits.remove(rule, this.part, this.index)));
  }

  update(item, index) {
    this.item = item;
    this.index = index;
    const where = `rule ${this.card.index + 1}, ${this.singular} ${index + 1}`;
    this.id = `rule-${this.card.index + 1}-${this.singular}-${index + 1}`;
    identify(this.node, this.id, where);
    identify(this.removeButton, `${this.id}-remove`, `Remove ${where}`);
    const findings = this.card.findingsAt(`${this.singular} ${index + 1}`);
    const serious = findings.some((finding) => finding.severity !== "hint");
    this.node.classList.toggle("has-warning", serious);
    this.node.classList.toggle("has-hint", findings.length > 0 && !serious);
    this.node.title = findings.map((finding) => finding.message).join("\n");
    this.show(item, where);
  }

  /** @param {?Element} bar What this element is worth; null to show nothing. */
  weigh(bar, id) {
    this.bar?.remove();
    this.bar = bar;
    this.node.classList.toggle("weighed", bar !== null);
    if (!bar) return;
    identify(bar, `${id}-worth`);
    this.node.append(bar);
  }

  paint(behaviour) {
    this.node.style.setProperty("--led", this.card.session.colour(behaviour));
  }
}

export class PreconditionChip extends Chip {
  constructor(card) {
    super(card, "preconditions");
    this.name = menuButton({ class: "word" }, () => this.#names());
    this.arguments = new Arguments((values) =>
      this.set((element) => ({ ...element, percept: { ...element.percept, arguments: values } })),
    );
    this.sign = menuButton({ class: "sign" }, () =>
      this.entry.comparisons.map((comparison) => ({
        id: comparison,
        label: comparison,
        choose: () => this.set((element) => ({ ...element, comparison })),
      })),
    );
    this.equals = h("span", { class: "sign" }, "==");
    this.value = new ValueButton(
      () => this.entry.values,
      (value) => this.set((element) => ({ ...element, value })),
    );
    this.body.append(this.name, this.arguments.node, this.equals, this.sign, this.value.node);
  }

  show({ percept, comparison, value }, where) {
    const { name } = percept;
    const entry = entryOf(this.card.session.vocabulary.preconditions, name);
    this.entry = entry ?? { arguments: [], comparisons: ["=="], values: [false, true] };
    this.name.textContent = name;
    this.arguments.update(percept, entry, this.id);
    const plain = typeof value === "boolean" && comparison === "==";
    this.equals.hidden = !plain;
    this.sign.hidden = plain;
    this.sign.textContent = comparison;
    const button = this.value.update(value, `${this.id}-value`, `${name} is ${value}`);
    button.title = entry ? says(entry, { percept, comparison, value }) : "";
    identify(this.name, `${this.id}-name`, `Change ${where}, now ${name}`);
    identify(this.sign, `${this.id}-sign`, `Change how ${name} is compared, now ${comparison}`);
  }

  #names() {
    return this.card.absent("preconditions").map((entry) => {
      const element = precondition(entry, this.item.value);
      const choose = () => this.set(() => element);
      return { id: entry.name, label: written(element.percept), detail: says(entry, element), choose };
    });
  }
}

/** A precondition on an entry of the vocabulary; with the value, if it can be compared with it. */
export function precondition(entry, value) {
  const { values, comparisons } = entry;
  const counts = typeof values[0] === "number";
  const first = counts ? middle(values) : values.at(-1);
  const comparison = counts && comparisons.includes(">=") ? ">=" : comparisons[0];
  return { percept: plainTerm(entry), value: values.includes(value) ? value : first, comparison };
}

const COMPARED = { "==": "exactly", "!=": "other than", ">=": "at least", "<=": "at most", ">": "more than", "<": "less than" };

/** A precondition in words. */
export function says(entry, { percept, comparison, value }) {
  const denied = isTruth(entry.values) ? value !== (comparison === "==") : comparison === "!=";
  return fill(denied && entry.fails ? entry.fails : entry.holds, { ...named(entry, percept), comparison: COMPARED[comparison], value });
}

export class BehaviourChip extends Chip {
  constructor(card) {
    super(card, "behaviours");
    this.name = menuButton({ class: "word" }, () => this.#names());
    this.arguments = new Arguments((values) => this.set((term) => ({ ...term, arguments: values })));
    this.body.append(h("span", { class: "lamp", "aria-hidden": "true" }), this.name, this.arguments.node);
    this.node.classList.add("lit");
  }

  show(term, where) {
    this.name.textContent = term.name;
    this.arguments.update(term, entryOf(this.card.session.vocabulary.behaviours, term.name), this.id);
    this.paint(term);
    identify(this.name, `${this.id}-name`, `Change ${where}, now ${term.name}`);
  }

  #names() {
    const choose = (entry) => () => this.set(() => plainTerm(entry));
    return this.card.absent("behaviours").map((entry) => ({ ...offered(entry), choose: choose(entry) }));
  }
}

export class ActionChip extends Chip {
  constructor(card) {
    super(card, "actions");
    const commit = (p, refused) => this.set((action) => ({ ...action, p }), refused);
    this.p = probabilityField(card.session, commit, (text, cursor) => this.#keep(text, cursor));
    this.lamp = h("span", { class: "lamp", "aria-hidden": "true" });
    this.target = menuButton({ class: "word" }, () => this.#targets());
    this.arguments = new Arguments((values) =>
      this.set((action) => ({ ...action, behaviour: { ...action.behaviour, arguments: values } })),
    );
    this.assigns = h("span", { class: "sign" });
    this.value = new ValueButton(
      () => entryOf(card.session.vocabulary.internal_states, this.item.state)?.values ?? [],
      (value) => this.set((action) => ({ ...action, value })),
    );
    const equals = h("span", { class: "sign" }, "=");
    const p = h("label", { class: "p" }, h("i", {}, "p"), equals, this.p.node);
    this.body.append(p, h("span", { class: "sign arrow" }, "→"), this.lamp, this.target);
    this.body.append(this.arguments.node, this.assigns, this.value.node);
  }

  show(action, where) {
    const { behaviour, state, value, operation } = action;
    const name = behaviour?.name ?? state;
    this.node.classList.toggle("lit", Boolean(behaviour));
    if (behaviour) this.paint(behaviour);
    this.target.textContent = name;
    const entry = behaviour && entryOf(this.card.session.vocabulary.behaviours, name);
    this.arguments.update(behaviour, entry, this.id);
    for (const node of [this.assigns, this.value.node]) node.hidden = Boolean(behaviour);
    this.lamp.hidden = !behaviour;
    this.p.update(action.p, `${this.id}-p`, `Probability of ${where}, ${name}`);
    identify(this.target, `${this.id}-target`, `Change ${where}, now ${name}`);
    if (behaviour) return;
    this.assigns.textContent = operation === "=" ? "←" : operation;
    this.value.update(value, `${this.id}-value`, `${name} becomes ${value}`);
  }

  /** True while somebody types here; a cursor alone is moved on by what this page asked for. */
  get typing() {
    return this.p.typing(!this.card.session.asking);
  }

  /** This action is gone. */
  drop() {
    this.p.giveUp(!this.card.session.asking);
  }

  #keep(text, cursor) {
    const { item, index: at, part, card } = this;
    const edit = (typed, rule) => {
      const p = parseProbability(typed);
      return Number.isNaN(p) ? null : edits.set(rule, part, at, { ...item, p });
    };
    const what = `The probability of ${item.behaviour?.name ?? item.state} in R${card.index + 1}`;
    card.session.keep({ what, text, cursor, rule: card.rule, edit });
  }

  #targets() {
    return actionChoices(this.card.session.vocabulary, (element) =>
      this.set(({ p }) => ({ p, ...element })),
    );
  }
}

/**
 * Everything that an action can do, as menu choices.
 *
 * @param {import("./protocol.js").VocabularyMessage} vocabulary
 * @param {(element: object) => void} choose Called with the action but for its probability.
 */
export function actionChoices(vocabulary, choose) {
  const changes = vocabulary.behaviours.map((entry) => ({
    ...offered(entry),
    detail: `start ${offered(entry).detail}`,
    choose: () => choose({ behaviour: plainTerm(entry) }),
  }));
  const assignments = vocabulary.internal_states.flatMap(({ name, on, off, values, counts }) => {
    const set = counts ? values.slice(0, 1) : [...values].reverse();
    const steps = counts ? ["+=", "-="].map((operation) => ({ operation, value: 1 })) : [];
    return [...steps, ...set.map((value) => ({ operation: "=", value }))].map(({ operation, value }) => ({
      id: `${name}-${operation === "=" ? value : operation}`,
      label: `${name} ${operation === "=" ? "←" : operation} ${value}`,
      detail: operation === "=" ? fill(value === false ? off : on, { value }) : "",
      choose: () => choose({ state: name, value, operation }),
    }));
  });
  if (assignments.length) assignments[0].divided = true;
  return [...changes, ...assignments];
}
