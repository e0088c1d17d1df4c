/** The run looked at, how far it is, and the buttons that stop it and take its best. */

import { h, icon, identify } from "../common/dom.js";
import { decimal } from "../common/figures.js";
import { readable } from "./form.js";

const WORDS = {
  IDLE: "not started",
  RUNNING: "running",
  PAUSED: "paused",
  STOPPED: "stopped",
  FINISHED: "finished",
  FAILED: "failed",
};

/** @param {import("./protocol.js").Preset} preset @returns {string} "preset modern, changed: mutation". */
export function presetWords({ name, changed }) {
  return changed.length ? `preset ${name}, changed: ${changed.map(readable).join(", ")}` : `preset ${name}`;
}

export class Header {
  /**
   * @param {Element} root
   * @param {(message: object) => boolean} send
   * @param {(name: string) => void} resume
   * @param {...Element} below Shown under the title.
   */
  constructor(root, send, resume, ...below) {
    const button = (id, label, onclick, ...more) => {
      const node = h("button", { type: "button", class: "button", hidden: true, onclick }, ...more, label);
      identify(node, id);
      return node;
    };
    this.pause = button("pause", "Pause", () => send({ type: this.status.phase === "PAUSED" ? "go_on" : "pause" }));
    this.stop = button("stop", "Stop", () => send({ type: "stop" }));
    this.resume = button("resume", "Resume", () => resume(this.status.run));
    this.best = button("load-best", "Load best", () => send({ type: "load_best" }), icon("save"));
    this.back = button("back", "Back to the present run", () => send({ type: "open", name: this.status.run }));
    this.name = h("span", { class: "name", "data-testid": "run" });
    this.about = h("span", { class: "origin", "data-testid": "about" });
    const actions = h("div", { class: "actions" }, this.pause, this.stop, this.resume, this.best);
    const title = h("div", { class: "title" }, this.name, this.about);
    this.progress = h("progress", { "aria-label": "Generations done", max: 1, value: 0 });
    this.line = h("div", { class: "status-line", role: "status", "data-testid": "status" });
    this.error = h("div", { class: "failure", role: "alert", hidden: true, "data-testid": "failure" });
    root.append(h("div", { class: "title-bar" }, title, actions), this.progress, this.line, this.error, this.back, ...below);
  }

  /** @param {import("./protocol.js").StatusMessage} status */
  update(status) {
    this.status = status;
    const { about, active, run, shown } = status;
    const own = shown !== null && shown === run;
    this.name.textContent = shown ?? "Evolution";
    this.about.textContent = about ? aboutWords(about) : "";
    this.pause.hidden = this.stop.hidden = !active;
    this.pause.textContent = status.phase === "PAUSED" ? "Go on" : "Pause";
    this.resume.hidden = !(own && status.resumable);
    this.best.hidden = about?.best === null || about?.best === undefined;
    this.back.hidden = !active || own;
    const done = own && active ? status.done : (about?.done ?? 0);
    const generations = (own && status.generations) || about?.generations || 0;
    this.progress.hidden = !generations;
    this.progress.max = generations || 1;
    this.progress.value = done;
    this.line.textContent = own || !shown ? ownLine(status, done, generations) : keptLine(about);
    const problem = own && status.phase === "FAILED" ? `Evolution failed: ${status.error}` : status.problem;
    this.error.textContent = problem;
    this.error.hidden = !problem;
  }
}

function aboutWords({ scenario, preset, seed, frozen }) {
  const parts = [`scenario ${scenario}`, presetWords(preset), `seed ${seed}`];
  if (frozen) parts.push(frozen === 1 ? "1 rule frozen" : `${frozen} rules frozen`);
  return parts.join(" · ");
}

function ownLine({ phase, about }, done, generations) {
  if (phase === "IDLE") return "Evolves foraging rules in the scenario of the arena, while the swarm goes on.";
  if (phase === "RUNNING" && !done) return "Running hand-coded and EVO 8 for comparison…";
  return `Generation ${done} of ${generations} · ${WORDS[phase]}${figures(about)}`;
}

function keptLine(about) {
  if (!about) return "";
  const state = about.finished ? "finished" : "not finished";
  return `Generation ${about.done} of ${about.generations} · ${state}${figures(about)}`;
}

function figures(about) {
  if (typeof about?.best !== "number") return "";
  return ` · best ${decimal(about.best)}, mean ${decimal(about.mean)}`;
}
