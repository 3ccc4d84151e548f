//! What a model knows of a force law: its constituents, its quantities, and its visible parts. The laws themselves are
//! in [`law`](crate::law), and no file of this folder names one.

use super::body::{Body, ElementId};
use super::dimension::Dimension;
use super::look::Look;
use super::part::{Field, Term};
use super::quantity::{Component, Projection};
use super::requirement::{Curves, List};
use serde::{Serialize, Serializer};
use serde_yaml::Value;
use std::any::Any;
use std::fmt;

impl dyn Law {
    /// All constituents of a law that exist in this dimension.
    pub fn fields(&mut self, dimension: Dimension) -> Vec<Field<'_>> {
        let mut fields = Vec::new();
        self.add_fields(dimension, &mut fields);
        fields
    }

    /// Removes terms that have no effect without an absent term, and brings absent parts to one common form.
    pub fn settle(&mut self, dimension: Dimension) {
        for field in self.fields(dimension) {
            if let Field::Term(_, part) = field
                && !part.is_in()
            {
                part.leave_out();
            }
        }
        self.settle_terms();
    }

    /// The terms, each with true if it is present.
    pub fn terms(&self, dimension: Dimension) -> Vec<(Term, bool)> {
        let mut copy = self.boxed();
        let fields = copy.fields(dimension).into_iter();
        let terms = fields.filter_map(|field| match field {
            Field::Term(term, part) => Some((term, part.is_in())),
            Field::Body(_) | Field::Number(..) => None,
        });
        terms.collect()
    }

    /// True if the law has an effect: a term that acts alone is present.
    pub fn acts(&self, dimension: Dimension) -> bool {
        let mut terms = self.terms(dimension).into_iter();
        terms.any(|(term, is_in)| is_in && term.needs.is_empty())
    }
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
}

/// The visible parts of a law, and the directions of its outputs.
pub trait Visible {
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
    /// The rotation about an axis of the carrier of this element's joint: 0, 1, 2 for x, y, z; others have no
    /// direction.
    About(ElementId, usize, Side),
    /// A degree of freedom of this element's joint, by its index.
    Freedom(ElementId, usize, Side),
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
pub trait Law: Terms + Visible + Object {
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

            /// Like `get`, mutable.
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
