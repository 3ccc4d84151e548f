// Outputs over time: a plot for each quantity, and one cursor for all plots and the motion.
const clock = data.times || [];
let zoomed = null;
// The time under the pointer, where there is one in a plot [s].
let pointed = null;

// All points of a curve in order of time: its rows, and what lies between them.
function pointsOf(curve, rows) {
  const { times, values } = curve.between || { times: [], values: [] };
  const points = { times: [], values: [] };
  const take = (t, v) => { points.times.push(t); points.values.push(v); };
  let next = 0;
  rows.forEach((t, k) => {
    while (next < times.length && times[next] < t) { take(times[next], values[next]); next += 1; }
    take(t, curve.values[k]);
  });
  return points;
}

// Curves on top of those of the run, with points of their own: those of a test, and those of a second run.
const overlays = [
  ...(data.overlays || []).map((curve) => ({ ...curve, dash: [2, 3], points: { times: curve.times, values: curve.values } })),
  ...(data.beside ? data.beside.curves.map((curve, of) => ({ ...curve, of, name: data.beside.label, dash: [9, 4], points: pointsOf(curve, data.beside.times) })) : []),
];

// The index of the last time that is not after t; of times before the first one it is 0.
function before(times, t) {
  let [low, high] = [0, times.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  return low;
}
// The value of a curve between its points; null where it has none.
function valueAt({ times, values }, t) {
  const slack = 1e-9 * Math.max(1, Math.abs(t));
  if (!times.length || t < times[0] - slack || t > times[times.length - 1] + slack) return null;
  const k = before(times, t), [a, b] = [values[k], values[Math.min(k + 1, values.length - 1)]];
  if (t <= times[k] || k + 1 === values.length) return a;
  if (a === null || b === null) return null;
  return a + ((b - a) * (t - times[k])) / (times[k + 1] - times[k] || 1);
}

class Plot {
  constructor({ title, what, unit, curves }) {
    this.title = title;
    this.axis = unit ? `${what} [${unit}]` : what;
    this.members = [];
    curves.forEach((index, k) => {
      const column = columns[index], colour = COLOURS[k % COLOURS.length];
      this.add({ name: column.name, unit: column.unit, colour, dash: [], points: pointsOf(column, clock), index });
      // an overlay has the colour of its curve
      for (const one of overlays) if (one.of === index) this.add({ name: `${column.name}, ${one.name}`, unit: one.unit, colour, dash: one.dash, points: one.points, index });
    });
    this.box = element("figure", null, { class: "plot" });
    const head = element("figcaption"), saving = element("button", "save picture", { class: "quiet" });
    saving.addEventListener("click", () => save(this.canvas, `${data.model}-${title.replace(/[^A-Za-z0-9]+/g, "-")}.png`));
    head.append(element("span", title), saving);
    this.canvas = element("canvas", null, { tabindex: "0", role: "img", "aria-label": `${title} over time: ${this.members.map((m) => m.name).join(", ")}` });
    this.reading = element("div", null, { class: "reading", role: "status" });
    this.reading.hidden = true;
    const keys = element("div", null, { class: "keys" });
    for (const member of this.members) keys.append(this.key(member));
    const stage = element("div", null, { class: "stage" });
    stage.append(this.canvas, this.reading);
    this.box.append(head, stage, keys);
    byId("curves").append(this.box);
    this.hands();
    new ResizeObserver(() => { if (this.seen) this.draw(); }).observe(this.canvas);
    watching.observe(this.box);
  }
  add(member) {
    const size = member.points.values.reduce((most, v) => Math.max(most, Math.abs(v || 0)), 0);
    this.members.push({ ...member, size, shown: true });
  }
  key(member) {
    const key = element("button", null, { "aria-pressed": "true", title: "show or hide" }), mark = element("i");
    mark.style.borderTopColor = member.colour;
    mark.style.borderTopStyle = member.dash.length ? "dashed" : "solid";
    member.value = element("output", "");
    key.append(mark, element("span", member.name), member.value, element("span", member.unit, { class: "unit" }));
    key.addEventListener("click", () => { member.shown = !member.shown; key.setAttribute("aria-pressed", member.shown); this.draw(); });
    return key;
  }
  range() { return zoomed || [clock[0], clock[clock.length - 1]]; }
  // The time at this place of the window: that of a point of a curve, if one is near.
  timeAt(x) {
    const p = this.canvas.places, t = p.a + ((x - this.canvas.getBoundingClientRect().left - p.left) / (p.right - p.left)) * (p.b - p.a);
    let [best, near] = [Math.max(p.a, Math.min(p.b, t)), (3 / (p.right - p.left)) * (p.b - p.a)];
    for (const { points, shown } of this.members) {
      if (!shown) continue;
      const k = before(points.times, t);
      for (const time of points.times.slice(k, k + 2)) if (time >= p.a && time <= p.b && Math.abs(time - t) < near) [best, near] = [time, Math.abs(time - t)];
    }
    return best;
  }
  hands() {
    const { canvas } = this;
    let from = null;
    const point = (t) => { pointed = t; drawPlots(); };
    canvas.addEventListener("pointerdown", (e) => {
      if (e.button !== 0 || !canvas.places) return;
      from = this.timeAt(e.clientX);
      canvas.setPointerCapture(e.pointerId);
      pick(from);
      this.read(e, from);
    });
    canvas.addEventListener("pointermove", (e) => {
      if (!canvas.places) return;
      const t = this.timeAt(e.clientX);
      // a finger reads, a mouse marks what to zoom to
      if (from !== null && e.pointerType !== "touch") this.band = [from, t];
      this.read(e, t);
    });
    canvas.addEventListener("pointerup", () => {
      const band = this.band && [...this.band].sort((x, y) => x - y), [low, high] = this.range();
      from = this.band = null;
      if (band && band[1] - band[0] > 0.02 * (high - low)) zoom(band); else drawPlots();
    });
    canvas.addEventListener("pointercancel", () => { from = this.band = null; this.leave(); });
    canvas.addEventListener("pointerleave", (e) => { if (e.pointerType !== "touch") this.leave(); });
    canvas.addEventListener("blur", () => this.leave());
    canvas.addEventListener("dblclick", () => zoom(null));
    canvas.addEventListener("keydown", (e) => {
      const [a, b] = this.range(), half = e.key === "+" ? 0.25 * (b - a) : b - a;
      if (e.key === "+" || e.key === "-") zoom([now - half, now + half]);
      if (e.key === "Escape") { zoom(null); this.leave(); }
    });
  }
  leave() {
    this.reading.hidden = true;
    pointed = null;
    drawPlots();
  }
  // Shows the values at a time beside the pointer.
  read(e, t) {
    pointed = t;
    const { top } = this.canvas.getBoundingClientRect(), x = this.canvas.places.x(t);
    const lines = this.members.filter((m) => m.shown).map((m) => ({ m, v: valueAt(m.points, t) })).filter(({ v }) => v !== null);
    // the curve next to the pointer is in bold
    const away = ({ v }) => Math.abs(this.canvas.places.y(v) - (e.clientY - top));
    const nearest = lines.reduce((best, line) => (!best || away(line) < away(best) ? line : best), null);
    showReading(this.reading, this.canvas, x, atTime(t), lines.map((line) => ({ colour: line.m.colour, name: line.m.name, value: readable(line.v, line.m.size), unit: line.m.unit, near: line === nearest })));
    // away from the pointer
    const low = e.clientY - top < 0.5 * this.canvas.clientHeight;
    Object.assign(this.reading.style, low ? { top: "auto", bottom: "38px" } : { top: "24px", bottom: "auto" });
    for (const plot of plots) if (plot !== this) plot.reading.hidden = true;
    drawPlots();
  }
  draw() {
    const [a, b] = this.range(), shown = this.members.filter((m) => m.shown);
    let [low, high] = [Infinity, -Infinity];
    for (const { points } of shown) {
      for (const t of [a, b]) { const v = valueAt(points, t); if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); } }
      points.values.forEach((v, k) => {
        if (v !== null && points.times[k] >= a && points.times[k] <= b) { low = Math.min(low, v); high = Math.max(high, v); }
      });
    }
    if (!(low <= high)) [low, high] = [0, 1];
    if (low > 0 && low < 0.5 * high) low = 0;
    if (high < 0 && high > 0.5 * low) high = 0;
    const margin = 0.06 * (high - low || Math.abs(high) || 1);
    [low, high] = [low === 0 ? 0 : low - margin, high === 0 ? 0 : high + margin];
    chart(this.canvas, [a, b], [low, high], [`time [${TIME.unit}]`, this.axis], (c, px, py, { top, bottom }) => {
      for (const { points, colour, dash } of shown) {
        c.strokeStyle = colour;
        c.lineWidth = 1.8;
        c.setLineDash(dash);
        c.beginPath();
        let down = false;
        // one point beyond each edge
        const [first, last] = [Math.max(0, before(points.times, a) - 1), Math.min(points.times.length - 1, before(points.times, b) + 1)];
        for (let k = first; k <= last; k++) {
          const v = points.values[k];
          if (v === null) { down = false; continue; }
          if (down) c.lineTo(px(points.times[k]), py(v)); else c.moveTo(px(points.times[k]), py(v));
          down = true;
        }
        c.stroke();
      }
      c.setLineDash([]);
      if (this.band) {
        c.fillStyle = style("--accent");
        c.globalAlpha = 0.18;
        c.fillRect(px(this.band[0]), top, px(this.band[1]) - px(this.band[0]), bottom - top);
        c.globalAlpha = 1;
      }
      const line = (t, colour) => {
        c.strokeStyle = style(colour);
        c.lineWidth = 1;
        c.beginPath(); c.moveTo(px(t), top); c.lineTo(px(t), bottom); c.stroke();
      };
      if (times.length && !printing) line(now, "--ink");
      if (pointed === null || printing) return;
      line(pointed, "--accent");
      for (const { points, colour } of shown) {
        const v = valueAt(points, pointed);
        if (v === null) continue;
        c.fillStyle = colour;
        c.beginPath(); c.arc(px(pointed), py(v), 3.5, 0, 2 * Math.PI); c.fill();
      }
    }, TIME.scale);
    for (const { value, points, size } of this.members) value.textContent = readable(valueAt(points, now), size);
  }
}

// Only plots in the window, and a little around it, are drawn: of others there may be a hundred.
const watching = new IntersectionObserver((entries) => entries.forEach(({ target, isIntersecting }) => {
  const plot = plots.find((one) => one.box === target);
  plot.seen = isIntersecting;
  if (plot.seen) plot.draw();
}), { rootMargin: "300px" });
// Draws the plots before the next picture of the screen.
let waiting = false;
function drawPlots() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; plots.filter((plot) => plot.seen).forEach((plot) => plot.draw()); });
}
// Shows a part of the time in all plots, or all of it.
function zoom(part) {
  const [first, last] = [clock[0], clock[clock.length - 1]];
  zoomed = part && [Math.max(first, part[0]), Math.min(last, part[1])];
  if (zoomed && zoomed[1] - zoomed[0] >= last - first) zoomed = null;
  byId("whole").hidden = !zoomed;
  drawPlots();
}
// Moves the motion to a time.
function pick(t) {
  if (times.length) { play(false); setTime(t); return; }
  now = Math.max(clock[0], Math.min(clock[clock.length - 1], t));
  drawPlots();
}

function startCurves() {
  if (!data.plots || !data.plots.length || clock.length === 0) { document.querySelector(".curves").hidden = true; return; }
  for (const plot of data.plots) plots.push(new Plot(plot));
  byId("whole").addEventListener("click", () => zoom(null));
  listeners.push(drawPlots);
  onPaper(() => plots.forEach((plot) => plot.draw()));
}
