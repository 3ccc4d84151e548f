//! Derivatives of τ by differentiation of the expressions of S and of r_s + r_f, entry by entry.

use super::{DerivativeInputs, Found, NotDifferentiable, zeros};
use crate::dynamics::spatial::Spatial;
use crate::dynamics::{applied_forces, bias_forces, mass_matrix};
use crate::expression::differentiate::{Known, differentiate_almost_everywhere};
use crate::expression::{Expr, NodeId, Symbol};
use crate::force::{AppliedForces, Wrenches};
use std::ops::Range;
use std::slice::from_ref;

/// S and r_s + r_f of a system.
pub struct Terms<'g> {
    rows: Range<usize>,
    /// The entries of the upper triangle of S that are not 0, each with its row and column of v.
    matrix: Vec<(usize, usize, Expr<'g>)>,
    /// r_s + r_f, by row of the system
    forces: Vec<Expr<'g>>,
}

/// S and r_s + r_f of a system with their derivatives.
pub struct InGraph<'g> {
    terms: Terms<'g>,
    /// For each velocity: the derivatives along its motion, and with respect to it.
    along: Vec<[Terms<'g>; 2]>,
}

impl<'g> Terms<'g> {
    pub fn of(scene: &DerivativeInputs<'g, '_>, spatial: &Spatial<'g, '_>) -> Self {
        let (graph, layout) = (spatial.graph, spatial.layout);
        let (zero, size) = (graph.constant(0.0), layout.velocities.len());
        let rows = layout.system_velocities(spatial.system);
        let system = from_ref(spatial);
        let entries = mass_matrix::mass_matrix(system, size);
        let r_s = bias_forces::velocity_forces(system, zero, size);
        let mut fields = Wrenches::none(graph, spatial.model);
        fields.fields.clone_from(&scene.applied.wrenches.fields);
        let fields = AppliedForces::of_wrenches(spatial.model, fields);
        let r_f = applied_forces::applied_forces(system, &fields, zero, size);
        let places = rows
            .clone()
            .flat_map(|i| (i..rows.end).map(move |j| (i, j)));
        Terms {
            matrix: places
                .filter_map(|(i, j)| Some((i, j, entries[i][j]?)))
                .collect(),
            forces: rows.clone().map(|i| r_s[i] + r_f[i]).collect(),
            rows,
        }
    }

    /// True for a system without velocities.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// r_s + r_f, then the entries of S.
    fn roots(&self) -> Vec<NodeId> {
        let entries = self.matrix.iter().map(|(.., value)| value);
        let values = self.forces.iter().chain(entries);
        values.map(|value| value.id()).collect()
    }

    /// The terms with these values in place of their [roots](Self::roots).
    fn with(&self, values: impl IntoIterator<Item = Expr<'g>>) -> Self {
        let mut values = values.into_iter();
        let forces = values.by_ref().take(self.forces.len()).collect();
        let entries = self.matrix.iter().zip(values);
        let entries = entries.map(|(&(i, j, _), value)| (i, j, value));
        Terms {
            rows: self.rows.clone(),
            matrix: entries.filter(|(.., value)| !value.is_zero()).collect(),
            forces,
        }
    }

    /// ∂τ/∂x at constant v̇, by row of v.
    pub fn by(
        &self,
        input: Symbol,
        accelerations: &[Expr<'g>],
    ) -> Result<Vec<Expr<'g>>, NotDifferentiable> {
        let graph = self.forces[0].graph();
        let direction = |s| graph.constant(if s == input { 1.0 } else { 0.0 });
        let roots = self.roots();
        let found = differentiate_almost_everywhere(graph, &roots, &Known::default(), direction)?;
        let change = self.with(found.into_iter().map(|id| graph.expr(id)));
        Ok(change.needed(accelerations))
    }

    /// S v̇ − (r_s + r_f), by row of v.
    fn needed(&self, accelerations: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let zero = self.forces[0].graph().constant(0.0);
        let mut needed = vec![zero; accelerations.len()];
        for &(i, j, value) in &self.matrix {
            needed[i] = needed[i] + value * accelerations[j];
            if i != j {
                needed[j] = needed[j] + value * accelerations[i];
            }
        }
        for (i, force) in self.rows.clone().zip(&self.forces) {
            needed[i] = needed[i] - *force;
        }
        needed
    }
}

impl<'g> InGraph<'g> {
    pub fn of(
        scene: &DerivativeInputs<'g, '_>,
        spatial: &Spatial<'g, '_>,
    ) -> Result<Self, NotDifferentiable> {
        let terms = Terms::of(scene, spatial);
        let roots = terms.roots();
        let mut along = Vec::new();
        for j in terms.rows.clone() {
            let found = scene.along(j, &roots, &Default::default())?;
            along.push([0, 1].map(|kind| terms.with(found.iter().map(|of| of[kind]))));
        }
        Ok(InGraph { terms, along })
    }

    /// τ, its derivatives and S at these v̇.
    pub fn at(&self, accelerations: &[Expr<'g>]) -> Found<'g> {
        let graph = self.terms.forces[0].graph();
        let (rows, size) = (self.terms.rows.clone(), accelerations.len());
        let mut found = Found {
            matrix: zeros(graph, size),
            forces: self.terms.needed(accelerations),
            by_position: zeros(graph, size),
            by_velocity: zeros(graph, size),
        };
        for &(i, j, value) in &self.terms.matrix {
            (found.matrix[i][j], found.matrix[j][i]) = (value, value);
        }
        for (along, j) in self.along.iter().zip(rows) {
            let matrices = [&mut found.by_position, &mut found.by_velocity];
            for (matrix, terms) in matrices.into_iter().zip(along) {
                for (row, change) in matrix.iter_mut().zip(terms.needed(accelerations)) {
                    row[j] = change;
                }
            }
        }
        found
    }
}
