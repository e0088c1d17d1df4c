/** The next run: all its parameters, and the rules that must not change. */

import { h, identify } from "../common/dom.js";
import { request } from "./protocol.js";
import { insteadOf } from "./question.js";

/** @param {string} name A setting. @returns {string} The same to read. */
export const readable = (name) => name.replaceAll("_", " ");

const sentence = (name) => readable(name).replace(/^./, (first) => first.toUpperCase());

export class Form {
  /** @type {Map<string, Control>} */
  #controls = new Map();

  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   * @param {() => void} started
   */
  constructor(root, send, started) {
    this.send = send;
    this.started = started;
    this.status = null;
    this.presets = h("div", { class: "segments", role: "group", "aria-label": "Preset" });
    this.where = h("span", { class: "where", "data-testid": "plan-scenario" });
    this.fields = h("div", { class: "fields" });
    this.switches = h("div", { class: "switches" });
    this.rules = h("ul", { class: "frozen" });
    this.moved = h("p", { class: "note", hidden: true, "data-testid": "plan-moved" }, MOVED);
    this.start = h("button", { type: "button", class: "button first", onclick: () => this.#start() }, "Start evolution");
    identify(this.start, "start");
    const head = h("div", { class: "form-head" }, h("h2", {}, "Preset"), this.presets, this.where);
    root.append(head, this.fields, this.switches, h("h2", {}, "Rules of the table"));
    this.table = root.appendChild(h("div", {}));
    root.append(h("h3", {}, "Freeze rules that must not change"), this.rules, this.moved);
    root.append(h("div", { class: "form-foot" }, this.start));
  }

  /**
   * Once: what is typed outlives the connection.
   *
   * @param {import("./protocol.js").FormMessage} message
   */
  build({ presets, fields }) {
    if (this.#controls.size) return;
    this.presets.replaceChildren(...presets.map((name) => this.#preset(name)));
    const seed = { name: "seed", kind: "whole", choices: [], help: "Equal seeds give equal runs, whatever the number of workers." };
    const controls = [...fields, seed].map((field) => this.#control(field));
    const inGroup = (wanted) => controls.filter(({ field }) => (field.kind === "switch") === wanted).map(({ node }) => node);
    this.fields.replaceChildren(...inGroup(false));
    this.switches.replaceChildren(...inGroup(true));
    const entry = { name: "from_table", kind: "switch", choices: [], help: "They take the place of the worst; frozen rules come first." };
    this.table.replaceChildren(this.#control(entry).node);
  }

  /** @param {import("./protocol.js").PlanMessage} message */
  update(message) {
    for (const button of this.presets.children) {
      button.setAttribute("aria-pressed", String(button.dataset.name === message.preset));
    }
    this.where.textContent = `in the scenario of the arena, ${message.scenario}`;
    const values = { ...message.values, seed: message.seed, from_table: message.from_table };
    for (const [name, control] of this.#controls) {
      control.show(values[name], message.findings[name] ?? "");
      control.node.classList.toggle("changed", message.changed.includes(name));
      control.node.classList.toggle("idle", message.idle.includes(name));
    }
    const words = `${message.table || "The rules of the table"} as edited: enters the first generation`;
    this.#controls.get("from_table").name(words);
    this.moved.hidden = !message.moved;
    this.start.disabled = Object.keys(message.findings).length > 0;
    this.#showRules(message.rules);
  }

  #preset(name) {
    const onclick = () => this.send(request.preset(name));
    const button = h("button", { type: "button", class: "segment", "data-name": name, onclick }, name);
    identify(button, `preset-${name}`);
    return button;
  }

  #control(field) {
    const control = new Control(field, (value) => this.send(request.plan(field.name, value)));
    this.#controls.set(field.name, control);
    return control;
  }

  /** Rows are kept, so that the focus stays where it is. */
  #showRules(rules) {
    while (this.rules.children.length > rules.length) this.rules.lastChild.remove();
    while (this.rules.children.length < rules.length) this.rules.append(this.#rule(this.rules.children.length));
    rules.forEach(({ text, frozen, enabled }, i) => {
      const [box, , words] = this.rules.children[i].firstChild.children;
      box.checked = frozen;
      box.disabled = !enabled;
      words.textContent = enabled ? text : `${text} (switched off)`;
    });
  }

  #rule(i) {
    const onchange = (event) => this.send(request.freeze(i, event.target.checked));
    const box = h("input", { type: "checkbox", onchange });
    identify(box, `freeze-${i + 1}`);
    const number = h("span", { class: "rule-number" }, h("i", {}, "R"), h("sub", {}, String(i + 1)));
    return h("li", {}, h("label", {}, box, number, h("span", {})));
  }

  #start() {
    insteadOf(this.status, (instead) => this.send(request.start(instead)) && this.started());
  }
}

const MOVED = "Frozen rules come before the evolved ones, so these would move to the front.";

/** One parameter: its name, its value, its explanation and what is wrong with it. */
class Control {
  /**
   * @param {import("./protocol.js").SettingField} field
   * @param {(value: number | string | boolean) => void} changed
   */
  constructor(field, changed) {
    this.field = field;
    const id = `plan-${field.name}`;
    this.input = { choice: select, switch: checkbox }[field.kind]?.(field) ?? numberInput(field);
    this.input.id = id;
    identify(this.input, id);
    this.input.addEventListener("input", () => (this.typing = true));
    this.input.addEventListener("blur", () => (this.typing = false));
    this.input.addEventListener("change", () => {
      this.typing = false;
      changed(valueOf(this.input));
    });
    this.label = h("label", { for: id }, sentence(field.name));
    this.error = h("span", { class: "field-error", id: `${id}-error`, role: "alert", hidden: true });
    identify(this.error, `${id}-error`);
    this.input.setAttribute("aria-describedby", this.error.id);
    const parts = field.kind === "switch" ? [this.input, this.label] : [this.label, this.input];
    this.node = h("div", { class: `field ${field.kind}`, title: field.help }, ...parts, this.error);
  }

  name(words) {
    this.label.textContent = words;
  }

  show(value, error) {
    if (this.input.type === "checkbox") this.input.checked = value;
    else if (!this.typing) this.input.value = value;
    this.error.textContent = error;
    this.error.hidden = !error;
    this.input.toggleAttribute("aria-invalid", Boolean(error));
  }
}

const select = ({ choices }) => h("select", {}, ...choices.map((name) => h("option", { value: name }, name)));
const checkbox = () => h("input", { type: "checkbox" });
const numberInput = () => h("input", { type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false" });

/** @returns {number | string | boolean} A number if it is one, else what was typed, to be told what is wrong. */
function valueOf(input) {
  if (input.type === "checkbox") return input.checked;
  const text = input.value.trim().slice(0, 40);
  const number = Number(text);
  return text !== "" && Number.isFinite(number) ? number : text;
}
