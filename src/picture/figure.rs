//! The visible parts of a model at one time, as shapes in the plane of the picture \[m\].

use super::view::View;
use crate::scene::{Ellipsoid, Kind, Place, Scene};

/// A point in the plane of the picture: to the right, upwards \[m\].
pub type Point = [f64; 2];

/// One stick figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// \[s\]
    pub time: f64,
    /// Elements, as (system, from, to).
    pub bones: Vec<(usize, Point, Point)>,
    /// Joints, as (system, place).
    pub joints: Vec<(usize, Point)>,
    /// Centres of gravity of elements that carry no other.
    pub masses: Vec<(usize, Point)>,
    /// Ellipsoids.
    pub ellipses: Vec<Ellipse>,
    /// Whether some of them are in no contact.
    pub some_meet_nothing: bool,
    /// Contact planes that are seen edge-on.
    pub planes: Vec<Plane>,
    /// Contact planes that are not seen edge-on: their corners.
    pub faces: Vec<[Point; 4]>,
    /// Belts.
    pub belts: Vec<Belt>,
    /// Ends of springs.
    pub springs: Vec<[Point; 2]>,
    /// Origins of both frames of bushings.
    pub bushings: Vec<[Point; 2]>,
}

/// Outline of an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// System of the body that carries it; `None` for the frame.
    pub system: Option<usize>,
    /// Centre.
    pub centre: Point,
    /// Semi-axes.
    pub semi_axes: [f64; 2],
    /// Angle of the first semi-axis from x towards z \[rad\].
    pub angle: f64,
}

/// A plane, seen as a piece of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// One end.
    pub from: Point,
    /// The other end.
    pub to: Point,
    /// Unit vector to the side of the ellipsoid.
    pub normal: Point,
}

/// A belt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belt {
    /// One end.
    pub from: Point,
    /// The other end.
    pub to: Point,
    /// False where it is slack.
    pub taut: bool,
}

/// A plane is seen edge-on if its normal leaves the plane of the picture by at most this sine.
const EDGE_ON: f64 = 0.02;

/// The figures of a motion, one for each of its times.
pub fn figures(scene: &Scene, view: View) -> Vec<Figure> {
    let at = |k| Projection { scene, k, view }.figure();
    (0..scene.times.len()).map(at).collect()
}

/// A scene at one time, seen from one side.
struct Projection<'a> {
    scene: &'a Scene,
    k: usize,
    view: View,
}

impl Projection<'_> {
    fn figure(&self) -> Figure {
        let Projection { scene, k, .. } = *self;
        let system = |place: Place| scene.system(place.body).unwrap_or_default();
        let bones = scene.bones.iter().map(|[from, to]| {
            let [a, b] = [from, to].map(|end| self.seen(*end));
            (system(*from), a, b)
        });
        let elements = scene.bodies.iter().enumerate().filter_map(|(body, named)| {
            let origin = Place {
                body: Some(body),
                at: [0.0; 3],
            };
            Some((named.system?, self.seen(origin)))
        });
        let masses = scene.masses.iter();
        let mut figure = Figure {
            time: scene.times[k],
            bones: bones.collect(),
            joints: elements.collect(),
            masses: masses.map(|at| (system(*at), self.seen(*at))).collect(),
            ellipses: scene.ellipsoids.iter().map(|e| self.outline(e)).collect(),
            some_meet_nothing: scene.some_meet_nothing,
            ..Figure::default()
        };
        for plane in &scene.planes {
            self.add_plane(&mut figure, plane);
        }
        for line in &scene.lines {
            let points: Vec<Point> = line.points.iter().map(|p| self.seen(*p)).collect();
            let taut = scene.taut(k, line);
            for (from, to) in points.iter().zip(&points[1..]) {
                match line.kind {
                    Kind::Belt => figure.belts.push(Belt {
                        from: *from,
                        to: *to,
                        taut,
                    }),
                    Kind::Spring => figure.springs.push([*from, *to]),
                    Kind::Bushing => figure.bushings.push([*from, *to]),
                }
            }
        }
        figure
    }

    fn seen(&self, place: Place) -> Point {
        self.view.seen(self.scene.point(self.k, place))
    }

    /// Outline of an ellipsoid with axes B and semi-axes a: with Q = B diag(a²) Bᵀ, the outline is the ellipse of the block of Q in the
    /// directions of the picture.
    fn outline(&self, ellipsoid: &Ellipsoid) -> Ellipse {
        let axes = self.scene.axes(self.k, ellipsoid);
        let axes = axes.map(|axis| self.view.seen(axis));
        let seen: &[usize] = if self.scene.planar {
            &[0, 2]
        } else {
            &[0, 1, 2]
        };
        let entry =
            |i: usize, j: usize| -> f64 { seen.iter().map(|&k| axes[k][i] * axes[k][j]).sum() };
        let (xx, xz, zz) = (entry(0, 0), entry(0, 1), entry(1, 1));
        let (mean, difference) = ((xx + zz) / 2.0, (xx - zz) / 2.0);
        let radius = libm::hypot(difference, xz);
        Ellipse {
            system: self.scene.system(ellipsoid.center.body),
            centre: self.seen(ellipsoid.center),
            semi_axes: [(mean + radius).sqrt(), (mean - radius).max(0.0).sqrt()],
            angle: 0.5 * libm::atan2(xz, difference),
        }
    }

    /// Adds a plane: its edge where it is seen edge-on, its corners elsewhere.
    fn add_plane(&self, figure: &mut Figure, plane: &crate::scene::Plane) {
        let frame = self.scene.frame(self.k, plane.body);
        let corners = plane.corners.map(|at| self.view.seen(frame.point(at)));
        let normal = self.view.seen(frame.direction(plane.normal));
        let length = libm::hypot(normal[0], normal[1]);
        if length < (1.0 - EDGE_ON * EDGE_ON).sqrt() {
            figure.faces.push(corners);
            return;
        }
        let normal = normal.map(|n| n / length);
        // the corners are on one line: its ends
        let place = |corner: &Point| corner[1] * normal[0] - corner[0] * normal[1];
        let [first, .., last] = {
            let mut corners = corners;
            corners.sort_by(|a, b| place(a).total_cmp(&place(b)));
            corners
        };
        figure.planes.push(Plane {
            from: first,
            to: last,
            normal,
        });
    }
}
