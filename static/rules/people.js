/** Who else is at this table, and what they call one another. */

import { dialog } from "../common/dialog.js";
import { h, identify } from "../common/dom.js";
import { browserStore } from "../common/store.js";
import { request } from "./protocol.js";

const MAX_NAME = 30;
const KEPT = "geswarm-name";

export class People {
  /** @param {import("./session.js").Session} session */
  constructor(session) {
    this.session = session;
    this.button = h("button", { type: "button", class: "quiet", hidden: true, onclick: () => this.#open() });
    identify(this.button, "people");
    this.node = dialog("people-dialog", "Who is here");
    const words = "Everybody who opens this address sees and changes the same swarm and the same rules.";
    this.list = h("ul", { class: "people", "data-testid": "people-list" });
    this.name = h("input", { class: "person-name", maxlength: MAX_NAME, autocomplete: "off" });
    identify(this.name, "person-name", "Your name");
    this.name.addEventListener("change", () => this.#call(this.name.value.trim()));
    this.node.append(h("p", {}, words), this.list, h("label", { class: "person-label" }, "Your name", this.name));
  }

  /** Tell the server what this person is called; with every new connection. */
  introduce() {
    const name = browserStore.get(KEPT);
    if (name) this.session.send(request.name(name));
  }

  /** @param {import("./protocol.js").PeopleMessage} message */
  update({ people }) {
    this.button.hidden = people.length < 2;
    this.button.textContent = `${people.length} here`;
    this.button.title = people.map(({ name, you }) => (you ? `${name} (you)` : name)).join("\n");
    const line = ({ name, you }) => h("li", {}, name, you ? h("span", { class: "you" }, " you") : "");
    this.list.replaceChildren(...people.map(line));
  }

  #open() {
    this.name.value = browserStore.get(KEPT) ?? "";
    this.node.showModal();
    this.name.focus();
  }

  #call(name) {
    browserStore.set(KEPT, name);
    this.session.send(request.name(name));
  }
}
