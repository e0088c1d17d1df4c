/**
 * What the browser remembers of a page: text under a name.
 *
 * Where site data is blocked (by the user, in a private window, in a frame of another site), even
 * to look for the storage throws, and a full one throws when it is written to: the page then works
 * all the same, and forgets when it is closed.
 */
class Store {
  #kept = new Map();
  #storage;

  /** @param {() => Storage} storage */
  constructor(storage) {
    this.#storage = storage;
  }

  /** @param {string} name @returns {?string} Null if there is none. */
  get(name) {
    if (this.#kept.has(name)) return this.#kept.get(name);
    try {
      return this.#storage().getItem(name);
    } catch {
      return null;
    }
  }

  /** @returns {boolean} False if what is kept under a name is forgotten when the page is closed. */
  lasts(name) {
    return !this.#kept.has(name);
  }

  /** @param {string} name @param {?string} text Null keeps nothing. */
  set(name, text) {
    try {
      if (text === null) this.#storage().removeItem(name);
      else this.#storage().setItem(name, text);
      this.#kept.delete(name);
    } catch {
      this.#kept.set(name, text);
    }
  }
}

/** For this tab, until it is closed. */
export const tabStore = new Store(() => sessionStorage);

/** For this browser, and all its tabs. */
export const browserStore = new Store(() => localStorage);
