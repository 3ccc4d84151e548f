//! What a rigid body is about a point: mass, first moment and second moment, and how they go from one frame to another.
//!
//! J = tr Σ · 1 − Σ is the inertia about the point. Σ = ∫ρρᵀ is what can be moved in parts: what lies on the axis of a hinge is seen by
//! the carrier alone.

use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Expr, Graph};

/// m, h and Σ about an origin.
#[derive(Clone, Copy)]
pub struct Body<'g> {
    /// m \[kg\]; of regrouped bodies of any sign.
    pub mass: Expr<'g>,
    /// h = m c \[kg m\]
    pub first: Vec3<'g>,
    /// Σ = ∫ρρᵀ \[kg m²\]
    pub second: Sym3<'g>,
}

impl<'g> Body<'g> {
    /// Nothing.
    pub fn none(graph: &'g Graph) -> Self {
        Body {
            mass: graph.constant(0.0),
            first: Vec3::zero(graph),
            second: Sym3::zero(graph),
        }
    }

    /// The body about the point −d: Σ + h dᵀ + d hᵀ + m d dᵀ, h + m d.
    pub fn moved(&self, d: Vec3<'g>) -> Self {
        let first = self.first + self.mass * d;
        let (h, k) = (self.first.0, first.0);
        let moved = Sym3::from_fn(|i, j| h[i] * d.0[j] + d.0[i] * k[j]);
        Body {
            mass: self.mass,
            first,
            second: self.second + moved,
        }
    }

    /// In axes that are the rows of a constant matrix.
    pub fn in_axes(&self, axes: &[[f64; 3]; 3]) -> Self {
        let first = in_axes(axes, self.first);
        let half = axes.map(|row| in_axes_of(&self.second, row));
        Body {
            mass: self.mass,
            first,
            second: Sym3::from_fn(|i, j| weighted(axes[i], half[j].0)),
        }
    }

    /// Both together, about the same origin.
    pub fn plus(&self, other: &Self) -> Self {
        Body {
            mass: self.mass + other.mass,
            first: self.first + other.first,
            second: self.second + other.second,
        }
    }

    /// Without what only rounding has left.
    pub fn cleaned(&self) -> Self {
        let entries = self.second.diagonal.iter().chain(&self.second.off);
        let largest = largest(entries);
        Body {
            mass: self.mass,
            first: cleaned(self.first),
            second: Sym3::from_fn(|i, j| without_rounding(self.second.entry(i, j), largest)),
        }
    }

    /// J = tr Σ · 1 − Σ
    pub fn inertia(&self) -> Sym3<'g> {
        let [x, y, z] = self.second.diagonal;
        let sums = [y + z, x + z, x + y];
        Sym3::from_fn(|i, j| match i == j {
            true => sums[i],
            false => -self.second.entry(i, j),
        })
    }
}

/// Relative size below which a constant is rounding.
const ROUNDING: f64 = 4e-15;

fn largest<'a, 'g: 'a>(entries: impl Iterator<Item = &'a Expr<'g>>) -> f64 {
    let constants = entries.filter_map(|e| e.as_constant());
    constants.fold(0.0, |m: f64, c| m.max(c.abs()))
}

fn without_rounding<'g>(value: Expr<'g>, scale: f64) -> Expr<'g> {
    match value.as_constant() {
        Some(c) if c.abs() <= ROUNDING * scale => value.graph().constant(0.0),
        _ => value,
    }
}

/// A constant vector without what only rounding has left.
pub fn cleaned(v: Vec3<'_>) -> Vec3<'_> {
    let largest = largest(v.0.iter());
    Vec3(v.0.map(|a| without_rounding(a, largest)))
}

fn weighted<'g>(weights: [f64; 3], values: [Expr<'g>; 3]) -> Expr<'g> {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
}

/// A vector in axes that are the rows of a constant matrix.
pub fn in_axes<'g>(axes: &[[f64; 3]; 3], v: Vec3<'g>) -> Vec3<'g> {
    Vec3(axes.map(|row| weighted(row, v.0)))
}

fn in_axes_of<'g>(m: &Sym3<'g>, row: [f64; 3]) -> Vec3<'g> {
    Vec3([0, 1, 2].map(|i| weighted(row, [0, 1, 2].map(|j| m.entry(i, j)))))
}
