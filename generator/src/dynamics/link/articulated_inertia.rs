//! Articulated inertia in the frames of links: for accelerations Δ in addition to the reference motion, the bodies
//! outboard of a joint need the wrench f = K Δa + Bᵀ Δα + f₀, n = B Δa + J Δα + n₀.

use super::frames::FramedLink;
use super::turn::{Turn, through};
use crate::dynamics::factorization::Ldl;
use crate::dynamics::spatial::Wrench;
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph};

/// Articulated inertia and bias of the bodies outboard of a joint.
#[derive(Clone, Copy)]
pub struct Articulated<'g> {
    /// K
    pub mass: Sym3<'g>,
    /// B
    pub coupling: Mat3<'g>,
    /// J
    pub inertia: Sym3<'g>,
    /// (f₀, n₀)
    pub bias: Wrench<'g>,
}

impl<'g> Articulated<'g> {
    pub fn none(graph: &'g Graph) -> Self {
        let zero = graph.constant(0.0);
        Articulated {
            mass: Sym3::zero(graph),
            coupling: Mat3([[zero; 3]; 3]),
            inertia: Sym3::zero(graph),
            bias: Wrench::none(graph),
        }
    }

    fn combined(&self, other: &Self, of: impl Fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> Self {
        let symmetric =
            |a: &Sym3<'g>, b: &Sym3<'g>| Sym3::from_fn(|i, j| of(a.entry(i, j), b.entry(i, j)));
        let vector = |a: Vec3<'g>, b: Vec3<'g>| Vec3([0, 1, 2].map(|i| of(a.0[i], b.0[i])));
        Articulated {
            mass: symmetric(&self.mass, &other.mass),
            coupling: Mat3(
                [0, 1, 2]
                    .map(|i| [0, 1, 2].map(|j| of(self.coupling.0[i][j], other.coupling.0[i][j]))),
            ),
            inertia: symmetric(&self.inertia, &other.inertia),
            bias: Wrench {
                force: vector(self.bias.force, other.bias.force),
                moment: vector(self.bias.moment, other.bias.moment),
            },
        }
    }

    pub fn plus(&self, other: &Self) -> Self {
        self.combined(other, |a, b| a + b)
    }

    pub fn minus(&self, other: &Self) -> Self {
        self.combined(other, |a, b| a - b)
    }

    /// The same articulated inertia in the axes of the parent.
    pub fn turned(&self, turns: &[Turn<'g>]) -> Self {
        let mut turned = *self;
        for turn in turns {
            turned.mass = turn.symmetric(turned.mass);
            turned.inertia = turn.symmetric(turned.inertia);
            turned.coupling = turn.general(turned.coupling);
        }
        turned.bias = Wrench {
            force: through(turns, self.bias.force),
            moment: through(turns, self.bias.moment),
        };
        turned
    }

    /// The same articulated inertia about the parent's origin and in its axes; only the constant part of the joint's
    /// rotation is applied.
    pub fn by_constants(&self, frame: &FramedLink<'g>) -> Self {
        let graph = self.mass.diagonal[0].graph();
        let matrix = Mat3(frame.against.map(|row| row.map(|a| graph.constant(a))));
        let congruent = |m: Mat3<'g>| matrix.product(&m).product(&matrix.transposed());
        let full = |m: &Sym3<'g>| Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| m.entry(i, j))));
        let symmetric = |m: &Sym3<'g>| {
            let turned = congruent(full(m));
            Sym3::from_fn(|i, j| turned.0[i][j])
        };
        let turned = Articulated {
            mass: symmetric(&self.mass),
            coupling: congruent(self.coupling),
            inertia: symmetric(&self.inertia),
            bias: self.bias,
        };
        turned.cleaned().moved(frame.place)
    }

    /// The same articulated inertia, with constant entries that are only rounding set to 0.
    fn cleaned(&self) -> Self {
        let entries = |m: &Mat3<'g>| m.0.iter().flatten().copied().collect::<Vec<_>>();
        let full = |m: &Sym3<'g>| m.diagonal.iter().chain(&m.off).copied().collect::<Vec<_>>();
        let scale = |values: Vec<Expr<'g>>| {
            let constants = values.into_iter().filter_map(|e| e.as_constant());
            4e-15 * constants.fold(0.0, |m: f64, c| m.max(c.abs()))
        };
        let clean = |e: Expr<'g>, scale: f64| match e.as_constant() {
            Some(c) if c.abs() <= scale => e.graph().constant(0.0),
            _ => e,
        };
        let symmetric = |m: &Sym3<'g>| {
            let scale = scale(full(m));
            Sym3::from_fn(|i, j| clean(m.entry(i, j), scale))
        };
        let coupling = scale(entries(&self.coupling));
        Articulated {
            mass: symmetric(&self.mass),
            coupling: Mat3(self.coupling.0.map(|row| row.map(|e| clean(e, coupling)))),
            inertia: symmetric(&self.inertia),
            bias: self.bias,
        }
    }

    /// The articulated inertia that is left after the elimination of a velocity with U, G = U/D, 1/D and u. The term
    /// added to the bias is computed as U (u/D) if `scales_bias`, otherwise as G u.
    pub fn less(
        &self,
        needed: &Wrench<'g>,
        gain: &Wrench<'g>,
        inverse: Expr<'g>,
        left: Expr<'g>,
        scales_bias: bool,
    ) -> Self {
        let mut rest = *self;
        let (u, g) = (needed, gain);
        rest.mass = Sym3::from_fn(|i, j| self.mass.entry(i, j) - u.force.0[i] * g.force.0[j]);
        rest.inertia =
            Sym3::from_fn(|i, j| self.inertia.entry(i, j) - u.moment.0[i] * g.moment.0[j]);
        for i in 0..3 {
            for j in 0..3 {
                let product = u.moment.0[i] * g.force.0[j];
                rest.coupling.0[i][j] = self.coupling.0[i][j] - product;
            }
        }
        let (by, factor) = match scales_bias {
            true => (u, left * inverse),
            false => (g, left),
        };
        rest.bias = Wrench {
            force: self.bias.force + factor * by.force,
            moment: self.bias.moment + factor * by.moment,
        };
        rest
    }

    /// The same articulated inertia about another origin; `r` points from there to its own origin.
    pub fn moved(&self, r: Vec3<'g>) -> Self {
        if r.is_zero() {
            return *self;
        }
        // B' = B + r̂ K
        let columns = [0, 1, 2].map(|j| {
            let column = Vec3([0, 1, 2].map(|i| self.mass.entry(i, j)));
            self.coupling.column(j) + r.cross(column)
        });
        let coupling = Mat3::from_columns(columns);
        // J' = J − B r̂ + r̂ B'ᵀ, component by component of r, so that every product is made only once
        let inertia = Sym3::from_fn(|i, j| {
            (0..3).fold(self.inertia.entry(i, j), |sum, k| {
                if r.0[k].is_zero() {
                    return sum;
                }
                let zero = r.0[k].graph().constant(0.0);
                let mut factor = zero;
                for b in 0..3 {
                    // (e_k ×)_{jb} B_ib and (e_k ×)_{ib} B'_jb
                    factor = added(factor, permutation(j, k, b), self.coupling.0[i][b]);
                    factor = added(factor, permutation(i, k, b), coupling.0[j][b]);
                }
                sum + r.0[k] * factor
            })
        });
        Articulated {
            mass: self.mass,
            coupling,
            inertia,
            bias: Wrench {
                force: self.bias.force,
                moment: self.bias.moment + r.cross(self.bias.force),
            },
        }
    }

    /// Δa and Δα of a free link in the plane perpendicular to z.
    pub fn floating_in_plane(&self, graph: &'g Graph) -> (Vec3<'g>, Vec3<'g>) {
        let (k, b, zero) = (&self.mass, &self.coupling.0[2], graph.constant(0.0));
        let lower = vec![
            vec![k.entry(0, 0)],
            vec![k.entry(1, 0), k.entry(1, 1)],
            vec![b[0], b[1], self.inertia.entry(2, 2)],
        ];
        let [x, y, _] = self.bias.force.0;
        let right = vec![-x, -y, -self.bias.moment.0[2]];
        let x = Ldl::of(graph, lower).solve(right);
        (Vec3([x[0], x[1], zero]), Vec3([zero, zero, x[2]]))
    }

    /// Δa and Δα of a free link.
    pub fn floating(&self, graph: &'g Graph) -> (Vec3<'g>, Vec3<'g>) {
        let entry = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, true) => self.mass.entry(i, j),
            (false, true) => self.coupling.0[i - 3][j],
            (true, false) => self.coupling.0[j - 3][i],
            (false, false) => self.inertia.entry(i - 3, j - 3),
        };
        let lower = (0..6).map(|i| (0..=i).map(|j| entry(i, j)).collect());
        let right = self.bias.force.0.iter().chain(&self.bias.moment.0);
        let right = right.map(|f| -*f).collect();
        let x = Ldl::of(graph, lower.collect()).solve(right);
        (Vec3([x[0], x[1], x[2]]), Vec3([x[3], x[4], x[5]]))
    }
}

/// The part of an articulated inertia that a rotation about z does not change and that a hinge about z does not feel: K
/// = diag(k, k, k'), J = diag(j, j, 0) and B = \[\[b, −t, 0\], \[t, b, 0\], 0\]. k' is 0 unless `third`. `None` if an
/// entry is not constant or if all are 0.
pub fn invariant<'g>(
    graph: &'g Graph,
    of: &Articulated<'g>,
    third: bool,
) -> Option<Articulated<'g>> {
    let constant = |e: Expr<'g>| e.as_constant().is_some();
    let zero = graph.constant(0.0);
    let (k, j) = (of.mass.diagonal[1], of.inertia.diagonal[1]);
    let (b, t) = (of.coupling.0[1][1], of.coupling.0[1][0]);
    if ![k, j, b, t].into_iter().all(constant) {
        return None;
    }
    let k3 = of.mass.diagonal[2];
    let k3 = if third && constant(k3) { k3 } else { zero };
    let mut part = Articulated {
        mass: Sym3::zero(graph),
        coupling: Mat3([[b, -t, zero], [t, b, zero], [zero; 3]]),
        inertia: Sym3::zero(graph),
        bias: Wrench::none(graph),
    };
    part.mass.diagonal = [k, k, k3];
    part.inertia.diagonal = [j, j, zero];
    let nothing = [k, j, b, t, k3].into_iter().all(|e| e.is_zero());
    (!nothing).then_some(part)
}

/// The entry (i, j) of e_k ×.
fn permutation(i: usize, k: usize, j: usize) -> i8 {
    match ((j + 3 - i) % 3, i == j || j == k || i == k) {
        (_, true) => 0,
        // (e_z ×)_xy = −1
        (1, _) => -1,
        _ => 1,
    }
}

fn added<'g>(sum: Expr<'g>, sign: i8, term: Expr<'g>) -> Expr<'g> {
    match sign {
        1 => sum + term,
        -1 => sum - term,
        _ => sum,
    }
}
