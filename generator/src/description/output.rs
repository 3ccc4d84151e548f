//! Outputs as written: the columns of the table.

use super::place::At;
use super::point::Point;
use super::schema::{Schema, any_of};
use super::shape::{Misfit, Named, Problems, Shape, check_record, record, words};
use super::short_forms::Each;
use serde_yaml::Value;

record! {
    /// A column of the table.
    Output as "an output" {
        /// heading of the column, unique; at most 80 characters
        name: String,
        /// `false` leaves the output out
        enabled: Option<bool> = "`true`",
        /// the thing that has the quantity, as in the table above; or a [list](#several-outputs-in-one)
        of: Each<String>,
        /// which quantity, as in the table above
        what: String,
        /// point of an element: `cg`, or coordinates in the local frame
        at: Option<Point> = "`cg`, of a vehicle its origin",
        /// of a vector: `x`, `y`, `z` or `resultant`, or a [list](#several-outputs-in-one) of these. For `angle` in
        /// space there is no default: `x`, `y` or `z` is the first, second or third Bryant angle, `resultant` the angle
        /// of the single turn that leads to the same orientation, 0 to 180°
        component: Option<Each<Component>> = "`resultant`",
        /// the body whose axes are `x`, `y` and `z`: `frame` for the absolute axes, `local` for those of the body in
        /// `of` or of the body that the force acts on, or a body by its name
        axes: Option<String> = "those of `relative_to`",
        /// the body that carries [the observer](#seen-from-a-body)
        relative_to: Option<String> = "`frame`",
        /// for a joint, a contact, a belt, a spring, a bushing or an airbag: the body that the force acts on; see
        /// [signs](#signs)
        on: Option<String> = "the first body",
        /// required for a belt with [rings](#a-ring): which segment, counted from 1 at its end `from`
        segment: Option<u32>,
        /// required for the `slip` of a belt: the name of the ring
        ring: Option<String>,
        /// required for a joint in space: `x`, `y` or `z`, the first, second or third relative angle; for a joint force
        /// also `flexion` or `torsion`
        about: Option<Axis> = "none in the plane",
        /// required for a [joint](#a-joint) with several freedoms: which one
        freedom: Option<String>,
        /// channel code of ISO-MME, 16 capital letters and digits, for `bryant run --mme` and criteria; if its 15th
        /// character is X, Y or Z, the column has the [axes and signs of SAE J211-1](criteria.md#axes-and-signs), and
        /// the `axes` of a sensor are `local`; with several components the 15th character is `?` and becomes X, Y, Z or
        /// R; a mirror image has RI for LE, or LE for RI
        code: Option<String>,
        /// `CFC60`, `CFC180`, `CFC600` or `CFC1000`: the [filter](compare.md#filters) of ISO 6487, or, as `SAE CFC180`,
        /// that of SAE J211-1. The table, files, plots, responses and studies apply it. A resultant itself is not
        /// filtered; its components are. The generated code, `bryant accuracy` and `bryant effects` use unfiltered
        /// values
        filter: Option<Class>,
        /// the [unit](#units-of-outputs) in which it is shown, such as `mm`, `g`, `kN*m` or `km/h`
        unit: Option<String> = "that of the model's `units`",
        /// `true` adds the output of the [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    }
}

record! {
    /// A column that is computed from others.
    Formula as "an output with a formula" {
        /// heading of the column, unique; at most 80 characters
        name: String,
        /// `false` leaves the output out
        enabled: Option<bool> = "`true`",
        /// the arithmetic
        formula: String,
        /// words of the formula, each with the name of the output that it stands for: `{ v: relative velocity }`
        with: Option<Named<String>>,
        /// the [unit](#units-of-outputs) in which it is shown
        unit: Option<String> = "that of the model's `units`",
    }
}

/// A column of the table: measured, or computed from others.
#[derive(Clone, Debug)]
pub enum Column {
    /// Measured.
    Output(Box<Output>),
    /// Computed.
    Formula(Formula),
}

impl Column {
    /// Its heading.
    pub fn name(&self) -> &str {
        match self {
            Column::Output(output) => &output.name,
            Column::Formula(formula) => &formula.name,
        }
    }
}

impl Shape for Column {
    fn schema(to: &mut Schema) -> Value {
        any_of([Output::schema(to), Formula::schema(to)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match at.node.get("formula") {
            Some(_) => check_record::<Formula>(at, problems),
            None => check_record::<Output>(at, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.get("formula") {
            Some(_) => Formula::read(value).map(Column::Formula),
            None => Output::read(value).map(Box::new).map(Column::Output),
        }
    }
}

words! {
    /// Component of a vector.
    Component {
        /// Along x, or the first angle.
        X = "x",
        /// Along y, or the second angle.
        Y = "y",
        /// Along z, or the third angle.
        Z = "z",
        /// The length of the vector.
        Resultant = "resultant",
    }
}

words! {
    /// A channel frequency class of ISO 6487, or of SAE J211-1.
    Class {
        /// 60
        Cfc60 = "CFC60",
        /// 180
        Cfc180 = "CFC180",
        /// 600
        Cfc600 = "CFC600",
        /// 1000
        Cfc1000 = "CFC1000",
        /// 60
        Sae60 = "SAE CFC60",
        /// 180
        Sae180 = "SAE CFC180",
        /// 600
        Sae600 = "SAE CFC600",
        /// 1000
        Sae1000 = "SAE CFC1000",
    }
}

impl Class {
    /// As it is written, and the number of the class.
    pub fn said(self) -> (&'static str, u16) {
        match self {
            Class::Cfc60 => ("CFC60", 60),
            Class::Cfc180 => ("CFC180", 180),
            Class::Cfc600 => ("CFC600", 600),
            Class::Cfc1000 => ("CFC1000", 1000),
            Class::Sae60 => ("SAE CFC60", 60),
            Class::Sae180 => ("SAE CFC180", 180),
            Class::Sae600 => ("SAE CFC600", 600),
            Class::Sae1000 => ("SAE CFC1000", 1000),
        }
    }
}

words! {
    /// A relative rotation of a joint.
    Axis {
        /// The first relative angle.
        X = "x",
        /// The second.
        Y = "y",
        /// The third.
        Z = "z",
        /// The angle between the long axes.
        Flexion = "flexion",
        /// The turn about them.
        Torsion = "torsion",
    }
}
