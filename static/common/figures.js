/** Numbers as they are read: signs, intervals, p-values, means. */

const MINUS = "\u2212";

/** @returns {string} With as many decimals as asked for and a minus sign that is one. */
export function decimal(value, decimals = 1) {
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", MINUS);
}

/** @returns {string} The same with a plus sign. */
export function signed(value, decimals = 1) {
  const text = decimal(value, decimals);
  return Number(value.toFixed(decimals)) > 0 ? `+${text}` : text;
}

export const interval = (low, high, decimals = 1) => `[${decimal(low, decimals)}, ${decimal(high, decimals)}]`;

/** @returns {number} Three where values are small, as shares are; none where they are thousands; else one. */
export function decimalsFor(values) {
  const most = Math.max(...values.map(Math.abs));
  return most >= 1000 ? 0 : most >= 2 ? 1 : 3;
}

/** @returns {string} One number by itself, with as many decimals as suit it. */
export const figure = (value) => decimal(value, decimalsFor([value]));

/** @returns {string} "p = 0.012", or nothing if there is no p-value. */
export function pValue(p) {
  if (p === null || p === undefined || Number.isNaN(p)) return "";
  if (p < 0.0001) return "p < 0.0001";
  return `p = ${Number(p.toPrecision(p < 0.001 ? 1 : 2))}`;
}

export const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

/** @returns {number} A quantile by linear interpolation. */
export function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  const at = share * (sorted.length - 1);
  const below = Math.floor(at);
  const above = sorted[Math.min(below + 1, sorted.length - 1)];
  return sorted[below] + (at - below) * (above - sorted[below]);
}

/**
 * A round axis around all values.
 *
 * @param {number[]} values
 * @returns {{ticks: number[], percent: (value: number) => number}} Ticks, and where a value lies.
 */
export function axis(values) {
  const least = Math.min(...values);
  const most = Math.max(...values);
  const farthest = Math.max(most, -least);
  const span = Math.max(most - least, farthest < 2 ? 0.1 : 4);
  const room = farthest < 10_000 ? 6 : 4; // ticks that have room beside one another
  const power = 10 ** Math.floor(Math.log10(span / 4));
  const step = [1, 2, 5, 10].map((round) => round * power).find((size) => span / size <= room);
  const first = Math.floor(least / step) * step;
  const count = Math.max(1, Math.ceil((least + span - first) / step));
  const ticks = Array.from({ length: count + 1 }, (_, i) => Number((first + i * step).toPrecision(9)));
  const percent = (value) => 2 + (96 * (value - first)) / (count * step);
  return { ticks, percent };
}
