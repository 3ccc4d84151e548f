//! The keys of a spring.

use crate::description::force::Acting;
use crate::description::measure::{Force, Length, LinearDamping, NotNegative, Stiffness};
use crate::description::quantity::Number;
use crate::description::shape::Flat;
use crate::diagnostic::quoted;
use crate::model::Attachment;
use crate::model::declared::{
    Coefficient, DeclaredLaw, Elastic, Given, Reader, Written, declare, declared_terms,
};
use crate::model::law::Terms;

/// The keys of a spring.
pub type SpringKeys = Written<Spring>;

declare! {
    /// A spring and a damper side by side between two points: u is the unit vector from the first to the second, L
    /// their distance.
    Spring as "a spring" only written {
        /// name, unique among the springs
        spring: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    } and kept {
        /// one [end](#an-attachment)
        from: Attachment,
        /// the other end, on another body
        to: Attachment,
        /// curve of the elongation: the length less the length without force
        elastic: Elastic<Length, Force, Stiffness> {
            /// instead of `elastic`: force per elongation, [a straight curve](#a-stiffness)
            stiffness: Option<Number<NotNegative<Stiffness>>>,
        },
        /// length without force
        length: Given<NotNegative<Length>> = "the distance of the ends at the start",
        /// viscous coefficient on the rate of the length
        damping: Coefficient<NotNegative<LinearDamping>> = "0",
    }
}

impl DeclaredLaw for Spring {
    const KEY: &'static str = "spring";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["from", "to"]);

    fn check_keys(_: &str, reader: &Reader<'_, '_, '_>) {
        reader.check_needs(
            "length",
            &["elastic", "stiffness"],
            "a length means nothing without an elastic force",
            "add `stiffness: …` or `elastic: …`, or remove `length`",
        );
    }

    fn check(mut self, name: &str, reader: &mut Reader<'_, '_, '_>) -> Option<Self> {
        if self.from.on == self.to.on {
            reader.resolver.problems.add(reader.at.key("to").problem(
                format!("both ends of spring {} are on the same body", quoted(name)),
                "a spring runs between two bodies; `frame` is the absolute frame",
            ));
        }
        self.settle_terms();
        Some(self)
    }
}

impl Terms for Spring {
    declared_terms!(flatten);

    fn settle_terms(&mut self) {
        if self.elastic.is_none() {
            self.length = None;
        }
    }
}
