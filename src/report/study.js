// A study: distributions, sensitivities, points of runs that can be selected, and the runs as rows.
const names = [...data.parameters, ...data.responses];
// Numbers are shown in the units that are told of them; commands take them as they are, in SI.
const runs = data.rows.map(([index, status, error, ...given]) => ({ index, status, error, given, values: given.map((v, k) => (v === null ? v : v / names[k].factor)) }));
const SHOWN = 200;
let brush = null;
let sorted = { column: -1, down: false };

const valueOf = (run, column) => (column < 0 ? run.index : run.values[column]);
function chosen() {
  if (!brush) return runs;
  const { across, up, x, y } = brush;
  const within = (v, [a, b]) => v !== null && v >= a && v <= b;
  return runs.filter((run) => within(run.values[across], x) && within(run.values[up], y));
}
const label = ({ name, unit }) => (unit ? `${name} [${unit}]` : name);
function extent(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const v of values) if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); }
  if (!(low <= high)) return [0, 1];
  const margin = 0.03 * (high - low || Math.abs(high) || 1);
  return [low - margin, high + margin];
}

function mark(c, from, to) {
  c.strokeStyle = style("--bad");
  c.lineWidth = 1.5;
  c.setLineDash([6, 4]);
  c.beginPath(); c.moveTo(...from); c.lineTo(...to); c.stroke();
  c.setLineDash([]);
}

function histogram(response) {
  const column = data.parameters.length + response, about = data.responses[response];
  const box = element("div", null, { class: "plot" }), canvas = element("canvas", null, { "aria-label": `distribution of ${about.name}` });
  const stage = element("div", null, { class: "stage" }), reading = element("div", null, { class: "reading", hidden: "" });
  stage.append(canvas, reading);
  box.append(stage);
  byId("curves").append(box);
  const values = runs.map((run) => run.values[column]).filter((v) => v !== null);
  const limits = about.limit === null ? [] : [about.limit];
  const [low, high] = extent([...values, ...limits]), bins = Math.max(8, Math.min(40, Math.round(Math.sqrt(values.length))));
  const counts = (of) => {
    const found = new Array(bins).fill(0);
    for (const run of of) {
      const v = run.values[column];
      if (v !== null) found[Math.min(bins - 1, Math.max(0, Math.floor(((v - low) / (high - low)) * bins)))] += 1;
    }
    return found;
  };
  const whole = counts(runs), most = 1.08 * Math.max(1, ...whole);
  // the bar under the pointer: from where to where, and how many runs
  canvas.addEventListener("pointermove", (e) => {
    const x = e.clientX - canvas.getBoundingClientRect().left, { left, right } = canvas.places, bar = Math.floor(((x - left) / (right - left)) * bins);
    reading.hidden = !(bar >= 0 && bar < bins);
    if (reading.hidden) return;
    const [from, to] = [bar, bar + 1].map((k) => readable(low + (k / bins) * (high - low))), of = counts(chosen())[bar];
    const lines = [{ name: "runs", value: String(whole[bar]) }, ...(brush ? [{ name: "of them chosen", value: String(of) }] : [])];
    showReading(reading, canvas, x, `${from} to ${to}${about.unit ? ` ${about.unit}` : ""}`, lines);
  });
  canvas.addEventListener("pointerleave", () => { reading.hidden = true; });
  return () => chart(canvas, [low, high], [0, most], [label(about), "runs"], (c, px, py, { top, bottom }) => {
    const bars = (of, colour, alpha) => of.forEach((count, k) => {
      const [x, y] = [px(low + (k / bins) * (high - low)), py(count)];
      c.globalAlpha = alpha;
      c.fillStyle = colour;
      c.fillRect(x + 0.5, y, px(low + ((k + 1) / bins) * (high - low)) - x - 1, py(0) - y);
      c.globalAlpha = 1;
    });
    bars(whole, style("--soft"), brush ? 0.35 : 0);
    bars(counts(chosen()), style("--accent"), 0.85);
    if (about.limit !== null) mark(c, [px(about.limit), top], [px(about.limit), bottom]);
  });
}

function scatter() {
  const canvas = byId("scatter"), [across, up] = [Number(byId("across").value), Number(byId("up").value)];
  const columns = [across, up].map((column) => runs.map((run) => run.values[column]));
  const [x, y] = columns.map(extent), picked = new Set(chosen());
  chart(canvas, x, y, [label(names[across]), label(names[up])], (c, px, py, { left, right, top, bottom }) => {
    const size = runs.length > 1500 ? 2 : 3.2;
    for (const [inside, colour, alpha] of [[false, "--soft", 0.3], [true, "--accent", 0.7]]) {
      c.fillStyle = style(colour);
      c.globalAlpha = alpha;
      for (const run of runs) {
        if (picked.has(run) !== inside || run.values[across] === null || run.values[up] === null) continue;
        c.beginPath();
        c.arc(px(run.values[across]), py(run.values[up]), size, 0, 2 * Math.PI);
        c.fill();
      }
    }
    c.globalAlpha = 1;
    const [of_x, of_y] = [names[across].limit, names[up].limit];
    if (of_x !== undefined && of_x !== null) mark(c, [px(of_x), top], [px(of_x), bottom]);
    if (of_y !== undefined && of_y !== null) mark(c, [left, py(of_y)], [right, py(of_y)]);
    const band = canvas.band || (brush && brush.across === across && brush.up === up ? [[brush.x[0], brush.y[0]], [brush.x[1], brush.y[1]]] : null);
    if (!band) return;
    const [[ax, ay], [bx, by]] = band;
    c.strokeStyle = style("--ink");
    c.strokeRect(px(Math.min(ax, bx)), py(Math.max(ay, by)), Math.abs(px(bx) - px(ax)), Math.abs(py(by) - py(ay)));
  });
}

// The mean of a response where a parameter is low and where it is high: in the lowest and the highest fifth of the runs that have it.
function lowAndHigh(parameter, column) {
  const of = runs.filter((run) => run.values[parameter] !== null && run.values[column] !== null).sort((p, q) => p.values[parameter] - q.values[parameter]);
  const count = Math.floor(of.length / 5);
  const mean = (part) => part.reduce((sum, run) => sum + run.values[column], 0) / part.length;
  return count < 2 ? null : [mean(of.slice(0, count)), mean(of.slice(-count))];
}

function tornado() {
  data.responses.forEach((about, response) => {
    const { shares, correlations } = about, column = data.parameters.length + response;
    const all = data.parameters.map((p, k) => ({ name: p.name, main: shares ? shares[k].main.value : Math.abs(correlations[k]), total: shares ? shares[k].total.value : Math.abs(correlations[k]), ends: lowAndHigh(k, column) }));
    all.sort((a, b) => b.total - a.total);
    const bar = (share, kind) => element("span", "", { class: kind, style: `width:${100 * Math.max(0, Math.min(1, share || 0))}%` });
    const furthest = Math.max(1e-300, ...all.flatMap(({ ends }) => (ends || []).map((v) => Math.abs(v - about.mean))));
    // low to the left or right of the mean, high to the other side
    const swing = (ends) => {
      const box = element("span", null, { class: "swing", "aria-hidden": "true" });
      ends.forEach((v, k) => {
        const length = (v - about.mean) / furthest / 2;
        box.append(element("i", null, { class: k ? "high" : "low", style: `left:${50 + 100 * Math.min(0, length)}%;width:${100 * Math.abs(length)}%` }));
      });
      return box;
    };
    const rows = all.map(({ name, main, total, ends }) => {
      const bars = element("span", null, { class: "bars" });
      bars.append(bar(main, "bar"), bar(Math.max(0, total - main), "bar loss"));
      const share = (x) => (Number.isFinite(x) ? x.toFixed(3).replace("-", "−") : "–");
      return [name, share(main), ...(shares ? [share(total)] : []), bars, ...(ends ? [readable(ends[0]), readable(ends[1]), swing(ends)] : ["", "", ""])];
    });
    const heads = ["parameter", ...(shares ? ["alone", "with others"] : ["|correlation|"]), "", "low", "high", ""];
    const number = ["alone", "with others", "|correlation|", "low", "high"];
    block(byId("tornado"), label(about), table(heads.map((head) => [head, number.includes(head)]), rows));
  });
}

// The command that makes the motion of a run.
function tell(run) {
  const set = data.parameters.map((p, k) => `--set ${p.name}=${run.given[k]}`);
  byId("command").replaceChildren(`Run ${run.index}: `, element("code", `${data.command} ${[...set, ...data.fixed].join(" ")} --report run-${run.index}.html`));
}

function rows() {
  const of = chosen().slice();
  const { column, down } = sorted;
  of.sort((p, q) => {
    const [a, b] = [valueOf(p, column), valueOf(q, column)];
    if (a === null || b === null) return (a === null) - (b === null);
    return down ? b - a : a - b;
  });
  const made = element("table"), head = element("tr"), body = element("tbody"), top = element("thead");
  const heads = [{ name: "run", column: -1 }, ...names.map((one, k) => ({ name: label(one), column: k }))];
  for (const one of heads) {
    const cell = element("th", null, { class: "number" }), button = element("button", one.name + (one.column === column ? (down ? " ▼" : " ▲") : ""));
    button.addEventListener("click", () => { sorted = { column: one.column, down: one.column === column && !down }; rows(); });
    cell.append(button);
    head.append(cell);
  }
  head.append(element("th", "end"));
  top.append(head);
  for (const run of of.slice(0, SHOWN)) {
    const line = element("tr", null, { tabindex: "0" });
    line.append(element("td", String(run.index), { class: "number" }));
    run.values.forEach((v, k) => {
      const limit = names[k].limit, missed = limit !== undefined && limit !== null && v !== null && v > limit;
      line.append(element("td", readable(v), { class: missed ? "number missed" : "number" }));
    });
    line.append(element("td", run.status));
    line.addEventListener("click", () => tell(run));
    line.addEventListener("keydown", (e) => { if (e.key === "Enter") tell(run); });
    body.append(line);
  }
  made.append(top, body);
  const box = element("div", null, { class: "wide" });
  box.append(made);
  if (of.length > SHOWN) box.append(element("p", `${SHOWN} of ${of.length} runs are shown; sort, or choose fewer.`));
  byId("rows").replaceChildren(box);
  byId("rows-title").textContent = `${of.length === runs.length ? "All" : "The chosen"} ${of.length} runs`;
  byId("chosen").textContent = brush ? `${of.length} of ${runs.length} runs chosen` : `${runs.length} runs`;
}

// The run whose point is near the pointer, or none.
function nearest(canvas, e) {
  const { left, top } = canvas.getBoundingClientRect(), [across, up] = [Number(byId("across").value), Number(byId("up").value)];
  let [best, near] = [null, 10];
  for (const run of runs) {
    const [x, y] = [run.values[across], run.values[up]];
    if (x === null || y === null) continue;
    const away = Math.hypot(canvas.places.x(x) - (e.clientX - left), canvas.places.y(y) - (e.clientY - top));
    if (away < near) [best, near] = [run, away];
  }
  return best;
}
// Shows the numbers of a run beside its point.
function read(canvas, run) {
  const box = byId("reading");
  box.hidden = !run;
  if (!run) return;
  const x = canvas.places.x(run.values[Number(byId("across").value)]);
  showReading(box, canvas, x, `run ${run.index}`, names.map((one, k) => ({ name: one.name, value: readable(run.values[k]), unit: one.unit })));
}

function startStudy() {
  byId("title").textContent = data.title;
  byId("subtitle").textContent = `study of ${data.model}, bryant ${data.version}`;
  const missed = data.ends.filter(([word]) => word !== "done");
  byId("state").textContent = missed.length ? `${missed.map(([word, count]) => `${count} ${word}`).join(", ")} of ${data.runs} runs` : "";
  if (missed.length) byId("state").classList.add("bad");
  const limited = data.responses.filter((one) => one.limit !== null);
  if (limited.length) {
    const all = data.kept === data.runs, what = limited.length === 1 ? `the limit of ${limited[0].name}` : limited.length === 2 ? "both limits" : `all ${limited.length} limits`;
    byId("kept").append(element("span", `${data.kept} of ${data.runs} runs (${readable((100 * data.kept) / data.runs)} %) keep ${what}.`, { class: all ? "met" : "missed" }));
  }
  // a column that would be empty is not there
  const heads = ["response", "unit", "mean", "deviation", "smallest", "5 %", "median", "95 %", "largest", ...(limited.length ? ["limit", "runs within"] : [])];
  const ofLimit = (one) => (one.limit === null ? ["–", "–"] : [limitText(one.limit), `${readable(100 * one.within)} %`]);
  const spread = data.responses.map((one) => [one.name, one.unit, readable(one.mean), readable(one.deviation), readable(one.minimum), ...one.quantiles.map((q) => readable(q)), readable(one.maximum), ...(limited.length ? ofLimit(one) : [])]);
  byId("summary").append(table(heads.map((head, k) => [head, k > 1]), spread));
  if (data.thinned) byId("summary").append(element("p", `Below, ${runs.length} of ${data.runs} runs are shown, evenly taken; the numbers above are of all.`));
  const varied = element("div"), trust = element("div");
  const units = data.parameters.some((p) => p.unit);
  varied.append(element("p", `${data.runs} runs of ${data.model} on ${data.design}:`), table([["parameter", false], ["values", false], ...(units ? [["unit", false]] : [])], data.parameters.map((p) => [p.name, p.values, ...(units ? [p.unit] : [])])));
  trust.append(element("p", data.ends.map(([word, count]) => `${count} ${word}`).join(", ")));
  if (data.errors) {
    const said = element("p");
    said.append(element("b", "Trust: "), data.errors);
    trust.append(said);
  }
  if (data.reasons.length) trust.append(lines(data.reasons.map(([why, count]) => `${count}: ${why}`)));
  byId("run").append(varied, trust);
  names.forEach((one, k) => ["across", "up"].forEach((id) => byId(id).append(element("option", label(one), { value: k }))));
  byId("across").value = 0;
  byId("up").value = data.parameters.length;
  const painted = data.responses.map((_, k) => histogram(k));
  const all = () => { scatter(); painted.forEach((paint) => paint()); };
  const changed = () => { all(); rows(); };
  ["across", "up"].forEach((id) => byId(id).addEventListener("change", () => { brush = null; changed(); }));
  byId("all").addEventListener("click", () => { brush = null; changed(); });
  const canvas = byId("scatter");
  const at = (e) => {
    const { left, top } = canvas.getBoundingClientRect(), p = canvas.places;
    return [p.a + ((e.clientX - left - p.left) / (p.right - p.left)) * (p.b - p.a), p.low + ((p.bottom - (e.clientY - top)) / (p.bottom - p.top)) * (p.high - p.low)];
  };
  let from = null;
  canvas.addEventListener("pointerdown", (e) => { from = at(e); canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener("pointermove", (e) => {
    if (from && Math.hypot(e.movementX, e.movementY) > 0) { canvas.band = [from, at(e)]; scatter(); }
    read(canvas, nearest(canvas, e));
  });
  canvas.addEventListener("pointerup", (e) => {
    if (!from) return;
    const to = at(e), order = (a, b) => [Math.min(a, b), Math.max(a, b)];
    const large = canvas.band && Math.abs(to[0] - from[0]) > 0.01 * (canvas.places.b - canvas.places.a);
    if (large) brush = { across: Number(byId("across").value), up: Number(byId("up").value), x: order(from[0], to[0]), y: order(from[1], to[1]) };
    const run = large ? null : nearest(canvas, e);
    from = canvas.band = null;
    if (run) { tell(run); read(canvas, run); }
    changed();
  });
  canvas.addEventListener("pointercancel", () => { from = canvas.band = null; read(canvas, null); changed(); });
  canvas.addEventListener("pointerleave", () => read(canvas, null));
  canvas.addEventListener("dblclick", () => { brush = null; changed(); });
  tornado();
  new ResizeObserver(all).observe(byId("curves"));
  onPaper(all);
  changed();
  const command = element("p"), digest = element("p");
  command.append("Command: ", element("code", data.made));
  digest.append("Digest of the model: ", element("code", data.digest), ", identity of the results: ", element("code", data.identity));
  byId("again").append(command, digest);
}

startStudy();
document.documentElement.dataset.made = "yes";
