/** One pop-up menu, shared by everything that offers a choice of names. */

import { h } from "./dom.js";

/**
 * @typedef {object} Choice
 * @property {string} id For tests.
 * @property {string} label
 * @property {string} [detail] Explains the label.
 * @property {string} [colour] LED colour shown before the label.
 * @property {boolean} [divided] Draw a line above.
 * @property {() => void} choose
 */

const menu = h("div", { class: "menu", role: "menu", popover: "auto", "data-testid": "menu" });
let owner = null;

menu.addEventListener("toggle", (event) => {
  if (event.newState === "closed") owner?.setAttribute("aria-expanded", "false");
});
menu.addEventListener("keydown", (event) => {
  const items = [...menu.children];
  const at = items.indexOf(document.activeElement);
  const last = items.length - 1;
  const targets = {
    ArrowDown: at === last ? 0 : at + 1,
    ArrowUp: at <= 0 ? last : at - 1,
    Home: 0,
    End: last,
  };
  if (event.key === "Tab") menu.hidePopover();
  if (!(event.key in targets)) return;
  event.preventDefault();
  event.stopPropagation();
  items[targets[event.key]].focus();
});

/**
 * A button that opens a menu.
 *
 * @param {object} attributes
 * @param {() => Choice[]} choices Asked for each time the menu opens.
 * @param {...(Node | string)} children
 */
export function menuButton(attributes, choices, ...children) {
  let wasOpen = false;
  const button = h(
    "button",
    {
      type: "button",
      "aria-haspopup": "menu",
      "aria-expanded": "false",
      // The press closes an open menu; the click that follows must not open it again.
      onpointerdown: () => (wasOpen = owner === button && menu.matches(":popover-open")),
      onclick: () => {
        if (!wasOpen) open(button, choices());
        wasOpen = false;
      },
      ...attributes,
    },
    ...children,
  );
  return button;
}

function open(button, choices) {
  owner = button;
  menu.replaceChildren(...choices.map(item));
  menu.setAttribute("aria-label", button.getAttribute("aria-label") ?? "");
  document.body.append(menu);
  menu.showPopover();
  placeBelow(menu, button);
  button.setAttribute("aria-expanded", "true");
  menu.firstElementChild?.focus();
}

function item({ id, label, detail = "", colour, divided = false, choose }) {
  const lamp = h("span", { class: "lamp", "aria-hidden": "true" });
  if (colour) lamp.style.setProperty("--led", colour);
  return h(
    "button",
    {
      type: "button",
      role: "menuitem",
      class: divided ? "menu-item divided" : "menu-item",
      "data-testid": `choice-${id}`,
      onclick: () => {
        menu.hidePopover();
        choose();
      },
    },
    ...(colour ? [lamp] : []),
    h("span", { class: "menu-label" }, label),
    h("span", { class: "menu-detail" }, detail),
  );
}

/** Put a pop-up under its anchor, or above where there is more room, inside the window. */
export function placeBelow(popup, anchor) {
  const gap = 4;
  const at = anchor.getBoundingClientRect();
  const { offsetWidth: width, offsetHeight: height } = popup;
  const below = at.bottom + gap + height <= innerHeight || at.top < innerHeight - at.bottom;
  const top = below ? at.bottom + gap : at.top - gap - height;
  const left = Math.min(at.left, innerWidth - width - gap);
  popup.style.setProperty("top", `${Math.max(gap, Math.min(top, innerHeight - height - gap))}px`);
  popup.style.setProperty("left", `${Math.max(gap, left)}px`);
}
