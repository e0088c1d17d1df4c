/** The connection to Python: JSON text messages, reconnecting by itself. */

const FIRST_DELAY = 250;
const LONGEST_DELAY = 3000;

/** @returns {string} Address of the socket, beside this page. */
export function socketAddress() {
  const address = new URL("socket", location.href);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  return address.href;
}

export class Socket {
  #socket = null;
  #delay = FIRST_DELAY;

  /**
   * @param {string} address
   * @param {object} handlers
   * @param {() => void} handlers.opened
   * @param {() => void} handlers.closed
   * @param {(why: string) => void} handlers.refused Called after `closed` if the server refuses this page.
   * @param {(message: object) => void} handlers.message
   */
  constructor(address, handlers) {
    this.address = address;
    this.handlers = handlers;
    this.#connect();
  }

  /** True while messages can be sent. */
  get open() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  /**
   * @param {object} message
   * @returns {boolean} False if there is no connection; the message is then not kept.
   */
  send(message) {
    if (this.open) this.#socket.send(JSON.stringify(message));
    return this.open;
  }

  #connect() {
    const socket = new WebSocket(this.address);
    this.#socket = socket;
    socket.addEventListener("open", () => {
      this.#delay = FIRST_DELAY;
      this.handlers.opened();
    });
    socket.addEventListener("message", (event) => this.handlers.message(JSON.parse(event.data)));
    socket.addEventListener("close", () => {
      this.handlers.closed();
      whyRefused().then((why) => why !== null && !this.open && this.handlers.refused(why)); // of refused.js
      setTimeout(() => this.#connect(), this.#delay);
      this.#delay = Math.min(LONGEST_DELAY, this.#delay * 1.6);
    });
  }
}
