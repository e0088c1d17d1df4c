/** What the server last said, and the edits on their way to it. */

const PATIENCE = 3000;
const FOR_A_VERSION = new Set(["edit", "undo", "redo", "set_text"]);
const ANSWERED = new Set([...FOR_A_VERSION, "take_simplified"]);

export class Session {
  /** @type {?import("./protocol.js").Vocabulary} */
  vocabulary = null;
  /** @type {?import("./protocol.js").RulesMessage} */
  state = null;
  #waiting = [];
  #timer = null;

  /**
   * @param {(message: object) => boolean} send Sends one message; false if there is no connection.
   * @param {() => boolean} connected
   * @param {() => void} unsent Called when something could not be sent.
   */
  constructor(send, connected, unsent) {
    this.send = send;
    this.connected = connected;
    this.unsent = unsent;
  }

  /**
   * Take what the server says of the rules.
   *
   * While it has not looked at the new rules yet (`simpler` is absent), the old findings stay, so
   * that they do not flicker at every edit.
   *
   * @param {import("./protocol.js").RulesMessage} message
   */
  receive(message) {
    const before = this.state;
    this.state = message;
    if (!before || message.simpler !== undefined) return;
    const findings = message.findings.length ? message.findings : carryOver(before, message);
    this.state = { ...message, findings, simpler: before.simpler };
  }

  /**
   * Send an edit as soon as the one before it has been answered.
   *
   * Every edit names the version it was made for. `make` is called at the last moment, so that an
   * edit made while another is under way still hits the element it was meant for, wherever that
   * has moved to; it returns null if the element has gone.
   *
   * @param {() => ?import("./protocol.js").Edit} make
   * @returns {boolean} False if there is no connection.
   */
  edit(make) {
    return this.#post(() => {
      const edit = make();
      return edit && { type: "edit", edit };
    });
  }

  /**
   * Send a message in order with the edits.
   *
   * @param {object} message
   */
  command(message) {
    return this.#post(() => message);
  }

  /** The server has answered and its answer is on screen: the next edit may go. */
  settled() {
    clearTimeout(this.#timer);
    this.#timer = null;
    while (this.#waiting.length && this.#timer === null) this.#go(this.#waiting.shift());
  }

  /** The connection is lost: what was not sent refers to a state that may be gone. */
  disconnected() {
    this.#waiting = [];
    this.settled();
  }

  /** @returns {string} LED colour of a behaviour, grey if it is unknown. */
  colour(behaviour) {
    const known = this.vocabulary?.behaviours.find((entry) => entry.name === behaviour);
    return known?.colour ?? "#8a8f98";
  }

  #post(make) {
    if (!this.state || !this.connected()) {
      this.unsent();
      return false;
    }
    if (this.#timer === null) this.#go(make);
    else this.#waiting.push(make);
    return true;
  }

  #go(make) {
    const message = make();
    if (!message) return;
    const { version } = this.state;
    if (!this.send(FOR_A_VERSION.has(message.type) ? { ...message, version } : message)) return;
    if (ANSWERED.has(message.type)) this.#timer = setTimeout(() => this.settled(), PATIENCE);
  }
}

/** Findings on other rules than before, at the places where those rules are now. */
function carryOver(before, after) {
  const [old, now] = [before, after].map(({ rule_set }) => rule_set.rules.map((rule) => JSON.stringify(rule)));
  const place = (at) => {
    if (now[at] === old[at]) return at;
    const moved = now.indexOf(old[at]);
    return moved < 0 && now.length === old.length ? at : moved;
  };
  return before.findings
    .map((finding) => (finding.rule ? { ...finding, rule: place(finding.rule - 1) + 1 } : finding))
    .filter(({ rule }) => rule !== 0);
}
