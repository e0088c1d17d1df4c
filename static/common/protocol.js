// What Python and every page say to one another: written by `python -m app.protocol`.

/**
 * Something that could not be done, or that was.
 * @typedef {object} NoticeMessage
 * @property {"notice"} type
 * @property {"error" | "info"} level An error stays until it is dismissed.
 * @property {string} text Empty: what it is about is over.
 * @property {"journal"} [about] journal, or absent: what was asked for last.
 */

/** Messages to Python. */
export const request = {
  /**
   * How fast a browser draws, told every few seconds.
   *
   * @param {?number} milliseconds Per frame; null if it is not looked at.
   */
  frameTime: (milliseconds) => ({ type: "frame_time", milliseconds }),
  /** The page is in view. */
  watch: () => ({ type: "watch" }),
};
