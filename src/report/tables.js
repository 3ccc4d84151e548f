// What the run says in words and numbers.
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
  const share = (one) => 100 * (one.value / one.limit - 1);
  const verdict = (one) => one.limit === null ? "no limit" : element("span", one.met ? `met by ${Math.round(-share(one))} %` : `missed by ${Math.round(share(one))} %`, { class: one.met ? "met" : "missed" });
  const rows = judged.map((one) => [one.criterion, readable(one.value), one.limit === null ? "–" : readable(one.limit), one.unit, verdict(one), one.filter || "none", one.detail]);
  const made = [table([["criterion", false], ["value", true], ["limit", true], ["unit", false], ["verdict", false], ["filter", false], ["", false]], rows)];
  if (missing.length) made.push(element("p", `Not judged, for there is no channel of: ${missing.map((one) => `${one.criterion} (${one.missing})`).join(", ")}.`));
  made.push(element("p", `Limits: ${source}.`));
  return made;
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

function startTables() {
  byId("title").textContent = data.title || data.model;
  byId("subtitle").textContent = `model ${data.model}, bryant ${data.version}`;
  const state = byId("state"), bad = data.failure || (data.doubts || []).length > 0 || data.beyond;
  state.textContent = data.failure ? `The run failed: ${data.failure}` : bad ? "This run is not to be trusted; see Results." : "";
  state.classList.add(bad ? "bad" : "good");
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
  if (data.effects && data.effects.length) block(again, "In the equations", lines(data.effects));
}

startTables();
startMotion();
startCurves();
// for whoever opens the page by a program: all of it was made
document.documentElement.dataset.made = "yes";
