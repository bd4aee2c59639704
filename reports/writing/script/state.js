"use strict";

// What a reader has chosen stands in the address, "#place&key=value&...", so that it can be sent and gone back to.
const state = {
  place: "",
  values: new Map(),
  listeners: [],

  read() {
    const [place, ...pairs] = location.hash.slice(1).split("&");
    this.place = decoded(place);
    this.values = new Map(pairs.map((pair) => pair.split("=").map(decoded)).filter(([, value]) => value));
  },

  get(key) {
    return this.values.get(key) || "";
  },

  // No value: what it is without a choice.
  set(key, value) {
    if (value) this.values.set(key, String(value));
    else this.values.delete(key);
    history.replaceState(null, "", this.address());
  },

  address() {
    const pairs = [...this.values].map(([key, value]) => `${encodeURIComponent(key)}=${encodeURIComponent(value)}`);
    return "#" + [encodeURIComponent(this.place), ...pairs].join("&");
  },

  // Every part of the page follows the address, at first and when the reader goes back.
  follow(listener) {
    this.listeners.push(listener);
  },

  apply() {
    this.read();
    this.listeners.forEach((listener) => listener());
    show(this.place);
  },

  go(place) {
    this.place = place;
    history.pushState(null, "", this.address());
    show(place);
  },
};

function decoded(text) {
  try {
    return decodeURIComponent(text || "");
  } catch (error) {
    return "";      // an address that somebody cut
  }
}

// Unfolds what hides a place, goes there and leaves the focus there.
function show(place) {
  const target = place && document.getElementById(place);
  if (!target) return;
  for (let part = target; part; part = part.parentElement) if (part.tagName === "DETAILS") part.open = true;
  target.scrollIntoView();
  if (!target.hasAttribute("tabindex") && !target.matches("a, button, input, summary")) target.tabIndex = -1;
  target.focus({ preventScroll: true });
}

// An element with attributes, of which those that begin with "on" are listeners, and contents.
function element(name, attributes = {}, ...contents) {
  const svg = ["svg", "g", "path", "circle", "text", "line"].includes(name);
  const made = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== false && value !== null) made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...contents);
  return made;
}

// Tells who hears the page.
function tell(text) {
  document.querySelector(".told").textContent = text;
}

function saved(name, type, text) {
  const address = URL.createObjectURL(new Blob([text], { type }));
  element("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}
