/** A question before something that cannot be taken back. */

import { dialog } from "../common/dialog.js";
import { h } from "../common/dom.js";

/**
 * @param {string} title
 * @param {string} text What will happen.
 * @param {string} yes The button that does it.
 * @param {() => void} act
 */
export function ask(title, text, yes, act) {
  const node = dialog("question", title);
  node.addEventListener("close", () => node.remove());
  const button = (id, label, onclick, more = "") =>
    h("button", { type: "button", class: `button ${more}`, "data-testid": id, onclick }, label);
  const go = () => {
    node.close();
    act();
  };
  const cancel = button("question-no", "Cancel", () => node.close());
  node.append(h("p", { class: "question-text" }, text));
  node.append(h("div", { class: "dialog-foot" }, cancel, button("question-yes", yes, go, "first")));
  node.showModal();
  cancel.focus();
}

/**
 * Begin another run, after a question if one is under way.
 *
 * @param {?import("./protocol.js").EvolutionMessage} status
 * @param {(instead: boolean) => void} act
 */
export function insteadOf(status, act) {
  if (!status?.active) act(false);
  else ask("Stop the present run?", `${status.run} is stopped first. It can be resumed later.`, "Stop it", () => act(true));
}
