//! What a model knows of a force law: its constituents, its outputs, and its visible parts. The laws themselves are in
//! [`law`](crate::law), and no file of this folder names one.

use super::look::Look;
use super::part::Field;
use super::requirement::{Curves, List};
use super::resolve::Resolver;
use super::resolve::applied::force;
use super::{Body, Component, Dimension, Projection, Quantity};
use crate::description::expand::{Expander, Node};
use crate::description::force::LawKeys;
use crate::description::output::Output as WrittenOutput;
use crate::description::place::At;
use crate::description::shape::{Key, Misfit, Record, Shape, check_record};
use serde::{Serialize, Serializer};
use serde_yaml::Value;
use std::any::Any;
use std::fmt;

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
    const TWICE: Option<&'static str> = None;

    /// The key of a Rust file that belongs to a force.
    const SOURCE: Option<&'static str> = None;

    /// The keys that all laws have.
    fn header(&self) -> Header<'_>;

    /// The checked form. Problems are reported; `None` if they leave no useful law.
    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>>;

    /// The records of the law's keys, in the order of the reference page.
    fn records() -> Vec<(&'static str, &'static [Key])>;

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
                records: K::records,
                image: K::image,
                twice: K::TWICE,
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
    let header = written.header();
    let check = |resolver: &mut Resolver<'_>, at: At<'_>| written.check(resolver, at);
    force(resolver, K::KEY, &header, &check, at);
    Ok(())
}

/// The title of a record, and its keys.
pub(crate) fn record<R: Record>() -> (&'static str, &'static [Key]) {
    (R::TITLE, R::KEYS)
}

/// The constituents of a law: its bodies, its numbers, its terms.
pub trait Terms: fmt::Debug {
    /// Adds all terms and numbers of the law, except those that do not exist in this dimension.
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>);

    /// Removes terms that have no effect without another term that is absent.
    fn settle_terms(&mut self) {}

    /// Removes the axes of parts that are the same in all directions, such as spheres.
    fn forget_directions(&mut self, _: Dimension) {}

    /// Adds conditions on several numbers together that must be checked before those on each number.
    fn require_first(&self, _: Dimension, _: &mut List<'_>) {}

    /// Adds conditions on several numbers together.
    fn require(&self, _: Dimension, _: Curves<'_>, _: &mut List<'_>) {}

    /// The bodies of the law that may be vehicles.
    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        Vec::new()
    }

    /// The switches that the law itself waits for: indices into [`Model::switches`](super::Model::switches).
    fn switches_mut(&mut self) -> Vec<&mut usize> {
        Vec::new()
    }

    /// True if the law exists in the plane.
    fn exists_in_plane(&self) -> bool {
        true
    }

    /// Reduces a law in space to its part in the plane x–z. Returns false if nothing is left.
    fn flatten(&mut self) -> bool;

    /// Turns a planar law into one in space that acts in the same way in the plane. Numbers are evaluated at these
    /// values of the parameters.
    fn embed(&mut self, _defaults: &[f64]) {}

    /// Reports a law that makes no sense at the start of a run. The model is right otherwise; `name` is that of the
    /// force, whose key stands at `at`.
    fn check_start(&self, _: &Resolver<'_>, _name: &str, _at: At<'_>) {}
}

/// The outputs and visible parts of a law.
pub trait Outputs {
    /// The quantity that an output asks for, and its unit. `None`, with a report, if the law has no such quantity.
    /// `force` is the index of the force.
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &WrittenOutput,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)>;

    /// The direction in which a quantity of the law is measured.
    fn direction(&self, asked: &dyn OfLaw) -> Measured {
        asked
            .component()
            .map_or(Measured::Undirected, Measured::Component)
    }

    /// The visible parts of the law.
    fn looks(&self) -> Vec<Look<'_>> {
        Vec::new()
    }
}

/// The direction in which a quantity of a law is measured: it decides the sign of a channel of a test.
pub enum Measured {
    /// A number without direction, such as a tension.
    Undirected,
    /// A component of a vector in absolute axes.
    Component(Component),
    /// The rotation about an axis of the carrier of this element's joint: 0, 1, 2 for x, y, z; others have no direction.
    About(super::ElementId, usize, Side),
    /// A degree of freedom of this element's joint, by its index.
    Freedom(super::ElementId, usize, Side),
}

/// The body whose load or motion a quantity of a joint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The load on the element that the joint carries.
    Load,
    /// The motion of that element relative to its carrier.
    Motion,
}

/// A quantity of a law, for outputs.
pub trait OfLaw: Object {
    /// For a vector, the projection that is asked for.
    fn projection_mut(&mut self) -> Option<&mut Projection> {
        None
    }

    /// For a vector, the component that is asked for, or its magnitude.
    fn component(&self) -> Option<Component> {
        None
    }

    /// False if the quantity is always 0 in the plane x–z.
    fn exists_in_plane(&self) -> bool {
        true
    }

    /// A copy.
    fn boxed(&self) -> Box<dyn OfLaw>;
}

/// A checked law.
pub trait Law: Terms + Outputs + Object {
    /// The key that names a force of this law.
    fn key(&self) -> &'static str;

    /// A copy.
    fn boxed(&self) -> Box<dyn Law>;
}

/// A value of a type that is known only to its law.
pub trait Object: fmt::Debug + Any + Send + Sync {
    /// True if the other value has the same type and is equal.
    fn equals(&self, other: &dyn Any) -> bool;

    /// All fields by name, for the digest.
    fn value(&self) -> Value;
}

impl<T: fmt::Debug + PartialEq + Serialize + Any + Send + Sync> Object for T {
    fn equals(&self, other: &dyn Any) -> bool {
        other.downcast_ref() == Some(self)
    }

    fn value(&self) -> Value {
        // laws are made of records, lists, texts and numbers, all of which have a value
        serde_yaml::to_value(self).unwrap_or_else(|error| panic!("a law has no value: {error}"))
    }
}

/// Makes boxes of a trait behave like the values in them.
macro_rules! boxed {
    ($($of:ident),*) => {$(
        impl dyn $of {
            /// The value, if it has this type.
            pub fn get<T: Any>(&self) -> Option<&T> {
                (self as &dyn Any).downcast_ref()
            }

            /// Like [`get`](Self::get), mutable.
            pub fn get_mut<T: Any>(&mut self) -> Option<&mut T> {
                (self as &mut dyn Any).downcast_mut()
            }
        }

        impl Clone for Box<dyn $of> {
            fn clone(&self) -> Self {
                (**self).boxed()
            }
        }

        impl PartialEq for Box<dyn $of> {
            fn eq(&self, other: &Self) -> bool {
                (**self).equals(&**other)
            }
        }

        // the derive of PartialEq compares boxes of traits in this way
        impl PartialEq<&Self> for Box<dyn $of> {
            fn eq(&self, other: &&Self) -> bool {
                self == *other
            }
        }

        impl Serialize for Box<dyn $of> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                (**self).value().serialize(serializer)
            }
        }
    )*};
}

boxed!(Law, OfLaw);
