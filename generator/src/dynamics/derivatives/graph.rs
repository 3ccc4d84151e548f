//! Derivatives of τ by differentiation of the expressions of S and of r_s + r_f, entry by entry.

use super::{Found, NotDifferentiable, Scene, zeros};
use crate::dynamics::spatial::Spatial;
use crate::dynamics::{applied_forces, bias_forces, mass_matrix};
use crate::expression::differentiate::differentiate_along;
use crate::expression::{Expr, Graph, NodeId, Symbol};
use crate::force::{AppliedForces, Events, States, Wrench, Wrenches};
use crate::model::Model;
use crate::motion::State;
use crate::motion::numbers::{number, vector};
use std::slice::from_ref;

/// S and r_s + r_f of a system, and their derivatives.
pub struct InGraph<'g> {
    rows: std::ops::Range<usize>,
    /// S
    matrix: Vec<Vec<Expr<'g>>>,
    /// r_s + r_f
    forces: Vec<Expr<'g>>,
    /// For each velocity: the derivatives of S and of r_s + r_f along its motion, then that of r_s + r_f with it.
    along: Vec<Along<'g>>,
}

struct Along<'g> {
    matrix: Vec<Vec<Expr<'g>>>,
    forces: [Vec<Expr<'g>>; 2],
}

impl<'g> InGraph<'g> {
    pub fn of(scene: &Scene<'g, '_>, spatial: &Spatial<'g, '_>) -> Result<Self, NotDifferentiable> {
        let (graph, layout) = (spatial.graph, spatial.layout);
        let (zero, size) = (graph.constant(0.0), layout.velocities.len());
        let rows = layout.system_velocities(spatial.system);
        let system = from_ref(spatial);
        let entries = mass_matrix::mass_matrix(system, size);
        let matrix: Vec<Vec<Expr<'g>>> = (rows.clone())
            .map(|i| {
                rows.clone()
                    .map(|j| entries[i][j].unwrap_or(zero))
                    .collect()
            })
            .collect();
        let r_s = bias_forces::velocity_forces(system, zero, size);
        let fields = fields(graph, spatial.model, scene);
        let r_f = applied_forces::applied_forces(system, &fields, zero, size);
        let forces: Vec<Expr<'g>> = rows.clone().map(|i| r_s[i] + r_f[i]).collect();
        let count = rows.len();
        let upper = (0..count).flat_map(|i| (i..count).map(move |j| (i, j)));
        let upper: Vec<(usize, usize)> = upper.collect();
        let mut roots: Vec<NodeId> = forces.iter().map(|e| e.id()).collect();
        roots.extend(upper.iter().map(|&(i, j)| matrix[i][j].id()));
        let mut along = Vec::new();
        for j in rows.clone() {
            graph.section(format!("∂τ/∂{}", layout.velocities[j].name));
            let position = differentiate_along(graph, &roots, tangent(spatial, scene.state, j))?;
            let of = |symbol: Symbol| match symbol == Symbol::Velocity(j as u32) {
                true => graph.constant(1.0),
                false => zero,
            };
            let velocity = differentiate_along(graph, &roots[..count], of)?;
            let values = |ids: &[NodeId]| ids.iter().map(|id| graph.expr(*id)).collect::<Vec<_>>();
            let mut change = vec![vec![zero; count]; count];
            for (&(i, j), value) in upper.iter().zip(values(&position[count..])) {
                (change[i][j], change[j][i]) = (value, value);
            }
            along.push(Along {
                matrix: change,
                forces: [values(&position[..count]), values(&velocity)],
            });
        }
        Ok(InGraph {
            rows,
            matrix,
            forces,
            along,
        })
    }

    /// τ, its derivatives and S at these v̇.
    pub fn at(&self, accelerations: &[Expr<'g>]) -> Found<'g> {
        let graph = self.forces[0].graph();
        let (zero, size) = (graph.constant(0.0), accelerations.len());
        let own = &accelerations[self.rows.clone()];
        let times = |row: &[Expr<'g>]| {
            let terms = row.iter().zip(own);
            terms.fold(zero, |sum, (s, a)| sum + *s * *a)
        };
        let first = self.rows.start;
        let mut found = Found {
            matrix: zeros(graph, size),
            forces: vec![zero; size],
            by_position: zeros(graph, size),
            by_velocity: zeros(graph, size),
        };
        for i in 0..self.rows.len() {
            found.forces[first + i] = times(&self.matrix[i]) - self.forces[i];
            found.matrix[first + i][self.rows.clone()].copy_from_slice(&self.matrix[i]);
            for (j, along) in self.along.iter().enumerate() {
                let [position, velocity] = [&along.forces[0], &along.forces[1]].map(|f| f[i]);
                found.by_position[first + i][first + j] = times(&along.matrix[i]) - position;
                found.by_velocity[first + i][first + j] = -velocity;
            }
        }
        found
    }
}

/// The direction of the coordinates in which a unit of velocity `j` moves the model.
pub fn tangent<'g, 'a>(
    spatial: &Spatial<'g, 'a>,
    state: &State<'g>,
    j: usize,
) -> impl Fn(Symbol) -> Expr<'g> + use<'g, 'a> {
    let graph = spatial.graph;
    let mut unit = State {
        q: state.q.clone(),
        v: vec![graph.constant(0.0); state.v.len()],
        charts: state.charts.clone(),
    };
    unit.v[j] = graph.constant(1.0);
    let rates = spatial.layout.coordinate_rates(graph, spatial.model, &unit);
    move |symbol| match symbol {
        Symbol::Coordinate(i) => rates[i as usize],
        _ => graph.constant(0.0),
    }
}

/// The fields alone, of all forces.
fn fields<'g>(graph: &'g Graph, model: &Model, scene: &Scene<'g, '_>) -> AppliedForces<'g> {
    let given = &scene.applied.wrenches;
    let mut wrenches = Wrenches::none(graph, model);
    wrenches.fields.clone_from(&given.fields);
    for spatial in scene.systems {
        let s = spatial.system;
        for (k, element) in model.systems[s].elements.iter().enumerate() {
            let force = number(graph, &element.mass) * given.partial_fields[s][k];
            let offset = spatial
                .motion_of(k)
                .rotation
                .times(vector(graph, &element.cg));
            wrenches.elements[s][k] = Wrench {
                force,
                moment: offset.cross(force),
            };
        }
    }
    AppliedForces {
        wrenches,
        states: States {
            auxiliaries: Vec::new(),
            memory: Vec::new(),
            switches: Vec::new(),
        },
        events: Events::none(model),
        works: Vec::new(),
        measures: Vec::new(),
    }
}
