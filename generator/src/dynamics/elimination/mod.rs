//! Accelerations by the articulated-body algorithm, without S, for ball joints.   \[after Featherstone 2008, ch. 7\]
//!
//! A ball joint passes a force but no moment. So for the acceleration a of joint k, the bodies outboard of it need the
//! force
//!
//! f = μ a − Q (a + a₀) + h
//!
//! at the joint. μ is a constant and Q a symmetric 3×3 matrix; a₀ and h are the bias, i.e. the terms that do not depend
//! on a (`ArticulatedBody`). Only Q is transformed from joint to joint; its six entries keep it symmetric. μ is added
//! to the constants of the body inboard, as a point mass at the joint. Each element chooses the μ and a₀ that suit it:
//!
//! | element | strategy |
//! |---|---|
//! | any | `absolute`: moments about the absolute axes, 3×3 matrix |
//! | one joint outboard, no force | `link`: axes along the link, 2×2 matrix; the row of the spin about the link contains only constants of the body |
//! | no joint outboard, no force | `tip`: Q is constant in the frame of the body, no factorisation |
//!
//! From the leaves to the root, each element combines the articulated inertias of its children into its own. From the
//! root to the leaves, a of the root is given or follows from f = 0; then each element gets α from a, and its children
//! a_c = a + α × u_c + γ(u_c). The velocity part β of a is summed beforehand, β_c = β + γ(u_c), starting anew at 0
//! behind each `link`; only a − β is passed on. For a floating system, a of the root is taken at the joint of one of
//! its children, where u_c = 0; the reference joint follows last. A field common to the whole system acts like the
//! opposite acceleration of the absolute frame, so it enters once, at the root. Bryant angles follow from φ̈ = W⁻¹ (α −
//! ε).

mod absolute;
mod frame;
mod link;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod tip;

use super::augmented_body::AugmentedTree;
use super::factorization::Ldl;
use super::link as link_frames;
use super::spatial::{self, Spatial};
use crate::expression::count::Count;
use crate::expression::passes::factor;
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Expr, Graph, Symbol};
use crate::force::{AppliedForces, Wrench};
use crate::model::{Dimension, Element, ElementId, Model};
use crate::motion::ball::Orientation;
use crate::motion::kinematics::{identifier, path, reference_acceleration};
use crate::motion::numbers::inverse_rates;
use crate::motion::numbers::vector;
use crate::motion::{ElementMotion, Layout, Motion};
use absolute::Absolute;
use link::Link;
use tip::Tip;

/// v̇ of all systems, by row.
pub fn accelerations<'g>(
    systems: &[Spatial<'g, '_>],
    applied: &AppliedForces<'g>,
    zero: Expr<'g>,
    size: usize,
) -> Vec<Expr<'g>> {
    let mut accelerations = vec![zero; size];
    for spatial in systems {
        if !spatial.has_balls_alone() {
            with_axes(spatial, applied, &mut accelerations);
            continue;
        }
        let mut elimination = Elimination::new(spatial, applied);
        let eliminated = elimination.leaves_to_root();
        elimination.root_to_leaves(&eliminated, &mut accelerations);
    }
    accelerations
}

/// Sets the rows of a system that has joints other than balls. Derives them in absolute axes and in the frames of
/// links, and takes the version with fewer operations.
fn with_axes<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    accelerations: &mut [Expr<'g>],
) {
    let mut rates = match spatial.is_coupled() {
        true => {
            spatial::coupled_accelerations(spatial, applied, accelerations);
            link_frames::cheaper_accelerations(spatial, applied, accelerations);
            let rows = spatial.layout.system_velocities(spatial.system);
            rows.map(|row| (row, accelerations[row])).collect()
        }
        false => spatial::accelerations(spatial, applied),
    };
    if let Some(in_links) = link_frames::accelerations(spatial, applied) {
        let cost = |rates: &[(usize, Expr<'g>)]| {
            let ids: Vec<_> = rates.iter().map(|(_, rate)| rate.id()).collect();
            factor::cost(&Count::of(spatial.graph, &ids))
        };
        if cost(&in_links) < cost(&rates) {
            rates = in_links;
        }
    }
    for (row, rate) in rates {
        accelerations[row] = rate;
    }
}

/// Articulated inertia and bias force of the bodies that a joint carries: f = μ a − Q (a + a₀) + h.
#[derive(Clone, Copy)]
struct ArticulatedBody<'g> {
    /// μ \[kg\]
    mass: Expr<'g>,
    /// Q \[kg\]
    resistance: Sym3<'g>,
    /// a₀ \[m/s²\]
    bias: Vec3<'g>,
    /// h \[N\]
    force: Vec3<'g>,
}

/// The strategy of elimination of an element, with the quantities that the pass inwards leaves for the pass outwards.
enum Strategy<'g> {
    Absolute(Absolute<'g>),
    Link(Box<Link<'g>>),
    Tip(Box<Tip<'g>>),
}

/// One element.
#[derive(Clone, Copy)]
struct Body<'g, 'a> {
    graph: &'g Graph,
    dimension: Dimension,
    layout: &'a Layout,
    id: ElementId,
    element: &'a Element,
    motion: &'a ElementMotion<'g>,
    /// Whether ω × Jω is included.
    gyroscopic: bool,
}

/// One element with its children.
struct BodyWithChildren<'g, 'a> {
    body: Body<'g, 'a>,
    load: &'a Wrench<'g>,
    /// The reference point of moments and of a, in the local frame: the joint, except for the root of a floating
    /// system.
    origin: Vec3<'g>,
    /// β of the origin: its velocity-product acceleration.
    beta: Vec3<'g>,
    children: Vec<Child<'g>>,
}

/// A child in the elimination of its parent.
struct Child<'g> {
    /// Path of the child, for section titles.
    label: String,
    /// s − origin: the joint of the child from the origin of the parent, in the parent's local frame.
    at: Vec3<'g>,
    /// u: the same vector in absolute axes.
    offset: Vec3<'g>,
    /// β of the child's joint.
    beta: Vec3<'g>,
    response: ArticulatedBody<'g>,
}

/// The elimination of one system.
struct Elimination<'g, 'a> {
    graph: &'g Graph,
    model: &'a Model,
    layout: &'a Layout,
    system: usize,
    motion: &'a Motion<'g>,
    tree: &'a AugmentedTree<'g>,
    applied: &'a AppliedForces<'g>,
    /// The child of a floating root whose joint is the origin of the root's equations.
    center: Option<usize>,
    /// For each element, u: its joint from the origin of its parent, in absolute axes.
    offsets: Vec<Vec3<'g>>,
    /// For each element, β of its joint.
    betas: Vec<Vec3<'g>>,
    /// For each element that is eliminated as a link, the axes along it.
    links: Vec<Option<link::Axes<'g>>>,
}

impl<'g, 'a> Elimination<'g, 'a> {
    fn new(spatial: &Spatial<'g, 'a>, applied: &'a AppliedForces<'g>) -> Self {
        let Spatial {
            graph,
            model,
            layout,
            system,
            motion,
            tree,
        } = *spatial;
        let elements = &model.systems[system].elements;
        let floats = layout.reference_velocities(system).is_some();
        let center = floats
            .then(|| center(graph, elements, &tree.children[0]))
            .flatten();
        let at = |k: usize| vector(graph, &elements[k].at);
        let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
        let idle = idle(elements, &applied.wrenches.elements[system]);
        let body = |k: usize| {
            let id = ElementId { system, element: k };
            Body {
                graph,
                dimension: model.dimension,
                layout,
                id,
                element: &elements[k],
                motion: motion.element(id),
                gyroscopic: tree.bodies[k].gyroscopic,
            }
        };
        let links: Vec<_> = (0..elements.len())
            .map(|k| {
                let id = ElementId { system, element: k };
                graph.section(format!("element {}: axes along it", path(model, id)));
                let children: Vec<_> = tree.children[k].iter().map(|&c| at(c)).collect();
                let centered = center.is_some() && k == 0;
                (idle[k] && !centered)
                    .then(|| link::Axes::of(&body(k), &children, &defaults))
                    .flatten()
            })
            .collect();
        let mut offsets = Vec::with_capacity(elements.len());
        let mut betas = Vec::with_capacity(elements.len());
        for (k, element) in elements.iter().enumerate() {
            let Some(parent) = element.parent else {
                offsets.push(Vec3::zero(graph));
                betas.push(Vec3::zero(graph));
                continue;
            };
            let inboard = &motion.systems[system][parent];
            let of = |element| path(model, ElementId { system, element });
            graph.section(format!("element {}: joint of {}", of(parent), of(k)));
            let offset = match (center, &links[parent]) {
                (Some(center), _) if parent == 0 => inboard.rotation.times(at(k) - at(center)),
                (_, Some(link)) => link.offset(),
                _ => motion.systems[system][k].offset,
            };
            offsets.push(offset);
            let base: Vec3<'g> = match links[parent] {
                Some(_) => Vec3::zero(graph),
                None => betas[parent],
            };
            betas.push(base + inboard.centripetal(offset));
        }
        Elimination {
            graph,
            model,
            layout,
            system,
            motion,
            tree,
            applied,
            center,
            offsets,
            betas,
            links,
        }
    }

    fn leaves_to_root(&mut self) -> Vec<(Strategy<'g>, ArticulatedBody<'g>)> {
        let Elimination {
            graph,
            model,
            layout,
            system,
            ..
        } = *self;
        let elements = &model.systems[system].elements;
        let center = self.center;
        let origin = |k: usize| match center {
            Some(center) if k == 0 => vector(graph, &elements[center].at),
            _ => Vec3::zero(graph),
        };
        // Children come after their parents, so going backwards all children of k are done when k is reached.
        let mut done: Vec<Option<(Strategy<'g>, ArticulatedBody<'g>)>> =
            elements.iter().map(|_| None).collect();
        for (k, element) in elements.iter().enumerate().rev() {
            let id = ElementId { system, element: k };
            let children = self.tree.children[k].iter().filter_map(|&c| {
                let (_, response) = done[c].as_ref()?;
                Some(Child {
                    label: path(model, ElementId { system, element: c }),
                    at: vector(graph, &elements[c].at) - origin(k),
                    offset: self.offsets[c],
                    beta: self.betas[c],
                    response: *response,
                })
            });
            let place = BodyWithChildren {
                body: Body {
                    graph,
                    dimension: model.dimension,
                    layout,
                    id,
                    element,
                    motion: self.motion.element(id),
                    gyroscopic: self.tree.bodies[k].gyroscopic,
                },
                load: &self.applied.wrenches.elements[system][k],
                origin: origin(k),
                beta: self.betas[k],
                children: children.collect(),
            };
            let (name, label) = (identifier(model, id), path(model, id));
            let link = |axes| {
                let (link, response) = place.link(axes, &label)?;
                Some((Strategy::Link(Box::new(link)), response))
            };
            let tip = || {
                let (tip, response) = place.tip(&label)?;
                Some((Strategy::Tip(Box::new(tip)), response))
            };
            let way = self.links[k].take().and_then(link).or_else(tip);
            let (way, response) = way.unwrap_or_else(|| {
                let (absolute, response) = place.absolute(&name, &label);
                (Strategy::Absolute(absolute), response)
            });
            response.resistance.named(&format!("p_{name}"));
            response.force.named(&format!("h_{name}"));
            done[k] = Some((way, response));
        }
        done.into_iter().flatten().collect()
    }

    fn root_to_leaves(
        &self,
        eliminated: &[(Strategy<'g>, ArticulatedBody<'g>)],
        accelerations: &mut [Expr<'g>],
    ) {
        let Elimination {
            graph,
            model,
            layout,
            system,
            motion,
            applied,
            ..
        } = *self;
        let field = applied.wrenches.fields[system];
        let elements = &model.systems[system].elements;
        let reference = format!("system {}: reference joint", model.systems[system].name);

        // a − β, in a frame in which the common field vanishes; for the root, β is 0
        graph.section(reference.as_str());
        let mut joint = vec![
            reference_acceleration(graph, &model.systems[system], motion) - field;
            elements.len()
        ];
        if layout.reference_velocities(system).is_some() {
            joint[0] = self.floating(&eliminated[0].1);
        }

        for (k, element) in elements.iter().enumerate() {
            let id = ElementId { system, element: k };
            let (name, label) = (identifier(model, id), path(model, id));
            graph.section(format!("element {label}: angular acceleration"));
            let (alpha, outboard) = eliminated[k].0.outwards(graph, model.dimension, joint[k]);
            let alpha = alpha.named(&format!("alpha_{name}"));
            for &c in &self.tree.children[k] {
                let id = ElementId { system, element: c };
                let (name, label) = (identifier(model, id), path(model, id));
                graph.section(format!("element {label}: acceleration of its joint"));
                joint[c] = outboard.unwrap_or_else(|| joint[k] + alpha.cross(self.offsets[c]));
                joint[c].named(&format!("a_{name}"));
            }
            if let (None, Some(range)) = (element.parent, layout.reference_velocities(system)) {
                graph.section(reference.as_str());
                let mut acceleration = joint[0];
                if let Some(center) = self.center {
                    let offset = motion.systems[system][center].offset;
                    let centripetal = motion.element(id).centripetal(offset);
                    acceleration = acceleration - alpha.cross(offset) - centripetal;
                }
                for (&direction, row) in layout.directions.iter().zip(range) {
                    accelerations[row] = acceleration.0[direction] + field.0[direction];
                }
            }
            graph.section(format!("element {label}: angular acceleration"));
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
            for (row, rate) in layout.element_velocities(id).zip(rates) {
                accelerations[row] = rate;
            }
        }
    }

    /// a of the root of a floating system, from f = 0.
    fn floating(&self, root: &ArticulatedBody<'g>) -> Vec3<'g> {
        let graph = self.graph;
        let directions = self.layout.directions;
        let stiffness = |row: usize, column: usize| {
            let own = if row == column {
                root.mass
            } else {
                graph.constant(0.0)
            };
            own - root.resistance.entry(row, column)
        };
        let matrix = directions.iter().enumerate().map(|(i, &row)| {
            let columns = directions[..=i].iter();
            columns.map(|&column| stiffness(row, column)).collect()
        });
        let force = root.force - root.resistance.times(root.bias);
        let right = directions.iter().map(|&d| -force.0[d]).collect();
        let mut acceleration = Vec3::zero(graph);
        let solution = Ldl::of(graph, matrix.collect()).solve(right);
        for (&direction, a) in directions.iter().zip(solution) {
            acceleration.0[direction] = a;
        }
        acceleration
    }
}

impl<'g> Strategy<'g> {
    /// Returns α and, for a link only, a − β of its joint outboard. `joint` is a − β of the element's own joint.
    fn outwards(
        &self,
        graph: &'g Graph,
        dimension: Dimension,
        joint: Vec3<'g>,
    ) -> (Vec3<'g>, Option<Vec3<'g>>) {
        match self {
            Strategy::Absolute(absolute) => {
                let alpha = absolute.angular_acceleration(graph, dimension, joint);
                (alpha, None)
            }
            Strategy::Link(link) => {
                let (alpha, outboard) = link.angular_acceleration(joint);
                (alpha, Some(outboard))
            }
            Strategy::Tip(tip) => (tip.angular_acceleration(joint), None),
        }
    }
}

/// The child of a floating root whose joint gives the other children's offsets from it the most zero components.
fn center(graph: &Graph, elements: &[Element], children: &[usize]) -> Option<usize> {
    let at = |k: usize| vector(graph, &elements[k].at);
    let numbers = |&center: &usize| {
        let offsets = children.iter().map(|&c| at(c) - at(center));
        let components = offsets.flat_map(|offset| offset.0);
        components.filter(|component| !component.is_zero()).count()
    };
    children.iter().copied().min_by_key(numbers)
}

/// For each element: true if no force acts on it or on any element outboard of it.
fn idle(elements: &[Element], applied: &[Wrench<'_>]) -> Vec<bool> {
    let mut idle: Vec<bool> = applied.iter().map(Wrench::is_zero).collect();
    for (k, element) in elements.iter().enumerate().rev() {
        if let (Some(parent), false) = (element.parent, idle[k]) {
            idle[parent] = false;
        }
    }
    idle
}
