/** The elements of a rule: preconditions, behaviours and actions, each as a chip. */

import { h, iconButton, identify } from "../common/dom.js";
import { menuButton } from "../common/menu.js";
import { probabilityField } from "./probability.js";

/** What all chips have in common: a place in a rule, a remove button and findings. */
class Chip {
  index = -1;

  /**
   * @param {import("./card.js").RuleCard} card
   * @param {import("./protocol.js").Part} part
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

  /** @param {(element: any) => any} change Makes the new element from the present one. */
  set(change) {
    return this.card.edit((rule) => {
      const element = change(this.item);
      const same = JSON.stringify(element) === JSON.stringify(this.item);
      return same ? null : this.#place(rule, "set", { element });
    });
  }

  remove() {
    return this.card.edit((rule) => this.#place(rule, "remove"));
  }

  #place(rule, what, more = {}) {
    return this.index < 0 ? null : { do: what, rule, part: this.part, at: this.index, ...more };
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
    this.value = h("button", {
      type: "button",
      class: "truth",
      onclick: () => this.set(({ name, holds }) => ({ name, holds: !holds })),
    });
    this.body.append(this.name, h("span", { class: "sign" }, "=="), this.value);
  }

  show({ name, holds }, where) {
    this.name.textContent = name;
    this.value.textContent = String(holds);
    this.value.dataset.value = String(holds);
    const entry = this.card.session.vocabulary.preconditions.find((known) => known.name === name);
    this.value.title = entry ? (holds ? entry.holds : entry.fails) : "";
    identify(this.name, `${this.id}-name`, `Change ${where}, now ${name}`);
    identify(this.value, `${this.id}-value`, `${name} is ${holds}: change to ${!holds}`);
  }

  #names() {
    return this.card
      .absent("preconditions")
      .map(({ name, holds }) => ({
        id: name,
        label: name,
        detail: holds,
        choose: () => this.set((element) => ({ name, holds: element.holds })),
      }));
  }
}

export class BehaviourChip extends Chip {
  constructor(card) {
    super(card, "behaviours");
    this.name = menuButton({ class: "word" }, () => this.#names());
    this.body.append(h("span", { class: "lamp", "aria-hidden": "true" }), this.name);
    this.node.classList.add("lit");
  }

  show(name, where) {
    this.name.textContent = name;
    this.paint(name);
    identify(this.name, `${this.id}-name`, `Change ${where}, now ${name}`);
  }

  #names() {
    return this.card
      .absent("behaviours")
      .map(({ name, doing, colour }) => ({
        id: name,
        label: name,
        detail: doing,
        colour,
        choose: () => this.set(() => name),
      }));
  }
}

export class ActionChip extends Chip {
  constructor(card) {
    super(card, "actions");
    this.p = probabilityField(card.session, (p) => this.set((action) => ({ ...action, p })));
    this.lamp = h("span", { class: "lamp", "aria-hidden": "true" });
    this.target = menuButton({ class: "word" }, () => this.#targets());
    this.assigns = h("span", { class: "sign" }, "←");
    this.value = h("button", {
      type: "button",
      class: "truth",
      onclick: () => this.set((action) => ({ ...action, value: !action.value })),
    });
    const equals = h("span", { class: "sign" }, "=");
    const p = h("label", { class: "p" }, h("i", {}, "p"), equals, this.p.node);
    this.body.append(p, h("span", { class: "sign arrow" }, "→"), this.lamp, this.target);
    this.body.append(this.assigns, this.value);
  }

  show(action, where) {
    const changesBehaviour = "behaviour" in action;
    const name = changesBehaviour ? action.behaviour : action.state;
    this.node.classList.toggle("lit", changesBehaviour);
    this.paint(name);
    this.target.textContent = name;
    for (const node of [this.assigns, this.value]) node.hidden = changesBehaviour;
    this.lamp.hidden = !changesBehaviour;
    this.p.update(action.p, `${this.id}-p`, `Probability of ${where}, ${name}`);
    identify(this.target, `${this.id}-target`, `Change ${where}, now ${name}`);
    if (changesBehaviour) return;
    this.value.textContent = String(action.value);
    this.value.dataset.value = String(action.value);
    const label = `${name} becomes ${action.value}: change to ${!action.value}`;
    identify(this.value, `${this.id}-value`, label);
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
 * @param {import("./protocol.js").Vocabulary} vocabulary
 * @param {(element: object) => void} choose Called with the action but for its probability.
 */
export function actionChoices(vocabulary, choose) {
  const changes = vocabulary.behaviours.map(({ name, doing, colour }) => ({
    id: name,
    label: name,
    detail: `start ${doing}`,
    colour,
    choose: () => choose({ behaviour: name }),
  }));
  const assignments = vocabulary.internal_states.flatMap(({ name, on, off }) =>
    [true, false].map((value) => ({
      id: `${name}-${value}`,
      label: `${name} ← ${value}`,
      detail: value ? on : off,
      choose: () => choose({ state: name, value }),
    })),
  );
  if (assignments.length) assignments[0].divided = true;
  return [...changes, ...assignments];
}
