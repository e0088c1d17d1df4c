// A classic script, run before the first paint, so that a forced theme never flashes.
const wanted = new URLSearchParams(location.search).get("theme");
if (wanted === "dark" || wanted === "light") document.documentElement.dataset.theme = wanted;
