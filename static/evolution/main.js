/** Starts the page and hands each message of the server to the part that shows it. */

import { Page, element } from "../common/page.js";
import { Tabs } from "../common/tabs.js";
import { Ancestors } from "./ancestors.js";
import { ChosenRules } from "./chosen.js";
import { Curves } from "./curves.js";
import { Form } from "./form.js";
import { Header } from "./header.js";
import { Population } from "./population.js";
import { request } from "./protocol.js";
import { insteadOf } from "./question.js";
import { Runs } from "./runs.js";
import { Steer } from "./steer.js";

const page = new Page();
const { ask: send, notices } = page;
const STEER = 1;
let status = null;

const resume = (name, generations = null) =>
  insteadOf(status, (instead) => send(request.resume(name, generations, instead)));
const curves = new Curves();
const form = new Form(element("plan"), send, () => tabs.show(STEER));
const steer = new Steer(element("steer"), send);
const population = new Population(element("population"), send);
const ancestors = new Ancestors(element("ancestors"), send);
const runs = new Runs(element("runs"), send, resume);
const chosen = new ChosenRules(element("chosen"), send);
const tab = (id, label) => ({ id, label, panel: element(id), tools: [], shown: () => inTab(id) });
const tabs = new Tabs([
  tab("plan", "New run"),
  tab("steer", "Steer"),
  tab("population", "Population"),
  tab("ancestors", "Ancestors"),
  tab("runs", "Runs"),
]);
const header = new Header(element("header"), send, resume, curves.node, tabs.node);

const handlers = {
  form(message) {
    form.build(message);
    steer.build(message);
    runs.most = message.most_compared;
  },
  plan: (message) => form.update(message),
  status(message) {
    const untouched = status === null && document.body.dataset.tab === "plan";
    if (untouched && message.active) tabs.show(STEER);
    status = form.status = message;
    header.update(message);
    steer.update(message);
    runs.showStatus(message);
  },
  curves(message) {
    curves.update(message);
    steer.showMarks(message);
  },
  compared: (message) => curves.compare(message),
  population: (message) => population.update(message),
  ancestors: (message) => ancestors.update(message),
  runs(message) {
    runs.update(message);
    tabs.badge("runs", message.runs.length || "");
  },
  chosen(message) {
    chosen.update(message);
    population.choose(message.individual);
    ancestors.choose(message.individual);
  },
  notice: ({ level, text }) => notices.show(level, text),
};

page.connect(handlers);
page.tellInView();

/** The rules of an individual stand beside those tabs where one can be clicked. */
function inTab(id) {
  document.body.dataset.tab = id;
}
