const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);

// Vectors are arrays of three numbers.
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.sqrt(dot(a, a));

// The vector v turned by the unit quaternion q = (w, x, y, z).
function turned(q, v) {
  const u = [q[1], q[2], q[3]];
  const t = scale(cross(u, v), 2);
  return add(add(v, scale(t, q[0])), cross(u, t));
}

// An element of the document with text, never HTML.
function element(name, text, attributes) {
  const made = document.createElement(name);
  if (text !== undefined && text !== null) made.textContent = text;
  for (const [key, value] of Object.entries(attributes || {})) made.setAttribute(key, value);
  return made;
}

// A number of four digits, as people write it. Beside numbers of size `most`, rounding counts as 0.
function readable(value, most = 0) {
  if (value === null || !Number.isFinite(value)) return "–";
  if (Math.abs(value) <= 1e-12 * most || value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
  return text.replace("-", "−");
}

// Parallel projection: what is seen from where. `yaw` and `pitch` [rad] turn the view from the right, along y; `half` is half the height
// that is seen [m].
class Camera {
  constructor() {
    this.center = [0, 0, 0];
    this.half = 1;
    this.look(0, 0);
  }
  look(yaw, pitch) {
    this.yaw = yaw;
    this.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, pitch));
    const [s, c, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(this.pitch), Math.cos(this.pitch)];
    this.right = [c, s, 0];
    this.forward = [-s * cp, c * cp, -sp];
    this.up = [-s * sp, c * sp, cp];
  }
  // To the right, upwards and away, in parts of half the height.
  seen(point) {
    const from = sub(point, this.center);
    return [dot(from, this.right) / this.half, dot(from, this.up) / this.half, dot(from, this.forward) / this.half];
  }
}

const VIEWS = { side: [0, 0], front: [Math.PI / 2, 0], top: [0, Math.PI / 2], oblique: [0.6, 0.4] };
