// A classic script: browsers ask for modules as they do for websockets, and where one is refused so
// is the other.
const admitted = new URL("admitted", document.currentScript.src);

/**
 * Browsers tell a page neither that its websocket was refused nor why.
 *
 * @returns {Promise<?string>} Why the server refuses this page; null if it does not, or is not there.
 */
async function whyRefused() {
  admitted.searchParams.set("origin", location.origin);
  const answer = await fetch(admitted).catch(() => null);
  return answer?.status === 403 ? (await answer.text()).trim() : null;
}

/** A page whose modules are missing shows nothing by itself. */
addEventListener("error", async ({ target }) => {
  if (target.localName !== "script") return;
  const why = await whyRefused();
  const notice = document.createElement("p");
  notice.className = "notice error";
  notice.setAttribute("role", "alert");
  notice.textContent = why === null ? "This page did not arrive whole: load it again." : `Refused: ${why}`;
  document.body.classList.remove("waiting");
  document.body.append(notice);
}, true);
