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
fn slope(pairs: &[(f64, f64)]) -> f64 {
    let count = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let moment = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    moment(&|p| (p.0 - x) * (p.1 - y)) / moment(&|p| (p.0 - x) * (p.0 - x))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(error: f64, time: f64) -> Cost {
        Cost { error, time }
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [
            cost(1e-2, 1.0),
            cost(1e-3, 2.0),
            // slower and less accurate than the one before
            cost(2e-3, 2.5),
            // as accurate as the second, and slower
            cost(1e-3, 3.0),
            // as fast as the first, and less accurate
            cost(5e-2, 1.0),
            cost(0.0, 10.0),
            cost(f64::NAN, 0.1),
            cost(f64::INFINITY, 0.2),
        ];
        assert_eq!(pareto(&points), [0, 1, 5]);
        // By the definition, pair by pair.
        for (i, p) in points
            .iter()
            .enumerate()
            .filter(|(_, p)| p.error.is_finite())
        {
            let beaten = points.iter().any(|q| {
                q.error <= p.error && q.time <= p.time && (q.error < p.error || q.time < p.time)
            });
            assert_eq!(pareto(&points).contains(&i), !beaten, "{i}");
        }
        assert_eq!(cheapest(&points, 5e-3), Some(1));
        assert_eq!(cheapest(&points, 1e-1), Some(0));
        assert_eq!(cheapest(&points[..1], 1e-3), None);
        assert!(pareto(&[]).is_empty());
    }

    #[test]
    fn equal_points_are_on_the_front_once() {
        let points = [cost(1e-3, 1.0), cost(1e-3, 1.0)];
        assert_eq!(pareto(&points), [0]);
    }

    #[test]
    fn a_digit_costs_what_the_points_were_made_with() {
        // time = 2 ms · 1.6^digits, errors at random places of eight digits
        let errors = [3e-1, 7e-3, 1.1e-4, 5e-5, 4e-7, 2e-8];
        let time = |error: f64| 2e-3 * 1.6f64.powf(-error.log10());
        let points: Vec<Cost> = errors.iter().map(|&e| cost(e, time(e))).collect();
        let digits = digits(&points).unwrap();
        assert!((digits.factor - 1.6).abs() < 1e-12, "{digits:?}");
        assert!((digits.from / 3e-1 - 1.0).abs() < 1e-12 && (digits.to / 2e-8 - 1.0).abs() < 1e-12);
        assert_eq!(digits.points, 6);
    }

    #[test]
    fn too_little_is_no_regression() {
        assert_eq!(digits(&[]), None);
        assert_eq!(digits(&[cost(1e-1, 1.0), cost(1e-5, 2.0)]), None);
        let close = [cost(1e-3, 1.0), cost(2e-3, 1.5), cost(3e-3, 2.0)];
        assert_eq!(digits(&close), None);
        // An error of 0 has no number of digits.
        assert_eq!(digits(&[cost(0.0, 1.0); 5]), None);
    }

    #[test]
    fn the_slope_is_that_of_least_squares() {
        // (0,0) (1,2) (2,1): b = Σ(x−1)(y−1)/Σ(x−1)² = (1 + 0)/2
        let b = slope(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)]);
        assert!((b - 0.5).abs() < 1e-15);
    }
}
