//! What a view stays with, from where it looks, and how much it shows.
//!
//! It stays with the vehicle that most is fixed to, among those that move. Without one it stays with the first body if
//! the motion leads farther than three times the size of what moves. It looks from the side, unless the box around the
//! whole motion is seen larger from the front or from above, by a quarter of its area.

use super::{BodyPoint, Scene, from_to, length};
use crate::picture::View;
use crate::pose::Vec3;

/// A motion that leads so many times farther than what moves is large is followed.
const FAR: f64 = 3.0;

/// The box of the motion has so many times the area in another view than from the side.
const LARGER: f64 = 1.25;

/// At most so many times are looked at.
const LOOKS: usize = 60;

impl Scene {
    /// The body that the view stays with.
    pub fn followed(&self) -> Option<usize> {
        let last = self.times.len().checked_sub(1)?;
        let moves = |body: &usize| {
            let way = from_to(
                self.frames[0][*body].origin,
                self.frames[last][*body].origin,
            );
            length(way) > 1e-6
        };
        let vehicles = (0..self.bodies.len()).filter(|body| self.bodies[*body].system.is_none());
        let vehicles = vehicles.filter(moves);
        // the first of several with as much on them
        if let Some(vehicle) = vehicles.rev().max_by_key(|vehicle| self.fixed_to(*vehicle)) {
            return Some(vehicle);
        }
        let size = |[low, high]: [Vec3; 2]| length(from_to(low, high));
        let each = self.looked_at().map(|k| size(self.boxed(&[k], None)));
        let largest = each.fold(0.0, f64::max);
        let all: Vec<usize> = self.looked_at().collect();
        let far = size(self.boxed(&all, None)) > FAR * largest;
        (far && !self.bodies.is_empty() && largest > 0.0).then_some(0)
    }

    /// How much is fixed to a body.
    fn fixed_to(&self, body: usize) -> usize {
        let on = |place: &&BodyPoint| place.body == Some(body);
        let ends = self.lines.iter().flat_map(|line| &line.points);
        let planes = self.planes.iter().filter(|p| p.body == Some(body));
        let children = self.bodies.iter().filter(|b| b.parent == Some(body));
        ends.filter(on).count() + planes.count() + children.count()
    }

    /// Some of the times, the last among them.
    fn looked_at(&self) -> impl Iterator<Item = usize> + use<> {
        let count = self.times.len();
        let step = count.div_ceil(LOOKS).max(1);
        (0..count).rev().step_by(step)
    }

    /// How far a body has gone since the start; the frame stays.
    pub fn travel(&self, k: usize, body: Option<usize>) -> Vec3 {
        body.map_or([0.0; 3], |body| {
            from_to(self.frames[0][body].origin, self.frames[k][body].origin)
        })
    }

    /// The points that say where things are at a time, of bodies that move by their equations and of lines, and how far
    /// the bodies reach around them \[m\].
    fn landmarks(&self, k: usize) -> impl Iterator<Item = (Vec3, f64)> + '_ {
        let bones = self.bones.iter().flatten().map(|place| (*place, 0.0));
        let ends = self.lines.iter().flat_map(|line| &line.points);
        let round = self.ellipsoids.iter();
        let round = round.filter(|e| self.system(e.center.body).is_some());
        let round = round.map(|e| (e.center, e.semi.into_iter().fold(0.0, f64::max)));
        let meshes = self.meshes.iter();
        let meshes = meshes.filter(|mesh| self.system(mesh.body).is_some());
        let meshes = meshes.flat_map(|mesh| {
            let body = mesh.body;
            mesh.corners.map(|at| (BodyPoint { body, at }, 0.0))
        });
        let round = round.chain(meshes);
        let all = bones.chain(ends.map(|place| (*place, 0.0))).chain(round);
        all.map(move |(place, reach)| (self.point(k, place), reach))
    }

    /// The box around all landmarks at these times, moved back with a body: low and high corner \[m\].
    fn boxed(&self, times: &[usize], followed: Option<usize>) -> [Vec3; 2] {
        let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for &k in times {
            let travel = self.travel(k, followed);
            for (point, reach) in self.landmarks(k) {
                for axis in 0..3 {
                    let x = point[axis] - travel[axis];
                    corners[0][axis] = corners[0][axis].min(x - reach);
                    corners[1][axis] = corners[1][axis].max(x + reach);
                }
            }
        }
        match corners[0].iter().all(|x| x.is_finite()) {
            true => corners,
            false => [[-0.5; 3], [0.5; 3]],
        }
    }

    /// The diagonal of the box around what moves by its equations, at a time \[m\].
    pub fn size(&self, k: usize) -> f64 {
        let [low, high] = self.boxed(&[k], None);
        length(from_to(low, high))
    }

    /// How far what is drawn of a body is from where it was at another time: the largest displacement of a point \[m\].
    /// Of a body that curves, the points are those in 26 directions from its middle.
    pub fn displacement(&self, from: usize, k: usize) -> f64 {
        let bones = self.bones.iter().flatten().copied();
        let ends = self.lines.iter().flat_map(|line| &line.points).copied();
        let planes = self.planes.iter().flat_map(|plane| {
            let body = plane.body;
            plane.corners.iter().map(move |&at| BodyPoint { body, at })
        });
        let meshes = self.meshes.iter().flat_map(|mesh| {
            let body = mesh.body;
            mesh.triangles
                .places
                .iter()
                .map(move |&at| BodyPoint { body, at })
        });
        let points = bones.chain(ends).chain(planes).chain(meshes);
        let moved = points.map(|place| from_to(self.point(from, place), self.point(k, place)));
        let round = self.ellipsoids.iter().flat_map(|e| {
            let [before, after] = [from, k].map(|k| (self.point(k, e.center), self.axes(k, e)));
            (0..27).map(move |n| {
                let signs = [n % 3, n / 3 % 3, n / 9].map(|digit| f64::from(digit) - 1.0);
                let degree = f64::from(e.degree);
                let sum: f64 = signs.iter().map(|sign| sign.abs()).sum();
                let reach = libm::pow(sum.max(1.0), -1.0 / degree);
                let at = |(center, axes): ([f64; 3], [Vec3; 3])| -> Vec3 {
                    let off = |i: usize| (0..3).map(|j| signs[j] * axes[j][i]).sum::<f64>();
                    std::array::from_fn(|i| center[i] + reach * off(i))
                };
                from_to(at(before), at(after))
            })
        });
        moved.chain(round).map(length).fold(0.0, f64::max)
    }

    /// The box around the whole motion, as one sees it who moves with a body.
    pub fn around(&self, followed: Option<usize>) -> [Vec3; 2] {
        self.boxed(&self.looked_at().collect::<Vec<_>>(), followed)
    }

    /// The view that shows the motion.
    pub fn view(&self) -> View {
        if self.planar || self.times.is_empty() {
            return View::Side;
        }
        let [low, high] = self.around(self.followed());
        let area = |view: View| -> f64 {
            let extent = |axis: Vec3| {
                (0..3)
                    .map(|i| axis[i].abs() * (high[i] - low[i]))
                    .sum::<f64>()
            };
            view.axes().map(extent).iter().product()
        };
        let larger = |best: View, view: View| match area(view) > LARGER * area(best) {
            true => view,
            false => best,
        };
        [View::Front, View::Top]
            .into_iter()
            .fold(View::Side, larger)
    }
}
