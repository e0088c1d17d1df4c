/** How fast this browser draws, told to Python: the arena beside a page is drawn in turn with it. */

import { request } from "./protocol.js";

const EVERY = 2000; // ms

/** @param {import("./socket.js").Socket} socket */
export function tellFrames(socket) {
  if (parent === window) return; // there is no arena beside this page
  let frames = 0;
  let since = performance.now();
  let seen = false;
  const begin = () => {
    frames = 0;
    since = performance.now();
  };
  const tell = () => {
    const before = seen;
    seen = !document.hidden && innerWidth > 0;
    const each = (performance.now() - since) / Math.max(frames, 1);
    if (before || seen) socket.send(request.frameTime(before && seen ? each : null));
    begin();
  };
  const count = () => {
    frames += 1;
    requestAnimationFrame(count);
  };
  requestAnimationFrame(count);
  setInterval(tell, EVERY);
  for (const [target, change] of [[document, "visibilitychange"], [window, "resize"]]) {
    target.addEventListener(change, () => (document.hidden || innerWidth === 0 ? tell() : begin()));
  }
}
