//! The keys of a contact.

use super::check::{self, Against, Degree, OtherSurface};
use crate::description::curve::FunctionOf;
use crate::description::force::Acting;
use crate::description::measure::{
    Coefficient as FrictionCoefficient, Force, Length, LinearDamping, NotNegative, Positive, Speed,
    Stiffness,
};
use crate::description::quantity::Number;
use crate::description::shape::Flat;
use crate::description::short_forms::ByName;
use crate::description::surface::{Edge, Ellipsoid as WrittenEllipsoid, Plane};
use crate::model::Ellipsoid;
use crate::model::declared::{
    Coefficient, CoulombFriction, DeclaredLaw, Elastic, Fade, FrictionBristle, HysteresisOf,
    Reader, Written, declare,
};
use crate::model::resolve::NOWHERE;
use crate::model::resolve::law::{TitledKeys, record};

/// The keys of a contact.
pub type ContactKeys = Written<Contact>;

declare! {
    /// Contact of an ellipsoid with a plane or another ellipsoid.
    Contact as "a contact" only written {
        /// name, unique among the contacts
        contact: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    } and kept {
        /// the [ellipsoid](#an-ellipsoid), or [names](#named-surfaces) of such
        ellipsoid: Ellipsoid,
        /// Exponent n of the surface Σ |x_i/a_i|ⁿ = 1, even: 2 is an ellipsoid, larger numbers are rounded boxes.
        degree: Degree,
        /// The plane or ellipsoid that the ellipsoid meets, on another body.
        against: OtherSurface {
            /// the [plane](#a-plane) that it meets, on another body, or names of such
            plane: Option<ByName<Plane>>,
            /// instead of `plane`: the other [ellipsoid](#an-ellipsoid), on another body, or names of such; one of the
            /// two keys must be given
            with: Option<ByName<WrittenEllipsoid>>,
        },
        /// curve of the perpendicular penetration
        elastic: Elastic<Length, Force, Stiffness> {
            /// instead of `elastic`: force per penetration, [a straight curve](#a-stiffness)
            stiffness: Option<Number<NotNegative<Stiffness>>>,
        },
        /// A different curve for unloading, against the penetration.
        hysteresis: HysteresisOf<Length, Force, Stiffness> {
            /// curve of the force during unloading, nowhere above `elastic`; see [hysteresis](#hysteresis)
            unloading: Option<FunctionOf<Length, Force>>,
            /// slope of the line between the two curves
            unloading_slope: Option<Number<NotNegative<Stiffness>>> = "ten times the steepest slope of `elastic`",
        } as "hysteresis" needs "there is no elastic force",
        /// viscous coefficient on the rate of penetration
        damping: Coefficient<NotNegative<LinearDamping>> = "0",
        /// damping grows in proportion to the penetration up to this one, so that no force jumps at touch; 0: it acts
        /// in full at once
        damping_depth: Fade<Length> as "damping fades in" needs "there is no damping" = "1 mm",
        /// coefficient of Coulomb friction on the normal force
        friction: CoulombFriction<FrictionCoefficient, Speed> {
            /// friction grows in proportion to the sliding speed up to this one, and is constant beyond
            friction_speed: Option<Number<Positive<Speed>>> = "0.01",
        } as "friction" needs "nothing presses" = "0",
        /// The bristle by which friction holds; without one, friction only resists motion.
        bristle: FrictionBristle<Length> {
            /// friction that holds: it grows with the displacement up to this one; see [friction](#friction)
            friction_displacement: Option<Number<NotNegative<Length>>>,
        } as "friction holds" needs "there is no friction",
    }
}

impl DeclaredLaw for Contact {
    const KEY: &'static str = "contact";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["ellipsoid", "with"]);
    const RECORDS: &'static [fn() -> TitledKeys] =
        &[record::<WrittenEllipsoid>, record::<Plane>, record::<Edge>];

    fn check_keys(name: &str, reader: &Reader<'_, '_, '_>) {
        check::check_surfaces(name, reader);
    }

    fn check(mut self, name: &str, reader: &mut Reader<'_, '_, '_>) -> Option<Self> {
        if self.damping.is_none() {
            self.damping_depth = None;
        }
        if self.friction.is_none() {
            self.bristle = None;
        }
        check::check_bodies(reader, name, &self);
        check::fade_over_depth(reader, &mut self);
        check::check_fading_edge(reader, &self);
        if let Against::Plane(plane) = &mut self.against
            && self.bristle.is_none()
            && plane.extent.is_none()
        {
            // only edges and bristles depend on the direction of the tangent
            plane.tangent = NOWHERE;
        }
        Some(self)
    }
}
