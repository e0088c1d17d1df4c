/** The runs that are kept: compared, looked at, resumed, deleted. */

import { COLOURS } from "../common/chart.js";
import { h, icon, iconButton, identify } from "../common/dom.js";
import { figure } from "../common/figures.js";
import { presetWords } from "./header.js";
import { request } from "./protocol.js";
import { ask } from "./question.js";

const STATES = { RUNNING: "running", PAUSED: "paused", STOPPED: "not finished", FINISHED: "finished", FAILED: "cannot be read" };

export class Runs {
  #items = new Map();
  #shown = null;

  /**
   * @param {HTMLElement} root
   * @param {(message: object) => boolean} send
   * @param {(name: string) => void} resume
   */
  constructor(root, send, resume) {
    this.send = send;
    this.resume = resume;
    this.most = 0;
    this.list = h("ul", { class: "runs-list" });
    this.note = h("p", { class: "note" });
    root.append(this.note, this.list);
  }

  /** @param {import("./protocol.js").RunsMessage} message */
  update({ runs }) {
    this.note.textContent = runs.length ? "Tick runs to lay their curves over one another." : "No runs are kept here yet: every evolution that is started will be.";
    const full = runs.filter(({ colour }) => colour !== null).length >= this.most;
    const names = new Set(runs.map((run) => run.name));
    for (const [name, item] of this.#items) {
      if (names.has(name)) continue;
      item.node.remove();
      this.#items.delete(name);
    }
    runs.forEach((run, i) => {
      const item = this.#items.get(run.name) ?? new RunItem(run.name, this.send, this.resume);
      this.#items.set(run.name, item);
      if (this.list.children[i] !== item.node) this.list.insertBefore(item.node, this.list.children[i] ?? null);
      item.update(run, full && run.colour === null, i);
    });
    this.#markShown();
  }

  /** @param {import("./protocol.js").EvolutionMessage} message */
  showStatus({ shown }) {
    this.#shown = shown;
    this.#markShown();
  }

  #markShown() {
    for (const [name, item] of this.#items) item.node.classList.toggle("shown", name === this.#shown);
  }
}

class RunItem {
  constructor(name, send, resume) {
    this.box = h("input", { type: "checkbox", onchange: () => send(request.compare(name, this.box.checked)) });
    this.open = h("button", { type: "button", class: "run-name", title: "Look at this run", onclick: () => send(request.open(name)) }, name);
    this.details = h("div", { class: "run-details" });
    this.best = h("b", { class: "run-best", title: "Best fitness so far" });
    this.state = h("span", { class: "run-state" });
    this.go = h("button", { type: "button", class: "quiet", onclick: () => resume(name) }, "Resume");
    const text = `The directory ${name} with its history and best rules is removed for good.`;
    const question = () => ask("Delete this run?", text, "Delete", () => send(request.delete(name)));
    this.remove = iconButton("trash", `Delete ${name}`, question);
    const middle = h("div", { class: "run-middle" }, this.open, this.details);
    this.node = h("li", { class: "run" }, this.box, middle, this.best, this.state, this.go, this.remove);
  }

  /**
   * @param {import("./protocol.js").KeptRun} run
   * @param {boolean} full No more can be compared.
   * @param {number} i
   */
  update(run, full, i) {
    const number = i + 1;
    this.node.dataset.testid = `run-${number}`;
    identify(this.box, `compare-${number}`, `Compare ${run.name}`);
    identify(this.open, `open-${number}`);
    identify(this.go, `resume-${number}`, `Resume ${run.name}`);
    identify(this.remove, `delete-${number}`, `Delete ${run.name}`);
    const compared = run.colour !== null;
    this.box.checked = compared;
    this.box.disabled = !compared && (Boolean(run.problem) || full);
    this.box.style.setProperty("accent-color", compared ? COLOURS[run.colour] : "auto");
    const active = run.elsewhere || run.phase === "RUNNING" || run.phase === "PAUSED";
    this.open.disabled = Boolean(run.problem);
    this.details.replaceChildren(...(run.problem ? [icon("warning"), run.problem] : [detailWords(run)]));
    this.details.classList.toggle("problem", Boolean(run.problem));
    this.best.textContent = run.best === null ? "" : `best ${figure(run.best)}`;
    this.state.textContent = run.elsewhere ? "under way elsewhere" : STATES[run.phase];
    this.state.className = `run-state ${run.phase.toLowerCase()}`;
    this.go.hidden = run.elsewhere || run.phase !== "STOPPED";
    this.remove.disabled = active;
  }
}

function detailWords({ scenario, preset, seed, done, generations, fall, written }) {
  const day = new Date(1000 * written).toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
  const parts = [`scenario ${scenario}`, presetWords(preset), `seed ${seed}`, `${done} of ${generations} generations`, fall, day];
  return parts.filter(Boolean).join(" · ");
}
