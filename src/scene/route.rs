//! The way of a belt over the bodies that it is on: a band that is tight from end to end and stays out of their
//! ellipsoids.
//!
//! Its points move to the middle of their neighbours, and those in an ellipsoid to its surface, away from its centre,
//! again and again. So the band lies on the side where the straight line passes. Nothing but drawings uses it: the
//! force acts along the straight line.

use super::{BodyPoint, Scene, from_to, length};
use crate::pose::{Vec3, dot};

/// Pieces of a band while it is pulled tight, and how often its points are moved.
const PIECES: usize = 24;
const TIMES: usize = 48;

/// Points between the ends of what is drawn.
pub const BETWEEN: usize = 5;

/// A band is this much farther from the centre than the surface.
pub const CLEAR: f64 = 1.03;

/// An ellipsoid at one time.
pub struct Solid {
    pub center: Vec3,
    /// Its semi-axes divided by their squares: the product with a vector is its coordinate in parts of the semi-axis.
    pub scaled: [Vec3; 3],
    pub degree: f64,
}

impl Solid {
    /// Moves a point out; whether it was in.
    fn clear(&self, point: &mut Vec3) -> bool {
        let from = from_to(self.center, *point);
        let sum: f64 = self
            .scaled
            .iter()
            .map(|axis| libm::pow(dot(*axis, from).abs(), self.degree))
            .sum();
        let distance = libm::pow(sum, 1.0 / self.degree);
        let is_in = distance < CLEAR && distance > 1e-6;
        if is_in {
            *point = std::array::from_fn(|i| self.center[i] + from[i] * CLEAR / distance);
        }
        is_in
    }
}

/// The points between the ends of each segment of a line at all times, by segment and time: [`BETWEEN`] of a segment
/// that meets one of the bodies at some time, none of others.
pub fn ways(scene: &Scene, points: &[BodyPoint]) -> Vec<Vec<Vec<Vec3>>> {
    let bodies = between(scene, points);
    let solids: Vec<Vec<Solid>> = (0..scene.times.len())
        .map(|k| solids(scene, k, &bodies))
        .collect();
    let segment = |ends: &[BodyPoint]| {
        let mut meets = false;
        let bands = solids.iter().enumerate().map(|(k, solids)| {
            let [from, to] = [0, 1].map(|end| scene.point(k, ends[end]));
            let (band, touched) = band(from, to, solids);
            meets |= touched;
            spread(&band)
        });
        let bands: Vec<_> = bands.collect();
        match meets {
            true => bands,
            false => Vec::new(),
        }
    };
    points.windows(2).map(segment).collect()
}

/// The bodies that points are on, and those between them in their trees.
fn between(scene: &Scene, points: &[BodyPoint]) -> Vec<usize> {
    let carriers = |body: usize| {
        std::iter::successors(Some(body), |body| scene.bodies[*body].parent).collect::<Vec<_>>()
    };
    let on: Vec<usize> = points.iter().filter_map(|point| point.body).collect();
    let mut all = on.clone();
    for (i, a) in on.iter().enumerate() {
        for b in &on[i + 1..] {
            let (a, b) = (carriers(*a), carriers(*b));
            if a.last() == b.last() {
                // both ways to the first body that carries both
                let common = a.iter().find(|body| b.contains(body)).copied();
                let below = |way: &[usize]| {
                    let own = way.iter().take_while(|body| Some(**body) != common);
                    own.copied().collect::<Vec<_>>()
                };
                all.extend(common);
                all.extend(below(&a));
                all.extend(below(&b));
            }
        }
    }
    all.retain(|body| scene.bodies[*body].system.is_some());
    all.sort_unstable();
    all.dedup();
    all
}

fn solids(scene: &Scene, k: usize, bodies: &[usize]) -> Vec<Solid> {
    let on = |body: Option<usize>| body.is_some_and(|body| bodies.contains(&body));
    let ellipsoids = scene.ellipsoids.iter();
    let ellipsoids = ellipsoids.filter(|e| on(e.center.body) && e.fill.is_none());
    let solid = |e: &super::Ellipsoid| Solid {
        center: scene.point(k, e.center),
        scaled: scene.axes(k, e).map(|axis| {
            let squared = dot(axis, axis).max(1e-12);
            axis.map(|x| x / squared)
        }),
        degree: f64::from(e.degree),
    };
    ellipsoids.map(solid).collect()
}

/// The points of a band, and whether it met anything.
pub fn band(from: Vec3, to: Vec3, solids: &[Solid]) -> (Vec<Vec3>, bool) {
    let at = |part: f64| std::array::from_fn(|i| from[i] + part * (to[i] - from[i]));
    let mut points: Vec<Vec3> = (0..=PIECES).map(|i| at(i as f64 / PIECES as f64)).collect();
    let clear = |points: &mut [Vec3]| {
        let mut met = false;
        for point in &mut points[1..PIECES] {
            for solid in solids {
                met |= solid.clear(point);
            }
        }
        met
    };
    if !clear(&mut points) {
        return (points, false);
    }
    for _ in 0..TIMES {
        for i in 1..PIECES {
            points[i] =
                std::array::from_fn(|axis| 0.5 * (points[i - 1][axis] + points[i + 1][axis]));
        }
        clear(&mut points);
    }
    (points, true)
}

/// Points at equal distances along a band, without its ends.
fn spread(band: &[Vec3]) -> Vec<Vec3> {
    let lengths: Vec<f64> = band
        .windows(2)
        .map(|ends| length(from_to(ends[0], ends[1])))
        .collect();
    let whole: f64 = lengths.iter().sum();
    let point = |n: usize| {
        let mut left = whole * (n + 1) as f64 / (BETWEEN + 1) as f64;
        for (ends, length) in band.windows(2).zip(&lengths) {
            if left <= *length && *length > 0.0 {
                return std::array::from_fn(|i| {
                    ends[0][i] + left / length * (ends[1][i] - ends[0][i])
                });
            }
            left -= length;
        }
        band[band.len() - 1]
    };
    (0..BETWEEN).map(point).collect()
}
