/** Runs at the head of viser's page, before viser does. */
(() => {
  const PAGES = [
    ["rules", "Rule table", "read and change the rules, and see what each piece is worth"],
    ["evolution", "Evolution", "evolve rules, and follow how they get better"],
    ["experiments", "Experiments", "compare rule sets, and repeat the paper's experiments"],
  ];

  const here = new URL(location.href);
  here.pathname = here.pathname.replace(/index\.html$/, "");
  if (!here.pathname.endsWith("/")) {
    here.pathname += "/"; // or what is beside this page would be looked for above it
    location.replace(here);
    return;
  }

  const token = here.searchParams.get("token");

  /** A proxy knows its path with the slash at its end, without which viser would ask. */
  function findSocket() {
    const socket = new URL(here.pathname, here);
    socket.protocol = here.protocol === "https:" ? "wss:" : "ws:";
    here.searchParams.delete("websocket"); // nor is anybody sent to a server elsewhere
    if (here.pathname !== "/") here.searchParams.set("websocket", socket.href);
    if (here.href !== location.href) history.replaceState(null, "", here);
  }

  /** What viser's page uses. */
  function hasWebGL() {
    try {
      const context = document.createElement("canvas").getContext("webgl2");
      context?.getExtension("WEBGL_lose_context")?.loseContext();
      return context !== null;
    } catch {
      return false;
    }
  }

  function h(tag, attributes, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    node.append(...children);
    return node;
  }

  /** Show this instead of what viser makes of the page. */
  function show(title, ...children) {
    const node = h("main", { class: "geswarm-instead" }, h("h1", {}, title), ...children);
    document.getElementById("root")?.setAttribute("inert", "");
    document.body.append(node);
  }

  function offerPages() {
    const query = token === null ? "" : `?${new URLSearchParams({ token })}`;
    const item = ([name, title, what]) => h("li", {}, h("a", { href: `${name}/${name}.html${query}` }, title), `: ${what}`);
    show(
      "The arena needs WebGL, which this browser does not have",
      h("p", {}, "It may be switched off, or missing on a remote desktop or a virtual machine. These pages need none:"),
      h("ul", {}, ...PAGES.map(item)),
    );
  }

  async function tellRefusal() {
    if (token !== null && !navigator.cookieEnabled) {
      show("GESwarm needs a cookie here", h("p", {}, "The token is kept in a cookie, and this browser blocks them: allow cookies for this site."));
      return;
    }
    const why = await whyRefused(); // of refused.js
    if (why !== null) show("GESwarm is here, but this address is refused", h("p", {}, `Refused: ${why}`));
  }

  findSocket();
  document.addEventListener("DOMContentLoaded", () => {
    if (!hasWebGL()) offerPages();
    tellRefusal();
  });
})();
