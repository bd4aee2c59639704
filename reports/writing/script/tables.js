
// Tables are sorted by their heads, filtered by words, and saved as CSV; longer ones say how many rows they show.
const FILTERED = 6;     // rows from which a table has a filter

class Sheet {
  constructor(table) {
    this.table = table;
    this.name = table.getAttribute("aria-label");
    this.body = table.tBodies[0];
    this.rows = [...this.body.rows];
    this.heads = [...table.tHead.rows[0].cells];
    this.heads.forEach((head, column) => this.addButton(head, column));
    this.makeOneStop();
    if (this.rows.length >= FILTERED && !table.closest(".second")) this.addFinder();
    table.sheet = this;
    this.follow();
  }

  // The heads of a table are one stop of the tab key; arrow keys go from one to the next.
  addButton(head, column) {
    const button = element("button", { type: "button", tabindex: column ? -1 : 0, onclick: () => this.sortBy(column),
      onkeydown: (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        const next = step && this.heads[column + step];
        if (next) next.querySelector("button").focus();
      } });
    button.append(...head.childNodes);
    head.append(button);
  }

  // So are all links of its rows; arrow keys go up and down.
  makeOneStop() {
    const stops = "tbody a, tbody summary";
    [...this.table.querySelectorAll(stops)].forEach((stop, i) => (stop.tabIndex = i ? -1 : 0));
    this.body.addEventListener("keydown", (event) => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      const all = [...this.table.querySelectorAll(stops)].filter((stop) => stop.checkVisibility?.() ?? true);
      const next = step && all[all.indexOf(event.target) + step];
      if (!next) return;
      event.preventDefault();
      all.forEach((stop) => (stop.tabIndex = stop === next ? 0 : -1));
      next.focus();
    });
  }

  addFinder() {
    this.input = element("input", { type: "search", placeholder: "filter rows", "aria-label": `filter rows of ${this.name}`,
      oninput: () => state.set(`find ${this.name}`, this.input.value) || this.filter() });
    this.count = element("span", { class: "note" });
    const csv = element("button", { type: "button", onclick: () => this.save(), "aria-label": `CSV of ${this.name}` }, "CSV");
    this.table.parentElement.before(element("div", { class: "finder" }, this.input, csv, this.count));
  }

  // What the address says.
  follow() {
    const [column, down] = state.get(`sort ${this.name}`).split(" ");
    if (column) this.sort(Number(column), down === "down");
    if (this.input) {
      this.input.value = state.get(`find ${this.name}`);
      this.filter();
    }
  }

  sortBy(column) {
    const down = this.heads[column].getAttribute("aria-sort") === "ascending";
    state.set(`sort ${this.name}`, `${column}${down ? " down" : ""}`);
    this.sort(column, down);
  }

  sort(column, down) {
    if (!this.heads[column]) return;
    this.heads.forEach((head) => head.removeAttribute("aria-sort"));
    this.heads[column].setAttribute("aria-sort", down ? "descending" : "ascending");
    const keyed = this.rows.map((row) => [sortKey(row.cells[column]), row]);
    keyed.sort(([a], [b]) => compared(a, b, down ? -1 : 1));
    this.body.append(...keyed.map(([, row]) => row));
  }

  find(words) {
    if (!this.input) return;
    this.input.value = words;
    state.set(`find ${this.name}`, words);
    this.filter();
  }

  filter() {
    const words = this.input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of this.rows) {
      const text = words.length ? row.textContent.toLowerCase() : "";
      row.hidden = !words.every((word) => text.includes(word));
      shown += !row.hidden;
    }
    this.count.textContent = shown < this.rows.length ? `${shown} of ${this.rows.length} rows` : `${shown} rows`;
  }

  save() {
    const lines = [this.table.tHead.rows[0], ...this.body.rows].filter((row) => !row.hidden).map((row) =>
      [...row.cells].map((cell) => `"${cell.textContent.trim().replace(/\s+/g, " ").replaceAll('"', '""')}"`).join(","));
    saved(`${this.name}.csv`, "text/csv", "\ufeff" + lines.join("\r\n") + "\r\n");
  }
}

// The number that a cell begins with, or its text; null for nothing.
function sortKey(cell) {
  const text = (cell ? cell.textContent : "").trim();
  const number = text.replaceAll("−", "-").replaceAll("\u202f", "").match(/^(?:order |[<~]\s*)?(-?\d[\d.]*(?:e[-+]?\d+)?)(?![\w])/);
  return text === "" || text === "–" || text.startsWith("nan") ? null : number ? Number(number[1]) : text;
}

// What is nothing comes last, whatever the direction.
function compared(a, b, sign) {
  if (a === null || b === null) return (a === null) - (b === null);
  if (typeof a === "number" && typeof b === "number") return sign * (a - b);
  return sign * String(a).localeCompare(String(b), "en", { numeric: true });
}

function setUpTables(within) {
  for (const table of within.querySelectorAll(".scroll > table")) {
    const folded = table.closest("details:not([open])");
    if (!table.sheet && !folded) new Sheet(table);
  }
  letScroll(within);
}

// What scrolls sideways can be reached by keys, and nothing else takes a stop. Studies that are far from the screen have no
// layout yet, and asking for it takes seconds: there figures scroll where media.css lets them.
function letScroll(within) {
  const narrow = matchMedia("(max-width: 40rem)").matches;
  for (const box of within.querySelectorAll(".scroll, .card:not([role=group])")) {
    const far = box.checkVisibility && !box.checkVisibility({ contentVisibilityAuto: true });
    if (far ? narrow && box.matches(".card") : box.scrollWidth > box.clientWidth + 1) {
      box.tabIndex = 0;
      box.setAttribute("role", "region");
      box.setAttribute("aria-label", box.firstElementChild.getAttribute("aria-label"));
    } else if (box.hasAttribute("tabindex")) {
      ["tabindex", "role", "aria-label"].forEach((name) => box.removeAttribute(name));
    }
  }
}

// Rows, tables and studies in which nothing departs are hidden.
function showDeparting(only) {
  document.body.classList.toggle("only", only);
  for (const row of document.querySelectorAll(".scroll tbody tr")) row.classList.toggle("departs-not", !row.classList.contains("departs"));
  for (const part of document.querySelectorAll(".study, .question, .scroll, figure, #q\\.explorer, #q\\.provenance"))
    part.classList.toggle("departs-not", !part.querySelector("tr.departs"));
  if (only) for (const row of document.querySelectorAll("tr.departs")) {
    const fold = row.closest("details");
    if (fold) fold.open = true;
  }
}
