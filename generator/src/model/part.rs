//! The constituents of a law: its bodies, its numbers, and its terms, each of which may be absent.
//!
//! law = geometry + Σ terms. A term is one summand of the force, which exists because of a coefficient or a curve.
//!
//! They follow from the declaration of the law ([`declared`](super::declared)). The vocabulary of effects, the normal
//! form of a model, and the scene with nothing left out know nothing of a law but these.

use super::body::{Attachment, Body};
use super::coefficient::{Bristle, FieldComponent, Friction, Hysteresis};
use super::curve::{Curve, Extrapolate, Interpolate, ScaledCurve};
use super::dimension::Dimension;
use super::mechanism::Parameter;
use super::number::Number;
use super::rule::Rule;
use super::rule::Ruled;

/// A constituent of a law.
pub enum Field<'a> {
    /// A body that the law acts on.
    Body(Body),
    /// A number of the geometry, which is always present: the path of its key, its rule, the number.
    Number(String, Rule, &'a mut Number),
    /// A term, which may be absent.
    Term(Term, &'a mut dyn Part),
}

/// Name and rules of a term.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    /// The name for users: "friction", in space with its axis: "friction about x".
    pub name: String,
    /// The key below the force: `friction`, `about.x.friction`, `acceleration[0]`. Further keys are other ways to write
    /// the same term.
    pub keys: Vec<String>,
    /// The term without which this one has no effect; empty if this term acts alone.
    pub needs: &'static str,
    /// The rule for the term's number, if the number has no rule of its own.
    pub rule: Rule,
    /// True if the term cannot be present with a coefficient of 0; it is then not added to a scene that does not have
    /// it.
    pub as_written: bool,
}

impl Term {
    pub(crate) fn new(name: impl Into<String>, key: impl Into<String>, rule: Rule) -> Self {
        Term {
            name: name.into(),
            keys: vec![key.into()],
            needs: "",
            rule,
            as_written: false,
        }
    }

    pub(crate) fn only_as_written(self) -> Self {
        Term {
            as_written: true,
            ..self
        }
    }

    pub(crate) fn needs(self, needs: &'static str) -> Self {
        Term { needs, ..self }
    }
}

/// A part of a law that may be absent.
pub trait Part {
    /// True if the part is present and not 0 for every motion.
    fn is_in(&self) -> bool;
    /// Makes it absent.
    fn leave_out(&mut self);
    /// Makes an absent part present, with run-time parameters in place of all numbers that would be 0.
    fn put_in(&mut self, fresh: &mut Fresh<'_>);
    /// The reason for the part to be out although it is written, as a clause.
    fn zero(&self) -> &'static str {
        "the coefficient is 0"
    }
    /// Its numbers, with the rule of each.
    fn numbers(&mut self) -> Vec<Ruled<'_>>;
    /// The curves that it uses.
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        Vec::new()
    }
}

impl Part for Option<Number> {
    fn is_in(&self) -> bool {
        self.as_ref().is_some_and(|n| !n.is_zero())
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, fresh: &mut Fresh<'_>) {
        self.get_or_insert_with(|| fresh.number(0.0));
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        self.iter_mut().map(Ruled::of_term).collect()
    }
}

impl Part for Option<Friction> {
    fn is_in(&self) -> bool {
        self.as_ref().is_some_and(|f| !f.limit.is_zero())
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, fresh: &mut Fresh<'_>) {
        self.get_or_insert_with(|| Friction {
            limit: fresh.number(0.0),
            tolerance: fresh.number(0.1),
        });
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let Some(Friction { limit, tolerance }) = self else {
            return Vec::new();
        };
        vec![
            Ruled::itself(Rule::NotNegative, limit),
            Ruled::beside("friction_speed", Rule::Positive, tolerance),
        ]
    }
}

impl Part for ScaledCurve {
    fn is_in(&self) -> bool {
        !self.times.is_zero()
    }
    fn leave_out(&mut self) {
        self.times = Number::ZERO;
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn zero(&self) -> &'static str {
        "the curve is 0 everywhere"
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let ScaledCurve {
            curve: _,
            times,
            stretch,
            stiffness,
        } = self;
        if *stiffness {
            return vec![Ruled::beside("stiffness", Rule::NotNegative, times)];
        }
        vec![
            Ruled::below("times", Rule::Finite, times),
            Ruled::below("stretch", Rule::Positive, stretch),
        ]
    }
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        vec![self]
    }
}

impl Part for Option<ScaledCurve> {
    fn is_in(&self) -> bool {
        self.as_ref().is_some_and(Part::is_in)
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, fresh: &mut Fresh<'_>) {
        self.get_or_insert_with(|| fresh.curve());
    }
    fn zero(&self) -> &'static str {
        "the curve is 0 everywhere"
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        self.iter_mut().flat_map(Part::numbers).collect()
    }
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        self.iter_mut().collect()
    }
}

impl Part for FieldComponent {
    fn is_in(&self) -> bool {
        match self {
            FieldComponent::Constant(number) => !number.is_zero(),
            FieldComponent::Curve(curve) => curve.is_in(),
        }
    }
    fn leave_out(&mut self) {
        *self = FieldComponent::Constant(Number::ZERO);
    }
    fn put_in(&mut self, fresh: &mut Fresh<'_>) {
        if !self.is_in() {
            *self = FieldComponent::Constant(fresh.number(0.0));
        }
    }
    fn zero(&self) -> &'static str {
        "the component is 0"
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        match self {
            FieldComponent::Constant(number) => vec![Ruled::itself(Rule::Finite, number)],
            FieldComponent::Curve(curve) => curve.numbers(),
        }
    }
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        match self {
            FieldComponent::Constant(_) => Vec::new(),
            FieldComponent::Curve(curve) => vec![curve],
        }
    }
}

impl Part for Option<FieldComponent> {
    fn is_in(&self) -> bool {
        self.as_ref().is_some_and(Part::is_in)
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        self.iter_mut().flat_map(Part::numbers).collect()
    }
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        self.iter_mut().flat_map(Part::curves).collect()
    }
}

/// The unloading curve, and the steep line that leads to it.
impl Part for Option<Hysteresis> {
    fn is_in(&self) -> bool {
        self.is_some()
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let Some(Hysteresis {
            unloading,
            slope,
            foot,
        }) = self
        else {
            return Vec::new();
        };
        let mut numbers = vec![
            Ruled::beside("unloading_slope", Rule::Positive, slope),
            Ruled::beside("unloading_slope", Rule::Finite, foot),
        ];
        numbers.extend(unloading.numbers());
        numbers
    }
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        let unloading = self.iter_mut().map(|law| &mut law.unloading);
        unloading.flat_map(Part::curves).collect()
    }
}

/// The bristle by which friction holds.
impl Part for Option<Bristle> {
    fn is_in(&self) -> bool {
        self.is_some()
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let displacements = self.iter_mut().map(|Bristle { displacement }| displacement);
        displacements
            .map(|number| Ruled::itself(Rule::Positive, number))
            .collect()
    }
}

/// A source of parameters and curves for parts that become present.
pub struct Fresh<'a> {
    /// The parameters of the model, to which new ones are added.
    pub parameters: &'a mut Vec<Parameter>,
    /// The curves of the model, to which a straight line is added if it is needed.
    pub curves: &'a mut Vec<Curve>,
    /// Index of the added line.
    pub line: Option<usize>,
}

impl Fresh<'_> {
    /// A new parameter with this default.
    pub fn number(&mut self, default: f64) -> Number {
        let index = self.parameters.len();
        self.parameters.push(Parameter {
            name: format!("p{}", index + 1),
            default,
            min: None,
            max: None,
            unit: String::new(),
            input: false,
        });
        Number::Parameter(index)
    }

    /// A straight line through 0, scaled by a new parameter that is 0.
    pub fn curve(&mut self) -> ScaledCurve {
        let curve = *self.line.get_or_insert_with(|| {
            self.curves.push(Curve {
                name: "nothing left out".into(),
                points: vec![[-1.0, -1.0], [1.0, 1.0]],
                interpolate: Interpolate::Linear,
                extrapolate: Extrapolate::Linear,
                states_extrapolation: true,
                thinned: None,
            });
            self.curves.len() - 1
        });
        ScaledCurve {
            curve,
            times: self.number(0.0),
            stretch: self.number(1.0),
            stiffness: false,
        }
    }
}

pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

pub(crate) fn attachment<'a>(
    attachment: &'a mut Attachment,
    key: &str,
    fields: &mut Vec<Field<'a>>,
) {
    let Attachment { on, at } = attachment;
    fields.push(Field::Body(*on));
    finite(at, key, fields);
}

/// Adds three numbers with the same key, of any finite value.
pub(crate) fn finite<'a>(numbers: &'a mut [Number; 3], key: &str, fields: &mut Vec<Field<'a>>) {
    let numbers = numbers.iter_mut();
    fields.extend(numbers.map(|number| Field::Number(key.to_owned(), Rule::Finite, number)));
}

/// Adds the components of a vector that exist in this dimension.
pub(crate) fn components<'a>(
    components: &'a mut [FieldComponent; 3],
    name: &str,
    key: &str,
    dimension: Dimension,
    fields: &mut Vec<Field<'a>>,
) {
    let mut place = 0;
    for (axis, component) in components.iter_mut().enumerate() {
        if dimension == Dimension::Plane && axis == 1 {
            continue;
        }
        let (name, key) = (format!("{name}{}", AXES[axis]), format!("{key}[{place}]"));
        fields.push(Field::Term(Term::new(name, key, Rule::Finite), component));
        place += 1;
    }
}
