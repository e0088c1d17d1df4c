/** What every page is built on: the connection, what is said about it, and requests over it. */

import { tellFrames } from "./frames.js";
import { Notices } from "./notices.js";
import { request } from "./protocol.js";
import { Socket, socketAddress } from "./socket.js";

const IN_VIEW = 1000; // ms between two words that a page is in view

/** @param {string} id @returns {HTMLElement} */
export const element = (id) => document.getElementById(id);

export class Page {
  #socket = null;

  constructor() {
    this.notices = new Notices(element("notices"));
  }

  /**
   * @param {object} message Made by a function of a `protocol.js`.
   * @returns {boolean} False if there is no connection; the message is then not kept.
   */
  send = (message) => this.#socket.send(message);

  /** The same for what somebody asks for: errors about what was asked for before are of no interest then. */
  ask = (message) => {
    this.notices.forget();
    const sent = this.send(message);
    if (!sent) this.notices.stress();
    return sent;
  };

  /**
   * Connect, and stay so.
   *
   * @param {Object<string, (message: object) => void>} handlers By type of message; others are of no interest.
   * @param {object} [more] What else to do.
   * @param {() => void} [more.opened] Called instead of saying that there is a connection again.
   * @param {() => void} [more.closed] Called when the connection is lost.
   */
  connect(handlers, { opened = () => this.notices.connected(true), closed = () => {} } = {}) {
    this.#socket = new Socket(socketAddress(), {
      opened,
      closed: () => {
        this.notices.connected(false);
        closed();
      },
      refused: (why) => this.notices.refused(why),
      message: (message) => handlers[message.type]?.(message),
    });
    tellFrames(this.#socket);
  }

  /** Say that this page is in view as long as it is: in a tab of the dashboard that is not it has no size. */
  tellInView() {
    setInterval(() => {
      if (!document.hidden && innerWidth > 0) this.send(request.watch());
    }, IN_VIEW);
  }
}
