//! The generalised forces of what acts, r_k in the paper, by virtual power, for trees of ball joints:
//!
//! r_x = F_out,root,   r_k = E_kᵀ (τ_k + Σ_c u_c × F_out,c)
//!
//! F_out = F + Σ_c F_out,c is summed from the leaves to the root, and τ_k is the moment about joint k of what acts on element k. A field a that is
//! common to a whole system needs no sum: it acts as M a on the reference joint, and as w_k × a on element k. A given acceleration of the reference
//! joint acts as its negative.
//!
//! Systems with other joints have r_k from the [power of wrenches](super::spatial).

use super::augmented::AugmentedTree;
use super::force::Loads;
use super::kinematics::{Motion, path, reference_acceleration};
use super::layout::Layout;
use super::spatial::{self, Spatial};
use crate::expression::{Expr, Graph};
use crate::model::{ElementId, Model};

/// r_k.
pub fn applied_forces<'g>(
    graph: &'g Graph,
    model: &Model,
    layout: &Layout,
    motion: &Motion<'g>,
    trees: &[AugmentedTree<'g>],
    loads: &Loads<'g>,
) -> Vec<Expr<'g>> {
    let mut forces = vec![graph.constant(0.0); layout.velocities.len()];
    for (s, (system, tree)) in model.systems.iter().zip(trees).enumerate() {
        if !system.has_balls_alone() {
            let spatial = Spatial {
                graph,
                model,
                layout,
                system: s,
                motion,
                tree,
            };
            spatial::applied_forces(&spatial, loads, &mut forces);
            continue;
        }
        let field = loads.fields[s] - reference_acceleration(graph, system, motion);
        let mut outboard: Vec<_> = loads.elements[s].iter().map(|load| load.force).collect();
        for k in (0..system.elements.len()).rev() {
            let id = ElementId {
                system: s,
                element: k,
            };
            graph.section(format!("r_k[{}]", path(model, id)));
            let mut moment = loads.elements[s][k].moment + tree.bodies[k].first_moment.cross(field);
            for &c in &tree.children[k] {
                moment = moment + motion.systems[s][c].offset.cross(outboard[c]);
                outboard[k] = outboard[k] + outboard[c];
            }
            for (row, axis) in layout.element_velocities(id).zip(&motion.element(id).axes) {
                forces[row] = axis.dot(moment);
            }
        }
        if let Some(x) = layout.reference_velocities(s) {
            graph.section(format!("r_k[{}.x]", system.name));
            let force = outboard[0] + tree.bodies[0].mass * field;
            for (row, &direction) in x.zip(layout.directions) {
                forces[row] = force.0[direction];
            }
        }
    }
    forces
}
