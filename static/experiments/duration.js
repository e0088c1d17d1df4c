/** Times as they are read. */

/** @param {number} seconds @returns {string} "40 s", "12 min" or "1.5 h". */
export function duration(seconds) {
  if (seconds < 60) return `${Math.max(1, Math.round(seconds))} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
}
