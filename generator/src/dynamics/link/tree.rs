//! The links of a system: one for every freedom of an element's joint, and none for a weld.
//!
//! All quantities are in the axes of the elements, about their origins. The axes along a joint are taken in its zero
//! position, where the axes of its links are parallel.

use super::articulated_inertia::Articulated;
use super::body::Body;
use crate::dynamics::augmented_body::own_inertia;
use crate::dynamics::spatial::{Spatial, Wrench};
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph};
use crate::force::AppliedForces;
use crate::model::Joint;
use crate::model::{Dimension, Reference};
use crate::motion::kinematics::reference_acceleration;
use crate::motion::numbers::{number, vector};
use crate::motion::twist::turn_and_advance;

/// A system as links; parents come first.
pub struct Tree<'g> {
    pub graph: &'g Graph,
    pub links: Vec<Link<'g>>,
    /// The carrier of the first link.
    pub ground: Ground<'g>,
    /// True if the reference joint is free; then the first element is on a ball (in the plane, a hinge with an absolute
    /// angle).
    pub free: bool,
    /// Index in v of the first velocity of a free reference joint.
    pub base: Option<usize>,
    /// The absolute axes along which a free reference joint moves.
    pub directions: &'static [usize],
    /// ω, α⁰ and a⁰ of the first link, if this tree is a part of a larger one and its first link stands for the carrier
    /// of the part.
    pub carrier: Option<[Vec3<'g>; 3]>,
}

/// The carrier of the first link: the vehicle that carries the reference joint, if the first joint is no ball;
/// otherwise the absolute frame.
#[derive(Clone, Copy)]
pub struct Ground<'g> {
    /// Rotation from its axes to absolute axes.
    pub axes: Mat3<'g>,
    /// Angular velocity ω, in its axes.
    pub omega: Vec3<'g>,
    /// Angular acceleration α, in its axes.
    pub alpha: Vec3<'g>,
    /// Acceleration of the reference joint minus the field common to all elements, in the ground's axes; 0 for a free
    /// reference joint unless accelerations are given.
    pub acceleration: Vec3<'g>,
    /// φ in the plane, 0 in space.
    pub angle: Expr<'g>,
}

/// One link.
#[derive(Clone)]
pub struct Link<'g> {
    /// Index of the link's element.
    pub element: usize,
    /// Index in v of the first velocity of its joint.
    pub row: usize,
    /// Index of the link that carries it.
    pub parent: Option<usize>,
    pub joint: LinkJoint<'g>,
    /// The position of its joint from the parent's origin, in the parent's axes.
    pub place: Vec3<'g>,
    pub body: Body<'g>,
    /// A, the rotation from its axes to absolute axes.
    pub rotation: Mat3<'g>,
    /// The wrench that acts on the link, in absolute axes.
    pub load: Wrench<'g>,
    /// Quantities that replace the links that it carries, if these are left out of this tree.
    pub carries: Option<Carried<'g>>,
}

/// Quantities that omitted links pass on to their carrier.
#[derive(Clone)]
pub enum Carried<'g> {
    /// For accelerations: their articulated inertia.
    Articulated(Articulated<'g>),
    /// For S and for forces.
    Composite {
        /// Their composite bodies.
        body: Body<'g>,
        /// The wrench that the omitted links need.
        needed: Wrench<'g>,
        /// The wrenches that the omitted links need for each of their velocities.
        columns: Vec<Wrench<'g>>,
    },
}

/// The joint between a link and its parent.
#[derive(Clone)]
pub enum LinkJoint<'g> {
    /// A ball: it turns freely. All quantities are in absolute axes.
    Ball {
        /// ω
        omega: Vec3<'g>,
        /// ε, the angular acceleration when v̇ = 0
        bias: Vec3<'g>,
        /// The axes about which its velocities turn it, as columns: ω = Σ e_j v_j
        columns: Mat3<'g>,
    },
    /// An axis: a unit of the coordinate turns the link by `turn` about the axis, and slides it by `slide` along the
    /// axis.
    Axis {
        axis: [f64; 3],
        turn: f64,
        slide: Expr<'g>,
        position: Expr<'g>,
        rate: Expr<'g>,
        /// The generalised force of laws on the coordinate.
        acting: Expr<'g>,
        /// The ratio of the joint's velocity to the velocity in its row.
        ratio: Expr<'g>,
        /// The inertia that only this velocity moves.
        armature: Expr<'g>,
        /// The acceleration of the joint beside that of the reference motion; 0 unless accelerations are
        /// [given](Tree::accelerated).
        acceleration: Expr<'g>,
        /// True if other links share the same row.
        coupled: bool,
        /// True for a hinge in the plane whose angle is absolute, so that the turning of its carrier does not turn it.
        absolute: bool,
    },
}

impl LinkJoint<'_> {
    /// True for a ball joint.
    pub fn is_ball(&self) -> bool {
        matches!(self, LinkJoint::Ball { .. })
    }

    /// True if the joint's velocities are relative to the absolute frame, so that the link does not turn with its
    /// carrier.
    pub fn is_absolute(&self) -> bool {
        self.is_ball() || matches!(self, LinkJoint::Axis { absolute: true, .. })
    }

    /// True if other links have a share of the joint's velocity.
    pub fn is_coupled(&self) -> bool {
        matches!(self, LinkJoint::Axis { coupled: true, .. })
    }

    /// True for a slider, which does not turn.
    pub fn slides_alone(&self) -> bool {
        matches!(self, LinkJoint::Axis { turn: 0.0, .. })
    }

    /// True for a hinge, which does not slide.
    pub fn is_hinge(&self) -> bool {
        matches!(self, LinkJoint::Axis { turn, slide, .. } if *turn != 0.0 && slide.is_zero())
    }
}

/// The joints of the links of an element, from the carrier outwards, each with the row of its velocity. `None` if an
/// axis depends on parameters.
fn joints<'g>(
    spatial: &Spatial<'g, '_>,
    applied: Option<&AppliedForces<'g>>,
    k: usize,
) -> Option<Vec<(usize, LinkJoint<'g>)>> {
    let (graph, model, motion) = (spatial.graph, spatial.model, spatial.motion_of(k));
    let shares = spatial.layout.shares(graph, model, spatial.id(k));
    let acting = applied.map(|applied| &applied.wrenches.on_freedoms[spatial.system][k][..]);
    let acting = acting.unwrap_or_default();
    let freedoms = match &spatial.of_system().elements[k].joint {
        Joint::Ball if model.dimension == Dimension::Plane => {
            let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
            let joint = LinkJoint::Axis {
                axis: [0.0, 1.0, 0.0],
                turn: 1.0,
                slide: zero,
                position: motion.angle,
                rate: motion.omega.0[1],
                acting: zero,
                ratio: one,
                armature: zero,
                acceleration: zero,
                coupled: false,
                absolute: true,
            };
            return Some(vec![(shares[0].velocity, joint)]);
        }
        Joint::Ball => {
            let columns = [0, 1, 2].map(|j| motion.axes[j]);
            let joint = LinkJoint::Ball {
                omega: motion.omega,
                bias: motion.bias,
                columns: Mat3::from_columns(columns),
            };
            return Some(vec![(shares[0].velocity, joint)]);
        }
        Joint::Freedoms(freedoms) => freedoms,
    };
    let mut joints = Vec::new();
    for (i, freedom) in freedoms.iter().enumerate() {
        let axis = vector(graph, &freedom.axis).0.map(|a| a.as_constant());
        let [Some(x), Some(y), Some(z)] = axis else {
            return None;
        };
        let (q, rate) = motion.freedoms[i];
        let (turn, slide) = turn_and_advance(graph, &freedom.kind);
        let joint = LinkJoint::Axis {
            axis: [x, y, z],
            turn,
            slide,
            position: q + number(graph, &freedom.zero),
            rate,
            acting: acting.get(i).copied().unwrap_or(graph.constant(0.0)),
            ratio: shares[i].ratio,
            armature: number(graph, &freedom.armature),
            acceleration: graph.constant(0.0),
            coupled: false,
            absolute: false,
        };
        joints.push((shares[i].velocity, joint));
    }
    Some(joints)
}

impl<'g> Tree<'g> {
    /// The links of a system, with the wrenches on them. Without `applied` no force acts, and the reference joint does
    /// not accelerate. `None` if link frames cannot be used: an axis depends on parameters; the reference joint is free
    /// but the first element is not on a ball; or a gyroscopic moment is left out.
    pub fn of(spatial: &Spatial<'g, '_>, applied: Option<&AppliedForces<'g>>) -> Option<Self> {
        let (graph, system) = (spatial.graph, spatial.of_system());
        let free = matches!(system.reference, Reference::Free);
        let first_is_ball = system.elements.first()?.joint == Joint::Ball;
        let complete = spatial.tree.bodies.iter().all(|body| body.gyroscopic);
        if (free && !first_is_ball) || !complete {
            return None;
        }
        graph.section(format!("system {}: links", system.name));
        let none = Vec3::zero(graph);
        let mut links: Vec<Link<'g>> = Vec::new();
        // for every element, its link and the origin of the element from that of the link
        let mut seats: Vec<(Option<usize>, Vec3<'g>)> = Vec::new();
        for (k, element) in system.elements.iter().enumerate() {
            let motion = spatial.motion_of(k);
            let (mut parent, carried_at) = match element.parent {
                Some(parent) => seats[parent],
                None => (None, none),
            };
            let mut place = match element.parent {
                Some(_) => carried_at + vector(graph, &element.at),
                None => carried_at,
            };
            for (row, joint) in joints(spatial, applied, k)? {
                links.push(Link {
                    element: k,
                    row,
                    parent,
                    joint,
                    place,
                    body: Body::none(graph),
                    rotation: motion.rotation,
                    load: Wrench::none(graph),
                    carries: None,
                });
                (parent, place) = (Some(links.len() - 1), none);
            }
            seats.push((parent, place));
            let Some(to) = parent else { continue };
            let to = &mut links[to];
            to.body = to.body.plus(&body_of(spatial, k).moved(place));
            let Some(applied) = applied else { continue };
            let load = &applied.wrenches.elements[spatial.system][k];
            let offset = to.rotation.times(place);
            to.load = to.load.plus(Wrench {
                force: load.force,
                moment: load.moment + offset.cross(load.force),
            });
        }
        couple(&mut links);
        let mut tree = Tree {
            graph,
            links,
            ground: Ground::of(spatial, applied, first_is_ball),
            free,
            base: spatial
                .layout
                .reference_velocities(spatial.system)
                .map(|rows| rows.start),
            directions: spatial.layout.directions,
            carrier: None,
        };
        tree.regroup();
        Some(tree)
    }

    /// The tree whose joints accelerate: with these v̇, and a free base against this field, in the reference motion of
    /// v̇ = 0.
    pub fn accelerated(mut self, given: &[Expr<'g>], field: Vec3<'g>) -> Self {
        for link in &mut self.links {
            match &mut link.joint {
                LinkJoint::Ball { bias, columns, .. } => {
                    let own = [0, 1, 2].map(|i| given[link.row + i]);
                    *bias = *bias + columns.times(Vec3(own));
                }
                LinkJoint::Axis {
                    acceleration,
                    ratio,
                    ..
                } => *acceleration = *ratio * given[link.row],
            }
        }
        if let Some(base) = self.base {
            self.ground.acceleration = -field;
            for (i, &direction) in self.directions.iter().enumerate() {
                let along = &mut self.ground.acceleration.0[direction];
                *along = *along + given[base + i];
            }
        }
        self
    }

    /// True if any quantity is in absolute axes: a force on a link, a ball other than that of a free first link, or, in
    /// the plane, a free first link.
    pub fn needs_axes(&self) -> bool {
        self.links.iter().enumerate().any(|(k, link)| {
            let of = |v: &Vec3<'g>| v.0.iter().any(|e| !e.is_zero());
            let is_first = k == 0 && self.free;
            of(&link.load.force) || of(&link.load.moment) || link.joint.is_ball() != is_first
        })
    }

    /// The generalised forces that laws apply on coordinates, by row.
    pub fn on_coordinates(&self) -> Vec<(usize, Expr<'g>)> {
        let of = |link: &Link<'g>| match link.joint {
            LinkJoint::Axis { acting, ratio, .. } => Some((link.row, ratio * acting)),
            LinkJoint::Ball { .. } => None,
        };
        self.links.iter().filter_map(of).collect()
    }

    /// The same links, with each expression replaced.
    pub fn map<'h>(&self, graph: &'h Graph, mut of: impl FnMut(Expr<'g>) -> Expr<'h>) -> Tree<'h> {
        let links = self.links.iter().map(|link| Link {
            element: link.element,
            row: link.row,
            parent: link.parent,
            joint: match link.joint {
                LinkJoint::Ball {
                    omega,
                    bias,
                    columns,
                } => LinkJoint::Ball {
                    omega: Vec3(omega.0.map(&mut of)),
                    bias: Vec3(bias.0.map(&mut of)),
                    columns: Mat3(columns.0.map(|row| row.map(&mut of))),
                },
                LinkJoint::Axis {
                    axis,
                    turn,
                    slide,
                    position,
                    rate,
                    acting,
                    ratio,
                    armature,
                    acceleration,
                    coupled,
                    absolute,
                } => LinkJoint::Axis {
                    axis,
                    turn,
                    slide: of(slide),
                    position: of(position),
                    rate: of(rate),
                    acting: of(acting),
                    ratio: of(ratio),
                    armature: of(armature),
                    acceleration: of(acceleration),
                    coupled,
                    absolute,
                },
            },
            place: Vec3(link.place.0.map(&mut of)),
            body: Body {
                mass: of(link.body.mass),
                first: Vec3(link.body.first.0.map(&mut of)),
                second: Sym3 {
                    diagonal: link.body.second.diagonal.map(&mut of),
                    off: link.body.second.off.map(&mut of),
                },
                sizes: link.body.sizes,
            },
            rotation: Mat3(link.rotation.0.map(|row| row.map(&mut of))),
            load: Wrench {
                force: Vec3(link.load.force.0.map(&mut of)),
                moment: Vec3(link.load.moment.0.map(&mut of)),
            },
            carries: None,
        });
        Tree {
            graph,
            links: links.collect(),
            ground: self.ground.map(&mut of),
            free: self.free,
            base: self.base,
            directions: self.directions,
            carrier: None,
        }
    }

    /// Regroups bodies: moves the part of each body that its joint does not feel to the parent of the link, because
    /// that part moves with the parent in any case.
    ///
    /// A hinge does not feel the mass on its axis e: m, (h · e) e and (e · Σ e) e eᵀ. A slider does not feel Σ, and a
    /// ball does not feel m. The motion of the system is the same with regrouped bodies. A single regrouped body has no
    /// physical meaning, and its mass may be negative.
    fn regroup(&mut self) {
        for k in (0..self.links.len()).rev() {
            let link = &self.links[k];
            if link.parent.is_none() && self.free {
                continue;
            }
            let passed = link.body.not_resisting(&link.joint);
            let (parent, place) = (link.parent, link.place);
            let moved = match link.joint.slides_alone() {
                // Σ without mass and first moment is the same about every origin
                true => passed,
                false => passed.moved(place),
            };
            self.links[k].body = self.links[k].body.minus(&passed);
            if let Some(parent) = parent {
                self.links[parent].body = self.links[parent].body.plus(&moved);
            }
        }
    }
}

impl<'g> Ground<'g> {
    /// The ground of a system. Without `applied`, the reference joint does not accelerate, but a vehicle still turns
    /// the ground.
    fn of(
        spatial: &Spatial<'g, '_>,
        applied: Option<&AppliedForces<'g>>,
        first_is_ball: bool,
    ) -> Self {
        let (graph, system) = (spatial.graph, spatial.of_system());
        let none = Vec3::zero(graph);
        let acceleration = match (&system.reference, applied) {
            (Reference::Free, _) | (_, None) => none,
            (_, Some(applied)) => {
                reference_acceleration(graph, system, spatial.motion)
                    - applied.wrenches.fields[spatial.system]
            }
        };
        let (axes, omega, alpha, angle) = match (&system.reference, first_is_ball) {
            (Reference::Riding { vehicle, .. }, false) => {
                let body = &spatial.motion.vehicles[*vehicle].body;
                (body.rotation, body.omega, body.bias, body.angle)
            }
            _ => (identity(graph), none, none, graph.constant(0.0)),
        };
        let own = |v: Vec3<'g>| axes.transposed_times(v);
        Ground {
            axes,
            omega: own(omega),
            alpha: own(alpha),
            acceleration: own(acceleration),
            angle,
        }
    }

    /// The same ground, with each expression replaced.
    pub fn map<'h>(&self, mut of: impl FnMut(Expr<'g>) -> Expr<'h>) -> Ground<'h> {
        let angle = of(self.angle);
        let mut vector = |v: Vec3<'g>| Vec3(v.0.map(&mut of));
        Ground {
            angle,
            acceleration: vector(self.acceleration),
            axes: Mat3(self.axes.0.map(|row| vector(Vec3(row)).0)),
            omega: vector(self.omega),
            alpha: vector(self.alpha),
        }
    }
}

/// The axes of the absolute frame.
pub fn identity(graph: &Graph) -> Mat3<'_> {
    Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| graph.constant(f64::from(i == j)))))
}

/// Marks the links that share a row.
fn couple(links: &mut [Link<'_>]) {
    let rows: Vec<usize> = links.iter().map(|link| link.row).collect();
    for link in links {
        if let LinkJoint::Axis { coupled, .. } = &mut link.joint {
            *coupled = rows.iter().filter(|&&row| row == link.row).count() > 1;
        }
    }
}

/// The body of an element about its origin.
fn body_of<'g>(spatial: &Spatial<'g, '_>, k: usize) -> Body<'g> {
    let graph = spatial.graph;
    let element = &spatial.of_system().elements[k];
    let (mass, c) = (number(graph, &element.mass), vector(graph, &element.cg));
    let inertia = own_inertia(graph, Dimension::Space, element);
    let [x, y, z] = inertia.diagonal;
    let half = 0.5 * (x + y + z);
    // Σ = ½ tr I · 1 − I about the centre of mass
    let about_center = Body {
        mass,
        first: Vec3::zero(graph),
        second: Sym3::from_fn(|i, j| match i == j {
            true => half - inertia.diagonal[i],
            false => -inertia.entry(i, j),
        }),
        sizes: [0.0; 2],
    };
    about_center.moved(c)
}
