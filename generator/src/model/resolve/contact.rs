//! Contacts between an ellipsoid and a plane.

use super::hysteresis::Unloading;
use super::quantity::{ANGLE, FORCE, FRICTION, LENGTH, LINEAR_DAMPING, PURE, SPEED, STIFFNESS};
use super::{NOWHERE, Resolver};
use crate::description::force::{Contact as Written, EdgeRule as WrittenRule, Plane};
use crate::description::place::At;
use crate::description::quantity::{OneOrThree, Quantity};
use crate::diagnostic::quoted;
use crate::model::{Attachment, Bristle, Contact, EdgeRule, Extent, ForceKind, Number};

/// Sliding speed at which contact friction is fully there, where none is given \[m/s\].
const FRICTION_SPEED: f64 = 0.01;

/// Penetration at which damping is fully there, where none is given \[m\].
const DAMPING_DEPTH: f64 = 1e-3;

/// Width over which a force fades at an edge, where none is given \[m\].
const EDGE_WIDTH: f64 = 10e-3;

/// Largest degree of an ellipsoid: its corners then have a radius of a hundredth of its size.
const MAX_DEGREE: f64 = 100.0;

impl Resolver<'_> {
    /// Resolves a contact.
    pub fn contact(&mut self, written: &Written, at: At<'_>) -> Option<ForceKind> {
        let round = at.key("ellipsoid");
        let flat = at.key("plane");
        let ellipsoid = self
            .body(&written.ellipsoid.on, round.key("on"))
            .map(|on| Attachment {
                on,
                at: self.vector(&written.ellipsoid.center, round.key("center"), LENGTH),
            });
        let plane = self
            .body(&written.plane.on, flat.key("on"))
            .map(|on| Attachment {
                on,
                at: self.vector(&written.plane.at, flat.key("at"), LENGTH),
            });
        if let (Some(a), Some(b)) = (&ellipsoid, &plane)
            && a.on == b.on
        {
            self.problems.add(flat.key("on").problem(
                format!(
                    "the ellipsoid and the plane of contact {} are on the same body",
                    quoted(&written.contact)
                ),
                "put them on two bodies; `frame` is the absolute frame",
            ));
        }
        let before = self.problems.count();
        let semi_axes = self.vector(&written.ellipsoid.semi_axes, round.key("semi_axes"), LENGTH);
        if self.problems.count() == before {
            for index in 0..written.ellipsoid.semi_axes.len() {
                let number = &semi_axes[self.axis(index)];
                let value = number.value(&self.defaults);
                if value <= 0.0 {
                    self.problems
                        .add(round.key("semi_axes").item(index).problem(
                            format!(
                                "the semi-axis {value} m is not positive{}",
                                self.by_default(number)
                            ),
                            "give half the extent of the ellipsoid along this axis",
                        ));
                }
            }
        }
        let axes = match &written.ellipsoid.axes {
            Some(axes) => self.rotation(axes, round.key("axes"), ANGLE),
            None => NOWHERE,
        };
        let degree = self.degree(written.ellipsoid.degree.as_ref(), round.key("degree"));
        let normal = self.normal(&written.plane, flat.key("normal"));
        let tangent = self.tangent(&normal, &written.plane, flat);
        let owner = format!("contact {} elastic", written.contact);
        let elastic = written
            .elastic
            .as_ref()
            .and_then(|e| self.function(e, at.key("elastic"), &owner, LENGTH, FORCE));
        let hysteresis = self.hysteresis(
            elastic.as_ref(),
            Unloading {
                curve: written.unloading.as_ref(),
                slope: written.unloading_slope.as_ref(),
                loading: ("elastic", written.elastic.is_some()),
                at,
                owner: format!("contact {} unloading", written.contact),
                expected: [LENGTH, FORCE, STIFFNESS],
            },
        );
        let damping = self.coefficient(written.damping.as_ref(), at.key("damping"), LINEAR_DAMPING);
        let damping_depth = self.fade(
            (written.damping.as_ref(), damping.is_some()),
            (written.damping_depth.as_ref(), at.key("damping_depth")),
            (LENGTH, DAMPING_DEPTH),
        );
        let friction = self.friction(
            written.friction.as_ref(),
            written.friction_speed.as_ref(),
            at,
            (FRICTION, SPEED, FRICTION_SPEED),
        );
        let displacement_at = at.key("friction_displacement");
        if written.friction_displacement.is_some() && written.friction.is_none() {
            self.problems.add(displacement_at.key_problem(
                "a friction displacement means nothing without friction",
                "add `friction: …`, or remove `friction_displacement`",
            ));
        }
        let bristle = self
            .coefficient(
                written.friction_displacement.as_ref(),
                displacement_at,
                LENGTH,
            )
            .filter(|_| friction.is_some())
            .map(|displacement| Bristle { displacement });
        let extent = self.extent(&written.plane, flat);
        if let (Some(extent), Some(law)) = (&extent, &hysteresis)
            && matches!(extent.rule, EdgeRule::Fade(_))
            && law.unloading.is_some()
        {
            self.problems.add(flat.key("extent").key_problem(
                "an edge that fades must know the energy that unloading gives back, which of a curve `unloading` it does not",
                "write `edge: { rule: cut }`, or `unloading_slope` alone",
            ));
        }
        if let Some(Extent {
            rule: EdgeRule::Fade(_),
            ..
        }) = &extent
            && degree > 2
        {
            self.problems.add(flat.key("extent").key_problem(
                "the deepest point of an ellipsoid of higher degree leaps from corner to corner, and an edge cannot fade under it",
                "write `edge: { rule: cut }`, or leave `degree` out",
            ));
        }
        Some(ForceKind::Contact(Box::new(Contact {
            ellipsoid: ellipsoid?,
            semi_axes,
            axes,
            degree,
            plane: plane?,
            tangent,
            normal,
            extent,
            elastic,
            hysteresis,
            damping,
            damping_depth,
            friction,
            bristle,
        })))
    }

    /// The normal at unit length. Its components may be lengths or pure numbers, all that matters is their ratio.
    fn normal(&self, plane: &Plane, at: At<'_>) -> [Number; 3] {
        let before = self.problems.count();
        let vector = self.vector(&plane.normal, at, PURE);
        if self.problems.count() > before {
            return vector;
        }
        let length = vector
            .iter()
            .map(|n| n.value(&self.defaults).powi(2))
            .sum::<f64>()
            .sqrt();
        if length == 0.0 || !length.is_finite() {
            self.problems.add(at.problem(
                "the normal has no direction",
                "write a vector of any finite length that points to the side where the ellipsoid belongs, such as `[1, 0]`",
            ));
            return vector;
        }
        self.unit(vector)
    }

    /// The degree of an ellipsoid, 2 where none is given.
    fn degree(&self, written: Option<&Quantity>, at: At<'_>) -> u32 {
        let Some(quantity) = written else { return 2 };
        let (number, value) = self.valued(quantity, at, PURE);
        let Some(value) = value else { return 2 };
        let even = value % 2.0 == 0.0 && (2.0..=MAX_DEGREE).contains(&value);
        if number.constant().is_none() {
            self.problems.add(at.problem(
                "the degree depends on a parameter",
                "give a number: it decides which code is generated",
            ));
        } else if !even {
            self.problems.add(at.problem(
                format!("the degree of an ellipsoid is {value}"),
                format!("give an even number from 2, the ellipsoid itself, to {MAX_DEGREE}, nearly a box"),
            ));
        } else {
            return value as u32;
        }
        2
    }

    /// A vector at unit length.
    fn unit(&self, vector: [Number; 3]) -> [Number; 3] {
        let length = if vector.iter().all(|n| n.constant().is_some()) {
            let squares = vector.iter().map(|n| n.value(&self.defaults).powi(2));
            Number::Constant(squares.sum::<f64>().sqrt())
        } else {
            let squares = vector.iter().map(|n| Number::product(n.clone(), n.clone()));
            Number::square_root(squares.fold(Number::ZERO, Number::sum))
        };
        vector.map(|n| Number::quotient(n, length.clone()))
    }

    /// In space, the direction `along`, or the one in the plane that is nearest to an axis.
    fn tangent(&self, normal: &[Number; 3], plane: &Plane, at: At<'_>) -> [Number; 3] {
        let place = at.key("along");
        if self.planar {
            if plane.along.is_some() {
                self.problems.add(place.key_problem(
                    "in the plane x–z a contact plane is a line and has one direction",
                    "remove `along`",
                ));
            }
            return NOWHERE;
        }
        let before = self.problems.count();
        let along = match &plane.along {
            Some(along) => self.vector(along, place, PURE),
            None => {
                let size = |axis: &usize| normal[*axis].value(&self.defaults).abs();
                let across = (0..3).min_by(|a, b| size(a).total_cmp(&size(b)));
                let mut axis = NOWHERE;
                axis[across.unwrap_or_default()] = Number::Constant(1.0);
                axis
            }
        };
        if self.problems.count() > before {
            return NOWHERE;
        }
        // a − (a·n) n
        let products = (0..3).map(|i| Number::product(along[i].clone(), normal[i].clone()));
        let part = products.fold(Number::ZERO, Number::sum);
        let tangent: [Number; 3] = std::array::from_fn(|i| {
            let normal = Number::product(part.clone(), normal[i].clone());
            Number::difference(along[i].clone(), normal)
        });
        let squared = |vector: &[Number; 3]| -> f64 {
            vector.iter().map(|n| n.value(&self.defaults).powi(2)).sum()
        };
        let length = squared(&along);
        let straight = length > 0.0 && length.is_finite();
        // an angle of a millionth of a radian between them is meant as none
        if straight && squared(&tangent) > 1e-12 * length {
            return self.unit(tangent);
        }
        // a normal without direction has been reported
        if plane.along.is_some() && squared(normal) > 0.5 {
            self.problems.add(place.problem(
                "this is no direction along the plane",
                "write a vector of any finite length that is not parallel to `normal`, such as `[1, 0, 0]`",
            ));
        }
        NOWHERE
    }

    /// Where a plane ends.
    fn extent(&self, plane: &Plane, at: At<'_>) -> Option<Extent> {
        let (extent_at, edge_at) = (at.key("extent"), at.key("edge"));
        let Some(written) = &plane.extent else {
            if plane.edge.is_some() {
                self.problems.add(edge_at.key_problem(
                    "a plane without `extent` has no edge",
                    "add `extent: …`, half the length of the plane, or remove `edge`",
                ));
            }
            return None;
        };
        let right = if self.planar { 1 } else { 2 };
        let lengths: Vec<(&Quantity, At<'_>)> = match written {
            OneOrThree::One(one) => vec![(one, extent_at)],
            OneOrThree::List(list) => list
                .iter()
                .enumerate()
                .map(|(i, length)| (length, extent_at.item(i)))
                .collect(),
        };
        if lengths.len() != right || (self.planar && matches!(written, OneOrThree::List(_))) {
            self.problems.add(if self.planar {
                extent_at.problem(
                    "in the plane x–z a contact plane is a line with one length",
                    "give half of it, without brackets",
                )
            } else {
                extent_at.problem(
                    "a plane in space has two lengths",
                    "write `[a, b]`: half its length along the first tangent and along the second",
                )
            });
            return None;
        }
        let before = self.problems.count();
        let mut smallest = f64::INFINITY;
        let half_lengths: Vec<Number> = lengths
            .into_iter()
            .map(|(length, place)| {
                let (number, value) = self.valued(length, place, LENGTH);
                if let Some(value) = value {
                    smallest = smallest.min(value);
                    if value <= 0.0 {
                        self.problems.add(place.problem(
                            format!("the half-length is {value} m{}", self.by_default(&number)),
                            "give a positive length, from the point of the plane to its edge",
                        ));
                    }
                }
                number
            })
            .collect();
        let (rule, width) = match &plane.edge {
            Some(edge) => (edge.rule, edge.width.as_ref()),
            None => (None, None),
        };
        let width_at = edge_at.key("width");
        let rule = match (rule, width) {
            (Some(WrittenRule::Cut), Some(_)) => {
                self.problems.add(width_at.key_problem(
                    "an edge that cuts has no width",
                    "remove `width`, or write `rule: fade`",
                ));
                EdgeRule::Cut
            }
            (Some(WrittenRule::Cut), None) => EdgeRule::Cut,
            (_, None) => EdgeRule::Fade(Number::Constant(EDGE_WIDTH.min(smallest))),
            (_, Some(width)) => match self.coefficient(Some(width), width_at, LENGTH) {
                Some(number) => {
                    let value = number.value(&self.defaults);
                    if value > smallest {
                        self.problems.add(width_at.problem(
                            format!(
                                "the edge is wider than the plane: {value} m of {smallest} m{}",
                                self.by_default(&number)
                            ),
                            "the force fades inside the edge: give at most the shorter half-length",
                        ));
                    }
                    EdgeRule::Fade(number)
                }
                None => EdgeRule::Cut,
            },
        };
        (self.problems.count() == before).then_some(Extent { half_lengths, rule })
    }
}
