// Vectors are arrays of three numbers.
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.sqrt(dot(a, a));

// The vector v rotated by the unit quaternion q = (w, x, y, z).
function turned(q, v) {
  const u = [q[1], q[2], q[3]];
  const t = scale(cross(u, v), 2);
  return add(add(v, scale(t, q[0])), cross(u, t));
}

// Parallel projection. `yaw` and `pitch` [rad] turn the view from the right, along y; `half` is half the height
// that is seen [m].
class Camera {
  constructor() {
    this.center = [0, 0, 0];
    this.offset = [0, 0, 0];
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
