//! Eliminates an element without elements outboard. If it were free, Euler's equations would give α_e = −I⁻¹(ω × Iω),
//! its centre of gravity would not accelerate, and its joint would accelerate by −a_e, where a_e = α_e × g + γ(g).
//! Relative to this motion the joint acts on a body at rest: with J = I + m (g²·1 − g gᵀ) and b = m g,
//!
//! f = μ a − Q (a + a_e) + m a_e,   Q = −b̃ J⁻¹ b̃,   α = α_e − J⁻¹ (b × (a + a_e)),   μ = m
//!
//! J⁻¹, Q and J⁻¹ b̃ are constant in the frame of the body. Q and J⁻¹ b̃ have rank two, because an acceleration of the
//! joint along b has no effect: with two vectors p perpendicular to b, Q = Σ d p pᵀ and −J⁻¹ (b × x) = Σ r (p·x).
//! Children whose joints are at the origin of the element are allowed: their articulated inertias are simply added.

use super::frame::{Frame, Own, along, clean, cleaned, values};
use super::{ArticulatedBody, BodyWithChildren};
use crate::dynamics::augmented_body::{sum_of_squares, terms_of_rank_two};
use crate::expression::graph::sum;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::Dimension;
use std::array::from_fn;

/// The quantities that the pass outwards needs.
pub(super) struct Tip<'g> {
    /// The principal axes of I, in absolute axes, as columns.
    axes: Mat3<'g>,
    /// α_e, in the principal axes.
    free: Vec3<'g>,
    /// β + a_e of the joint, in absolute axes.
    bias: Vec3<'g>,
    /// p in absolute axes, and r in the principal axes.
    turns: Vec<(Vec3<'g>, Vec3<'g>)>,
}

impl<'g> BodyWithChildren<'g, '_> {
    /// Eliminates the element. `None` unless the model is spatial, all children are at the origin of the element, its
    /// constants are numbers with positive moments of inertia, and no force acts on it.
    pub(super) fn tip(&self, label: &str) -> Option<(Tip<'g>, ArticulatedBody<'g>)> {
        let graph = self.body.graph;
        let bare = self.children.iter().all(|child| child.offset.is_zero());
        if self.body.dimension == Dimension::Plane || !bare || !self.load.is_zero() {
            return None;
        }
        graph.section(format!("element {label}: free body"));
        let own = Own::of(graph, self.body.element, self.origin)?;
        let moments = values(own.principal)?;
        if moments.iter().any(|&moment| moment <= 0.0) {
            return None;
        }
        let frame = Frame::new(own.principal_axes);
        let axes = frame.turned(&self.body, 1.0);
        let g = frame.components(own.center);
        let free_rates = match self.body.gyroscopic {
            true => free_rates(moments),
            false => [0.0; 3],
        };
        let omega = axes.transposed_times(self.body.motion.omega);
        let free = rates(omega, free_rates);
        let bias = axes.times(tip_acceleration(graph, omega, free_rates, g));

        let pinned = Pinned::of(own.mass, moments, g);
        let answers = pinned.answers();
        let across: Vec<_> = answers
            .iter()
            .map(|answer| axes.times(answer.across))
            .collect();
        let terms: Vec<_> = answers
            .iter()
            .map(|answer| answer.resistance)
            .zip(across.iter().copied())
            .collect();
        let mut response = ArticulatedBody {
            mass: own.mass,
            resistance: sum_of_squares(graph.constant(0.0), &terms, pinned.trace()),
            bias,
            force: own.mass * bias,
        };
        if !self.children.is_empty() {
            response.force = response.force - response.resistance.times(bias);
            response.bias = Vec3::zero(graph);
        }
        for ArticulatedBody {
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
            axes,
            free,
            bias: self.beta + bias,
            turns: across
                .into_iter()
                .zip(answers.iter().map(|answer| answer.turn))
                .collect(),
        };
        Some((tip, response))
    }
}

impl<'g> Tip<'g> {
    /// α = α_e − J⁻¹ (b × (a + a_e)); `joint` is a − β.
    pub(super) fn angular_acceleration(&self, joint: Vec3<'g>) -> Vec3<'g> {
        let beyond = joint + self.bias;
        let mut alpha = self.free;
        for &(across, turn) in &self.turns {
            alpha = alpha + across.dot(beyond) * turn;
        }
        self.axes.times(alpha)
    }
}

/// The vector (κ₁ ω₂ω₃, κ₂ ω₃ω₁, κ₃ ω₁ω₂); `factors` are the κ.
fn rates<'g>(omega: Vec3<'g>, factors: [f64; 3]) -> Vec3<'g> {
    let [x, y, z] = omega.0;
    Vec3([
        factors[0] * (y * z),
        factors[1] * (x * z),
        factors[2] * (x * y),
    ])
}

/// a_e = α_e × g + ω × (ω × g), in principal axes; `factors` are the κ of α_e.
fn tip_acceleration<'g>(
    graph: &'g Graph,
    omega: Vec3<'g>,
    factors: [f64; 3],
    g: [f64; 3],
) -> Vec3<'g> {
    let [x, y, z] = omega.0;
    // For each axis, the product of the other two rates, and the sum of their squares.
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

/// The κ in α_e = (κ₁ ω₂ω₃, κ₂ ω₃ω₁, κ₃ ω₁ω₂), in principal axes.
fn free_rates([x, y, z]: [f64; 3]) -> [f64; 3] {
    [(y - z) / x, (z - x) / y, (x - y) / z]
}

/// One term of Q and of −J⁻¹ b̃: the effect of the joint's acceleration along one vector p perpendicular to b.
pub struct Answer<'g> {
    /// d \[kg\]
    pub resistance: Expr<'g>,
    /// p, in principal axes.
    pub across: Vec3<'g>,
    /// r, in principal axes \[1/m\].
    pub turn: Vec3<'g>,
}

/// The constants of a body that is held at its joint, in axes of which the first is along g. Only the block of J⁻¹
/// perpendicular to g is needed. It is the inverse N of what is left of J after elimination of its first pivot:
///
/// Q = b² \[\[N₃₃, −N₂₃\], \[−N₂₃, N₂₂\]\],   −J⁻¹ b̃ x = b (…, N₂₂ x₃ − N₂₃ x₂, N₂₃ x₃ − N₃₃ x₂)
pub struct Pinned<'g> {
    /// The axes, as components in the principal axes.
    axes: [[f64; 3]; 3],
    /// b
    moment: Expr<'g>,
    /// N₂₂, N₃₃, N₂₃
    inverse: [Expr<'g>; 3],
    /// I₁₂/I₁₁, I₁₃/I₁₁
    ratios: [f64; 2],
}

impl<'g> Pinned<'g> {
    pub fn of(mass: Expr<'g>, principal: [f64; 3], g: [f64; 3]) -> Self {
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

    /// The trace of Q.
    fn trace(&self) -> Expr<'g> {
        let [n22, n33, _] = self.inverse;
        self.moment * self.moment * (n22 + n33)
    }

    /// The terms of Q and −J⁻¹ b̃, one for each vector p: none if b is 0, otherwise two.
    pub fn answers(&self) -> Vec<Answer<'g>> {
        if self.moment.is_zero() {
            return Vec::new();
        }
        let graph = self.moment.graph();
        let number = |value: f64| graph.constant(value);
        let [n22, n33, n23] = self.inverse;
        let square = self.moment * self.moment;
        let axis = |k: usize| Vec3(self.axes[k].map(number));
        let vectors = self.numbers().unwrap_or_else(|| {
            let ratio = n23 / n33;
            [
                (square * n33, axis(1) - ratio * axis(2)),
                (square * (n22 - n23 * ratio), axis(2)),
            ]
        });

        // in these axes: −J⁻¹ b̃ x as a function of x₂ and x₃; and x₂ and x₃ as functions of the two products p·x
        let [n22, n33, n23] = self.inverse.map(|n| self.moment * n);
        let [first, second] = self.ratios.map(number);
        let columns = [[-n23, -n33], [n22, n23]].map(|[x, y]| [-(first * x + second * y), x, y]);
        let [[a, b], [c, d]] = vectors.map(|(_, p)| [axis(1).dot(p), axis(2).dot(p)]);
        let determinant = a * d - b * c;
        let inverse = [[d, -c], [-b, a]].map(|row| row.map(|entry| entry / determinant));
        let scale = n22 + n33;
        let turn = |[of_second, of_third]: [Expr<'g>; 2]| {
            Vec3(from_fn(|i| {
                let terms = (0..3).map(|k| {
                    let turned = of_second * columns[0][k] + of_third * columns[1][k];
                    number(self.axes[k][i]) * turned
                });
                clean(sum(graph, terms), scale)
            }))
        };
        let answers = vectors.into_iter().zip(inverse);
        let answers = answers.map(|((resistance, across), row)| Answer {
            resistance,
            across,
            turn: turn(row),
        });
        answers.collect()
    }

    /// The d and p of Q as numbers, with as many zeros in p as possible; `None` if an entry of Q is not a number.
    fn numbers(&self) -> Option<[(Expr<'g>, Vec3<'g>); 2]> {
        let graph = self.moment.graph();
        let [n22, n33, n23] = self.inverse;
        let square = self.moment * self.moment;
        let [q22, q33, q23] =
            [square * n33, square * n22, -(square * n23)].map(|q| q.as_constant());
        let (q22, q33, q23) = (q22?, q33?, q23?);
        let matrix = [[0.0; 3], [0.0, q22, q23], [0.0, q23, q33]];
        let principal = from_fn(|i| {
            from_fn(|j| {
                let terms = (0..3).flat_map(|k| (0..3).map(move |l| (k, l)));
                let terms = terms.map(|(k, l)| self.axes[k][i] * matrix[k][l] * self.axes[l][j]);
                cleaned(terms.sum(), q22.max(q33))
            })
        });
        let terms = terms_of_rank_two(principal, 0.0).into_iter();
        let vectors: Vec<_> = terms
            .map(|(d, p)| {
                (
                    graph.constant(d),
                    Vec3(p.map(|component| graph.constant(component))),
                )
            })
            .collect();
        vectors.try_into().ok()
    }
}
