//! The visible parts of a model at one time, as shapes in the plane of the picture \[m\].

use super::view::View;
use crate::pose::Vec3;
use crate::scene::mesh::outline;
use crate::scene::{self, BodyPoint, Ellipsoid, LineKind, Scene, from_to, length};
use std::f64::consts::TAU;

/// A point in the plane of the picture: to the right, upwards \[m\].
pub type Point = [f64; 2];

/// One stick figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// \[s\]
    pub time: f64,
    /// How far the body has gone that the view moves with \[m\].
    pub travel: f64,
    /// Elements, as (system, from, to).
    pub bones: Vec<(usize, Point, Point)>,
    /// Joints, as (system, place).
    pub joints: Vec<(usize, Point)>,
    /// Centres of gravity of elements that carry no other.
    pub masses: Vec<(usize, Point)>,
    /// Ellipsoids.
    pub ellipses: Vec<Ellipse>,
    /// Rounded boxes, as (system of the body that carries it, outline).
    pub boxes: Vec<(Option<usize>, Vec<Point>)>,
    /// Meshes, as (system of the body that carries it, closed lines around it).
    pub meshes: Vec<(Option<usize>, Vec<Vec<Point>>)>,
    /// Bags, as large as their gas.
    pub bags: Vec<Ellipse>,
    /// Whether some of them are in no contact.
    pub some_meet_nothing: bool,
    /// Contact planes that are seen edge-on in all figures.
    pub planes: Vec<Plane>,
    /// Other contact planes: their corners.
    pub faces: Vec<[Point; 4]>,
    /// Belts.
    pub belts: Vec<Belt>,
    /// Points of ellipsoids and planes that have to be seen, and how far these reach around them.
    pub outer: Vec<(Point, f64)>,
    /// Ends of springs.
    pub springs: Vec<[Point; 2]>,
    /// Origins of both frames of bushings.
    pub bushings: Vec<[Point; 2]>,
}

impl Figure {
    /// How far anything, or the view, has moved since another figure of the same motion; infinite where a belt has
    /// become taut or slack.
    pub fn change(&self, before: &Figure) -> f64 {
        let ends = |figure: &Figure| -> Vec<Point> {
            let bones = figure.bones.iter().flat_map(|(_, from, to)| [*from, *to]);
            let belts = figure.belts.iter().flat_map(|belt| belt.points.clone());
            let lines = figure.springs.iter().chain(&figure.bushings).flatten();
            let bags = figure.bags.iter();
            let bags = bags.map(|bag| [bag.centre[0] + bag.semi_axes[0], bag.centre[1]]);
            let outer = figure.outer.iter().map(|(at, _)| *at);
            let all = bones.chain(belts).chain(lines.copied()).chain(bags);
            all.chain(outer).collect()
        };
        let taut = |figure: &Figure| figure.belts.iter().map(|b| b.taut).collect::<Vec<_>>();
        if taut(self) != taut(before) {
            return f64::INFINITY;
        }
        let pairs = ends(self).into_iter().zip(ends(before));
        let moved = pairs.map(|(a, b)| libm::hypot(a[0] - b[0], a[1] - b[1]));
        moved.fold((self.travel - before.travel).abs(), f64::max)
    }
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

/// A segment of a belt.
#[derive(Clone, Debug, PartialEq)]
pub struct Belt {
    /// From one end to the other.
    pub points: Vec<Point>,
    /// False where it is slack.
    pub taut: bool,
}

/// A plane is seen edge-on if its normal leaves the plane of the picture by at most this sine.
const EDGE_ON: f64 = 0.02;

/// Corners of the outline of a rounded box.
const CORNERS: usize = 64;

/// The figures of a motion, one for each of its times, as one sees them who moves with a body.
pub fn figures(scene: &Scene, view: View, followed: Option<usize>) -> Vec<Figure> {
    let at = |k| Projection {
        scene,
        k,
        view,
        followed,
    };
    let times = 0..scene.times.len();
    // what is an edge in some figures alone is drawn in the same way in all of them
    let edges = scene.planes.iter().map(|plane| {
        let mut normals = times.clone().map(|k| at(k).direction(plane));
        normals.all(|n| libm::hypot(n[0], n[1]) >= (1.0 - EDGE_ON * EDGE_ON).sqrt())
    });
    let edges: Vec<bool> = edges.collect();
    times.clone().map(|k| at(k).figure(&edges)).collect()
}

/// A scene at one time, seen from one side.
struct Projection<'a> {
    scene: &'a Scene,
    k: usize,
    view: View,
    followed: Option<usize>,
}

impl Projection<'_> {
    fn figure(&self, edges: &[bool]) -> Figure {
        let Projection { scene, k, .. } = *self;
        let system = |place: BodyPoint| scene.system(place.body).unwrap_or_default();
        let bones = scene.bones.iter().map(|[from, to]| {
            let [a, b] = [from, to].map(|end| self.seen(*end));
            (system(*from), a, b)
        });
        let elements = scene.bodies.iter().enumerate().filter_map(|(body, named)| {
            let origin = BodyPoint {
                body: Some(body),
                at: [0.0; 3],
            };
            Some((named.system?, self.seen(origin)))
        });
        let masses = scene.masses.iter();
        let mut figure = Figure {
            time: scene.times[k],
            travel: length(scene.travel(k, self.followed)),
            bones: bones.collect(),
            joints: elements.collect(),
            masses: masses.map(|at| (system(*at), self.seen(*at))).collect(),
            some_meet_nothing: scene.some_meet_nothing,
            ..Figure::default()
        };
        // of the frame, past which the view moves, nothing has to be seen
        let counts = |body: Option<usize>| self.followed.is_none() || body.is_some();
        for ellipsoid in &scene.ellipsoids {
            if counts(ellipsoid.center.body) {
                let ellipse = self.outline(ellipsoid);
                let reach = ellipse.semi_axes[0];
                figure.outer.push((ellipse.centre, reach));
            }
            if ellipsoid.fill.is_some() {
                figure.bags.push(self.outline(ellipsoid));
            } else if ellipsoid.degree > 2 {
                let system = scene.system(ellipsoid.center.body);
                figure.boxes.push((system, self.corners(ellipsoid)));
            } else {
                figure.ellipses.push(self.outline(ellipsoid));
            }
        }
        for mesh in &scene.meshes {
            let frame = scene.frame(k, mesh.body);
            let places = mesh.triangles.places.iter();
            let places: Vec<Point> = places.map(|at| self.project(frame.point(*at))).collect();
            let system = scene.system(mesh.body);
            if system.is_some() {
                let corners = mesh.corners.map(|at| (self.project(frame.point(at)), 0.0));
                figure.outer.extend(corners);
            }
            let lines = outline(&places, &mesh.triangles.corners);
            figure.meshes.push((system, lines));
        }
        for (plane, edge) in scene.planes.iter().zip(edges) {
            let frame = scene.frame(k, plane.body);
            let corners = plane.corners.map(|at| self.project(frame.point(at)));
            if counts(plane.body) {
                figure.outer.extend(corners.map(|corner| (corner, 0.0)));
            }
            match edge {
                true => figure.planes.push(self.edge(plane, corners)),
                false => figure.faces.push(corners),
            }
        }
        for line in &scene.lines {
            for (segment, ends) in line.points.windows(2).enumerate() {
                let [from, to] = [0, 1].map(|end| self.seen(ends[end]));
                match line.kind {
                    LineKind::Belt => figure.belts.push(Belt {
                        points: scene
                            .path(k, line, segment)
                            .into_iter()
                            .map(|point| self.project(point))
                            .collect(),
                        taut: scene.taut(k, line, segment),
                    }),
                    LineKind::Spring => figure.springs.push([from, to]),
                    LineKind::Bushing => figure.bushings.push([from, to]),
                }
            }
        }
        figure
    }

    /// The place of a point in the picture.
    fn project(&self, point: Vec3) -> Point {
        let travel = self.scene.travel(self.k, self.followed);
        self.view.seen(from_to(travel, point))
    }

    fn seen(&self, place: BodyPoint) -> Point {
        self.project(self.scene.point(self.k, place))
    }

    /// The normal of a plane in the picture.
    fn direction(&self, plane: &scene::Plane) -> Point {
        let frame = self.scene.frame(self.k, plane.body);
        self.view.seen(frame.direction(plane.normal))
    }

    /// The semi-axes of an ellipsoid that are seen.
    fn axes(&self, ellipsoid: &Ellipsoid) -> Vec<Point> {
        let axes = self.scene.axes(self.k, ellipsoid);
        let seen: &[usize] = match self.scene.planar {
            true => &[0, 2],
            false => &[0, 1, 2],
        };
        seen.iter().map(|&i| self.view.seen(axes[i])).collect()
    }

    /// Outline of an ellipsoid with axes B and semi-axes a: with Q = B diag(a²) Bᵀ, the outline is the ellipse of the
    /// block of Q in the directions of the picture.
    fn outline(&self, ellipsoid: &Ellipsoid) -> Ellipse {
        let axes = self.axes(ellipsoid);
        let entry = |i: usize, j: usize| -> f64 { axes.iter().map(|axis| axis[i] * axis[j]).sum() };
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

    /// Outline of a rounded box of degree n with axes aᵢ: its farthest point in the direction d is Σ aᵢ cᵢ with cᵢ
    /// ∝ |aᵢ·d|^(1/(n−1)), Σ |cᵢ|ⁿ = 1.
    fn corners(&self, ellipsoid: &Ellipsoid) -> Vec<Point> {
        let axes = self.axes(ellipsoid);
        let centre = self.seen(ellipsoid.center);
        let n = f64::from(ellipsoid.degree);
        let corner = |i: usize| {
            let (y, x) = libm::sincos(TAU * i as f64 / CORNERS as f64);
            let along = axes.iter().map(|axis| axis[0] * x + axis[1] * y);
            let parts: Vec<f64> = along
                .map(|a| libm::pow(a.abs(), 1.0 / (n - 1.0)).copysign(a))
                .collect();
            let sum: f64 = parts.iter().map(|c| libm::pow(c.abs(), n)).sum();
            let size = libm::pow(sum, -1.0 / n);
            [0, 1].map(|i| {
                let far: f64 = axes.iter().zip(&parts).map(|(axis, c)| axis[i] * c).sum();
                centre[i] + size * far
            })
        };
        (0..=CORNERS).map(corner).collect()
    }

    /// The edge of a plane whose corners are on one line.
    fn edge(&self, plane: &scene::Plane, mut corners: [Point; 4]) -> Plane {
        let normal = self.direction(plane);
        let size = libm::hypot(normal[0], normal[1]);
        let normal = normal.map(|n| n / size);
        let place = |corner: &Point| corner[1] * normal[0] - corner[0] * normal[1];
        corners.sort_by(|a, b| place(a).total_cmp(&place(b)));
        Plane {
            from: corners[0],
            to: corners[3],
            normal,
        }
    }
}
