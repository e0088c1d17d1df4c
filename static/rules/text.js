/** The rules as text in the rule language, checked while it is typed. */

import { h, identify } from "../common/dom.js";
import { findingLine } from "./finding.js";

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

  /** @param {import("./protocol.js").TextFinding[]} findings */
  mark(findings) {
    this.#lines.forEach(({ node }, i) => {
      const [worst] = findings.filter((finding) => finding.line === i + 1);
      node.className = worst?.severity ?? "";
    });
  }
}

export class TextTab {
  #stored = "";
  #sent = null;
  #applied = {};
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
    const typed = this.area.value;
    const untouched = typed === this.#stored || typed === this.#sent;
    if (text !== this.#stored) this.meanwhile.hidden = untouched || typed === text;
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

  /** The server could not do something: what was sent is a draft again. */
  refused() {
    this.#sent = null;
  }

  /**
   * Somebody else changed the rules before the text that was applied got there: it is a draft again.
   *
   * @param {number} version The one that it was meant for.
   */
  tooLate(version) {
    if (version !== this.#applied.version) return;
    this.area.value = this.#applied.text;
    this.meanwhile.hidden = false;
    this.#refresh();
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
    this.revert = button("revert-text", "Revert", "Back to the rules as they are", () => this.#write(this.#stored));
    this.apply = button("apply-text", "Apply", "Ctrl+Enter", () => this.#apply());
    this.apply.classList.add("first");
    this.meanwhile = h("div", { class: "notice offline", role: "status", hidden: true });
    identify(this.meanwhile, "changed-meanwhile");
    const words = "Changed meanwhile: the rules have changed since you began to type. Apply replaces them by your text, Revert shows them.";
    this.meanwhile.append(h("span", { class: "notice-text" }, words));
    return [this.state, this.revert, this.apply];
  }

  #write(text) {
    this.area.value = text;
    this.meanwhile.hidden = true;
    this.#clear();
  }

  #typed() {
    clearTimeout(this.#timer);
    if (this.area.value === this.#stored) {
      this.meanwhile.hidden = true;
      this.#clear();
      return;
    }
    this.#timer = setTimeout(() => this.#check(), PAUSE);
    this.#refresh();
  }

  #clear() {
    clearTimeout(this.#timer);
    this.#sent = null;
    this.showFindings({ findings: [] });
  }

  #check() {
    if (this.session.connected()) this.session.command({ type: "check_text", text: this.area.value });
  }

  #refresh() {
    const draft = this.area.value !== this.#stored;
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
  }

  #apply() {
    if (this.apply.disabled) return;
    const text = this.area.value;
    this.#applied = { version: this.session.state.version, text };
    if (this.session.command({ type: "set_text", text })) this.#sent = text;
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
