//! A run as an animation in glTF 2.0: one binary file that Blender, game engines and viewers on the web open.
//!
//! Every body is a node with keyframes of its position and its rotation, with less than a quarter turn from one to the
//! next; its ellipsoids, bones and planes are meshes on nodes below it. A belt or a spring is made of rods; keyframes
//! rotate and stretch each from one end to the other. A belt has its rods in several colours and widths, by force, one
//! of which is there at a time: the others have the scale 0, by which glTF 2.0 (3.7.3.1) hides nodes. A camera moves
//! with the body that the view [stays with](Scene::followed). All nodes are below one node that rotates z up into y up,
//! as glTF requires. Units are metres and seconds.

mod file;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod plate;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod shape;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod turn;

use crate::pose::{Frame, Vec3, cross, quaternion};
use crate::scene::{LineKind, Scene};
use file::File;
use plate::Plate;
use serde_json::json;
use shape::Shape;
use turn::{Quaternion, along, continuous, turn};

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

/// Colours of a slack belt and of one that pulls with the largest force, and the number of steps between nothing and
/// that force.
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

impl File<'_> {
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

    /// Adds rods within bodies that have no ellipsoid and no mesh. Rods between two bodies, of sliding joints, are left
    /// out.
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
        let belts = scene
            .lines
            .iter()
            .filter(|line| line.kind == LineKind::Belt);
        let pulls = belts.flat_map(|belt| belt.pulls.iter().flatten());
        let largest = pulls.fold(0.0, |most: f64, pull| pull.max(most));
        for line in &scene.lines {
            for segment in 0..line.points.len() - 1 {
                let name = match line.points.len() {
                    2 => line.name.clone(),
                    _ => format!("{}, segment {}", line.name, segment + 1),
                };
                let steps: Vec<usize> = match (line.kind, line.pulls.get(segment)) {
                    (LineKind::Belt, Some(pulls)) => {
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

    /// The looks of a line that is at these steps of force: mesh and radius of each, and the times and scales by which
    /// it is there.
    fn looks(&mut self, kind: LineKind, steps: &[usize]) -> Vec<(usize, f64, Option<Shows>)> {
        if kind != LineKind::Belt {
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
}
