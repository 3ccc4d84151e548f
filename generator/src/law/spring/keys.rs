//! The keys of a spring.

use crate::description::curve::FunctionOf;
use crate::description::expand::{Expander, Node};
use crate::description::force::{Acting, Attachment};
use crate::description::measure::{Force, Length, LinearDamping, Stiffness};
use crate::description::place::At;
use crate::description::quantity::Number;
use crate::description::shape::{Flat, Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// A spring and a damper between two points.
    Spring as "a spring" {
        /// name, unique among the springs
        spring: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
        /// one [end](#an-attachment)
        from: Attachment,
        /// the other end, on another body
        to: Attachment,
        /// curve of the elongation: the length less the length without force
        elastic: Option<FunctionOf<Length, Force>>,
        /// instead of `elastic`: force per elongation, [a straight curve](#a-stiffness)
        stiffness: Option<Number<Stiffness>>,
        /// length without force
        length: Option<Number<Length>> = "the distance of the ends at the start",
        /// viscous coefficient on the rate of the length
        damping: Option<Number<LinearDamping>> = "0",
    }
}

impl Keys for Spring {
    const KEY: &'static str = "spring";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["from", "to"]);

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::spring(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
        vec![record::<Spring>()]
    }

    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        for key in ["from", "to"] {
            image.change(key, |end| expander.mirrored_surface(end));
        }
    }
}
