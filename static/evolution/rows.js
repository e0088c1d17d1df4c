/** A table of individuals: a click or Enter on a row chooses it, arrow keys walk. */

import { h, identify } from "../common/dom.js";

export class Rows {
  #items = [];

  /**
   * @param {string} testid Of the rows, with their number.
   * @param {Object<string, string>} columns What they are called, and what that means.
   * @param {(item: any) => void} choose
   */
  constructor(testid, columns, choose) {
    this.testid = testid;
    this.choose = choose;
    this.body = h("tbody", {});
    const heads = Object.entries(columns).map(([name, title]) => h("th", { scope: "col", title }, name));
    this.node = h("table", { class: "rows" }, h("thead", {}, h("tr", {}, ...heads)), this.body);
    this.body.addEventListener("keydown", (event) => this.#key(event));
    this.body.addEventListener("click", (event) => this.#pick(event.target.closest("tr")));
  }

  get length() {
    return this.#items.length;
  }

  /**
   * Rows are kept and get new texts, so that the focus stays.
   *
   * @template T An array that begins with generation and key.
   * @param {T[]} items
   * @param {(item: T, i: number) => (string | Node[])[]} cells
   */
  show(items, cells) {
    this.#items = items;
    while (this.body.rows.length > items.length) this.body.lastChild.remove();
    items.forEach((item, i) => {
      const row = this.body.rows[i] ?? this.body.appendChild(this.#row(i));
      const texts = cells(item, i);
      while (row.cells.length < texts.length) row.append(h("td", {}));
      texts.forEach((text, at) => row.cells[at].replaceChildren(...[text].flat()));
    });
  }

  /** @param {?{generation: number, key: number}} individual The one that is looked at. */
  mark(individual) {
    this.#items.forEach(([generation, key], i) => {
      const chosen = individual !== null && individual.generation === generation && individual.key === key;
      this.body.rows[i].setAttribute("aria-selected", String(chosen));
    });
  }

  #row(i) {
    const row = h("tr", { tabindex: i === 0 ? 0 : -1 });
    identify(row, `${this.testid}-${i + 1}`);
    return row;
  }

  #pick(row) {
    if (row) this.choose(this.#items[row.sectionRowIndex]);
  }

  #key(event) {
    const row = event.target.closest("tr");
    const to = { ArrowDown: row.nextElementSibling, ArrowUp: row.previousElementSibling }[event.key];
    if (event.key === "Enter" || event.key === " ") this.#pick(row);
    else if (to === undefined) return;
    event.preventDefault();
    to?.focus();
  }
}
