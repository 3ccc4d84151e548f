// The motion: bodies between samples, playback, and input of the reader.
const scene = data.scene;
const times = scene ? scene.times : [];
const camera = new Camera();
const listeners = [];
// The outputs of a run and their plots; the page of modes has none. Its motion is one loop, and its times are parts of it.
const columns = data.columns || [];
const plots = [];
const loops = Boolean(data.modes);
let now = times.length ? times[0] : 0;
let playing = false;

// Frames of all bodies at a time: positions and quaternions, interpolated between two samples.
function framesAt(t, scene = data.scene) {
  const { times } = scene;
  let k = times.findIndex((time) => time > t) - 1;
  if (k < -1) k = times.length - 2;
  k = Math.max(0, Math.min(times.length - 2, k));
  const [a, b] = [scene.frames[k], scene.frames[Math.min(k + 1, scene.frames.length - 1)]];
  const span = times.length > 1 ? times[k + 1] - times[k] : 1;
  const u = Math.max(0, Math.min(1, (t - times[k]) / (span || 1)));
  const frames = scene.bodies.map((_, body) => {
    const part = (of, from, to) => of.slice(7 * body + from, 7 * body + to);
    const [p, r, q, s] = [part(a, 0, 3), part(b, 0, 3), part(a, 3, 7), part(b, 3, 7)];
    const sign = q[0] * s[0] + q[1] * s[1] + q[2] * s[2] + q[3] * s[3] < 0 ? -1 : 1;
    const mid = q.map((x, i) => x + (sign * s[i] - x) * u);
    const length = Math.hypot(...mid) || 1;
    return { at: add(p, scale(sub(r, p), u)), turn: mid.map((x) => x / length) };
  });
  return { frames, k: u > 0.5 && k + 1 < times.length ? k + 1 : k, at: k, u };
}
// Numbers that are given for each sample, between two samples.
const between = (list, { at, u }) => {
  const [a, b] = [list[at], list[Math.min(at + 1, list.length - 1)]];
  return Array.isArray(a) ? a.map((x, i) => x + (b[i] - x) * u) : a + (b - a) * u;
};
// The points of a line: both ends, and those between them by which a belt goes over bodies.
function pathOf(moment, line) {
  const ends = [line.from, line.to].map((end) => pointOf(moment.frames, ...end)), path = [ends[0]];
  const way = line.way ? between(line.way, moment) : [];
  for (let i = 0; i < way.length; i += 3) path.push(way.slice(i, i + 3));
  return [...path, ends[1]];
}
const FIXED = { at: [0, 0, 0], turn: [1, 0, 0, 0] };
const frameOf = (frames, body) => (body < 0 ? FIXED : frames[body]);
const pointOf = (frames, body, local) => {
  const frame = frameOf(frames, body);
  return add(frame.at, turned(frame.turn, local));
};

const colourOf = (body) => {
  const system = body < 0 ? -1 : scene.bodies[body].system;
  // neighbouring quaternions differ little
  return lightOr(body, system < 0 ? rgb("#8a929c") : mixed(rgb(COLOURS[system % COLOURS.length]), [1, 1, 1], 0.14 * (body % 3)));
};
// Slack is grey; otherwise the colour goes from orange to dark red as the force grows.
const tensionColour = (force, most) => (force > 0 && most > 0 ? mixed(rgb("#e69f00"), rgb("#b00020"), Math.min(1, force / most)) : rgb("#9aa4b0"));

// An ellipsoid as it is drawn.
function solid(frames, e, colour, size = 1) {
  const axes = [0, 1, 2].map((i) => turned(frameOf(frames, e.body).turn, turned(e.turn, [0, 1, 2].map((j) => (i === j ? size * e.semi[i] : 0)))));
  return { place: pointOf(frames, e.body, e.at), axes, colour, degree: e.degree };
}

// Meshes of files, their numbers as they are drawn.
const meshes = (scene ? scene.meshes : []).map((m) => {
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
  const places = Float32Array.from(new Uint16Array(bytes(m.places)), (n, i) => m.low[i % 3] + n * m.step);
  const corners = bytes(m.corners);
  return { body: m.body, mesh: { places, corners: m.wide ? new Uint32Array(corners) : new Uint16Array(corners) } };
});

// Other positions in grey: of the second run at this time, or the ends of the motion of a mode, through which one sees.
function ghosts(t, shapes) {
  if (data.beside) ghost(data.beside.scene, Math.min(t, data.beside.scene.times[data.beside.scene.times.length - 1]), shapes, shapes.ellipsoids);
  if (loops) for (const end of ends()) ghost(scene, end, shapes, shapes.bags);
}
function ghost(scene, t, shapes, solids) {
  const grey = rgb("#9aa4b0"), moment = framesAt(t, scene), { frames } = moment;
  if (byId("show-shapes").checked) {
    for (const e of scene.ellipsoids) {
      if (e.body < 0 || e.size || !isShown(e.body)) continue;
      solids.push(solid(frames, e, mixed(grey, [1, 1, 1], 0.35)));
    }
  }
  if (loops && byId("show-shapes").checked) {
    for (const { body, mesh } of meshes) {
      if (body >= 0 && isShown(body)) shapes.meshes.push({ mesh, origin: frames[body].at, turn: frames[body].turn, colour: grey, alpha: 0.2 });
    }
  }
  for (const [a, p, b, q] of scene.bones) shapes.strokes.push({ from: pointOf(frames, a, p), to: pointOf(frames, b, q), colour: grey, width: 3.5, above: scene.planar });
  for (const line of scene.lines) strokes(shapes, pathOf(moment, line), { colour: grey, width: 2, above: scene.planar });
}

// Strokes from point to point.
function strokes(shapes, path, look) {
  for (let i = 1; i < path.length; i++) shapes.strokes.push({ from: path[i - 1], to: path[i], ...look });
}

// A bushing: a cross in the axes of its first body, and a line to the origin of its second frame.
function bushingMark(frames, line) {
  const [from, to] = [pointOf(frames, ...line.from), pointOf(frames, ...line.to)];
  const colour = rgb("#7a5195"), arm = 0.025 * home.half, above = scene.planar;
  const arms = [0, 1, 2].map((i) => turned(frameOf(frames, line.from[0]).turn, [0, 1, 2].map((j) => (i === j ? arm : 0))));
  return [
    ...arms.map((a) => ({ from: sub(from, a), to: sub(from, scale(a, -1)), colour, width: 3, above })),
    { from, to, colour, width: 2, above },
  ];
}

// The points that can be traced: the origin of each body, and the points of outputs.
const traceable = scene ? [...scene.bodies.map((body, index) => ({ name: body.name, body: index, at: [0, 0, 0] })), ...scene.points] : [];

function shapesAt(t) {
  const moment = framesAt(t), { frames, k } = moment;
  const shapes = { ellipsoids: [], bags: [], meshes: [], faces: [], strokes: [], texts: [] };
  if (byId("show-beside").checked || (printing && loops)) ghosts(t, shapes);
  const ink = rgb(style("--ink").length === 7 ? style("--ink") : "#1a1d21");
  if (byId("show-shapes").checked) {
    for (const e of scene.ellipsoids) {
      if (!isShown(e.body)) continue;
      if (e.size) shapes.bags.push(solid(frames, e, rgb("#5c6f82"), e.size.length ? between(e.size, moment) : 1));
      else shapes.ellipsoids.push(solid(frames, e, mixed(colourOf(e.body), [1, 1, 1], 0.25)));
    }
  }
  if (byId("show-shapes").checked) {
    // one sees what is in a vehicle
    for (const { body, mesh } of meshes) {
      if (!isShown(body)) continue;
      const { at, turn } = frameOf(frames, body), inside = body < 0 || scene.bodies[body].system < 0;
      shapes.meshes.push({ mesh, origin: at, turn, colour: mixed(colourOf(body), [1, 1, 1], 0.3), alpha: inside ? 0.35 : 1 });
    }
  }
  for (const p of scene.planes) {
    if (!isShown(p.body)) continue;
    const corners = p.corners.map((corner) => pointOf(frames, p.body, corner));
    shapes.faces.push({ corners, colour: rgb("#8a929c"), alpha: 0.3 });
    if (scene.planar) shapes.strokes.push({ from: corners[0], to: corners[1], colour: rgb("#6f7883"), width: 3 });
    else corners.forEach((corner, i) => shapes.strokes.push({ from: corner, to: corners[(i + 1) % 4], colour: rgb("#6f7883"), width: 1.5 }));
  }
  const bare = !byId("show-shapes").checked;
  const round = new Set([...scene.ellipsoids, ...meshes].map((e) => e.body));
  for (const [a, p, b, q] of scene.bones) {
    if (!isShown(a)) continue;
    // in space sticks would only stand out of solids
    if (!bare && !scene.planar && round.has(a)) continue;
    const colour = mixed(colourOf(a), ink, scene.planar && !bare ? 0.45 : 0.1);
    shapes.strokes.push({ from: pointOf(frames, a, p), to: pointOf(frames, b, q), colour, width: bare ? 6 : 4, above: scene.planar || bare });
  }
  const pulling = scene.lines.filter((line) => line.kind !== "bushing");
  const most = Math.max(0, ...pulling.flatMap((line) => line.force));
  for (const line of scene.lines) {
    if (!isShown(lawOf(line))) continue;
    if (line.kind === "bushing") { shapes.strokes.push(...bushingMark(frames, line)); continue; }
    const force = line.force[k] || 0;
    const colour = lightOr(lawOf(line), line.kind === "belt" ? tensionColour(force, most) : rgb("#7a5195"));
    const path = pathOf(moment, line);
    strokes(shapes, path, { colour, width: 3.5 + (most > 0 ? 3 * Math.max(0, force / most) : 0), above: scene.planar });
    const [from, to] = [path[0], path[path.length - 1]];
    if (Math.abs(force) > 0.02 * most && byId("show-forces").checked) shapes.texts.push({ at: scale(add(from, to), 0.5), force: Math.abs(force) });
  }
  if (byId("show-forces").checked) {
    const strongest = Math.max(0, ...scene.pushes.flatMap((list) => list.map((p) => Math.hypot(p[4], p[5], p[6]))));
    for (const [index, x, y, z, fx, fy, fz] of scene.pushes[k] || []) {
      if (!data.forces[index].bodies.some(isShown)) continue;
      const force = [fx, fy, fz], size = norm(force);
      const length = 0.9 * home.half * Math.sqrt(size / strongest) * 0.5;
      const tip = [x, y, z];
      const tail = sub(tip, scale(force, length / size));
      shapes.strokes.push({ from: tail, to: tip, colour: rgb("#d55e00"), width: 3, head: true, above: true });
      if (size > 0.02 * strongest) shapes.texts.push({ at: tail, force: size });
    }
  }
  const traced = Number(byId("trace").value);
  if (traced >= 0) {
    const { body, at } = traceable[traced];
    const path = times.map((t) => pointOf(framesAt(t).frames, body, at));
    for (let i = 1; i < path.length && (loops || times[i] <= t); i++) shapes.strokes.push({ from: path[i - 1], to: path[i], colour: rgb("#cc79a7"), width: 2, above: true });
  }
  return { shapes, frames };
}

// The box that contains the whole motion, as one sees it who moves with the body that is followed.
const home = { center: [0, 0, 0], half: 1 };
const followed = () => Number(byId("follow").value);
const placeOf = (frames) => frameOf(frames, followed()).at;
function frameAll() {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  let origin = [0, 0, 0];
  const include = (point, margin) => point.forEach((x, i) => {
    low[i] = Math.min(low[i], x - origin[i] - margin);
    high[i] = Math.max(high[i], x - origin[i] + margin);
  });
  // of modes the poses are in `data.scene` one after the other
  const poses = scene.frames.length, first = Math.max(1, Math.floor(poses / 60));
  for (let k = 0; k < poses; k += first) {
    const { frames } = framesAt(k, { ...scene, times: scene.frames.map((_, index) => index) });
    origin = placeOf(frames);
    frames.forEach((frame, body) => { if (scene.bodies[body].system >= 0) include(frame.at, 0); });
    for (const [a, p, b, q] of scene.bones) { include(pointOf(frames, a, p), 0); include(pointOf(frames, b, q), 0); }
    for (const e of scene.ellipsoids) if (e.body >= 0) include(pointOf(frames, e.body, e.at), Math.max(...e.semi));
    for (const line of scene.lines) { include(pointOf(frames, ...line.from), 0); include(pointOf(frames, ...line.to), 0); }
    for (const { body, mesh } of meshes) {
      if (body < 0 || scene.bodies[body].system < 0) continue;
      for (let i = 0; i < mesh.places.length; i += 3 * Math.ceil(mesh.places.length / 600)) include(pointOf(frames, body, [mesh.places[i], mesh.places[i + 1], mesh.places[i + 2]]), 0);
    }
  }
  if (!low.every(Number.isFinite)) return;
  home.center = scale(add(low, high), 0.5);
  home.low = low;
  home.high = high;
}
// The height of the view that shows the box of the motion, for a picture of this shape.
function fit() {
  if (!home.low) return;
  const size = sub(home.high, home.low), aspect = byId("scene").clientWidth / Math.max(1, byId("scene").clientHeight);
  const extent = (axis) => 0.5 * size.reduce((sum, length, i) => sum + Math.abs(axis[i]) * length, 0);
  camera.offset = home.center.slice();
  camera.half = 1.12 * Math.max(extent(camera.up), extent(camera.right) / aspect, 0.05);
  home.half = camera.half;
}

let renderer = null;
let seenAspect = 1;
function resize() {
  const ratio = Math.min(3, window.devicePixelRatio || 1);
  for (const canvas of [byId("scene"), byId("labels")]) {
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  }
}
let asked = false;
function redraw() {
  if (!asked) {
    asked = true;
    requestAnimationFrame(() => { asked = false; render(); });
  }
}
function render() {
  if (!renderer) return;
  resize();
  const { shapes, frames } = shapesAt(now);
  camera.center = add(placeOf(frames), camera.offset);
  const canvas = byId("scene"), aspect = canvas.clientWidth / canvas.clientHeight, { half } = camera;
  // a flatter picture on paper shows the same width
  if (printing) camera.half *= Math.max(1, seenAspect / aspect); else seenAspect = aspect;
  renderer.draw(camera, shapes);
  labels(shapes.texts);
  camera.half = half;
  byId("clock").textContent = loops ? partText(now) : `${timeText(now)} ${TIME.unit}`;
}
// A bar of a round length, and the axes.
function labels(texts) {
  const canvas = byId("labels"), c = canvas.getContext("2d"), ratio = canvas.height / canvas.clientHeight;
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, canvas.width, canvas.height);
  // what WebGL has drawn is not printed
  if (printing) c.drawImage(byId("scene"), 0, 0, canvas.clientWidth, canvas.clientHeight);
  forceTexts(c, texts);
  const pixels = canvas.clientHeight / 2 / camera.half, power = 10 ** Math.floor(Math.log10(120 / pixels));
  const length = [5, 2, 1].map((f) => f * power).find((l) => l * pixels <= 120) || power;
  const [x, y] = [canvas.clientWidth - 20 - length * pixels, canvas.clientHeight - 16];
  c.strokeStyle = c.fillStyle = style("--soft");
  c.lineWidth = 2;
  c.beginPath();
  c.moveTo(x, y - 5); c.lineTo(x, y); c.lineTo(x + length * pixels, y); c.lineTo(x + length * pixels, y - 5);
  c.stroke();
  c.font = "12px system-ui, sans-serif";
  c.textAlign = "center";
  c.fillText(length >= 1 ? `${length} m` : `${Number((1000 * length).toPrecision(3))} mm`, x + (length * pixels) / 2, y - 6);
  [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]].forEach(([name, axis]) => {
    const [dx, dy] = [dot(axis, camera.right), dot(axis, camera.up)];
    if (Math.hypot(dx, dy) < 0.1) return;
    const [ox, oy] = [34, canvas.clientHeight - 34];
    c.beginPath();
    c.moveTo(ox, oy); c.lineTo(ox + 22 * dx, oy - 22 * dy);
    c.stroke();
    c.fillText(name, ox + 30 * dx, oy - 30 * dy + 4);
  });
}

function setTime(t) {
  now = Math.max(times[0], Math.min(times[times.length - 1], t));
  byId("time").value = now;
  redraw();
  listeners.forEach((listener) => listener(now));
}
function play(on) {
  playing = on;
  byId("play").textContent = on ? "❚❚" : "▶";
  if (!on) return;
  if (now >= times[times.length - 1]) setTime(times[0]);
  let before = performance.now();
  const step = (clock) => {
    if (!playing) return;
    const t = now + ((clock - before) / 1000) * Number(byId("speed").value);
    before = clock;
    setTime(loops ? t % 1 : t);
    if (!loops && t >= times[times.length - 1]) play(false);
    else requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}
function view(name) {
  camera.look(...VIEWS[name]);
  fit();
  redraw();
}

function hands() {
  const canvas = byId("scene"), fingers = new Map();
  let apart = 0;
  canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); fingers.set(e.pointerId, [e.clientX, e.clientY]); apart = 0; });
  const up = (e) => { fingers.delete(e.pointerId); apart = 0; };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointermove", (e) => {
    if (!fingers.has(e.pointerId)) return;
    const [x, y] = fingers.get(e.pointerId), [dx, dy] = [e.clientX - x, e.clientY - y];
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    const unit = (2 * camera.half) / canvas.clientHeight;
    const move = () => {
      const by = add(scale(camera.right, -dx * unit), scale(camera.up, dy * unit));
      camera.offset = add(camera.offset, by);
    };
    if (fingers.size === 2) {
      const [a, b] = [...fingers.values()], distance = Math.hypot(a[0] - b[0], a[1] - b[1]);
      if (apart > 0) camera.half *= apart / distance;
      apart = distance;
      move();
    } else if (e.shiftKey || e.buttons & 6 || scene.planar) move();
    else camera.look(camera.yaw - 0.008 * dx, camera.pitch + 0.008 * dy);
    redraw();
  });
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("wheel", (e) => { e.preventDefault(); camera.half *= Math.exp(0.0012 * e.deltaY); redraw(); }, { passive: false });
  document.addEventListener("keydown", (e) => {
    if (["INPUT", "SELECT", "BUTTON", "SUMMARY"].includes(e.target.tagName) && e.target.id !== "time") return;
    const step = times.length > 1 ? (times[times.length - 1] - times[0]) / (times.length - 1) : 0;
    const keys = { " ": () => play(!playing), ArrowRight: () => setTime(now + step), ArrowLeft: () => setTime(now - step), Home: () => setTime(times[0]), End: () => setTime(times[times.length - 1]) };
    const nearer = (factor) => { camera.half *= factor; redraw(); };
    const turn = (yaw, pitch) => { camera.look(camera.yaw + yaw, camera.pitch + pitch); redraw(); };
    const turns = scene.planar ? {} : { ArrowRight: () => turn(-0.1, 0), ArrowLeft: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1) };
    const zooms = { "+": () => nearer(0.8), "-": () => nearer(1.25) };
    const does = (e.target.id === "scene" && (zooms[e.key] || (e.shiftKey && turns[e.key]))) || keys[e.key];
    if (does) { e.preventDefault(); does(); }
  });
}

function save(canvas, name) {
  const link = element("a", null, { download: name, href: canvas.toDataURL("image/png") });
  link.click();
}

function startMotion() {
  if (!scene || times.length === 0) {
    document.querySelector(".motion").hidden = true;
    return;
  }
  try { renderer = WebGl.of(byId("scene")); } catch (error) { console.warn(error); renderer = null; }
  if (!renderer) {
    // after a request for WebGL, a canvas gives no other context
    const fresh = byId("scene").cloneNode(true);
    byId("scene").replaceWith(fresh);
    renderer = new Plain(fresh);
  }
  const slider = byId("time");
  slider.min = times[0];
  slider.max = times[times.length - 1];
  slider.addEventListener("input", () => { play(false); setTime(Number(slider.value)); });
  byId("play").addEventListener("click", () => play(!playing));
  // playback takes about four seconds for any run, two for a mode
  const natural = (times[times.length - 1] - times[0]) / (loops ? 2 : 4);
  const speeds = loops ? [2, 1, 0.5, 0.2, 0.1] : [1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];
  const usual = speeds.reduce((best, s) => (Math.abs(Math.log(s / natural)) < Math.abs(Math.log(best / natural)) ? s : best));
  for (const s of speeds) byId("speed").append(element("option", loops ? `${readable(1 / s)} s` : s === 1 ? "real time" : `1 : ${Math.round(1 / s)}`, { value: s }));
  byId("speed").value = usual;
  // a motion in the plane is seen from the side alone: the button shows all of it again
  for (const name of scene.planar ? ["side"] : Object.keys(VIEWS)) {
    const button = element("button", scene.planar ? "whole view" : name);
    button.addEventListener("click", () => view(name));
    byId("views").append(button, " ");
  }
  for (const id of ["follow", "trace"]) {
    byId(id).append(element("option", "nothing", { value: -1 }));
    (id === "trace" ? traceable : scene.bodies).forEach((one, index) => byId(id).append(element("option", one.name, { value: index })));
    byId(id).addEventListener("change", () => {
      if (id === "follow") { frameAll(); fit(); }
      redraw();
    });
  }
  byId("beside").hidden = !data.beside && !loops;
  if (loops) byId("beside-name").textContent = "ends of the motion";
  for (const id of ["show-forces", "show-numbers", "show-shapes", "show-beside"]) byId(id).addEventListener("change", redraw);
  byId("picture").addEventListener("click", () => { render(); save(byId("scene"), `${data.model}.png`); });
  const strongest = Math.max(0, ...scene.pushes.flatMap((list) => list.map((p) => Math.hypot(p[4], p[5], p[6]))));
  const tightest = Math.max(0, ...scene.lines.filter((l) => l.kind === "belt").flatMap((l) => l.force));
  const words = loops ? ["Forces are those at rest."] : [];
  if (scene.lines.some((l) => l.kind === "belt")) words.push(`Belts: grey while slack${tightest > 0 ? `, from orange to dark red up to ${newtons(tightest)}` : ""}.`);
  if (strongest > 0) words.push(`Arrows: forces of contacts on bodies; their length is proportional to the square root of the force, the longest is ${newtons(strongest)}.`);
  if (data.beside) words.push(`Grey: the run with ${data.beside.label}.`);
  byId("legend").textContent = words.join(" ");
  byId("follow").value = scene.follow;
  frameAll();
  hands();
  // report.html#t=80&view=front begins at 80 ms, seen from the front
  const asked = new URLSearchParams(location.hash.slice(1));
  const from = asked.get("view");
  view(scene.planar ? "side" : from in VIEWS ? from : scene.view === "side" ? "oblique" : scene.view);
  new ResizeObserver(redraw).observe(byId("stage"));
  onPaper(() => {
    // at rest there is little to see: paper has the first peak, unless another time was chosen
    const chosen = now;
    if (printing && loops) now = middle();
    else if (printing && now === times[0] && data.result.peaks.length) now = data.result.peaks[0].time_s;
    render();
    now = chosen;
  });
  const t = Number(asked.get("t"));
  setTime(asked.has("t") && Number.isFinite(t) ? t / 1000 : times[0]);
}
