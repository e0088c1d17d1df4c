/** What has changed between two versions of a rule set: which rule became which, and how. */

import { written } from "./terms.js";

/**
 * @typedef {object} RuleChange
 * @property {?import("./protocol.js").Rule} before Null if the rule is new.
 * @property {?import("./protocol.js").Rule} after Null if the rule is gone.
 * @property {number} from Index before, -1 if new.
 * @property {number} to Index after, -1 if gone.
 * @property {boolean} moved The rule has overtaken another.
 * @property {"same" | "changed" | "added" | "removed"} status
 *
 * @typedef {object} ElementChange
 * @property {"same" | "moved" | "changed" | "added" | "removed"} status
 * @property {string[]} before Words; empty if added.
 * @property {string[]} after Words; empty if removed.
 */

const LEAST_ALIKE = 0.25; // below this a rule counts as another one
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/** @returns {string[]} The words of a precondition, behaviour or action. */
export function wordsOf(element) {
  if ("percept" in element) return [written(element.percept), element.comparison, `${element.value}`];
  if (!("p" in element)) return [written(element)];
  const { p, behaviour, state, operation, value } = element;
  const effect = behaviour ? [written(behaviour)] : [state, operation === "=" ? "←" : operation, `${value}`];
  return ["p =", `${p}`, "→", ...effect];
}

/** What an element speaks of; null for a behaviour, which is all that there is to it. */
const subjectOf = ({ percept, behaviour, state }) => percept?.name ?? behaviour?.name ?? state ?? null;

/** How much two rules have in common, 0 to 1: their elements, and a little their comments. */
function alike(a, b) {
  const features = (rule) =>
    ["preconditions", "behaviours", "actions"]
      .flatMap((part) => rule[part].flatMap((item) => [[part, item], [part, subjectOf(item) ?? item]]))
      .map((feature) => JSON.stringify(feature));
  const [left, right] = [new Set(features(a)), new Set(features(b))];
  const shared = [...left].filter((feature) => right.has(feature)).length;
  const all = new Set([...left, ...right]).size;
  const comment = a.comment !== "" && a.comment === b.comment ? 1 : 0;
  return (shared + comment) / Math.max(1, all + comment);
}

/** Pairs of indices: equal rules first, the ones in place before others, then the most alike. */
function pair(before, after) {
  const partner = new Array(after.length).fill(-1);
  const free = new Set(before.keys());
  const take = (to, from) => {
    partner[to] = from;
    free.delete(from);
  };
  const keys = before.map((rule) => JSON.stringify(rule));
  after.forEach((rule, i) => i in before && same(rule, before[i]) && take(i, i));
  after.forEach((rule, i) => {
    if (partner[i] >= 0) return;
    const key = JSON.stringify(rule);
    const equal = [...free].find((from) => keys[from] === key);
    if (equal !== undefined) take(i, equal);
  });
  const open = after.map((rule, to) => ({ rule, to })).filter(({ to }) => partner[to] < 0);
  const candidates = open
    .flatMap(({ rule, to }) =>
      [...free].map((from) => ({ to, from, score: alike(before[from], rule) + (from === to ? 0.1 : 0) })),
    )
    .sort((a, b) => b.score - a.score);
  for (const { to, from, score } of candidates) {
    if (score >= LEAST_ALIKE && partner[to] < 0 && free.has(from)) take(to, from);
  }
  return { partner, free };
}

/** @returns {Set<number>} Positions of a longest run of numbers that rise. */
function rising(numbers) {
  const best = [];
  numbers.forEach((number, i) => {
    let chain = { length: 1, previous: -1 };
    for (let j = 0; j < i; j += 1) {
      const longer = numbers[j] < number && best[j].length + 1 > chain.length;
      if (longer) chain = { length: best[j].length + 1, previous: j };
    }
    best.push(chain);
  });
  const kept = new Set();
  let at = best.reduce((top, chain, i) => (top < 0 || chain.length > best[top].length ? i : top), -1);
  for (; at >= 0; at = best[at].previous) kept.add(at);
  return kept;
}

/**
 * Which rule became which.
 *
 * @param {import("./protocol.js").Rule[]} before
 * @param {import("./protocol.js").Rule[]} after
 * @returns {RuleChange[]} In the order after; a rule that is gone stands where it was.
 */
export function compareRules(before, after) {
  const { partner, free } = pair(before, after);
  const kept = after.map((_, i) => i).filter((i) => partner[i] >= 0);
  const inPlace = rising(kept.map((i) => partner[i]));
  const still = new Set(kept.filter((_, k) => inPlace.has(k)));
  const changes = after.map((rule, to) => {
    const from = partner[to];
    if (from < 0) return { before: null, after: rule, from, to, moved: false, status: "added" };
    const status = same(before[from], rule) ? "same" : "changed";
    return { before: before[from], after: rule, from, to, moved: !still.has(to), status };
  });
  for (const from of free) {
    const gone = { before: before[from], after: null, from, to: -1, moved: false, status: "removed" };
    const next = changes.findIndex((change) => !change.moved && change.from > from);
    changes.splice(next < 0 ? changes.length : next, 0, gone);
  }
  return changes;
}

/**
 * What became of the elements of one part of a rule.
 *
 * @param {import("./protocol.js").RuleElement[]} before
 * @param {import("./protocol.js").RuleElement[]} after
 * @returns {ElementChange[]}
 */
export function compareElements(before, after) {
  const gone = new Set(before.keys());
  const take = (test) => {
    const from = [...gone].find((i) => test(before[i]));
    gone.delete(from);
    return from ?? -1;
  };
  const equal = after.map((element) => take((old) => same(old, element)));
  const kept = after.map((_, i) => i).filter((i) => equal[i] >= 0);
  const inPlace = rising(kept.map((i) => equal[i]));
  const still = new Set(kept.filter((_, k) => inPlace.has(k)));
  const changes = after.map((element, i) => {
    const words = wordsOf(element);
    if (equal[i] >= 0) return { status: still.has(i) ? "same" : "moved", before: words, after: words };
    const from = take((old) => akin(old, element));
    const old = from < 0 ? [] : wordsOf(before[from]);
    return { status: from < 0 ? "added" : "changed", before: old, after: words };
  });
  const left = [...gone].map((i) => ({ status: "removed", before: wordsOf(before[i]), after: [] }));
  return [...changes, ...left];
}

/** Two elements that speak of the same percept, behaviour or state. */
function akin(a, b) {
  const subject = subjectOf(a);
  return subject !== null && subject === subjectOf(b) && same(Object.keys(a), Object.keys(b));
}
