/** The campaign looked at: how far each part is, the curves of its evolutions, and its claims. */

import { COLOURS, Chart, swatch } from "../common/chart.js";
import { h, identify } from "../common/dom.js";

export class Campaign {
  /** @param {HTMLElement} root */
  constructor(root) {
    this.title = h("h2", { "data-testid": "campaign-title" });
    this.error = h("div", { class: "failure", role: "alert", hidden: true, "data-testid": "campaign-problem" });
    this.parts = h("ul", { class: "parts" });
    identify(this.parts, "parts", "Parts of the campaign");
    this.chart = new Chart("curves", "Best fitness so far of each evolution");
    this.legend = h("div", { class: "chart-legend" });
    this.claims = h("table", { class: "claims" });
    identify(this.claims, "claims", "Claims of the paper");
    this.frame = h("iframe", { sandbox: "allow-scripts" });
    identify(this.frame, "report");
    this.report = h("details", { class: "report", ontoggle: () => this.#load() }, h("summary", {}, "All figures and tables"), this.frame);
    identify(this.report, "figures");
    const parts = [this.title, this.parts, this.chart.node, this.legend, this.claims, this.report];
    this.node = h("div", { class: "campaign-look", hidden: true }, ...parts);
    root.append(this.error, this.node);
  }

  /** @param {import("./protocol.js").CampaignMessage} message */
  update(message) {
    this.error.textContent = message.problem;
    this.error.hidden = !message.problem;
    this.node.hidden = message.name === null;
    if (message.name === null) return;
    this.title.textContent = message.name;
    this.parts.hidden = message.parts.every(({ done, total }) => done >= total);
    this.parts.replaceChildren(...message.parts.map(part));
    this.#draw(message);
    this.claims.hidden = message.claims.length === 0;
    const heads = ["the paper", "found", "verdict"].map((text) => h("th", { scope: "col" }, text));
    this.claims.replaceChildren(h("thead", {}, h("tr", {}, ...heads)), h("tbody", {}, ...message.claims.map(claim)));
    this.report.hidden = !message.reported;
    this.address = message.reported ? reportAddress(message.name) : "";
    this.frame.title = `Report of ${message.name}`;
    this.#load();
  }

  /** The report is large: it is fetched when it is asked for, and once. */
  #load() {
    const address = this.report.open && this.address ? `${this.address}#figures` : "about:blank";
    if (this.frame.getAttribute("src") !== address) this.frame.setAttribute("src", address);
  }

  #draw({ curves, levels }) {
    const lines = curves
      .map(({ name, generation, best_so_far: y }, i) => ({ label: name, ...ink(i), x: generation, y }))
      .filter(({ x }) => x.length);
    this.chart.node.hidden = this.legend.hidden = lines.length === 0;
    const dashed = levels.map(({ name, mean }) => ({ label: name, y: mean })).sort((a, b) => b.y - a.y);
    this.chart.show({ lines, levels: dashed, marks: [] });
    this.legend.replaceChildren(...lines.map((line) => h("span", {}, swatch(line), line.label)));
  }
}

/** @param {string} name Of a campaign. @returns {string} Where its report is. */
export function reportAddress(name) {
  return `files/report/${encodeURIComponent(name)}`;
}

/** Every line another colour; when there are no more, the same again, dashed. */
function ink(i) {
  return { kind: i < COLOURS.length ? "other" : "other again", colour: COLOURS[i % COLOURS.length] };
}

function part({ name, done, total }) {
  const bar = h("progress", { max: total, value: done, "aria-label": name });
  const words = total === 1 ? (done ? "done" : "") : `${done} of ${total}`;
  return h("li", { class: done >= total ? "done" : "" }, h("span", {}, name), bar, h("span", { class: "detail" }, words));
}

function claim({ where, paper, found, verdict, words }) {
  const said = h("td", {}, paper, h("div", { class: "detail" }, where));
  const badge = h("span", { class: `claim-verdict ${verdict.toLowerCase()}` }, words);
  return h("tr", {}, said, h("td", { class: "found" }, found), h("td", {}, badge));
}
