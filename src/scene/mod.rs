//! A motion as it is seen: bodies with their shapes, and what acts between them, at every time. Pictures, the page of a
//! report and animations are made of this. What a law looks like is said by the law
//! ([`Visible::looks`](bryant_generator::model::law::Visible::looks)).

mod bodies;
mod bones;
mod build;
mod camera;
pub mod mesh;
mod planes;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod route;

use crate::picture::Instant;
use crate::pose::{Frame, Layout, Mismatch, Numbers, Pose, Vec3, dot};
use bryant_generator::law::types::Belt;
use bryant_generator::model::look::{self, Look};
use bryant_generator::model::{Active, Dimension, Force, Model, Output, Quantity, Shown};
use build::Builder;

pub use bodies::Bodies;

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
    pub bones: Vec<[BodyPoint; 2]>,
    /// Centres of gravity of elements that carry no other.
    pub masses: Vec<BodyPoint>,
    /// Points that outputs refer to, each by the first of them.
    pub points: Vec<(String, BodyPoint)>,
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
pub struct BodyPoint {
    /// Index of the body.
    pub body: Option<usize>,
    /// Local frame \[m\].
    pub at: Vec3,
}

/// An ellipsoid.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Its centre.
    pub center: BodyPoint,
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
pub enum LineKind {
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
    pub kind: LineKind,
    /// Both ends, and rings between them.
    pub points: Vec<BodyPoint>,
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

/// The model with additional outputs after its own: what a scene with forces has to know ([`Look::asks`]), force by
/// force.
pub fn with_forces(model: &Model) -> Model {
    let mut model = model.clone();
    for (index, force) in model.forces.iter().enumerate() {
        let asked = force.law.looks().into_iter();
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

/// Whether a scene without forces does not show how full bags are, or which belts are taut: those whose untensioned
/// length changes, or that act at times.
pub fn needs_forces(model: &Model) -> bool {
    let changes = |force: &Force| {
        force.law.looks().into_iter().any(|look| match look {
            Look::Bag(..) => true,
            Look::Line(look::Line::Belt(law), _) => {
                let pays_out = |belt: &Belt| {
                    let parts = (&belt.retractor, &belt.limiter, &belt.pretensioner);
                    parts.0.is_some() || parts.1.is_some() || parts.2.is_some()
                };
                law.get().is_none_or(pays_out) || force.active != Active::default()
            }
            _ => false,
        })
    };
    model.forces.iter().any(changes)
}

impl Scene {
    /// A motion through these instants. `coordinates` are the names of q, `parameters` the values of the run (SI, in
    /// the model's order). `forces` has a column for each output that [`with_forces`] adds, with a value for each
    /// instant, or no column.
    ///
    /// Instants with coordinates that are not finite are left out: of a failed run there is what was before its
    /// failure.
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
    pub fn point(&self, k: usize, place: BodyPoint) -> Vec3 {
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

    /// Whether a segment of a belt is taut at a time: by its force, or by the untensioned length at the start where
    /// forces are not known.
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
