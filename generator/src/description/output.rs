//! Outputs as written: the columns of the table.

use super::place::At;
use super::point::Point;
use super::shape::{Misfit, Named, Problems, Shape, check_record, record, words};
use super::short::Each;
use serde_yaml::Value;

record! {
    /// A column of the table.
    Output as "an output" {
        /// Heading, unique.
        name: String,
        /// Whether it is shown.
        enabled: Option<bool>,
        /// What is looked at: `man/head`, `joint man/head`, `contact seat`, `belt chest`, `man`.
        of: Each<String>,
        /// What of it.
        what: String,
        /// The point of an element, local frame \[m\].
        at: Option<Point>,
        /// Which component of a vector.
        component: Option<Each<Component>>,
        /// The body along whose axes: `frame`, `local`, a vehicle or an element.
        axes: Option<String>,
        /// The body that the observer rides on.
        relative_to: Option<String>,
        /// Of a joint, a contact or a belt: the body on which the force acts.
        on: Option<String>,
        /// Of a belt that runs through rings: which segment, counted from its end `from`.
        segment: Option<u32>,
        /// Of a belt that runs through rings: which ring.
        ring: Option<String>,
        /// In space: which relative rotation of a joint.
        about: Option<Axis>,
        /// Of a joint with several freedoms of its own: which.
        freedom: Option<String>,
        /// Its channel code in ISO-MME, 16 characters; of several components with `?` for the direction.
        code: Option<String>,
        /// The channel frequency class that it is filtered by.
        filter: Option<Class>,
        /// The unit in which it is shown.
        unit: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
    }
}

record! {
    /// A column that is computed from others.
    Formula as "an output with a formula" {
        /// Heading, unique.
        name: String,
        /// Whether it is shown.
        enabled: Option<bool>,
        /// Arithmetic of outputs above it, parameters and numbers with their units.
        formula: String,
        /// Words of the formula and the outputs that they stand for.
        with: Option<Named<String>>,
        /// The unit in which it is shown.
        unit: Option<String>,
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
