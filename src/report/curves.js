// Outputs over time: a plot for each unit, and one cursor for all plots and the motion.
const columns = data.columns || [];
const clock = columns.length ? columns[0].values : [];
const plots = [];
let zoomed = null;

// Curves on top of those of the run, with times of their own: measured curves, and those of a second run.
const overlays = [...(data.overlays || []), ...(data.beside ? data.beside.curves : [])];

class Plot {
  constructor(unit, members) {
    this.unit = unit;
    const own = members.filter((column) => !column.times);
    const place = (column, k) => {
      // an overlay has the colour of the curve below
      const over = own.findIndex((one) => column.times && (column.name.startsWith(`${one.name} measured`) || column.name.startsWith(`${one.name} with `)));
      return over < 0 ? k : over;
    };
    const dash = (column, k) => (column.times ? (column.name.includes(" measured") ? [2, 3] : [9, 4]) : [[], [7, 4], [2, 3], [9, 3, 2, 3]][Math.floor(k / COLOURS.length) % 4]);
    this.members = members.map((column, k) => ({ column, clock: column.times || clock, size: column.values.reduce((most, v) => Math.max(most, Math.abs(v || 0)), 0), colour: COLOURS[place(column, k) % COLOURS.length], dash: dash(column, k), shown: true }));
    const box = element("div", null, { class: "plot" });
    const head = element("header");
    const saving = element("button", "save picture");
    saving.addEventListener("click", () => save(this.canvas, `${data.model}-${unit.replace(/[^A-Za-z0-9]+/g, "-") || "curves"}.png`));
    head.append(element("span", `[${unit || "–"}] over time [ms]`), saving);
    this.canvas = element("canvas", null, { "aria-label": `curves in ${unit}` });
    const keys = element("div", null, { class: "keys" });
    for (const member of this.members) {
      const key = element("button", null, { "aria-pressed": "true", title: "show or hide" });
      const mark = element("i");
      mark.style.borderTopColor = member.colour;
      mark.style.borderTopStyle = member.dash.length ? "dashed" : "solid";
      member.value = element("output", "");
      key.append(mark, element("span", member.column.name), member.value);
      key.addEventListener("click", () => { member.shown = !member.shown; key.setAttribute("aria-pressed", member.shown); this.draw(); });
      keys.append(key);
    }
    box.append(head, this.canvas, keys);
    byId("curves").append(box);
    this.hands();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }
  range() { return zoomed || [clock[0], clock[clock.length - 1]]; }
  hands() {
    let from = null;
    const timeAt = (e) => {
      const { left, width } = this.canvas.getBoundingClientRect(), [a, b] = this.range();
      return a + ((e.clientX - left - 58) / Math.max(1, width - 74)) * (b - a);
    };
    this.canvas.addEventListener("pointerdown", (e) => { from = timeAt(e); this.canvas.setPointerCapture(e.pointerId); pick(from); });
    this.canvas.addEventListener("pointermove", (e) => {
      if (from === null) return;
      this.band = [from, timeAt(e)];
      this.draw();
    });
    const end = (e) => {
      if (from === null) return;
      const [a, b] = [from, timeAt(e)].sort((x, y) => x - y), [low, high] = this.range();
      if (b - a > 0.02 * (high - low)) zoomed = [Math.max(clock[0], a), Math.min(clock[clock.length - 1], b)];
      from = this.band = null;
      plots.forEach((plot) => plot.draw());
    };
    this.canvas.addEventListener("pointerup", end);
    this.canvas.addEventListener("pointercancel", () => { from = this.band = null; this.draw(); });
    this.canvas.addEventListener("dblclick", () => { zoomed = null; plots.forEach((plot) => plot.draw()); });
  }
  draw() {
    const made = blank(this.canvas);
    if (!made) return;
    const { c, width, height } = made;
    const [left, right, top, bottom] = [58, width - 16, 8, height - 22], [a, b] = this.range();
    const shown = this.members.filter((m) => m.shown);
    let [low, high] = [Infinity, -Infinity];
    for (const { column, clock } of shown) column.values.forEach((v, k) => {
      if (v !== null && clock[k] >= a - 1e-12 && clock[k] <= b + 1e-12) { low = Math.min(low, v); high = Math.max(high, v); }
    });
    if (!(low <= high)) [low, high] = [0, 1];
    if (low > 0 && low < 0.5 * high) low = 0;
    if (high < 0 && high > 0.5 * low) high = 0;
    const margin = 0.05 * (high - low || Math.abs(high) || 1);
    [low, high] = [low === 0 ? 0 : low - margin, high === 0 ? 0 : high + margin];
    const [px, py] = [(t) => left + ((t - a) / (b - a || 1)) * (right - left), (v) => bottom - ((v - low) / (high - low || 1)) * (bottom - top)];
    c.font = "11px system-ui, sans-serif";
    c.strokeStyle = style("--line");
    c.fillStyle = style("--soft");
    c.lineWidth = 1;
    const up = ticks(low, high, 6), along = ticks(1000 * a, 1000 * b, Math.max(3, Math.floor(width / 80)));
    c.textAlign = "right";
    for (const v of up.found) {
      c.beginPath(); c.moveTo(left, py(v)); c.lineTo(right, py(v)); c.stroke();
      const text = Math.abs(v) >= 1e6 ? v.toExponential(1) : v.toFixed(Math.min(8, up.digits));
      c.fillText(text.replace("-", "−"), left - 5, py(v) + 4);
    }
    c.textAlign = "center";
    for (const t of along.found) {
      c.beginPath(); c.moveTo(px(t / 1000), top); c.lineTo(px(t / 1000), bottom); c.stroke();
      c.fillText(t.toFixed(along.digits), px(t / 1000), height - 7);
    }
    c.save();
    c.beginPath();
    c.rect(left, top - 2, right - left, bottom - top + 4);
    c.clip();
    for (const { column, clock, colour, dash } of shown) {
      c.strokeStyle = colour;
      c.lineWidth = 1.8;
      c.setLineDash(dash);
      c.beginPath();
      let down = false;
      column.values.forEach((v, k) => {
        if (v === null) { down = false; return; }
        if (down) c.lineTo(px(clock[k]), py(v)); else c.moveTo(px(clock[k]), py(v));
        down = true;
      });
      c.stroke();
    }
    c.setLineDash([]);
    if (this.band) {
      c.fillStyle = style("--accent");
      c.globalAlpha = 0.18;
      c.fillRect(px(this.band[0]), top, px(this.band[1]) - px(this.band[0]), bottom - top);
      c.globalAlpha = 1;
    }
    c.strokeStyle = style("--ink");
    c.lineWidth = 1;
    c.beginPath(); c.moveTo(px(now), top); c.lineTo(px(now), bottom); c.stroke();
    c.restore();
    for (const member of this.members) member.value.textContent = readable(valueAt(member.column.values, now, member.clock), member.size);
  }
}

// Interpolates between two rows.
function valueAt(values, t, clock) {
  if (values.length === 0 || t < clock[0] - 1e-9 || t > clock[clock.length - 1] + 1e-9) return null;
  let k = clock.findIndex((time) => time > t);
  if (k < 0) k = clock.length - 1;
  if (k === 0) return values[0];
  const [a, b] = [values[k - 1], values[k]];
  if (a === null || b === null) return null;
  const u = Math.max(0, Math.min(1, (t - clock[k - 1]) / (clock[k] - clock[k - 1] || 1)));
  return a + (b - a) * u;
}
// Called when the reader points at a time in a plot.
function pick(t) {
  if (times.length) { play(false); setTime(t); return; }
  now = Math.max(clock[0], Math.min(clock[clock.length - 1], t));
  plots.forEach((plot) => plot.draw());
}

function startCurves() {
  const units = new Map();
  for (const column of [...columns.slice(1), ...overlays]) {
    if (!units.has(column.unit)) units.set(column.unit, []);
    units.get(column.unit).push(column);
  }
  if (!units.size || clock.length === 0) { document.querySelector(".curves").hidden = true; return; }
  for (const [unit, members] of units) plots.push(new Plot(unit, members));
  let waiting = false;
  listeners.push(() => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; plots.forEach((plot) => plot.draw()); });
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => plots.forEach((plot) => plot.draw()));
}
