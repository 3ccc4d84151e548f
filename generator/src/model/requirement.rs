//! Requirements on the numbers of a model, each as one sentence. Requirements on constants are checked when the model
//! is read, those on parameters before every run, with the same words.
//!
//! Each number of a law has its own rule in [`part`](super::part). Requirements on several numbers together are here,
//! each as one expression of these numbers.

use super::coefficient::Hysteresis;
use super::curve::{Curve, ScaledCurve};
use super::dimension::Dimension;
use super::force::Force;
use super::mechanism::Model;
use super::number::Number;
use super::part::{Field, Part};
use super::rule::{Rule, Ruled};
use super::switch::Switch;
use super::system::{Element, Reference, System, Vehicle};
use super::unloading;

/// Relative excess of a principal moment over the sum of the others that counts as rounding: for a flat body they are
/// equal.
pub(crate) const ROUNDING: f64 = 1e-9;

/// A requirement on one number, or on several together.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// The requirement in words: "`damping` of contact "floor" must not be negative".
    pub sentence: String,
    /// The path of the key to which the requirement belongs, below the force or the element.
    pub path: String,
    /// The number, or an expression of several.
    pub value: Number,
    /// The rule that the value must keep.
    pub rule: Rule,
    /// A remedy if the requirement is broken.
    pub help: &'static str,
    /// True if the value is a number as written, so that messages may show it.
    pub written: bool,
}

/// Returns a curve, given its index; `None` if the curve is wrong.
pub type Curves<'a> = &'a dyn Fn(usize) -> Option<&'a Curve>;

/// The requirements of one owner: "contact "floor"", "man/head".
pub struct List<'a> {
    owner: &'a str,
    found: Vec<Requirement>,
}

impl List<'_> {
    /// Adds a requirement on a number as written.
    pub(crate) fn number(&mut self, path: String, value: &Number, rule: Rule) {
        self.found.push(Requirement {
            sentence: format!("`{path}` of {} {}", self.owner, rule.words()),
            path,
            value: value.clone(),
            rule,
            help: rule.help(),
            written: true,
        });
    }

    /// Adds a requirement on several numbers together; `must` follows the name of the owner in the sentence.
    pub(crate) fn together(
        &mut self,
        path: &str,
        must: &str,
        value: Number,
        rule: Rule,
        help: &'static str,
    ) {
        self.found.push(Requirement {
            sentence: format!("`{path}` of {} {must}", self.owner),
            path: path.to_owned(),
            value,
            rule,
            help,
            written: false,
        });
    }

    pub(crate) fn ruled(&mut self, term: &str, of_term: Rule, numbers: Vec<Ruled<'_>>) {
        for Ruled { rule, key, number } in numbers {
            self.number(key.path(term), number, rule.unwrap_or(of_term));
        }
    }
}

impl Model {
    /// All requirements of the model.
    pub fn requirements(&self) -> Vec<Requirement> {
        let mut all = Vec::new();
        all.extend(self.vehicles.iter().flat_map(Vehicle::requirements));
        all.extend(self.systems.iter().flat_map(System::requirements));
        for system in &self.systems {
            for element in &system.elements {
                let owner = format!("{}/{}", system.name, element.name);
                all.extend(element.requirements(&owner, self.dimension));
            }
        }
        let curve = |index: usize| self.curves.get(index);
        for force in &self.forces {
            all.extend(force.requirements(self.dimension, &curve));
        }
        all.extend(self.switches.iter().flat_map(Switch::requirements));
        all
    }
}

impl Vehicle {
    /// Requirements on the curves of a vehicle.
    pub fn requirements(&self) -> Vec<Requirement> {
        let owner = format!("vehicle \"{}\"", self.name);
        let mut list = List {
            owner: &owner,
            found: Vec::new(),
        };
        let mut vehicle = self.clone();
        for curve in &mut vehicle.translation.curves {
            list.ruled("motion", Rule::Finite, curve.numbers());
        }
        for angle in &mut vehicle.angles {
            list.ruled("angles", Rule::Finite, angle.numbers());
        }
        list.found
    }
}

impl System {
    /// Requirements on the curves of a reference joint.
    pub fn requirements(&self) -> Vec<Requirement> {
        let owner = format!("system \"{}\"", self.name);
        let mut list = List {
            owner: &owner,
            found: Vec::new(),
        };
        if let Reference::Prescribed(translation) = &self.reference {
            for curve in &mut translation.clone().curves {
                list.ruled("reference", Rule::Finite, curve.numbers());
            }
        }
        list.found
    }
}

impl Switch {
    /// Requirements on a switch.
    pub fn requirements(&self) -> Vec<Requirement> {
        let owner = format!("switch \"{}\"", self.name);
        let mut list = List {
            owner: &owner,
            found: Vec::new(),
        };
        if let Some(after) = &self.after {
            list.number("after".into(), after, Rule::NotNegative);
        }
        list.found
    }
}

impl Element {
    /// Requirements on an element, which sentences call `owner`.
    pub fn requirements(&self, owner: &str, dimension: Dimension) -> Vec<Requirement> {
        let mut list = List {
            owner,
            found: Vec::new(),
        };
        list.number("mass".into(), &self.mass, Rule::Positive);
        for freedom in self.joint.freedoms() {
            list.number("armature".into(), &freedom.armature, Rule::NotNegative);
            if freedom
                .axis
                .iter()
                .any(|component| component.constant().is_none())
            {
                // the axis is divided by its length, which fails if squares overflow or underflow
                let squares = freedom
                    .axis
                    .each_ref()
                    .map(|a| Number::product(a.clone(), a.clone()));
                list.together(
                    "joint",
                    "must have an axis with a direction",
                    Number::difference(
                        squares.into_iter().fold(Number::ZERO, Number::sum),
                        0.5.into(),
                    ),
                    Rule::Positive,
                    "give components of which one at least is not 0, between 1e-100 and 1e100",
                );
            }
        }
        match dimension {
            Dimension::Plane => {
                list.number("inertia".into(), &self.inertia[1], Rule::NotNegative);
            }
            Dimension::Space => {
                for (index, moment) in self.inertia.iter().enumerate() {
                    list.number(format!("inertia[{index}]"), moment, Rule::NotNegative);
                }
                let sum = self.inertia.iter().cloned().fold(Number::ZERO, Number::sum);
                let sum = Number::product((1.0 + ROUNDING).into(), sum);
                for moment in &self.inertia {
                    let twice = Number::product(2.0.into(), moment.clone());
                    list.together(
                        "inertia",
                        "must have no moment above the sum of the other two",
                        Number::difference(sum.clone(), twice),
                        Rule::NotNegative,
                        "no body has such moments; each principal one is at most the sum of the others",
                    );
                }
            }
        }
        list.found
    }
}

impl Force {
    /// Requirements on a force.
    pub fn requirements(&self, dimension: Dimension, curves: Curves<'_>) -> Vec<Requirement> {
        let mut kind = self.law.clone();
        let owner = format!("{} \"{}\"", kind.key(), self.name);
        let mut list = List {
            owner: &owner,
            found: Vec::new(),
        };
        self.law.require_first(dimension, &mut list);
        for field in kind.fields(dimension) {
            match field {
                Field::Body(_) => {}
                Field::Number(path, rule, number) => list.number(path, number, rule),
                Field::Term(term, part) => list.ruled(&term.keys[0], term.rule, part.numbers()),
            }
        }
        self.law.require(dimension, curves, &mut list);
        list.found
    }
}

/// Requirements on unloading, for all laws.
impl List<'_> {
    /// Adds the requirements on unloading: its curve lies nowhere above the loading curve.
    pub(crate) fn hysteresis(
        &mut self,
        key: &str,
        loading: &ScaledCurve,
        law: &Hysteresis,
        curves: Curves<'_>,
    ) {
        let Some(f) = curves(loading.curve) else {
            return;
        };
        self.steep((f, loading), law, "", curves);
        let u = law.unloading.as_ref();
        let u = u.and_then(|scaled| Some((curves(scaled.curve)?, scaled)));
        let Some((u, scaled)) = u else { return };
        let must = format!("must lie at or below `{key}` everywhere");
        for clearance in unloading::clearances((u, scaled), (f, loading)) {
            self.together(
                "unloading",
                &must,
                clearance,
                Rule::NotNegative,
                "unloading gives back at most what loading took: let its curve lie at or below the other everywhere",
            );
        }
    }

    /// Adds the requirement that the line between two curves is at least as steep as both.
    pub(crate) fn steep(
        &mut self,
        loading: (&Curve, &ScaledCurve),
        law: &Hysteresis,
        below: &str,
        curves: Curves<'_>,
    ) {
        let u = law.unloading.as_ref();
        let u = u.and_then(|scaled| Some((curves(scaled.curve)?, scaled)));
        let mut steep = vec![loading];
        steep.extend(u);
        for (curve, scaled) in steep {
            for slope in unloading::steepest(curve) {
                let slope = Number::product(slope.into(), scaled.times.clone());
                let slope = Number::quotient(slope, scaled.stretch.clone());
                self.together(
                    &format!("{below}unloading_slope"),
                    "must be at least as steep as both curves",
                    Number::difference(law.slope.clone(), slope),
                    Rule::NotNegative,
                    "give an `unloading_slope` at least as steep as both curves, or leave it out for ten times that of loading",
                );
            }
        }
    }
}
