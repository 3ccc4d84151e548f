// Modes: a table of them, and the motion in the one that is chosen. Its poses, and the factors on its shape there, are in the data.
const allFrames = scene.frames, allWays = scene.lines.map((line) => line.way);
const still = window.matchMedia("(prefers-reduced-motion: reduce)");
let chosenMode = 0;
const mode = () => data.modes[chosenMode];
const turns = () => mode().course === "oscillates" || mode().course === "free";

// The parts of the loop at which the motion ends, and the one in its middle.
const ends = () => (turns() ? [0, 0.5] : [0, 1]);
const middle = () => (turns() ? 0.25 : 0.5);
function partText(part) {
  if (mode().course === "free") return "to and fro";
  return mode().course === "oscillates" ? `${Math.round(360 * part) % 360}°` : `${readable(mode().lasts * part)} s`;
}

// Shows the motion of another mode.
function chooseMode(index) {
  chosenMode = Math.max(0, Math.min(data.modes.length - 1, index));
  // the state of rest is first
  const count = times.length, first = 1 + count * chosenMode;
  scene.frames = allFrames.slice(first, first + count);
  scene.lines.forEach((line, k) => { line.way = allWays[k] && allWays[k].slice(first, first + count); });
  const rows = [...byId("modes").querySelectorAll("tbody tr")];
  rows.forEach((row, k) => {
    row.classList.toggle("chosen", k === chosenMode);
    row.querySelector("button").setAttribute("aria-pressed", k === chosenMode);
  });
  rows[chosenMode].scrollIntoView({ block: "nearest" });
  tellShape();
  setTime(now);
}

// What is drawn, in words, and the amplitudes of the coordinates.
function tellShape() {
  const { course, farthest, lasts, coordinates, cells } = mode(), swings = course === "oscillates";
  const motion = {
    oscillates: `One period takes ${readable(lasts)} s. It is drawn without its damping.`,
    decays: `It does not oscillate: it is drawn as it decays, in ${readable(lasts)} s.`,
    grows: `It does not oscillate: it is drawn as it grows, in ${readable(lasts)} s.`,
    free: "Nothing brings it back: it is drawn to and fro.",
  }[course];
  const far = farthest > 0 ? `The farthest point moves by ${readable(Number((1000 * farthest).toPrecision(3)))} mm from rest; a mode may be of any size, its shape is fixed.` : "Nothing that is drawn moves in this mode: it is one of states of force laws.";
  byId("drawn").textContent = `Mode ${chosenMode + 1}${swings ? `, ${cells[0]} Hz` : ""}. ${far} ${motion}`;
  const most = {};
  for (const { unit, amplitude } of coordinates) most[unit] = Math.max(most[unit] || 0, amplitude);
  const made = coordinates.map((one) => {
    const swing = element("span", null, { class: "swing" });
    swing.append(element("i"));
    // in parts of the largest of its unit
    swing.part = one.amplitude / (most[one.unit] || 1);
    swing.phase = (one.phase * Math.PI) / 180;
    const phase = one.amplitude > 1e-6 * most[one.unit] ? `${Math.round(one.phase)}°`.replace("-", "−").replace("−0°", "0°") : "–";
    return { swing, row: [one.name, one.share < 5e-4 ? "0" : (100 * one.share).toFixed(1), readable(Number(one.amplitude.toPrecision(3)), 1e9 * most[one.unit]), one.unit, phase, swing] };
  });
  const heads = [["velocity", false], ["energy [%]", true], ["amplitude", true], ["unit", false], ["phase", true], ["now", false]];
  const many = 12, large = made.slice(0, many), small = made.slice(many);
  byId("shape").replaceChildren(table(heads, large.map(({ row }) => row)));
  if (small.length) folded(byId("shape"), `${small.length} with smaller shares`, table(heads, small.map(({ row }) => row)));
  byId("shape").swings = made.map(({ swing }) => swing);
}
// The factor on a coordinate of this phase, between two poses as the picture is: the real part of the product with e^(iφ).
function factor(phase, part) {
  const factors = data.factors[mode().course], at = part * (factors.length - 1), k = Math.min(Math.floor(at), factors.length - 2);
  const [re, im] = [0, 1].map((i) => factors[k][i] + (at - k) * (factors[k + 1][i] - factors[k][i]));
  return Math.cos(phase) * re - Math.sin(phase) * im;
}
function swing(part) {
  for (const swing of byId("shape").swings) {
    const at = 50 * swing.part * factor(swing.phase, part);
    Object.assign(swing.firstChild.style, { left: `${50 + Math.min(0, at)}%`, width: `${Math.abs(at)}%` });
  }
}

function startModes() {
  byId("title").textContent = data.title;
  byId("subtitle").textContent = `model ${data.model}, bryant ${data.version}`;
  if (data.unstable) { byId("state").textContent = "A mode grows: the state of rest is unstable."; byId("state").classList.add("bad"); }
  const rows = data.modes.map(({ cells }, index) => [element("button", index + 1, { class: "link", "aria-label": `mode ${index + 1}` }), ...cells]);
  byId("modes").append(table([["mode", false], ["frequency [Hz]", true], ["damping [%]", true], ["time [s]", true], ["moves", false]], rows));
  byId("modes").querySelectorAll("tbody tr").forEach((row, index) => row.addEventListener("click", () => chooseMode(index)));
  document.addEventListener("keydown", (e) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    if (!step || e.shiftKey || ["INPUT", "SELECT"].includes(e.target.tagName)) return;
    e.preventDefault();
    chooseMode(chosenMode + step);
    // the mark of the keyboard goes along
    if (byId("modes").contains(e.target)) byId("modes").querySelectorAll("tbody button")[chosenMode].focus();
  });
  const notes = byId("notes");
  if (data.notes.length) notes.append(lines(data.notes));
  notes.append(lines([
    "frequency: |λ|/2π of the motion e^(λ t), that of the mode without its damping; damping: −Re λ/|λ|, in parts of the critical one; time: in which the motion falls, or grows, by a factor of e",
    "moves, energy: the shares of the kinetic energy by velocity of the model; amplitude and phase: those of the coordinate along the motion of the velocity, at the size that is drawn",
    "Where rates coincide, every combination of their shapes is a shape, too. Those that are shown are orthogonal in the mass matrix, and as much of the energy as possible is in a single velocity of each.",
  ]));
  const command = element("p"), digest = element("p");
  command.append("Command: ", element("code", data.command));
  digest.append("Digest of the model: ", element("code", data.digest));
  byId("again").append(command, digest);
}

startModes();
for (const line of scene.lines) line.force = times.map(() => line.force[0] || 0);
for (const e of scene.ellipsoids) if (e.size && e.size.length) e.size = times.map(() => e.size[0]);
byId("show-beside").checked = still.matches;
tellShape();
listeners.push(swing);
startMotion();
startParts();
// modes.html#mode=3 begins with the third
const first = Number(new URLSearchParams(location.hash.slice(1)).get("mode")) || 1;
chooseMode(first - 1);
setTime(still.matches ? middle() : 0);
if (!still.matches) play(true);
onPaper(() => swing(now));
// for programs that open the page: all of it was made
document.documentElement.dataset.made = "yes";
