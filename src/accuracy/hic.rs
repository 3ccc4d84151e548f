//! The head injury criterion: HIC = max (t₂ − t₁) [ 1/(t₂ − t₁) ∫ a dt ]^2.5, a in g, t₂ − t₁ at most 15 ms \[SAE
//! J1727\].
//!
//! The acceleration is linear between its samples. Windows begin and end at samples; but if a window of the largest
//! length begins or ends at a sample, its other end may be between two samples.

/// Standard acceleration of gravity \[m/s²\].
const G: f64 = 9.806_65;

/// The longest window of HIC15 \[s\].
pub const WINDOW: f64 = 15e-3;

/// HIC of accelerations \[m/s²\] at increasing times \[s\], over windows of at most `window` \[s\]; `None` if there are
/// fewer than two samples, or one is not finite.
pub fn hic(times: &[f64], accelerations: &[f64], window: f64) -> Option<f64> {
    let samples = times.len().min(accelerations.len());
    let finite = |values: &[f64]| values.iter().take(samples).all(|v| v.is_finite());
    if samples < 2 || !finite(times) || !finite(accelerations) {
        return None;
    }
    let times = &times[..samples];
    let signal = Signal::new(times, &accelerations[..samples]);
    let mut largest = 0.0f64;
    let mut consider = |from: f64, to: f64, velocity: f64| {
        let length = to - from;
        if length > 0.0 && velocity > 0.0 {
            largest = largest.max(length * libm::pow(velocity / (G * length), 2.5));
        }
    };
    // slightly longer than the window, because times of samples are rounded
    let reach = window * (1.0 + 1e-9);
    for (first, &from) in times.iter().enumerate() {
        for (last, &to) in times.iter().enumerate().skip(first + 1) {
            if to - from > reach {
                break;
            }
            consider(from, to, signal.velocity[last] - signal.velocity[first]);
        }
        for (from, to) in [(from, from + window), (from - window, from)] {
            if from >= times[0] && to <= times[samples - 1] {
                consider(from, to, signal.integral(to) - signal.integral(from));
            }
        }
    }
    Some(largest)
}

/// A signal that is linear between samples, and its integral from the first sample.
struct Signal<'a> {
    times: &'a [f64],
    values: &'a [f64],
    /// The integral from the first sample to each sample.
    velocity: Vec<f64>,
}

impl<'a> Signal<'a> {
    fn new(times: &'a [f64], values: &'a [f64]) -> Self {
        let mut velocity = vec![0.0];
        let mut sum = 0.0;
        for (t, a) in times.windows(2).zip(values.windows(2)) {
            sum += 0.5 * (t[1] - t[0]) * (a[0] + a[1]);
            velocity.push(sum);
        }
        Self {
            times,
            values,
            velocity,
        }
    }

    /// The integral from the first sample to a time between the first and the last.
    fn integral(&self, t: f64) -> f64 {
        let after = self.times.partition_point(|x| *x <= t);
        let last = after.clamp(1, self.times.len() - 1);
        let (t0, t1) = (self.times[last - 1], self.times[last]);
        let (a0, a1) = (self.values[last - 1], self.values[last]);
        let part = t - t0;
        let at = a0 + (a1 - a0) * part / (t1 - t0);
        self.velocity[last - 1] + 0.5 * part * (a0 + at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulse(samples: usize, every: f64, a: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..samples).map(|i| i as f64 * every).collect();
        let values = times.iter().map(|t| a(*t)).collect();
        (times, values)
    }

    #[test]
    fn a_constant_acceleration_counts_for_the_whole_window() {
        // 50 g for 15 ms: 0.015 · 50^2.5 = 265.165
        let (times, values) = pulse(101, 1e-3, |_| 50.0 * G);
        let expected = 0.015 * 50f64.powf(2.5);
        let found = hic(&times, &values, WINDOW).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
        assert!((expected - 265.165).abs() < 1e-3);
        // The window does not fit the samples: its end lies between two of them.
        let (times, values) = pulse(51, 2e-3, |_| 50.0 * G);
        let found = hic(&times, &values, WINDOW).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_half_sine_has_its_closed_form() {
        // Centred windows of x T have the mean 2A/(πx) sin(πx/2); HIC = T A^2.5 (2/π)^2.5 max x^-1.5 sin^2.5(πx/2), whose
        // maximum is at tan u = 5/3 u, u = πx/2.
        let u = (0..100).fold(1.0f64, |u, _| (5.0 / 3.0 * u).atan());
        let x = 2.0 * u / std::f64::consts::PI;
        let factor = (u.sin() / u).powf(2.5) * x;
        assert!((factor - 0.4146).abs() < 1e-4, "{factor}");
        let (length, amplitude) = (0.012, 120.0);
        let (samples, every) = (1201, 1e-5);
        let (times, values) = pulse(samples, every, |t| {
            amplitude * G * (std::f64::consts::PI * t / length).sin().max(0.0)
        });
        let found = hic(&times, &values, WINDOW).unwrap();
        let expected = factor * length * amplitude.powf(2.5);
        // The trapezoidal rule errs by (π h/T)²/12 of the mean; the ends of the window err by half a sample, which enters squared.
        let bound = 2.5 * (std::f64::consts::PI * every / length).powi(2);
        assert!((found / expected - 1.0).abs() < bound, "{found} {expected}");
    }

    #[test]
    fn longer_windows_than_allowed_do_not_count() {
        let (times, values) = pulse(2001, 1e-4, |t| if t < 0.1 { 30.0 * G } else { 0.0 });
        let short = hic(&times, &values, WINDOW).unwrap();
        let long = hic(&times, &values, 36e-3).unwrap();
        assert!((long / short - 36.0 / 15.0).abs() < 1e-9);
        assert_eq!(hic(&times[..1], &values[..1], WINDOW), None);
        assert_eq!(hic(&[0.0, 1.0], &[0.0, f64::NAN], WINDOW), None);
    }
}
