//! How bodies and wrenches are passed from a link to its parent.
//!
//! A wrench is about the origin of its link and in the axes of the link; for a link on a ball it is in absolute axes,
//! because the velocities of the ball are. A joint with an axis passes the whole wrench, a ball only the force.

use super::body::Body;
use super::frames::{Choice, Framed};
use super::motion::{LinkMotion, slide};
use super::tree::{LinkJoint, Tree};
use super::turn::through;
use crate::dynamics::spatial::Wrench;
use crate::expression::Expr;
use crate::expression::vector::Vec3;

/// A tree, its frames, and the choice of the frames.
#[derive(Clone, Copy)]
pub struct Written<'g, 'a> {
    pub tree: &'a Tree<'g>,
    pub framed: &'a Framed<'g>,
    pub choice: &'a Choice,
}

/// A wrench on a link that comes from one of its children.
#[derive(Clone, Copy)]
pub enum Arrived<'g> {
    /// In the axes of the link.
    InLink(Wrench<'g>),
    /// In absolute axes.
    Absolute(Wrench<'g>),
}

impl<'g> Arrived<'g> {
    /// The wrench without change of its axes.
    pub fn as_it_is(self) -> Wrench<'g> {
        match self {
            Arrived::InLink(wrench) | Arrived::Absolute(wrench) => wrench,
        }
    }
}

impl<'g> Written<'g, '_> {
    /// True if a link is on a ball.
    pub fn is_ball(&self, k: usize) -> bool {
        self.tree.links[k].joint.is_ball()
    }

    /// The wrench that the parent of a link feels from a wrench on the link.
    pub fn on_parent(&self, k: usize, parent: usize, wrench: Wrench<'g>) -> Arrived<'g> {
        let frame = &self.framed.links[k];
        let of = |force: Vec3<'g>, moment: Vec3<'g>, place: Vec3<'g>| Wrench {
            force,
            moment: moment + place.cross(force),
        };
        let none = Vec3::zero(self.tree.graph);
        match (&self.tree.links[k].joint, self.is_ball(parent)) {
            (LinkJoint::Ball { .. }, true) => {
                let place = self.framed.links[parent].axes.times(frame.place);
                Arrived::Absolute(of(wrench.force, none, place))
            }
            (LinkJoint::Ball { .. }, false) => {
                let axes = &self.framed.links[parent].axes;
                let force = axes.transposed_times(wrench.force);
                Arrived::InLink(of(force, none, frame.place))
            }
            (LinkJoint::Axis { absolute: true, .. }, _) => {
                let force = through(&frame.turns, wrench.force);
                Arrived::InLink(of(force, none, frame.place))
            }
            (LinkJoint::Axis { .. }, _) => {
                let mut moment = wrench.moment;
                if let Some(along) = self.along(k) {
                    moment = moment + along.cross(wrench.force);
                }
                let force = through(&frame.turns, wrench.force);
                let moment = through(&frame.turns, moment);
                Arrived::InLink(of(force, moment, frame.place))
            }
        }
    }

    /// The wrench in the axes that its link uses: absolute axes on a ball, otherwise the link's axes.
    pub fn settled(&self, k: usize, arrived: Arrived<'g>) -> Wrench<'g> {
        match arrived {
            Arrived::InLink(wrench) if self.is_ball(k) => self.absolute(k, wrench),
            Arrived::InLink(wrench) | Arrived::Absolute(wrench) => wrench,
        }
    }

    /// A wrench in absolute axes.
    pub fn absolute(&self, k: usize, wrench: Wrench<'g>) -> Wrench<'g> {
        let axes = &self.framed.links[k].axes;
        Wrench {
            force: axes.times(wrench.force),
            moment: axes.times(wrench.moment),
        }
    }

    /// The body of a link as a part of its parent, in the parent's axes about the parent's origin.
    pub fn body_on_parent(&self, k: usize, body: Body<'g>) -> Body<'g> {
        let frame = &self.framed.links[k];
        let graph = self.tree.graph;
        let body = match (&self.tree.links[k].joint, self.along(k)) {
            (joint, _) if joint.is_absolute() => Body {
                mass: body.mass,
                ..Body::none(graph)
            },
            (_, None) => body.turned(&frame.turns),
            (_, Some(along)) => body.moved(along).turned(&frame.turns),
        };
        body.moved(frame.place)
    }

    /// The displacement of a link along z, if it slides.
    pub fn along(&self, k: usize) -> Option<Vec3<'g>> {
        let sign = self.framed.links[k].sign;
        let (d, _) = slide(&self.tree.links[k].joint, self.choice.unit, sign)?;
        let mut along = Vec3::zero(self.tree.graph);
        along.0[2] = d;
        Some(along)
    }

    /// The power of a wrench on a link per velocity of its joint, by row.
    pub fn powers(&self, k: usize, wrench: &Wrench<'g>) -> Vec<(usize, Expr<'g>)> {
        let link = &self.tree.links[k];
        match &link.joint {
            LinkJoint::Ball { columns, .. } => (0..3)
                .map(|j| (link.row + j, columns.column(j).dot(wrench.moment)))
                .collect(),
            LinkJoint::Axis { turn, slide, .. } => {
                let slide = (1.0 / self.choice.unit) * *slide;
                let power = slide * wrench.force.0[2] + *turn * wrench.moment.0[2];
                vec![(link.row, self.share(k) * power)]
            }
        }
    }

    /// The acceleration of the coordinate of a link in the reference motion; 0 for a ball and for a coupled coordinate.
    pub fn reference(&self, k: usize, motion: &LinkMotion<'g>) -> Expr<'g> {
        let joint = &self.tree.links[k].joint;
        // for a slider, the coordinate is a length
        let unit = if joint.slides_alone() {
            self.choice.unit
        } else {
            1.0
        };
        (unit * self.framed.links[k].sign) * motion.reference
    }

    /// The power of a wrench on the first link per velocity of a free base, by row.
    pub fn on_base(&self, wrench: &Wrench<'g>) -> Vec<(usize, Expr<'g>)> {
        let Some(base) = self.tree.base else {
            return Vec::new();
        };
        let force = match self.is_ball(0) {
            true => wrench.force,
            false => self.framed.links[0].axes.times(wrench.force),
        };
        let force = (1.0 / self.choice.unit) * force;
        let directions = self.tree.directions.iter().enumerate();
        directions.map(|(i, &d)| (base + i, force.0[d])).collect()
    }

    /// The velocity of a link about or along its z axis, as a share of the velocity in its row.
    pub fn share(&self, k: usize) -> Expr<'g> {
        match self.tree.links[k].joint {
            LinkJoint::Axis { ratio, .. } => self.framed.links[k].sign * ratio,
            LinkJoint::Ball { .. } => self.tree.graph.constant(1.0),
        }
    }

    /// The same share, for a slider in the unit of length of the choice.
    pub fn scaled_share(&self, k: usize) -> Expr<'g> {
        match self.tree.links[k].joint.slides_alone() {
            true => (1.0 / self.choice.unit) * self.share(k),
            false => self.share(k),
        }
    }
}
