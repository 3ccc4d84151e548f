// The parts of the scene: a tree to show and hide them, and what there is to know of the one that was clicked.
const hidden = new Set();
let chosenPart = null;

// A part is a body, by its index, or a law, by its kind and name.
const lawOf = (line) => `${line.kind} ${line.name}`;
const laws = (data.forces || []).map(lawOf);
const isShown = (part) => !hidden.has(part);
const lightOr = (part, colour) => (part === chosenPart ? rgb("#f0c800") : colour);
const nameOf = (part) => (part === -1 ? "fixed to the ground" : typeof part === "number" ? scene.bodies[part].name : part);

// The unit of forces is that of outputs, if they are in kilonewtons.
const inKilonewtons = columns.some((column) => column.unit === "kN");
const newtons = (force) => (inKilonewtons ? `${Number((force / 1000).toPrecision(3))} kN` : `${Number(force.toPrecision(3))} N`);

// A tree of { part, name, below }: systems with their bodies, vehicles, the ground, and belts and springs.
function tree() {
  const nodes = scene.bodies.map((body, part) => ({ part, name: body.name.split("/").pop(), below: [] }));
  const tops = [], systems = new Map();
  scene.bodies.forEach((body, part) => {
    if (body.parent !== null && body.parent !== undefined) nodes[body.parent].below.push(nodes[part]);
    else if (body.system < 0) tops.push(nodes[part]);
    else {
      if (!systems.has(body.system)) systems.set(body.system, { part: null, name: body.name.split("/")[0], below: [] });
      systems.get(body.system).below.push(nodes[part]);
    }
  });
  const fixed = [...scene.ellipsoids, ...scene.planes, ...meshes].some((shape) => shape.body < 0) ? [{ part: -1, name: nameOf(-1), below: [] }] : [];
  const lines = [...new Map(scene.lines.map((line) => [lawOf(line), { part: lawOf(line), name: lawOf(line), below: [] }])).values()];
  const group = lines.length ? [{ part: null, name: "belts and springs", below: lines }] : [];
  return [...systems.values(), ...tops, ...fixed, ...group];
}
const partsOf = (node) => [...(node.part === null ? [] : [node.part]), ...node.below.flatMap(partsOf)];

// A node as an element of a list; `boxes` gets what brings its check box up to date.
function branch(node, depth, boxes) {
  const item = element("li"), row = element("div", null, { class: "row", style: `padding-left:${Math.min(depth, 8) * 0.8}rem` });
  const box = element("input", null, { type: "checkbox", "aria-label": `show ${node.name}` }), all = partsOf(node);
  boxes.push(() => {
    const shown = all.filter(isShown).length;
    box.checked = shown > 0;
    box.indeterminate = shown > 0 && shown < all.length;
  });
  box.addEventListener("change", () => {
    all.forEach((part) => (box.checked ? hidden.delete(part) : hidden.add(part)));
    boxes.forEach((update) => update());
    redraw();
  });
  const check = element("label", null, { class: "check" });
  check.append(box);
  const name = node.part === null ? element("b", node.name) : element("button", node.name, { class: "part", "data-part": node.part });
  if (node.part !== null) name.addEventListener("click", () => choose(node.part));
  row.append(check, name);
  item.append(row);
  if (node.below.length) {
    const list = element("ul");
    node.below.forEach((one) => list.append(branch(one, depth + 1, boxes)));
    item.append(list);
  }
  return item;
}

// Shows the outputs of a part, and the forces on it.
function choose(part) {
  chosenPart = part === chosenPart ? null : part;
  document.querySelectorAll(".part").forEach((one) => one.setAttribute("aria-pressed", one.dataset.part === String(chosenPart)));
  tell();
  redraw();
}
function tell() {
  const box = byId("about");
  if (chosenPart === null) { box.replaceChildren(element("p", columns.length ? "Click on a part to see its outputs." : "Click on a part to mark it.", { class: "hint" })); return; }
  const law = laws.indexOf(chosenPart), { k } = framesAt(now);
  const of = columns.map((column, index) => index).filter((index) => (law < 0 ? columns[index].bodies : columns[index].laws).includes(law < 0 ? chosenPart : law));
  const rows = of.map((index) => {
    const { name, unit } = columns[index], jump = element("button", name, { class: "link", title: "go to its curve" });
    jump.addEventListener("click", () => {
      const plot = plots.find((one) => one.members.some((member) => member.index === index));
      plot.canvas.scrollIntoView({ block: "center", behavior: "smooth" });
      plot.canvas.focus({ preventScroll: true });
    });
    const [member] = plots.flatMap((plot) => plot.members).filter((one) => one.index === index);
    return [jump, readable(valueAt(member.points, now), member.size), unit];
  });
  const pushes = (scene.pushes[k] || []).filter(([index]) => law < 0 && data.forces[index].bodies.includes(chosenPart));
  const pulls = scene.lines.filter((line) => [line.from[0], line.to[0]].includes(chosenPart) && line.force[k]);
  const acting = [...pushes.map(([index, , , , ...force]) => [laws[index], newtons(norm(force))]), ...pulls.map((line) => [lawOf(line), newtons(Math.abs(line.force[k]))])];
  const parts = [element("h3", nameOf(chosenPart))];
  if (rows.length) parts.push(table([["output", false], ["value", true], ["unit", false]], rows));
  else if (columns.length) parts.push(element("p", "No output is of this part.", { class: "hint" }));
  if (acting.length) parts.push(table([["acts on it", false], ["force", true]], acting));
  box.replaceChildren(...parts);
}

// The part that is seen at a place of the canvas: the nearest body on the ray, or else a line or a surface.
// Where a ray from a point in a direction first meets a mesh (Möller and Trumbore 1997); null if it does not.
function depthOf({ places, corners }, from, along) {
  let nearest = null;
  const corner = (i) => [0, 1, 2].map((axis) => places[3 * corners[i] + axis]);
  for (let i = 0; i < corners.length; i += 3) {
    const a = corner(i), [u, v] = [sub(corner(i + 1), a), sub(corner(i + 2), a)];
    const p = cross(along, v), size = dot(u, p);
    if (Math.abs(size) < 1e-30) continue;
    const off = sub(from, a), x = dot(off, p) / size, q = cross(off, u), y = dot(along, q) / size;
    if (x < 0 || y < 0 || x + y > 1) continue;
    const depth = dot(v, q) / size;
    if (nearest === null || depth < nearest) nearest = depth;
  }
  return nearest;
}
function partAt(x, y) {
  const canvas = byId("scene"), [width, height] = [canvas.clientWidth, canvas.clientHeight], unit = (2 * camera.half) / height;
  const start = add(camera.center, add(scale(camera.right, (x - width / 2) * unit), scale(camera.up, (height / 2 - y) * unit)));
  const { frames } = framesAt(now);
  let [best, near] = [null, Infinity];
  const found = (part, depth) => { if (depth < near) [best, near] = [part, depth]; };
  const screen = (p) => { const [px, py, depth] = camera.seen(p); return [width / 2 + (px * height) / 2, height / 2 - (py * height) / 2, depth * camera.half]; };
  if (byId("show-shapes").checked) {
    for (const e of scene.ellipsoids.filter((one) => isShown(one.body))) {
      const place = pointOf(frames, e.body, e.at), { turn } = frameOf(frames, e.body);
      const axes = [0, 1, 2].map((i) => turned(turn, turned(e.turn, [0, 1, 2].map((j) => (i === j ? e.semi[i] : 0)))));
      const local = (v) => axes.map((axis) => dot(axis, v) / dot(axis, axis));
      const [o, d] = [local(sub(start, place)), local(camera.forward)];
      // where the ray is nearest to the middle, and from there to both sides
      const middle = -dot(o, d) / dot(d, d), reach = Math.sqrt(3) / norm(d);
      for (let k = -40; k <= 40; k++) {
        const t = middle + (k / 40) * reach, inside = o.reduce((sum, v, i) => sum + Math.abs(v + t * d[i]) ** e.degree, 0);
        if (inside <= 1) { found(e.body, t); break; }
      }
    }
  }
  if (byId("show-shapes").checked) {
    // through those of vehicles one sees what is inside
    for (const { body, mesh } of meshes.filter((one) => one.body >= 0 && scene.bodies[one.body].system >= 0 && isShown(one.body))) {
      const { at, turn: [w, ...v] } = frameOf(frames, body), back = [w, ...v.map((n) => -n)];
      const depth = depthOf(mesh, turned(back, sub(start, at)), turned(back, camera.forward));
      if (depth !== null) found(body, depth);
    }
  }
  // lines are drawn over bodies where the scene is plane
  const lines = [...scene.bones.map(([a, p, b, q]) => [a, [a, p], [b, q]]), ...scene.lines.map((line) => [lawOf(line), line.from, line.to])];
  for (const [part, from, to] of lines) {
    if (!isShown(part)) continue;
    const [a, b] = [screen(pointOf(frames, ...from)), screen(pointOf(frames, ...to))], along = [b[0] - a[0], b[1] - a[1]];
    const u = Math.max(0, Math.min(1, ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2 || 1)));
    const away = Math.hypot(a[0] + u * along[0] - x, a[1] + u * along[1] - y);
    if (away < 7) found(part, a[2] + u * (b[2] - a[2]) - (scene.planar ? 1e3 : 0.02));
  }
  if (best !== null) return best;
  for (const p of scene.planes.filter((one) => isShown(one.body))) {
    const corners = p.corners.map((corner) => screen(pointOf(frames, p.body, corner)));
    const sides = corners.map((a, i) => { const b = corners[(i + 1) % 4]; return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]); });
    if (sides.every((side) => side >= 0) || sides.every((side) => side <= 0)) found(p.body, corners[0][2]);
  }
  return best;
}

// Numbers beside arrows and belts, the largest first, where there is room.
function forceTexts(c, texts) {
  if (!byId("show-numbers").checked) return;
  const taken = [], { clientWidth: width, clientHeight: height } = byId("labels");
  c.font = "600 11px system-ui, sans-serif";
  c.textAlign = "center";
  c.lineWidth = 3;
  c.strokeStyle = style("--sky");
  c.fillStyle = style("--ink");
  for (const { at, force } of [...texts].sort((a, b) => b.force - a.force).slice(0, 40)) {
    const [px, py] = camera.seen(at), text = newtons(force), half = c.measureText(text).width / 2 + 2;
    const [x, y] = [width / 2 + (px * height) / 2, height / 2 - (py * height) / 2];
    if (taken.some(([tx, ty, th]) => Math.abs(tx - x) < half + th && Math.abs(ty - y) < 13)) continue;
    taken.push([x, y, half]);
    c.strokeText(text, x, y + 4);
    c.fillText(text, x, y + 4);
  }
}

function startParts() {
  if (!scene || times.length === 0) return;
  const boxes = [], list = element("ul", null, { class: "tree" });
  tree().forEach((node) => list.append(branch(node, 0, boxes)));
  boxes.forEach((update) => update());
  byId("parts").append(list);
  // below the motion, a long tree stays folded
  byId("parts").parentElement.open = window.innerWidth > 900;
  const canvas = byId("scene");
  let down = null;
  canvas.addEventListener("pointerdown", (e) => { down = [e.clientX, e.clientY]; });
  canvas.addEventListener("click", (e) => {
    if (!down || Math.hypot(e.clientX - down[0], e.clientY - down[1]) > 4) return;
    const { left, top } = canvas.getBoundingClientRect(), part = partAt(e.clientX - left, e.clientY - top);
    if (part !== null || chosenPart !== null) choose(part === null ? chosenPart : part);
  });
  listeners.push(() => { if (chosenPart !== null) tell(); });
  tell();
}
