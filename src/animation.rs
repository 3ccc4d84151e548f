//! A run as an animation in glTF 2.0: one binary file that Blender, game engines and viewers on the web open.
//!
//! Every body is a node with keyframes of its position and its rotation, with less than a quarter turn from one to the next; its ellipsoids, bones and planes are
//! meshes on nodes below it. A belt or a spring is made of rods; keyframes rotate and stretch each from one end to the other. A belt has its rods in several colours
//! and widths, by force, one of which is there at a time: the others have the scale 0, by which glTF 2.0 (3.7.3.1) hides nodes. A camera moves with the body that the
//! view [stays with](Scene::followed). All nodes are below one node that rotates z up into y up, as glTF requires. Units are metres and seconds.

mod plate;

use crate::pose::{Frame, Vec3, cross, quaternion};
use crate::scene::{Kind, Scene, from_to, length};
use plate::Plate;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// (x, y, z, w), as glTF has it.
type Quaternion = [f64; 4];

/// Number of circles of latitude and of longitude on a sphere.
const AROUND: (usize, usize) = (16, 24);

/// Number of sides of a rod.
const SIDES: usize = 10;

/// Radius of bones, of springs and slack belts, and what the largest force adds to that of a belt \[m\].
const OF_BONES: f64 = 0.008;
const THIN: f64 = 0.006;
const THICK: f64 = 0.008;

/// Colours, safe for the colour-blind: of systems, vehicles, planes, and belts, springs and bushings.
const COLOURS: [[f64; 4]; 4] = [
    [0.0, 0.29, 0.48, 1.0],
    [0.70, 0.35, 0.0, 1.0],
    [0.0, 0.42, 0.30, 1.0],
    [0.45, 0.25, 0.45, 1.0],
];
const OF_VEHICLES: [f64; 4] = [0.45, 0.47, 0.5, 1.0];
const OF_PLANES: [f64; 4] = [0.55, 0.57, 0.6, 0.35];
const OF_SPRINGS: [f64; 4] = [0.20, 0.08, 0.30, 1.0];
const OF_BAGS: [f64; 4] = [0.11, 0.16, 0.22, 0.3];

/// Colours of a slack belt and of one that pulls with the largest force, and the number of steps between nothing and that force.
const SLACK: [f64; 4] = [0.32, 0.37, 0.42, 1.0];
const LEAST: [f64; 4] = [0.79, 0.35, 0.0, 1.0];
const MOST: [f64; 4] = [0.43, 0.0, 0.014, 1.0];
const STEPS: usize = 6;

/// The camera sees half this angle above and below its middle, and this many times what has to be seen \[rad\].
const OPENING: f64 = 0.5;
const ROOM: f64 = 1.1;

/// The bytes of an animation.
///
/// # Errors
/// There are fewer than two instants.
pub fn glb(title: &str, scene: &Scene) -> Result<Vec<u8>, String> {
    if scene.times.len() < 2 {
        return Err("an animation needs at least two instants of the run".into());
    }
    let mut file = File::new(title, scene);
    file.bodies();
    file.ellipsoids();
    file.bones();
    file.planes();
    file.meshes();
    file.lines();
    file.camera();
    Ok(file.finish())
}

/// By how much each body of a scene turns at least from each instant to the next, instant by instant \[rad\].
pub fn turns(scene: &Scene) -> Vec<Vec<f64>> {
    let between = |pair: &[Vec<Frame>]| {
        let angle = |(a, b): (&Frame, &Frame)| {
            let [a, b] = [a, b].map(|frame| quaternion(frame.rotation));
            let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
            2.0 * libm::acos(product.abs().min(1.0))
        };
        pair[0].iter().zip(&pair[1]).map(angle).collect()
    };
    scene.frames.windows(2).map(between).collect()
}

/// The accessors of times and scales that show a node and hide it, and whether it is there at first.
struct Shows {
    input: usize,
    output: usize,
    at_first: bool,
}

/// A glTF file under construction.
struct File<'a> {
    scene: &'a Scene,
    json: Value,
    binary: Vec<u8>,
    /// The accessor of the times.
    times: usize,
    /// The node of each body.
    bodies: Vec<usize>,
    /// Meshes of unit size with their colours: spheres and rods.
    meshes: Vec<(Shape, [f64; 4], usize)>,
    shapes: Vec<(Shape, Accessors)>,
}

/// The accessors of places, of normals if there are any, and of indices.
type Accessors = (usize, Option<usize>, usize);

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    /// A sphere of radius 1, or a cube with rounded edges: the degree of its equation.
    Sphere(u32),
    /// A rod of radius 1 along z, from 0 to 1.
    Rod,
}

impl<'a> File<'a> {
    fn new(title: &str, scene: &'a Scene) -> Self {
        let half = f64::sqrt(0.5);
        let mut file = File {
            scene,
            json: json!({
                "asset": { "version": "2.0", "generator": format!("bryant {}", env!("CARGO_PKG_VERSION")) },
                "scene": 0,
                "scenes": [{ "name": title, "nodes": [0] }],
                "nodes": [{ "name": title, "rotation": [-half, 0.0, 0.0, half], "children": [] }],
                "meshes": [],
                "materials": [],
                "cameras": [],
                "accessors": [],
                "bufferViews": [],
                "animations": [{ "name": "run", "channels": [], "samplers": [] }],
            }),
            binary: Vec::new(),
            times: 0,
            bodies: Vec::new(),
            meshes: Vec::new(),
            shapes: Vec::new(),
        };
        // players expect that times begin at 0
        let times = scene.times.iter();
        let relative: Vec<f64> = times.map(|t| t - scene.times[0]).collect();
        file.times = file.floats(&relative, 1, None);
        file
    }

    fn list(&mut self, key: &str) -> &mut Vec<Value> {
        match &mut self.json[key] {
            Value::Array(list) => list,
            _ => unreachable!("all lists are made by `new`"),
        }
    }

    fn add(&mut self, key: &str, value: Value) -> usize {
        let list = self.list(key);
        list.push(value);
        list.len() - 1
    }

    /// Adds a node below another one.
    fn node(&mut self, parent: usize, node: Value) -> usize {
        let index = self.add("nodes", node);
        let children = &mut self.json["nodes"][parent]["children"];
        match children {
            Value::Array(list) => list.push(json!(index)),
            other => *other = json!([index]),
        }
        index
    }

    /// Adds bytes to the buffer.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        while !self.binary.len().is_multiple_of(4) {
            self.binary.push(0);
        }
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.binary.extend_from_slice(bytes);
        self.add("bufferViews", view)
    }

    /// Adds an accessor of numbers, `width` of them in each entry, with their bounds.
    fn floats(&mut self, values: &[f64], width: usize, target: Option<u32>) -> usize {
        let single: Vec<f32> = values.iter().map(|value| *value as f32).collect();
        let bytes: Vec<u8> = single
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let view = self.view(&bytes, target);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        let of = |k: usize, first: f32, better: fn(f32, f32) -> f32| {
            single
                .iter()
                .skip(k)
                .step_by(width)
                .copied()
                .fold(first, better)
        };
        let low: Vec<f32> = (0..width).map(|k| of(k, f32::INFINITY, f32::min)).collect();
        let high: Vec<f32> = (0..width)
            .map(|k| of(k, f32::NEG_INFINITY, f32::max))
            .collect();
        let accessor = json!({
            "bufferView": view,
            "componentType": 5126,
            "count": values.len() / width,
            "type": kind,
            "min": low,
            "max": high,
        });
        self.add("accessors", accessor)
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices
            .iter()
            .flat_map(|index| index.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(34963));
        let accessor = json!({ "bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR" });
        self.add("accessors", accessor)
    }

    /// The accessors of places, normals and indices.
    fn triangles(&mut self, places: &[Vec3], normals: &[Vec3], indices: &[u32]) -> Accessors {
        let places = self.floats(places.as_flattened(), 3, Some(34962));
        let normals = self.floats(normals.as_flattened(), 3, Some(34962));
        (places, Some(normals), self.indices(indices))
    }

    fn mesh(
        &mut self,
        name: &str,
        (places, normals, indices): Accessors,
        colour: [f64; 4],
    ) -> usize {
        let mut material = json!({
            "pbrMetallicRoughness": { "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.8 },
            "doubleSided": true,
        });
        if colour[3] < 1.0 {
            material["alphaMode"] = json!("BLEND");
        }
        let known = self
            .list("materials")
            .iter()
            .position(|other| *other == material);
        let material = match known {
            Some(index) => index,
            None => self.add("materials", material),
        };
        let mut attributes = json!({ "POSITION": places });
        if let Some(normals) = normals {
            attributes["NORMAL"] = json!(normals);
        }
        let primitive =
            json!({ "attributes": attributes, "indices": indices, "material": material });
        self.add("meshes", json!({ "name": name, "primitives": [primitive] }))
    }

    /// The mesh of a shape in a colour; each is made once.
    fn shape(&mut self, shape: Shape, colour: [f64; 4]) -> usize {
        if let Some((.., mesh)) = self
            .meshes
            .iter()
            .find(|(s, c, _)| *s == shape && *c == colour)
        {
            return *mesh;
        }
        let known = self.shapes.iter().find(|(s, _)| *s == shape);
        let accessors = match known.map(|(_, accessors)| *accessors) {
            Some(accessors) => accessors,
            None => {
                let (places, normals, indices) = match shape {
                    Shape::Sphere(degree) => sphere(degree),
                    Shape::Rod => rod(),
                };
                let accessors = self.triangles(&places, &normals, &indices);
                self.shapes.push((shape, accessors));
                accessors
            }
        };
        let name = match shape {
            Shape::Sphere(2) => "ellipsoid",
            Shape::Sphere(_) => "rounded box",
            Shape::Rod => "rod",
        };
        let mesh = self.mesh(name, accessors, colour);
        self.meshes.push((shape, colour, mesh));
        mesh
    }

    /// Adds keyframes of a node at all times. The first is also where the node rests: what shows the file without playing it shows the start.
    fn key(&mut self, node: usize, path: &str, values: &[f64], width: usize) {
        debug_assert_eq!(values.len(), width * self.scene.times.len());
        self.list("nodes")[node][path] = json!(values[..width]);
        let output = self.floats(values, width, None);
        self.channel(node, path, (self.times, output, "LINEAR"));
    }

    fn channel(&mut self, node: usize, path: &str, (input, output, how): (usize, usize, &str)) {
        let sampler = json!({ "input": input, "output": output, "interpolation": how });
        let channel = json!({ "node": node, "path": path });
        let animation = &mut self.json["animations"][0];
        let mut push = |key: &str, value: Value| match &mut animation[key] {
            Value::Array(list) => {
                list.push(value);
                list.len() - 1
            }
            _ => unreachable!("both lists are made by `new`"),
        };
        let sampler = push("samplers", sampler);
        push("channels", json!({ "sampler": sampler, "target": channel }));
    }

    /// Adds a node for each body, with its keyframes.
    fn bodies(&mut self) {
        let scene = self.scene;
        for (index, body) in scene.bodies.iter().enumerate() {
            let node = self.node(0, json!({ "name": body.name }));
            let frames = scene.frames.iter().map(|all| &all[index]);
            let places: Vec<f64> = frames.clone().flat_map(|frame| frame.origin).collect();
            let turns = continuous(frames.map(|frame| turn(frame.rotation)));
            self.key(node, "translation", &places, 3);
            self.key(node, "rotation", &turns.concat(), 4);
            self.bodies.push(node);
        }
    }

    /// The node of a body: that of the frame is above all others.
    fn node_of(&self, body: Option<usize>) -> usize {
        body.map_or(0, |body| self.bodies[body])
    }

    fn colour(&self, body: Option<usize>) -> [f64; 4] {
        let system = self.scene.system(body);
        system.map_or(OF_VEHICLES, |system| COLOURS[system % COLOURS.len()])
    }

    fn ellipsoids(&mut self) {
        for ellipsoid in &self.scene.ellipsoids {
            let body = ellipsoid.center.body;
            let (what, colour) = match ellipsoid.fill {
                Some(_) => ("bag", OF_BAGS),
                None => ("ellipsoid", self.colour(body)),
            };
            let mesh = self.shape(Shape::Sphere(ellipsoid.degree), colour);
            let node = json!({
                "name": self.part(body, what),
                "mesh": mesh,
                "translation": ellipsoid.center.at,
                "rotation": turn(ellipsoid.turn),
                "scale": ellipsoid.semi,
            });
            let node = self.node(self.node_of(body), node);
            if ellipsoid.fill.as_ref().is_some_and(|fill| !fill.is_empty()) {
                let sizes = (0..self.scene.times.len()).flat_map(|k| {
                    let size = ellipsoid.size(k);
                    ellipsoid.semi.map(|semi| size * semi)
                });
                self.key(node, "scale", &sizes.collect::<Vec<_>>(), 3);
            }
        }
    }

    /// Adds rods within bodies that have no ellipsoid and no mesh. Rods between two bodies, of sliding joints, are left out.
    fn bones(&mut self) {
        let scene = self.scene;
        let is_round = |body| {
            scene.ellipsoids.iter().any(|e| e.center.body == body)
                || scene.meshes.iter().any(|mesh| mesh.body == body)
        };
        for [from, to] in &scene.bones {
            let (turn, length) = along(from.at, to.at);
            if from.body != to.body || length == 0.0 || is_round(from.body) {
                continue;
            }
            let mesh = self.shape(Shape::Rod, self.colour(from.body));
            let scale = [OF_BONES, OF_BONES, length];
            let node = json!({
                "name": self.part(from.body, "bone"),
                "mesh": mesh,
                "translation": from.at,
                "rotation": turn,
                "scale": scale,
            });
            self.node(self.node_of(from.body), node);
        }
    }

    fn planes(&mut self) {
        for plane in &self.scene.planes {
            let plate = Plate::of(plane);
            let accessors = self.triangles(&plate.places, &plate.normals, &plate.corners);
            let name = format!("{} plane", plane.name);
            let mesh = self.mesh(&name, accessors, OF_PLANES);
            let node = json!({ "name": name, "mesh": mesh });
            self.node(self.node_of(plane.body), node);
        }
    }

    /// Adds meshes of files. Their corners have no normals: players make triangles flat then.
    fn meshes(&mut self) {
        let scene = self.scene;
        for mesh in &scene.meshes {
            let places = mesh.triangles.places.as_flattened();
            let places = self.floats(places, 3, Some(34962));
            let indices = self.indices(mesh.triangles.corners.as_flattened());
            let mut colour = self.colour(mesh.body);
            if scene.system(mesh.body).is_none() {
                colour[3] = OF_PLANES[3];
            }
            let name = self.part(mesh.body, &mesh.name);
            let shape = self.mesh(&name, (places, None, indices), colour);
            let node = json!({ "name": name, "mesh": shape });
            self.node(self.node_of(mesh.body), node);
        }
    }

    /// The name of a part of a body.
    fn part(&self, body: Option<usize>, what: &str) -> String {
        match body {
            Some(body) => format!("{} {what}", self.scene.bodies[body].name),
            None => format!("frame {what}"),
        }
    }

    /// Adds belts, springs and bushings: a node for each segment, below it a node for each rod.
    fn lines(&mut self) {
        let scene = self.scene;
        let belts = scene.lines.iter().filter(|line| line.kind == Kind::Belt);
        let pulls = belts.flat_map(|belt| belt.pulls.iter().flatten());
        let largest = pulls.fold(0.0, |most: f64, pull| pull.max(most));
        for line in &scene.lines {
            for segment in 0..line.points.len() - 1 {
                let name = match line.points.len() {
                    2 => line.name.clone(),
                    _ => format!("{}, segment {}", line.name, segment + 1),
                };
                let steps: Vec<usize> = match (line.kind, line.pulls.get(segment)) {
                    (Kind::Belt, Some(pulls)) => {
                        let step = |pull: &f64| (pull / largest * STEPS as f64).ceil() as usize;
                        pulls.iter().map(step).collect()
                    }
                    _ => vec![0; scene.times.len()],
                };
                let looks = self.looks(line.kind, &steps);
                let paths = (0..scene.times.len()).map(|k| scene.path(k, line, segment));
                let paths: Vec<Vec<Vec3>> = paths.collect();
                let node = self.node(0, json!({ "name": name }));
                for piece in 0..paths[0].len() - 1 {
                    let ends = paths.iter().map(|path| [path[piece], path[piece + 1]]);
                    self.rod(node, &name, &ends.collect::<Vec<_>>(), &looks);
                }
            }
        }
    }

    /// The looks of a line that is at these steps of force: mesh and radius of each, and the times and scales by which it is there.
    fn looks(&mut self, kind: Kind, steps: &[usize]) -> Vec<(usize, f64, Option<Shows>)> {
        if kind != Kind::Belt {
            return vec![(self.shape(Shape::Rod, OF_SPRINGS), THIN, None)];
        }
        let mut used = steps.to_vec();
        used.sort_unstable();
        used.dedup();
        let look = |step: usize| {
            let part = step as f64 / STEPS as f64;
            let colour = match step {
                0 => SLACK,
                _ => std::array::from_fn(|i| LEAST[i] + part * (MOST[i] - LEAST[i])),
            };
            let mesh = self.shape(Shape::Rod, colour);
            let shows = (used.len() > 1).then(|| self.shows(steps, step));
            (mesh, THIN + part * THICK, shows)
        };
        used.iter().copied().map(look).collect()
    }

    /// When a step of force is there: keyframes where that changes.
    fn shows(&mut self, steps: &[usize], step: usize) -> Shows {
        let there = |k: usize| steps[k] == step;
        let changes = (0..steps.len()).filter(|&k| k == 0 || there(k) != there(k - 1));
        let (mut times, mut scales) = (Vec::new(), Vec::new());
        for k in changes {
            times.push(self.scene.times[k] - self.scene.times[0]);
            scales.extend([f64::from(u8::from(there(k))); 3]);
        }
        Shows {
            input: self.floats(&times, 1, None),
            output: self.floats(&scales, 3, None),
            at_first: there(0),
        }
    }

    /// Adds a rod with its ends at all times, in all its looks.
    fn rod(
        &mut self,
        parent: usize,
        name: &str,
        ends: &[[Vec3; 2]],
        looks: &[(usize, f64, Option<Shows>)],
    ) {
        let rods: Vec<(Quaternion, f64)> = ends.iter().map(|[a, b]| along(*a, *b)).collect();
        let places: Vec<f64> = ends.iter().flat_map(|[from, _]| *from).collect();
        let scales = rods
            .iter()
            .flat_map(|(_, length)| [1.0, 1.0, length.max(1e-6)]);
        let node = self.node(parent, json!({ "name": format!("{name} rod") }));
        self.key(node, "translation", &places, 3);
        let turns = continuous(rods.iter().map(|(turn, _)| *turn));
        self.key(node, "rotation", &turns.concat(), 4);
        self.key(node, "scale", &scales.collect::<Vec<_>>(), 3);
        for (mesh, radius, shows) in looks {
            let wide = json!({ "mesh": mesh, "scale": [radius, radius, 1.0] });
            let Some(shows) = shows else {
                self.node(node, wide);
                continue;
            };
            let size = f64::from(u8::from(shows.at_first));
            let switch = self.node(node, json!({ "scale": [size, size, size] }));
            self.channel(switch, "scale", (shows.input, shows.output, "STEP"));
            self.node(switch, wide);
        }
    }

    /// Adds a camera that sees the whole motion, and stays with what the view stays with.
    fn camera(&mut self) {
        let scene = self.scene;
        let followed = scene.followed();
        let [low, high] = scene.around(followed);
        let [right, up] = scene.view().axes();
        let back = cross(right, up);
        let extent = |axis: Vec3| {
            (0..3)
                .map(|i| axis[i].abs() * (high[i] - low[i]))
                .sum::<f64>()
        };
        let seen = ROOM * 0.5 * extent(up).max(extent(right)).max(0.1);
        let away = seen / libm::tan(OPENING / 2.0) + 0.5 * extent(back);
        let middle: Vec3 = std::array::from_fn(|i| 0.5 * (low[i] + high[i]) + away * back[i]);
        let camera = self.add(
            "cameras",
            json!({
                "name": scene.view().name(),
                "type": "perspective",
                "perspective": { "yfov": OPENING, "znear": 0.01 * away, "zfar": 100.0 * away },
            }),
        );
        // the camera looks along its −z, with y upwards
        let rows = std::array::from_fn(|i| [right[i], up[i], back[i]]);
        let node = json!({ "name": "camera", "camera": camera, "rotation": turn(rows) });
        let node = self.node(0, node);
        let places = (0..scene.times.len()).flat_map(|k| {
            let travel = scene.travel(k, followed);
            [0, 1, 2].map(|i| middle[i] + travel[i])
        });
        let places: Vec<f64> = places.collect();
        match followed {
            Some(_) => self.key(node, "translation", &places, 3),
            None => self.list("nodes")[node]["translation"] = json!(places[..3]),
        }
    }

    /// The bytes of the file: a header, the JSON and the buffer, each a multiple of four bytes long.
    fn finish(mut self) -> Vec<u8> {
        while !self.binary.len().is_multiple_of(4) {
            self.binary.push(0);
        }
        self.json["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        // glTF has no empty lists
        if let Value::Object(map) = &mut self.json {
            map.retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        }
        let mut text = self.json.to_string().into_bytes();
        while !text.len().is_multiple_of(4) {
            text.push(b' ');
        }
        let total = 12 + 8 + text.len() + 8 + self.binary.len();
        let mut file = Vec::with_capacity(total);
        let word = |file: &mut Vec<u8>, word: u32| file.extend(word.to_le_bytes());
        for header in [0x4654_6C67, 2, total as u32, text.len() as u32, 0x4E4F_534A] {
            word(&mut file, header);
        }
        file.extend(text);
        word(&mut file, self.binary.len() as u32);
        word(&mut file, 0x004E_4942);
        file.extend(self.binary);
        file
    }
}

/// The rotation of a frame.
fn turn(rotation: [Vec3; 3]) -> Quaternion {
    let [w, x, y, z] = quaternion(rotation);
    [x, y, z, w]
}

fn unit(q: Quaternion) -> Quaternion {
    let size = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / size)
}

/// The rotation (x, y, z, w) of z into the direction from one point to another, and their distance.
fn along(from: Vec3, to: Vec3) -> (Quaternion, f64) {
    let d = from_to(from, to);
    let length = length(d);
    if length == 0.0 {
        return ([0.0, 0.0, 0.0, 1.0], 0.0);
    }
    let [x, y, z] = d.map(|x| x / length);
    // half way between z and the direction; a half turn about x if they are opposite
    match z < -1.0 + 1e-9 {
        true => ([1.0, 0.0, 0.0, 0.0], length),
        false => (unit([-y, x, 0.0, 1.0 + z]), length),
    }
}

/// Unit quaternions with the sign, q or −q, that is closer to the one before: players interpolate along the shorter way.
fn continuous(turns: impl IntoIterator<Item = Quaternion>) -> Vec<Quaternion> {
    let mut all: Vec<Quaternion> = Vec::new();
    for turn in turns {
        let turn = unit(turn);
        let far = all.last().is_some_and(|before| {
            let product: f64 = before.iter().zip(turn).map(|(a, b)| a * b).sum();
            product < 0.0
        });
        all.push(if far { turn.map(|x| -x) } else { turn });
    }
    all
}

/// Positions, normals and triangles of Σ |x_i|ⁿ = 1, a sphere if n is 2.
fn sphere(degree: u32) -> (Vec<Vec3>, Vec<Vec3>, Vec<u32>) {
    let (rings, sides) = AROUND;
    let n = f64::from(degree);
    let power = |x: f64, to: f64| libm::pow(x.abs(), to).copysign(x);
    let (mut places, mut normals) = (Vec::new(), Vec::new());
    for i in 0..=rings {
        let (sine, cosine) = libm::sincos(PI * i as f64 / rings as f64);
        for j in 0..=sides {
            let (y, x) = libm::sincos(TAU * j as f64 / sides as f64);
            let on_sphere = [sine * x, sine * y, cosine];
            if degree == 2 {
                places.push(on_sphere);
                normals.push(on_sphere);
                continue;
            }
            let place = on_sphere.map(|x| power(x, 2.0 / n));
            let normal = place.map(|x| power(x, n - 1.0));
            places.push(place);
            normals.push(normal.map(|x| x / length(normal)));
        }
    }
    let mut indices = Vec::new();
    let at = |i: usize, j: usize| (i * (sides + 1) + j) as u32;
    for i in 0..rings {
        for j in 0..sides {
            indices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            indices.extend([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (places, normals, indices)
}

/// Positions, normals and triangles of a rod, without its ends.
fn rod() -> (Vec<Vec3>, Vec<Vec3>, Vec<u32>) {
    let (mut places, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for j in 0..=SIDES {
        let (y, x) = libm::sincos(TAU * j as f64 / SIDES as f64);
        for z in [0.0, 1.0] {
            places.push([x, y, z]);
            normals.push([x, y, 0.0]);
        }
    }
    for j in 0..SIDES as u32 {
        let first = 2 * j;
        indices.extend([first, first + 2, first + 3, first, first + 3, first + 1]);
    }
    (places, normals, indices)
}

#[cfg(test)]
mod tests {
    use super::{along, continuous, rod, sphere};
    use crate::pose::{cross, rotation};

    #[test]
    fn a_rod_is_turned_from_one_end_to_the_other() {
        for to in [
            [0.3, -0.2, 0.9],
            [0.0, 0.0, -2.0],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 3.0],
        ] {
            let ([a, b, c, w], length) = along([0.0; 3], to);
            let tip = rotation(&[w, a, b, c]).map(|row| length * row[2]);
            assert!(
                tip.iter().zip(to).all(|(x, y)| (x - y).abs() < 1e-12),
                "{tip:?} {to:?}"
            );
        }
    }

    #[test]
    fn turns_do_not_jump() {
        let turns = continuous(vec![[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -0.1, -0.99]]);
        assert!(turns[1][3] > 0.0 && turns[1][2] > 0.0);
    }

    /// Triangles are counter-clockwise about their normals.
    #[test]
    fn meshes_look_outward() {
        for (places, normals, indices) in [sphere(2), sphere(8), rod()] {
            for three in indices.chunks(3) {
                let [a, b, c] = [0, 1, 2].map(|k| places[three[k] as usize]);
                let sides = [b, c].map(|p| std::array::from_fn(|i| p[i] - a[i]));
                let area = cross(sides[0], sides[1]);
                let outward: f64 = three
                    .iter()
                    .map(|k| normals[*k as usize])
                    .map(|n| n.iter().zip(area).map(|(n, a)| n * a).sum::<f64>())
                    .sum();
                assert!(outward >= -1e-12, "{three:?}");
            }
        }
    }
}
