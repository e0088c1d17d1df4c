/** Findings, as lines of a list. */

import { h, icon } from "../common/dom.js";

/**
 * One line of the list of findings.
 *
 * @param {import("./protocol.js").Severity} severity
 * @param {...(Node | string)} words
 */
export function findingLine(severity, ...words) {
  return h("li", { class: severity }, icon(severity === "hint" ? "hint" : "warning"), h("span", {}, ...words));
}
