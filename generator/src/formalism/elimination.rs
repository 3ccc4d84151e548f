//! Accelerations without ever assembling S.   \[after Featherstone 2008, ch. 7, for ball joints\]
//!
//! A ball joint passes a force but no moment: what is outboard of joint k answers an acceleration a of that joint with the
//! force f = K a + h, K symmetric 3×3. Of K only the part that is not constant is carried, K = M·1 − P, as six numbers, so
//! that it cannot lose its symmetry; the constant part is in the augmented bodies.
//!
//! Leaves to root, with e_c = h_c − P_c γ(u_c):
//!
//! | | |
//! |---|---|
//! | f = (M·1 − ΣP_c) a + H α + f₀ | H = D(w) − Σ P_c D(u_c),   f₀ = γ(w) + Σ e_c − F |
//! | 0 = Hᵀ a + J' α + t₀ | J' = EᵀJE − Σ D(u_c)ᵀ P_c D(u_c),   t₀ = Eᵀ(ω × Jω + Σ u_c × e_c − τ) |
//! | P = ΣP_c + H J'⁻¹ Hᵀ | h = f₀ − H J'⁻¹ t₀ |
//!
//! Root to leaves: a of the root from K a + h = 0, or given; α = −J'⁻¹ (Hᵀ a + t₀); a_c = a + α × u_c + γ(u_c).
//! A field common to the whole system is an acceleration of the absolute frame the other way: it enters once, at the root.
//! E are the absolute axes in space, e_y in the plane; Bryant angles follow from φ̈ = W⁻¹ (α − ε).

use super::augmented::AugmentedTree;
use super::factorization::Ldl;
use super::force::Loads;
use super::kinematics::{Motion, identifier, inverse_rates, path, reference_acceleration};
use super::layout::{Layout, Orientation};
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Expr, Graph, Symbol};
use crate::model::{Dimension, ElementId, Model};

/// v̇.
pub fn accelerations<'g>(
    graph: &'g Graph,
    model: &Model,
    layout: &Layout,
    motion: &Motion<'g>,
    trees: &[AugmentedTree<'g>],
    loads: &Loads<'g>,
) -> Vec<Expr<'g>> {
    let mut accelerations = vec![graph.constant(0.0); layout.velocities.len()];
    for (system, tree) in trees.iter().enumerate() {
        let elimination = Elimination {
            graph,
            model,
            layout,
            system,
            motion,
            tree,
            loads,
        };
        let eliminated = elimination.leaves_to_root();
        elimination.root_to_leaves(&eliminated, &mut accelerations);
    }
    accelerations
}

/// The elimination of one system.
struct Elimination<'g, 'a> {
    graph: &'g Graph,
    model: &'a Model,
    layout: &'a Layout,
    system: usize,
    motion: &'a Motion<'g>,
    tree: &'a AugmentedTree<'g>,
    loads: &'a Loads<'g>,
}

/// What the way inwards leaves behind for the way outwards, per element.
struct Eliminated<'g> {
    /// J' = L D Lᵀ
    factors: Ldl<'g>,
    /// Z = D⁻¹ L⁻¹ Hᵀ, one row per freedom of rotation.
    z: Vec<Vec3<'g>>,
    /// D⁻¹ L⁻¹ t₀
    z_bias: Vec<Expr<'g>>,
    /// P: the answer of joint k is f = (M·1 − P) a + h.
    resistance: Sym3<'g>,
    /// h
    force: Vec3<'g>,
}

/// Axes of the freedoms of rotation, those of the absolute frame that the dimension has, with their indices.
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

impl<'g> Elimination<'g, '_> {
    fn leaves_to_root(&self) -> Vec<Eliminated<'g>> {
        let Elimination {
            graph,
            model,
            system,
            motion,
            tree,
            loads,
            ..
        } = *self;
        let axes = rotations(graph, model.dimension);
        // Children come after their parents: from the last element back, those of k are on the stack when k is met.
        let mut done: Vec<Option<Eliminated<'g>>> = (0..tree.bodies.len()).map(|_| None).collect();
        for k in (0..tree.bodies.len()).rev() {
            let id = ElementId { system, element: k };
            let (element, body, load) = (
                motion.element(id),
                &tree.bodies[k],
                &loads.elements[system][k],
            );
            let (name, label) = (identifier(model, id), path(model, id));

            graph.section(format!("element {label}: forces of velocity and load"));
            let mut force = element.centripetal(body.first_moment) - load.force;
            let mut moment = body.gyroscopic_moment(graph, element.omega) - load.moment;
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

            for &c in &tree.children[k] {
                let Some(child) = &done[c] else { continue };
                let offset = motion.systems[system][c].offset;
                graph.section(format!(
                    "element {label}: what {} passes on",
                    path(model, ElementId { system, element: c })
                ));
                let passed = child.force - child.resistance.times(element.centripetal(offset));
                force = force + passed;
                moment = moment + offset.cross(passed);
                let turned: Vec<Vec3<'g>> = axes.iter().map(|(_, e)| e.cross(offset)).collect();
                let resisted: Vec<Vec3<'g>> =
                    turned.iter().map(|d| child.resistance.times(*d)).collect();
                for i in 0..axes.len() {
                    columns[i] = columns[i] - resisted[i];
                    for j in 0..=i {
                        inertia[i][j] = inertia[i][j] - turned[i].dot(resisted[j]);
                    }
                }
                resistance = resistance + child.resistance;
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
            resistance.named(&format!("p_{name}"));
            force.named(&format!("h_{name}"));
            done[k] = Some(Eliminated {
                factors,
                z,
                z_bias,
                resistance,
                force,
            });
        }
        done.into_iter().flatten().collect()
    }

    fn root_to_leaves(&self, eliminated: &[Eliminated<'g>], accelerations: &mut [Expr<'g>]) {
        let Elimination {
            graph,
            model,
            layout,
            system,
            motion,
            tree,
            loads,
        } = *self;
        let field = loads.fields[system];
        let elements = &model.systems[system].elements;
        let root = &eliminated[0];

        // the root's joint, in a frame in which the common field is at rest
        graph.section(format!(
            "system {}: reference joint",
            model.systems[system].name
        ));
        let mut joint = vec![
            reference_acceleration(graph, &model.systems[system], motion) - field;
            elements.len()
        ];
        if let Some(range) = layout.reference_velocities(system) {
            let directions = layout.directions;
            let stiffness = directions
                .iter()
                .enumerate()
                .map(|(i, &row)| {
                    directions[..=i]
                        .iter()
                        .map(|&column| {
                            let own = if row == column {
                                tree.bodies[0].mass
                            } else {
                                graph.constant(0.0)
                            };
                            own - root.resistance.entry(row, column)
                        })
                        .collect()
                })
                .collect();
            let right = directions.iter().map(|&d| -root.force.0[d]).collect();
            joint[0] = Vec3::zero(graph);
            for ((&d, row), a) in directions
                .iter()
                .zip(range)
                .zip(Ldl::of(graph, stiffness).solve(right))
            {
                joint[0].0[d] = a;
                accelerations[row] = a + field.0[d];
            }
        }

        for (k, element) in elements.iter().enumerate() {
            let id = ElementId { system, element: k };
            let (name, label) = (identifier(model, id), path(model, id));
            if let Some(parent) = element.parent {
                graph.section(format!("element {label}: acceleration of its joint"));
                let (inboard, offset) = (
                    &motion.systems[system][parent],
                    motion.systems[system][k].offset,
                );
                let alpha = angular_acceleration(
                    graph,
                    model.dimension,
                    &eliminated[parent],
                    joint[parent],
                );
                joint[k] = joint[parent] + alpha.cross(offset) + inboard.centripetal(offset);
                joint[k].named(&format!("a_{name}"));
            }
            graph.section(format!("element {label}: angular acceleration"));
            let alpha = angular_acceleration(graph, model.dimension, &eliminated[k], joint[k])
                .named(&format!("alpha_{name}"));
            let range = layout.element_velocities(id);
            let rates = match layout.orientation {
                Orientation::Angle => vec![alpha.0[1]],
                Orientation::Quaternion => alpha.0.to_vec(),
                Orientation::Bryant => {
                    let motion = motion.element(id);
                    let second = graph.symbol(Symbol::Coordinate(
                        layout.element_coordinates(id).start as u32 + 1,
                    ));
                    inverse_rates(
                        motion.axes[1],
                        motion.axes[2],
                        second.cos(),
                        alpha - motion.bias,
                    )
                    .to_vec()
                }
            };
            for (row, rate) in range.zip(rates) {
                accelerations[row] = rate;
            }
        }
    }
}

/// α = −J'⁻¹ (Hᵀ a + t₀)
fn angular_acceleration<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    element: &Eliminated<'g>,
    joint: Vec3<'g>,
) -> Vec3<'g> {
    let right = element
        .z
        .iter()
        .zip(&element.z_bias)
        .map(|(z, bias)| z.dot(joint) + *bias)
        .collect();
    let mut alpha = Vec3::zero(graph);
    for ((i, _), value) in rotations(graph, dimension)
        .into_iter()
        .zip(element.factors.backward(right))
    {
        alpha.0[i] = -value;
    }
    alpha
}
