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
    const refuse = (reason) => notices.show("error", `${file.name}: ${reason}`);
    if (file.size > LARGEST) return refuse(`${file.size} bytes are too many for a rule set.`);
    const text = await file.text().catch(() => null);
    if (text === null) refuse("this file cannot be read.");
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
