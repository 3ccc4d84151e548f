//! The keys of a bushing.

use crate::description::curve::Function;
use crate::description::expand::{Expander, Node};
use crate::description::place::At;
use crate::description::quantity::{OneOrThree, Quantity};
use crate::description::shape::{Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// Springs and dampers in six directions between frames of two bodies.
    Bushing as "a bushing" {
        /// Name, unique among the bushings.
        bushing: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// The frame in whose axes the laws are.
        from: Mount,
        /// The frame that moves against it.
        to: Mount,
        /// Laws of the displacement.
        along: Option<Directions>,
        /// Laws of the rotation.
        about: Option<Rotations>,
    }
}

record! {
    /// A frame on a body.
    Mount as "an end of a bushing" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// Its origin, local frame \[m\].
        at: Vec<Quantity>,
        /// Bryant angles of its axes relative to the local frame \[rad\].
        axes: Option<OneOrThree>,
    }
}

record! {
    /// A law for each axis.
    Directions as "the directions of a bushing" {
        /// Along or about x.
        x: Option<Direction>,
        /// Along or about y.
        y: Option<Direction>,
        /// Along or about z.
        z: Option<Direction>,
    }
}

record! {
    /// A law for each Bryant angle, or one of the rotation as a whole.
    Rotations as "the rotations of a bushing" {
        /// About x.
        x: Option<Direction>,
        /// About y.
        y: Option<Direction>,
        /// About z.
        z: Option<Direction>,
        /// Of the angle of the whole rotation, about whatever axis it is.
        turn: Option<Turn>,
    }
}

record! {
    /// The law of the angle of the whole rotation.
    Turn as "the law of a whole rotation" {
        /// Moment by the angle \[N m/rad\].
        stiffness: Option<Quantity>,
        /// Viscous coefficient \[N m s/rad\].
        damping: Option<Quantity>,
    }
}

record! {
    /// The law of one direction.
    Direction as "a direction of a bushing" {
        /// Force against displacement \[m\] → \[N\], or moment against angle \[rad\] → \[N m\].
        elastic: Option<Function>,
        /// Its slope, where it is a line through 0 \[N/m\] or \[N m/rad\].
        stiffness: Option<Quantity>,
        /// Viscous coefficient \[N s/m\] or \[N m s/rad\].
        damping: Option<Quantity>,
    }
}

impl Keys for Bushing {
    const KEY: &'static str = "bushing";

    fn header(&self) -> Header<'_> {
        Header {
            name: self.bushing.clone(),
            called: Some((Self::KEY, &self.bushing)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::bushing(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
        vec![
            record::<Bushing>(),
            record::<Mount>(),
            record::<Directions>(),
            record::<Rotations>(),
            record::<Turn>(),
            record::<Direction>(),
        ]
    }

    /// The frames of the image are images, too: the displacement along the reversed axis and the angles about the two others change their signs.
    /// The angle of the whole rotation stays.
    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        for key in ["from", "to"] {
            image.change(key, |end| expander.mirrored_surface(end));
        }
        for (axis, key) in ["x", "y", "z"].into_iter().enumerate() {
            let reversed = match expander.reverses(axis) {
                true => "along",
                false => "about",
            };
            let laws = image.get_mut(reversed);
            if let Some(law) = laws.and_then(|laws| laws.get_mut(key)) {
                expander.mirror_law(law);
            }
        }
    }
}
