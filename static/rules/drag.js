/** Rules are dragged to another place by their number. */

import { edits } from "./protocol.js";

const THRESHOLD = 4; // px before a press becomes a drag

/**
 * @param {import("./card.js").RuleCard} card
 * @param {Element} handle
 */
export function makeDraggable(card, handle) {
  let start = null;

  function follow(event) {
    if (!start || event.pointerId !== start.pointerId) return;
    const by = event.clientY - start.y + scrollY - start.scroll;
    if (!start.dragging && Math.abs(by) < THRESHOLD) return;
    start.dragging = true;
    card.node.classList.add("dragged");
    card.node.style.setProperty("transform", `translateY(${by}px)`);
    start.to = placeAt(card, event.clientY);
    mark(card, start.to);
  }

  function finish(event) {
    const { to, dragging } = start ?? {};
    start = null;
    card.node.classList.remove("dragged");
    card.node.style.removeProperty("transform");
    mark(card, card.index);
    if (event.type !== "pointerup" || !dragging || to === card.index) return;
    card.edit((rule) => edits.moveRule(rule, to));
  }

  handle.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    handle.setPointerCapture(event.pointerId);
    start = { pointerId: event.pointerId, y: event.clientY, scroll: scrollY, to: card.index };
  });
  handle.addEventListener("pointermove", follow);
  handle.addEventListener("pointerup", finish);
  handle.addEventListener("pointercancel", finish);
}

const others = (card) => [...card.node.parentElement.children].filter((node) => node !== card.node);

/** How many of the other rules lie above the pointer: the rule's new index. */
function placeAt(card, y) {
  return others(card).filter((node) => {
    const { top, height } = node.getBoundingClientRect();
    return top + height / 2 < y;
  }).length;
}

/** Show where the rule would go; nothing if it would stay. */
function mark(card, to) {
  others(card).forEach((node, i) => {
    node.classList.toggle("drop-before", i === to && to < card.index);
    node.classList.toggle("drop-after", i === to - 1 && to > card.index);
  });
}
