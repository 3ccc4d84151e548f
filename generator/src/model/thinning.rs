//! Thins curves with more points than a model may have: points are left out that lie close to a straight line between
//! their neighbours.

use super::curve::{Curve, Thinned};

impl Curve {
    /// The curve with at most `most` of its points, and the error of this. The points are chosen for the smallest error
    /// that is found for straight lines; the stated error is that of the curve itself, which for a cubic is a different
    /// one.
    pub fn with_at_most(self, most: usize) -> Curve {
        if self.points.len() <= most.max(2) {
            return self;
        }
        let heights = self.points.iter().map(|point| point[1]);
        let highest = heights.clone().fold(f64::NEG_INFINITY, f64::max);
        let lowest = heights.fold(f64::INFINITY, f64::min);
        // 60 halvings reach the rounding of a number
        let (mut too_small, mut enough) = (0.0, (highest - lowest).max(f64::MIN_POSITIVE));
        for _ in 0..60 {
            let middle = 0.5 * (too_small + enough);
            match kept(&self.points, middle).len() <= most {
                true => enough = middle,
                false => too_small = middle,
            }
        }
        let all = self.points;
        let mut curve = Curve {
            points: kept(&all, enough),
            ..self
        };
        let apart = all.iter().map(|[x, y]| (curve.value(*x) - y).abs());
        curve.thinned = Some(Thinned {
            points: all.len(),
            error: apart.fold(0.0, f64::max),
        });
        curve
    }
}

/// A choice of points such that every other point is within `tolerance` of the line between its neighbours in the
/// choice. From a chosen point, the slopes of lines that pass all later points within the tolerance form an interval.
/// The next chosen point is the last one before a point whose own slope is outside of this interval.
fn kept(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let mut kept = vec![points[0]];
    let mut slopes = [f64::NEG_INFINITY, f64::INFINITY];
    for pair in points.windows(2) {
        let [before, here] = [pair[0], pair[1]];
        let slope = |from: [f64; 2], to: f64| (to - from[1]) / (here[0] - from[0]);
        let mut from = kept[kept.len() - 1];
        let own = slope(from, here[1]);
        if own < slopes[0] || own > slopes[1] {
            kept.push(before);
            from = before;
            slopes = [f64::NEG_INFINITY, f64::INFINITY];
        }
        slopes[0] = slopes[0].max(slope(from, here[1] - tolerance));
        slopes[1] = slopes[1].min(slope(from, here[1] + tolerance));
    }
    kept.push(points[points.len() - 1]);
    kept
}
