/** Rules are copied, cut and pasted as text in the rule language, also between windows. */

import { isEditing } from "./grid.js";
import { edits } from "./protocol.js";

/**
 * @param {import("./session.js").Session} session
 * @param {import("./table.js").RuleTable} table
 * @param {import("../common/notices.js").Notices} notices
 */
export function listenToClipboard(session, table, notices) {
  const elsewhere = () =>
    isEditing(document.activeElement) || table.list.offsetParent === null || document.querySelector("dialog[open]");

  function copy(event) {
    const card = table.cardOf(document.activeElement);
    const text = card && session.state.rule_texts?.[card.index];
    if (!text || elsewhere() || !getSelection().isCollapsed) return null;
    event.preventDefault();
    event.clipboardData.setData("text/plain", `${text.trimEnd()}\n`);
    return card;
  }

  document.addEventListener("copy", (event) => {
    const card = copy(event);
    if (card) notices.show("info", `Rule ${card.index + 1} copied.`);
  });
  document.addEventListener("cut", (event) => copy(event)?.remove());
  document.addEventListener("paste", (event) => {
    if (elsewhere()) return;
    event.preventDefault();
    const text = event.clipboardData.getData("text/plain");
    if (!/\brule\b/.test(text)) {
      notices.show("info", "The clipboard holds no rule: copy one with Ctrl+C, or a text that starts with “rule”.");
      return;
    }
    const card = table.cardOf(document.activeElement);
    session.edit(() => edits.pasteRules(card && card.index >= 0 ? card.index + 1 : table.cards.length, text));
  });
}
