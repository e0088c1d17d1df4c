/** Name and origin of the rule set, undo and redo, load and save. */

import { h, icon, iconButton, identify } from "../common/dom.js";
import { ruleSetFile } from "../common/file.js";
import { menuButton } from "../common/menu.js";
import { draftField, growing } from "./field.js";
import { edits, request } from "./protocol.js";

/**
 * @param {import("./protocol.js").Origin} origin
 * @param {import("./protocol.js").VocabularyMessage} vocabulary
 * @returns {string} Where the rules came from, in words.
 */
export function describeOrigin({ preset, run, generation, fitness }, vocabulary) {
  const title = vocabulary.presets.find((known) => known.name === preset)?.title ?? preset;
  return [
    title && `preset ${title}`,
    run && `run ${run}`,
    generation !== null && `generation ${generation}`,
    fitness !== null && `fitness ${Number(fitness.toPrecision(4))}`,
  ]
    .filter(Boolean)
    .join(" · ");
}

export class Header {
  /**
   * @param {Element} root
   * @param {import("./session.js").Session} session
   * @param {import("../common/notices.js").Notices} notices
   * @param {Element} people Who else is here.
   * @param {Element} help Shows the keys.
   * @param {...Element} below Shown under the title.
   */
  constructor(root, session, notices, people, help, ...below) {
    this.session = session;
    this.notices = notices;
    this.undo = iconButton("undo", "Undo (Ctrl+Z)", () => session.command(request.undo()));
    this.redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => session.command(request.redo()));
    identify(this.undo, "undo", "Undo");
    identify(this.redo, "redo", "Redo");
    this.origin = h("div", { class: "origin", "data-testid": "origin" });
    const title = h("div", { class: "title" }, this.#name(), this.origin, people);
    const actions = h("div", { class: "actions" }, help, this.undo, this.redo, ...this.#files());
    root.append(h("div", { class: "title-bar" }, title, actions), ...below);
  }

  /** @param {import("./protocol.js").RulesMessage} message */
  update({ rule_set: { name, origin }, can_undo, can_redo }) {
    if (this.session.replaced) this.draft.giveUp(false);
    this.draft.update(name);
    const words = describeOrigin(origin, this.session.vocabulary);
    this.origin.textContent = words;
    this.origin.hidden = !words;
    this.undo.disabled = !can_undo;
    this.redo.disabled = !can_redo;
    document.title = `${name || "Rules"} - GESwarm`;
  }

  #name() {
    const input = h("textarea", {
      rows: 1,
      cols: 1,
      class: "name",
      "aria-label": "Name of the rule set",
      "data-testid": "name",
      placeholder: "Name",
      spellcheck: "false",
    });
    const wrapper = growing(input);
    this.draft = draftField(input, {
      tidy: (text) => text.replace(/\s+/g, " ").trim(),
      commit: (name, refused) => this.session.edit(() => edits.setName(name), refused),
      keep: (text, cursor) =>
        this.session.keep({
          what: "The name of the rules",
          text,
          cursor,
          rule: null,
          edit: (name) => edits.setName(name),
        }),
      changed: wrapper.fit,
    });
    return wrapper.node;
  }

  #files() {
    const file = ruleSetFile(this.notices, ({ name, text }) =>
      this.session.command(request.loadText(text, name)),
    );
    const load = menuButton(
      { class: "button", "data-testid": "load", "aria-label": "Load a rule set" },
      () => this.#sources(file),
      icon("open"),
      "Load",
    );
    const save = h(
      "button",
      {
        type: "button",
        class: "button",
        "data-testid": "save",
        "aria-label": "Save the rule set as a YAML file",
        onclick: () => this.session.command(request.save("yaml")),
      },
      icon("save"),
      "Save",
    );
    return [load, save, file];
  }

  #sources(file) {
    const presets = (this.session.vocabulary?.presets ?? []).map(({ name, title }) => ({
      id: name,
      label: title,
      detail: "preset",
      choose: () => this.session.command(request.loadPreset(name)),
    }));
    const open = { id: "file", label: "Open file…", detail: "YAML, text or JSON", divided: true };
    return [...presets, { ...open, choose: () => file.click() }];
  }
}

/** Hand a file to the browser's downloads. */
export function download({ name, text }) {
  const address = URL.createObjectURL(new Blob([text], { type: "application/yaml" }));
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
