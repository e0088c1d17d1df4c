/** A rule set from a file of the user's. */

import { h } from "./dom.js";

const LARGEST = 200_000; // bytes, as much as the server reads

/**
 * @param {import("./notices.js").Notices} notices
 * @param {(file: {name: string, text: string}) => void} take
 * @returns {HTMLInputElement} Hidden; a click on it lets the user choose a file.
 */
export function ruleSetFile(notices, take) {
  const open = async () => {
    const [file] = input.files;
    input.value = ""; // the same file may be chosen again
    if (!file) return;
    notices.forget();
    const refuse = (reason) => notices.show("error", `${file.name}: ${reason}`);
    if (file.size > LARGEST) return refuse(`${file.size} bytes are too many for a rule set.`);
    const bytes = await file.arrayBuffer().catch(() => null);
    if (bytes === null) return refuse("this file cannot be read.");
    const { text, reason } = decode(new Uint8Array(bytes));
    if (reason) refuse(reason);
    else take({ name: file.name, text });
  };
  const input = h("input", {
    type: "file",
    accept: ".yaml,.yml,.rules,.txt,.json",
    hidden: true,
    "aria-label": "Rule set file",
    "data-testid": "file",
    onchange: open,
  });
  return input;
}

/**
 * @param {Uint8Array} bytes
 * @returns {{text?: string, reason?: string}} The text in UTF-8, without byte order mark; or why there is none.
 */
function decode(bytes) {
  const [first, second] = bytes;
  const marked = (first === 0xff && second === 0xfe) || (first === 0xfe && second === 0xff);
  if (marked || (first === 0) !== (second === 0)) return { reason: "UTF-16, expected UTF-8." };
  try {
    return { text: new TextDecoder("utf-8", { fatal: true }).decode(bytes) };
  } catch {
    return { reason: `not UTF-8 at byte ${readable(bytes)}.` };
  }
}

/** How many bytes from the beginning are UTF-8; not all of them. */
function readable(bytes) {
  const decoder = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });
  let text = "";
  try {
    for (let at = 0; at < bytes.length; at += 1) text += decoder.decode(bytes.subarray(at, at + 1), { stream: true });
  } catch {
    // `text` is what came before it
  }
  return new TextEncoder().encode(text).length;
}
