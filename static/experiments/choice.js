/** Which rule sets are compared in which scenarios, and how often they run. */

import { h, icon, identify } from "../common/dom.js";
import { ruleSetFile } from "../common/file.js";
import { NumberField } from "./field.js";
import { request } from "./protocol.js";

export class Choice {
  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   * @param {import("../common/notices.js").Notices} notices
   */
  constructor(root, send, notices) {
    this.send = send;
    this.notices = notices;
    this.rules = new Offers("rules", "Rule sets", send);
    this.scenarios = new Offers("scenarios", "Scenarios", send);
    const typed = (name) => (value) => send(request.choice(name, value));
    this.runs = new NumberField("runs", "Runs", typed("runs"));
    this.seed = new NumberField("seed", "Seed", typed("seed"));
    this.against = h("select", { id: "against", onchange: () => typed("against")(this.against.value) });
    identify(this.against, "against");
    const against = h("div", { class: "field" }, h("label", { for: "against" }, "Against"), this.against);
    this.start = h("button", { type: "button", class: "button first", onclick: () => send(request.compare()) }, "Compare");
    this.cancel = h("button", { type: "button", class: "button", hidden: true, onclick: () => send(request.cancel()) }, "Cancel");
    identify(this.start, "compare-start");
    identify(this.cancel, "compare-cancel");
    this.progress = h("progress", { "aria-label": "Runs done", max: 1, value: 0, hidden: true });
    identify(this.progress, "compare-progress");
    const fields = h("div", { class: "choice-foot" }, this.runs.node, this.seed.node, against, this.start, this.cancel);
    const both = h("div", { class: "offers" }, this.rules.node, this.scenarios.node);
    this.rules.node.append(this.#files());
    root.append(both, fields, this.progress);
  }

  /** @param {import("./protocol.js").ChoiceMessage} message */
  update({ rules, scenarios, table, arena, against, runs, seed, findings }) {
    this.rules.show(rules, findings.rules, { table });
    this.scenarios.show(scenarios, findings.scenarios, { arena });
    this.runs.show(runs, findings.runs);
    this.seed.show(seed, findings.seed);
    this.start.disabled = Object.keys(findings).length > 0;
    const chosen = rules.filter((offer) => offer.chosen).map(({ name }) => name);
    this.against.replaceChildren(...chosen.map((name) => h("option", { value: name }, name)));
    if (chosen.length) this.against.value = chosen.includes(against) ? against : chosen[0];
  }

  /** @param {import("./protocol.js").ComparedMessage} message */
  showProgress({ busy, share }) {
    this.cancel.hidden = this.progress.hidden = !busy;
    this.progress.value = share;
  }

  #files() {
    const file = ruleSetFile(this.notices, ({ name, text }) => this.send(request.file(name, text)));
    const button = h("button", { type: "button", class: "quiet", onclick: () => file.click() }, icon("open"), "Open file…");
    identify(button, "open-file");
    return h("div", {}, button, file);
  }
}

/** A list to tick; its rows are kept, so that the focus stays. */
class Offers {
  constructor(what, title, send) {
    this.what = what;
    this.send = send;
    this.list = h("ul", {});
    this.error = h("span", { class: "field-error", role: "alert", hidden: true });
    identify(this.list, what, title);
    identify(this.error, `${what}-error`);
    this.node = h("div", { class: "offer" }, h("h2", {}, title), this.list, this.error);
  }

  /**
   * @param {import("./protocol.js").Offer[]} offers
   * @param {string} [error]
   * @param {Object<string, string>} details What some of the names stand for now.
   */
  show(offers, error = "", details = {}) {
    while (this.list.children.length > offers.length) this.list.lastChild.remove();
    offers.forEach(({ name, chosen }, i) => {
      const row = this.list.children[i] ?? this.list.appendChild(this.#row());
      const [box, words, detail] = row.firstChild.children;
      row.dataset.name = name;
      box.checked = chosen;
      identify(box, `${this.what}-${i + 1}`);
      words.textContent = name;
      detail.textContent = details[name] ? `now ${details[name]}` : "";
    });
    this.error.textContent = error;
    this.error.hidden = !error;
  }

  #row() {
    const tick = ({ target }) =>
      this.send(request.choose(this.what, target.closest("li").dataset.name, target.checked));
    const box = h("input", { type: "checkbox", onchange: tick });
    return h("li", {}, h("label", {}, box, h("span", {}), h("span", { class: "detail" })));
  }
}
