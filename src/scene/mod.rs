//! A motion as it is seen: bodies with their shapes, and what acts between them, at every time. Pictures, the page of a report and animations are made of this.
//! What a law looks like is said by the law ([`Outputs::looks`](bryant_generator::law::Outputs::looks)).

mod bones;
mod camera;
pub mod mesh;
mod planes;
mod route;

use crate::picture::Instant;
use crate::pose::{Frame, Layout, Mismatch, Numbers, Pose, Vec3, bryant_rotation, dot};
use bryant_generator::law::{self, Look, Round};
use bryant_generator::model::{
    Active, Attachment, BeltLength, Body, Dimension, ElementId, Force, Model, Number, Output,
    Quantity, Reference, Shown,
};
use planes::Planes;

/// A motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Whether it is in the plane x–z.
    pub planar: bool,
    /// The elements, system by system, then the vehicles.
    pub bodies: Vec<Named>,
    /// \[s\]
    pub times: Vec<f64>,
    /// By time, the frame of each body.
    pub frames: Vec<Vec<Frame>>,
    /// Lines from joint to joint.
    pub bones: Vec<[Place; 2]>,
    /// Centres of gravity of elements that carry no other.
    pub masses: Vec<Place>,
    /// Points that outputs refer to, each by the first of them.
    pub points: Vec<(String, Place)>,
    /// Each once.
    pub ellipsoids: Vec<Ellipsoid>,
    /// Whether some of them are in no contact.
    pub some_meet_nothing: bool,
    /// Each once.
    pub planes: Vec<Plane>,
    /// Belts, springs and bushings.
    pub lines: Vec<Line>,
    /// Meshes of files; none at first.
    pub meshes: Vec<mesh::Mesh>,
    /// By time, the forces on ellipsoids.
    pub pushes: Vec<Vec<Push>>,
}

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Its name: `man/head`, `car`.
    pub name: String,
    /// The index of its system; `None` for a vehicle.
    pub system: Option<usize>,
    /// The body that carries it, a vehicle among them.
    pub parent: Option<usize>,
}

/// A point of a body; without a body, of the absolute frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Index of the body.
    pub body: Option<usize>,
    /// Local frame \[m\].
    pub at: Vec3,
}

/// An ellipsoid.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Its centre.
    pub center: Place,
    /// Its axes in the frame of the body, by rows.
    pub turn: [Vec3; 3],
    /// Its semi-axes \[m\]; of a planar scene the second is the smaller of the others.
    pub semi: Vec3,
    /// n of Σ |x_i/a_i|ⁿ = 1
    pub degree: u32,
    /// Of a bag, by time: the volume of its gas over that of the ellipsoid. Empty where it is not known.
    pub fill: Option<Vec<f64>>,
}

/// A piece of a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Name of the first force of it.
    pub name: String,
    /// The body that carries it.
    pub body: Option<usize>,
    /// In order around it, local frame \[m\].
    pub corners: [Vec3; 4],
    /// To the side of the ellipsoids, local frame.
    pub normal: Vec3,
}

/// What pulls along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A belt.
    Belt,
    /// A spring.
    Spring,
    /// A bushing.
    Bushing,
}

/// Straight segments from point to point.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Name of the force.
    pub name: String,
    /// What pulls.
    pub kind: Kind,
    /// Both ends, and rings between them.
    pub points: Vec<Place>,
    /// Of a belt, the untensioned length at the start \[m\].
    pub length: Option<f64>,
    /// By segment and time, the force \[N\]; empty where forces are not known.
    pub pulls: Vec<Vec<f64>>,
    /// Of a belt in space, by segment and time: points on the way over the bodies that it is on, as many at all times.
    ways: Vec<Vec<Vec<Vec3>>>,
}

/// A force on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Index of the force in the model.
    pub force: usize,
    /// Where it acts, absolute \[m\].
    pub at: Vec3,
    /// Absolute \[N\].
    pub on_body: Vec3,
}

/// The model with additional outputs after its own: what a scene with forces has to know ([`Look::asks`]), force by force.
pub fn with_forces(model: &Model) -> Model {
    let mut model = model.clone();
    for (index, force) in model.forces.iter().enumerate() {
        let asked = force.kind.looks().into_iter();
        for quantity in asked.flat_map(|look| look.asks(index)) {
            let unit = match quantity {
                Quantity::OfForce { .. } => "m^3",
                _ => "N",
            };
            model.outputs.push(Output {
                name: format!("scene {}", model.outputs.len()),
                quantity,
                unit: unit.into(),
                code: None,
                filter: None,
                channel: None,
            });
        }
    }
    model
}

/// Whether a scene without forces does not show how full bags are, or which belts are taut: those whose untensioned length changes, or that act at times.
pub fn needs_forces(model: &Model) -> bool {
    let changes = |force: &Force| {
        force.kind.looks().into_iter().any(|look| match look {
            Look::Bag(..) => true,
            Look::Line(law::Line::Belt(belt), _) => {
                let pays_out = belt.retractor.is_some() || belt.limiter.is_some();
                pays_out || belt.pretensioner.is_some() || force.active != Active::default()
            }
            _ => false,
        })
    };
    model.forces.iter().any(changes)
}

/// The columns that [`with_forces`] adds, read one after the other: each has a value for each time.
struct Columns<'a>(std::slice::Iter<'a, Vec<f64>>);

impl<'a> Columns<'a> {
    fn next(&mut self) -> &'a [f64] {
        self.0.next().map_or(&[], Vec::as_slice)
    }

    /// A vector for each time, if there are columns.
    fn vector(&mut self) -> Option<impl Fn(usize) -> Vec3 + use<'a>> {
        let columns = [self.next(), self.next(), self.next()];
        let known = columns.iter().all(|column| !column.is_empty());
        known.then_some(move |k| columns.map(|column: &[f64]| column[k]))
    }
}

/// The bodies of a model in one list.
pub struct Bodies<'a> {
    model: &'a Model,
    /// Index of the first body of each system; vehicles follow after all elements.
    first: Vec<usize>,
    elements: usize,
}

impl<'a> Bodies<'a> {
    /// Those of a model.
    pub fn of(model: &'a Model) -> Self {
        let mut elements = 0;
        let first = model.systems.iter().map(|system| {
            elements += system.elements.len();
            elements - system.elements.len()
        });
        let first = first.collect();
        Bodies {
            model,
            first,
            elements,
        }
    }

    fn ids(&self) -> impl Iterator<Item = ElementId> + '_ {
        let systems = self.model.systems.iter().enumerate();
        systems.flat_map(|(system, of)| {
            (0..of.elements.len()).map(move |element| ElementId { system, element })
        })
    }

    fn all(&self) -> impl Iterator<Item = Body> + '_ {
        let vehicles = (0..self.model.vehicles.len()).map(Body::Vehicle);
        self.ids().map(Body::Element).chain(vehicles)
    }

    /// The index of a body; `None` for the frame.
    pub fn index(&self, body: Body) -> Option<usize> {
        match body {
            Body::Frame => None,
            Body::Element(id) => Some(self.first[id.system] + id.element),
            Body::Vehicle(index) => Some(self.elements + index),
        }
    }

    fn named(&self) -> Vec<Named> {
        let named = |body| match body {
            Body::Element(ElementId { system, element }) => {
                let of = &self.model.systems[system];
                Named {
                    name: format!("{}/{}", of.name, of.elements[element].name),
                    system: Some(system),
                    parent: match (of.elements[element].parent, &of.reference) {
                        (Some(parent), _) => Some(self.first[system] + parent),
                        (None, Reference::Riding { vehicle, .. }) => {
                            self.index(Body::Vehicle(*vehicle))
                        }
                        (None, _) => None,
                    },
                }
            }
            Body::Vehicle(index) => Named {
                name: self.model.vehicles[index].name.clone(),
                system: None,
                parent: None,
            },
            Body::Frame => unreachable!("it is no body of the list"),
        };
        self.all().map(named).collect()
    }
}

impl Scene {
    /// A motion through these instants. `coordinates` are the names of q, `parameters` the values of the run (SI, in the model's order). `forces` has a column for
    /// each output that [`with_forces`] adds, with a value for each instant, or no column.
    ///
    /// Instants with coordinates that are not finite are left out: of a failed run there is what was before its failure.
    ///
    /// # Errors
    /// The coordinates do not belong to the model.
    pub fn new(
        model: &Model,
        coordinates: &[String],
        parameters: &[f64],
        instants: &[Instant],
        forces: &[Vec<f64>],
    ) -> Result<Self, Mismatch> {
        let layout = Layout::new(model, coordinates)?;
        let finite = |instant: &&Instant| instant.coordinates.iter().all(|q| q.is_finite());
        let poses = instants.iter().filter(finite).filter_map(|instant| {
            let q = &instant.coordinates;
            let pose = Pose::new(model, &layout, parameters, instant.time, q)?;
            Some((instant.time, pose))
        });
        let (times, poses): (Vec<f64>, Vec<Pose>) = poses.unzip();
        let bodies = Bodies::of(model);
        let numbers = Numbers { model, parameters };
        let frame_of = |pose: &Pose| bodies.all().map(|body| pose.body(body)).collect();
        let (bones, masses) = bones::bones(&bodies, numbers);
        let mut scene = Scene {
            planar: model.dimension == Dimension::Plane,
            bodies: bodies.named(),
            frames: poses.iter().map(frame_of).collect(),
            bones,
            masses,
            points: Vec::new(),
            ellipsoids: Vec::new(),
            some_meet_nothing: model.shown.iter().any(|s| matches!(s, Shown::Round(..))),
            planes: Vec::new(),
            lines: Vec::new(),
            meshes: Vec::new(),
            pushes: vec![Vec::new(); times.len()],
            times,
        };
        Builder {
            bodies,
            numbers,
            scene: &mut scene,
        }
        .add(forces);
        Ok(scene)
    }

    /// Frame of a body at a time.
    pub fn frame(&self, k: usize, body: Option<usize>) -> Frame {
        body.map_or(Frame::ABSOLUTE, |body| self.frames[k][body])
    }

    /// Position of a point at a time \[m\].
    pub fn point(&self, k: usize, place: Place) -> Vec3 {
        self.frame(k, place.body).point(place.at)
    }

    /// The system of a body; `None` for the frame and vehicles.
    pub fn system(&self, body: Option<usize>) -> Option<usize> {
        self.bodies[body?].system
    }

    /// The semi-axes of an ellipsoid as vectors at a time \[m\]; a bag is as large as its gas.
    pub fn axes(&self, k: usize, ellipsoid: &Ellipsoid) -> [Vec3; 3] {
        let frame = self.frame(k, ellipsoid.center.body);
        let size = ellipsoid.size(k);
        std::array::from_fn(|j| {
            frame.direction(std::array::from_fn(|i| {
                ellipsoid.turn[i][j] * ellipsoid.semi[j] * size
            }))
        })
    }

    /// The points of a segment of a line at a time: both ends, and those between them by which it goes over bodies.
    pub fn path(&self, k: usize, line: &Line, segment: usize) -> Vec<Vec3> {
        let [from, to] = [0, 1].map(|end| self.point(k, line.points[segment + end]));
        let between = line.ways[segment].get(k).into_iter().flatten().copied();
        std::iter::once(from).chain(between).chain([to]).collect()
    }

    /// Whether a segment of a belt is taut at a time: by its force, or by the untensioned length at the start where forces are not known.
    pub fn taut(&self, k: usize, line: &Line, segment: usize) -> bool {
        if let Some(pulls) = line.pulls.get(segment) {
            return pulls[k] > 0.0;
        }
        let points: Vec<Vec3> = line.points.iter().map(|p| self.point(k, *p)).collect();
        line.length.is_none_or(|length| way(&points) > length)
    }
}

impl Ellipsoid {
    /// Factor on the semi-axes of a bag at a time: the cube root of its fill.
    pub fn size(&self, k: usize) -> f64 {
        let fill = self.fill.as_ref().and_then(|fill| fill.get(k));
        fill.map_or(1.0, |fill| libm::cbrt(fill.clamp(0.0, 1.0)))
    }
}

/// A part of a scene that is not finished.
struct Builder<'a> {
    bodies: Bodies<'a>,
    numbers: Numbers<'a>,
    scene: &'a mut Scene,
}

impl Builder<'_> {
    fn add(mut self, forces: &[Vec<f64>]) {
        let model = self.bodies.model;
        let mut columns = Columns(forces.iter());
        let mut planes = Planes::default();
        for (index, force) in model.forces.iter().enumerate() {
            for look in force.kind.looks() {
                self.look((index, &force.name), look, &mut columns, &mut planes);
            }
        }
        for look in model.shown.iter().filter_map(Shown::look) {
            let none = (model.forces.len(), "surface");
            self.look(none, look, &mut columns, &mut planes);
        }
        debug_assert!(columns.0.len() == 0);
        self.scene.planes = planes.finish();
        if !self.scene.planar {
            let scene = &mut *self.scene;
            let ways = |line: &Line| match line.kind {
                Kind::Belt => route::ways(scene, &line.points),
                _ => line.ways.clone(),
            };
            let ways: Vec<_> = scene.lines.iter().map(ways).collect();
            for (line, ways) in scene.lines.iter_mut().zip(ways) {
                line.ways = ways;
            }
        }
        self.points();
    }

    /// Adds a part of the force with this index and name.
    fn look(
        &mut self,
        (index, name): (usize, &str),
        look: Look<'_>,
        columns: &mut Columns<'_>,
        planes: &mut Planes,
    ) {
        match look {
            Look::Round(round) => self.ellipsoid(round, None),
            Look::Bag(round, _) => self.ellipsoid(round, Some(columns.next().to_vec())),
            Look::Plane(plane, round) => {
                planes.add(name, (plane, round), &self.bodies, self.numbers, self.scene);
            }
            Look::Push(round, plane) => {
                let normal = plane.map(|plane| {
                    let body = self.bodies.index(plane.at.on);
                    (body, self.numbers.vector(&plane.normal))
                });
                if let Some(force) = columns.vector() {
                    self.pushes(index, round, normal, force);
                }
            }
            Look::Line(kind, points) => {
                let vectors = (1..points.len()).filter_map(|_| columns.vector());
                let vectors: Vec<_> = vectors.collect();
                self.line(name, kind, &points, &vectors);
            }
        }
    }

    fn place(&self, attachment: &Attachment) -> Place {
        Place {
            body: self.bodies.index(attachment.on),
            at: self.numbers.vector(&attachment.at),
        }
    }

    fn round(&self, round: Round<'_>) -> Ellipsoid {
        let mut semi = self.numbers.vector(round.semi_axes);
        if self.scene.planar {
            semi[1] = semi[0].min(semi[2]);
        }
        Ellipsoid {
            center: self.place(round.center),
            turn: bryant_rotation(self.numbers.vector(round.axes)),
            semi,
            degree: round.degree,
            fill: None,
        }
    }

    /// Adds an ellipsoid, even if several forces have it once. `volume` is that of the gas in a bag.
    fn ellipsoid(&mut self, round: Round<'_>, volume: Option<Vec<f64>>) {
        let mut ellipsoid = self.round(round);
        let full = 4.0 / 3.0 * std::f64::consts::PI * ellipsoid.semi.iter().product::<f64>();
        ellipsoid.fill = volume.map(|volume| volume.iter().map(|v| v / full).collect());
        if !self.scene.ellipsoids.contains(&ellipsoid) {
            self.scene.ellipsoids.push(ellipsoid);
        }
    }

    fn line(
        &mut self,
        name: &str,
        kind: law::Line<'_>,
        points: &[&Attachment],
        forces: &[impl Fn(usize) -> Vec3],
    ) {
        let points: Vec<Place> = points.iter().map(|point| self.place(point)).collect();
        let scene = &mut *self.scene;
        let at = |k: usize, i: usize| scene.point(k, points[i]);
        let pulls = forces.iter().enumerate().map(|(i, force)| {
            let pull = |k| {
                let along = from_to(at(k, i), at(k, i + 1));
                dot(force(k), along) / length(along).max(1e-12)
            };
            (0..scene.times.len()).map(pull).collect()
        });
        let pulls = pulls.collect();
        let (kind, length) = match kind {
            law::Line::Belt(belt) if !scene.times.is_empty() => {
                let points: Vec<Vec3> = (0..points.len()).map(|i| at(0, i)).collect();
                (
                    Kind::Belt,
                    Some(untensioned(self.numbers, belt, way(&points))),
                )
            }
            law::Line::Belt(_) => (Kind::Belt, None),
            law::Line::Spring => (Kind::Spring, None),
            law::Line::Bushing => (Kind::Bushing, None),
        };
        scene.lines.push(Line {
            name: name.to_owned(),
            kind,
            ways: vec![Vec::new(); points.len() - 1],
            points,
            length,
            pulls,
        });
    }

    /// Adds the forces on the body of an ellipsoid at all times. `normal` is that of the plane that it meets, with its body.
    fn pushes(
        &mut self,
        index: usize,
        round: Round<'_>,
        normal: Option<(Option<usize>, Vec3)>,
        force: impl Fn(usize) -> Vec3,
    ) {
        let ellipsoid = self.round(round);
        for k in 0..self.scene.times.len() {
            let on_body = force(k);
            if dot(on_body, on_body) == 0.0 || !on_body.iter().all(|f| f.is_finite()) {
                continue;
            }
            let normal = normal.map_or(on_body, |(body, normal)| {
                self.scene.frame(k, body).direction(normal)
            });
            let at = self.scene.deepest(k, &ellipsoid, normal);
            self.scene.pushes[k].push(Push {
                force: index,
                at,
                on_body,
            });
        }
    }

    /// Adds the points that outputs refer to.
    fn points(&mut self) {
        for output in &self.bodies.model.outputs {
            let Quantity::Point { body, at, .. } = &output.quantity else {
                continue;
            };
            let place = Place {
                body: self.bodies.index(*body),
                at: self.numbers.vector(at),
            };
            if !self.scene.points.iter().any(|(_, known)| *known == place) {
                let name = format!("point of {}", output.name);
                self.scene.points.push((name, place));
            }
        }
    }
}

impl Scene {
    /// The point of an ellipsoid that is farthest in the direction −n: c − Q n/√(nᵀQ n).
    fn deepest(&self, k: usize, ellipsoid: &Ellipsoid, normal: Vec3) -> Vec3 {
        let (mut sum, mut squared) = ([0.0; 3], 0.0);
        for (axis, vector) in self.axes(k, ellipsoid).into_iter().enumerate() {
            if self.planar && axis == 1 {
                continue;
            }
            let along = dot(vector, normal);
            squared += along * along;
            sum = std::array::from_fn(|i| sum[i] + along * vector[i]);
        }
        let c = self.point(k, ellipsoid.center);
        let size = squared.sqrt().max(1e-300);
        std::array::from_fn(|i| c[i] - sum[i] / size)
    }
}

/// Untensioned length of a belt whose points are `initial` apart at the start \[m\].
fn untensioned(numbers: Numbers<'_>, belt: &bryant_generator::model::Belt, initial: f64) -> f64 {
    let value = |number: &Number| numbers.value(number);
    match &belt.length {
        BeltLength::Given(length) => value(length),
        BeltLength::Slack(slack) => initial + value(slack),
        BeltLength::Pretension(force) => {
            let curve = &numbers.model.curves[belt.force.curve];
            let ordinate = value(force) / value(&belt.force.times);
            let elongation = value(&belt.force.stretch) * curve.inverse(ordinate);
            initial / (1.0 + elongation)
        }
    }
}

/// From one point to another.
pub fn from_to(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| b[i] - a[i])
}

/// Length of a vector.
pub fn length(vector: Vec3) -> f64 {
    dot(vector, vector).sqrt()
}

/// Length of the line through these points.
fn way(points: &[Vec3]) -> f64 {
    let pairs = points.windows(2);
    pairs.map(|ends| length(from_to(ends[0], ends[1]))).sum()
}
