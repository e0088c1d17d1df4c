/** The next campaign, and those that are kept: opened, continued, their reports read. */

import { h, icon, identify } from "../common/dom.js";
import { reportAddress } from "./campaign.js";
import { duration } from "./duration.js";
import { NumberField } from "./field.js";
import { request } from "./protocol.js";

const FIELDS = { runs: "Evolutions", generations: "Generations", evaluations: "Runs of each", seed: "First seed" };
const WHAT =
  "Repeats the paper's experiments: evolves, runs the evolved rules beside the paper's in all its settings, " +
  "and holds every claim to the data.";

export class Campaigns {
  /** @type {Map<string, Item>} */
  #items = new Map();
  #running = null;

  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   */
  constructor(root, send) {
    this.send = send;
    this.sizes = h("div", { class: "segments", role: "group", "aria-label": "Size" });
    this.fields = new Map(
      Object.entries(FIELDS).map(([name, label]) => [
        name,
        new NumberField(`draft-${name}`, label, (value) => send(request.draft(name, value))),
      ]),
    );
    this.time = h("span", { class: "where", role: "status" });
    identify(this.time, "draft-time");
    this.start = h("button", { type: "button", class: "button first", onclick: () => send(request.start()) }, "Start campaign");
    identify(this.start, "campaign-start");
    this.list = h("ul", { class: "campaign-list" });
    identify(this.list, "campaigns", "Campaigns");
    const fields = h("div", { class: "fields" }, ...[...this.fields.values()].map(({ node }) => node));
    root.append(
      h("p", { class: "note" }, WHAT),
      h("div", { class: "form-head" }, h("h2", {}, "New campaign"), this.sizes),
      fields,
      h("div", { class: "form-foot" }, this.start, this.time),
      this.list,
    );
  }

  /** @param {import("./protocol.js").DraftMessage} message */
  showDraft({ values, findings, sizes, seconds }) {
    const buttons = new Map([...this.sizes.children].map((button) => [button.dataset.name, button]));
    for (const { name, chosen } of sizes) {
      const button = buttons.get(name) ?? this.sizes.appendChild(this.#size(name));
      button.setAttribute("aria-pressed", String(chosen));
    }
    for (const [name, field] of this.fields) field.show(values[name], findings[name]);
    this.time.textContent = seconds === null ? "" : `takes about ${duration(seconds)} here`;
    this.start.disabled = Object.keys(findings).length > 0;
  }

  /** @param {import("./protocol.js").CampaignStatusMessage} message */
  showStatus({ phase, name }) {
    this.#running = phase === "RUNNING" ? name : null;
    for (const item of this.#items.values()) item.run(item.name === this.#running);
  }

  /** @param {import("./protocol.js").CampaignsMessage} message */
  update({ shown, campaigns }) {
    const names = new Set(campaigns.map(({ name }) => name));
    for (const [name, item] of this.#items) {
      if (names.has(name)) continue;
      item.node.remove();
      this.#items.delete(name);
    }
    campaigns.forEach((campaign, i) => {
      const item = this.#items.get(campaign.name) ?? new Item(campaign.name, this.send);
      this.#items.set(campaign.name, item);
      if (this.list.children[i] !== item.node) this.list.insertBefore(item.node, this.list.children[i] ?? null);
      item.update(campaign, i + 1, campaign.name === shown);
      item.run(campaign.name === this.#running);
    });
  }

  #size(name) {
    const onclick = () => this.send(request.size(name));
    const button = h("button", { type: "button", class: "segment", "data-name": name, onclick }, name);
    identify(button, `size-${name}`);
    return button;
  }
}

class Item {
  constructor(name, send) {
    this.name = name;
    this.open = h("button", { type: "button", class: "campaign-name", onclick: () => send(request.open(name)) }, name);
    this.details = h("div", { class: "detail" });
    this.state = h("span", { class: "detail" });
    this.goOn = h("button", { type: "button", class: "quiet", onclick: () => send(request.resume(name)) }, "Go on");
    const address = reportAddress(name);
    this.report = h("a", { class: "quiet", href: address, target: "_blank", rel: "noopener" }, "Report");
    this.save = h("a", { class: "quiet", href: address, download: `${name}.html` }, icon("save"));
    const middle = h("div", { class: "campaign-middle" }, this.open, this.details);
    this.node = h("li", { class: "campaign" }, middle, this.state, this.goOn, this.report, this.save);
  }

  /**
   * @param {import("./protocol.js").KeptCampaign} summary
   * @param {number} number
   * @param {boolean} shown
   */
  update({ name, problem, plan, reported, written }, number, shown) {
    this.reported = reported;
    this.problem = problem;
    this.node.dataset.testid = `campaign-${number}`;
    identify(this.open, `open-${number}`);
    identify(this.goOn, `go-on-${number}`, `Go on with ${name}`);
    identify(this.report, `report-${number}`, `Report of ${name}`);
    identify(this.save, `save-report-${number}`, `Save the report of ${name}`);
    this.node.classList.toggle("shown", shown);
    this.open.disabled = Boolean(problem);
    this.report.hidden = this.save.hidden = !reported;
    this.details.textContent = problem || planWords(plan, written);
    this.details.classList.toggle("problem", Boolean(problem));
  }

  /** @param {boolean} running It is under way. */
  run(running) {
    this.state.textContent = running ? "running" : this.reported || this.problem ? "" : "not finished";
    this.state.classList.toggle("running", running);
    this.goOn.hidden = running || this.reported || Boolean(this.problem);
  }
}

function planWords({ runs, generations, evaluations, seed }, written) {
  const day = new Date(1000 * written).toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
  return `${runs} × ${generations} generations · ${evaluations} runs of each · seed ${seed} · ${day}`;
}
