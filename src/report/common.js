// Shared by the pages of runs and of studies: numbers, elements, tables.
// A unit as people write it: N*m/s^2 is N·m/s², deg/s is °/s.
const typeset = (unit) => unit.replace(/\^2/g, "²").replace(/\^3/g, "³").replace(/\*/g, "·").replace(/deg/g, "°");
const data = JSON.parse(document.getElementById("data").textContent, (key, value) => (key === "unit" && typeof value === "string" ? typeset(value) : value));
const byId = (id) => document.getElementById(id);

// An element of the document with text, never HTML.
function element(name, text, attributes) {
  const made = document.createElement(name);
  if (text !== undefined && text !== null) made.textContent = text;
  for (const [key, value] of Object.entries(attributes || {})) made.setAttribute(key, value);
  return made;
}

// A number with four digits, as people write it. A number that is only rounding beside numbers of size `most` is 0.
function readable(value, most = 0) {
  if (value === null || !Number.isFinite(value)) return "–";
  if (Math.abs(value) <= 1e-12 * most || value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
  return text.replace("-", "−");
}

// Colours of systems and curves, also for the colour-blind (Okabe and Ito 2008).
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a7a00", "#6b6b6b"];
const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// A canvas with the resolution of the screen and the colour of panels: returns its context and its size, or nothing while it is not shown.
function blank(canvas) {
  const ratio = Math.min(3, window.devicePixelRatio || 1), c = canvas.getContext("2d");
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (width === 0) return null;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.fillStyle = style("--panel");
  c.fillRect(0, 0, width, height);
  return { c, width, height };
}

// Round numbers between two numbers, at most this many.
function ticks(low, high, count) {
  const span = high - low || 1, power = 10 ** Math.floor(Math.log10(span / count));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => span / s <= count) || 10 * power;
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; k++) found.push(k * step);
  return { found, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

function table(heads, rows) {
  const made = element("table"), head = element("tr"), box = element("div", null, { class: "wide" });
  heads.forEach(([text, number]) => head.append(element("th", text, number ? { class: "number" } : {})));
  const top = element("thead"), body = element("tbody");
  top.append(head);
  for (const row of rows) {
    const line = element("tr");
    row.forEach((cell, k) => {
      if (cell instanceof Node) { const td = element("td"); td.append(cell); line.append(td); }
      else line.append(element("td", cell, heads[k][1] ? { class: "number" } : {}));
    });
    body.append(line);
  }
  made.append(top, body);
  box.append(made);
  return box;
}
function block(parent, title, ...content) {
  const box = element("div");
  box.append(element("h3", title), ...content);
  parent.append(box);
}
function lines(texts) {
  const list = element("ul");
  texts.forEach((text) => list.append(element("li", text)));
  return list;
}
