//! Eliminates an element with moments about the absolute axes E. With a' = a − β and e_c = h_c − Q_c (β_c + a₀_c):
//!
//! | | |
//! |---|---|
//! | f = μ a − ΣQ_c a' + H α + f₀ | H = D(w) − Σ Q_c D(u_c),   f₀ = γ(w) + Σ e_c − F |
//! | 0 = Hᵀ a' + J' α + t₀ | J' = EᵀJE − Σ D(u_c)ᵀ Q_c D(u_c),   t₀ = Eᵀ(ω × Jω + w × β + Σ u_c × e_c − τ) |
//! | Q = ΣQ_c + H J'⁻¹ Hᵀ,   a₀ = −β | h = f₀ − H J'⁻¹ t₀ |
//! | α = −J'⁻¹ (Hᵀ a' + t₀) | μ = m + Σ μ_c |
//!
//! If a child has a₀ = −β, too, no velocity term is multiplied by Q_c; β then appears only in the moment w × β. E are
//! the absolute axes in space, and e_y alone in the plane. In space H has no trace, because D(w) has none, nor has the
//! product of a symmetric and a skew matrix.

use super::{ArticulatedBody, BodyWithChildren, Child};
use crate::dynamics::augmented_body::{AugmentedBody, with_points};
use crate::dynamics::factorization::Ldl;
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::Dimension;

/// The quantities that the pass outwards needs.
pub(super) struct Absolute<'g> {
    /// J' = L D Lᵀ
    factors: Ldl<'g>,
    /// Z = D⁻¹ L⁻¹ Hᵀ, one row for each rotational freedom.
    z: Vec<Vec3<'g>>,
    /// D⁻¹ L⁻¹ t₀
    z_bias: Vec<Expr<'g>>,
}

impl<'g> BodyWithChildren<'g, '_> {
    /// Eliminates the element.
    pub(super) fn absolute(&self, name: &str, label: &str) -> (Absolute<'g>, ArticulatedBody<'g>) {
        let graph = self.body.graph;
        let axes = rotations(graph, self.body.dimension);
        graph.section(format!("element {label}: augmented body"));
        let body = self.body(name);

        graph.section(format!("element {label}: forces of velocity and load"));
        let motion = self.body.motion;
        let mut force = motion.centripetal(body.first_moment) - self.load.force;
        let center = motion.rotation.times(self.origin);
        let mut moment = body.gyroscopic_moment(graph, motion.omega) - self.load.moment
            + center.cross(self.load.force)
            + body.first_moment.cross(self.beta);
        let mut columns: Vec<Vec3<'g>> = axes
            .iter()
            .map(|(_, e)| e.cross(body.first_moment))
            .collect();
        let mut inertia: Vec<Vec<Expr<'g>>> = axes
            .iter()
            .enumerate()
            .map(|(i, (row, _))| {
                axes[..=i]
                    .iter()
                    .map(|(column, _)| body.inertia.entry(*row, *column))
                    .collect()
            })
            .collect();
        let mut resistance = Sym3::zero(graph);

        for child in &self.children {
            graph.section(format!("element {label}: what {} passes on", child.label));
            let passed = child.passed();
            let (offset, outboard) = (child.offset, &child.response.resistance);
            force = force + passed;
            moment = moment + offset.cross(passed);
            let turned: Vec<Vec3<'g>> = axes.iter().map(|(_, e)| e.cross(offset)).collect();
            let resisted: Vec<Vec3<'g>> = turned.iter().map(|d| outboard.times(*d)).collect();
            for i in 0..axes.len() {
                columns[i] = columns[i] - resisted[i];
                for j in 0..=i {
                    inertia[i][j] = inertia[i][j] - turned[i].dot(resisted[j]);
                }
            }
            resistance = resistance + *outboard;
        }
        if let [x, y, z] = &mut columns[..] {
            z.0[2] = -(x.0[0] + y.0[1]);
        }

        graph.section(format!("element {label}: elimination"));
        let factors = Ldl::of(graph, inertia);
        let y = factors.forward(columns);
        let z = factors.scale(&y);
        let y_bias = factors.forward(axes.iter().map(|(_, e)| e.dot(moment)).collect());
        let z_bias = factors.scale(&y_bias);
        for (z, y) in z.iter().zip(&y) {
            resistance = resistance + Sym3::from_fn(|i, j| z.0[i] * y.0[j]);
        }
        for (y, bias) in y.iter().zip(&z_bias) {
            force = force - *bias * *y;
        }
        let response = ArticulatedBody {
            mass: body.mass,
            resistance,
            bias: -self.beta,
            force,
        };
        let absolute = Absolute { factors, z, z_bias };
        (absolute, response)
    }

    /// The body about `origin`, with the μ of its children as point masses at their joints.
    fn body(&self, name: &str) -> AugmentedBody<'g> {
        let children = self.children.iter();
        let points: Vec<_> = children
            .map(|child| (child.response.mass, child.at))
            .collect();
        let constants = with_points(
            self.body.graph,
            self.body.dimension,
            self.body.element,
            self.origin,
            &points,
        );
        let (graph, rotation) = (self.body.graph, &self.body.motion.rotation);
        AugmentedBody {
            gyroscopic: self.body.gyroscopic,
            ..AugmentedBody::turned(graph, rotation, constants, name)
        }
    }
}

impl<'g> Child<'g> {
    /// h − Q (β + a₀)
    fn passed(&self) -> Vec3<'g> {
        let ArticulatedBody {
            resistance,
            bias,
            force,
            ..
        } = self.response;
        force - resistance.times(self.beta + bias)
    }
}

impl<'g> Absolute<'g> {
    /// α = −J'⁻¹ (Hᵀ a' + t₀); `joint` is a'.
    pub(super) fn angular_acceleration(
        &self,
        graph: &'g Graph,
        dimension: Dimension,
        joint: Vec3<'g>,
    ) -> Vec3<'g> {
        let right = self.z.iter().zip(&self.z_bias);
        let right = right.map(|(z, bias)| z.dot(joint) + *bias).collect();
        let mut alpha = Vec3::zero(graph);
        let axes = rotations(graph, dimension).into_iter();
        for ((i, _), value) in axes.zip(self.factors.backward(right)) {
            alpha.0[i] = -value;
        }
        alpha
    }
}

/// The axes of the rotational freedoms: the absolute axes that the dimension has, with their indices.
fn rotations<'g>(graph: &'g Graph, dimension: Dimension) -> Vec<(usize, Vec3<'g>)> {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let axis = |i: usize| {
        (
            i,
            Vec3(std::array::from_fn(|j| if i == j { one } else { zero })),
        )
    };
    match dimension {
        Dimension::Plane => vec![axis(1)],
        Dimension::Space => (0..3).map(axis).collect(),
    }
}
