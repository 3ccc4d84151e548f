//! The criteria of the neck and the viscous criterion.

use super::Missing;
use super::limits::{Chest, Neck};
use bryant_signal::Signal;

/// From the load cell at the upper neck to the joint of head and neck, of all Hybrid III dummies \[m\] (49 CFR Part 572).
const ARM: f64 = 0.01778;

/// The moment about the joint of head and neck \[N m\] of the shear force \[N\] and the moment \[N m\] that the cell above measures: My − e Fx.
pub fn moment(fx: f64, my: f64) -> f64 {
    my - ARM * fx
}

/// The largest Nij = Fz/Fzc + M/Mc of the shear force, the axial force and the moment of the cell, and its mode. Tension and flexion are positive. At a time
/// one mode counts.
pub fn nij([fx, fz, my]: &[Signal; 3], critical: &Neck) -> (f64, String) {
    let mut worst = (0.0, String::new());
    for (index, fz) in fz.values.iter().enumerate() {
        let moment = moment(fx.values[index], my.values[index]);
        let (force, axial) = match *fz >= 0.0 {
            true => (fz / critical.tension, "tension"),
            false => (-fz / critical.compression, "compression"),
        };
        let (bent, bending) = match moment >= 0.0 {
            true => (moment / critical.flexion, "flexion"),
            false => (-moment / critical.extension, "extension"),
        };
        if force + bent > worst.0 {
            let time = 1e3 * my.time(index);
            worst = (
                force + bent,
                format!("{axial} and {bending} at {time:.1} ms"),
            );
        }
    }
    worst
}

/// max S (D/D₀) dD/dt \[m/s\] of a deflection D \[m\], whatever its sign; the rate is that of five points.
pub fn viscous(deflection: &Signal, chest: &Chest) -> Result<f64, Missing> {
    let d = &deflection.values;
    if d.len() < 5 {
        return Err(Missing::Unusable(
            "the recording is too short for it".to_owned(),
        ));
    }
    let at = |i: usize| {
        let rate =
            (8.0 * (d[i + 1] - d[i - 1]) - (d[i + 2] - d[i - 2])) / (12.0 * deflection.interval);
        chest.factor * d[i] / chest.depth * rate
    };
    Ok((2..d.len() - 2).map(at).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::{nij, viscous};
    use crate::criteria::limits::{Chest, Neck};
    use bryant_signal::Signal;
    use std::f64::consts::PI;

    fn signal(values: Vec<f64>) -> Signal {
        Signal {
            first: 0.0,
            interval: 1e-4,
            values,
        }
    }

    /// D = A sin ω t has the largest VC = S A² ω/(2 D₀).
    #[test]
    fn a_half_sine_has_the_viscous_criterion_of_the_closed_form() {
        let chest = Chest {
            factor: 1.3,
            depth: 0.229,
        };
        let omega = PI / 0.06;
        for sign in [1.0, -1.0] {
            let samples = (0..=600).map(|i| sign * 0.05 * (omega * f64::from(i) * 1e-4).sin());
            let found = viscous(&signal(samples.collect()), &chest).unwrap();
            let exact = 1.3 * 0.05 * 0.05 * omega / (2.0 * 0.229);
            // five points err by (ω Δt)⁴/30; the top lies 0.5 samples off at most: (2 ω Δt/2)²/2
            assert!((found / exact - 1.0).abs() < 2e-5, "{found} {exact}");
            assert!((exact - 0.3715493).abs() < 1e-7);
        }
    }

    /// Each of the four modes with numbers of its own.
    #[test]
    fn each_mode_of_the_neck_counts_by_itself() {
        let critical = Neck {
            tension: 6806.0,
            compression: 6160.0,
            flexion: 310.0,
            extension: 135.0,
        };
        for (fx, fz, my, expected, mode) in [
            (0.0, 680.6, 31.0, 0.2, "tension and flexion"),
            (0.0, 680.6, -13.5, 0.2, "tension and extension"),
            (0.0, -616.0, 31.0, 0.2, "compression and flexion"),
            (0.0, -616.0, -13.5, 0.2, "compression and extension"),
            // the shear force turns the moment: 10 − 0.01778 · 1000
            (1000.0, 0.0, 10.0, 7.78 / 135.0, "tension and extension"),
        ] {
            let cell = [fx, fz, my].map(|value| signal(vec![0.0, value, 0.0]));
            let (found, detail) = nij(&cell, &critical);
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            assert_eq!(detail, format!("{mode} at 0.1 ms"));
        }
    }
}
