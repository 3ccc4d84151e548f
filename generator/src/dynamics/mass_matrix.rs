//! The mass matrix, S in the paper, block by block for trees of ball joints:
//!
//! S_xx = M·1,   S_xk = D_k(w_k),   S_kk = E_kᵀ (A J Aᵀ) E_k,   S_jk = D_j(u_c)ᵀ D_k(w_k)   \[MADYMO 1980\]
//!
//! x are the velocities of a free reference joint, and k those of element k. j is inboard of k, and c is the child of j
//! on the way to k. E holds the columns e_j, and D_k(v) the columns e_j × v. M, w and J are mass, first moment and
//! inertia of the [augmented body](super::augmented_body). Elements on different branches, and different systems, are
//! not coupled; these entries are absent.
//!
//! Systems with other joints get S from [composite bodies](super::spatial).

use super::spatial::{self, Spatial};
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::model::ElementId;
use crate::motion::kinematics::path;

/// S by rows; `None` where the tree shows that the entry is 0 in every state.
pub fn mass_matrix<'g>(systems: &[Spatial<'g, '_>], size: usize) -> Vec<Vec<Option<Expr<'g>>>> {
    let mut matrix = vec![vec![None; size]; size];
    for spatial in systems {
        match spatial.has_balls_alone() {
            true => of_balls(spatial, &mut matrix),
            false => spatial::mass_matrix(spatial, &mut matrix),
        }
    }
    matrix
}

/// Sets the entries of a system whose joints are all balls.
fn of_balls<'g>(spatial: &Spatial<'g, '_>, matrix: &mut [Vec<Option<Expr<'g>>>]) {
    let Spatial {
        graph,
        model,
        layout,
        system: s,
        motion,
        tree,
    } = *spatial;
    let system = spatial.of_system();
    let mut set = |i: usize, j: usize, value: Expr<'g>| {
        if !value.is_zero() {
            matrix[i][j] = Some(value);
            matrix[j][i] = Some(value);
        }
    };
    let reference = layout.reference_velocities(s);
    if let Some(x) = &reference {
        graph.section(format!("S[{0}.x, {0}.x]", system.name));
        for i in x.clone() {
            set(i, i, tree.bodies[0].mass);
        }
    }
    for k in 0..system.elements.len() {
        let id = ElementId {
            system: s,
            element: k,
        };
        let name = path(model, id);
        let (element, body) = (motion.element(id), &tree.bodies[k]);
        let rows = layout.element_velocities(id);

        graph.section(format!("S[{name}, {name}]"));
        let columns: Vec<Vec3<'g>> = element
            .axes
            .iter()
            .map(|e| body.inertia.times(*e))
            .collect();
        for (i, e) in element.axes.iter().enumerate() {
            for (j, column) in columns.iter().enumerate().skip(i) {
                set(rows.start + i, rows.start + j, e.dot(*column));
            }
        }

        let turned = element.turned(body.first_moment);
        if let Some(x) = &reference {
            graph.section(format!("S[{}.x, {name}]", system.name));
            for (i, &direction) in x.clone().zip(layout.directions) {
                for (j, column) in turned.iter().enumerate() {
                    set(i, rows.start + j, column.0[direction]);
                }
            }
        }

        let mut child = k;
        while let Some(parent) = system.elements[child].parent {
            let inboard = ElementId {
                system: s,
                element: parent,
            };
            graph.section(format!("S[{}, {name}]", path(model, inboard)));
            let offset = motion.systems[s][child].offset;
            let rows_inboard = layout.element_velocities(inboard);
            for (i, row) in motion.element(inboard).turned(offset).iter().enumerate() {
                for (j, column) in turned.iter().enumerate() {
                    set(rows_inboard.start + i, rows.start + j, row.dot(*column));
                }
            }
            child = parent;
        }
    }
}
