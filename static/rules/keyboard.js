/** Keys that work anywhere on the page. */

import { isEditing, isText } from "./grid.js";
import { request } from "./protocol.js";

/**
 * @param {import("./session.js").Session} session
 * @param {import("./table.js").RuleTable} table
 * @param {import("./grid.js").Grid} grid
 * @param {import("./help.js").Help} help
 * @param {import("./text.js").TextTab} text
 */
export function listenToKeys(session, table, grid, help, text) {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.target.closest?.("dialog")) return;
    const act =
      wholePage(event, session) ??
      withinRule(event, table) ??
      elsewhere(event, grid, help) ??
      (text.root.hidden ? arena(event, session) : null);
    if (!act) return;
    event.preventDefault();
    act();
  });
}

/** @returns {?() => void} What the key does, or null. */
function wholePage(event, session) {
  if (!event.ctrlKey && !event.metaKey) return null;
  const typing = isText(event.target) && event.target.hasAttribute("data-draft");
  const key = event.key.toLowerCase();
  if (key === "s") return () => session.command(request.save("yaml"));
  if (typing) return null;
  if (key === "z") return () => session.command(event.shiftKey ? request.redo() : request.undo());
  if (key === "y") return () => session.command(request.redo());
  return null;
}

function withinRule(event, table) {
  const card = table.cardOf(event.target);
  if (!card) return null;
  if (event.altKey && event.key === "ArrowUp") return () => card.move(-1);
  if (event.altKey && event.key === "ArrowDown") return () => card.move(1);
  if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "d") return () => card.duplicate();
  if (event.key !== "Delete" || isEditing(event.target)) return null;
  const chips = Object.values(card.rows).flatMap((row) => row.chips);
  const chip = chips.find((candidate) => candidate.node.contains(event.target));
  if (chip) return () => chip.remove();
  return event.target.closest(".part") ? null : () => card.remove();
}

/**
 * The keys that play the arena, as in ARGoS: the page has the focus, the arena should not miss them.
 * Whoever types means text, also while the cursor is in none: keys then play nothing.
 */
function arena(event, session) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return null;
  if (event.target.closest?.("input, textarea, select, [popover]")) return null;
  const key = event.key.toUpperCase();
  return "POXFR".includes(key) && key.length === 1 ? () => session.command(request.key(key)) : null;
}

function elsewhere(event, grid, help) {
  if (event.ctrlKey || event.metaKey || event.altKey) return null;
  if (event.key === "?" && !isEditing(event.target)) return () => help.open();
  if (event.key === "ArrowDown" && event.target.id === "tab-table") return () => grid.enter();
  return null;
}
