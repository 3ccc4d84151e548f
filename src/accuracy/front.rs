//! The Pareto front of error and time, and the cost of each further digit along it.

/// A point of the diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Relative error, not negative.
    pub error: f64,
    /// Time of a run \[s\], positive.
    pub time: f64,
}

/// Indices of the points on the front, in the order of decreasing error: each is more accurate than all faster points.
/// Of equal points, only the first is on the front; points that are not finite are left out.
pub fn pareto(points: &[Cost]) -> Vec<usize> {
    let usable = |p: &Cost| p.error.is_finite() && p.error >= 0.0 && p.time.is_finite();
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| usable(&points[i])).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (&points[a], &points[b]);
        a.time.total_cmp(&b.time).then(a.error.total_cmp(&b.error))
    });
    let mut best = f64::INFINITY;
    // in the order of time, a point stays if it is more accurate than all faster ones
    order.retain(|&i| {
        let better = points[i].error < best;
        best = best.min(points[i].error);
        better
    });
    order
}

/// The fastest point whose error is at most `error`.
pub fn cheapest(points: &[Cost], error: f64) -> Option<usize> {
    pareto(points)
        .into_iter()
        .find(|&i| points[i].error <= error)
}

/// The cost of a digit, by least squares: log₁₀ time = a + b · digits with digits = −log₁₀ error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Digits {
    /// Factor on the time for each further digit: 10^b.
    pub factor: f64,
    /// Largest error among the points.
    pub from: f64,
    /// Smallest error among the points.
    pub to: f64,
    /// Number of points.
    pub points: usize,
}

/// The regression over points with positive error and time; `None` if there are fewer than three, or their errors span
/// less than one digit.
pub fn digits(points: &[Cost]) -> Option<Digits> {
    let usable = points.iter().filter(|p| p.error > 0.0 && p.time > 0.0);
    let pairs: Vec<(f64, f64)> = usable
        .map(|p| (-libm::log10(p.error), libm::log10(p.time)))
        .collect();
    let fold = |pick: fn(f64, f64) -> f64, start: f64| pairs.iter().map(|p| p.0).fold(start, pick);
    let (least, most) = (
        fold(f64::min, f64::INFINITY),
        fold(f64::max, f64::NEG_INFINITY),
    );
    // false, too, without points, because the range is then not a number
    let enough = pairs.len() >= 3 && most - least >= 1.0;
    enough.then(|| Digits {
        factor: libm::pow(10.0, slope(&pairs)),
        from: libm::pow(10.0, -least),
        to: libm::pow(10.0, -most),
        points: pairs.len(),
    })
}

/// Slope b of the line y = a + b x with the least sum of squares of the errors in y.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn slope(pairs: &[(f64, f64)]) -> f64 {
    let count = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let moment = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    moment(&|p| (p.0 - x) * (p.1 - y)) / moment(&|p| (p.0 - x) * (p.0 - x))
}
