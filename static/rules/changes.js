/** The rules as they are beside the version loaded last: what was added, removed, moved, changed. */

import { h } from "../common/dom.js";
import { compareElements, compareRules } from "./difference.js";
import { request } from "./protocol.js";

const PARTS = { preconditions: "P", behaviours: "B", actions: "A" };

export class ChangesTab {
  #message = null;

  /**
   * @param {Element} root
   * @param {import("./session.js").Session} session
   * @param {(count: number) => void} counted Told how many rules differ.
   */
  constructor(root, session, counted) {
    Object.assign(this, { root, session, counted });
    this.title = h("p", { class: "changes-title", "data-testid": "changes-title" });
    this.back = h("button", { type: "button", class: "button", "data-testid": "back-to-loaded" });
    const words = [h("span", { class: "long" }, "Back to the loaded version"), h("span", { class: "short" }, "Back to loaded")];
    this.back.append(...words);
    this.back.title = "Undo brings the present version back";
    this.back.addEventListener("click", () => {
      session.command(request.setText(this.#message.loaded_text));
    });
    this.list = h("div", { class: "rules" });
    root.append(this.title, this.list);
  }

  /** @param {import("./protocol.js").RulesMessage} message */
  update(message) {
    this.#message = message;
    const { loaded, rule_set } = message;
    if (!loaded) return;
    this.changes = compareRules(loaded.rules, rule_set.rules);
    const count = this.changes.filter(({ status, moved }) => status !== "same" || moved).length;
    this.renamed = loaded.name !== rule_set.name;
    this.counted(count);
    const name = loaded.name || "the rules";
    const rules = count === 1 ? "1 rule differs" : `${count} rules differ`;
    const differs = count > 0 || this.renamed;
    this.title.textContent = differs ? `${rules} from ${name} as loaded` : `No change since ${name} was loaded`;
    this.back.hidden = !message.loaded_text || !differs;
    if (!this.root.hidden) this.shown();
  }

  /** The tab comes into view. */
  shown() {
    if (!this.changes) return;
    const { loaded, rule_set } = this.#message;
    const name = this.renamed ? [h("div", { class: "renamed" }, "Name ", ...text(loaded.name, rule_set.name))] : [];
    this.list.replaceChildren(...name, ...this.changes.map(ruleNode));
  }
}

/** @param {import("./difference.js").RuleChange} change */
function ruleNode(change) {
  const { before, after, from, to, moved, status } = change;
  const number = (after ? to : from) + 1;
  const badge = h("div", { class: "badge" }, h("i", {}, "R"), h("sub", {}, String(number)));
  const heading = h("div", { class: "heading" }, h("div", { class: "comment" }, ...comment(before, after)));
  const node = h("article", { class: `rule change ${status}`, "data-testid": `change-${from + 1}-${to + 1}` });
  node.append(h("div", { class: "gutter" }, badge), heading, h("div", { class: "tags" }, ...tags(change)));
  if (moved) node.classList.add("moved");
  if (status !== "same") {
    const rows = Object.entries(PARTS).map(([part, letter]) => partRow(part, letter, number, before, after));
    node.append(...rows);
  }
  return node;
}

function tags({ before, after, from, moved, status }) {
  const words = {
    added: ["added", "new"],
    removed: ["removed", "removed"],
    changed: ["changed", "changed"],
    same: moved ? null : ["same", "unchanged"],
  }[status];
  const tag = (kind, label) => h("span", { class: `tag ${kind}` }, label);
  const found = words ? [tag(...words)] : [];
  if (moved) found.push(tag("moved", `moved, was R${from + 1}`));
  if (before && after && before.enabled !== after.enabled) {
    found.push(tag("changed", after.enabled ? "switched on" : "switched off"));
  }
  return found;
}

const comment = (before, after) => text(before?.comment ?? null, after?.comment ?? null);

/** A text that may have changed: the old one struck out before the new one. */
function text(before, after) {
  if (before === after) return [before];
  const parts = [before && h("del", {}, before), after && h("ins", {}, after)].filter(Boolean);
  return parts.length > 1 ? [parts[0], " ", parts[1]] : parts;
}

function partRow(part, letter, number, before, after) {
  const label = h("div", { class: "part-label" }, h("i", {}, letter), h("sub", {}, String(number)));
  label.append(h("span", { class: "part-word" }, part));
  const changes = compareElements(before?.[part] ?? [], after?.[part] ?? []);
  const epsilon = h("span", { class: "empty" }, h("i", {}, "ε"));
  const chips = changes.length ? changes.map(chip) : [epsilon];
  return h("div", { class: "part" }, label, h("div", { class: "part-body" }, ...chips));
}

/** @param {import("./difference.js").ElementChange} change */
function chip({ status, before, after }) {
  const sign = { added: "+", removed: "−", moved: "⇄" }[status];
  const node = h("span", { class: `chip ${status}` });
  if (sign) node.append(h("span", { class: "sign", "aria-label": status }, sign), " ");
  if (status === "added") node.append(h("ins", {}, after.join(" ")));
  else if (status === "removed") node.append(h("del", {}, before.join(" ")));
  else node.append(...after.flatMap((word, i) => [...(i ? [" "] : []), ...text(before[i], word)]));
  return node;
}
