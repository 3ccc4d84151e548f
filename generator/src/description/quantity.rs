//! A quantity as written: a number in SI units, a text (`20 deg`, `2 * belt_stiffness`), or `{ param: name }`.

use super::place::At;
use super::rule::Rule;
use super::schema::{QUANTITY, Schema, any_of, object, typed};
use super::shape::{In, Misfit, Problems, Shape, check_record, misfit, record};
use super::tree::NodeKind;
use serde_yaml::Value;

/// A quantity that is measured in `U`; `&Number<U>` is a `&Quantity` where the unit does not matter.
pub type Number<U> = In<Quantity, U>;

/// What stands for a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A bare number, SI.
    Number(f64),
    /// A number with its unit, or an expression of parameters.
    Text(String),
    /// `{ param: name }`
    Param(String),
}

record! {
    /// A number that is the value of a parameter.
    Param as "a reference to a parameter" {
        /// name of the parameter
        param: String,
    }
}

impl Quantity {
    /// The JSON Schema of a quantity whose number keeps a rule. What a text or a parameter amounts to is known only to
    /// reading.
    pub fn ruled(to: &mut Schema, rule: Rule) -> Value {
        let number = ("type", "number".into());
        let number = match rule {
            Rule::Finite => object([number]),
            Rule::NotZero => object([number, ("not", object([("const", 0.into())]))]),
            Rule::NotNegative => object([number, ("minimum", 0.into())]),
            Rule::Positive => object([number, ("exclusiveMinimum", 0.into())]),
        };
        any_of([number, typed("string"), Param::schema(to)])
    }
}

impl Shape for Quantity {
    fn schema(to: &mut Schema) -> Value {
        to.define(QUANTITY, |to| Quantity::ruled(to, Rule::Finite))
    }

    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            NodeKind::Map(_) => check_record::<Param>(at, problems),
            NodeKind::Scalar { .. } if matches!(at.node.article(), "a number" | "a text") => {}
            _ => problems.add(at.problem(
                format!("here stands {}, but a number is needed", at.node.article()),
                "write a number, a number with its unit such as `20 deg`, or an expression of parameters",
            )),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value {
            Value::String(text) => Ok(Quantity::Text(text.clone())),
            Value::Mapping(_) => Param::read(value).map(|of| Quantity::Param(of.param)),
            _ => (value.as_f64().map(Quantity::Number)).ok_or_else(|| {
                misfit(
                    value,
                    "a number, a number with its unit, or an expression of parameters",
                )
            }),
        }
    }
}

/// One value in the plane, three in space: moments of inertia, angles, rates, moments.
#[derive(Clone, Debug, PartialEq)]
pub enum OneOrThree<T> {
    /// About y.
    One(T),
    /// One per axis.
    List(Vec<T>),
}

impl<T> OneOrThree<T> {
    /// The values with their places; `at` is that of the whole.
    pub fn each<'w>(&'w self, at: At<'w>) -> Vec<(&'w T, At<'w>)> {
        match self {
            OneOrThree::One(one) => vec![(one, at)],
            OneOrThree::List(list) => {
                let items = list.iter().enumerate();
                items.map(|(i, one)| (one, at.item(i))).collect()
            }
        }
    }
}

impl<T: Shape> Shape for OneOrThree<T> {
    const RULE: Rule = T::RULE;

    fn unit() -> String {
        T::unit()
    }

    fn schema(to: &mut Schema) -> Value {
        any_of([T::schema(to), Vec::<T>::schema(to)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            NodeKind::List(_) => Vec::<T>::check(at, problems),
            _ => T::check(at, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.is_sequence() {
            true => Vec::read(value).map(OneOrThree::List),
            false => T::read(value).map(OneOrThree::One),
        }
    }
}
