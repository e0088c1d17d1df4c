/** Starts the page and hands each message of the server to the part that shows it. */

import { h } from "../common/dom.js";
import { Page, element } from "../common/page.js";
import { Tabs } from "../common/tabs.js";
import { Boxes } from "./boxes.js";
import { Campaign } from "./campaign.js";
import { Campaigns } from "./campaigns.js";
import { Choice } from "./choice.js";
import { Status } from "./status.js";

const page = new Page();
const { ask: send, notices } = page;

const choice = new Choice(element("compare"), send, notices);
const boxes = new Boxes(element("compare"));
const campaigns = new Campaigns(element("campaigns"), send);
const campaign = new Campaign(element("campaigns"));
const status = new Status(send);
const tabs = new Tabs([
  { id: "compare", label: "Compare", panel: element("compare"), tools: [] },
  { id: "campaigns", label: "The paper, repeated", panel: element("campaigns"), tools: [] },
]);
const title = h("div", { class: "title-bar" }, h("span", { class: "name" }, "Experiments"));
element("header").append(title, status.node, tabs.node);

const handlers = {
  choice: (message) => choice.update(message),
  compared(message) {
    choice.showProgress(message);
    boxes.update(message);
  },
  draft: (message) => campaigns.showDraft(message),
  status(message) {
    status.update(message);
    campaigns.showStatus(message);
  },
  campaigns(message) {
    campaigns.update(message);
    tabs.badge("campaigns", message.campaigns.length || "");
  },
  campaign: (message) => campaign.update(message),
  notice: ({ level, text }) => notices.show(level, text),
};

page.connect(handlers);
page.tellInView();
