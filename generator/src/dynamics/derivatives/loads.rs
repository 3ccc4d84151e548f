//! The generalised forces of laws and their derivatives, by differentiation of their expressions.

use super::{DerivativeInputs, NotDifferentiable, Square, zeros};
use crate::dynamics::applied_forces;
use crate::expression::differentiate::{Known, differentiate_almost_everywhere};
use crate::expression::{Expr, Graph, NodeId, Symbol};
use crate::force::{AppliedForces, Wrenches};
use crate::motion::State;
use crate::motion::kinematics::reference_acceleration;

/// Generalised forces by row of v, and their derivatives by row and column.
pub struct Loads<'g> {
    /// r
    pub forces: Vec<Expr<'g>>,
    /// ∂r/∂q
    pub by_position: Square<'g>,
    /// ∂r/∂v
    pub by_velocity: Square<'g>,
    /// The derivatives with respect to other inputs, a list of rows for each.
    pub by_others: Vec<Vec<Expr<'g>>>,
}

impl<'g> Loads<'g> {
    /// No forces.
    pub fn none(graph: &'g Graph, size: usize) -> Self {
        Loads {
            forces: vec![graph.constant(0.0); size],
            by_position: zeros(graph, size),
            by_velocity: zeros(graph, size),
            by_others: Vec::new(),
        }
    }

    /// The fields that only some elements of a system feel.
    pub fn of_partial_fields(scene: &DerivativeInputs<'g, '_>) -> Result<Self, NotDifferentiable> {
        let (graph, size) = (scene.graph, scene.state.v.len());
        let fields = &scene.applied.wrenches.partial_fields;
        if fields.iter().flatten().all(|field| field.is_zero()) {
            return Ok(Loads::none(graph, size));
        }
        Loads::of(scene, &partial_fields(scene), &[])
    }

    /// All laws but fields that a whole system feels, with their derivatives with respect to other inputs.
    pub fn of_laws(
        scene: &DerivativeInputs<'g, '_>,
        others: &[Symbol],
    ) -> Result<Self, NotDifferentiable> {
        Loads::of(scene, scene.applied, others)
    }

    /// The forces of wrenches, with a field that no system feels.
    fn of(
        scene: &DerivativeInputs<'g, '_>,
        applied: &AppliedForces<'g>,
        others: &[Symbol],
    ) -> Result<Self, NotDifferentiable> {
        let (graph, size) = (scene.graph, scene.state.v.len());
        let zero = graph.constant(0.0);
        let forces = generalised(scene, applied);
        let mut loads = Loads::none(graph, size);
        let roots: Vec<NodeId> = forces.iter().map(|force| force.id()).collect();
        for j in 0..size {
            let of = scene.along(j, &roots, &Default::default())?;
            for (i, [position, velocity]) in of.into_iter().enumerate() {
                (loads.by_position[i][j], loads.by_velocity[i][j]) = (position, velocity);
            }
        }
        for other in others {
            let direction = |s: Symbol| {
                if s == *other {
                    graph.constant(1.0)
                } else {
                    zero
                }
            };
            let known = Known::default();
            let found = differentiate_almost_everywhere(graph, &roots, &known, direction)?;
            loads
                .by_others
                .push(found.into_iter().map(|id| graph.expr(id)).collect());
        }
        loads.forces = forces;
        Ok(loads)
    }
}

impl<'g> DerivativeInputs<'g, '_> {
    /// The derivatives of values along the motion of velocity `j`, and with respect to it. The derivatives of some
    /// nodes along both are known.
    pub(super) fn along(
        &self,
        j: usize,
        roots: &[NodeId],
        known: &[Known<'g>; 2],
    ) -> Result<Vec<[Expr<'g>; 2]>, NotDifferentiable> {
        let graph = self.graph;
        graph.section(format!("derivatives by {}", self.layout.velocities[j].name));
        let velocity = |symbol| match symbol == Symbol::Velocity(j as u32) {
            true => graph.constant(1.0),
            false => graph.constant(0.0),
        };
        let tangent = self.tangent(j);
        let [position, rate] = known;
        let position = differentiate_almost_everywhere(graph, roots, position, tangent)?;
        let velocity = differentiate_almost_everywhere(graph, roots, rate, velocity)?;
        let both = position.into_iter().zip(velocity);
        Ok(both.map(|(q, v)| [graph.expr(q), graph.expr(v)]).collect())
    }

    /// The direction of the coordinates in which a unit of velocity `j` moves the model.
    fn tangent(&self, j: usize) -> impl Fn(Symbol) -> Expr<'g> + use<'g> {
        let graph = self.graph;
        let mut unit = State {
            q: self.state.q.clone(),
            v: vec![graph.constant(0.0); self.state.v.len()],
            charts: self.state.charts.clone(),
        };
        unit.v[j] = graph.constant(1.0);
        let rates = self.layout.coordinate_rates(graph, self.model, &unit);
        move |symbol| match symbol {
            Symbol::Coordinate(i) => rates[i as usize],
            _ => graph.constant(0.0),
        }
    }
}

/// r \[N m or N, in the order of v\]: the generalised forces of all laws but fields.
pub fn of_laws_but_fields<'g>(scene: &DerivativeInputs<'g, '_>) -> Vec<Expr<'g>> {
    let laws = generalised(scene, scene.applied).into_iter();
    let fields = generalised(scene, &partial_fields(scene));
    laws.zip(fields).map(|(all, field)| all - field).collect()
}

/// The generalised forces of wrenches alone, whatever the reference joints do.
fn generalised<'g>(scene: &DerivativeInputs<'g, '_>, applied: &AppliedForces<'g>) -> Vec<Expr<'g>> {
    let graph = scene.graph;
    let mut wrenches = Wrenches::none(graph, scene.model);
    wrenches.elements.clone_from(&applied.wrenches.elements);
    wrenches
        .on_freedoms
        .clone_from(&applied.wrenches.on_freedoms);
    // a field that the acceleration of the reference joint cancels
    wrenches.fields = (scene.systems.iter())
        .map(|spatial| reference_acceleration(graph, spatial.of_system(), spatial.motion))
        .collect();
    let (zero, size) = (graph.constant(0.0), scene.state.v.len());
    let alone = AppliedForces::of_wrenches(scene.model, wrenches);
    applied_forces::applied_forces(scene.systems, &alone, zero, size)
}

/// The forces of fields that only some elements of a system feel.
fn partial_fields<'g>(scene: &DerivativeInputs<'g, '_>) -> AppliedForces<'g> {
    let fields = &scene.applied.wrenches.partial_fields;
    let wrenches = Wrenches::of_partial_fields(scene.graph, scene.model, scene.motion, fields);
    AppliedForces::of_wrenches(scene.model, wrenches)
}
