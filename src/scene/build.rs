//! What a scene is made of: the looks of laws and of what is only shown, with their forces at all times.

use super::planes::Planes;
use super::{
    Bodies, BodyPoint, Ellipsoid, Line, LineKind, Push, Scene, from_to, length, route, way,
};
use crate::pose::{Numbers, Vec3, bryant_rotation, dot};
use bryant_generator::law::types::{Belt, BeltLength};
use bryant_generator::model::Round;
use bryant_generator::model::look::{self, Look};
use bryant_generator::model::{Attachment, Number, Quantity, Shown};

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

/// A part of a scene that is not finished.
pub struct Builder<'a> {
    pub bodies: Bodies<'a>,
    pub numbers: Numbers<'a>,
    pub scene: &'a mut Scene,
}

impl Builder<'_> {
    /// Adds everything. `forces` has the columns of [`with_forces`](super::with_forces), or none.
    pub fn add(mut self, forces: &[Vec<f64>]) {
        let model = self.bodies.model;
        let mut columns = Columns(forces.iter());
        let mut planes = Planes::default();
        for (index, force) in model.forces.iter().enumerate() {
            for look in force.law.looks() {
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
                LineKind::Belt => route::ways(scene, &line.points),
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

    fn place(&self, attachment: &Attachment) -> BodyPoint {
        BodyPoint {
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
        kind: look::Line<'_>,
        points: &[&Attachment],
        forces: &[impl Fn(usize) -> Vec3],
    ) {
        let points: Vec<BodyPoint> = points.iter().map(|point| self.place(point)).collect();
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
            look::Line::Belt(belt) if !scene.times.is_empty() => {
                let points: Vec<Vec3> = (0..points.len()).map(|i| at(0, i)).collect();
                let belt = belt.get::<Belt>();
                (
                    LineKind::Belt,
                    belt.map(|belt| untensioned(self.numbers, belt, way(&points))),
                )
            }
            look::Line::Belt(_) => (LineKind::Belt, None),
            look::Line::Spring => (LineKind::Spring, None),
            look::Line::Bushing => (LineKind::Bushing, None),
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

    /// Adds the forces on the body of an ellipsoid at all times. `normal` is that of the plane that it meets, with its
    /// body.
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
            let place = BodyPoint {
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

/// Untensioned length of a belt whose points are `initial` apart at the start \[m\].
fn untensioned(numbers: Numbers<'_>, belt: &Belt, initial: f64) -> f64 {
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
