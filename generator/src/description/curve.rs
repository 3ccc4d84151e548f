//! Curves as written, and the places where one is used.

use super::measure::{OfItsUse, OfTheFactor, Positive, Pure};
use super::place::At;
use super::quantity::{Number, Quantity};
use super::schema::{Schema, any_of};
use super::shape::{In, Misfit, Problems, Record, Shape, check_record, record, words};
use super::tree::{Node, NodeKind};
use serde_yaml::Value;
use std::ops::Deref;

record! {
    /// A function through points.
    Curve as "a curve" {
        /// units of abscissa and ordinate for the bare numbers in `points` or in the file; `1` for a pure number
        unit: Option<Vec<Quantity>> = "SI, or those in the headings of the file",
        /// `[abscissa, ordinate]`, at least two, abscissae increasing; numbers, not parameters
        points: Option<Vec<Vec<Number<OfItsUse>>>> = "required without `file`",
        /// a text file with the points, its path relative to this file; see [curves from files](#curves-from-files)
        file: Option<String>,
        /// abscissa and ordinate in the file: headings, or numbers of columns
        columns: Option<Vec<Quantity>> = "`[1, 2]`",
        /// a test in ISO-MME with the points as one of its channels, `TEST.mme`, relative to this file; see [curves
        /// from files](#curves-from-files)
        mme: Option<String>,
        /// the code of the channel, or its name in words
        channel: Option<String> = "required with `mme`",
        /// between the points: `linear` draws straight lines, `cubic` a smooth curve
        interpolate: Option<Interpolate> = "`linear`",
        /// beyond the first and the last point: `linear` goes on with the outermost segment, `hold` keeps the outermost
        /// value, `error` makes leaving the range a failure of the run
        extrapolate: Option<Extrapolate> = "`hold`",
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
        /// name of the curve, or the curve itself: `{ curve: { points: [[0, 0], [0.1, 1]] }, times: belt_stiffness }`
        curve: NameOrCurve,
        /// factor on the ordinate
        times: Option<Number<OfTheFactor>> = "1",
        /// factor on the abscissa: 2 makes a pulse of 80 ms one of 160 ms
        stretch: Option<Number<Positive<Pure>>> = "1",
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
    fn schema(to: &mut Schema) -> Value {
        any_of([String::schema(to), Curve::schema(to)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            NodeKind::Map(_) => check_record::<Curve>(at, problems),
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

/// A function that is a curve: by name, scaled, or written in place. Derefs to it.
#[derive(Clone, Debug)]
pub struct NoConstant(Function);

impl Deref for NoConstant {
    type Target = Function;
    fn deref(&self) -> &Function {
        &self.0
    }
}

impl Shape for NoConstant {
    fn schema(to: &mut Schema) -> Value {
        to.define("a function that is a curve", |to| {
            any_of([
                String::schema(to),
                ScaledCurve::schema(to),
                Curve::schema(to),
            ])
        })
    }

    // a constant is refused with the rest of what its place means
    fn check(at: At<'_>, problems: &Problems) {
        Function::check(at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        Function::read(value).map(NoConstant)
    }
}

/// A function of `X`, measured in `Y`.
pub type FunctionOf<X, Y> = In<NoConstant, (X, Y)>;

/// A number, or a function of the time \[s\], measured in `Y`.
pub type OverTime<Y> = In<Function, Y>;

impl Shape for Function {
    fn schema(to: &mut Schema) -> Value {
        to.define("a function", |to| {
            any_of([
                Quantity::schema(to),
                ScaledCurve::schema(to),
                Curve::schema(to),
            ])
        })
    }

    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            NodeKind::Map(_) if at.node.get("param").is_some() => Quantity::check(at, problems),
            NodeKind::Map(_) if at.node.get("curve").is_some() => {
                check_record::<ScaledCurve>(at, problems);
            }
            NodeKind::Map(_) => check_record::<Curve>(at, problems),
            NodeKind::Scalar { .. } => Quantity::check(at, problems),
            NodeKind::List(_) => problems.add(at.problem(
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
    let NodeKind::Map(entries) = &node.kind else {
        return false;
    };
    let keys = Curve::keys();
    let known = |key: &str| keys.iter().any(|k| k.name == key);
    let named = node.get("file").is_some() || node.get("mme").is_some();
    named && entries.iter().all(|entry| known(&entry.key))
}
