/** The rules as text in the rule language, checked while it is typed. */

import { h, identify } from "../common/dom.js";
import { tabStore } from "../common/store.js";
import { findingLine } from "./finding.js";
import { request } from "./protocol.js";

const KEPT = "geswarm-text"; // what is not applied, and the rules that it was typed for
const PAUSE = 250; // ms without a key before the text is checked
const TOKEN = /(#.*)|("(?:[^"\\]|\\.)*")|([\w.+-]+)|([^\w"#.+-]+)|(.)/g;
const KEYWORDS = new Set(["name", "origin", "rule", "off", "if", "and", "while", "or", "do"]);

/** A line in the colours of its tokens, never wider or narrower than the plain text. */
function coloured(line) {
  return [...line.matchAll(TOKEN)].map(([word, comment, string]) => {
    const kind = comment ? "comment" : string ? "string" : KEYWORDS.has(word) ? "keyword" : "";
    if (kind) return h("span", { class: kind }, word);
    if (word === "true" || word === "false") return h("span", { class: word }, word);
    return word;
  });
}

/** The text behind the text area: coloured, numbered, with marks at the lines. */
class Backdrop {
  #lines = [];

  constructor() {
    this.node = h("ol", { class: "lines", "aria-hidden": "true" });
  }

  write(text) {
    const lines = text.split("\n");
    while (this.#lines.length > lines.length) this.#lines.pop().node.remove();
    lines.forEach((line, i) => {
      this.#lines[i] ??= { node: this.node.appendChild(h("li")), text: null };
      const shown = this.#lines[i];
      if (shown.text === line) return;
      shown.text = line;
      shown.node.replaceChildren(...(line ? coloured(line) : ["\u200b"]));
    });
  }

  /** @param {import("./protocol.js").RuleFinding[]} findings */
  mark(findings) {
    this.#lines.forEach(({ node }, i) => {
      const [worst] = findings.filter((finding) => finding.line === i + 1);
      node.className = worst?.severity ?? "";
    });
  }
}

export class TextTab {
  #stored = "";
  #base = ""; // the rules for which the text is typed
  #sent = null;
  #known = false;
  #timer = null;
  #findings = [];

  /**
   * @param {Element} root
   * @param {import("./session.js").Session} session
   * @param {(draft: boolean) => void} drafting Told whether there is text that is not applied.
   */
  constructor(root, session, drafting) {
    Object.assign(this, { root, session, drafting });
    this.area = h("textarea", { class: "source", spellcheck: "false", autocomplete: "off", rows: 1 });
    this.area.addEventListener("input", () => this.#typed());
    this.area.addEventListener("connectionlost", () => (this.#sent = null));
    this.area.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.#apply();
    });
    identify(this.area, "source", "The rules as text");
    this.backdrop = new Backdrop();
    this.list = h("ul", { class: "findings", "aria-live": "polite", "data-testid": "text-findings" });
    /** Nodes for the bar above. */
    this.tools = this.#tools();
    root.append(this.meanwhile, h("div", { class: "editor" }, this.backdrop.node, this.area), this.list);
  }

  /** @param {import("./protocol.js").RulesMessage} message */
  update({ text }) {
    if (text === undefined) return;
    if (!this.#known) this.#recall();
    this.#known = true;
    const typed = this.area.value;
    const untouched = typed === this.#stored || typed === this.#sent;
    this.#stored = text;
    if (untouched) this.#sent = null;
    if (untouched && typed !== text) this.#write(text);
    else this.#refresh();
  }

  /** @param {import("./protocol.js").TextFindingsMessage} message */
  showFindings({ findings }) {
    this.#findings = this.area.value === this.#stored ? [] : findings;
    this.backdrop.mark(this.#findings);
    this.list.replaceChildren(...this.#findings.map((finding) => this.#finding(finding)));
    this.#refresh();
  }

  /** There is a connection again: what was typed without one has not been checked. */
  comeBack() {
    if (this.area.value !== this.#stored) this.#check();
  }

  /** True if there is text that would be lost with this page. */
  get unkept() {
    return this.area.value !== this.#stored && !tabStore.lasts(KEPT);
  }

  /** The tab comes into view. */
  shown() {
    this.backdrop.write(this.area.value);
    this.area.focus({ preventScroll: true });
  }

  #tools() {
    const button = (id, label, title, act) => {
      const node = h("button", { type: "button", class: "button", title, "data-testid": id }, label);
      node.addEventListener("click", act);
      return node;
    };
    this.state = h("span", { class: "text-state", role: "status", "data-testid": "text-state" });
    this.revert = button("revert-text", "Revert", "Back to the rules as they are", () => this.#revert());
    this.apply = button("apply-text", "Apply", "Ctrl+Enter", () => this.#apply());
    this.apply.classList.add("first");
    this.meanwhile = h("div", { class: "notice offline", role: "status", hidden: true });
    identify(this.meanwhile, "changed-meanwhile");
    const words = "Changed meanwhile: the rules have changed since you began to type. Apply replaces them by your text, Revert shows them.";
    this.meanwhile.append(h("span", { class: "notice-text" }, words));
    return [this.state, this.revert, this.apply];
  }

  /** Text that was typed before this page was loaded again is a draft again. */
  #recall() {
    const kept = JSON.parse(tabStore.get(KEPT) ?? "null");
    if (!kept) return;
    this.area.value = kept.text;
    this.#stored = this.#base = kept.rules;
    this.#check();
  }

  #revert() {
    this.#write(this.#stored);
    this.area.focus({ preventScroll: true });
    this.area.dispatchEvent(new Event("reverted", { bubbles: true }));
  }

  #write(text) {
    this.area.value = text;
    this.#clear();
  }

  #typed() {
    clearTimeout(this.#timer);
    if (this.area.value === this.#stored) return this.#clear();
    this.#timer = setTimeout(() => this.#check(), PAUSE);
    this.#refresh();
  }

  #clear() {
    clearTimeout(this.#timer);
    this.#sent = null;
    this.showFindings({ findings: [] });
  }

  #check() {
    if (this.session.connected) this.session.command(request.checkText(this.area.value));
  }

  #refresh() {
    const draft = this.area.value !== this.#stored;
    if (!draft) this.#base = this.#stored;
    this.meanwhile.hidden = this.#base === this.#stored;
    const errors = this.#findings.filter((finding) => finding.severity === "error").length;
    if (!this.root.hidden) this.backdrop.write(this.area.value);
    this.area.toggleAttribute("data-draft", draft);
    this.area.setAttribute("aria-invalid", String(errors > 0));
    this.revert.disabled = !draft;
    this.apply.disabled = !draft || errors > 0;
    const problems = errors === 1 ? "1 error" : `${errors} errors`;
    this.state.textContent = errors ? problems : draft ? "not applied yet" : "";
    this.state.classList.toggle("error", errors > 0);
    this.drafting(draft);
    tabStore.set(KEPT, draft ? JSON.stringify({ text: this.area.value, rules: this.#base }) : null);
  }

  #apply() {
    if (this.apply.disabled) return;
    const [text, base] = [this.area.value, this.#base];
    if (this.session.command(request.setText(text), () => this.#putBack(text, base))) this.#sent = text;
    this.area.focus({ preventScroll: true });
  }

  /** The text that was applied was not taken: it is a draft again, unless something else is typed by now. */
  #putBack(text, base) {
    this.#sent = null;
    if (this.area.value === this.#stored) [this.area.value, this.#base] = [text, base];
    this.#refresh();
  }

  #finding({ line, element, message, severity }) {
    const words = element ? `${element}: ${message}` : message;
    if (!line) return findingLine(severity, words);
    const go = h("button", { type: "button", class: "line-link" }, `line ${line}`);
    go.addEventListener("click", () => this.#goTo(line));
    return findingLine(severity, go, ` ${words}`);
  }

  #goTo(line) {
    const lines = this.area.value.split("\n");
    const start = lines.slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
    this.area.focus();
    this.area.setSelectionRange(start, start + (lines[line - 1] ?? "").length);
  }
}
