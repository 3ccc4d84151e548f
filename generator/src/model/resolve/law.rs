//! What reading a model asks of a law.

use super::Resolver;
use super::applied::force;
use crate::description::expand::{Expander, Node};
use crate::description::force::LawKeys;
use crate::description::output::Output;
use crate::description::place::At;
use crate::description::shape::{Key, Misfit, Record, Shape, check_record};
use crate::model::Quantity;
use crate::model::law::Law;
use serde_yaml::Value;

/// A law as the user writes it.
pub trait Keys: Record {
    /// The key that names a force and tells that it is of this law.
    const KEY: &'static str;

    /// Two keys whose values may be exchanged without changing the law.
    const EXCHANGEABLE: Option<[&'static str; 2]> = None;

    /// True if the law has outputs.
    const OBSERVABLE: bool = true;

    /// True if outputs name a part of the law after its name: `of: user drag/head`.
    const HAS_PORTS: bool = false;

    /// Advice for two forces with the same name, in place of renaming one of them.
    const SAME_NAME_ADVICE: Option<&'static str> = None;

    /// The key of a Rust file that belongs to a force.
    const SOURCE: Option<&'static str> = None;

    /// The keys that all laws have, of the force that was read from `value`.
    fn header<'v>(&'v self, value: &'v Value) -> Header<'v> {
        Header::read(value, Self::KEY)
    }

    /// The checked form. Problems are reported; `None` if they leave no useful law.
    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>>;

    /// The records of the law's keys, in the order of the reference page.
    fn records() -> Vec<TitledKeys>;

    /// Turns a copy of the force, apart from its name, into its mirror image.
    fn mirror(_: &Expander<'_>, _image: &mut Node) {}

    /// Turns a copy of a force into its mirror image, with its name. `None`, with a report, if the force has no mirror
    /// image.
    fn image(expander: &mut Expander<'_>, force: &Node, image: &mut Node) -> Option<()> {
        expander.image_of_named(force, image, Self::KEY)?;
        Self::mirror(expander, image);
        expander.differs(force, image, Self::KEY, Self::EXCHANGEABLE)
    }
}

/// The keys that all laws have, as written.
pub struct Header<'a> {
    /// Name of the force in outputs and messages.
    pub name: String,
    /// The key under which the user names the force, and the name.
    pub called: Option<(&'static str, &'a str)>,
    /// False if the force is switched off.
    pub enabled: Option<bool>,
    /// The switch after which the force acts.
    pub since: Option<&'a str>,
    /// The switch up to which the force acts.
    pub until: Option<&'a str>,
}

impl<'v> Header<'v> {
    /// The keys of a force whose name stands under `key`.
    pub fn read(value: &'v Value, key: &'static str) -> Self {
        let text = |key: &str| value.get(key).and_then(Value::as_str);
        let name = text(key);
        Header {
            name: name.unwrap_or_default().to_owned(),
            called: name.map(|name| (key, name)),
            enabled: value.get("enabled").and_then(Value::as_bool),
            since: text("since"),
            until: text("until"),
        }
    }
}

/// A law as the language knows it, and how a force of it is read.
pub(crate) struct Registered {
    /// The law as the language knows it.
    pub keys: LawKeys,
    /// Enters a force of this law, written as this value, which passed the check.
    pub enter: fn(&mut Resolver<'_>, &Value, At<'_>) -> Result<(), Misfit>,
}

impl Registered {
    /// The law with these keys.
    pub const fn of<K: Keys + Shape>() -> Self {
        Registered {
            keys: LawKeys {
                key: K::KEY,
                title: K::TITLE,
                shape: check_record::<K>,
                schema: K::schema,
                records: K::records,
                image: K::image,
                same_name_advice: K::SAME_NAME_ADVICE,
                is_observable: K::OBSERVABLE,
                has_ports: K::HAS_PORTS,
                source: K::SOURCE,
            },
            enter: enter::<K>,
        }
    }
}

fn enter<K: Keys + Shape>(
    resolver: &mut Resolver<'_>,
    value: &Value,
    at: At<'_>,
) -> Result<(), Misfit> {
    let written = K::read(value)?;
    let header = written.header(value);
    let check = |resolver: &mut Resolver<'_>, at: At<'_>| written.check(resolver, at);
    force(resolver, K::KEY, &header, &check, at);
    Ok(())
}

/// The title of a record, and its keys.
pub type TitledKeys = (&'static str, Vec<Key>);

/// The title of this record, and its keys.
pub(crate) fn record<R: Record>() -> TitledKeys {
    (R::TITLE, R::keys())
}

/// The outputs of a checked law, and its remarks on the start of a run: what needs the rest of the model.
pub trait Outputs {
    /// The quantity that an output asks for, and its unit. `None`, with a report, if the law has no such quantity.
    /// `force` is the index of the force.
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Output,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)>;

    /// Reports a law that makes no sense at the start of a run. The model is right otherwise; `name` is that of the
    /// force, whose key stands at `at`.
    fn check_start(&self, _: &Resolver<'_>, _name: &str, _at: At<'_>) {}
}
