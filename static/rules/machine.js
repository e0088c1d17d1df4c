/** The picture of a state machine, as Python draws it, with the swarm in it. */

import { h, identify, svg } from "../common/dom.js";

const LEAST_SCALE = 0.72; // of the picture; beyond that it is scrolled
const JOURNEY = 450; // ms that a robot is seen on its way from state to state
const MOST_DOTS = 3; // on an arrow at a time: more cannot be told apart
const STOPS = 12; // of a dot on its way

export class MachinePicture {
  /**
   * @param {import("./session.js").Session} session
   * @param {(chosen: import("./states.js").Chosen) => void} choose Called when something is clicked.
   */
  constructor(session, choose) {
    Object.assign(this, { session, onChoose: choose });
    this.node = h("div", { class: "machine", "data-testid": "machine" });
  }

  /** @param {import("./protocol.js").StatesMessage} message */
  draw({ svg: text, states, transitions }) {
    Object.assign(this, { states, transitions });
    const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
    const picture = document.importNode(parsed.documentElement, true);
    picture.style.setProperty("min-width", `${LEAST_SCALE * picture.getAttribute("width")}px`);
    this.groups = [...picture.querySelectorAll(".state")].map((group, at) => this.#state(group, at));
    this.arrows = [...picture.querySelectorAll(".arrow")].map((group) => this.#arrow(group));
    this.labels = [...picture.querySelectorAll(".transition")].map((group) => this.#label(group));
    this.dots = svg("g", { class: "dots", "aria-hidden": "true" });
    picture.insertBefore(this.dots, picture.querySelector(".paper, .state"));
    this.node.replaceChildren(picture);
  }

  /** @param {import("./states.js").Chosen} chosen */
  choose({ source, target, at }) {
    this.groups.forEach(({ group }, i) => group.classList.toggle("chosen", target === null && i === source));
    for (const arrow of this.arrows) {
      const { source: from, target: to } = arrow.group.dataset;
      arrow.group.classList.toggle("chosen", Number(from) === source && Number(to) === target);
    }
    for (const { group, index } of this.labels) group.classList.toggle("chosen", index === at);
  }

  /**
   * @param {number[]} robots In each state.
   * @param {number[]} since How often each transition has just been taken.
   * @param {number} swarm
   */
  show(robots, since, swarm) {
    this.groups.forEach(({ group, fill, count }, i) => {
      const words = robots[i] === 1 ? "1 robot" : `${robots[i]} robots`;
      count.textContent = words;
      fill.style.setProperty("transform", `scaleX(${robots[i] / Math.max(1, swarm)})`);
      group.setAttribute("aria-label", `${this.states[i].label}: ${words}`);
    });
    const light = (group, times) => {
      group.classList.toggle("taken", times > 0);
      if (times > 0) group.style.setProperty("--heat", (0.4 + 0.6 * Math.min(1, times / swarm)).toFixed(2));
    };
    for (const { group, path, indices } of this.arrows) {
      const times = indices.reduce((sum, at) => sum + since[at], 0);
      light(group, times);
      this.#travel(group, path, Math.min(times, MOST_DOTS));
    }
    for (const { group, index } of this.labels) light(group, since[index]);
  }

  #state(group, at) {
    const body = group.querySelector(".body");
    const [x, y, width, height, rx] = ["x", "y", "width", "height", "rx"].map((name) => Number(body.getAttribute(name)));
    const shape = { x, y, width, height, rx };
    const clip = svg("clipPath", { id: `state-clip-${at}` }, svg("rect", shape));
    const fill = svg("rect", { ...shape, rx: 0, class: "fill" });
    const count = svg("text", { class: "robots", x: x + width / 2, y: y + height - 11, "text-anchor": "middle" });
    body.after(clip, svg("g", { "clip-path": `url(#state-clip-${at})` }, fill));
    group.append(count);
    group.style.setProperty("--led", this.session.colour(this.states[at].behaviour));
    this.#button(group, `state-${at}`, this.states[at].label, { source: at, target: null, at: null });
    return { group, fill, count };
  }

  #arrow(group) {
    const [source, target] = [Number(group.dataset.source), Number(group.dataset.target)];
    const indices = group.dataset.transitions.split(" ").map(Number);
    const path = group.querySelector("path");
    const halo = path.cloneNode();
    const reach = path.cloneNode();
    halo.setAttribute("class", "halo");
    reach.setAttribute("class", "reach");
    path.before(halo, reach);
    group.style.setProperty("--led", this.session.colour(this.states[source].behaviour));
    const chosen = { source, target, at: null };
    const words = `${this.states[source].label} to ${this.states[target].label}`;
    const labelled = group.ownerSVGElement.querySelector(".transition") !== null;
    this.#button(group, `arrow-${source}-${target}`, words, chosen, !labelled);
    return { group, path, indices };
  }

  #label(group) {
    const index = Number(group.dataset.transition);
    const { source, target, words, effects } = this.transitions[index];
    group.classList.toggle("effect", effects.length > 0);
    group.style.setProperty("--led", this.session.colour(this.states[source].behaviour));
    this.#button(group, `transition-${index}`, words, { source, target, at: index });
    return { group, index };
  }

  /** Make a part of the picture answer to clicks, and to Enter if it can have the focus. */
  #button(group, testid, label, chosen, focusable = true) {
    identify(group, testid, label);
    group.addEventListener("click", () => this.onChoose(chosen));
    if (!focusable) return;
    group.setAttribute("role", "button");
    group.setAttribute("tabindex", "0");
    group.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      this.onChoose(chosen);
    });
  }

  /** Robots on their way along an arrow. */
  #travel(group, path, count) {
    if (!count || matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    const length = path.getTotalLength();
    const points = Array.from({ length: STOPS + 1 }, (_, i) => path.getPointAtLength((length * i) / STOPS));
    const stops = points.map(({ x, y }) => ({ transform: `translate(${x}px, ${y}px)` }));
    for (let i = 0; i < count; i++) {
      const dot = svg("circle", { r: 5 });
      dot.style.setProperty("--led", group.style.getPropertyValue("--led"));
      this.dots.append(dot);
      const way = dot.animate(stops, { duration: JOURNEY, delay: i * 90, fill: "backwards", easing: "ease-in-out" });
      way.finished.then(() => dot.remove(), () => {});
    }
  }
}
