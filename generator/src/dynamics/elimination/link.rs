//! Eliminates an element with one joint outboard of it, in axes along the link: E₁ = u = A s, E₂ towards the centre of
//! gravity, and E₃ = e₁ × E₂, each of the length ℓ of s. A rotation about u does not move the joint outboard, so its
//! equation involves only the body itself. With the mass m of the body, its first moment (b₁, b₂, 0) and its inertia J
//! about the joint in these axes, this equation is
//!
//! J₁₁ α₁ + J₁₂ α₂ + J₁₃ α₃ + b₂ a₃ + t₁ = 0,   t = ω × Jω
//!
//! With it, α₁ is eliminated by constants, and a 2×2 system is left. Two shifts of the point mass μ of the joint
//! outboard, Q' = Q + (μ' − μ)·1 and Q″ = Q + (μ″ − μ)·1, absorb further terms of the body. With ℓ μ' = −(b₁ + b₂
//! J₁₂/J₁₁), a appears in the second row only through Q'. With ℓ μ″ = −b₁, the first moment of the body is
//! perpendicular to u; then a along e₂ in the third row, and γ(u) everywhere, appear only through Q″:
//!
//! | | |
//! |---|---|
//! | D α₂₃ + (y₂·a + T₂, y₃·a + T₃) = 0 | y₂ = Q'E₃,   y₃ = −Q″E₂ − b₂ (e₁ + (J₁₃/J₁₁) e₃) |
//! | D = \[j₂₂ − E₃Q'E₃, j₂₃ + E₂Q'E₃; ·, j₃₃ − E₂Q″E₂\] | j = J less its first pivot, and μ'ℓ² and μ″ℓ² on the diagonal |
//! | T = (t₂ − E₃·e, t₃ + E₂·e) less (J₁₂, J₁₃)/J₁₁ t₁ | e = h + (μ″ − μ) a₀ − Q″ (β_c + a₀),   β_c = γ(u) |
//! | f = (m + μ') a − (Q' + (b₂²/J₁₁) e₃e₃ᵀ) a + y₂α₂ + y₃α₃ + e + γ(b₂e₂) − (b₂/J₁₁) t₁ e₃ | |

use super::frame::{Frame, Own, along, clean, values};
use super::{ArticulatedBody, Body, BodyWithChildren};
use crate::expression::evaluate::{Inputs, NoFunctions, evaluate};
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::Dimension;

/// The largest |μ'| and |μ″| relative to the mass of the body. Beyond, their rounding errors would spoil Q'.
const LARGEST_SHIFT: f64 = 8.0;

/// The smallest J₁₁ relative to the trace of J; smaller values are taken for rounding.
const SMALLEST_SPIN: f64 = 1e-9;

/// The quantities that the pass outwards needs.
pub(super) struct Link<'g> {
    graph: &'g Graph,
    constants: Constants<'g>,
    /// E₁, E₂, E₃ as columns.
    axes: Mat3<'g>,
    /// β of the joint, its velocity-product acceleration.
    beta: Vec3<'g>,
    /// D₂₃/D₂₂
    lower: Expr<'g>,
    /// D⁻¹L⁻¹ y, for each row of D.
    z: [Vec3<'g>; 2],
    /// D⁻¹L⁻¹ T, for each row of D.
    z_bias: [Expr<'g>; 2],
    /// t₁
    spin: Expr<'g>,
}

/// The constants of the link, in its axes.
struct Constants<'g> {
    frame: Frame,
    /// ℓ
    length: f64,
    mass: Expr<'g>,
    /// b₂
    across: Expr<'g>,
    /// J of the body alone, about the joint.
    inertia: [[Expr<'g>; 3]; 3],
    /// J₁₂/J₁₁, J₁₃/J₁₁
    ratios: [Expr<'g>; 2],
    /// μ'
    outboard: Expr<'g>,
    /// μ″
    outboard_of_velocity: Expr<'g>,
}

/// The axes of a link.
pub(super) struct Axes<'g> {
    constants: Constants<'g>,
    /// E₁, E₂, E₃ as columns.
    absolute: Mat3<'g>,
}

impl<'g> Axes<'g> {
    /// The axes of an element, if `at` is its only joint outboard and its geometry is known in numbers. `defaults` are
    /// the default values of the parameters, on which mass and moments may depend.
    pub(super) fn of(body: &Body<'g, '_>, at: &[Vec3<'g>], defaults: &[f64]) -> Option<Self> {
        let [at] = at else { return None };
        if body.dimension == Dimension::Plane {
            return None;
        }
        let own = Own::of(body.graph, body.element, Vec3::zero(body.graph))?;
        let constants = Constants::of(&own, values(*at)?, defaults)?;
        let absolute = constants.frame.turned(body, constants.length);
        Some(Axes {
            constants,
            absolute,
        })
    }

    /// u of the joint outboard, in absolute axes.
    pub(super) fn offset(&self) -> Vec3<'g> {
        self.absolute.column(0)
    }
}

impl<'g> BodyWithChildren<'g, '_> {
    /// Eliminates an element on which no force acts and that has exactly one child.
    // Long: the formulas of the table above, one after the other; each needs most of those before it.
    pub(super) fn link(
        &self,
        axes: Axes<'g>,
        label: &str,
    ) -> Option<(Link<'g>, ArticulatedBody<'g>)> {
        let graph = self.body.graph;
        let [child] = &self.children[..] else {
            return None;
        };
        let Axes {
            constants,
            absolute: axes,
        } = axes;
        let Constants {
            length,
            mass,
            across,
            inertia: j,
            ratios: [j2, j3],
            ..
        } = constants;
        let spin = j[0][0];
        let ArticulatedBody {
            resistance,
            bias,
            force: outboard_force,
            mass: outboard_mass,
        } = child.response;
        let shifted = |mass: Expr<'g>| {
            let mut shifted = resistance;
            for entry in &mut shifted.diagonal {
                *entry = *entry + (mass - outboard_mass);
            }
            shifted
        };
        let number = |value: f64| graph.constant(value);
        let across_by_length = number(1.0 / length) * across;
        let [e1, e2, e3] = [0, 1, 2].map(|i| axes.column(i));

        graph.section(format!("element {label}: forces of velocity"));
        let omega = self.body.motion.omega;
        let rates = axes.transposed_times(omega);
        let square = self.body.motion.omega_squared();
        let [t1, t2, t3] = match self.body.gyroscopic {
            true => constants.gyroscopic(rates).0,
            false => [number(0.0); 3],
        };
        let mut force = (across_by_length * rates.0[1]) * omega - (across_by_length * square) * e2;

        graph.section(format!("element {label}: what {} passes on", child.label));
        let velocities = shifted(constants.outboard_of_velocity);
        let resisted = velocities.times(child.beta + bias);
        let moved = (constants.outboard_of_velocity - outboard_mass) * bias;
        let passed = outboard_force + moved - resisted;
        force = force + passed;
        let outboard = shifted(constants.outboard);
        let y2 = outboard.times(e3);
        let resisted = velocities.times(e2);
        let mut y3 = -across_by_length * (e1 + j3 * e3) - resisted;
        let scale = spin + j[1][1] + j[2][2];
        let point = number(length * length) * constants.outboard;
        let point_of_velocity = number(length * length) * constants.outboard_of_velocity;
        let reduced = |i: usize, k: usize, ratio: Expr<'g>, point: Expr<'g>| {
            clean(j[i][k] + point - ratio * j[0][k], scale)
        };
        let d22 = reduced(1, 1, j2, point) - e3.dot(y2);
        let d23 = reduced(1, 2, j2, number(0.0)) + e2.dot(y2);
        let mut d33 = reduced(2, 2, j3, point_of_velocity) - e2.dot(resisted);
        let bias2 = t2 - j2 * t1 - e3.dot(passed);
        let mut bias3 = t3 - j3 * t1 + e2.dot(passed);

        graph.section(format!("element {label}: elimination"));
        let inverse2 = d22.recip();
        let lower = d23 * inverse2;
        d33 = d33 - lower * d23;
        let inverse3 = d33.recip();
        y3 = y3 - lower * y2;
        bias3 = bias3 - lower * bias2;
        let z = [inverse2 * y2, inverse3 * y3];
        let z_bias = [inverse2 * bias2, inverse3 * bias3];
        let spinning = (across_by_length * (across_by_length / spin)) * e3;
        let resistance = outboard
            + Sym3::from_fn(|i, k| spinning.0[i] * e3.0[k])
            + Sym3::from_fn(|i, k| z[0].0[i] * y2.0[k])
            + Sym3::from_fn(|i, k| z[1].0[i] * y3.0[k]);
        force = force - ((across_by_length / spin) * t1) * e3 - z_bias[0] * y2 - z_bias[1] * y3;
        let response = ArticulatedBody {
            mass: mass + constants.outboard,
            resistance,
            bias: Vec3::zero(graph),
            force,
        };
        let link = Link {
            graph,
            axes,
            beta: self.beta,
            lower,
            z,
            z_bias,
            spin: t1,
            constants,
        };
        Some((link, response))
    }
}

impl<'g> Link<'g> {
    /// α, and a − β of the joint outboard, given a − β of the joint.
    pub(super) fn angular_acceleration(&self, joint: Vec3<'g>) -> (Vec3<'g>, Vec3<'g>) {
        let Constants {
            length,
            across,
            inertia: j,
            ratios: [j2, j3],
            ..
        } = self.constants;
        let joint = joint + self.beta;
        let [e1, e2, e3] = [0, 1, 2].map(|i| self.axes.column(i));
        let third = -(self.z[1].dot(joint) + self.z_bias[1]);
        let second = -(self.z[0].dot(joint) + self.z_bias[0]) - self.lower * third;
        let outboard = joint + third * e2 - second * e3;
        // From here on, components along E₁, E₂ and E₃ are divided by the length ℓ.
        let inverse = self.graph.constant(1.0 / length);
        let (second, third) = (inverse * second, inverse * third);
        let by_spin = inverse / j[0][0];
        let first = (by_spin * (inverse * across)) * e3.dot(joint)
            + by_spin * self.spin
            + j2 * second
            + j3 * third;
        (second * e2 + third * e3 - first * e1, outboard)
    }
}

impl<'g> Constants<'g> {
    fn of(own: &Own<'g>, at: [f64; 3], defaults: &[f64]) -> Option<Self> {
        let norm = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let length = norm(at);
        if length == 0.0 {
            return None;
        }
        let g = own.center;
        let g1 = (0..3).map(|i| g[i] * at[i]).sum::<f64>() / length;
        let beside: [f64; 3] = std::array::from_fn(|i| g[i] - g1 * at[i] / length);
        let off = !own.mass.is_zero() && norm(beside) > 1e-12 * norm(g);
        let axes = along(at, off.then_some(beside));
        let g2 = if off { norm(beside) } else { 0.0 };

        let (m, mut inertia) = (own.mass, own.inertia(axes));
        let number = |value: f64| m.graph().constant(value);
        inertia[0][0] = inertia[0][0] + number(g2 * g2) * m;
        inertia[1][1] = inertia[1][1] + number(g1 * g1) * m;
        inertia[2][2] = inertia[2][2] + number(g1 * g1 + g2 * g2) * m;
        inertia[0][1] = inertia[0][1] - number(g1 * g2) * m;
        inertia[1][0] = inertia[0][1];
        let scale = inertia[0][0] + inertia[1][1] + inertia[2][2];
        let inertia = inertia.map(|row| row.map(|moment| clean(moment, scale)));
        let spin = inertia[0][0];
        if spin.is_zero() {
            return None;
        }
        let ratios = [inertia[0][1] / spin, inertia[0][2] / spin];
        let outboard_of_velocity = number(-g1 / length) * m;
        let outboard = outboard_of_velocity - number(g2 / length) * m * ratios[0];

        let roots = [spin, scale, m, outboard, outboard_of_velocity];
        let [spin, scale, mass, first, second] = at_defaults(roots, defaults);
        let shift = first.abs().max(second.abs());
        let sound = spin > SMALLEST_SPIN * scale && shift <= LARGEST_SHIFT * mass;
        sound.then_some(Constants {
            frame: Frame::new(axes),
            length,
            mass: m,
            across: number(g2) * m,
            inertia,
            ratios,
            outboard,
            outboard_of_velocity,
        })
    }

    /// ω × Jω of the body with the point mass μ″ at the joint outboard; `rates` is ℓω in the axes of the link.
    fn gyroscopic(&self, rates: Vec3<'g>) -> Vec3<'g> {
        let number = |value: f64| self.mass.graph().constant(value);
        let square = self.length * self.length;
        let mut j = self.inertia;
        for i in [1, 2] {
            j[i][i] = j[i][i] + number(square) * self.outboard_of_velocity;
        }
        // Adding a multiple of 1 to J does not change ω × Jω, so the diagonal entry of the row with most zeros is
        // subtracted.
        let zeros = |i: &usize| j[*i].iter().filter(|entry| entry.is_zero()).count();
        let same = (0..3)
            .rev()
            .max_by_key(zeros)
            .map_or(number(0.0), |i| j[i][i]);
        let scale = self.inertia[0][0] + self.inertia[1][1] + self.inertia[2][2];
        for (i, row) in j.iter_mut().enumerate() {
            row[i] = clean(row[i] - same, scale);
        }
        let momentum = j.map(|row| Vec3(row.map(|entry| number(1.0 / square) * entry)).dot(rates));
        rates.cross(Vec3(momentum))
    }
}

/// The values at the default values of the parameters; the expressions may depend on parameters alone.
fn at_defaults<const N: usize>(values: [Expr<'_>; N], defaults: &[f64]) -> [f64; N] {
    if let Some(numbers) = values
        .iter()
        .map(|v| v.as_constant())
        .collect::<Option<Vec<f64>>>()
    {
        return std::array::from_fn(|i| numbers[i]);
    }
    let inputs = Inputs {
        time: 0.0,
        coordinates: &[],
        velocities: &[],
        parameters: defaults,
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    let roots = values.map(|value| value.id());
    let found = evaluate(values[0].graph(), &roots, &inputs, &NoFunctions);
    std::array::from_fn(|i| found[i])
}
