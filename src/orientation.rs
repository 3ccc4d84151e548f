//! States without charts: states of a model in Bryant angles, converted to quaternions.
//!
//! The meaning of three Bryant angles and their rates depends on the chart of their element: A = Rx(φ₁) Ry(φ₂) Rz(φ₃)
//! in chart 0, and A = Rx(φ₁) Ry(φ₂) Rz(φ₃) Ry(−90°) in chart 1. To compare states of two runs or to draw them, they
//! are converted to quaternions (w, x, y, z) and angular velocities in absolute axes, as in the same model with
//! `coordinates: quaternion`. States of other models are not changed.

use crate::pose::rotation;
use bryant_runtime::program::Header;

/// The conversion of the states of a model to quaternions.
#[derive(Clone, Debug, PartialEq)]
pub struct WithoutCharts {
    /// Names of the coordinates after conversion.
    pub coordinates: Vec<String>,
    /// Names of the velocities after conversion.
    pub velocities: Vec<String>,
    /// Numbers of coordinates and of velocities before conversion.
    lengths: [usize; 2],
    elements: Vec<Charted>,
}

/// The indices of an element's first angle, first rate and chart in the state.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Charted {
    angles: usize,
    rates: usize,
    chart: usize,
}

impl WithoutCharts {
    /// The conversion for a model. Elements with a chart in memory are converted.
    pub fn of(header: &Header) -> Self {
        let find = |names: &[String], name: String| names.iter().position(|n| *n == name);
        let before = header.coordinates.len() + header.velocities.len();
        let memory = before + header.auxiliaries.len();
        let charts = header.memory.iter().enumerate();
        let elements = charts.filter_map(|(index, name)| {
            let element = name.strip_suffix(": chart")?;
            let angles = find(&header.coordinates, format!("{element}.phi1"))?;
            let rates = find(&header.velocities, format!("{element}.dphi1"))?;
            Some(Charted {
                angles,
                rates: header.coordinates.len() + rates,
                chart: memory + index,
            })
        });
        let elements: Vec<Charted> = elements.collect();
        let renamed = |names: &[String], from: &str, to: &[&str]| {
            let component = |name: &String| -> Vec<String> {
                let Some((element, component)) = name.rsplit_once('.') else {
                    return vec![name.clone()];
                };
                match component.strip_prefix(from) {
                    Some("1") => to.iter().map(|to| format!("{element}.{to}")).collect(),
                    Some("2" | "3") => Vec::new(),
                    _ => vec![name.clone()],
                }
            };
            names.iter().flat_map(component).collect()
        };
        let charted = !elements.is_empty();
        let names = |names: &[String], from: &str, to: &[&str]| match charted {
            true => renamed(names, from, to),
            false => names.to_vec(),
        };
        Self {
            coordinates: names(&header.coordinates, "phi", &["qw", "qx", "qy", "qz"]),
            velocities: names(&header.velocities, "dphi", &["wx", "wy", "wz"]),
            lengths: [header.coordinates.len(), header.velocities.len()],
            elements,
        }
    }

    /// The converted coordinates of a state of the model.
    pub fn q(&self, state: &[f64]) -> Vec<f64> {
        let mut q = Vec::with_capacity(self.coordinates.len());
        let mut from = 0;
        for &Charted { angles, chart, .. } in &self.elements {
            q.extend(&state[from..angles]);
            let [a, b, c] = [0, 1, 2].map(|i| state[angles + i]);
            q.extend(quaternion([a, b, c], state[chart]));
            from = angles + 3;
        }
        q.extend(&state[from..self.lengths[0]]);
        q
    }

    /// A whole state of the model, converted; entries after the velocities are not changed.
    pub fn state(&self, state: &[f64]) -> Vec<f64> {
        let mut y = self.q(state);
        let mut from = self.lengths[0];
        for &Charted { angles, rates, .. } in &self.elements {
            y.extend(&state[from..rates]);
            let [first, second] = [0, 1].map(|i| libm::sincos(state[angles + i]));
            y.extend(omega(first, second, [0, 1, 2].map(|i| state[rates + i])));
            from = rates + 3;
        }
        y.extend(&state[from..]);
        y
    }
}

/// Angles are given in chart 1 if the sine of the middle angle in chart 0 exceeds this, the same limit at which runs
/// change charts.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub const CHANGE: f64 = 0.8;

/// The unit quaternion, and the angular velocity in absolute axes, for Bryant angles and their rates in a chart.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn without_chart(angles: [f64; 3], rates: [f64; 3], chart: f64) -> ([f64; 4], [f64; 3]) {
    let [first, second] = [0, 1].map(|i| libm::sincos(angles[i]));
    (quaternion(angles, chart), omega(first, second, rates))
}

/// The Bryant angles, their rates and their chart for a unit quaternion and an angular velocity in absolute axes: the
/// inverse of [`without_chart`].
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn in_chart(quaternion: [f64; 4], omega: [f64; 3]) -> ([f64; 3], [f64; 3], f64) {
    let a = rotation(&quaternion);
    let (r, chart) = match a[0][2].abs() > CHANGE {
        // without the last rotation by −90° about y: the columns of A are (r₃, r₂, −r₁)
        true => (a.map(|[x, y, z]| [-z, y, x]), 1.0),
        false => (a, 0.0),
    };
    let angles = [
        libm::atan2(-r[1][2], r[2][2]),
        libm::asin(r[0][2].clamp(-1.0, 1.0)),
        libm::atan2(-r[0][1], r[0][0]),
    ];
    let [(s1, c1), (s2, c2)] = [0, 1].map(|i| libm::sincos(angles[i]));
    let third = (c1 * omega[2] - s1 * omega[1]) / c2;
    let rates = [omega[0] - s2 * third, c1 * omega[1] + s1 * omega[2], third];
    (angles, rates, chart)
}

/// The unit quaternion of Rx(φ₁) Ry(φ₂) Rz(φ₃) in chart 0, and of Rx(φ₁) Ry(φ₂) Rz(φ₃) Ry(−90°) in chart 1.
fn quaternion(angles: [f64; 3], chart: f64) -> [f64; 4] {
    let [(s1, c1), (s2, c2), (s3, c3)] = angles.map(|angle| libm::sincos(0.5 * angle));
    let [w, x, y, z] = [
        c1 * c2 * c3 - s1 * s2 * s3,
        s1 * c2 * c3 + c1 * s2 * s3,
        c1 * s2 * c3 - s1 * c2 * s3,
        c1 * c2 * s3 + s1 * s2 * c3,
    ];
    if chart < 0.5 {
        return [w, x, y, z];
    }
    // multiply by (cos 45°, 0, −sin 45°, 0)
    [w + y, x + z, y - w, z - x].map(|component| component * std::f64::consts::FRAC_1_SQRT_2)
}

/// ω = W φ̇ in absolute axes, in any chart: the columns of W are e_x, Rx e_y and Rx Ry e_z.
fn omega((s1, c1): (f64, f64), (s2, c2): (f64, f64), [d1, d2, d3]: [f64; 3]) -> [f64; 3] {
    [d1 + s2 * d3, c1 * d2 - s1 * c2 * d3, s1 * d2 + c1 * c2 * d3]
}
