/**
 * What was typed and cannot stay where it was typed: its rule is gone, or the connection was lost
 * meanwhile. It is offered: to be applied, if its rule is there, to be copied, or to be discarded.
 */

import { h, icon, identify } from "../common/dom.js";
import { growing } from "./field.js";

const GONE = "is gone: somebody else removed or replaced it while you typed. Your text is kept here.";
const AWAY = "was typed while the connection was lost, and is not applied.";

/**
 * @typedef {object} Typed
 * @property {string} what Where it was typed, in words.
 * @property {string} text
 * @property {?[number, number]} cursor Where the cursor is in the text; null if it is elsewhere.
 * @property {?import("./protocol.js").Rule} rule The rule that it is for; null if it is for all of them.
 * @property {(text: string, rule: number) => ?import("./protocol.js").AnyEdit} edit Null if the text says nothing.
 */

export class KeptTexts {
  /** @type {Set<{typed: Typed, node: Element, area: HTMLTextAreaElement, apply: HTMLButtonElement}>} */
  #kept = new Set();

  /**
   * @param {Element} root
   * @param {import("./session.js").Session} session
   */
  constructor(root, session) {
    this.session = session;
    this.root = h("div", {});
    root.append(this.root);
  }

  /** True if something would be lost with this page. */
  get any() {
    return this.#kept.size > 0;
  }

  /**
   * @param {Typed} typed
   * @param {boolean} away It was typed while the connection was lost.
   */
  add(typed, away) {
    const area = h("textarea", { rows: 1, cols: 1, spellcheck: "false", "data-draft": true }, typed.text);
    const { node: text, fit } = growing(area);
    const button = (id, label, onclick) => identified(h("button", { type: "button", class: "button", onclick }, label), id);
    const apply = button("apply-kept", "Apply", () => this.#apply(entry));
    const discard = button("discard-kept", "Discard", () => this.#remove(entry));
    const words = h("span", { class: "notice-text" }, `${typed.what} ${away ? AWAY : GONE}`);
    const node = h("div", { class: "notice offline kept", role: "status" }, icon("warning"), words, text, apply, discard);
    const entry = { typed, node, area, apply };
    identify(node, "kept");
    identify(area, "kept-text", typed.what);
    area.addEventListener("input", () => {
      fit();
      this.#refresh(entry);
    });
    fit();
    this.#show(entry);
    if (!typed.cursor) return;
    area.focus();
    area.setSelectionRange(...typed.cursor);
  }

  /** The rules have changed: what can be applied may have, too. */
  rulesChanged() {
    for (const entry of this.#kept) this.#refresh(entry);
  }

  #show(entry) {
    this.#kept.add(entry);
    this.root.append(entry.node);
    this.#refresh(entry);
  }

  #remove(entry) {
    this.#kept.delete(entry);
    entry.node.remove();
  }

  /** @returns {?import("./protocol.js").AnyEdit} Null if there is nothing that the text could be applied to. */
  #edit({ typed, area }) {
    const rules = this.session.state?.rule_set.rules ?? [];
    const wanted = JSON.stringify(typed.rule);
    const at = typed.rule && rules.findIndex((rule) => JSON.stringify(rule) === wanted);
    return at === -1 ? null : typed.edit(area.value, at);
  }

  #refresh(entry) {
    entry.apply.disabled = this.#edit(entry) === null;
    entry.apply.title = entry.apply.disabled ? "There is nothing now that this could be applied to" : "";
  }

  #apply(entry) {
    const make = () => {
      const edit = this.#edit(entry);
      if (edit) this.#remove(entry);
      return edit;
    };
    this.session.edit(make, () => this.#show(entry));
  }
}

function identified(node, testid) {
  identify(node, testid);
  return node;
}
