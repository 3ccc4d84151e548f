//! Contacts between an ellipsoid and a plane.

use super::hysteresis::Unloading;
use super::quantity::{ANGLE, FORCE, FRICTION, LENGTH, LINEAR_DAMPING, PURE, SPEED, STIFFNESS};
use super::{NOWHERE, Resolver};
use crate::description::force::{Contact as Written, Plane};
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::{Attachment, Bristle, Contact, ForceKind, Number};

/// Sliding speed at which contact friction is fully there, where none is given \[m/s\].
const FRICTION_SPEED: f64 = 0.01;

/// Penetration at which damping is fully there, where none is given \[m\].
const DAMPING_DEPTH: f64 = 1e-3;

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
        let normal = self.normal(&written.plane, flat.key("normal"));
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
        Some(ForceKind::Contact(Box::new(Contact {
            ellipsoid: ellipsoid?,
            semi_axes,
            axes,
            plane: plane?,
            tangent: self.tangent(&normal),
            normal,
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

    /// In space, the direction in a plane that is nearest to the axis which the plane is nearest to.
    fn tangent(&self, normal: &[Number; 3]) -> [Number; 3] {
        if self.planar {
            return NOWHERE;
        }
        let size = |axis: &usize| normal[*axis].value(&self.defaults).abs();
        let across = (0..3).min_by(|a, b| size(a).total_cmp(&size(b)));
        let across = across.unwrap_or_default();
        let [x, y, z] = normal
            .clone()
            .map(|n| Number::negative(Number::product(normal[across].clone(), n)));
        let mut tangent = [x, y, z];
        tangent[across] = Number::sum(Number::Constant(1.0), tangent[across].clone());
        self.unit(tangent)
    }
}
