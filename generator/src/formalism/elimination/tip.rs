//! An element that carries nothing. Free, it would turn as Euler's equations say, α_e = −I⁻¹(ω × Iω), and its joint would
//! move with −a_e, a_e = α_e × g + γ(g), while its centre of gravity rests. What a joint does beyond that it does to a
//! body at rest: with J = I + m (g²·1 − g gᵀ) and b = m g,
//!
//! f = μ a − Q (a + a_e) + m a_e,   Q = −b̃ J⁻¹ b̃,   α = α_e − J⁻¹ (b × (a + a_e)),   μ = m
//!
//! J⁻¹, Q and J⁻¹ b̃ are numbers in the frame of the body, the latter two of rank two: Q b = 0, and b·J (α − α_e) = 0.
//! Children whose joints are at the origin of the element ask nothing more of it: their answers add to its own.

use super::frame::{Frame, Own, along, clean, cleaned, values};
use super::{Place, Response};
use crate::expression::graph::sum;
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph};
use crate::formalism::augmented::rotated_numbers;
use crate::model::Dimension;
use std::array::from_fn;

/// What the way outwards needs.
pub(super) struct Tip<'g> {
    graph: &'g Graph,
    /// Principal axes of I, absolute, as columns.
    axes: Mat3<'g>,
    /// α_e in them.
    free: Vec3<'g>,
    /// β + a_e of the joint, absolute.
    bias: Vec3<'g>,
    /// −J⁻¹ b̃, in the principal axes.
    turning: [[Expr<'g>; 3]; 3],
    /// J b by m, in the principal axes.
    idle: [f64; 3],
}

impl<'g> Place<'g, '_> {
    /// Eliminates the element, if it is one that carries nothing but at its origin, is a body of numbers and bears no load.
    pub(super) fn tip(&self, label: &str) -> Option<(Tip<'g>, Response<'g>)> {
        let graph = self.seat.graph;
        let bare = self.children.iter().all(|child| child.offset.is_zero());
        if self.seat.dimension == Dimension::Plane || !bare || !self.load.is_zero() {
            return None;
        }
        graph.section(format!("element {label}: free body"));
        let own = Own::of(graph, self.seat.element, self.origin)?;
        let moments = values(own.principal)?;
        if moments.iter().any(|&moment| moment <= 0.0) {
            return None;
        }
        let frame = Frame::new(own.principal_axes);
        let axes = frame.turned(&self.seat, 1.0);
        let g = frame.components(own.center);
        let free_rates = match self.seat.gyroscopic {
            true => free_rates(moments),
            false => [0.0; 3],
        };
        let omega = axes.transposed_times(self.seat.motion.omega);
        let free = rates(omega, free_rates);
        let bias = axes.times(tip_acceleration(graph, omega, free_rates, g));

        let pinned = Pinned::of(own.mass, moments, g);
        let mut response = Response {
            mass: own.mass,
            resistance: pinned.resistance(&axes),
            bias,
            force: own.mass * bias,
        };
        if !self.children.is_empty() {
            response.force = response.force - response.resistance.times(bias);
            response.bias = Vec3::zero(graph);
        }
        for Response {
            mass,
            resistance,
            bias,
            force,
        } in self.children.iter().map(|child| child.response)
        {
            response.mass = response.mass + mass;
            response.force = response.force + force - resistance.times(bias);
            response.resistance = response.resistance + resistance;
        }
        let tip = Tip {
            graph,
            axes,
            free,
            bias: self.beta + bias,
            turning: pinned.turning(),
            idle: from_fn(|i| moments[i] * g[i]),
        };
        Some((tip, response))
    }
}

impl<'g> Tip<'g> {
    /// α = α_e − J⁻¹ (b × (a + a_e)); `joint` is a − β.
    pub(super) fn angular_acceleration(&self, joint: Vec3<'g>) -> Vec3<'g> {
        let graph = self.graph;
        let number = |value: f64| graph.constant(value);
        let beyond = self.axes.transposed_times(joint + self.bias);
        let row = |i: usize| Vec3(self.turning[i]).dot(beyond);
        // Two of the components give the third.
        let third = (0..3)
            .max_by(|&i, &j| self.idle[i].abs().total_cmp(&self.idle[j].abs()))
            .unwrap_or(2);
        let mut alpha = Vec3::zero(graph);
        let mut rest = graph.constant(0.0);
        for i in (0..3).filter(|&i| i != third) {
            alpha.0[i] = row(i);
            rest = rest + number(cleaned(self.idle[i] / self.idle[third], 1.0)) * alpha.0[i];
        }
        alpha.0[third] = if self.idle[third] == 0.0 {
            row(third)
        } else {
            -rest
        };
        self.axes.times(alpha + self.free)
    }
}

/// (κ₁ ω₂ω₃, κ₂ ω₃ω₁, κ₃ ω₁ω₂)
fn rates<'g>(omega: Vec3<'g>, factors: [f64; 3]) -> Vec3<'g> {
    let [x, y, z] = omega.0;
    Vec3([
        factors[0] * (y * z),
        factors[1] * (x * z),
        factors[2] * (x * y),
    ])
}

/// α_e × g + ω × (ω × g) in principal axes.
fn tip_acceleration<'g>(
    graph: &'g Graph,
    omega: Vec3<'g>,
    factors: [f64; 3],
    g: [f64; 3],
) -> Vec3<'g> {
    let [x, y, z] = omega.0;
    // By axis: the product of the other two rates, and the sum of their squares.
    let products = [y * z, x * z, x * y];
    let squares = omega.0.map(|rate| rate.squared());
    Vec3(from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sum: Expr<'g> = squares[j.min(k)] + squares[j.max(k)];
        graph.constant((1.0 + factors[j]) * g[k]) * products[j]
            + graph.constant((1.0 - factors[k]) * g[j]) * products[k]
            - graph.constant(g[i]) * sum
    }))
}

/// κ: α_e = (κ₁ ω₂ω₃, κ₂ ω₃ω₁, κ₃ ω₁ω₂) in principal axes.
fn free_rates([x, y, z]: [f64; 3]) -> [f64; 3] {
    [(y - z) / x, (z - x) / y, (x - y) / z]
}

/// What is constant of a body held at its joint, in axes of which the first is along g. Of J⁻¹ only the block across g is
/// needed, the inverse N of J less its first pivot:
///
/// Q = b² \[\[N₃₃, −N₂₃\], \[−N₂₃, N₂₂\]\],   −J⁻¹ b̃ x = b (…, N₂₂ x₃ − N₂₃ x₂, N₂₃ x₃ − N₃₃ x₂)
struct Pinned<'g> {
    /// The axes, in principal axes.
    axes: [[f64; 3]; 3],
    /// b
    moment: Expr<'g>,
    /// N₂₂, N₃₃, N₂₃
    inverse: [Expr<'g>; 3],
    /// I₁₂/I₁₁, I₁₃/I₁₁
    ratios: [f64; 2],
}

impl<'g> Pinned<'g> {
    fn of(mass: Expr<'g>, principal: [f64; 3], g: [f64; 3]) -> Self {
        let graph = mass.graph();
        let number = |value: f64| graph.constant(value);
        let length = g.iter().map(|c| c * c).sum::<f64>().sqrt();
        let axes = match length {
            0.0 => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            _ => along(g, None),
        };
        let size: f64 = principal.iter().sum();
        let own = |i: usize, j: usize| {
            let terms = (0..3).map(|k| axes[i][k] * principal[k] * axes[j][k]);
            cleaned(terms.sum(), size)
        };
        let (spin, first, second) = (own(0, 0), own(0, 1), own(0, 2));
        let transverse = number(length * length) * mass;
        let m22 = number(own(1, 1) - first * first / spin) + transverse;
        let m33 = number(own(2, 2) - second * second / spin) + transverse;
        let m23 = number(cleaned(own(1, 2) - first * second / spin, size));
        let determinant = m22 * m33 - m23 * m23;
        Pinned {
            axes,
            moment: number(length) * mass,
            inverse: [m33 / determinant, m22 / determinant, -m23 / determinant],
            ratios: [first / spin, second / spin],
        }
    }

    /// Q in absolute axes, from the principal axes there.
    fn resistance(&self, principal: &Mat3<'g>) -> Sym3<'g> {
        let graph = self.moment.graph();
        let [n22, n33, n23] = self.inverse;
        let square = self.moment * self.moment;
        let entries = [square * n33, square * n22, -(square * n23)];
        if let [Some(q22), Some(q33), Some(q23)] = entries.map(|entry| entry.as_constant()) {
            let matrix = [[0.0; 3], [0.0, q22, q23], [0.0, q23, q33]];
            let scale = q22.max(q33);
            let back =
                from_fn(|i| from_fn(|j| cleaned(self.back(i, j, |k, l| matrix[k][l]), scale)));
            return rotated_numbers(graph, principal, back, 0.0);
        }
        // of parameters, as L D Lᵀ
        let [second, third] =
            [1, 2].map(|k| principal.times(Vec3(self.axes[k].map(|c| graph.constant(c)))));
        let first = second - (n23 / n33) * third;
        let rest = square * (n22 - n23 * (n23 / n33));
        let (scaled, scaled_third) = (entries[0] * first, rest * third);
        Sym3::from_fn(|i, j| scaled.0[i] * first.0[j] + scaled_third.0[i] * third.0[j])
    }

    /// −J⁻¹ b̃ in principal axes.
    fn turning(&self) -> [[Expr<'g>; 3]; 3] {
        let graph = self.moment.graph();
        let [n22, n33, n23] = self.inverse.map(|n| self.moment * n);
        let [first, second] = self.ratios.map(|ratio| graph.constant(ratio));
        let rows = [[-n23, n22], [-n33, n23]];
        let about = |j: usize| -(first * rows[0][j] + second * rows[1][j]);
        let matrix = [[about(0), about(1)], rows[0], rows[1]];
        let scale = n22 + n33;
        from_fn(|i| {
            from_fn(|j| {
                let terms = (0..3).flat_map(|k| [1, 2].map(|l| (k, l)));
                let terms = terms.map(|(k, l)| {
                    graph.constant(self.axes[k][i] * self.axes[l][j]) * matrix[k][l - 1]
                });
                clean(sum(graph, terms), scale)
            })
        })
    }

    /// Entry of a matrix given in these axes, in principal axes.
    fn back(&self, i: usize, j: usize, entry: impl Fn(usize, usize) -> f64) -> f64 {
        let terms = (0..3).flat_map(|k| (0..3).map(move |l| (k, l)));
        terms
            .map(|(k, l)| self.axes[k][i] * entry(k, l) * self.axes[l][j])
            .sum()
    }
}
