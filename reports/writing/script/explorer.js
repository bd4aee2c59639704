
// Any quantity of any case over any other, filtered, with the cases that no other beats in both.
const WIDE = 900, TALL = 520, ROOM = { left: 70, right: 15, top: 15, bottom: 50 };
const FILTERS = ["scene", "scheme", "kernel", "path", "study"];
const COLORS = ["0072b2", "d55e00", "009e73", "cc79a7", "000000", "e69f00", "56b4e9"]
  .map((color) => (color === "000000" ? "var(--ink,#000000)" : `var(--c-${color},#${color})`));
const DASHES = ["", "6 2", "2 2", "8 2 2 2", "4 2 1 2", "1 3"];

class Explorer {
  constructor(box, data) {
    this.quantities = data.quantities;
    this.series = data.series;
    this.box = box;
    this.hidden = new Set();
    const most = this.common("scene");
    this.defaults = { x: "seconds", y: "max-norm error", scene: most, scheme: "", kernel: "", path: "", study: "" };
    this.inputs = {};
    const form = element("form", { onsubmit: (event) => event.preventDefault() });
    for (const name of ["x", "y"]) form.append(this.select(name, name === "x" ? "over " : "show ", this.quantities));
    form.prepend(form.lastChild);
    for (const name of FILTERS) {
      const values = [...new Set(this.series.map((one) => one[name]))].sort();
      if (values.length > 1) form.append(this.select(name, `${name} `, values, "all"));
    }
    this.plot = element("div", { class: "card" });
    this.said = element("p", { class: "note", role: "status" });
    this.keys = element("ul", { class: "keys" });
    this.best = element("div", {});
    box.append(form, this.said, this.plot, this.keys, this.best);
    this.plot.addEventListener("pointermove", (event) => this.point(event));
    this.plot.addEventListener("pointerleave", () => this.leave());
    state.follow(() => this.follow());
    this.follow();
  }

  common(name) {
    const counts = new Map();
    for (const one of this.series) counts.set(one[name], (counts.get(one[name]) || 0) + 1);
    return [...counts].sort((a, b) => b[1] - a[1])[0][0];
  }

  select(name, label, values, all) {
    const input = this.inputs[name] = element("select", { name, onchange: () => this.choose(name, input.value) },
      ...(all ? [element("option", { value: "" }, all)] : []), ...values.map((value) => element("option", { value }, value)));
    return element("label", {}, label, input);
  }

  choose(name, value) {
    state.set(`explore ${name}`, value === this.defaults[name] ? "" : value || "all");
    this.follow();
  }

  chosen(name) {
    const value = state.get(`explore ${name}`) || this.defaults[name];
    return value === "all" ? "" : value;
  }

  follow() {
    for (const [name, input] of Object.entries(this.inputs)) input.value = this.chosen(name);
    this.draw();
  }

  shown() {
    return this.series.filter((one) => FILTERS.every((name) => !this.chosen(name) || one[name] === this.chosen(name)));
  }

  draw() {
    const [x, y] = ["x", "y"].map((name) => Math.max(0, this.quantities.indexOf(this.chosen(name))));
    const shown = this.shown();
    const kinds = [...new Set(shown.map(named))], paths = [...new Set(shown.map((one) => one.path))];
    this.points = [];
    const curves = shown.map((one) => one.cases[0].map((_, i) => ({ one, i, x: one.cases[x][i], y: one.cases[y][i] }))
      .filter((point) => point.x > 0 && point.y > 0));
    const visible = curves.filter((curve) => curve.length && !this.hidden.has(named(curve[0].one)));
    const flat = visible.flat();
    this.plot.replaceChildren();
    this.keys.replaceChildren(...kinds.map((kind, i) => this.key(kind, COLORS[i % COLORS.length])));
    this.best.replaceChildren();
    this.said.textContent = `${flat.length} cases of ${visible.length} series.`;
    if (!flat.length) return;
    const across = scale(flat.map((point) => point.x), ROOM.left, WIDE - ROOM.right);
    const up = scale(flat.map((point) => point.y), TALL - ROOM.bottom, ROOM.top);
    const svg = this.svg = element("svg", { class: "drawing", viewBox: `0 0 ${WIDE} ${TALL}`, role: "img",
      "aria-label": `${this.quantities[y]} over ${this.quantities[x]}; the cases that no other beats are in the table below.` });
    for (const tick of across.ticks) svg.append(line(across(tick), ROOM.top, across(tick), TALL - ROOM.bottom),
      element("text", { x: across(tick), y: TALL - ROOM.bottom + 18, "text-anchor": "middle" }, written(tick)));
    for (const tick of up.ticks) svg.append(line(ROOM.left, up(tick), WIDE - ROOM.right, up(tick)),
      element("text", { x: ROOM.left - 6, y: up(tick) + 4, "text-anchor": "end" }, written(tick)));
    svg.append(element("text", { x: (WIDE + ROOM.left) / 2, y: TALL - 8, "text-anchor": "middle" }, this.quantities[x]),
      element("text", { x: ROOM.left, y: 10 }, this.quantities[y]));
    const best = frontier(flat);
    svg.append(element("path", { class: "frontier", d: joined(best, across, up) }));
    for (const curve of visible) {
      const color = COLORS[kinds.indexOf(named(curve[0].one)) % COLORS.length];
      svg.append(element("path", { class: "curve", d: joined(curve, across, up), stroke: color,
        "stroke-dasharray": DASHES[paths.indexOf(curve[0].one.path) % DASHES.length] }));
      for (const point of curve) {
        [point.px, point.py] = [across(point.x), up(point.y)];
        svg.append(element("circle", { cx: point.px, cy: point.py, r: 2.6, fill: color }));
        this.points.push(point);
      }
    }
    this.plot.append(svg);
    this.listBest(best, x, y);
  }

  // The frontier as a table: what to choose.
  listBest(best, x, y) {
    const columns = [this.quantities[x], this.quantities[y], "N", "δ/h", "scheme", "path", "steps", "study"];
    const N = this.quantities.indexOf("N"), ratio = this.quantities.indexOf("δ/h");
    const rows = best.map((point) => [short(point.x), short(point.y), point.one.cases[N][point.i],
      short(point.one.cases[ratio][point.i]), named(point.one), point.one.path, point.one.steps, point.one.study]);
    const table = element("table", { "aria-label": "cases that no other beats" },
      element("thead", {}, element("tr", {}, ...columns.map((text) => element("th", { scope: "col" }, text)))),
      element("tbody", {}, ...rows.map((cells) => element("tr", {}, ...cells.map((cell) => element("td", {}, String(cell)))))));
    const fold = element("details", {}, element("summary", {}, `The ${best.length} cases that no other beats in both`),
      element("div", { class: "scroll" }, table));
    this.best.append(fold);
  }

  key(kind, color) {
    const button = element("button", { type: "button", "aria-pressed": String(!this.hidden.has(kind)), onclick: () => {
      if (!this.hidden.delete(kind)) this.hidden.add(kind);
      this.draw();
    } }, element("span", { style: `color:${color}`, "aria-hidden": "true" }, "● "), kind);
    return element("li", {}, button);
  }

  point(event) {
    this.leave();
    if (!this.svg || !this.svg.isConnected) return;
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
    let nearest = null, least = NEAR;
    for (const point of this.points) {
      const distance = Math.hypot(point.px - at.x, point.py - at.y);
      if (distance < least) [nearest, least] = [point, distance];
    }
    if (!nearest) return;
    const { one, i } = nearest;
    this.mark = this.svg.appendChild(element("circle", { class: "pointed", cx: nearest.px, cy: nearest.py, r: 6 }));
    const list = element("dl", {}, ...this.quantities.flatMap((name, k) => one.cases[k][i] === null ? [] :
      [element("dt", {}, name), element("dd", {}, short(one.cases[k][i]))]));
    this.tip = this.plot.appendChild(element("div", { class: "tip" }, element("strong", {}, named(one)),
      element("div", {}, `${one.path}; ${one.steps}; ${one.study}; order ${one.order}: ${one.verdict}`), list));
    const share = this.svg.getBoundingClientRect().width / WIDE;
    this.tip.style.left = `${nearest.px * share > 500 ? Math.max(4, nearest.px * share - this.tip.offsetWidth - 8) : nearest.px * share + 18}px`;
    this.tip.style.top = `${Math.max(0, Math.min(nearest.py * share, TALL * share - this.tip.offsetHeight))}px`;
  }

  leave() {
    if (this.mark) this.mark.remove();
    if (this.tip) this.tip.remove();
  }
}

function named(one) {
  return `${one.scheme}, ${one.kernel}`;
}

// Points that no other beats in both, by x.
function frontier(points) {
  let least = Infinity;
  return [...points].sort((a, b) => a.x - b.x || a.y - b.y).filter((point) => point.y < least && ((least = point.y), true));
}

function joined(points, across, up) {
  return points.map((point, i) => `${i ? "L" : "M"}${across(point.x).toFixed(1)} ${up(point.y).toFixed(1)}`).join("");
}

// A logarithmic scale from one place to another, with ticks at decades, or at 1, 2 and 5 where there are few.
function scale(values, from, to) {
  let [low, high] = [Math.log10(Math.min(...values)), Math.log10(Math.max(...values))];
  const pad = Math.max(0.04 * (high - low), 0.05);
  [low, high] = [low - pad, high + pad];
  const at = (value) => from + (to - from) * (Math.log10(value) - low) / (high - low);
  const decades = Array.from({ length: Math.floor(high) - Math.ceil(low) + 1 }, (_, i) => Math.ceil(low) + i);
  at.ticks = decades.filter((_, i) => i % Math.ceil(decades.length / 9 || 1) === 0).map((power) => 10 ** power);
  if (at.ticks.length < 3) at.ticks = [...Array(Math.ceil(high) - Math.floor(low) + 1).keys()]
    .flatMap((i) => [1, 2, 5].map((step) => step * 10 ** (Math.floor(low) + i)))
    .filter((tick) => Math.log10(tick) > low && Math.log10(tick) < high);
  return at;
}

function line(x1, y1, x2, y2) {
  return element("line", { class: "grid", x1, y1, x2, y2 });
}

function written(tick) {
  return tick >= 1e-3 && tick < 1e5 ? String(Number(tick.toPrecision(3))) : tick.toExponential(0).replace("+", "");
}

function short(value) {
  return value === null ? "–" : Number.isInteger(value) ? String(value) : Number(value.toPrecision(4)).toString();
}

function setUpExplorer() {
  const stored = document.getElementById("q.cases");
  if (stored) new Explorer(document.querySelector(".explorer"), JSON.parse(stored.textContent));
}
