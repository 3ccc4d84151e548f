//! Derivatives of the dynamics as expressions.
//!
//! τ is the generalised force that a motion needs besides the fields: τ(t, q, v, v̇) = S v̇ − r_s − r_f, r_f being the
//! forces of fields (`field`) and of the prescribed acceleration of reference joints. So S v̇ = r_s + r_f + r is the
//! motion under the forces r of all other laws.
//!
//! Derivatives with respect to positions are along the tangent: column j is the derivative along the motion that a unit
//! of `v[j]` makes, q̇ being its coordinate rates. So all matrices have as many rows and columns as v. For a quaternion
//! the columns are turns about the absolute axes x, y, z, as the velocities ω of bryant are components in absolute
//! axes: q ⊕ d = exp(d/2) ∘ q. For every other coordinate the column is ∂/∂q.
//!
//! | file | |
//! |---|---|
//! | `inverse_dynamics` | τ, ∂τ/∂q, ∂τ/∂v, S |
//! | `acceleration` | v̇, ∂v̇/∂q, ∂v̇/∂v, S⁻¹ |
//! | `linearisation` | A, B, C, D of the whole scene with its forces |
//! | `loads` | the generalised forces of laws, and their derivatives |
//! | `graph` | ∂τ/∂q and ∂τ/∂v by differentiation of S and r_s, for systems that link frames cannot describe |

mod acceleration;
pub mod graph;
mod inverse_dynamics;
mod linearisation;
mod loads;

pub use crate::dynamics::link::derivatives::{Found, Square};
pub use acceleration::{AccelerationDerivatives, acceleration_derivatives};
pub use inverse_dynamics::inverse_dynamics_derivatives;
pub use linearisation::{Linearisation, linearisation};
pub use loads::of_laws_but_fields;

use super::LARGEST_FACTORIZED;
use super::link::derivatives::{InLinks, ways};
use super::spatial::Spatial;
use crate::expression::count::Count;
use crate::expression::passes::factor;
use crate::expression::{Expr, Graph};
use crate::force::AppliedForces;
use crate::model::Model;
use crate::motion::{Layout, Motion, State};
use graph::InGraph;

pub use crate::expression::differentiate::NotDifferentiable;

/// All that derivatives are made from.
#[derive(Clone, Copy)]
pub struct DerivativeInputs<'g, 'a> {
    /// The graph of the expressions.
    pub graph: &'g Graph,
    /// The model.
    pub model: &'a Model,
    /// Its coordinates.
    pub layout: &'a Layout,
    /// The state as symbols.
    pub state: &'a State<'g>,
    /// The motion in this state.
    pub motion: &'a Motion<'g>,
    /// The motion at the start of a run.
    pub start: &'a Motion<'g>,
    /// All systems of the model.
    pub systems: &'a [Spatial<'g, 'a>],
    /// The applied forces.
    pub applied: &'a AppliedForces<'g>,
}

/// A way to derive τ and its derivatives for a system.
enum Way<'g> {
    InLinks(Box<InLinks<'g>>),
    InGraph(Box<InGraph<'g>>),
}

impl<'g> Way<'g> {
    /// All ways for a system that are worth a comparison.
    fn all(
        scene: &DerivativeInputs<'g, '_>,
        spatial: &Spatial<'g, '_>,
    ) -> Result<Vec<Self>, NotDifferentiable> {
        let mut found: Vec<Self> = ways(spatial, scene.applied)
            .into_iter()
            .map(|way| Way::InLinks(Box::new(way)))
            .collect();
        let rows = spatial.layout.system_velocities(spatial.system);
        if found.is_empty() || rows.len() <= LARGEST_FACTORIZED {
            found.push(Way::InGraph(Box::new(InGraph::of(scene, spatial)?)));
        }
        Ok(found)
    }

    /// τ, its derivatives and S at these v̇, in the rows and columns of the system.
    fn at(&self, accelerations: &[Expr<'g>]) -> Found<'g> {
        match self {
            Way::InLinks(way) => way.at(accelerations),
            Way::InGraph(way) => way.at(accelerations),
        }
    }

    /// τ at v̇ = 0.
    fn bias(&self, zero: Expr<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let rest = vec![zero; v.len()];
        match self {
            Way::InLinks(way) if way.rests() => {
                // a quadratic form of v is half its derivative times v
                let twice = way.at(&rest).by_velocity;
                let fields = way.of_field().into_iter();
                let forces = twice.iter().zip(fields).map(|(row, field)| {
                    let terms = row.iter().zip(v);
                    0.5 * terms.fold(zero, |sum, (d, v)| sum + *d * *v) - field
                });
                forces.collect()
            }
            _ => self.at(&rest).forces,
        }
    }
}

/// The number of operations of these values; a quotient counts as several.
fn cost<'g>(graph: &Graph, values: impl IntoIterator<Item = Expr<'g>>) -> usize {
    let ids: Vec<_> = values.into_iter().map(|value| value.id()).collect();
    factor::cost(&Count::of(graph, &ids))
}

fn zeros(graph: &Graph, size: usize) -> Square<'_> {
    vec![vec![graph.constant(0.0); size]; size]
}
