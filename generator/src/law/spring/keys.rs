//! The keys of a spring.

use crate::description::curve::Function;
use crate::description::expand::{Expander, Node};
use crate::description::force::Attachment;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::shape::{Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// A spring and a damper between two points.
    Spring as "a spring" {
        /// Name, unique among the springs.
        spring: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// One end.
        from: Attachment,
        /// The other end.
        to: Attachment,
        /// Force against elongation \[m\] → \[N\].
        elastic: Option<Function>,
        /// Its slope, where it is a line through 0 \[N/m\].
        stiffness: Option<Quantity>,
        /// Length without force \[m\].
        length: Option<Quantity>,
        /// Viscous coefficient \[N s/m\].
        damping: Option<Quantity>,
    }
}

impl Keys for Spring {
    const KEY: &'static str = "spring";
    const EXCHANGEABLE: Option<[&'static str; 2]> = Some(["from", "to"]);

    fn header(&self) -> Header<'_> {
        Header {
            name: self.spring.clone(),
            called: Some((Self::KEY, &self.spring)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::spring(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
        vec![record::<Spring>()]
    }

    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        for key in ["from", "to"] {
            image.change(key, |end| expander.mirrored_surface(end));
        }
    }
}
