/**
 * The table as a grid of cells: arrow keys go from cell to cell.
 *
 * A text field that is reached by an arrow key is a cell first (`data-cell`): arrow keys leave it
 * again. Enter, a click or typing makes it a field; Enter or Esc makes it a cell again.
 */

import { isRendering } from "../common/dom.js";

const CELLS = ".switch, .comment, .tools .tool, .part-body :is(.word, .truth, .p-input, .plus), .add-rule";
const ROWS = ".rule, .part, .add-rule";

export const isText = (node) => node.matches?.("textarea, input[type=text]");

/** True if keys are text for this node and not steps in the grid. */
export const isEditing = (node) => isText(node) && !("cell" in node.dataset);

const usable = (cell) => !cell.disabled && cell.checkVisibility();
const middle = (cell) => {
  const { left, width } = cell.getBoundingClientRect();
  return left + width / 2;
};

export class Grid {
  /** Where the focus is, by numbers, for when the cell that has it goes away. */
  #place = null;

  /**
   * @param {HTMLElement} root
   * @param {import("./table.js").RuleTable} table
   */
  constructor(root, table) {
    this.root = root;
    this.table = table;
    root.addEventListener("focusin", (event) => (this.#place = this.#placeOf(event.target)));
    root.addEventListener("focusout", (event) => {
      if (isRendering()) return;
      this.#place = null;
      delete event.target.dataset.cell;
    });
    for (const name of ["input", "pointerdown"]) {
      root.addEventListener(name, (event) => delete event.target.dataset.cell, true);
    }
    root.addEventListener("keydown", (event) => this.#key(event), true);
    root.addEventListener("keydown", (event) => this.#leftField(event));
  }

  /**
   * Put the focus beside the cell that it was in, if that cell has gone.
   *
   * @param {boolean} asked This page asked for it; nobody else's change takes the focus elsewhere.
   */
  restore(asked) {
    const place = this.#place;
    const lost = document.activeElement === document.body;
    if (!asked && !this.root.contains(document.activeElement)) this.#place = null;
    if (!asked || !place || !lost) return;
    const rows = this.#rows();
    const row = rows[Math.min(this.#rowIndex(place, rows), rows.length - 1)];
    if (row) this.#focus(row[Math.min(place.column, row.length - 1)]);
  }

  /** The first cell of the table gets the focus. */
  enter() {
    this.#focus(this.#rows()[0][0]);
  }

  /** Rows of cells from top to bottom: for each rule its heading and its parts. */
  #rows() {
    const parts = [...this.root.querySelectorAll(ROWS)].map((row) => {
      const own = row.matches(".add-rule") ? [row] : [...row.querySelectorAll(CELLS)];
      return row.matches(".rule") ? own.filter((cell) => !cell.closest(".part")) : own;
    });
    return parts.map((cells) => cells.filter(usable)).filter((cells) => cells.length);
  }

  #placeOf(target) {
    const cell = target.matches(CELLS) ? target : (target.closest(".chip")?.querySelector(CELLS) ?? null);
    const card = this.table.cardOf(target);
    if (!cell || !card) return null;
    const part = cell.closest(".part");
    const row = [...(part ?? card.node).querySelectorAll(CELLS)].filter(usable);
    return { rule: card.index, part: [...card.node.querySelectorAll(".part")].indexOf(part), column: row.indexOf(cell) };
  }

  /** Index among all rows; part -1 is the heading of a rule. */
  #rowIndex({ rule, part }, rows) {
    const card = this.table.cards[Math.min(rule, this.table.cards.length - 1)];
    if (!card) return 0;
    const parts = card.node.querySelectorAll(".part");
    const row = part < 0 ? card.comment : (parts[part].querySelector(CELLS) ?? card.comment);
    const found = rows.findIndex((cells) => cells.includes(row) || (part >= 0 && parts[part].contains(cells[0])));
    return Math.max(0, found);
  }

  #key(event) {
    const { target, key } = event;
    if (event.altKey || event.shiftKey || event.isComposing || isEditing(target)) return;
    const ctrl = event.ctrlKey || event.metaKey;
    if (isText(target) && !ctrl && (key === "Enter" || key === "F2" || key === "Escape")) {
      event.preventDefault();
      event.stopPropagation();
      if (key === "Escape") target.blur();
      else edit(target);
      return;
    }
    const next = this.#next(target, key, ctrl);
    if (!next) return;
    event.preventDefault();
    event.stopPropagation();
    this.#focus(next);
  }

  #next(target, key, ctrl) {
    if (ctrl && key !== "Home" && key !== "End") return null;
    const rows = this.#rows();
    const cell = target.matches(CELLS) ? target : target.closest(".chip")?.querySelector(CELLS);
    const at = rows.findIndex((row) => row.includes(cell));
    if (at < 0) return null;
    const row = rows[at];
    const column = row.indexOf(cell);
    if (key === "ArrowLeft") return row[column - 1];
    if (key === "ArrowRight") return row[column + 1];
    if (key === "Home") return ctrl ? rows[0][0] : row[0];
    if (key === "End") return ctrl ? rows.at(-1).at(-1) : row.at(-1);
    if (key !== "ArrowUp" && key !== "ArrowDown") return null;
    const x = middle(cell);
    const beyond = rows[at + (key === "ArrowUp" ? -1 : 1)] ?? [];
    return [...beyond].sort((a, b) => Math.abs(middle(a) - x) - Math.abs(middle(b) - x))[0];
  }

  #focus(cell) {
    if (isText(cell)) cell.dataset.cell = "";
    cell.focus();
    if (cell.matches(".p-input")) cell.select();
  }

  /** Enter and Esc leave a field: its cell keeps the focus. */
  #leftField({ key, target }) {
    if (key !== "Enter" && key !== "Escape") return;
    if (!isText(target) || target.matches("[aria-invalid]")) return;
    if (document.activeElement === document.body || target.matches(".p-input")) this.#focus(target);
  }
}

function edit(field) {
  delete field.dataset.cell;
  if (field.matches(".p-input")) field.click();
  else field.setSelectionRange(field.value.length, field.value.length);
}
