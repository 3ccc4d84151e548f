//! Records that are declared once: [`declare!`](crate::declare) takes the keys of a record, each with its meaning, its
//! kind and its default, and makes of them how the record is written (its shape, its rows of the reference page, its
//! schema), the struct that a model keeps of it, and all that asks for its numbers: units, rules, terms, mirror images,
//! the form in the plane.
//!
//! What several keys mean only together stays code: [`Declared`] of a record, [`DeclaredLaw`] of a law.

mod kinds;

pub use kinds::*;

use super::body::Body;
use super::curve::ScaledCurve;
use super::dimension::Dimension;
use super::law::Law;
use super::number::Number;
use super::part::{Field, Fresh, Part, Term};
use super::resolve::Resolver;
use super::resolve::law::{Keys, Outputs, TitledKeys};
use super::rule::{Rule, Ruled};
use crate::description::expand::{Expander, Node};
use crate::description::measure::InPlace;
use crate::description::place::At;
use crate::description::quantity::Number as WrittenNumber;
use crate::description::schema::Schema;
use crate::description::shape::{Key, Misfit, Problems, Record, Shape, check_keys, misfit};
use serde_yaml::Value;
use std::marker::PhantomData;

/// What a key of a record is: how it is written, what a model keeps of it, and what is done with that.
pub trait Kind {
    /// How it is written.
    type Written: Shape;
    /// What a model keeps of it.
    type Kept;

    /// Reads the key; `None` after a problem that leaves nothing useful.
    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept>;

    /// Adds its bodies, numbers and terms.
    fn add_fields<'a>(_: &'a mut Self::Kept, _: &Names<'_>, _: &mut Vec<Field<'a>>) {}

    /// Adds its bodies that may be vehicles.
    fn add_bodies<'a>(_: &'a mut Self::Kept, _: &mut Vec<&'a mut Body>) {}

    /// Adds the switches that it waits for.
    fn add_switches<'a>(_: &'a mut Self::Kept, _: &mut Vec<&'a mut usize>) {}

    /// Reduces it to its part in the plane x–z.
    fn flatten(_: &mut Self::Kept) {}

    /// Turns the value of the key, in a copy of the text, into its mirror image.
    fn mirror(_: &Expander<'_>, _record: &mut Node, _key: &str) {}
}

/// What the kept value of a kind is.
pub type Of<K> = <K as Kind>::Kept;

/// A record of the text whose keys are read one after the other.
pub struct Reader<'r, 'm, 'w> {
    /// The model so far.
    pub resolver: &'r mut Resolver<'m>,
    /// The record.
    pub value: &'w Value,
    /// Its place.
    pub at: At<'w>,
    /// True where its numbers are of a coordinate that slides.
    pub slides: bool,
    /// The elastic law that was read last.
    pub loading: Loading,
    /// The default of the key that is read, as the declaration writes it.
    pub default: &'static str,
}

/// An elastic law, to which a law of unloading may belong.
#[derive(Default)]
pub struct Loading {
    /// The key of its curve.
    pub key: &'static str,
    /// The curve; `None` if it is 0 or wrong.
    pub curve: Option<ScaledCurve>,
}

impl<'m, 'w> Reader<'_, 'm, 'w> {
    /// The value of a key as it is written. The record has passed the check of its shape, so this is `None` only with
    /// a report of a fault of the check.
    pub fn written<S: Shape>(&self, key: &str) -> Option<S> {
        let written = S::of_key(self.value, key);
        written
            .map_err(|misfit| {
                let problem = self.at.problem(misfit, "see the reference of the language");
                self.resolver.problems.add(problem);
            })
            .ok()
    }

    /// True if the key is written.
    pub fn has(&self, key: &str) -> bool {
        self.at.node.get(key).is_some()
    }

    /// Reads a number; nothing where the key is not written.
    pub fn number<U: InPlace>(&self, key: &str) -> Option<Option<Number>> {
        let written: Option<WrittenNumber<U>> = self.written(key)?;
        let (at, expected) = (self.at.key(key), U::expected(self.slides));
        let number = written.map(|number| self.resolver.number_in(&number, at, expected));
        // 0 may mean that there is none: whether it may stand is known where the number has an effect
        if let Some(value) = number.as_ref().and_then(Number::constant)
            && value != 0.0
            && !U::RULE.keeps(value)
        {
            self.resolver
                .problems
                .add(self.resolver.breaks(U::RULE, value, at));
        }
        Some(number)
    }

    /// Reads a coefficient. One that is 0 counts as not written.
    pub fn coefficient<U: InPlace>(&self, key: &str) -> Option<Option<Number>> {
        Some(self.number::<U>(key)?.filter(|number| !number.is_zero()))
    }

    /// Reports a key that is written without any of those that it needs.
    pub fn check_needs(&self, key: &str, needs: &[&str], message: &str, help: &str) {
        if self.has(key) && !needs.iter().any(|other| self.has(other)) {
            let problem = self.at.key(key).key_problem(message, help);
            self.resolver.problems.add(problem);
        }
    }

    /// Reads the record at a key; `None` if the key is not written.
    pub fn below(&mut self, key: &str) -> Option<Reader<'_, 'm, 'w>> {
        let value = self.value.get(key)?;
        Some(Reader {
            resolver: self.resolver,
            value,
            at: self.at.key(key),
            slides: self.slides,
            loading: Loading::default(),
            default: "",
        })
    }

    /// Reads the records of the list at a key, one after the other; none if the key is not written.
    pub fn each_below(&mut self, key: &str, mut read: impl FnMut(Reader<'_, 'm, 'w>)) {
        let list = self.value.get(key).and_then(Value::as_sequence);
        for (index, value) in list.into_iter().flatten().enumerate() {
            read(Reader {
                resolver: self.resolver,
                value,
                at: self.at.key(key).item(index),
                slides: false,
                loading: Loading::default(),
                default: "",
            });
        }
    }

    /// A record at this place with no keys.
    pub fn without_keys(&mut self) -> Reader<'_, 'm, 'w> {
        Reader {
            resolver: self.resolver,
            value: &Value::Null,
            at: self.at,
            slides: self.slides,
            loading: Loading::default(),
            default: "",
        }
    }
}

/// What the constituents of a record are called.
#[derive(Clone, Copy)]
pub struct Names<'n> {
    /// The dimension of the model.
    pub dimension: Dimension,
    /// Follows the name of each term: " about x".
    pub about: &'n str,
    /// Leads to the record: "about.x.".
    pub below: &'n str,
    /// The key.
    pub key: &'static str,
    /// Name of its term.
    pub name: &'static str,
    /// Why it has no effect without another term, as in [`Term`].
    pub needs: &'static str,
}

impl<'n> Names<'n> {
    /// Those of a force's own keys.
    pub fn of_force(dimension: Dimension) -> Self {
        Names {
            dimension,
            about: "",
            below: "",
            key: "",
            name: "",
            needs: "",
        }
    }

    /// Those of a record below.
    pub fn within(self, about: &'n str, below: &'n str) -> Self {
        Names {
            about,
            below,
            ..self
        }
    }

    /// Those of a key.
    pub fn of(self, key: &'static str, name: &'static str, needs: &'static str) -> Self {
        Names {
            key,
            name: if name.is_empty() { key } else { name },
            needs,
            ..self
        }
    }

    /// The path of the key.
    pub fn path(&self) -> String {
        format!("{}{}", self.below, self.key)
    }

    /// The term of the key.
    pub fn term(&self, rule: Rule) -> Term {
        Term::new(format!("{}{}", self.name, self.about), self.path(), rule).needs(self.needs)
    }
}

/// What [`declare!`](crate::declare) makes of the keys.
pub trait Declaration: Sized {
    /// What it is called, with its article.
    const TITLE: &'static str;
    /// The keys, in the order of the reference page.
    fn keys() -> Vec<Key>;
    /// Reads all keys; `None` after a problem that leaves nothing useful.
    fn keep(reader: &mut Reader<'_, '_, '_>) -> Option<Self>;
    /// Adds the constituents of all keys.
    fn add_fields<'a>(&'a mut self, names: Names<'_>, fields: &mut Vec<Field<'a>>);
    /// Adds the bodies that may be vehicles.
    fn add_bodies<'a>(&'a mut self, bodies: &mut Vec<&'a mut Body>);
    /// Adds the switches that it waits for.
    fn add_switches<'a>(&'a mut self, switches: &mut Vec<&'a mut usize>);
    /// Reduces it to its part in the plane x–z.
    fn flatten(&mut self);
    /// Turns a copy of its text into its mirror image.
    fn mirror(expander: &Expander<'_>, image: &mut Node);
}

/// A declared record.
pub trait Declared: Declaration {
    /// Reports keys that do not go together.
    fn check_keys(_: &Reader<'_, '_, '_>) {}

    /// Reports values that do not go together; `None` if the record has no effect.
    fn finish(self, _: &mut Reader<'_, '_, '_>) -> Option<Self> {
        Some(self)
    }

    /// Reads the record.
    fn read(reader: &mut Reader<'_, '_, '_>) -> Option<Self> {
        Self::check_keys(reader);
        Self::keep(reader)?.finish(reader)
    }
}

/// A force law whose keys are declared.
pub trait DeclaredLaw: Declaration + Law {
    /// The key that names a force and tells that it is of this law.
    const KEY: &'static str;
    /// Two keys whose values may be exchanged without changing the law.
    const EXCHANGEABLE: Option<[&'static str; 2]> = None;
    /// True if the law has outputs.
    const OBSERVABLE: bool = true;
    /// The records below it, in the order of the reference page.
    const RECORDS: &'static [fn() -> TitledKeys] = &[];

    /// Reports keys that do not go together. `name` is that of the force.
    fn check_keys(_name: &str, _: &Reader<'_, '_, '_>) {}

    /// Reports values that do not go together; `None` if nothing useful is left.
    fn check(self, _name: &str, _: &mut Reader<'_, '_, '_>) -> Option<Self> {
        Some(self)
    }
}

/// What is kept without a key of its own.
pub struct NoKey;

impl Shape for NoKey {
    const OPTIONAL: bool = true;

    fn schema(_: &mut Schema) -> Value {
        Value::Null
    }

    fn check(_: At<'_>, _: &Problems) {}

    fn read(_: &Value) -> Result<Self, Misfit> {
        Ok(NoKey)
    }

    fn declare(_: &'static str, _: &'static str, _: &'static str, _: &mut Vec<Key>) {}
}

/// A declared record as it is written.
#[derive(Clone, Debug)]
pub struct Written<D>(Value, PhantomData<D>);

impl<D> Written<D> {
    /// Reads the record, whose numbers are not of a coordinate that slides.
    pub fn reader<'r, 'm, 'w>(
        &'w self,
        resolver: &'r mut Resolver<'m>,
        at: At<'w>,
    ) -> Reader<'r, 'm, 'w> {
        Reader {
            resolver,
            value: &self.0,
            at,
            slides: false,
            loading: Loading::default(),
            default: "",
        }
    }
}

impl<D: Declaration> Record for Written<D> {
    const TITLE: &'static str = D::TITLE;

    fn keys() -> Vec<Key> {
        D::keys()
    }

    fn among(value: &Value) -> Result<Self, Misfit> {
        match value.is_mapping() {
            true => Ok(Written(value.clone(), PhantomData)),
            false => Err(misfit(value, D::TITLE)),
        }
    }
}

impl<D: Declaration> Shape for Written<D> {
    fn schema(to: &mut Schema) -> Value {
        to.keys(D::TITLE, &D::keys())
    }

    fn check(at: At<'_>, problems: &Problems) {
        check_keys(D::TITLE, &D::keys(), at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        Self::among(value)
    }
}

impl<L: DeclaredLaw + Outputs> Keys for Written<L> {
    const KEY: &'static str = L::KEY;
    const EXCHANGEABLE: Option<[&'static str; 2]> = L::EXCHANGEABLE;
    const OBSERVABLE: bool = L::OBSERVABLE;

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        let name = self.0.get(L::KEY).and_then(Value::as_str);
        let name = name.unwrap_or_default();
        let mut reader = self.reader(resolver, at);
        L::check_keys(name, &reader);
        let law = L::keep(&mut reader)?.check(name, &mut reader)?;
        Some(Box::new(law))
    }

    fn records() -> Vec<TitledKeys> {
        let below = L::RECORDS.iter().map(|record| record());
        std::iter::once((L::TITLE, L::keys()))
            .chain(below)
            .collect()
    }

    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        L::mirror(expander, image);
    }
}

/// The methods of [`Terms`](crate::model::law::Terms) that follow from a declaration. With `flatten` the law keeps in
/// the plane what its keys keep.
macro_rules! declared_terms {
    ($($flatten:ident)?) => {
        fn add_fields<'a>(
            &'a mut self,
            dimension: $crate::model::Dimension,
            fields: &mut Vec<$crate::model::part::Field<'a>>,
        ) {
            let names = $crate::model::declared::Names::of_force(dimension);
            $crate::model::declared::Declaration::add_fields(self, names, fields);
        }

        fn bodies_mut(&mut self) -> Vec<&mut $crate::model::Body> {
            let mut bodies = Vec::new();
            $crate::model::declared::Declaration::add_bodies(self, &mut bodies);
            bodies
        }

        fn switches_mut(&mut self) -> Vec<&mut usize> {
            let mut switches = Vec::new();
            $crate::model::declared::Declaration::add_switches(self, &mut switches);
            switches
        }

        $(fn $flatten(&mut self) -> bool {
            $crate::model::declared::Declaration::flatten(self);
            true
        })?
    };
}
pub(crate) use declared_terms;

/// A record that is a term: it is never 0 if written, and is not added to a scene that does not have it.
impl<D: Declared> Part for Option<D> {
    fn is_in(&self) -> bool {
        self.is_some()
    }

    fn leave_out(&mut self) {
        *self = None;
    }

    fn put_in(&mut self, _: &mut Fresh<'_>) {}

    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let numbers = fields(self).into_iter().flat_map(|field| match field {
            Field::Body(_) => Vec::new(),
            Field::Number(key, rule, number) => vec![Ruled::below(key, rule, number)],
            Field::Term(term, part) => {
                let numbers = part.numbers().into_iter().map(|number| Ruled {
                    rule: Some(number.rule.unwrap_or(term.rule)),
                    ..number.under(&term.keys[0])
                });
                numbers.collect()
            }
        });
        numbers.collect()
    }

    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        let curves = fields(self).into_iter().map(|field| match field {
            Field::Term(_, part) => part.curves(),
            Field::Body(_) | Field::Number(..) => Vec::new(),
        });
        curves.flatten().collect()
    }
}

/// The constituents of a record that may be absent.
fn fields<D: Declared>(record: &mut Option<D>) -> Vec<Field<'_>> {
    let mut fields = Vec::new();
    if let Some(record) = record {
        record.add_fields(Names::of_force(Dimension::Space), &mut fields);
    }
    fields
}

/// Declares a record: a struct of what a model keeps, and its [`Declaration`]. Keys that are `only written` are not
/// kept (`Lock as "a lock" only written { … } and kept { … }`); those in braces behind a kind are read together with
/// it.
///
/// ```text
/// /// A lock.
/// Lock as "a lock" {
///     /// the [switch](#a-switch)
///     by: SwitchName,
///     /// torque per angle from there
///     stiffness: CoefficientOrZero<NotNegative<AngularStiffness>>,
///     /// viscous coefficient on the rate
///     damping: Coefficient<NotNegative<AngularDamping>> = "0",
/// }
/// ```
#[macro_export]
#[doc(hidden)]
macro_rules! declare {
    ($(#[$meta:meta])* $record:ident as $title:literal $(only written {
        $( $(#[doc = $said:literal])* $only:ident: $shape:ty $(= $usual:literal)?, )*
    } and kept)? {
        $(
            $(#[doc = $meaning:literal])*
            $field:ident: $kind:ty
                $({ $( $(#[doc = $other_meaning:literal])* $other:ident: $other_shape:ty $(= $other_default:literal)?, )* })?
                $(as $name:literal $(needs $needs:literal)?)?
                $(= $default:literal)?,
        )*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize)]
        pub struct $record { $( $(#[doc = $meaning])* pub $field: $crate::model::declared::Of<$kind>, )* }

        impl $crate::model::declared::Declaration for $record {
            const TITLE: &'static str = $title;

            fn keys() -> Vec<$crate::description::shape::Key> {
                use $crate::description::shape::Shape;
                use $crate::model::declared::Kind;
                let mut all = Vec::new();
                $( $( <$shape>::declare(stringify!($only), concat!($( $usual )?), concat!($( $said ),*), &mut all); )* )?
                $(
                    <$kind as Kind>::Written::declare(
                        stringify!($field), concat!($( $default )?), concat!($( $meaning ),*), &mut all,
                    );
                    $( $( <$other_shape>::declare(
                        stringify!($other), concat!($( $other_default )?), concat!($( $other_meaning ),*), &mut all,
                    ); )* )?
                )*
                all
            }

            fn keep(reader: &mut $crate::model::declared::Reader<'_, '_, '_>) -> Option<Self> {
                $(
                    reader.default = concat!($( $default )?);
                    let $field = <$kind as $crate::model::declared::Kind>::keep(reader, stringify!($field));
                )*
                Some($record { $( $field: $field?, )* })
            }

            fn add_fields<'a>(
                &'a mut self,
                names: $crate::model::declared::Names<'_>,
                fields: &mut Vec<$crate::model::part::Field<'a>>,
            ) {
                $( <$kind as $crate::model::declared::Kind>::add_fields(
                    &mut self.$field,
                    &names.of(stringify!($field), concat!($( $name )?), concat!($( $( $needs )? )?)),
                    fields,
                ); )*
            }

            fn add_bodies<'a>(&'a mut self, bodies: &mut Vec<&'a mut $crate::model::Body>) {
                $( <$kind as $crate::model::declared::Kind>::add_bodies(&mut self.$field, bodies); )*
            }

            fn add_switches<'a>(&'a mut self, switches: &mut Vec<&'a mut usize>) {
                $( <$kind as $crate::model::declared::Kind>::add_switches(&mut self.$field, switches); )*
            }

            fn flatten(&mut self) {
                $( <$kind as $crate::model::declared::Kind>::flatten(&mut self.$field); )*
            }

            fn mirror(
                expander: &$crate::description::expand::Expander<'_>,
                image: &mut $crate::description::expand::Node,
            ) {
                $( <$kind as $crate::model::declared::Kind>::mirror(expander, image, stringify!($field)); )*
            }
        }
    };
}
pub use declare;
