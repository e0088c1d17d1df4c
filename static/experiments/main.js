/** Starts the page and hands each message of the server to the part that shows it. */

import { h } from "../common/dom.js";
import { tellFrames } from "../common/frames.js";
import { Notices } from "../common/notices.js";
import { Socket, socketAddress } from "../common/socket.js";
import { Tabs } from "../common/tabs.js";
import { Boxes } from "./boxes.js";
import { Campaign } from "./campaign.js";
import { Campaigns } from "./campaigns.js";
import { Choice } from "./choice.js";
import { Status } from "./status.js";

const IN_VIEW = 1000; // ms between two words that this page is in view

const element = (id) => document.getElementById(id);
const notices = new Notices(element("notices"));

/** With what is asked for, errors about what was asked for before are of no interest. */
function send(message) {
  notices.forget();
  const sent = socket.send(message);
  if (!sent) notices.stress();
  return sent;
}

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

const socket = new Socket(socketAddress(), {
  opened: () => notices.connected(true),
  closed: () => notices.connected(false),
  refused: (why) => notices.refused(why),
  message: (message) => handlers[message.type]?.(message),
});
tellFrames(socket);

/** A page in a tab of the dashboard that is not in view has no size. */
setInterval(() => {
  if (!document.hidden && innerWidth > 0) socket.send({ type: "watch" });
}, IN_VIEW);
