//! The keys of a bushing.

use crate::description::curve::FunctionOf;
use crate::description::expand::{Expander, Node};
use crate::description::force::Acting;
use crate::description::measure::{
    Angle, AngularDamping, AngularStiffness, Displacement, Effort, EffortPerCoordinate,
    EffortPerRate, Length,
};
use crate::description::place::At;
use crate::description::quantity::{Number, OneOrThree};
use crate::description::shape::{Flat, Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// Springs and dampers in six directions between frames of two bodies.
    Bushing as "a bushing" {
        /// name, unique among the bushings
        bushing: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
        /// the [frame](#an-end-of-a-bushing) in whose axes the laws are
        from: Mount,
        /// the frame that moves against it, on another body
        to: Mount,
        /// laws of the displacement [by axis](#the-directions-of-a-bushing); in the plane `x` and `z`
        along: Option<Directions>,
        /// [laws of the rotation](#the-rotations-of-a-bushing): of the Bryant angles by axis, or of the whole; in the
        /// plane `y`
        about: Option<Rotations>,
    }
}

record! {
    /// A frame on a body.
    Mount as "an end of a bushing" {
        /// `frame`, a vehicle, or an element as `system/element`
        on: String,
        /// its origin, local frame
        at: Vec<Number<Length>>,
        /// Bryant angles of its axes relative to the local frame; one angle about y in the plane
        axes: Option<OneOrThree<Number<Angle>>> = "0",
    }
}

record! {
    /// A law for each axis.
    Directions as "the directions of a bushing" {
        /// the [law](#a-direction-of-a-bushing) along x
        x: Option<Direction>,
        /// along y
        y: Option<Direction>,
        /// along z
        z: Option<Direction>,
    }
}

record! {
    /// A law for each Bryant angle, or one of the rotation as a whole.
    Rotations as "the rotations of a bushing" {
        /// the [law](#a-direction-of-a-bushing) of the Bryant angle about x
        x: Option<Direction>,
        /// about y
        y: Option<Direction>,
        /// about z
        z: Option<Direction>,
        /// in their place: the [law](#the-law-of-a-whole-rotation) of the angle of the whole rotation, about whatever
        /// axis it is
        turn: Option<Turn>,
    }
}

record! {
    /// The law of the angle of the whole rotation.
    Turn as "the law of a whole rotation" {
        /// moment by the angle
        stiffness: Option<Number<AngularStiffness>>,
        /// viscous coefficient on the relative angular velocity
        damping: Option<Number<AngularDamping>> = "0",
    }
}

record! {
    /// The law of one direction.
    Direction as "a direction of a bushing" {
        /// curve of the displacement or the angle
        elastic: Option<FunctionOf<Displacement, Effort>>,
        /// in its place: [a straight curve](#a-stiffness)
        stiffness: Option<Number<EffortPerCoordinate>>,
        /// viscous coefficient on its rate
        damping: Option<Number<EffortPerRate>> = "0",
    }
}

impl Keys for Bushing {
    const KEY: &'static str = "bushing";

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::bushing(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
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
