// The messages and numbers of the run.
function peaks() {
  return columns.slice(1).map((column) => {
    let [low, high] = [0, 0];
    column.values.forEach((v, k) => {
      if (v === null) return;
      if (!(column.values[low] <= v)) low = k;
      if (!(column.values[high] >= v)) high = k;
    });
    const at = (k) => `${Number((1000 * clock[k]).toPrecision(5))}`;
    const most = Math.max(Math.abs(column.values[high]), Math.abs(column.values[low]));
    return [column.name, column.unit, readable(column.values[high], most), at(high), readable(column.values[low], most), at(low)];
  });
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

// A limit as the regulation prints it.
function limit(one) {
  return one.limit === null ? "–" : String(one.limit);
}

function met(one) {
  const share = 100 * (one.value / one.limit - 1);
  return one.limit === null ? "no limit" : element("span", one.met ? `met by ${Math.round(-share)} %` : `missed by ${Math.round(share)} %`, { class: one.met ? "met" : "missed" });
}

// The result in short: what the last screen of the command says.
function result(parent) {
  const { peaks, more, energy, trust } = data.result;
  const left = element("div"), right = element("div");
  if (peaks.length) {
    left.append(table([["peak of", false], ["value", true], ["unit", false], ["at [ms]", true]], peaks.map((p) => [p.output, readable(p.value), p.unit, (1000 * p.time_s).toFixed(1)])));
    if (more) left.append(element("p", `${more} more below.`, { class: "hint" }));
  }
  if (data.criteria) {
    const judged = data.criteria.criteria.filter((one) => one.value !== null);
    right.append(element("p", `${data.criteria.standard}, ${data.criteria.dummy}`));
    right.append(table([["criterion", false], ["value", true], ["limit", true], ["unit", false], ["verdict", false]], judged.map((one) => [one.criterion, readable(one.value), limit(one), one.unit, met(one)])));
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
    this.canvas = element("canvas", null, { "aria-label": "energy over time, stacked" });
    const keys = element("div", null, { class: "keys" });
    this.layers.forEach((layer, k) => {
      const mark = element("i");
      mark.style.borderTopColor = COLOURS[k % COLOURS.length];
      mark.style.borderTopWidth = "8px";
      const key = element("span", null, { class: "key" });
      key.append(mark, element("span", layer.name));
      keys.append(key);
    });
    const box = element("div", null, { class: "plot" }), head = element("header");
    head.append(element("span", "[J] over time [ms]: kinetic energy, and what each effect has taken; the top is what was given"));
    box.append(head, this.canvas, keys);
    parent.append(box);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }
  draw() {
    const made = blank(this.canvas);
    if (!made) return;
    const { c, width, height } = made;
    const [left, right, top, bottom] = [58, width - 16, 8, height - 22];
    const [a, b] = [this.times[0], this.times[this.times.length - 1]];
    const [px, py] = [(t) => left + ((t - a) / (b - a || 1)) * (right - left), (v) => bottom - (v / (1.05 * this.most)) * (bottom - top)];
    const below = this.times.map(() => 0);
    this.layers.forEach((layer, k) => {
      const above = below.map((v, i) => v + layer.values[i]);
      c.fillStyle = COLOURS[k % COLOURS.length];
      c.globalAlpha = 0.75;
      c.beginPath();
      this.times.forEach((t, i) => c.lineTo(px(t), py(below[i])));
      for (let i = this.times.length - 1; i >= 0; i--) c.lineTo(px(this.times[i]), py(above[i]));
      c.closePath();
      c.fill();
      above.forEach((v, i) => { below[i] = v; });
    });
    c.globalAlpha = 1;
    c.font = "11px system-ui, sans-serif";
    c.strokeStyle = style("--line");
    c.fillStyle = style("--soft");
    c.textAlign = "right";
    const up = ticks(0, 1.05 * this.most, 6), along = ticks(1000 * a, 1000 * b, Math.max(3, Math.floor(width / 80)));
    for (const v of up.found) {
      c.beginPath(); c.moveTo(left, py(v)); c.lineTo(right, py(v)); c.stroke();
      c.fillText(v.toFixed(Math.min(8, up.digits)), left - 5, py(v) + 4);
    }
    c.textAlign = "center";
    for (const t of along.found) c.fillText(t.toFixed(along.digits), px(t / 1000), height - 7);
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
  if (data.criteria) block(verdict, `Injury criteria: ${data.criteria.standard}, ${data.criteria.dummy}`, ...criteria());
  if (data.responses && data.responses.length) {
    block(verdict, "Responses", table([["response", false], ["value", true], ["unit", false]], data.responses.map((r) => [r.name, readable(r.value), r.unit || ""])));
  }
  if (columns.length > 1) {
    block(verdict, "Largest and smallest values of the rows", table([["output", false], ["unit", false], ["largest", true], ["at [ms]", true], ["smallest", true], ["at [ms]", true]], peaks()));
  }
  if (data.doubts && data.doubts.length) block(verdict, "Why it cannot be trusted", lines(data.doubts));
  if (data.notes && data.notes.length) block(verdict, "To be known", lines(data.notes));
  if (data.energy && data.works && data.works.times.length > 1) {
    const box = element("div");
    block(verdict, "Energy over time", box);
    new EnergyPlot(box);
  }
  verdict.append(two);
  if (data.energy) block(two, "Balance of energy", energy());
  block(two, "Accuracy", lines(data.accuracy && data.accuracy.length ? data.accuracy : ["not checked"]), element("p", data.report || ""));
  const again = byId("again"), parameters = Object.entries(data.parameters || {});
  const command = element("p");
  command.append("Command: ", element("code", data.command));
  const digest = element("p");
  digest.append("Digest of the model: ", element("code", data.digest));
  again.append(command, digest);
  if (parameters.length) block(again, "Parameters", table([["parameter", false], ["value", true], ["unit", false]], parameters.map(([name, p]) => [name, readable(p.value), p.unit])));
  const [ins, outs] = [[], []];
  let list = ins;
  for (const line of data.effects || []) {
    if (line.startsWith(" ")) list.push(line.trim());
    else if (!line.startsWith("In")) list = outs;
  }
  if (ins.length) block(again, "In the equations", lines(ins));
  if (outs.length) block(again, "Not in the equations", lines(outs));
}

startTables();
startMotion();
startCurves();
// for programs that open the page: all of it was made
document.documentElement.dataset.made = "yes";
