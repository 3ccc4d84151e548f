// The messages and numbers of the run.
function extremes() {
  const rows = columns.map((column) => {
    // of a run that did not reach its end there are only rows
    const found = [Math.max, Math.min].map((best) => {
      const value = best(...column.values.filter((v) => v !== null));
      return [value, clock[column.values.indexOf(value)]];
    });
    const [largest, smallest] = column.between ? [column.largest, column.smallest] : found;
    const most = Math.max(...[largest, smallest].map((one) => (one ? Math.abs(one[0]) : 0)));
    const cells = (one) => (one && Number.isFinite(one[0]) ? [readable(one[0], most), timeText(one[1])] : ["–", "–"]);
    return [column.name, column.unit, ...cells(largest), ...cells(smallest)];
  });
  return table([["output", false], ["unit", false], ["largest", true], [`at [${TIME.unit}]`, true], ["smallest", true], [`at [${TIME.unit}]`, true]], rows);
}

function criteria() {
  const { criteria: all, source } = data.criteria;
  const judged = all.filter((one) => one.value !== null), missing = all.filter((one) => one.missing);
  const rows = judged.map((one) => [one.criterion, readable(one.value), limit(one), one.unit, met(one), one.filter || "none", Object.values(one.channels).join(", "), one.detail]);
  const made = [table([["criterion", false], ["value", true], ["limit", true], ["unit", false], ["verdict", false], ["filter", false], ["read from", false], ["", false]], rows)];
  if (missing.length) made.push(element("p", `Not judged, because there is no channel of: ${missing.map((one) => `${one.criterion} (${one.missing})`).join(", ")}.`));
  made.push(element("p", `Limits: ${source}.`));
  return made;
}

// A limit that falls with the duration of a load is computed for its duration, all others are those of the regulation.
function limit(one) {
  if (one.limit === null) return "–";
  return one.duration === null ? limitText(one.limit) : readable(one.limit);
}

function met(one) {
  const share = 100 * Math.abs(one.value / one.limit - 1), text = share < 0.95 ? share.toFixed(1) : share.toFixed(0);
  return one.limit === null ? "no limit" : element("span", `${one.met ? "met" : "missed"} by ${text} %`, { class: one.met ? "met" : "missed" });
}

// The result in short: what the last screen of the command says.
function result(parent) {
  const { peaks, more, energy, trust } = data.result;
  const left = element("div"), right = element("div");
  if (peaks.length) {
    left.append(table([["peak of", false], ["value", true], ["unit", false], [`at [${TIME.unit}]`, true]], peaks.map((p) => [p.output, readable(p.value), p.unit, timeText(p.time_s)])));
    if (more) left.append(element("p", `${more} more below.`, { class: "hint" }));
  }
  if (data.criteria) {
    const judged = data.criteria.criteria.filter((one) => one.value !== null);
    right.append(element("p", `${data.criteria.standard}, ${data.criteria.dummy}`, { class: "hint" }));
    right.append(table([["criterion", false], ["value", true], ["limit", true], ["unit", false], ["verdict", false]], judged.map((one) => [one.criterion, readable(one.value), limit(one), one.unit, met(one)])));
    const missing = data.criteria.criteria.filter((one) => one.missing);
    if (missing.length) right.append(element("p", `Not judged: ${missing.map((one) => one.criterion).join(", ")}; see below.`, { class: "hint" }));
  }
  if (data.responses && data.responses.length) {
    right.append(table([["response", false], ["value", true], ["unit", false]], data.responses.map((r) => [r.name, readable(r.value), r.unit || ""])));
  }
  for (const [what, line] of [["Energy", energy], ["Trust", trust]]) {
    if (!line) continue;
    const said = element("p");
    said.append(element("b", `${what}: `), line);
    left.append(said);
  }
  parent.append(left, right);
}

function energy() {
  const { energy } = data;
  const work = Object.entries(energy.work || {}).filter(([, joules]) => joules !== 0);
  const most = Math.max(...work.map(([, joules]) => Math.abs(joules)), Math.abs(energy.kinetic_at_end), 1e-300);
  const bar = (joules) => element("span", "", { class: joules < 0 ? "bar loss" : "bar", style: `width:${Math.round((90 * Math.abs(joules)) / most)}px` });
  work.sort((a, b) => Math.abs(b[1]) - Math.abs(a[1]));
  const rows = [
    ["kinetic energy at the start", readable(energy.kinetic_at_start), bar(energy.kinetic_at_start)],
    ...work.map(([name, joules]) => [name, readable(joules), bar(joules)]),
    ["not accounted for", readable(energy.not_accounted_for), bar(energy.not_accounted_for)],
    ["kinetic energy at the end", readable(energy.kinetic_at_end), bar(energy.kinetic_at_end)],
  ];
  return table([["work of", false], ["J", true], ["", false]], rows);
}

// Energy over time: kinetic energy, and above it the energy that effects have taken, the largest first.
class EnergyPlot {
  constructor(parent) {
    const { times, effects } = data.works, start = data.energy.kinetic_at_start;
    this.times = times;
    const given = times.map((_, k) => start + effects.reduce((sum, e) => sum + Math.max(0, e.values[k]), 0));
    const kinetic = times.map((_, k) => start + effects.reduce((sum, e) => sum + e.values[k], 0));
    const most = Math.max(...given, 1e-300);
    const taken = effects.map((e) => ({ name: e.name, values: e.values.map((w) => Math.max(0, -w)) }));
    const large = taken.filter((e) => Math.max(...e.values) > 0.02 * most).sort((a, b) => Math.max(...b.values) - Math.max(...a.values)).slice(0, 6);
    const rest = taken.filter((e) => !large.includes(e));
    this.layers = [{ name: "kinetic energy", values: kinetic }, ...large];
    if (rest.length) this.layers.push({ name: `${rest.length} smaller`, values: times.map((_, k) => rest.reduce((sum, e) => sum + e.values[k], 0)) });
    this.most = most;
    this.canvas = element("canvas", null, { role: "img", "aria-label": "energy over time, stacked" });
    const keys = element("div", null, { class: "keys" });
    this.layers.forEach((layer, k) => {
      const mark = element("i");
      mark.style.borderTopColor = COLOURS[k % COLOURS.length];
      mark.style.borderTopWidth = "8px";
      const key = element("span", null, { class: "key" });
      key.append(mark, element("span", layer.name));
      keys.append(key);
    });
    const box = element("figure", null, { class: "plot" });
    const stage = element("div", null, { class: "stage" }), reading = element("div", null, { class: "reading" });
    reading.hidden = true;
    stage.append(this.canvas, reading);
    box.append(element("figcaption", "Kinetic energy, and what each effect has taken; the top is what was given"), stage, keys);
    this.canvas.addEventListener("pointermove", (e) => {
      const { a, b, left, right, x } = this.canvas.places, at = e.clientX - this.canvas.getBoundingClientRect().left;
      const t = Math.max(a, Math.min(b, a + ((at - left) / (right - left)) * (b - a)));
      const rows = this.layers.map((layer, k) => ({ colour: COLOURS[k % COLOURS.length], name: layer.name, value: readable(valueAt({ times, values: layer.values }, t), most), unit: "J" }));
      showReading(reading, this.canvas, x(t), atTime(t), rows);
    });
    for (const gone of ["pointerleave", "pointercancel"]) this.canvas.addEventListener(gone, () => { reading.hidden = true; });
    parent.append(box);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    onPaper(() => this.draw());
  }
  draw() {
    const { times } = this;
    chart(this.canvas, [times[0], times[times.length - 1]], [0, 1.05 * this.most], [`time [${TIME.unit}]`, "energy [J]"], (c, px, py) => {
      const below = times.map(() => 0);
      this.layers.forEach((layer, k) => {
        const above = below.map((v, i) => v + layer.values[i]);
        c.fillStyle = COLOURS[k % COLOURS.length];
        c.globalAlpha = 0.75;
        c.beginPath();
        times.forEach((t, i) => c.lineTo(px(t), py(below[i])));
        for (let i = times.length - 1; i >= 0; i--) c.lineTo(px(times[i]), py(above[i]));
        c.closePath();
        c.fill();
        above.forEach((v, i) => { below[i] = v; });
      });
      c.globalAlpha = 1;
    }, TIME.scale);
  }
}

function startTables() {
  byId("title").textContent = data.title || data.model;
  byId("subtitle").textContent = `model ${data.model}, bryant ${data.version}`;
  const state = byId("state"), bad = data.failure || (data.doubts || []).length > 0 || data.beyond;
  state.textContent = data.failure ? `The run failed: ${data.failure}` : bad ? "This run is not to be trusted; see below." : "";
  state.classList.add(bad ? "bad" : "good");
  result(byId("result"));
  const verdict = byId("verdict"), two = element("div", null, { class: "columns" });
  if (data.doubts && data.doubts.length) block(verdict, "Why it cannot be trusted", lines(data.doubts));
  if (data.notes && data.notes.length) block(verdict, "To be known", lines(data.notes));
  if (data.criteria) folded(verdict, `How the criteria were read: ${data.criteria.standard}, ${data.criteria.dummy}`, ...criteria());
  verdict.append(two);
  if (columns.length) block(two, columns.every((c) => c.between) ? "Largest and smallest values" : "Largest and smallest values of the rows", extremes());
  const right = element("div");
  two.append(right);
  if (data.energy && data.works && data.works.times.length > 1) {
    const box = element("div");
    block(right, "Energy over time", box);
    new EnergyPlot(box);
  }
  block(right, "Accuracy", lines(data.accuracy && data.accuracy.length ? data.accuracy : ["not checked"]), element("p", data.report || ""));
  if (data.energy) folded(right, "Balance of energy", energy());
  const again = byId("again"), parameters = Object.entries(data.parameters || {});
  const command = element("p");
  command.append("Command: ", element("code", data.command));
  const digest = element("p");
  digest.append("Digest of the model: ", element("code", data.digest));
  again.append(command, digest);
  if (parameters.length) folded(again, `Parameters (${parameters.length})`, table([["parameter", false], ["value", true], ["unit", false]], parameters.map(([name, p]) => [name, readable(p.value), p.unit])));
  const [ins, outs] = [[], []];
  let list = ins;
  for (const line of data.effects || []) {
    if (line.startsWith(" ")) list.push(line.trim());
    else if (!line.startsWith("In")) list = outs;
  }
  if (ins.length) folded(again, `In the equations (${ins.length})`, lines(ins));
  if (outs.length) folded(again, `Not in the equations (${outs.length})`, lines(outs));
}

startTables();
startCurves();
startMotion();
startParts();
// for programs that open the page: all of it was made
document.documentElement.dataset.made = "yes";
