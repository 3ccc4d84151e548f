//! Curves as written, and the places where one is used.

use super::place::At;
use super::quantity::Quantity;
use super::shape::{Misfit, Problems, Record, Shape, check_record, record, words};
use super::tree::{Kind, Node};
use serde_yaml::Value;

record! {
    /// A function through points.
    Curve as "a curve" {
        /// Units of abscissa and ordinate for the bare numbers in `points` or in the file.
        unit: Option<Vec<Quantity>>,
        /// `[abscissa, ordinate]`, abscissae increasing.
        points: Option<Vec<Vec<Quantity>>>,
        /// A text file with the points, relative to this one.
        file: Option<String>,
        /// Abscissa and ordinate in the file: headings, or numbers from 1.
        columns: Option<Vec<Quantity>>,
        /// A test in ISO-MME with the points as one of its channels, `TEST.mme`, relative to this file.
        mme: Option<String>,
        /// The code of the channel.
        channel: Option<String>,
        /// What holds between the points.
        interpolate: Option<Interpolate>,
        /// What holds beyond the first and the last point.
        extrapolate: Option<Extrapolate>,
    }
}

words! {
    /// What holds between the points of a curve.
    Interpolate {
        /// Lines.
        Linear = "linear",
        /// Cubics, monotone where the points are.
        Cubic = "cubic",
    }
}

words! {
    /// What holds beyond the points of a curve.
    Extrapolate {
        /// The outermost segment goes on.
        Linear = "linear",
        /// The outermost value stays.
        Hold = "hold",
        /// The run fails.
        Error = "error",
    }
}

record! {
    /// A named curve with factors.
    ScaledCurve as "a scaled curve" {
        /// Name of the curve, or the curve itself.
        curve: NameOrCurve,
        /// Factor on its ordinate.
        times: Option<Quantity>,
        /// Factor on its abscissa.
        stretch: Option<Quantity>,
    }
}

/// A curve by name, or written in place.
#[derive(Clone, Debug)]
pub enum NameOrCurve {
    /// Its name.
    Name(String),
    /// Written in place.
    Inline(Curve),
}

impl Shape for NameOrCurve {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::Map(_) => check_record::<Curve>(at, problems),
            _ => String::check(at, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.is_mapping() {
            true => Curve::read(value).map(NameOrCurve::Inline),
            false => String::read(value).map(NameOrCurve::Name),
        }
    }
}

/// A function where one is used: by name, scaled, written in place, or a constant.
#[derive(Clone, Debug)]
pub enum Function {
    /// A number, or a text: the name of a curve or an expression.
    Quantity(Quantity),
    /// A curve and a factor.
    Scaled(ScaledCurve),
    /// Written in place.
    Inline(Curve),
}

impl Shape for Function {
    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            Kind::Map(_) if at.node.get("param").is_some() => Quantity::check(at, problems),
            Kind::Map(_) if at.node.get("curve").is_some() => {
                check_record::<ScaledCurve>(at, problems);
            }
            Kind::Map(_) => check_record::<Curve>(at, problems),
            Kind::Scalar { .. } => Quantity::check(at, problems),
            Kind::List(_) => problems.add(at.problem(
                "here stands a list, but a curve is needed",
                "write the name of a curve, or `{ points: [[0, 0], [1, 10]] }`",
            )),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        if !value.is_mapping() || value.get("param").is_some() {
            Quantity::read(value).map(Function::Quantity)
        } else if value.get("curve").is_some() {
            ScaledCurve::read(value).map(Function::Scaled)
        } else {
            Curve::read(value).map(Function::Inline)
        }
    }
}

/// True of a mapping that is a curve with its points in a file.
pub fn has_file(node: &Node) -> bool {
    let Kind::Map(entries) = &node.kind else {
        return false;
    };
    let known = |key: &str| Curve::KEYS.iter().any(|k| k.name == key);
    let named = node.get("file").is_some() || node.get("mme").is_some();
    named && entries.iter().all(|entry| known(&entry.key))
}
