//! A quantity as written: a number in SI units, a text (`20 deg`, `2 * belt_stiffness`), or `{ param: name }`.

use super::place::At;
use super::shape::{Problems, Shape, check_record, record};
use super::tree::Kind;
use serde::de::{self, Deserialize, DeserializeOwned, Deserializer, MapAccess, Visitor};
use std::fmt;

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
        /// Name of the parameter.
        param: String,
    }
}

impl Shape for Quantity {
    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            Kind::Map(_) => check_record::<Param>(at, problems),
            Kind::Scalar { .. } if matches!(at.node.article(), "a number" | "a text") => {}
            _ => problems.add(at.problem(
                format!("here stands {}, but a number is needed", at.node.article()),
                "write a number, a number with its unit such as `20 deg`, or an expression of parameters",
            )),
        }
    }
}

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Any;
        impl<'de> Visitor<'de> for Any {
            type Value = Quantity;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, a number with its unit, or an expression of parameters")
            }
            fn visit_i64<E>(self, value: i64) -> Result<Quantity, E> {
                Ok(Quantity::Number(value as f64))
            }
            fn visit_u64<E>(self, value: u64) -> Result<Quantity, E> {
                Ok(Quantity::Number(value as f64))
            }
            fn visit_i128<E>(self, value: i128) -> Result<Quantity, E> {
                Ok(Quantity::Number(value as f64))
            }
            fn visit_u128<E>(self, value: u128) -> Result<Quantity, E> {
                Ok(Quantity::Number(value as f64))
            }
            fn visit_f64<E>(self, value: f64) -> Result<Quantity, E> {
                Ok(Quantity::Number(value))
            }
            fn visit_str<E>(self, text: &str) -> Result<Quantity, E> {
                Ok(Quantity::Text(text.to_owned()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Quantity, A::Error> {
                let param = Param::deserialize(de::value::MapAccessDeserializer::new(map))?;
                Ok(Quantity::Param(param.param))
            }
        }
        deserializer.deserialize_any(Any)
    }
}

/// One value in the plane, three in space: moments of inertia, angles, rates, moments.
#[derive(Clone, Debug, PartialEq)]
pub enum OneOrThree<T = Quantity> {
    /// About y.
    One(T),
    /// One per axis.
    List(Vec<T>),
}

impl<T: Shape> Shape for OneOrThree<T> {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::List(_) => Vec::<T>::check(at, problems),
            _ => T::check(at, problems),
        }
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for OneOrThree<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_yaml::Value::deserialize(deserializer)?;
        if value.is_sequence() {
            Vec::deserialize(value).map(OneOrThree::List)
        } else {
            T::deserialize(value).map(OneOrThree::One)
        }
        .map_err(de::Error::custom)
    }
}
