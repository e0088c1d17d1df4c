/** The run looked at, how far it is, and the buttons that stop it and take its best. */

import { h, icon, identify } from "../common/dom.js";
import { figure } from "../common/figures.js";
import { readable } from "./form.js";
import { request } from "./protocol.js";

const WORDS = {
  IDLE: "not started",
  RUNNING: "running",
  PAUSED: "paused",
  STOPPED: "stopped",
  FINISHED: "finished",
  FAILED: "failed",
};

/** @param {import("./protocol.js").NearestPreset} preset @returns {string} "preset modern, changed: mutation". */
export function presetWords({ name, changed }) {
  return changed.length ? `preset ${name}, changed: ${changed.map(readable).join(", ")}` : `preset ${name}`;
}

export class Header {
  /**
   * @param {Element} root
   * @param {(message: object) => boolean} send
   * @param {(name: string, generations: ?number) => void} resume
   * @param {...Element} below Shown under the title.
   */
  constructor(root, send, resume, ...below) {
    const button = (id, label, onclick, ...more) => {
      const node = h("button", { type: "button", class: "button", hidden: true, onclick }, ...more, label);
      identify(node, id);
      return node;
    };
    this.pause = button("pause", "Pause", () => send(this.status.phase === "PAUSED" ? request.goOn() : request.pause()));
    this.stop = button("stop", "Stop", () => send(request.stop()));
    this.resume = button("resume", "Resume", () => resume(this.status.shown, this.until.value));
    this.until = new Until();
    this.best = button("load-best", "Load the best", () => send(request.loadBest()), icon("save"));
    this.back = button("back", "Back to the present run", () => send(request.open(this.status.run)));
    this.name = h("span", { class: "name", "data-testid": "run" });
    this.about = h("span", { class: "origin", "data-testid": "about" });
    const actions = h("div", { class: "actions" }, this.pause, this.stop, this.until.node, this.resume, this.best);
    const title = h("div", { class: "title" }, this.name, this.about);
    this.progress = h("progress", { "aria-label": "Generations done", max: 1, value: 0 });
    this.line = h("div", { class: "status-line", role: "status", "data-testid": "status" });
    this.remarks = h("p", { class: "note", hidden: true, "data-testid": "remarks" });
    this.error = h("div", { class: "failure", role: "alert", hidden: true, "data-testid": "failure" });
    root.append(h("div", { class: "title-bar" }, title, actions), this.progress, this.line, this.remarks, this.error, this.back, ...below);
  }

  /** @param {import("./protocol.js").EvolutionMessage} status */
  update(status) {
    this.status = status;
    const { about, active, run, shown } = status;
    const own = shown !== null && shown === run;
    this.name.textContent = shown ?? "Evolution";
    this.about.textContent = about ? aboutWords(about) : "";
    this.pause.hidden = this.stop.hidden = !active;
    this.pause.textContent = status.phase === "PAUSED" ? "Go on" : "Pause";
    this.resume.hidden = !status.resumable;
    this.until.show(status);
    this.best.title = `The best of ${shown}, into the table and the arena`;
    this.best.hidden = about?.best === null || about?.best === undefined;
    this.back.hidden = !active || own;
    const done = own && active ? status.done : (about?.done ?? 0);
    const generations = (own && status.generations) || about?.generations || 0;
    this.progress.hidden = !generations;
    this.progress.max = generations || 1;
    this.progress.value = done;
    this.line.textContent = own || !shown ? ownLine(status, done, generations) : keptLine(about);
    this.remarks.textContent = own ? status.remarks.join(" ") : "";
    this.remarks.hidden = !this.remarks.textContent;
    const problem = own && status.phase === "FAILED" ? `Evolution failed: ${status.error}` : status.problem;
    this.error.textContent = problem;
    this.error.hidden = !problem;
  }
}

/** How many generations a run is to have when it is resumed. */
class Until {
  #name = null;

  constructor() {
    this.input = h("input", { type: "number", min: 1, step: 1, class: "until", oninput: () => (this.typed = true) });
    identify(this.input, "resume-generations", "Generations to resume it to");
    this.node = h("label", { hidden: true, title: "How many generations it is to have in all" }, "to", this.input);
    this.typed = false;
  }

  /** Nothing that is being typed is overwritten. */
  show({ resumable, shown, about }) {
    this.node.hidden = !resumable || !about;
    if (this.node.hidden || shown !== this.#name) this.typed = false;
    this.#name = shown;
    if (about && !this.typed) this.input.value = about.finished ? 2 * about.done : about.generations;
  }

  /** @returns {?number} Nothing: as many as it was to have. */
  get value() {
    return this.node.hidden || this.input.value === "" ? null : Number(this.input.value);
  }
}

function aboutWords({ scenario, preset, seed, frozen, version }) {
  const parts = [`scenario ${scenario}`, presetWords(preset), `seed ${seed}`];
  if (frozen) parts.push(frozen === 1 ? "1 rule frozen" : `${frozen} rules frozen`);
  if (version) parts.push(`begun with GESwarm ${version}`);
  return parts.join(" · ");
}

function ownLine({ phase, about }, done, generations) {
  if (phase === "IDLE") return "Evolves rules in the scenario of the arena, while the swarm goes on.";
  if (phase === "RUNNING" && !done) return "Running what evolved rules are compared with…";
  return `Generation ${done} of ${generations} · ${WORDS[phase]}${figures(about)}`;
}

function keptLine(about) {
  if (!about) return "";
  const state = about.finished ? "finished" : "not finished";
  return `Generation ${about.done} of ${about.generations} · ${state}${figures(about)}`;
}

function figures(about) {
  if (typeof about?.best !== "number") return "";
  return ` · best ${figure(about.best)}${about.fall && ` (${about.fall})`}, mean ${figure(about.mean)}`;
}
