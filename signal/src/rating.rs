//! The agreement of a signal with a reference by ISO 18571: four numbers from 0 to 1 and their weighted mean.
//!
//! R is the reference and C the comparison, both with N samples at 10 kHz over the rated interval:
//!
//! | part | weight | what |
//! |---|---|---|
//! | corridor | 0.4 | mean over all samples of a score: 1 if \|R − C\| is within a = 5 % of max \|R\|, 0 beyond b = 50 %, between them ((b − \|R − C\|)/(b − a))² |
//! | phase | 0.2 | C is shifted to the best correlation with R, by at most 20 % of N samples: 1 − shift/(0.2 N) |
//! | magnitude | 0.2 | the overlap of the shifted signals, with C warped in time onto R (dynamic time warping, within 10 %): 1 − E/0.5, E = Σ\|C − R\|/Σ\|R\| |
//! | slope | 0.2 | the overlap of the shifted signals, with slopes that are smoothed over nine samples in place of C and R in E: 1 − E/2 |
//!
//! Of the shifts with the best correlation, the phase uses the smallest, and a shift of C to the left before one to the
//! right. Periodic signals, ramps and exponentials correlate equally well at many shifts; correlations count as equal
//! within `ROUNDING`. If several paths of the warping cost the same, a step along both signals is taken first, then one
//! along the reference alone, then one along the comparison.

use thiserror::Error;

/// Samples per second in ISO 18571.
pub const RATE: f64 = 1e4;

/// Correlations that differ by less count as equal. The sums of a correlation have rounding errors of about 1e-16 for
/// each sample, so 1e-11 for 10 s. If a file has six digits, a correlation of 1 changes by about 1e-12.
const ROUNDING: f64 = 1e-9;

/// The agreement of two signals; each number is from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rating {
    /// How close the comparison is to the reference.
    pub corridor: f64,
    /// How little the comparison must be shifted.
    pub phase: f64,
    /// How well the magnitudes agree.
    pub magnitude: f64,
    /// How well the slopes agree.
    pub slope: f64,
    /// Number of samples by which the comparison is late; negative if it is early.
    pub late: i64,
}

/// Why two signals cannot be rated.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum RatingError {
    /// They have different lengths.
    #[error("the signals have {0} and {1} samples")]
    Lengths(usize, usize),
    /// They are too short.
    #[error("the signals have {0} samples, and a rating needs 20")]
    Short(usize),
    /// A sample is missing.
    #[error("a sample is missing")]
    Missing,
    /// The reference never changes, and the comparison differs from it.
    #[error("the reference does not change, so nothing can be rated by it")]
    Constant,
}

/// The grade of a rating.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grade {
    /// Above 0.94.
    Excellent,
    /// Above 0.80.
    Good,
    /// Above 0.58.
    Fair,
    /// Everything else.
    Poor,
}

impl std::fmt::Display for Grade {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Grade::Excellent => "excellent",
            Grade::Good => "good",
            Grade::Fair => "fair",
            Grade::Poor => "poor",
        })
    }
}

impl Rating {
    /// The rating of two equal signals.
    const SAME: Rating = Rating {
        corridor: 1.0,
        phase: 1.0,
        magnitude: 1.0,
        slope: 1.0,
        late: 0,
    };

    /// The weighted mean.
    pub fn overall(&self) -> f64 {
        0.4 * self.corridor + 0.2 * (self.phase + self.magnitude + self.slope)
    }

    /// The grade of the weighted mean.
    pub fn grade(&self) -> Grade {
        match self.overall() {
            overall if overall > 0.94 => Grade::Excellent,
            overall if overall > 0.80 => Grade::Good,
            overall if overall > 0.58 => Grade::Fair,
            _ => Grade::Poor,
        }
    }
}

/// Rates a comparison against a reference, both at 10 kHz over the rated interval.
///
/// # Errors
/// The signals have different lengths or are too short, a sample is missing, or the reference is constant and differs
/// from the comparison.
pub fn rate(reference: &[f64], comparison: &[f64]) -> Result<Rating, RatingError> {
    let count = reference.len();
    if comparison.len() != count {
        return Err(RatingError::Lengths(count, comparison.len()));
    }
    if count < 20 {
        return Err(RatingError::Short(count));
    }
    if reference.iter().chain(comparison).any(|x| !x.is_finite()) {
        return Err(RatingError::Missing);
    }
    if is_constant(reference) {
        let same = |(r, c): (&f64, &f64)| (r - c).abs() <= ROUNDING * r.abs();
        return match reference.iter().zip(comparison).all(same) {
            true => Ok(Rating::SAME),
            false => Err(RatingError::Constant),
        };
    }
    let late = best_shift(reference, comparison);
    let shift = late.unsigned_abs() as usize;
    let overlap = count - shift;
    let (reference_part, comparison_part) = match late > 0 {
        true => (&reference[..overlap], &comparison[shift..]),
        false => (&reference[shift..], &comparison[..overlap]),
    };
    let most = 0.2 * count as f64;
    Ok(Rating {
        corridor: corridor(reference, comparison),
        phase: ((most - shift as f64) / most).max(0.0),
        magnitude: (1.0 - warped_error(reference_part, comparison_part) / 0.5).max(0.0),
        slope: (1.0 - slope_error(reference_part, comparison_part) / 2.0).max(0.0),
        late,
    })
}

/// True if a signal is constant, apart from rounding errors of a filter.
fn is_constant(signal: &[f64]) -> bool {
    let apart = signal.iter().map(|x| (x - signal[0]).abs());
    apart.fold(0.0, f64::max) <= 1e-12 * signal[0].abs()
}

fn corridor(reference: &[f64], comparison: &[f64]) -> f64 {
    let largest = reference
        .iter()
        .fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let (inner, outer) = (0.05 * largest, 0.5 * largest);
    let score = |(r, c): (&f64, &f64)| {
        let distance = (r - c).abs();
        if distance < inner {
            1.0
        } else if distance > outer {
            0.0
        } else {
            let share = (outer - distance) / (outer - inner);
            share * share
        }
    };
    let scores: f64 = reference.iter().zip(comparison).map(score).sum();
    scores / reference.len() as f64
}

/// Number of samples by which the comparison is late: the shift with the best correlation.
fn best_shift(reference: &[f64], comparison: &[f64]) -> i64 {
    let count = reference.len();
    // preferred shifts first
    let mut all = vec![(correlation(reference, comparison), 0)];
    for shift in 1..=count / 5 {
        let (short, long) = (count - shift, shift);
        let late = correlation(&reference[..short], &comparison[long..]);
        let early = correlation(&reference[long..], &comparison[..short]);
        all.extend([(late, shift as i64), (early, -(shift as i64))]);
    }
    let best = all
        .iter()
        .fold(-1.0, |best: f64, (value, _)| best.max(*value));
    let first = all.iter().find(|(value, _)| *value >= best - ROUNDING);
    first.map_or(0, |(_, shift)| *shift)
}

/// Pearson's coefficient; −1 if one of the signals is constant, so that such a shift is never the best.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len() as f64;
    let mean = |x: &[f64]| x.iter().sum::<f64>() / count;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        let (x, y) = (x - mean_a, y - mean_b);
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    match aa * bb > 0.0 {
        true => ab / (aa * bb).sqrt(),
        false => -1.0,
    }
}

/// The last step of the cheapest path to a cell of the warping.
#[derive(Clone, Copy, PartialEq)]
enum Step {
    Both,
    Reference,
    Comparison,
}

/// Σ|C − R|/Σ|R| of two signals of the same length, warped onto each other.
fn warped_error(reference: &[f64], comparison: &[f64]) -> f64 {
    let count = reference.len();
    // largest |i − j|
    let band = (count.div_ceil(10)).max(1) - 1;
    let width = 2 * band + 1;
    // each row holds the cells j = i − band … i + band
    let mut before = vec![f64::INFINITY; width];
    let mut steps = vec![Step::Both; count * width];
    for i in 0..count {
        let mut row = vec![f64::INFINITY; width];
        for k in 0..width {
            let Some(j) = (i + k).checked_sub(band).filter(|j| *j < count) else {
                continue;
            };
            let difference = reference[i] - comparison[j];
            let cost = difference * difference;
            // in the row above, the same j is one place further right
            let both = if i > 0 && j > 0 {
                before[k]
            } else {
                f64::INFINITY
            };
            let along_reference = match i > 0 && k + 1 < width {
                true => before[k + 1],
                false => f64::INFINITY,
            };
            let along_comparison = if j > 0 && k > 0 {
                row[k - 1]
            } else {
                f64::INFINITY
            };
            let (mut least, mut step) = (both, Step::Both);
            if along_reference < least {
                (least, step) = (along_reference, Step::Reference);
            }
            if along_comparison < least {
                (least, step) = (along_comparison, Step::Comparison);
            }
            if i == 0 && j == 0 {
                least = 0.0;
            }
            row[k] = least + cost;
            steps[i * width + k] = step;
        }
        before = row;
    }
    // follow the path from the end back to the start
    let (mut i, mut j) = (count - 1, count - 1);
    let (mut apart, mut size) = (0.0, 0.0);
    loop {
        apart += (comparison[j] - reference[i]).abs();
        size += reference[i].abs();
        if i == 0 && j == 0 {
            return relative(apart, size);
        }
        let step = steps[i * width + (j + band - i)];
        i -= usize::from(step != Step::Comparison);
        j -= usize::from(step != Step::Reference);
    }
}

/// Σ|C' − R'|/Σ|R'| of the slopes.
fn slope_error(reference: &[f64], comparison: &[f64]) -> f64 {
    let (r, c) = (smooth(&slopes(reference)), smooth(&slopes(comparison)));
    let apart: f64 = r.iter().zip(&c).map(|(r, c)| (c - r).abs()).sum();
    relative(apart, r.iter().map(|r| r.abs()).sum())
}

/// A difference as a share of a size; 0 if there is no difference, whatever the size.
fn relative(apart: f64, size: f64) -> f64 {
    match apart == 0.0 {
        true => 0.0,
        false => apart / size,
    }
}

/// Central differences, per sample; one-sided at the ends.
fn slopes(x: &[f64]) -> Vec<f64> {
    let last = x.len() - 1;
    let slope = |i: usize| match i {
        0 => x[1] - x[0],
        i if i == last => x[last] - x[last - 1],
        i => (x[i + 1] - x[i - 1]) / 2.0,
    };
    (0..x.len()).map(slope).collect()
}

/// The mean of nine values; of 1, 3, 5, 7 values towards the ends.
fn smooth(x: &[f64]) -> Vec<f64> {
    let last = x.len() - 1;
    let mean = |i: usize| {
        let reach = 4.min(i).min(last - i);
        let part = &x[i - reach..=i + reach];
        part.iter().sum::<f64>() / part.len() as f64
    };
    (0..x.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::{Grade, RatingError, rate};
    use std::f64::consts::PI;

    fn samples(count: u32, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..count).map(|i| of(f64::from(i) * 1e-4)).collect()
    }

    /// A half-sine of 40 ms with the amplitude 50 that begins at `begin`.
    fn pulse(begin: f64) -> Vec<f64> {
        samples(1001, |t| match (begin..=begin + 0.04).contains(&t) {
            true => 50.0 * (PI * (t - begin) / 0.04).sin(),
            false => 0.0,
        })
    }

    /// Against an independent program (objective-rating-metrics 1.3, of TU Graz): corridor, phase, magnitude, slope,
    /// overall.
    #[test]
    fn ratings_are_those_of_another_program() {
        let sine = samples(1500, |t| (20.0 * t).sin());
        let larger: Vec<f64> = sine.iter().map(|x| 1.3 * x).collect();
        let given = [
            (
                sine,
                larger,
                [
                    0.4778626900239473,
                    1.0,
                    0.759706005289321,
                    0.85,
                    0.7130862770674432,
                ],
            ),
            (
                pulse(0.02),
                pulse(0.022),
                [
                    0.9138815000487591,
                    0.9000999000999002,
                    1.0,
                    1.0,
                    0.9455725800394834,
                ],
            ),
            (pulse(0.02), pulse(0.02), [1.0; 5]),
        ];
        for (reference, comparison, expected) in given {
            let found = rate(&reference, &comparison).unwrap();
            let all = [
                found.corridor,
                found.phase,
                found.magnitude,
                found.slope,
                found.overall(),
            ];
            for (index, (found, expected)) in all.into_iter().zip(expected).enumerate() {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{index}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_late_signal_is_known_as_late_and_an_early_one_as_early() {
        let late = rate(&pulse(0.02), &pulse(0.025)).unwrap();
        let early = rate(&pulse(0.02), &pulse(0.015)).unwrap();
        assert_eq!((late.late, early.late), (50, -50));
        assert!((late.phase - (1.0 - 50.0 / 200.2)).abs() < 1e-12 && late.phase == early.phase);
        assert_eq!(late.grade(), Grade::Good);
    }

    /// Deterministic noise from -1 to 1.
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// Every signal beside itself rates 1, whatever its shape, size and offset, also where it correlates equally well
    /// at other shifts.
    #[test]
    fn a_signal_beside_itself_rates_one() {
        let mut all: Vec<(String, Vec<f64>)> = Vec::new();
        // up to half the rate of the samples, whole and odd numbers of periods
        for frequency in [
            0.3, 1.0, 7.3, 10.0, 50.0, 123.4, 500.0, 1000.0, 2500.0, 3333.3, 4999.0, 5000.0,
        ] {
            for phase in [0.0, 0.7] {
                let of = |t: f64| (2.0 * PI * frequency * t + phase).sin();
                all.push((format!("sine {frequency} Hz, {phase}"), samples(1001, of)));
            }
        }
        for rate in [-300.0, -20.0, 0.01, 5.0, 200.0] {
            let of = |t: f64| (rate * t).exp();
            all.push((format!("exponential {rate}"), samples(1501, of)));
        }
        all.push(("ramp".to_owned(), samples(1000, |t| 3.0 - 7.0 * t)));
        all.push(("velocity of a fall".to_owned(), samples(999, |t| 9.81 * t)));
        all.push((
            "height of a fall".to_owned(),
            samples(999, |t| 2.0 - 4.905 * t * t),
        ));
        all.push(("step".to_owned(), samples(800, |t| f64::from(t > 0.04))));
        all.push((
            "last sample".to_owned(),
            samples(800, |t| f64::from(t > 0.07985)),
        ));
        for constant in [0.0, -2.5, 1e9] {
            all.push((format!("constant {constant}"), vec![constant; 500]));
        }
        for seed in 0..5 {
            let mut noise = noise(seed);
            all.push((
                format!("noise {seed}"),
                samples(700, |_| 0.0).iter().map(|_| noise()).collect(),
            ));
        }
        for (name, signal) in &all {
            for (size, offset) in [
                (1.0, 0.0),
                (1e-9, 0.0),
                (1e12, 0.0),
                (1.0, 100.0),
                (1e-3, -1e4),
            ] {
                let signal: Vec<f64> = signal.iter().map(|x| size * x + offset).collect();
                let found = rate(&signal, &signal).unwrap();
                assert_eq!(
                    (found.overall(), found.late),
                    (1.0, 0),
                    "{name}, {size}, {offset}: {found:?}"
                );
            }
        }
    }

    /// A table with six digits, scaled: the shift is that of the signals, not that of their rounding.
    #[test]
    fn rounding_does_not_shift_a_periodic_signal() {
        for (frequency, late) in [(50.0, 0), (50.0, 13), (500.0, 3), (500.0, 0)] {
            let sine = |t: f64| (2.0 * PI * frequency * t).sin();
            let digits = |x: f64| (x * 1e6).round() / 1e6;
            let reference = samples(1200, |t| digits(sine(t)));
            let comparison = samples(1200, |t| digits(1.1 * sine(t - f64::from(late) * 1e-4)));
            let found = rate(&reference, &comparison).unwrap();
            assert_eq!(found.late, i64::from(late), "{frequency} Hz");
        }
    }

    #[test]
    fn what_cannot_be_rated_is_refused() {
        let (pulse, flat) = (pulse(0.02), vec![1.0; 1001]);
        assert_eq!(rate(&flat, &pulse), Err(RatingError::Constant));
        assert_eq!(
            rate(&pulse, &pulse[1..]),
            Err(RatingError::Lengths(1001, 1000))
        );
        assert_eq!(
            rate(&pulse[..19], &pulse[..19]),
            Err(RatingError::Short(19))
        );
        let mut missing = pulse.clone();
        missing[3] = f64::NAN;
        assert_eq!(rate(&pulse, &missing), Err(RatingError::Missing));
        // a constant beside itself, but for rounding, and beside another one
        let nearly: Vec<f64> = flat
            .iter()
            .enumerate()
            .map(|(i, x)| x + 1e-15 * (i % 3) as f64)
            .collect();
        assert_eq!(rate(&nearly, &flat), Ok(super::Rating::SAME));
        assert_eq!(rate(&flat, &vec![1.001; 1001]), Err(RatingError::Constant));
        // a comparison that never changes is as bad as possible, but is rated
        let poor = rate(&pulse, &vec![0.0; 1001]).unwrap();
        assert_eq!(
            (poor.grade(), poor.magnitude, poor.late),
            (Grade::Poor, 0.0, 0)
        );
    }
}
