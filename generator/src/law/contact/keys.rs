//! The keys of a contact, and of the surfaces that meet in it.

use crate::description::curve::FunctionOf;
use crate::description::expand::{Expander, Node};
use crate::description::force::Acting;
use crate::description::measure::{Coefficient, Force, Length, LinearDamping, Speed, Stiffness};
use crate::description::place::At;
use crate::description::quantity::Number;
use crate::description::shape::{Flat, Key, record};
use crate::description::short::ByName;
use crate::description::surface::{Edge, Ellipsoid, Plane};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// Contact of an ellipsoid with a plane or another ellipsoid.
    Contact as "a contact" {
        /// name, unique among the contacts
        contact: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
        /// the [ellipsoid](#an-ellipsoid), or [names](#named-surfaces) of such
        ellipsoid: ByName<Ellipsoid>,
        /// the [plane](#a-plane) that it meets, on another body, or names of such
        plane: Option<ByName<Plane>>,
        /// instead of `plane`: the other [ellipsoid](#an-ellipsoid), on another body, or names of such; one of the two
        /// keys must be given
        with: Option<ByName<Ellipsoid>>,
        /// curve of the perpendicular penetration
        elastic: Option<FunctionOf<Length, Force>>,
        /// instead of `elastic`: force per penetration, [a straight curve](#a-stiffness)
        stiffness: Option<Number<Stiffness>>,
        /// curve of the force during unloading, nowhere above `elastic`; see [hysteresis](#hysteresis)
        unloading: Option<FunctionOf<Length, Force>>,
        /// slope of the line between the two curves
        unloading_slope: Option<Number<Stiffness>> = "ten times the steepest slope of `elastic`",
        /// viscous coefficient on the rate of penetration
        damping: Option<Number<LinearDamping>> = "0",
        /// damping grows in proportion to the penetration up to this one, so that no force jumps at touch; 0: it acts
        /// in full at once
        damping_depth: Option<Number<Length>> = "1 mm",
        /// coefficient of Coulomb friction on the normal force
        friction: Option<Number<Coefficient>> = "0",
        /// friction grows in proportion to the sliding speed up to this one, and is constant beyond
        friction_speed: Option<Number<Speed>> = "0.01",
        /// friction that holds: it grows with the displacement up to this one; see [friction](#friction)
        friction_displacement: Option<Number<Length>>,
    }
}

impl Keys for Contact {
    const KEY: &'static str = "contact";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["ellipsoid", "with"]);

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::contact(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
        vec![
            record::<Contact>(),
            record::<Ellipsoid>(),
            record::<Plane>(),
            record::<Edge>(),
        ]
    }

    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        for key in ["ellipsoid", "plane", "with"] {
            image.change(key, |surface| expander.mirrored_by_name(surface));
        }
    }
}
