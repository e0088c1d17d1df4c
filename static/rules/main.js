/** Starts the page and hands each message of the server to the part that shows it. */

import { h } from "../common/dom.js";
import { Page, element } from "../common/page.js";
import { tabStore } from "../common/store.js";
import { Tabs } from "../common/tabs.js";
import { ChangesTab } from "./changes.js";
import { listenToClipboard } from "./clipboard.js";
import { forgetRefusal, tellDrafts } from "./field.js";
import { Grid, isEditing } from "./grid.js";
import { Header, download } from "./header.js";
import { Help } from "./help.js";
import { KeptTexts } from "./kept.js";
import { listenToKeys } from "./keyboard.js";
import { Live } from "./live.js";
import { People } from "./people.js";
import { Session } from "./session.js";
import { Simplify } from "./simplify.js";
import { StatesTab } from "./states.js";
import { RuleTable } from "./table.js";
import { TextTab } from "./text.js";
import { UnsavedRules } from "./unsaved.js";
import { Verdict } from "./verdict.js";
import { Worth } from "./worth.js";

/** What a refusal of the last of these is told for: with the next it is of no interest. */
const CHANGES = new Set([
  "edit", "undo", "redo", "set_text", "take_simplified", "load_preset", "load_text", "bring_back", "discard", "simplify",
]);
const UNANSWERED = "The connection was lost before the last change was confirmed: look whether it was made.";

const page = new Page();
const { notices } = page;
const session = new Session(
  (message) => {
    if (CHANGES.has(message.type)) notices.forget();
    return page.send(message);
  },
  () => notices.stress(),
  (typed) => kept.add(typed, away),
);
const live = new Live();
const verdict = new Verdict();
const table = new RuleTable(element("table"), session);
const grid = new Grid(element("table"), table);
const worth = new Worth(session, table);
const people = new People(session);
const kept = new KeptTexts(element("notices"), session);
const unsaved = new UnsavedRules(element("notices"), session);
const states = new StatesTab(element("states"), session, table, () => tabs.show(0));
const simplify = new Simplify(session);
const help = new Help();
const text = new TextTab(element("text"), session, (draft) => tabs.badge("text", draft ? "edited" : ""));
const changes = new ChangesTab(element("changes"), session, (count) => tabs.badge("changes", count || ""));
const tabs = new Tabs(
  [
    {
      id: "table",
      label: "Table",
      panel: element("table"),
      tools: [worth.node, simplify.button, wordsSwitch()],
      shown: () => states.tableShown(),
    },
    { id: "states", label: "States", panel: element("states"), tools: [] },
    { id: "text", label: "Text", panel: element("text"), tools: text.tools, shown: () => text.shown() },
    { id: "changes", label: "Changes", panel: element("changes"), tools: [changes.back], shown: () => changes.shown() },
  ],
);
const header = new Header(element("header"), session, notices, people.button, help.button, live.node, verdict.node, tabs.node, worth.legend);
let away = false; // the connection was lost, and what has become of the rules is not known yet
let unanswered = false; // and what was asked for before has not been answered

const handlers = {
  vocabulary(message) {
    session.vocabulary = message;
    verdict.measure(message.objective);
    worth.measure(message.objective);
    live.name(message);
  },
  rules(received) {
    const { asking, state: before } = session;
    session.receive(received);
    const message = session.state;
    notices.connected(true);
    if (before?.version !== message.version) forgetRefusal();
    if (session.replaced) notices.forget();
    document.body.classList.remove("waiting");
    header.update(message);
    live.rulesChanged(message.rule_set.rules);
    verdict.rulesChanged(message);
    table.update(message);
    worth.rulesChanged(message);
    grid.restore(asking);
    simplify.rulesChanged(message);
    text.update(message);
    changes.update(message);
    kept.rulesChanged();
    session.settled();
    if (away) comeBack();
  },
  live: (message) => live.update(message, table.cards),
  states: (message) => states.update(message),
  activity: (message) => states.live(message),
  verdict: (message) => verdict.update(message),
  worth: (message) => worth.update(message),
  simplified: (message) => simplify.offer(message),
  text_findings: (message) => text.showFindings(message),
  file: download,
  people: (message) => people.update(message),
  changed: ({ who, what }) => notices.tell(who, what),
  unsaved: ({ left }) => unsaved.update(left),
  stale({ version, text: words }) {
    notices.show("error", words);
    session.refused(version);
  },
  notice({ level, text: words, about }) {
    if (words) notices.show(level, words, about);
    else notices.forget(about);
    if (level !== "error" || !session.asking) return;
    session.refused();
    session.settled();
  },
};

page.connect(handlers, {
  opened: () => people.introduce(),
  closed() {
    unanswered ||= session.disconnected();
    tellDrafts("connectionlost");
    away = true;
  },
});

/** What was typed meanwhile was typed for the rules as they were: it is offered, and not applied. */
function comeBack() {
  const active = document.activeElement;
  tellDrafts("giveup", !session.replaced && isEditing(active) ? active : null);
  text.comeBack();
  notices.forget("journal");
  if (unanswered) notices.show("error", UNANSWERED);
  away = unanswered = false;
}

tabs.remember("geswarm-tab");
listenToKeys(session, table, grid, help, text);
listenToClipboard(session, table, notices);
addEventListener("reverted", () => notices.forget());
addEventListener("beforeunload", (event) => {
  if (kept.any || text.unkept || document.querySelector("[data-draft]:not(.source)")) event.preventDefault();
});

/** A switch that shows every rule as a sentence as well. */
function wordsSwitch() {
  const attributes = { type: "button", class: "quiet", "aria-pressed": "false", "data-testid": "in-words" };
  const button = h("button", { ...attributes, title: "Show every rule as a sentence" }, "In words");
  const show = (on) => {
    element("table").classList.toggle("in-words", on);
    button.setAttribute("aria-pressed", String(on));
    tabStore.set("geswarm-words", String(on));
  };
  button.addEventListener("click", () => show(button.getAttribute("aria-pressed") !== "true"));
  show(tabStore.get("geswarm-words") === "true");
  return button;
}
