//! The mass properties of a rigid body about a point (mass, first moment and second moment), and how they change from
//! one frame to another.
//!
//! J = tr Σ · 1 − Σ is the inertia about the point. Unlike J, Σ = ∫ρρᵀ can be divided into parts that are moved
//! separately, as regrouping needs: mass on the axis of a hinge acts on the carrier alone.

use super::frames::Matrix;
use super::tree::LinkJoint;
use super::turn::Turn;
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Expr, Graph};

/// m, h and Σ about an origin.
#[derive(Clone, Copy)]
pub struct Body<'g> {
    /// m \[kg\]; it may have any sign after regrouping.
    pub mass: Expr<'g>,
    /// h = m c \[kg m\]
    pub first: Vec3<'g>,
    /// Σ = ∫ρρᵀ \[kg m²\]
    pub second: Sym3<'g>,
    /// The largest numbers from which h and Σ were computed. Entries far below these are rounding.
    pub sizes: [f64; 2],
}

impl<'g> Body<'g> {
    /// A body without mass.
    pub fn none(graph: &'g Graph) -> Self {
        Body {
            mass: graph.constant(0.0),
            first: Vec3::zero(graph),
            second: Sym3::zero(graph),
            sizes: [0.0; 2],
        }
    }

    /// The body with its sizes raised to the largest of its own entries and of `others`.
    fn sized(mut self, others: [f64; 2]) -> Self {
        let entries = self.second.diagonal.iter().chain(&self.second.off);
        let own = [largest(self.first.0.iter()), largest(entries)];
        self.sizes = [0, 1].map(|i| own[i].max(others[i]));
        self
    }

    /// The body about the point −d: Σ + h dᵀ + d hᵀ + m d dᵀ, h + m d.
    pub fn moved(&self, d: Vec3<'g>) -> Self {
        let first = self.first + self.mass * d;
        let (h, k) = (self.first.0, first.0);
        let moved = Sym3::from_fn(|i, j| match i == j && self.mass.is_zero() {
            true => (2.0 * d.0[i]) * h[i],
            false => h[i] * d.0[j] + d.0[i] * k[j],
        });
        Body {
            mass: self.mass,
            first,
            second: self.second + moved,
            sizes: self.sizes,
        }
        .sized(self.sizes)
    }

    /// The body in axes that are the rows of a constant matrix.
    pub fn in_axes(&self, axes: &[[f64; 3]; 3]) -> Self {
        let first = in_axes(axes, self.first);
        let half = axes.map(|row| in_axes_of(&self.second, row));
        Body {
            mass: self.mass,
            first,
            second: Sym3::from_fn(|i, j| weighted(axes[i], half[j].0)),
            sizes: self.sizes,
        }
    }

    /// The body in axes that follow from its own by several rotations, in order.
    pub fn turned(&self, turns: &[Turn<'g>]) -> Self {
        turns.iter().fold(*self, |body, turn| Body {
            mass: body.mass,
            first: turn.vector(body.first),
            second: turn.symmetric(body.second),
            sizes: body.sizes,
        })
    }

    /// The sum of two bodies about the same origin.
    pub fn plus(&self, other: &Self) -> Self {
        Body {
            mass: self.mass + other.mass,
            first: self.first + other.first,
            second: self.second + other.second,
            sizes: self.sizes,
        }
        .sized([0, 1].map(|i| self.sizes[i].max(other.sizes[i])))
    }

    /// The difference of two bodies about the same origin.
    pub fn minus(&self, other: &Self) -> Self {
        Body {
            mass: self.mass - other.mass,
            first: self.first - other.first,
            second: self.second - other.second,
            sizes: self.sizes,
        }
        .sized([0, 1].map(|i| self.sizes[i].max(other.sizes[i])))
    }

    /// The part of the body that does not resist the motion of its joint.
    pub fn not_resisting(&self, joint: &LinkJoint<'g>) -> Self {
        let graph = self.mass.graph();
        let mut part = Body::none(graph);
        match joint {
            LinkJoint::Ball { .. } => part.mass = self.mass,
            LinkJoint::Axis { axis, .. } if joint.is_hinge() => {
                let along = weighted(*axis, self.first.0);
                let spread = weighted(*axis, in_axes_of(&self.second, *axis).0);
                part.mass = self.mass;
                part.first = Vec3(axis.map(|a| a * along));
                part.second = Sym3::from_fn(|i, j| (axis[i] * axis[j]) * spread);
            }
            LinkJoint::Axis { .. } if joint.slides_alone() => part.second = self.second,
            LinkJoint::Axis { .. } => {}
        }
        part
    }

    /// The body after regrouping, without entries that are only rounding; entries that do not resist a hinge
    /// about z are set to exactly 0.
    pub fn regrouped(&self, joint: &LinkJoint<'g>) -> Self {
        let zero = self.mass.graph().constant(0.0);
        let mut body = *self;
        if joint.is_hinge() {
            body.first.0[2] = zero;
            body.second.diagonal[2] = zero;
        }
        body.cleaned()
    }

    /// The body without values that are only rounding.
    fn cleaned(&self) -> Self {
        let [first, second] = self.sizes;
        Body {
            mass: self.mass,
            first: Vec3(self.first.0.map(|a| without_rounding(a, first))),
            second: Sym3::from_fn(|i, j| without_rounding(self.second.entry(i, j), second)),
            sizes: self.sizes,
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

/// A [`Body`] in numbers. Its operations are the same as those of a body, in the same order.
#[derive(Clone, Copy)]
pub struct Numbers {
    mass: f64,
    pub first: [f64; 3],
    /// Symmetric.
    second: Matrix,
    /// As in [`Body::sizes`].
    pub sizes: [f64; 2],
}

impl Numbers {
    /// `None` if an entry is not a number.
    pub fn of(body: &Body<'_>) -> Option<Self> {
        let mut second = [[0.0; 3]; 3];
        for (i, row) in second.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = body.second.entry(i, j).as_constant()?;
            }
        }
        Some(Numbers {
            mass: body.mass.as_constant()?,
            first: numbers(body.first)?,
            second,
            sizes: body.sizes,
        })
    }

    /// A point mass at the origin.
    pub fn point(mass: f64) -> Self {
        Numbers {
            mass,
            first: [0.0; 3],
            second: [[0.0; 3]; 3],
            sizes: [0.0; 2],
        }
    }

    /// The body as constants of a graph.
    pub fn body<'g>(&self, graph: &'g Graph) -> Body<'g> {
        Body {
            mass: graph.constant(self.mass),
            first: Vec3(self.first.map(|h| graph.constant(h))),
            second: Sym3::from_fn(|i, j| graph.constant(self.second[i][j])),
            sizes: self.sizes,
        }
    }

    fn sized(mut self, others: [f64; 2]) -> Self {
        let largest = |entries: &[f64]| entries.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let own = [largest(&self.first), largest(self.second.as_flattened())];
        self.sizes = [0, 1].map(|i| own[i].max(others[i]));
        self
    }

    /// See [`Body::moved`].
    pub fn moved(&self, d: [f64; 3]) -> Self {
        let first = [0, 1, 2].map(|i| self.first[i] + self.mass * d[i]);
        let (h, k) = (self.first, first);
        let second = symmetric(|i, j| {
            let moved = match i == j && self.mass == 0.0 {
                true => (2.0 * d[i]) * h[i],
                false => h[i] * d[j] + d[i] * k[j],
            };
            self.second[i][j] + moved
        });
        Numbers {
            first,
            second,
            ..*self
        }
        .sized(self.sizes)
    }

    /// See [`Body::in_axes`].
    pub fn in_axes(&self, axes: &Matrix) -> Self {
        let weighted = |w: [f64; 3], v: [f64; 3]| w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
        let half = axes.map(|row| self.second.map(|entries| weighted(row, entries)));
        Numbers {
            first: axes.map(|row| weighted(row, self.first)),
            second: symmetric(|i, j| weighted(axes[i], half[j])),
            ..*self
        }
    }

    fn combined(&self, other: &Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Numbers {
            mass: of(self.mass, other.mass),
            first: [0, 1, 2].map(|i| of(self.first[i], other.first[i])),
            second: symmetric(|i, j| of(self.second[i][j], other.second[i][j])),
            sizes: self.sizes,
        }
        .sized([0, 1].map(|i| self.sizes[i].max(other.sizes[i])))
    }

    /// See [`Body::plus`].
    pub fn plus(&self, other: &Self) -> Self {
        self.combined(other, |a, b| a + b)
    }

    /// See [`Body::minus`].
    pub fn minus(&self, other: &Self) -> Self {
        self.combined(other, |a, b| a - b)
    }

    /// The part of a body that does not resist a hinge about z.
    pub fn not_resisting_about_z(&self) -> Self {
        let mut part = Self::point(self.mass);
        part.first[2] = self.first[2];
        part.second[2][2] = self.second[2][2];
        part
    }

    /// See [`Body::regrouped`]; the axis of a hinge is z.
    pub fn regrouped(mut self, of_hinge: bool) -> Self {
        if of_hinge {
            self.first[2] = 0.0;
            self.second[2][2] = 0.0;
        }
        let without = |value: f64, scale: f64| match value.abs() <= ROUNDING * scale {
            true => 0.0,
            false => value,
        };
        let [first, second] = self.sizes;
        self.first = self.first.map(|h| without(h, first));
        self.second = self.second.map(|row| row.map(|a| without(a, second)));
        self
    }

    /// The body in another unit of length.
    pub fn in_unit(&self, unit: f64) -> Self {
        Numbers {
            mass: (unit * unit) * self.mass,
            first: self.first.map(|h| unit * h),
            second: self.second,
            sizes: [unit * self.sizes[0], self.sizes[1]],
        }
    }
}

/// The symmetric matrix with the entries `of(i, j)`, which is called with i ≤ j only, as in [`Sym3::from_fn`].
fn symmetric(of: impl Fn(usize, usize) -> f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| of(i.min(j), i.max(j))))
}

/// The components of a constant vector; `None` if a component is not a number.
pub fn numbers(v: Vec3<'_>) -> Option<[f64; 3]> {
    let [x, y, z] = v.0.map(|e| e.as_constant());
    Some([x?, y?, z?])
}

/// The relative size below which a constant counts as rounding.
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

/// A constant vector without components that are only rounding.
pub fn cleaned(v: Vec3<'_>) -> Vec3<'_> {
    let largest = largest(v.0.iter());
    Vec3(v.0.map(|a| without_rounding(a, largest)))
}

/// A vector of numbers without components that are only rounding.
pub fn cleaned_numbers(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    v.map(|c| {
        if c.abs() <= ROUNDING * largest {
            0.0
        } else {
            c
        }
    })
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
