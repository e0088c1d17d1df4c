/** The tabs above the table, and the tools beside them. */

import { h, identify } from "./dom.js";
import { tabStore } from "./store.js";

/**
 * @typedef {object} Tab
 * @property {string} id
 * @property {string} label
 * @property {HTMLElement} panel
 * @property {Node[]} tools Shown beside the tabs while this one is in view.
 * @property {() => void} [shown] Called when the tab comes into view.
 */

export class Tabs {
  #kept = null;

  /**
   * @param {Tab[]} tabs The first is shown at the start.
   * @param {...Node} always Shown beside every tab's tools.
   */
  constructor(tabs, ...always) {
    this.tabs = tabs;
    this.tools = tabs.map(({ tools }) => h("div", { class: "tab-tools" }, ...tools));
    this.buttons = tabs.map(({ id, label, panel }, i) => {
      panel.setAttribute("role", "tabpanel");
      panel.setAttribute("aria-labelledby", `tab-${id}`);
      const attributes = { type: "button", role: "tab", class: "tab", id: `tab-${id}`, "aria-controls": panel.id };
      const button = h("button", { ...attributes, onclick: () => this.show(i) }, label);
      identify(button, `tab-${id}`);
      return button;
    });
    const list = h("div", { class: "tab-list", role: "tablist", "aria-label": "View" }, ...this.buttons);
    list.addEventListener("keydown", (event) => this.#walk(event));
    this.node = h("div", { class: "tab-bar" }, list, ...this.tools, ...always);
    this.show(0);
  }

  /** @param {number} at */
  show(at) {
    this.tabs.forEach(({ panel, shown }, i) => {
      const selected = i === at;
      this.buttons[i].setAttribute("aria-selected", String(selected));
      this.buttons[i].tabIndex = selected ? 0 : -1;
      panel.hidden = !selected;
      this.tools[i].hidden = !selected;
      if (selected) shown?.();
    });
    if (this.#kept) tabStore.set(this.#kept, this.tabs[at].id);
  }

  /**
   * Show the tab that was in view before this page was loaded again, and remember which is.
   *
   * @param {string} key Under which it is kept.
   */
  remember(key) {
    const at = this.tabs.findIndex(({ id }) => id === tabStore.get(key));
    if (at > 0) this.show(at);
    this.#kept = key;
  }

  /** A number or sign behind a tab's label; empty for none. */
  badge(id, text) {
    const at = this.tabs.findIndex((tab) => tab.id === id);
    const badge = text ? [h("span", { class: "count" }, text)] : [];
    this.buttons[at].replaceChildren(this.tabs[at].label, ...badge);
  }

  #walk(event) {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    const count = this.buttons.length;
    const to = (this.buttons.indexOf(event.target) + by + count) % count;
    this.show(to);
    this.buttons[to].focus();
  }
}
