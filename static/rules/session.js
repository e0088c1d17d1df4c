/** What the server last said, and the edits on their way to it. */

import { request } from "./protocol.js";

const PATIENCE = 3000;

/**
 * @typedef {object} Request
 * @property {() => ?object} make The message, made at the last moment; null if it has become idle.
 * @property {() => void} refused Called if it was not done.
 */

export class Session {
  /** @type {?import("./protocol.js").VocabularyMessage} */
  vocabulary = null;
  /** @type {?import("./protocol.js").RulesMessage} */
  state = null;
  /** True from the moment at which the rules have come over this connection. */
  connected = false;
  /** True if the newest rules are others from elsewhere, and not the ones before, edited. */
  replaced = false;
  #waiting = [];
  #asked = null;
  #answered = null;
  #timer = null;

  /**
   * @param {(message: object) => boolean} send Sends one message; false if there is no connection.
   * @param {() => void} unsent Called when something could not be sent.
   * @param {(typed: import("./kept.js").Typed) => void} keep Takes what was typed for rules that are gone.
   */
  constructor(send, unsent, keep) {
    Object.assign(this, { send, unsent, keep });
  }

  /** True while the server has been asked for a change and has not answered. */
  get asking() {
    return this.#timer !== null;
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
    this.replaced = before !== null && (this.connected ? !alike(before, message, "loaded") : !sameVersion(before, message));
    this.connected = true;
    if (!before || message.simpler !== undefined) return;
    const findings = message.findings.length ? message.findings : carryOver(before, message, this.replaced);
    this.state = { ...message, findings, simpler: this.replaced ? undefined : before.simpler };
  }

  /**
   * Send an edit as soon as the one before it has been answered.
   *
   * Every edit names the version it was made for. `make` is called at the last moment, so that an
   * edit made while another is under way still hits the element it was meant for, wherever that
   * has moved to; it returns null if the element has gone.
   *
   * @param {() => ?import("./protocol.js").AnyEdit} make
   * @param {() => void} [refused] Called if the edit was not made.
   * @returns {boolean} False if there is no connection.
   */
  edit(make, refused) {
    return this.#post(() => {
      const edit = make();
      return edit && request.edit(edit);
    }, refused);
  }

  /**
   * Send a message in order with the edits.
   *
   * @param {object} message
   * @param {() => void} [refused] Called if it was not done.
   */
  command(message, refused) {
    return this.#post(() => message, refused);
  }

  /** The server has answered and its answer is on screen: the next edit may go. */
  settled() {
    clearTimeout(this.#timer);
    this.#timer = null;
    [this.#answered, this.#asked] = [this.#asked, null];
    while (this.#waiting.length && !this.asking) this.#go(this.#waiting.shift());
  }

  /**
   * What was asked for last was not done.
   *
   * @param {number} [version] What it was meant for, if the server has sent newer rules since.
   */
  refused(version) {
    const last = this.#asked ?? this.#answered;
    if (!last || (version ?? last.version) !== last.version) return;
    this.#asked = this.#answered = null;
    last.refused();
  }

  /**
   * The connection is lost: what was not answered was perhaps not done, and what was not sent refers
   * to rules that may be gone.
   *
   * @returns {boolean} True if there was any of it.
   */
  disconnected() {
    const left = [...(this.#asked ? [this.#asked] : []), ...this.#waiting];
    this.connected = false;
    this.#waiting = [];
    this.#asked = null;
    this.settled();
    for (const { refused } of left) refused();
    return left.length > 0;
  }

  /** @returns {string} LED colour of a behaviour, grey if it is unknown. */
  colour(behaviour) {
    const known = this.vocabulary?.behaviours.find(({ name }) => name === behaviour.name);
    return known?.colour ?? "#8a8f98";
  }

  #post(make, refused = () => {}) {
    if (!this.connected) {
      this.unsent();
      return false;
    }
    if (this.asking) this.#waiting.push({ make, refused });
    else this.#go({ make, refused });
    return true;
  }

  /** @param {Request} request */
  #go({ make, refused }) {
    const message = make();
    if (!message) return;
    const { version } = this.state;
    const isChange = "version" in message; // of the rules as they are: it names them, and is answered
    if (isChange) message.version ??= version;
    if (!this.send(message)) return refused();
    if (!isChange) return;
    this.#asked = { refused, version };
    this.#timer = setTimeout(() => this.settled(), PATIENCE);
  }
}

const alike = (before, after, part) => JSON.stringify(before[part]) === JSON.stringify(after[part]);
const sameVersion = (before, after) => before.version === after.version && alike(before, after, "rule_set");

/** Findings on other rules than before, at the places where those rules are now. */
function carryOver(before, after, replaced) {
  const [old, now] = [before, after].map(({ rule_set }) => rule_set.rules.map((rule) => JSON.stringify(rule)));
  const place = (at) => {
    if (now[at] === old[at]) return at;
    const moved = now.indexOf(old[at]);
    return moved < 0 && !replaced && now.length === old.length ? at : moved;
  };
  return before.findings
    .map((finding) => (finding.rule ? { ...finding, rule: place(finding.rule - 1) + 1 } : finding))
    .filter(({ rule }) => rule !== 0);
}
