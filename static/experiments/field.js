/** A number to type, with what is wrong with it; what is being typed is not overwritten. */

import { h, identify } from "../common/dom.js";

const LONGEST = 40;

export class NumberField {
  #typing = false;

  /**
   * @param {string} id
   * @param {string} name
   * @param {(value: number | string) => void} changed Gets a number if it is one, else the text.
   */
  constructor(id, name, changed) {
    this.input = h("input", { type: "text", id, inputmode: "numeric", autocomplete: "off", spellcheck: "false" });
    this.error = h("span", { class: "field-error", id: `${id}-error`, role: "alert", hidden: true });
    identify(this.input, id);
    identify(this.error, `${id}-error`);
    this.input.setAttribute("aria-describedby", this.error.id);
    this.input.addEventListener("input", () => (this.#typing = true));
    this.input.addEventListener("blur", () => (this.#typing = false));
    this.input.addEventListener("change", () => {
      this.#typing = false;
      const text = this.input.value.trim().slice(0, LONGEST);
      const number = Number(text);
      changed(text !== "" && Number.isFinite(number) ? number : text);
    });
    this.node = h("div", { class: "field" }, h("label", { for: id }, name), this.input, this.error);
  }

  /** @param {number | string} value @param {string} [error] */
  show(value, error = "") {
    if (!this.#typing) this.input.value = value;
    this.error.textContent = error;
    this.error.hidden = !error;
    this.input.toggleAttribute("aria-invalid", Boolean(error));
  }
}
