/** The rules in their order. */

import { focusAnswer, h, icon, keepingFocus, reconcile } from "../common/dom.js";
import { RuleCard } from "./card.js";
import { findingLine } from "./finding.js";
import { edits } from "./protocol.js";

const GLIDE = { duration: 180, easing: "ease-out" };
const EMPTY_RULE = { comment: "", enabled: true, preconditions: [], behaviours: [], actions: [] };

export class RuleTable {
  /** @type {RuleCard[]} */
  cards = [];
  #asked = false;

  /**
   * @param {Element} root
   * @param {import("./session.js").Session} session
   */
  constructor(root, session) {
    this.session = session;
    this.list = h("div", { class: "rules", "data-testid": "rules" });
    this.general = h("ul", { class: "findings general" });
    this.add = h(
      "button",
      { type: "button", class: "add-rule", "data-testid": "add-rule", onclick: () => this.#addRule() },
      icon("add"),
      "add rule",
    );
    root.append(this.general, this.list, this.add);
  }

  /** @param {import("./protocol.js").RulesMessage} message */
  update({ rule_set: { rules }, findings }) {
    const before = new Map(this.cards.map((card) => [card, card.node.offsetTop]));
    keepingFocus(() => {
      const { session } = this;
      this.cards = reconcile(this.list, this.cards, rules, () => new RuleCard(session), session.replaced);
      const general = findings.filter((finding) => !finding.rule);
      this.general.replaceChildren(
        ...general.map(({ message, severity }) => findingLine(severity, message)),
      );
      this.general.hidden = general.length === 0;
    });
    if (before.size) this.#glide(before);
    if (this.#asked && this.cards.length > before.size) {
      this.#asked = false;
      focusAnswer(this.add, this.cards.at(-1).comment);
    }
  }

  /** The card that a node belongs to, if any. */
  cardOf(node) {
    return this.cards.find((card) => card.node.contains(node));
  }

  #addRule() {
    this.#asked = true;
    this.session.edit(() => edits.addRule(this.cards.length, EMPTY_RULE));
  }

  /**
   * Let the cards glide to their new places, so that the eye can follow.
   *
   * Meanwhile the list is clipped: cards that come up from below would make the page longer, and what
   * stands under them would scroll away from a finger that is on it.
   */
  async #glide(before) {
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    const glides = [];
    for (const card of this.cards) {
      const moved = before.get(card) - card.node.offsetTop;
      if (!before.has(card)) glides.push(card.node.animate([{ opacity: 0 }, {}], GLIDE));
      else if (moved) glides.push(card.node.animate([{ transform: `translateY(${moved}px)` }, {}], GLIDE));
    }
    this.list.classList.add("gliding");
    await Promise.allSettled(glides.map(({ finished }) => finished));
    this.list.classList.remove("gliding");
  }
}
