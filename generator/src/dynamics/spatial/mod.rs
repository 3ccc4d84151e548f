//! Systems that have joints other than balls, by spatial algebra in absolute axes.   \[Featherstone 2008\]
//!
//! An element k has the origin p_k, in its joint, and the columns (s_j, e_j) of its velocities (`joint::twist`). With
//! the carrier p and u = p_k − p_p (if k is on a ball joint, it does not turn with its carrier, so α_k has no term
//! α_p),
//!
//! a_k = a_p + α_p × u + c_k + Σ s_j v̇_j,   α_k = α_p + Σ e_j v̇_j + …      (c_k and … are the terms without v̇)
//!
//! A wrench (f, n) on k, with n about p_k, has the power (s_j · f + e_j · n) v_j. Its carrier feels (f, n + u × f);
//! through a ball joint no n passes.
//!
//! | file | |
//! |---|---|
//! | `mass_matrix` | S by composite bodies |
//! | `inverse_dynamics` | r_s and r_k by the recursive Newton–Euler algorithm |
//! | `articulated_body` | v̇ by the articulated-body algorithm |
//!
//! A freedom that follows another has q̇ = ratio · q̇ of the leader: its column, times the ratio, is added to
//! the leader's. The articulated-body algorithm of this module cannot handle this, because the two are at different
//! places of the tree; then v̇ follows from S. The algorithm in [the frames of the links](super::link) can handle it.
//!
//! Systems whose joints are all balls have a shorter algorithm (`elimination`), which treats the mass of carried
//! elements as a point mass of the carrier.

mod articulated_body;
mod inverse_dynamics;
mod mass_matrix;

use crate::motion::{ElementMotion, Layout, Motion};
pub use articulated_body::accelerations;
pub use inverse_dynamics::{applied_forces, inverse_dynamics, velocity_forces};
pub use mass_matrix::mass_matrix;

use super::factorization;
use crate::force::AppliedForces;

use super::augmented_body::{AugmentedBody, AugmentedTree, with_points};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::model::Joint;
use crate::model::{ElementId, Model, System};
use crate::motion::ball::Orientation;
use crate::motion::kinematics::{identifier, path};
use crate::motion::numbers::number;
use std::ops::Range;

/// A system in motion.
#[derive(Clone, Copy)]
pub struct Spatial<'g, 'a> {
    /// The graph of the expressions.
    pub graph: &'g Graph,
    /// The model.
    pub model: &'a Model,
    /// Its coordinates.
    pub layout: &'a Layout,
    /// Index of the system.
    pub system: usize,
    /// Its motion.
    pub motion: &'a Motion<'g>,
    /// The augmented bodies of its elements; they also tell which gyroscopic moment is left out.
    pub tree: &'a AugmentedTree<'g>,
}

/// A column (s, e) of a velocity of an element: s moves the origin relative to the carrier, e turns the element.
#[derive(Clone, Copy)]
pub struct Column<'g> {
    /// Index in v.
    pub row: usize,
    /// Inertia that only this velocity moves.
    armature: Expr<'g>,
    pub slide: Vec3<'g>,
    pub axis: Vec3<'g>,
}

/// A wrench: a force at the origin of an element and a moment about it, in absolute axes.
#[derive(Clone, Copy)]
pub struct Wrench<'g> {
    pub force: Vec3<'g>,
    pub moment: Vec3<'g>,
}

impl<'g> Column<'g> {
    /// The power s · f + e · n.
    pub fn power(&self, wrench: &Wrench<'g>) -> Expr<'g> {
        self.slide.dot(wrench.force) + self.axis.dot(wrench.moment)
    }
}

impl<'g> Wrench<'g> {
    /// The wrench 0.
    pub fn none(graph: &'g Graph) -> Self {
        Wrench {
            force: Vec3::zero(graph),
            moment: Vec3::zero(graph),
        }
    }

    pub fn plus(self, other: Wrench<'g>) -> Self {
        Wrench {
            force: self.force + other.force,
            moment: self.moment + other.moment,
        }
    }

    /// The wrench that the carrier of an element feels from a wrench on the element.
    pub fn on_carrier(self, of: &ElementMotion<'g>) -> Self {
        let moment = of.offset.cross(self.force);
        Wrench {
            force: self.force,
            moment: match of.turns_with_carrier {
                true => self.moment + moment,
                false => moment,
            },
        }
    }
}

/// Sets the rows of v̇ of a system in which freedoms follow others, computed from its S.
pub fn coupled_accelerations<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    accelerations: &mut [Expr<'g>],
) {
    let size = accelerations.len();
    let mut matrix = vec![vec![None; size]; size];
    let mut r_s = vec![spatial.graph.constant(0.0); size];
    let mut r_k = r_s.clone();
    mass_matrix(spatial, &mut matrix);
    velocity_forces(spatial, &mut r_s);
    applied_forces(spatial, applied, &mut r_k);
    let rows = spatial.layout.system_velocities(spatial.system);
    factorization::accelerations_of(spatial.graph, rows, &matrix, [&r_s, &r_k], accelerations);
}

impl<'g, 'a> Spatial<'g, 'a> {
    pub fn of_system(&self) -> &'a System {
        &self.model.systems[self.system]
    }

    /// Whether all joints of the system are balls.
    pub fn has_balls_alone(&self) -> bool {
        self.of_system().has_balls_alone()
    }

    pub fn id(&self, element: usize) -> ElementId {
        ElementId {
            system: self.system,
            element,
        }
    }

    pub fn motion_of(&self, element: usize) -> &'a ElementMotion<'g> {
        &self.motion.systems[self.system][element]
    }

    pub fn rows(&self, element: usize) -> Range<usize> {
        self.layout.element_velocities(self.id(element))
    }

    pub fn label(&self, element: usize) -> String {
        path(self.model, self.id(element))
    }

    fn name(&self, element: usize) -> String {
        identifier(self.model, self.id(element))
    }

    /// Whether v of an element are the rates of Bryant angles.
    pub fn has_bryant_angles(&self, element: usize) -> bool {
        self.layout.orientation == Orientation::Bryant
            && self.of_system().elements[element].joint == Joint::Ball
    }

    /// The velocities of an element's joint. If a freedom follows another, its column belongs to the leader's
    /// velocity.
    pub fn columns(&self, element: usize) -> Vec<Column<'g>> {
        let motion = self.motion_of(element);
        let none = Vec3::zero(self.graph);
        let slides = motion.slides.iter().copied();
        let slides = slides.chain(std::iter::repeat(none));
        let axes = motion.axes.iter().copied();
        let freedoms = self.of_system().elements[element].joint.freedoms().iter();
        let armatures = freedoms.map(|freedom| number(self.graph, &freedom.armature));
        let armatures = armatures.chain(std::iter::repeat(self.graph.constant(0.0)));
        let shares = self.layout.shares(self.graph, self.model, self.id(element));
        let columns = shares.into_iter().zip(axes.zip(slides)).zip(armatures);
        columns
            .map(|((share, (axis, slide)), armature)| Column {
                row: share.velocity,
                slide: share.ratio * slide,
                axis: share.ratio * axis,
                armature: share.ratio * share.ratio * armature,
            })
            .collect()
    }

    /// True if a freedom follows another. Then S has more entries than the tree alone tells.
    pub fn is_coupled(&self) -> bool {
        self.of_system().is_coupled()
    }

    /// The bodies of single elements, about their origins.
    pub fn bodies(&self) -> Vec<AugmentedBody<'g>> {
        let elements = self.of_system().elements.iter().enumerate();
        let origin = Vec3::zero(self.graph);
        elements
            .map(|(k, element)| {
                self.graph
                    .section(format!("element {}: body", self.label(k)));
                let own = with_points(self.graph, self.model.dimension, element, origin, &[]);
                let rotation = &self.motion_of(k).rotation;
                AugmentedBody {
                    gyroscopic: self.tree.bodies[k].gyroscopic,
                    ..AugmentedBody::turned(self.graph, rotation, own, &self.name(k))
                }
            })
            .collect()
    }

    /// The acceleration of every origin for v̇ = 0, given that of the reference joint.
    fn origin_biases(&self, reference: Vec3<'g>) -> Vec<Vec3<'g>> {
        let mut biases: Vec<Vec3<'g>> = Vec::new();
        for (k, element) in self.of_system().elements.iter().enumerate() {
            let motion = self.motion_of(k);
            self.graph.section(format!(
                "element {}: acceleration of its origin",
                self.label(k)
            ));
            let inboard = element.parent.map_or(reference, |parent| biases[parent]);
            let relative = match (motion.turns_with_carrier, element.parent) {
                (true, _) => motion.slide_bias,
                (false, Some(parent)) => self.motion_of(parent).gamma(motion.offset),
                (false, None) => Vec3::zero(self.graph),
            };
            biases.push(inboard + relative);
        }
        biases
    }

    /// The wrench that the body of an element needs for v̇ = 0, given the acceleration of its origin.
    fn inertia(&self, k: usize, body: &AugmentedBody<'g>, acceleration: Vec3<'g>) -> Wrench<'g> {
        let motion = self.motion_of(k);
        Wrench {
            force: body.mass * acceleration + motion.gamma(body.first_moment),
            moment: body.inertia.times(motion.bias)
                + body.gyroscopic_moment(self.graph, motion.omega)
                + body.first_moment.cross(acceleration),
        }
    }
}
