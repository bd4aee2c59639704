
// Figures tell of the point that is pointed at or reached by arrow keys, and hide series by their legend.
const NEAR = 16;        // units of the drawing within which a point is meant

class Figure {
  constructor(figure) {
    this.stem = figure.dataset.figure;
    this.card = figure.querySelector(".card");
    this.svg = this.card.querySelector("svg");
    const stored = figure.querySelector("script.curves");
    this.curves = JSON.parse(stored.textContent).map(([key, name, about, columns, points]) => ({ key, name, about, columns, points }));
    this.at = null;     // [curve, point], indices
    this.card.tabIndex = 0;
    this.card.setAttribute("role", "group");
    this.card.setAttribute("aria-label", `${this.svg.getAttribute("aria-label")} Arrow keys go through its points, Enter hides a series.`);
    this.card.addEventListener("pointermove", (event) => this.point(event));
    this.card.addEventListener("pointerleave", () => this.leave());
    this.card.addEventListener("blur", () => this.leave());
    this.card.addEventListener("keydown", (event) => this.key(event));
    this.card.addEventListener("click", (event) => {
      const entry = event.target.closest("[data-legend]");
      if (entry) this.toggle(entry.dataset.legend);
    });
    state.follow(() => this.follow());
    this.follow();
  }

  get hidden() {
    return new Set(state.get(`hide ${this.stem}`).split(",").filter(Boolean));
  }

  follow() {
    const hidden = this.hidden;
    for (const part of this.svg.querySelectorAll("[data-series], [data-legend]"))
      part.classList.toggle("off", hidden.has(part.dataset.series || part.dataset.legend));
  }

  toggle(key) {
    const hidden = this.hidden;
    const name = (this.curves.find((curve) => curve.key === key) || { name: key }).name;
    tell(`${name} ${hidden.delete(key) ? "shown" : hidden.add(key) && "hidden"}`);
    state.set(`hide ${this.stem}`, [...hidden].join(","));
    this.follow();
    this.leave();
  }

  point(event) {
    const entry = event.target.closest("[data-legend]");
    if (entry) {
      this.leave();
      return this.highlight(entry.dataset.legend);
    }
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
    const hidden = this.hidden;
    let nearest = null, least = NEAR;
    this.curves.forEach((curve, i) => {
      if (!hidden.has(curve.key)) curve.points.forEach(([x, y], k) => {
        const distance = Math.hypot(x - place.x, y - place.y);
        if (distance < least) [nearest, least] = [[i, k], distance];
      });
    });
    if (nearest) this.tellOf(...nearest);
    else this.leave();
  }

  key(event) {
    if (event.target !== this.card) return;
    const steps = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key];
    if (event.key === "Enter" && this.at) this.toggle(this.curves[this.at[0]].key);
    else if (event.key === "Escape") this.leave();
    else if (steps) {
      const [i, k] = this.at || [0, -steps[1]];
      const curve = (i + steps[0] + this.curves.length) % this.curves.length;
      const points = this.curves[curve].points.length;
      this.tellOf(curve, this.at ? (Math.min(k, points - 1) + steps[1] + points) % points : 0);
      tell(this.text().join("; "));
    } else return;
    event.preventDefault();
  }

  text() {
    const curve = this.curves[this.at[0]], [, , ...texts] = curve.points[this.at[1]];
    return [curve.name, curve.about, ...texts.map((text, i) => `${curve.columns[i]} ${text}`)];
  }

  tellOf(i, k) {
    if (this.at && this.at[0] === i && this.at[1] === k) return;
    this.leave();
    this.at = [i, k];
    const curve = this.curves[i], [x, y, ...texts] = curve.points[k];
    this.highlight(curve.key);
    this.mark = this.svg.appendChild(element("circle", { class: "pointed", cx: x, cy: y, r: 6 }));
    const list = element("dl", {}, ...texts.flatMap((text, n) => text === "–" ? [] :
      [element("dt", {}, curve.columns[n]), element("dd", {}, text)]));
    this.tip = this.card.appendChild(element("div", { class: "tip" }, element("strong", {}, curve.name),
      element("div", {}, curve.about), list));
    const box = this.card.getBoundingClientRect(), at = new DOMPoint(x, y).matrixTransform(this.svg.getScreenCTM());
    const left = at.x - box.left + this.card.scrollLeft;
    const room = this.card.scrollLeft + box.width - this.tip.offsetWidth - 4;
    this.tip.style.left = `${Math.max(4, left + 14 > room ? Math.min(left - this.tip.offsetWidth - 14, room) : left + 14)}px`;
    this.tip.style.top = `${at.y - box.top + 12}px`;
  }

  highlight(key) {
    this.svg.classList.add("highlighted");
    for (const part of this.svg.querySelectorAll("[data-series]")) part.classList.toggle("lit", part.dataset.series === key);
  }

  leave() {
    this.at = null;
    if (this.mark) this.mark.remove();
    if (this.tip) this.tip.remove();
    this.svg.classList.remove("highlighted");
  }
}

function setUpFigures() {
  for (const figure of document.querySelectorAll("figure[data-figure]"))
    if (figure.querySelector("script.curves")) figure.drawn = new Figure(figure);
}
