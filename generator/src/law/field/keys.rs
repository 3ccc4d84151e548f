//! The keys of a field.

use crate::description::curve::Function;
use crate::description::place::At;
use crate::description::shape::{Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// A uniform acceleration field.
    Field as "a field" {
        /// Name, unique among the fields.
        field: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Per absolute axis \[m/s²\]: a number or a curve of time.
        acceleration: Vec<Function>,
        /// Systems and elements that feel it.
        on: Option<Vec<String>>,
    }
}

impl Keys for Field {
    const KEY: &'static str = "field";
    const OBSERVABLE: bool = false;

    fn header(&self) -> Header<'_> {
        Header {
            name: self.field.clone(),
            called: Some((Self::KEY, &self.field)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::field(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
        vec![record::<Field>()]
    }
}
