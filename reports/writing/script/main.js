
// Light, dark or as the system is; "departing only"; links within the page; and everything that follows the address.
function setUpTools() {
  const tools = document.querySelector(".tools");
  const only = element("input", { type: "checkbox", onchange: () => state.set("only", only.checked && "departing") || follow() });
  const theme = element("select", { onchange: () => state.set("theme", theme.value) || follow() },
    ...["as the system", "light", "dark"].map((name, i) => element("option", { value: i ? name : "" }, name)));
  const none = element("span", { class: "note" });
  function follow() {
    only.checked = state.get("only") === "departing";
    theme.value = state.get("theme");
    none.textContent = only.checked && !document.querySelector("tr.departs") ? "nothing departs" : "";
    if (theme.value) document.documentElement.dataset.theme = theme.value;
    else delete document.documentElement.dataset.theme;
    showDeparting(only.checked);
  }
  tools.append(element("label", {}, only, " departing only"), none, element("label", {}, "colors ", theme));
  tools.hidden = false;
  state.follow(follow);
}

document.addEventListener("click", (event) => {
  const link = event.target.closest('a[href^="#"]');
  if (!link || event.ctrlKey || event.metaKey || event.shiftKey) return;
  event.preventDefault();
  state.go(decoded(link.getAttribute("href").slice(1)));
  if (link.dataset.find) {
    const study = document.getElementById(state.place);
    for (const fold of study.querySelectorAll("details.findings")) fold.open = true;
    setUpTables(study);
    for (const table of study.querySelectorAll(".findings table")) table.sheet.find(link.dataset.find);
  }
});
document.addEventListener("toggle", (event) => event.target.open && setUpTables(event.target), true);
document.addEventListener("contentvisibilityautostatechange", (event) => event.skipped || letScroll(event.target), true);
window.addEventListener("resize", () => letScroll(document));
window.addEventListener("popstate", () => state.apply());

state.read();
setUpTools();
setUpFigures();
setUpExplorer();
state.follow(() => document.querySelectorAll(".scroll > table").forEach((table) => table.sheet && table.sheet.follow()));
state.apply();
// Below the first screen there is time.
requestAnimationFrame(() => setTimeout(() => setUpTables(document), 0));
