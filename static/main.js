/** Starts the page and hands each message of the server to the part that shows it. */

import { Header, download } from "./header.js";
import { tellDrafts } from "./field.js";
import { listenToKeys } from "./keyboard.js";
import { Live } from "./live.js";
import { Notices } from "./notices.js";
import { Session } from "./session.js";
import { Socket, socketAddress } from "./socket.js";
import { RuleTable } from "./table.js";

const notices = new Notices(document.getElementById("notices"));
const session = new Session(
  (message) => socket.send(message),
  () => socket.open,
  () => notices.stress(),
);
const live = new Live();
const header = new Header(document.getElementById("header"), session, notices, live.node);
const table = new RuleTable(document.getElementById("table"), session);
let resend = false;

const handlers = {
  vocabulary(message) {
    session.vocabulary = message;
    live.name(message);
  },
  rules(message) {
    session.state = message;
    header.update(message);
    live.rulesChanged(message.rule_set.rules);
    table.update(message);
    session.settled();
    if (resend) tellDrafts("resend");
    resend = false;
  },
  live: (message) => live.update(message, table.cards),
  file: download,
  notice({ level, text }) {
    notices.show(level, text);
    if (level === "error") session.settled();
  },
};

const socket = new Socket(socketAddress(), {
  opened: () => notices.connected(true),
  closed() {
    notices.connected(false);
    session.disconnected();
    tellDrafts("connectionlost");
    resend = true;
  },
  message: (message) => handlers[message.type]?.(message),
});

listenToKeys(session, table);
