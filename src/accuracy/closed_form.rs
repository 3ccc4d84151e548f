//! Recognises models whose motion is known in closed form.
//!
//! | scene | motion |
//! |---|---|
//! | one element on a hinge at rest in the plane, uniform constant fields | θ̈ = −κ sin θ: Jacobi's elliptic functions \[Whittaker, Analytical Dynamics, § 44\] |
//! | one free element in the plane, uniform constant fields | the centre of gravity on a parabola, constant angular velocity |
//!
//! Nothing else may act: there is no other force, no switch and no vehicle.
use super::elliptic::{amplitude, first_kind};
use super::trajectory::Trajectory;
use bryant_generator::model::{
    Active, Dimension, Element, ElementId, Field, FieldComponent, ForceKind, Model, Number,
    Reference,
};
use std::f64::consts::PI;

/// A motion in closed form, which gives the state at any time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClosedForm {
    /// A plane pendulum, or an element that rotates about its centre of gravity.
    Pendulum(Pendulum),
    /// A free element in the plane.
    Flight(Flight),
}

/// θ̈ = −κ sin θ, θ = φ − φ₀.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    /// φ₀, the angle of stable equilibrium \[rad\]; it includes whole turns, so that |θ| ≤ π at the start.
    equilibrium: f64,
    /// Angular velocity at t = 0 \[rad/s\].
    rate: f64,
    /// √κ, the angular frequency of small oscillations \[rad/s\].
    frequency: f64,
    motion: Motion,
}

/// The kinds of motion of a pendulum.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Motion {
    /// No moment acts: φ at t = 0 \[rad\].
    Uniform { start: f64 },
    /// sin θ/2 = k sn(√κ t + u₀, k)
    Oscillation { modulus: f64, phase: f64 },
    /// θ/2 = ± am(k √κ t + u₀, 1/k)
    Rotation { inverse: f64, phase: f64, sign: f64 },
}

/// A motion on a parabola with uniform rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Centre of gravity at t = 0: x, z \[m\].
    position: [f64; 2],
    /// Velocity of the centre of gravity at t = 0 \[m/s\].
    velocity: [f64; 2],
    /// Acceleration of the centre of gravity \[m/s²\].
    acceleration: [f64; 2],
    /// Vector from the reference joint to the centre of gravity, local frame \[m\].
    arm: [f64; 2],
    /// φ at t = 0 \[rad\].
    angle: f64,
    /// Angular velocity φ̇ \[rad/s\].
    rate: f64,
}

/// Least distance of k² from that of the separatrix, k² = 1: nearer to it, the start does not determine the last digits
/// of the motion.
const SEPARATRIX: f64 = 1e-6;

impl ClosedForm {
    /// The closed form of a model at these parameters (SI, in the model's order); `None` if it is not known.
    pub fn of(model: &Model, parameters: &[f64]) -> Option<ClosedForm> {
        let [system] = model.systems.as_slice() else {
            return None;
        };
        let [element] = system.elements.as_slice() else {
            return None;
        };
        if model.dimension != Dimension::Plane || !model.vehicles.is_empty() {
            return None;
        }
        let scene = Scene {
            element,
            parameters,
            field: field(model, parameters)?,
        };
        match system.reference {
            Reference::Fixed => scene.pendulum().map(ClosedForm::Pendulum),
            Reference::Free => {
                let start = [&system.position, &system.velocity].map(|v| scene.plane(v));
                Some(ClosedForm::Flight(scene.flight(start)))
            }
            Reference::Prescribed(_) | Reference::Riding { .. } => None,
        }
    }

    /// The name for people.
    pub fn name(&self) -> &'static str {
        match self {
            ClosedForm::Pendulum(pendulum) => match pendulum.motion {
                Motion::Uniform { .. } => "uniform rotation",
                Motion::Oscillation { .. } => "the plane pendulum's swing, Jacobi's sn and cn",
                Motion::Rotation { .. } => "the plane pendulum's rotation, Jacobi's am and dn",
            },
            ClosedForm::Flight(_) => "free flight, a parabola and a uniform rotation",
        }
    }

    /// Coordinates, then velocities, at a time \[s\].
    pub fn state(&self, t: f64) -> Vec<f64> {
        match self {
            ClosedForm::Pendulum(pendulum) => pendulum.state(t).to_vec(),
            ClosedForm::Flight(flight) => flight.state(t).to_vec(),
        }
    }

    /// The motion at these times, without outputs.
    pub fn trajectory(&self, times: &[f64]) -> Trajectory {
        Trajectory {
            times: times.to_vec(),
            states: times.iter().map(|t| self.state(*t)).collect(),
            outputs: Vec::new(),
        }
    }

    /// Bound of the rounding errors of a state, relative to its largest magnitudes: some roundings of functions, and
    /// one of the phase.
    pub fn rounding(&self, duration: f64) -> f64 {
        let phase = match self {
            ClosedForm::Pendulum(p) => p.frequency.max(p.rate.abs()) * duration,
            ClosedForm::Flight(f) => f.rate.abs() * duration,
        };
        (16.0 + 4.0 * phase) * f64::EPSILON
    }
}

/// The sum of all fields, x and z \[m/s²\]; `None` if another force acts on the element.
fn field(model: &Model, parameters: &[f64]) -> Option<[f64; 2]> {
    const ONLY: ElementId = ElementId {
        system: 0,
        element: 0,
    };
    let mut sum = [0.0; 2];
    for force in &model.forces {
        let ForceKind::Field(field) = &force.kind else {
            return None;
        };
        let Field { on, acceleration } = &**field;
        if force.active != Active::default() {
            return None;
        }
        if !on.contains(&ONLY) {
            continue;
        }
        for (sum, axis) in sum.iter_mut().zip([0, 2]) {
            match &acceleration[axis] {
                FieldComponent::Constant(value) => *sum += value.value(parameters),
                FieldComponent::Curve(_) => return None,
            }
        }
    }
    Some(sum)
}

/// The only element, and the field that acts on it.
struct Scene<'a> {
    element: &'a Element,
    parameters: &'a [f64],
    field: [f64; 2],
}

impl Scene<'_> {
    fn value(&self, number: &Number) -> f64 {
        number.value(self.parameters)
    }

    /// The components x and z of a vector.
    fn plane(&self, vector: &[Number; 3]) -> [f64; 2] {
        [self.value(&vector[0]), self.value(&vector[2])]
    }

    /// The motion of the element as a pendulum; `None` near the separatrix and in equilibrium. With the centre of
    /// gravity c = l (sin α, cos α), the local vector (c_x, c_z) rotated by φ about y is l (sin(φ + α), cos(φ + α)). In
    /// the field g (sin β, cos β), m c·g = m l g cos θ with θ = φ + α − β, so (I + m l²) θ̈ = −m l g sin θ.
    fn pendulum(&self) -> Option<Pendulum> {
        let cg = self.plane(&self.element.cg);
        let (mass, inertia) = (
            self.value(&self.element.mass),
            self.value(&self.element.inertia[1]),
        );
        let arm = libm::hypot(cg[0], cg[1]);
        let strength = libm::hypot(self.field[0], self.field[1]);
        let start = self.value(&self.element.angles[1]);
        let rate = self.value(&self.element.angular_velocity[1]);
        let square = mass * arm * strength / (inertia + mass * arm * arm);
        if square == 0.0 {
            return Some(Pendulum {
                equilibrium: 0.0,
                rate,
                frequency: 0.0,
                motion: Motion::Uniform { start },
            });
        }
        let frequency = square.sqrt();
        let turned = start + libm::atan2(cg[0], cg[1]) - libm::atan2(self.field[0], self.field[1]);
        // θ at the start, from −π to π
        let theta = turned - 2.0 * PI * (turned / (2.0 * PI)).round();
        let half = libm::sin(0.5 * theta);
        let swing = 0.5 * rate / frequency;
        let modulus = libm::hypot(half, swing);
        if (modulus - 1.0).abs() < SEPARATRIX || modulus == 0.0 {
            return None;
        }
        let motion = if modulus < 1.0 {
            // k sn u₀ = sin θ/2, k cn u₀ = θ̇/(2√κ)
            let phi = libm::atan2(half, swing);
            Motion::Oscillation {
                modulus,
                phase: quarter_wise(phi, modulus),
            }
        } else {
            let sign = rate.signum();
            Motion::Rotation {
                inverse: 1.0 / modulus,
                phase: first_kind(sign * 0.5 * theta, 1.0 / modulus),
                sign,
            }
        };
        Some(Pendulum {
            equilibrium: start - theta,
            rate,
            frequency,
            motion,
        })
    }

    fn flight(&self, [position, velocity]: [[f64; 2]; 2]) -> Flight {
        let arm = self.plane(&self.element.cg);
        let angle = self.value(&self.element.angles[1]);
        let rate = self.value(&self.element.angular_velocity[1]);
        let [x, z] = turned(arm, angle);
        Flight {
            position: [position[0] + x, position[1] + z],
            // v + ω × c, with ω × c = ω (z, −x) for a rotation about y
            velocity: [velocity[0] + rate * z, velocity[1] - rate * x],
            acceleration: self.field,
            arm,
            angle,
            rate,
        }
    }
}

/// F(φ, k) for |φ| ≤ π; for |φ| > π/2 from F(φ) = 2K − F(π − φ).
fn quarter_wise(phi: f64, modulus: f64) -> f64 {
    if phi.abs() <= 0.5 * PI {
        return first_kind(phi, modulus);
    }
    let half_period = 2.0 * super::elliptic::quarter_period(modulus);
    phi.signum() * (half_period - first_kind(PI - phi.abs(), modulus))
}

/// A local vector (x, z) in absolute axes, for an element that is rotated by φ about y.
fn turned([x, z]: [f64; 2], phi: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(phi);
    [x * cos + z * sin, z * cos - x * sin]
}

impl Pendulum {
    /// φ \[rad\], φ̇ \[rad/s\]
    fn state(&self, t: f64) -> [f64; 2] {
        match self.motion {
            Motion::Uniform { start } => [start + self.rate * t, self.rate],
            Motion::Oscillation { modulus, phase } => {
                let am = amplitude(self.frequency * t + phase, modulus);
                let theta = 2.0 * libm::asin(modulus * libm::sin(am));
                let rate = 2.0 * modulus * self.frequency * libm::cos(am);
                [self.equilibrium + theta, rate]
            }
            Motion::Rotation {
                inverse,
                phase,
                sign,
            } => {
                let am = amplitude(self.frequency * t / inverse + phase, inverse);
                let product = inverse * libm::sin(am);
                let dn = ((1.0 - product) * (1.0 + product)).sqrt();
                let rate = sign * 2.0 * self.frequency / inverse * dn;
                [self.equilibrium + sign * 2.0 * am, rate]
            }
        }
    }
}

impl Flight {
    /// The state: x, z \[m\], φ \[rad\], ẋ, ż \[m/s\], φ̇ \[rad/s\] of the reference joint and the element.
    fn state(&self, t: f64) -> [f64; 6] {
        let phi = self.angle + self.rate * t;
        let [x, z] = turned(self.arm, phi);
        let velocity = |i: usize| self.velocity[i] + self.acceleration[i] * t;
        let position =
            |i: usize| self.position[i] + t * (self.velocity[i] + 0.5 * self.acceleration[i] * t);
        [
            position(0) - x,
            position(1) - z,
            phi,
            velocity(0) - self.rate * z,
            velocity(1) + self.rate * x,
            self.rate,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::elliptic::quarter_period;
    use super::*;

    fn model(reference: &str, start: &str, rest: &str) -> Model {
        let text = format!(
            "model: one\ndimension: 2\nsystems:\n  - name: a\n    reference: {reference}\n    elements:\n      \
             - {{ name: b, mass: 2 kg, cg: [0.1, -0.4], inertia: 0.05 }}\n    start: {{ {start} }}\nforces:\n  \
             - {{ field: earth, acceleration: [1.5, -9.81] }}\n{rest}run: {{ duration: 1 s, every: 0.1 s }}\n"
        );
        let none = |_: &std::path::Path| Err(std::io::Error::from(std::io::ErrorKind::NotFound));
        read_str("one.yaml", &text, &none)
            .unwrap_or_else(|e| panic!("{e}"))
            .0
    }

    fn closed(reference: &str, start: &str) -> ClosedForm {
        ClosedForm::of(&model(reference, start, ""), &[]).unwrap()
    }

    /// θ̈ by the moment of the field about the joint, from the numbers of the model.
    fn acceleration(phi: f64) -> f64 {
        let [x, z] = turned([0.1, -0.4], phi);
        let moment = 2.0 * (z * 1.5 - x * -9.81);
        moment / (0.05 + 2.0 * (0.1 * 0.1 + 0.4 * 0.4))
    }

    /// Classical Runge–Kutta steps of φ̈ = f(φ), an integration of its own.
    fn integrate(mut y: [f64; 2], t: f64, steps: usize) -> [f64; 2] {
        let h = t / steps as f64;
        let rate = |y: [f64; 2]| [y[1], acceleration(y[0])];
        let ahead = |y: [f64; 2], h: f64, k: [f64; 2]| [y[0] + h * k[0], y[1] + h * k[1]];
        for _ in 0..steps {
            let k1 = rate(y);
            let k2 = rate(ahead(y, 0.5 * h, k1));
            let k3 = rate(ahead(y, 0.5 * h, k2));
            let k4 = rate(ahead(y, h, k3));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        y
    }

    #[test]
    fn swings_and_rotations_are_those_of_an_integration() {
        for start in [
            "angles: { b: 30 deg }",
            "angles: { b: -170 deg }, rates: { b: 0.3 }",
            "angles: { b: 100 deg }, rates: { b: -2 }",
            "angles: { b: 400 deg }, rates: { b: 1 }",
            "angles: { b: 20 deg }, rates: { b: 25 }",
            "angles: { b: 120 deg }, rates: { b: -14 }",
        ] {
            let closed = closed("fixed", start);
            let first: [f64; 2] = closed.state(0.0).try_into().unwrap();
            let t = 1.7;
            // The difference of two step sizes bounds the error of the finer one; ten thousand steps add rounding.
            let [coarse, fine] = [10_000, 20_000].map(|steps| integrate(first, t, steps));
            let last = closed.state(t);
            for i in 0..2 {
                let bound = (coarse[i] - fine[i]).abs() + 1e-11;
                assert!(
                    (last[i] - fine[i]).abs() <= bound,
                    "{start}: {} {}",
                    last[i],
                    fine[i]
                );
            }
        }
    }

    #[test]
    fn the_start_is_that_of_the_model() {
        let start = closed("fixed", "angles: { b: 400 deg }, rates: { b: 1 }").state(0.0);
        let expected = 400f64.to_radians();
        assert!((start[0] - expected).abs() < 32.0 * f64::EPSILON * expected);
        assert!((start[1] - 1.0).abs() < 32.0 * f64::EPSILON * 10.0);
        let start = closed("fixed", "angles: { b: 20 deg }, rates: { b: -25 }").state(0.0);
        assert!((start[0] - 20f64.to_radians()).abs() < 32.0 * f64::EPSILON);
        assert!((start[1] + 25.0).abs() < 32.0 * f64::EPSILON * 25.0);
    }

    #[test]
    fn the_period_is_the_elliptic_integral() {
        // T = 4 K(sin θ₀/2)/√κ; after it the state is that of the start
        let closed = closed("fixed", "angles: { b: 75 deg }");
        let ClosedForm::Pendulum(pendulum) = closed else {
            panic!("{closed:?}")
        };
        let Motion::Oscillation { modulus, .. } = pendulum.motion else {
            panic!("{pendulum:?}")
        };
        let period = 4.0 * quarter_period(modulus) / pendulum.frequency;
        let (first, later) = (closed.state(0.0), closed.state(period));
        for (a, b) in first.iter().zip(&later) {
            assert!((a - b).abs() < closed.rounding(period) * 10.0, "{a} {b}");
        }
        let half = closed.state(0.5 * period);
        // On the other side of the equilibrium, at rest.
        assert!((first[0] + half[0] - 2.0 * pendulum.equilibrium).abs() < 1e-13);
        assert!(half[1].abs() < 1e-13);
    }

    #[test]
    fn a_free_element_flies_on_a_parabola() {
        let start = "position: [1, 2], velocity: [3, 4], angles: { b: 50 deg }, rates: { b: 6 }";
        let closed = closed("free", start);
        let first = closed.state(0.0);
        let expected = [1.0, 2.0, 50f64.to_radians(), 3.0, 4.0, 6.0];
        for (a, b) in first.iter().zip(expected) {
            assert!((a - b).abs() < 64.0 * f64::EPSILON, "{a} {b}");
        }
        // The second differences of the centre of gravity equal the field, those of the angle are 0.
        let h = 1e-2;
        let cg = |t: f64| {
            let y = closed.state(t);
            let [x, z] = turned([0.1, -0.4], y[2]);
            [y[0] + x, y[1] + z, y[2]]
        };
        for t in [0.1, 0.7] {
            let [before, now, after] = [t - h, t, t + h].map(cg);
            for (i, expected) in [1.5, -9.81, 0.0].into_iter().enumerate() {
                let second = (before[i] - 2.0 * now[i] + after[i]) / (h * h);
                // roundings of numbers below 10, over h²
                assert!(
                    (second - expected).abs() < 1e-14 * 10.0 / (h * h),
                    "{second}"
                );
            }
            // the velocity is the rate of the position: central differences are exact for parabolas, and err by ω³ l h²/6 at the joint
            let [before, after] = [t - h, t + h].map(|t| closed.state(t));
            let now = closed.state(t);
            for i in 0..3 {
                let rate = (after[i] - before[i]) / (2.0 * h);
                let bound = 6f64.powi(3) * 0.42 * h * h / 6.0 * 1.01;
                assert!((rate - now[3 + i]).abs() < bound, "{i}");
            }
        }
    }

    #[test]
    fn what_is_more_than_that_is_not_recognised() {
        let of = |model: &Model| ClosedForm::of(model, &[]);
        let brake = "  - { joint: a/b, damping: 1 }\n";
        assert_eq!(of(&model("fixed", "angles: { b: 1 }", brake)), None);
        let belt = "  - { belt: c, from: { on: a/b, at: [0, 0.3] }, to: { on: frame, at: [1, 0] }, force: { points: \
                    [[0, 0], [1, 1]], extrapolate: linear } }\n";
        assert_eq!(of(&model("free", "angles: { b: 1 }", belt)), None);
        let pulse = "  - { field: sled, acceleration: [{ points: [[0, 0], [1, 1]], extrapolate: hold }, 0] }\n";
        assert_eq!(of(&model("free", "angles: { b: 1 }", pulse)), None);
        assert!(of(&model("free", "angles: { b: 1 }", "")).is_some());
    }
}
