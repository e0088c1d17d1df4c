/** The probability of an action: typed, chosen among the vocabulary's values, or dragged. */

import { h, identify } from "../common/dom.js";
import { placeBelow } from "../common/menu.js";
import { draftField } from "./field.js";

const STEP = 0.1; // s, one control step
const SMALLEST = 0.001; // left end of the slider

/** @returns {number} The probability that a text says; NaN if it says none. Accepts 0,05 and 5 %. */
export function parseProbability(text) {
  const [, digits, percent] = text.trim().replace(",", ".").match(/^(\S+?)\s*(%?)$/) ?? [];
  const value = Number(digits ?? NaN) / (percent ? 100 : 1);
  return value >= 0 && value <= 1 ? Number(value.toPrecision(12)) : NaN;
}

const tidy = (text) => {
  const value = parseProbability(text);
  return Number.isNaN(value) ? text.trim() : String(value);
};

const EXPECTED = "p is a number from 0 to 1, for example 0.05";
const problem = (text) => (Number.isNaN(parseProbability(text)) ? EXPECTED : null);

/** What a probability per control step means for the time that an action takes. */
export function meaning(p) {
  if (Number.isNaN(p)) return EXPECTED;
  if (p === 0) return "never";
  if (p === 1) return "in every control step, at once";
  return `on average after ${round(1 / p)} control steps, ${round(STEP / p)} s`;
}

const round = (x) => Number(x.toPrecision(x < 100 ? 2 : 3)).toLocaleString("en");

/**
 * @param {import("./session.js").Session} session
 * @param {(p: number, refused: () => void) => boolean} commit
 * @param {import("./field.js").Keep} keep
 */
export function probabilityField(session, commit, keep) {
  const input = h("input", {
    class: "p-input",
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    spellcheck: "false",
  });
  const control = { input, session, values: () => session.vocabulary.probabilities };
  const draft = draftField(input, {
    tidy,
    problem,
    keep,
    left: () => !choices.pressed,
    commit: (text, refused) => commit(Number(text), refused),
    changed: () => {
      input.style.setProperty("width", `calc(${Math.max(1, input.value.length)}ch + 11px)`);
      if (choices.control === control) choices.show();
    },
  });
  control.try = (p, final) => {
    input.value = String(p);
    input.dispatchEvent(new Event("input"));
    if (final) draft.commit();
  };
  input.addEventListener("click", () => choices.open(control));
  input.addEventListener("blur", () => choices.close());
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && problem(input.value)) choices.open(control);
    else if (event.key === "Enter" || event.key === "Escape") choices.close();
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown" || event.altKey) return;
    event.preventDefault();
    control.try(nextValue(control.values(), parseProbability(input.value), event.key), false);
  });
  return {
    node: input,
    update(p, testid, label) {
      identify(input, testid, label);
      input.dataset.hint = `p = ${p}: ${meaning(p)}`;
      draft.update(String(p));
    },
    focus() {
      input.focus();
      input.select();
    },
    typing: draft.typing,
    giveUp(touched) {
      draft.giveUp(touched);
      if (choices.control === control) choices.close();
    },
  };
}

/** The nearest of the vocabulary's values above or below p. */
function nextValue(values, p, key) {
  const up = key === "ArrowUp";
  const beyond = values.filter((value) => (up ? value > p : value < p));
  return beyond.length ? (up ? Math.min(...beyond) : Math.max(...beyond)) : p || values[0];
}

/** The pop-up under the field that has the focus. */
class Choices {
  control = null;
  /** True while the mouse is down on the pop-up: a dragged value is not final. */
  pressed = false;

  constructor() {
    this.values = h("div", { class: "p-values" });
    this.slider = h("input", {
      type: "range",
      class: "p-slider",
      min: Math.log10(SMALLEST),
      max: 0,
      step: 0.01,
      "aria-label": "Probability, logarithmic",
      "data-testid": "p-slider",
      oninput: () => this.control?.try(this.#dragged(), false),
      onchange: () => this.control?.try(this.#dragged(), true),
    });
    this.caption = h("div", { class: "p-caption" });
    this.node = h(
      "div",
      { class: "p-choices", popover: "manual", "data-testid": "p-choices" },
      this.values,
      this.slider,
      this.caption,
    );
    this.node.addEventListener("pointerdown", (event) => {
      this.pressed = true;
      if (event.target !== this.slider) event.preventDefault();
    });
    for (const end of ["pointerup", "pointercancel"]) addEventListener(end, () => this.#released());
    addEventListener("scroll", () => this.close(), { passive: true });
  }

  open(control) {
    this.control = control;
    const buttons = control.values().map((p) =>
      h(
        "button",
        {
          type: "button",
          tabindex: -1,
          "data-p": p,
          "data-testid": `p-choice-${p}`,
          "aria-label": `p = ${p}`,
          onclick: () => control.try(p, true),
        },
        String(p),
      ),
    );
    this.values.replaceChildren(...buttons);
    document.body.append(this.node);
    if (!this.node.matches(":popover-open")) this.node.showPopover();
    this.show();
    placeBelow(this.node, control.input);
  }

  /** Bring the pop-up in line with what the field says. */
  show() {
    const p = parseProbability(this.control.input.value);
    for (const button of this.values.children) {
      button.classList.toggle("current", Number(button.dataset.p) === p);
    }
    if (!Number.isNaN(p)) this.slider.value = Math.log10(Math.max(SMALLEST, p));
    this.caption.textContent = meaning(p);
    this.caption.classList.toggle("error", Number.isNaN(p));
  }

  close() {
    if (this.pressed || !this.control) return;
    this.control = null;
    if (this.node.matches(":popover-open")) this.node.hidePopover();
  }

  #dragged() {
    const p = 10 ** Number(this.slider.value);
    return Number(p.toPrecision(p >= 0.995 ? 1 : 2));
  }

  #released() {
    if (!this.pressed) return;
    this.pressed = false;
    this.control?.input.focus();
  }
}

const choices = new Choices();
