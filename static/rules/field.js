/**
 * Text that is typed: Enter or leaving the field commits, Esc reverts, messages never overwrite it.
 *
 * Text that cannot be taken is not left behind: leaving the field shows what is, and says why.
 */

import { h, isRendering } from "../common/dom.js";

/** Why the text that was typed last is not taken, at its place. */
const refusal = h("span", { class: "refusal", role: "alert", "data-testid": "refusal" });

/** The rules have changed, or something else is typed: what was refused before is of no interest. */
export const forgetRefusal = () => refusal.remove();

/**
 * @typedef {(text: string, cursor: ?[number, number]) => void} Keep The cursor is null if it is elsewhere.
 *
 * @param {HTMLInputElement | HTMLTextAreaElement} input
 * @param {object} how
 * @param {(text: string) => string} how.tidy The text as it would be stored, for comparing.
 * @param {(text: string, refused: () => void) => boolean} how.commit Sends the text; false if that is
 *   not possible now.
 * @param {Keep} how.keep Takes what was typed and can no longer stand here.
 * @param {(text: string) => ?string} [how.problem] Why the text cannot be committed.
 * @param {() => boolean} [how.left] False if the focus is still in what belongs to the field.
 * @param {() => void} [how.changed] Called whenever the text has changed for any reason.
 */
export function draftField(input, { tidy, commit, keep, problem = () => null, left = () => true, changed = () => {} }) {
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

  /** What was sent was not taken: it is a draft again, unless something else is typed by now. */
  function putBack(text) {
    if (tidy(input.value) === stored) write(text);
    sent = null;
  }

  function tryCommit() {
    const text = tidy(input.value);
    if (text === stored) return revert();
    if (text === sent || problem(input.value)) return undefined;
    if (commit(text, () => putBack(text))) sent = text;
    return undefined;
  }

  function leave() {
    if (isRendering() || !left()) return;
    const reason = input.hasAttribute("data-draft") && problem(input.value);
    if (!reason) return void tryCommit();
    refusal.textContent = `“${input.value}” is not taken: ${reason}`;
    revert();
    (input.closest(".chip") ?? input.parentElement).append(refusal);
  }

  input.addEventListener("input", () => {
    forgetRefusal();
    refresh();
  });
  input.addEventListener("focus", () => isRendering() || forgetRefusal());
  input.addEventListener("blur", leave);
  input.addEventListener("connectionlost", () => (sent = null));
  input.addEventListener("keydown", (event) => {
    if (event.isComposing) return;
    if (event.key === "Enter" && !event.shiftKey) {
      event.preventDefault();
      tryCommit();
      if (input instanceof HTMLTextAreaElement) input.blur();
    } else if (event.key === "Escape") {
      event.preventDefault();
      revert();
      input.dispatchEvent(new Event("reverted", { bubbles: true }));
      input.blur();
    }
  });

  const field = {
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
    /** @param {boolean} touched Text counts as typed if the cursor is in it. */
    typing: (touched) => input.hasAttribute("data-draft") || (touched && input === document.activeElement),
    /** What is typed here cannot stay here: it is kept elsewhere, and the field shows what is. */
    giveUp(touched) {
      const { value, selectionStart, selectionEnd } = input;
      const cursor = input === document.activeElement ? [selectionStart, selectionEnd] : null;
      const typed = field.typing(touched);
      sent = null;
      write(stored);
      if (typed) keep(value, cursor);
    },
  };
  input.addEventListener("giveup", () => field.giveUp(false));
  return field;
}

/** Every field whose text is not stored is told: `connectionlost`, or `giveup`. */
export function tellDrafts(event, except = null) {
  for (const input of document.querySelectorAll("[data-draft]")) {
    if (input !== except) input.dispatchEvent(new Event(event));
  }
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
