// A study: distributions, sensitivities, points of runs that can be selected, and the runs as rows.
const names = [...data.parameters, ...data.responses];
const runs = data.rows.map(([index, status, error, ...values]) => ({ index, status, error, values }));
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
  box.append(canvas);
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

function tornado() {
  data.responses.forEach((about, response) => {
    const box = element("div"), { shares, correlations } = about;
    const all = data.parameters.map((p, k) => ({ name: p.name, main: shares ? shares[k].main.value : Math.abs(correlations[k]), total: shares ? shares[k].total.value : Math.abs(correlations[k]) }));
    all.sort((a, b) => b.total - a.total);
    const bar = (share, kind) => element("span", "", { class: kind, style: `width:${Math.round(160 * Math.max(0, Math.min(1, share || 0)))}px` });
    const rows = all.map((one) => {
      const bars = element("span");
      bars.append(bar(one.main, "bar"), bar(Math.max(0, one.total - one.main), "bar loss"));
      return [one.name, readable(one.main), readable(one.total), bars];
    });
    const heads = shares ? ["alone", "with others"] : ["|correlation|", ""];
    box.append(table([["parameter", false], [heads[0], true], [heads[1], true], ["", false]], shares ? rows : rows.map(([a, b, , d]) => [a, b, "", d])));
    block(byId("tornado"), shares ? `${about.name}: shares of the variance` : `${about.name}: correlation`, box);
  });
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
    const tell = () => {
      const set = data.parameters.map((p, k) => `--set ${p.name}=${run.values[k]}`);
      byId("command").replaceChildren(`Run ${run.index}: `, element("code", `${data.command} ${[...set, ...data.fixed].join(" ")} --report run-${run.index}.html`));
    };
    line.addEventListener("click", tell);
    line.addEventListener("keydown", (e) => { if (e.key === "Enter") tell(); });
    body.append(line);
  }
  made.append(top, body);
  const box = element("div", null, { class: "wide" });
  box.append(made);
  if (of.length > SHOWN) box.append(element("p", `${SHOWN} of ${of.length} runs are shown; sort, or choose fewer.`));
  byId("rows").replaceChildren(box);
  byId("chosen").textContent = brush ? `${of.length} of ${runs.length} runs chosen` : `${runs.length} runs`;
}

function startStudy() {
  byId("title").textContent = data.title;
  byId("subtitle").textContent = `study of ${data.model}, bryant ${data.version}`;
  const missed = data.ends.filter(([word]) => word !== "done");
  byId("state").textContent = missed.length ? `${missed.map(([word, count]) => `${count} ${word}`).join(", ")} of ${data.runs} runs` : "";
  if (missed.length) byId("state").classList.add("bad");
  const kept = (about) => (about.limit === null ? "" : `${readable(100 * about.within)} %`);
  const unit = (about) => about.unit || "";
  const rows_of = data.responses.map((one) => [one.name, unit(one), readable(one.mean), readable(one.deviation), readable(one.minimum), ...one.quantiles.map((q) => readable(q)), readable(one.maximum), one.limit === null ? "" : readable(one.limit), kept(one)]);
  const heads = ["response", "unit", "mean", "deviation", "smallest", "5 %", "median", "95 %", "largest", "limit", "runs within"];
  byId("summary").append(table(heads.map((head, k) => [head, k > 1]), rows_of));
  if (data.errors) byId("summary").append(element("p", data.errors));
  if (data.thinned) byId("summary").append(element("p", `Below, ${runs.length} of ${data.runs} runs are shown, evenly taken; the numbers above are of all.`));
  if (data.reasons.length) byId("summary").append(lines(data.reasons.map(([why, count]) => `${count}: ${why}`)));
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
  canvas.addEventListener("pointermove", (e) => { if (from) { canvas.band = [from, at(e)]; scatter(); } });
  canvas.addEventListener("pointerup", (e) => {
    if (!from) return;
    const to = at(e), order = (a, b) => [Math.min(a, b), Math.max(a, b)];
    const large = canvas.band && Math.abs(to[0] - from[0]) > 0.01 * (canvas.places.b - canvas.places.a);
    if (large) brush = { across: Number(byId("across").value), up: Number(byId("up").value), x: order(from[0], to[0]), y: order(from[1], to[1]) };
    from = canvas.band = null;
    changed();
  });
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
