/** Windows over a page. */

import { h, iconButton, identify } from "./dom.js";

/** An empty dialog with a title and a button to close it; Esc closes it as well. */
export function dialog(testid, title) {
  const close = iconButton("remove", "Close", () => node.close());
  const head = h("div", { class: "dialog-head" }, h("h2", {}, title), close);
  const node = h("dialog", { class: "dialog" }, head);
  identify(node, testid, title);
  node.addEventListener("click", (event) => event.target === node && node.close());
  document.body.append(node);
  return node;
}
