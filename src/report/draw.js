const mixed = (a, b, share) => a.map((x, k) => x + (b[k] - x) * share);

const ELLIPSOID_VERTEX = `#version 300 es
uniform vec3 center, right, up, forward; uniform float half_height, aspect;
in vec2 corner; in vec3 place, first, second, third; in vec4 look;
out vec2 seen; flat out vec3 o; flat out mat3 axes; flat out vec4 colour;
void main() {
  vec3 from = place - center;
  vec2 middle = vec2(dot(from, right), dot(from, up));
  vec2 reach = vec2(length(vec3(dot(first, right), dot(second, right), dot(third, right))), length(vec3(dot(first, up), dot(second, up), dot(third, up))));
  if (look.w > 2.5) reach = vec2(abs(dot(first, right)) + abs(dot(second, right)) + abs(dot(third, right)), abs(dot(first, up)) + abs(dot(second, up)) + abs(dot(third, up)));
  seen = middle + corner * reach * 1.03;
  o = from; axes = mat3(first, second, third); colour = look;
  gl_Position = vec4(seen.x / half_height / aspect, seen.y / half_height, 0.0, 1.0);
}`;
// The ray along `forward` through a point of the picture meets the body where sum |x_i / a_i|^n = 1.
const ELLIPSOID_FRAGMENT = `#version 300 es
precision highp float;
uniform vec3 right, up, forward; uniform float depth, alpha;
in vec2 seen; flat in vec3 o; flat in mat3 axes; flat in vec4 colour; out vec4 result;
vec3 local(vec3 v) { return vec3(dot(axes[0], v) / dot(axes[0], axes[0]), dot(axes[1], v) / dot(axes[1], axes[1]), dot(axes[2], v) / dot(axes[2], axes[2])); }
float outside(vec3 p, float n) { vec3 q = pow(abs(p), vec3(n)); return q.x + q.y + q.z - 1.0; }
void main() {
  vec3 start = local(seen.x * right + seen.y * up - o), along = local(forward);
  float t, n = colour.w; vec3 normal;
  if (n < 2.5) {
    float a = dot(along, along), b = dot(start, along), c = dot(start, start) - 1.0, d = b * b - a * c;
    if (d < 0.0) discard;
    t = (-b - sqrt(d)) / a;
    normal = start + t * along;
  } else {
    vec3 safe = mix(along, vec3(1e-9), lessThan(abs(along), vec3(1e-9)));
    vec3 one = (-1.0 - start) / safe, two = (1.0 - start) / safe, low = min(one, two), high = max(one, two);
    float near = max(low.x, max(low.y, low.z)), far = min(high.x, min(high.y, high.z)), before = near;
    if (near > far) discard;
    bool met = false;
    for (int k = 1; k <= 40; k++) {
      t = near + (far - near) * float(k) / 40.0;
      if (outside(start + t * along, n) < 0.0) { met = true; break; }
      before = t;
    }
    if (!met) discard;
    for (int k = 0; k < 12; k++) { float m = 0.5 * (before + t); if (outside(start + m * along, n) < 0.0) t = m; else before = m; }
    vec3 p = start + t * along;
    normal = sign(p) * pow(abs(p), vec3(n - 1.0));
  }
  normal = normalize(axes[0] * normal.x / dot(axes[0], axes[0]) + axes[1] * normal.y / dot(axes[1], axes[1]) + axes[2] * normal.z / dot(axes[2], axes[2]));
  float light = 0.42 + 0.58 * max(0.0, dot(normal, normalize(0.5 * up - 0.35 * right - forward)));
  float rim = smoothstep(0.0, 0.25, -dot(normal, forward));
  float cover = alpha < 1.0 ? mix(0.85, alpha, rim) : 1.0;
  result = vec4(colour.rgb * light * (0.6 + 0.4 * rim) * cover, cover);
  gl_FragDepth = clamp(0.5 + 0.5 * t / depth, 0.0, 1.0);
}`;
const MESH_VERTEX = `#version 300 es
uniform vec3 center, right, up, forward, origin; uniform vec4 turn; uniform float half_height, aspect, depth;
in vec3 place; out vec3 seen;
void main() {
  vec3 p = place + 2.0 * cross(turn.yzw, cross(turn.yzw, place) + turn.x * place) + origin - center;
  seen = vec3(dot(p, right), dot(p, up), dot(p, forward));
  gl_Position = vec4(seen.x / half_height / aspect, seen.y / half_height, seen.z / depth, 1.0);
}`;
const MESH_FRAGMENT = `#version 300 es
precision highp float;
uniform vec3 tint; uniform float alpha; in vec3 seen; out vec4 result;
void main() {
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  float light = 0.45 + 0.55 * abs(dot(normal, normalize(vec3(-0.35, 0.5, -1.0))));
  result = vec4(tint * light * alpha, alpha);
}`;
const FLAT_VERTEX = `#version 300 es
in vec3 place; in vec4 colour; out vec4 tint; void main() { tint = colour; gl_Position = vec4(place, 1.0); }`;
const FLAT_FRAGMENT = `#version 300 es
precision mediump float; in vec4 tint; out vec4 result; void main() { result = vec4(tint.rgb * tint.a, tint.a); }`;

// Draws lists of shapes: meshes, ellipsoids, and bags that one sees through { place, axes: [3 vectors of the lengths of semi-axes], colour, degree }, faces { corners, colour,
// alpha }, strokes { from, to, colour, width [px], above }.
class WebGl {
  static of(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, premultipliedAlpha: true, preserveDrawingBuffer: true });
    return gl ? new WebGl(canvas, gl) : null;
  }
  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.round = this.program(ELLIPSOID_VERTEX, ELLIPSOID_FRAGMENT);
    this.flat = this.program(FLAT_VERTEX, FLAT_FRAGMENT);
    this.solid = this.program(MESH_VERTEX, MESH_FRAGMENT);
    this.kept = new Map();
    this.buffer = gl.createBuffer();
    this.corners = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
  }
  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }
  attribute(program, name, size, stride, offset, divisor) {
    const gl = this.gl, at = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * stride, 4 * offset);
    gl.vertexAttribDivisor(at, divisor);
  }
  draw(camera, shapes) {
    const gl = this.gl, aspect = this.canvas.width / this.canvas.height;
    // the visible depth: this many heights in front of the centre and behind it
    const far = 40;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    // with the mask off, the depths of the picture before would stay
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.useProgram(this.round);
    const uniform = (name) => gl.getUniformLocation(this.round, name);
    for (const name of ["center", "right", "up", "forward"]) gl.uniform3fv(uniform(name), camera[name]);
    gl.uniform1f(uniform("half_height"), camera.half);
    gl.uniform1f(uniform("aspect"), aspect);
    gl.uniform1f(uniform("depth"), far * camera.half);
    this.rounds(shapes.ellipsoids, 1);
    this.meshes(camera, aspect, far, shapes.meshes.filter((m) => m.alpha === 1));
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.triangles(camera, aspect, far, shapes.strokes.filter((s) => !s.above).flatMap((s) => this.stroke(camera, aspect, s)));
    gl.depthMask(false);
    const flat = shapes.faces.flatMap((face) => [0, 1, 2, 0, 2, 3].map((k) => [face.corners[k], face.colour, face.alpha]));
    this.triangles(camera, aspect, far, flat);
    // one sees through bags: they are drawn after what is in them
    this.rounds(shapes.bags, 0.25);
    this.meshes(camera, aspect, far, shapes.meshes.filter((m) => m.alpha < 1));
    gl.disable(gl.DEPTH_TEST);
    this.triangles(camera, aspect, far, shapes.strokes.filter((s) => s.above).flatMap((s) => this.stroke(camera, aspect, s)));
  }
  // Draws meshes { mesh: { places, corners }, origin, turn, colour, alpha }; the numbers of each are sent once.
  meshes(camera, aspect, far, all) {
    const gl = this.gl;
    if (all.length === 0) return;
    gl.useProgram(this.solid);
    const uniform = (name) => gl.getUniformLocation(this.solid, name);
    for (const name of ["center", "right", "up", "forward"]) gl.uniform3fv(uniform(name), camera[name]);
    gl.uniform1f(uniform("half_height"), camera.half);
    gl.uniform1f(uniform("aspect"), aspect);
    gl.uniform1f(uniform("depth"), far * camera.half);
    for (const { mesh, origin, turn, colour, alpha } of all) {
      if (!this.kept.has(mesh)) {
        const [places, corners] = [gl.createBuffer(), gl.createBuffer()];
        gl.bindBuffer(gl.ARRAY_BUFFER, places);
        gl.bufferData(gl.ARRAY_BUFFER, mesh.places, gl.STATIC_DRAW);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, corners);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.corners, gl.STATIC_DRAW);
        this.kept.set(mesh, [places, corners]);
      }
      const [places, corners] = this.kept.get(mesh);
      gl.uniform3fv(uniform("origin"), origin);
      gl.uniform4fv(uniform("turn"), turn);
      gl.uniform3fv(uniform("tint"), colour);
      gl.uniform1f(uniform("alpha"), alpha);
      gl.bindBuffer(gl.ARRAY_BUFFER, places);
      this.attribute(this.solid, "place", 3, 3, 0, 0);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, corners);
      gl.drawElements(gl.TRIANGLES, mesh.corners.length, mesh.corners instanceof Uint16Array ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT, 0);
    }
  }
  // Draws ellipsoids.
  rounds(all, alpha) {
    const gl = this.gl;
    gl.useProgram(this.round);
    gl.uniform1f(gl.getUniformLocation(this.round, "alpha"), alpha);
    const numbers = all.flatMap((e) => [...e.place, ...e.axes[0], ...e.axes[1], ...e.axes[2], ...e.colour, e.degree]);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    this.attribute(this.round, "corner", 2, 2, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.DYNAMIC_DRAW);
    ["place", "first", "second", "third"].forEach((name, k) => this.attribute(this.round, name, 3, 16, 3 * k, 1));
    this.attribute(this.round, "look", 4, 16, 12, 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, all.length);
  }
  // Draws a stroke as two triangles that face the camera.
  stroke(camera, aspect, { from, to, colour, width, head }) {
    const along = sub(to, from), across = cross(along, camera.forward), size = norm(across);
    if (size < 1e-9) return [];
    const unit = (2 * camera.half) / this.canvas.clientHeight;
    const side = scale(across, (0.5 * width * unit) / size);
    const corner = (p, s) => [add(p, scale(side, s)), colour, 1];
    const neck = head ? sub(to, scale(along, Math.min(0.6, (3.2 * width * unit) / norm(along)))) : to;
    const [a, b, c, d] = [corner(from, 1), corner(from, -1), corner(neck, -1), corner(neck, 1)];
    const tip = head ? [corner(neck, 2.6), corner(neck, -2.6), [to, colour, 1]] : [];
    return [a, b, c, a, c, d, ...tip];
  }
  triangles(camera, aspect, far, corners) {
    if (corners.length === 0) return;
    const gl = this.gl, numbers = [];
    for (const [point, colour, alpha] of corners) {
      const [x, y, z] = camera.seen(point);
      numbers.push(x / aspect, y, z / far, ...colour, alpha);
    }
    gl.useProgram(this.flat);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.DYNAMIC_DRAW);
    this.attribute(this.flat, "place", 3, 7, 0, 0);
    this.attribute(this.flat, "colour", 4, 7, 3, 0);
    gl.drawArrays(gl.TRIANGLES, 0, corners.length);
  }
}

// Draws the same on a plain canvas, from back to front.
class Plain {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
  }
  draw(camera, shapes) {
    const { width, height } = this.canvas, c = this.context, pixels = height / 2;
    c.clearRect(0, 0, width, height);
    const place = (p) => {
      const [x, y, z] = camera.seen(p);
      return [width / 2 + x * pixels, height / 2 - y * pixels, z];
    };
    const css = (colour, alpha = 1) => `rgba(${colour.map((x) => Math.round(255 * x)).join(",")},${alpha})`;
    const ratio = height / this.canvas.clientHeight;
    const items = [];
    for (const e of shapes.ellipsoids) items.push([place(e.place)[2], () => this.ellipse(camera, e, place(e.place), pixels, css, 1)]);
    for (const m of shapes.meshes) items.push([place(m.origin)[2] + (m.alpha < 1 ? 1 : 0), () => this.mesh(m, camera, place, css)]);
    for (const e of shapes.bags) items.push([place(e.place)[2], () => this.ellipse(camera, e, place(e.place), pixels, css, 0.25)]);
    for (const f of shapes.faces) {
      const corners = f.corners.map(place);
      items.push([Math.max(...corners.map((p) => p[2])), () => {
        c.beginPath();
        corners.forEach((p) => c.lineTo(p[0], p[1]));
        c.closePath();
        c.fillStyle = css(f.colour, f.alpha);
        c.fill();
      }]);
    }
    for (const s of shapes.strokes) {
      const [a, b] = [place(s.from), place(s.to)];
      items.push([s.above ? -1e9 : 0.5 * (a[2] + b[2]), () => {
        c.strokeStyle = css(s.colour);
        c.lineWidth = s.width * ratio;
        c.lineCap = "round";
        c.beginPath();
        c.moveTo(a[0], a[1]);
        c.lineTo(b[0], b[1]);
        c.stroke();
        const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
        if (s.head && length > 1) {
          const [ux, uy] = [((b[0] - a[0]) / length) * 3.5 * c.lineWidth, ((b[1] - a[1]) / length) * 3.5 * c.lineWidth];
          c.fillStyle = c.strokeStyle;
          c.beginPath();
          c.moveTo(b[0], b[1]);
          c.lineTo(b[0] - ux - 0.6 * uy, b[1] - uy + 0.6 * ux);
          c.lineTo(b[0] - ux + 0.6 * uy, b[1] - uy - 0.6 * ux);
          c.fill();
        }
      }]);
    }
    items.sort((a, b) => b[0] - a[0]).forEach(([, paint]) => paint());
  }
  // Fills the triangles of a mesh from back to front.
  mesh({ mesh, origin, turn, colour, alpha }, camera, place, css) {
    const c = this.context, places = [];
    for (let i = 0; i < mesh.places.length; i += 3) places.push(add(origin, turned(turn, [mesh.places[i], mesh.places[i + 1], mesh.places[i + 2]])));
    const all = [];
    for (let i = 0; i < mesh.corners.length; i += 3) {
      const three = [0, 1, 2].map((k) => places[mesh.corners[i + k]]), normal = cross(sub(three[1], three[0]), sub(three[2], three[0]));
      const seen = three.map(place);
      all.push([seen[0][2] + seen[1][2] + seen[2][2], seen, 0.45 + 0.55 * Math.abs(dot(normal, camera.forward)) / (norm(normal) || 1)]);
    }
    all.sort((a, b) => b[0] - a[0]);
    for (const [, seen, light] of all) {
      c.beginPath();
      seen.forEach((p) => c.lineTo(p[0], p[1]));
      c.closePath();
      c.fillStyle = css(scale(colour, light), alpha);
      c.fill();
      if (alpha < 1) continue;
      // no gap between neighbours
      c.strokeStyle = c.fillStyle;
      c.lineWidth = 1;
      c.stroke();
    }
  }
  ellipse(camera, e, [x, y], pixels, css, alpha) {
    const c = this.context;
    const parts = e.axes.map((axis) => [dot(axis, camera.right), dot(axis, camera.up)]);
    const entry = (i, j) => parts.reduce((sum, part) => sum + part[i] * part[j], 0);
    const [xx, xy, yy] = [entry(0, 0), entry(0, 1), entry(1, 1)];
    const mean = (xx + yy) / 2, radius = Math.hypot((xx - yy) / 2, xy);
    const long = (Math.sqrt(mean + radius) / camera.half) * pixels, short = (Math.sqrt(Math.max(0, mean - radius)) / camera.half) * pixels;
    c.beginPath();
    c.ellipse(x, y, long, short, -0.5 * Math.atan2(2 * xy, xx - yy), 0, 2 * Math.PI);
    c.fillStyle = css(mixed(e.colour, [1, 1, 1], 0.35), alpha);
    c.fill();
    c.strokeStyle = css(mixed(e.colour, [0, 0, 0], 0.35));
    c.lineWidth = 1.5;
    c.stroke();
  }
}
