//! Systems that have joints other than balls, in the frames of their links: S, r_s and r_k, and the accelerations by
//! two routes.
//!
//! In axes fixed to a link, the inertia of its body is constant, many of its entries are 0 in a suitable frame, and a
//! rotation about the joint's axis mixes only two components. Mass on the axis of a hinge is regrouped to the parent
//! beforehand. Velocities enter by a reference motion, so they are never multiplied by an articulated inertia.
//!
//! | file | |
//! |---|---|
//! | `tree` | the links of a system |
//! | `body` | mass, first and second moment |
//! | `frames` | the frames of links, and regrouping |
//! | `regrouping` | regrouping partly undone, for the reference motion |
//! | `turn` | rotations between two frames |
//! | `motion` | the reference motion |
//! | `elimination` | v̇ by the articulated-body algorithm |
//! | `articulated_inertia`, `axis` | the articulated inertia outboard of a joint, and an axis in it |
//! | `shared_velocities` | velocities that several links share |
//! | `wrench` | how bodies and wrenches are passed from a link to its parent |
//! | `mass_matrix` | S by composite bodies |
//! | `forces` | generalised forces |
//! | `derivatives` | the derivatives of the generalised forces that a motion needs |
//! | `search` | the choice of frames by operation count |

mod articulated_inertia;
mod axis;
mod body;
pub mod derivatives;
pub mod elimination;
mod forces;
pub mod frames;
mod mass_matrix;
mod motion;
mod regrouping;
pub mod search;
pub mod shared_velocities;
pub mod tree;
mod turn;
mod wrench;

use super::factorization;
use super::spatial::Spatial;
use crate::expression::count::Count;
use crate::expression::passes::factor;
use crate::expression::{Expr, Graph, Symbol};
use crate::force::AppliedForces;
use crate::motion::ball::Orientation;
use crate::motion::kinematics::reference_acceleration;
use crate::motion::numbers::inverse_rates;
use body::Body;
use elimination::Solved;
use frames::{Choice, Framed, natural_axes};
use motion::{LinkMotion, Reference};
use search::Aim;
use tree::{LinkJoint, Tree};
use wrench::Written;

/// v̇ of the system by row, without S; `None` if link frames cannot be used ([`Tree::of`],
/// [`shared_velocities::elimination_links`]).
pub fn accelerations<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
) -> Option<Vec<(usize, Expr<'g>)>> {
    let tree = Tree::of(spatial, Some(applied))?;
    shared_velocities::elimination_links(&tree)?;
    let choice = search::choice(&tree, Aim::Elimination);
    let framed = Framed::of(&tree, &natural_axes(&tree), &choice);
    let name = |link: &tree::Link<'g>| spatial.label(link.element);
    let solved = elimination::accelerations(&tree, &framed, &choice, &name);
    Some(rates(spatial, applied, &tree, &solved))
}

/// Replaces S, r_s and r_k of a system by those in link frames if these take fewer operations. S and r_s are compared
/// together, r_k by itself.
pub fn cheaper_matrices<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    matrix: &mut [Vec<Option<Expr<'g>>>],
    [velocity_forces, applied_forces]: [&mut [Expr<'g>]; 2],
) {
    let choose = |tree: &Tree<'g>| search::choice(tree, Aim::Matrices);
    let Some(found) = matrices(spatial, applied, choose) else {
        return;
    };
    let (graph, size) = (spatial.graph, velocity_forces.len());
    let rows = spatial.layout.system_velocities(spatial.system);
    let mut in_links = vec![vec![None; size]; size];
    add_entries(&mut in_links, &found.matrix);
    let together = |forces: Vec<(usize, Expr<'g>)>| {
        let mut sums = vec![graph.constant(0.0); size];
        for (row, force) in forces {
            sums[row] = sums[row] + force;
        }
        sums
    };
    let (r_s, r_k) = (
        together(found.velocity_forces),
        together(found.applied_forces),
    );
    let of_rows = |matrix: &[Vec<Option<Expr<'g>>>], forces: &[Expr<'g>]| {
        let entries = rows
            .clone()
            .flat_map(|i| matrix[i][i..].iter().copied().flatten());
        entries
            .chain(forces[rows.clone()].iter().copied())
            .collect::<Vec<_>>()
    };
    if cost(graph, &of_rows(&in_links, &r_s)) < cost(graph, &of_rows(matrix, velocity_forces)) {
        for i in rows.clone() {
            matrix[i][rows.clone()].copy_from_slice(&in_links[i][rows.clone()]);
            velocity_forces[i] = r_s[i];
        }
    }
    let rows = || rows.clone();
    if cost(graph, &r_k[rows()]) < cost(graph, &applied_forces[rows()]) {
        applied_forces[rows()].copy_from_slice(&r_k[rows()]);
    }
}

/// Replaces the forces that a system needs for given v̇ by those in link frames, if these take fewer operations.
pub fn cheaper_inverse_dynamics<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    accelerations: &[Expr<'g>],
    forces: &mut [Expr<'g>],
) {
    let Some(tree) = Tree::of(spatial, Some(applied)) else {
        return;
    };
    let tree = tree.accelerated(accelerations, applied.wrenches.fields[spatial.system]);
    let choice = search::choice(&tree, Aim::InverseDynamics);
    let framed = Framed::of(&tree, &natural_axes(&tree), &choice);
    let written = Written {
        tree: &tree,
        framed: &framed,
        choice: &choice,
    };
    let motions = motion::motion(&tree, &framed, &choice, Reference::Rest);
    let needed = forces::needed(&written, &motions);
    let name = |k: usize| spatial.label(tree.links[k].element);
    let mut in_links = vec![spatial.graph.constant(0.0); forces.len()];
    for (row, power) in forces::powers(&written, needed, &name).terms {
        in_links[row] = in_links[row] + power;
    }
    for (k, link) in tree.links.iter().enumerate() {
        if let LinkJoint::Axis { armature, .. } = link.joint {
            let own = written.share(k).squared() * armature * accelerations[link.row];
            in_links[link.row] = in_links[link.row] + own;
        }
    }
    let rows = spatial.layout.system_velocities(spatial.system);
    if cost(spatial.graph, &in_links[rows.clone()]) < cost(spatial.graph, &forces[rows.clone()]) {
        forces[rows.clone()].copy_from_slice(&in_links[rows]);
    }
}

/// Replaces v̇ of the system by v̇ from S in link frames, if this takes fewer operations.
pub fn cheaper_accelerations<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    accelerations: &mut [Expr<'g>],
) {
    let mut in_links = accelerations.to_vec();
    let rows = spatial.layout.system_velocities(spatial.system);
    let choose = |tree: &Tree<'g>| search::choice(tree, Aim::Factorization);
    if accelerations_by_factors(spatial, applied, choose, &mut in_links)
        && cost(spatial.graph, &in_links[rows.clone()])
            < cost(spatial.graph, &accelerations[rows.clone()])
    {
        accelerations[rows.clone()].copy_from_slice(&in_links[rows]);
    }
}

fn cost(graph: &Graph, values: &[Expr<'_>]) -> usize {
    let ids: Vec<_> = values.iter().map(|value| value.id()).collect();
    factor::cost(&Count::of(graph, &ids))
}

/// S, r_s and r_k of a system.
pub struct Matrices<'g> {
    /// Terms of the upper or lower triangle of S, by row and column. Terms with the same place must be added.
    pub matrix: Vec<(usize, usize, Expr<'g>)>,
    /// Terms of r_s by row.
    pub velocity_forces: Vec<(usize, Expr<'g>)>,
    /// Terms of r_k by row.
    pub applied_forces: Vec<(usize, Expr<'g>)>,
}

/// S, and the forces that the reference motion of a system needs, in chosen frames.
struct Needs<'g> {
    /// The composite body of each link.
    composites: Vec<Body<'g>>,
    /// Terms of S by row and column.
    pub matrix: Vec<(usize, usize, Expr<'g>)>,
    /// The reference motion of each link.
    motions: Vec<LinkMotion<'g>>,
    /// Terms, by row, of the forces that the reference motion needs, without applied forces.
    forces: Vec<(usize, Expr<'g>)>,
}

impl<'g> Needs<'g> {
    fn of(written: &Written<'g, '_>, reference: Reference, name: &dyn Fn(usize) -> String) -> Self {
        let composites = mass_matrix::composites(written);
        let entries = mass_matrix::mass_matrix(written, &composites, name);
        let motions = motion::motion(written.tree, written.framed, written.choice, reference);
        let needed = forces::needed(written, &motions);
        let powers = forces::powers(written, needed, name);
        Needs {
            composites,
            matrix: entries.terms,
            motions,
            forces: powers.terms,
        }
    }
}

/// S, r_s and r_k of the system; `None` if link frames do not apply.
pub fn matrices<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    choose: impl FnOnce(&Tree<'g>) -> Choice,
) -> Option<Matrices<'g>> {
    let tree = Tree::of(spatial, None)?;
    let choice = choose(&tree);
    let framed = Framed::of(&tree, &natural_axes(&tree), &choice);
    let written = Written {
        tree: &tree,
        framed: &framed,
        choice: &choice,
    };
    let name = |k: usize| spatial.label(tree.links[k].element);
    let needs = Needs::of(&written, Reference::Rest, &name);
    let velocity_forces = needs.forces.into_iter().map(|(row, power)| (row, -power));

    let loaded = Tree::of(spatial, Some(applied))?;
    let acting = loaded.links.iter().zip(&framed.links).enumerate();
    let acting = acting.map(|(k, (link, frame))| frame.load(link, &choice, k == 0 && loaded.free));
    let mut applied_forces = forces::powers(&written, acting.collect(), &name).terms;
    let reference = reference_acceleration(spatial.graph, spatial.of_system(), spatial.motion);
    let field = applied.wrenches.fields[spatial.system] - reference;
    applied_forces.extend(forces::of_field(&written, &needs.composites, field));
    applied_forces.extend(loaded.on_coordinates());
    Some(Matrices {
        matrix: needs.matrix,
        velocity_forces: velocity_forces.collect(),
        applied_forces,
    })
}

/// Sets the rows of v̇ of the system, computed from its S; returns false if link frames do not apply.
pub fn accelerations_by_factors<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    choose: impl FnOnce(&Tree<'g>) -> Choice,
    accelerations: &mut [Expr<'g>],
) -> bool {
    let Some(tree) = Tree::of(spatial, Some(applied)) else {
        return false;
    };
    let choice = choose(&tree);
    let framed = Framed::of(&tree, &natural_axes(&tree), &choice);
    let written = Written {
        tree: &tree,
        framed: &framed,
        choice: &choice,
    };
    let name = |k: usize| spatial.label(tree.links[k].element);
    let needs = Needs::of(&written, Reference::ChosenOfAxes, &name);
    let motions = needs.motions.iter().enumerate();
    let references: Vec<Expr<'g>> = motions.map(|(k, m)| written.reference(k, m)).collect();
    let size = accelerations.len();
    let mut matrix = vec![vec![None; size]; size];
    add_entries(&mut matrix, &needs.matrix);
    let zero = spatial.graph.constant(0.0);
    let (mut needed, mut acting) = (vec![zero; size], vec![zero; size]);
    for (row, power) in needs.forces {
        needed[row] = needed[row] - power;
    }
    for (row, force) in tree.on_coordinates() {
        acting[row] = acting[row] + force;
    }
    for (link, reference) in tree.links.iter().zip(&references) {
        if let LinkJoint::Axis { armature, .. } = link.joint {
            needed[link.row] = needed[link.row] - armature * *reference;
        }
    }
    let rows = spatial.layout.system_velocities(spatial.system);
    let forces = [&needed[..], &acting];
    factorization::accelerations_of(spatial.graph, rows, &matrix, forces, accelerations);
    for (link, reference) in tree.links.iter().zip(references) {
        accelerations[link.row] = accelerations[link.row] + reference;
    }
    if let Some(rows) = spatial.layout.reference_velocities(spatial.system) {
        let field = applied.wrenches.fields[spatial.system];
        for (row, &direction) in rows.zip(spatial.layout.directions) {
            accelerations[row] = accelerations[row] + field.0[direction];
        }
    }
    true
}

/// Adds terms to both triangles of S.
pub fn add_entries<'g>(matrix: &mut [Vec<Option<Expr<'g>>>], terms: &[(usize, usize, Expr<'g>)]) {
    for &(i, j, value) in terms {
        if !value.is_zero() {
            let sum = matrix[i][j].map_or(value, |entry| entry + value);
            (matrix[i][j], matrix[j][i]) = (Some(sum), Some(sum));
        }
    }
}

/// v̇ of the joints of all links, by row.
pub fn rates<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    tree: &Tree<'g>,
    solved: &[Solved<'g>],
) -> Vec<(usize, Expr<'g>)> {
    let graph = spatial.graph;
    let mut rates = Vec::new();
    for (link, solved) in tree.links.iter().zip(solved) {
        if !link.joint.is_ball() {
            // links that share a velocity have the same rate, so only the first counts
            if !rates.iter().any(|(row, _)| *row == link.row) {
                rates.push((link.row, solved.rotation.0[0]));
            }
            continue;
        }
        let motion = spatial.motion_of(link.element);
        let turned = match spatial.layout.orientation {
            Orientation::Bryant => {
                let second = spatial.layout.element_coordinates(spatial.id(link.element));
                let cosine = graph
                    .symbol(Symbol::Coordinate(second.start as u32 + 1))
                    .cos();
                let nu = solved.rotation - motion.bias;
                inverse_rates(motion.axes[1], motion.axes[2], cosine, nu)
            }
            Orientation::Quaternion | Orientation::Angle => solved.rotation.0,
        };
        rates.extend(
            turned
                .into_iter()
                .enumerate()
                .map(|(i, rate)| (link.row + i, rate)),
        );
    }
    if let Some(rows) = spatial.layout.reference_velocities(spatial.system) {
        let field = applied.wrenches.fields[spatial.system];
        for (row, &direction) in rows.zip(spatial.layout.directions) {
            rates.push((row, solved[0].base.0[direction] + field.0[direction]));
        }
    }
    rates
}
