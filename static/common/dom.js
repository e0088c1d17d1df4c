/** Small helpers for making elements and for keeping a list of them in line with data. */

/**
 * @param {string} tag
 * @param {object} attributes `class`, `on<event>` handlers, and attributes; false and null are left out.
 * @param {...(Node | string)} children Strings become text, never markup.
 */
export function h(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value !== null) node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
}

/** Give a node its name for tests and, if there is one, for assistive technology. */
export function identify(node, testid, label = null) {
  node.dataset.testid = testid;
  if (label !== null) node.setAttribute("aria-label", label);
}

const PATHS = {
  add: "M8 3.2v9.6M3.2 8h9.6",
  remove: "M4.3 4.3l7.4 7.4M11.7 4.3l-7.4 7.4",
  up: "M8 12.6V3.8M4.2 7.4L8 3.6l3.8 3.8",
  down: "M8 3.4v8.8M4.2 8.6L8 12.4l3.8-3.8",
  duplicate: "M5.6 5.6h7.2v7.2H5.6zM3.2 10.2V3.2h7",
  trash: "M3.2 4.6h9.6M6.4 4.4V2.8h3.2v1.6M4.5 4.8l.6 8.4h5.8l.6-8.4M6.9 7v4M9.1 7v4",
  undo: "M6.2 3.2L3 6.2l3.2 3M3.4 6.2h5.8a3.4 3.4 0 010 6.8H6.4",
  redo: "M9.8 3.2L13 6.2l-3.2 3M12.6 6.2H6.8a3.4 3.4 0 000 6.8h2.8",
  open: "M2.6 12.4V3.6h3.6l1.4 1.6h5.8v7.2z",
  save: "M8 2.8v6.8M5 6.8l3 3 3-3M3 12.8h10",
  warning: "M8 2.8l5.8 10.2H2.2zM8 6.6v3M8 11.3v.2",
  hint: "M8 2.4a5.6 5.6 0 100 11.2A5.6 5.6 0 008 2.4M8 7.4v3.4M8 5.1v.2",
  fold: "M4.4 9.6L8 6l3.6 3.6",
};

/**
 * @param {string} tag
 * @param {object} attributes
 * @param {...SVGElement} children
 */
export function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

/** @param {keyof PATHS} name */
export function icon(name) {
  const attributes = { viewBox: "0 0 16 16", class: "icon", "aria-hidden": "true" };
  return svg("svg", attributes, svg("path", { d: PATHS[name] }));
}

/** A button with an icon; its label is what assistive technology and the tooltip say. */
export function iconButton(name, label, onclick, attributes = {}) {
  return h(
    "button",
    { type: "button", class: "tool", "aria-label": label, title: label, onclick, ...attributes },
    icon(name),
  );
}

/** True while nodes move: a blur that comes from this is not the user's. */
let rendering = false;
export const isRendering = () => rendering;

/** Run a change of the page that moves nodes, keeping the focus where it was. */
export function keepingFocus(change) {
  const active = document.activeElement;
  rendering = true;
  try {
    change();
    const lost = document.activeElement === document.body;
    if (lost && active?.isConnected) active.focus();
  } finally {
    rendering = false;
  }
}

/** Give an answer the focus, unless whoever asked for it has gone elsewhere meanwhile. */
export function focusAnswer(asker, answer) {
  const active = document.activeElement;
  if (active === asker || active === document.body) answer.focus();
}

/**
 * Bring components in line with data, moving and reusing them so that focus and typing survive.
 *
 * A component goes where its data has gone: first equal data at the same position, then equal data
 * elsewhere, then whatever is left over in its order. One in which somebody types (`typing`) takes no
 * other data than its own, equal or changed: what is typed must not get to something else.
 *
 * @template T
 * @typedef {object} Component
 * @property {Element} node
 * @property {number} index
 * @property {string} [key]
 * @property {(item: T, index: number) => void} update
 * @property {boolean} [typing]
 * @property {() => void} [drop] Called before it goes.
 * @param {Element} parent Its children are the components' nodes, and nothing else.
 * @param {Component<T>[]} old
 * @param {T[]} items
 * @param {() => Component<T>} create
 * @param {boolean} [replaced] The data comes from elsewhere: none of it is that before, changed.
 * @returns {Component<T>[]} One per item; the components that are not needed get index -1.
 */
export function reconcile(parent, old, items, create, replaced = false) {
  const keys = items.map((item) => JSON.stringify(item));
  const free = new Set(old);
  const parts = new Array(items.length).fill(null);
  const take = (i, part) => {
    parts[i] = part;
    free.delete(part);
  };
  keys.forEach((key, i) => old[i]?.key === key && take(i, old[i]));
  keys.forEach((key, i) => {
    const moved = parts[i] ?? [...free].find((part) => part.key === key);
    if (moved) take(i, moved);
  });
  const changed = !replaced && free.size === 1 && parts.filter((part) => !part).length === 1;
  const fits = (part) => free.has(part) && (changed || !part.typing);
  keys.forEach((key, i) => {
    if (parts[i]) return;
    const left = fits(old[i]) ? old[i] : [...free].find(fits);
    take(i, left ?? create());
  });
  for (const part of free) {
    part.drop?.();
    part.index = -1;
    part.node.remove();
  }
  parts.forEach((part, i) => {
    if (parent.children[i] !== part.node) parent.insertBefore(part.node, parent.children[i] ?? null);
    part.update(items[i], i);
    part.key = keys[i];
  });
  return parts;
}
