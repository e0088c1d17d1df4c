/** Text that is typed: Enter or leaving the field commits, Esc reverts, messages never overwrite it. */

import { isRendering } from "../common/dom.js";

/**
 * @param {HTMLInputElement | HTMLTextAreaElement} input
 * @param {object} how
 * @param {(text: string) => string} how.tidy The text as it would be stored, for comparing.
 * @param {(text: string) => boolean} how.commit Sends the text; false if that is not possible now.
 * @param {(text: string) => ?string} [how.problem] Why the text cannot be committed.
 * @param {() => void} [how.changed] Called whenever the text has changed for any reason.
 * @returns {{update: (text: string) => void, commit: () => void, revert: () => void}}
 */
export function draftField(input, { tidy, commit, problem = () => null, changed = () => {} }) {
  let stored = "";
  let sent = null;

  function refresh() {
    const draft = tidy(input.value) !== stored;
    const reason = draft ? problem(input.value) : null;
    input.toggleAttribute("data-draft", draft);
    if (reason) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
    input.title = reason ?? input.dataset.hint ?? "";
    changed();
  }

  function write(text) {
    if (input.value !== text) input.value = text;
    refresh();
  }

  function revert() {
    sent = null;
    write(stored);
  }

  function tryCommit() {
    const text = tidy(input.value);
    if (text === stored) return revert();
    if (text === sent || problem(input.value)) return undefined;
    if (commit(text)) sent = text;
    return undefined;
  }

  input.addEventListener("input", refresh);
  input.addEventListener("blur", () => isRendering() || tryCommit());
  input.addEventListener("connectionlost", () => (sent = null));
  const typing = () => input === document.activeElement && !("cell" in input.dataset);
  input.addEventListener("resend", () => typing() || tryCommit());
  input.addEventListener("keydown", (event) => {
    if (event.isComposing) return;
    if (event.key === "Enter" && !event.shiftKey) {
      event.preventDefault();
      tryCommit();
      if (input instanceof HTMLTextAreaElement) input.blur();
    } else if (event.key === "Escape") {
      event.preventDefault();
      revert();
      input.blur();
    }
  });

  return {
    /** Take the server's text, unless something else is being typed here. */
    update(text) {
      const typed = tidy(input.value);
      const untouched = typed === stored || typed === sent;
      stored = text;
      sent = null;
      if (untouched && (tidy(input.value) !== text || input !== document.activeElement)) write(text);
      else refresh();
    },
    commit: tryCommit,
    revert,
  };
}

/** Tell every field with unsaved text about the connection: `connectionlost` or `resend`. */
export function tellDrafts(event) {
  for (const input of document.querySelectorAll("[data-draft]")) input.dispatchEvent(new Event(event));
}

/** A text area that is as high as its text, without measuring: CSS sizes it by the wrapper's copy. */
export function growing(input) {
  const wrapper = document.createElement("div");
  wrapper.className = "growing";
  wrapper.append(input);
  return {
    node: wrapper,
    fit: () => (wrapper.dataset.text = input.value || input.placeholder),
  };
}
