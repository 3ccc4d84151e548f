//! A point of an element as written: `cg`, or its coordinates in the local frame.

use super::measure::Length;
use super::place::At;
use super::quantity::Number;
use super::schema::{Schema, any_of, words};
use super::shape::{Misfit, Problems, Shape};
use super::tree::NodeKind;
use serde_yaml::Value;

/// A point of an element.
#[derive(Clone, Debug)]
pub enum Point {
    /// The centre of gravity.
    Cg,
    /// In the local frame \[m\].
    At(Vec<Number<Length>>),
}

impl Shape for Point {
    fn unit() -> String {
        Vec::<Number<Length>>::unit()
    }

    fn schema(to: &mut Schema) -> Value {
        any_of([words(&["cg"]), Vec::<Number<Length>>::schema(to)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            NodeKind::List(_) => Vec::<Number<Length>>::check(at, problems),
            NodeKind::Scalar { text, .. } if text == "cg" => {}
            _ => problems.add(at.problem(
                format!("here stands {}, but a point is needed", at.node.article()),
                "write `cg` for the centre of gravity, or coordinates in the local frame such as `[0, 0.1]`",
            )),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.as_str() {
            Some("cg") => Ok(Point::Cg),
            _ => Vec::read(value).map(Point::At),
        }
    }
}
