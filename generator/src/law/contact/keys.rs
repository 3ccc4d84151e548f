//! The keys of a contact, and of the surfaces that meet in it.

use crate::description::curve::Function;
use crate::description::expand::{Expander, Node};
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::shape::{Key, record};
use crate::description::short::ByName;
use crate::description::surface::{Edge, Ellipsoid, Plane};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// Contact of an ellipsoid with a plane or another ellipsoid.
    Contact as "a contact" {
        /// Name, unique among the contacts.
        contact: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// The ellipsoid; an ellipse in the plane.
        ellipsoid: ByName<Ellipsoid>,
        /// The plane that it meets; a line in the plane.
        plane: Option<ByName<Plane>>,
        /// Or the other ellipsoid.
        with: Option<ByName<Ellipsoid>>,
        /// Force against penetration \[m\] → \[N\].
        elastic: Option<Function>,
        /// Its slope, where it is a line through 0 \[N/m\].
        stiffness: Option<Quantity>,
        /// The same while it falls \[m\] → \[N\].
        unloading: Option<Function>,
        /// Slope of the line between the two \[N/m\].
        unloading_slope: Option<Quantity>,
        /// Viscous coefficient \[N s/m\].
        damping: Option<Quantity>,
        /// Penetration at which damping is fully there \[m\].
        damping_depth: Option<Quantity>,
        /// Coefficient of friction.
        friction: Option<Quantity>,
        /// Sliding speed at which friction is fully there \[m/s\].
        friction_speed: Option<Quantity>,
        /// Displacement at which friction that holds is fully there \[m\].
        friction_displacement: Option<Quantity>,
    }
}

impl Keys for Contact {
    const KEY: &'static str = "contact";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["ellipsoid", "with"]);

    fn header(&self) -> Header<'_> {
        Header {
            name: self.contact.clone(),
            called: Some((Self::KEY, &self.contact)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::contact(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
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
