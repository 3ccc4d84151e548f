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

// A number with four digits or more, as people write it: no digit before the point is rounded away. A number that is only rounding beside numbers of size
// `most` is 0.
function readable(value, most = 0) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (Math.abs(value) <= 1e-12 * most || value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e7 || size < 1e-4 ? value.toExponential(3) : String(Number(value.toPrecision(Math.max(4, Math.floor(Math.log10(size)) + 1))));
  return text.replace("-", "−");
}
// A limit as the regulation prints it: all digits, but not those that only a conversion of units adds.
const limitText = (limit) => String(Number(limit.toPrecision(12)));
// Times are in milliseconds, those of a long run in seconds, as in the terminal.
const TIME = data.times && data.times[data.times.length - 1] >= 10 ? { unit: "s", scale: 1, digits: 3 } : { unit: "ms", scale: 1000, digits: 1 };
const atTime = (t) => `${Number((TIME.scale * t).toPrecision(6))} ${TIME.unit}`;
const timeText = (t) => (TIME.scale * t).toFixed(TIME.digits);

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

// A canvas with axes, their titles and numbers; x may be in other units than its numbers are printed in. `paint` gets functions from numbers to places.
function chart(canvas, [a, b], [low, high], titles, paint, scale = 1) {
  const made = blank(canvas);
  if (!made) return;
  const { c, width, height } = made;
  c.font = "11px system-ui, sans-serif";
  const text = (v, digits) => (Math.abs(v) >= 1e7 ? v.toExponential(1) : v.toFixed(Math.min(8, digits))).replace("-", "−");
  const [up, along] = [ticks(low, high, Math.max(2, Math.floor(height / 38))), ticks(scale * a, scale * b, Math.max(2, Math.floor(width / 90)))];
  const numbers = Math.max(...up.found.map((v) => c.measureText(text(v, up.digits)).width));
  const [left, right, top, bottom] = [Math.max(28, numbers + 12), width - 14, 22, height - 34];
  const [px, py] = [(x) => left + ((x - a) / (b - a || 1)) * (right - left), (y) => bottom - ((y - low) / (high - low || 1)) * (bottom - top)];
  c.strokeStyle = style("--line");
  c.fillStyle = style("--soft");
  c.lineWidth = 1;
  c.textAlign = "right";
  for (const v of up.found) {
    c.beginPath(); c.moveTo(left, py(v)); c.lineTo(right, py(v)); c.stroke();
    c.fillText(text(v, up.digits), left - 5, py(v) + 4);
  }
  c.textAlign = "center";
  for (const v of along.found) {
    c.beginPath(); c.moveTo(px(v / scale), top); c.lineTo(px(v / scale), bottom); c.stroke();
    c.fillText(text(v, along.digits), px(v / scale), bottom + 14);
  }
  c.fillText(titles[0], (left + right) / 2, height - 5);
  c.textAlign = "left";
  c.fillText(titles[1], 4, 12);
  c.save();
  c.beginPath();
  c.rect(left, top - 2, right - left, bottom - top + 4);
  c.clip();
  paint(c, px, py, { left, right, top, bottom });
  c.restore();
  canvas.places = { left, right, top, bottom, a, b, low, high, x: px, y: py };
}

// Shows numbers beside the place x of a canvas: rows of { colour, name, value, unit, near }.
function showReading(box, canvas, x, title, rows) {
  box.replaceChildren(element("b", title), ...rows.map(({ colour, name, value, unit, near }) => {
    const row = element("div", null, near ? { class: "near" } : {});
    if (colour) {
      const mark = element("i");
      mark.style.background = colour;
      row.append(mark);
    }
    row.append(element("span", name), element("output", value), element("span", unit || "", { class: "unit" }));
    return row;
  }));
  box.hidden = false;
  const right = x + 14 + box.offsetWidth > canvas.clientWidth;
  box.style.left = `${right ? Math.max(0, x - 14 - box.offsetWidth) : x + 14}px`;
}

// What is drawn is drawn again where its colours or its size change at once: in the dark, and on paper.
let printing = false;
const drawn = [];
const onPaper = (draw) => drawn.push(draw);
function repaint() { drawn.forEach((draw) => draw()); }
function paper(on) {
  printing = on;
  document.documentElement.classList.toggle("print", on);
  repaint();
}
window.addEventListener("beforeprint", () => paper(true));
window.addEventListener("afterprint", () => paper(false));
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);

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
// The same, folded: only its title is seen until it is opened.
function folded(parent, title, ...content) {
  const box = element("details");
  box.append(element("summary", title), ...content);
  parent.append(box);
}
function lines(texts) {
  const list = element("ul");
  texts.forEach((text) => list.append(element("li", text)));
  return list;
}
