/** Terms as rules mention them, `IS_CLOSE_TO(3)`, and how they are chosen. */

import { h, identify } from "../common/dom.js";
import { menuButton } from "../common/menu.js";

/** @param {import("./protocol.js").Term} term */
export const written = ({ name, arguments: values }) => (values.length ? `${name}(${values.join(", ")})` : name);

/** The middle one of what is offered: the ends are rarely what is wanted. */
export const middle = (offered) => offered[Math.floor((offered.length - 1) / 2)];

/** A term of an entry of the vocabulary, with the middle one of what is offered in its parentheses. */
export const plainTerm = ({ name, arguments: taken }) => ({
  name,
  arguments: taken.map(({ offered }) => middle(offered)),
});

export const entryOf = (entries, name) => entries.find((entry) => entry.name === name);

/** Words of the vocabulary with what stands in their braces; what is not known yet is named. */
export const fill = (words, values = {}) => words.replace(/\{(\w+)\}/g, (_, name) => values[name] ?? name);

/** The arguments of a term by name, as words take them. */
export const named = (entry, term) =>
  Object.fromEntries(entry.arguments.map(({ name }, at) => [name, term.arguments[at]]));

/** A behaviour of the vocabulary as menus offer it: with the arguments that it would have at first. */
export function offered(entry) {
  const term = plainTerm(entry);
  return { id: entry.name, label: written(term), detail: fill(entry.doing, named(entry, term)), colour: entry.colour };
}

export const isTruth = (values) => typeof values[0] === "boolean";

/** One value: true or false change places at a click, all others are chosen from a menu. */
export class ValueButton {
  /**
   * @param {() => (string | number | boolean)[]} values What is offered.
   * @param {(value: string | number | boolean) => void} choose
   */
  constructor(values, choose) {
    this.toggle = h("button", { type: "button", class: "truth", onclick: () => choose(!this.value) });
    this.menu = menuButton({ class: "word value" }, () =>
      values().map((value) => ({ id: String(value), label: String(value), choose: () => choose(value) })),
    );
    this.node = h("span", { class: "value-button" });
  }

  update(value, id, label) {
    this.value = value;
    const truth = typeof value === "boolean";
    const button = truth ? this.toggle : this.menu;
    if (this.node.firstChild !== button) this.node.replaceChildren(button);
    button.textContent = String(value);
    button.dataset.value = String(value);
    identify(button, id, truth ? `${label}: change to ${!value}` : `Change ${label}`);
    return button;
  }
}

/** What stands in the parentheses of a term. */
export class Arguments {
  node = h("span", { class: "arguments" });
  buttons = [];

  /** @param {(values: (string | number)[]) => void} choose */
  constructor(choose) {
    this.choose = choose;
  }

  /** @param {?object} entry Of the vocabulary; null if it does not know the term. */
  update(term, entry, id) {
    const taken = entry?.arguments ?? [];
    if (this.entry !== entry) {
      this.entry = entry;
      this.buttons = taken.map(
        ({ offered }, at) => new ValueButton(() => offered, (value) => this.#set(at, value)),
      );
      const parts = this.buttons.flatMap(({ node }, at) => (at ? [", ", node] : [node]));
      this.node.replaceChildren(...(parts.length ? ["(", ...parts, ")"] : []));
    }
    this.term = term;
    taken.forEach(({ name, unit }, at) => {
      const value = term.arguments[at];
      const label = `${name} of ${term.name}, now ${value}${unit ? ` ${unit}` : ""}`;
      this.buttons[at].update(value, `${id}-${name}`, label);
    });
  }

  #set(at, value) {
    this.choose(this.term.arguments.map((old, place) => (place === at ? value : old)));
  }
}
