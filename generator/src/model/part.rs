//! What a law is made of: its bodies, its numbers, and its terms, each of which may be absent.
//!
//! law = geometry + Σ terms, a term being one summand of the force that a coefficient or a curve calls for
//!
//! Every struct of a law is taken apart here without `..`: a field that is added to one does not compile until it is
//! said here what it is. What is said here is all that the vocabulary of effects, the normal form of a model and the
//! scene with nothing left out know of a law.

use super::rule::{Key, Rule, Ruled};
use super::{
    Against, Airbag, Attachment, Belt, BeltLength, Bending, Body, Bristle, Contact, Curve,
    Dimension, Drive, EdgeRule, Element, Ellipsoid, Extent, Extrapolate, FieldComponent, Filled,
    Follows, ForceKind, Freedom, Friction, Hysteresis, Inflow, Interpolate, JointTorque, Load,
    Lock, Model, Number, Output, Parameter, Plane, Port, Pretensioner, Quantity, Reference,
    Retractor, Ring, ScaledCurve, Spring, Stop, Switch, System, Translation, Trigger, User,
    UserFreedom, UserFunction, UserLine, UserParameter, UserQuantity, UserState, Vehicle,
};

/// Something of a law.
pub enum Field<'a> {
    /// A body that feels it.
    Body(Body),
    /// A number of its geometry, always there: the path of its key, what it may be, and it.
    Number(String, Rule, &'a mut Number),
    /// A term, which may be absent.
    Term(Term, &'a mut dyn Part),
}

/// What a term is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    /// For people: "friction", in space with its axis: "friction about x".
    pub name: String,
    /// Its key below the force: `friction`, `about.x.friction`, `acceleration[0]`; further ones say the same in another way.
    pub keys: Vec<String>,
    /// What has to be there for it to do anything; empty where it acts alone.
    pub needs: &'static str,
    /// What its number may be, where it is one that does not say so itself.
    pub rule: Rule,
    /// True for what cannot be there with a coefficient of 0, and so is not added to a scene that does not have it.
    pub as_written: bool,
}

impl Term {
    fn new(name: impl Into<String>, key: impl Into<String>, rule: Rule) -> Self {
        Term {
            name: name.into(),
            keys: vec![key.into()],
            needs: "",
            rule,
            as_written: false,
        }
    }

    fn only_as_written(self) -> Self {
        Term {
            as_written: true,
            ..self
        }
    }

    fn needs(self, needs: &'static str) -> Self {
        Term { needs, ..self }
    }
}

/// A part of a law that may be absent.
pub trait Part {
    /// True where it is there and not 0 whatever the motion.
    fn is_in(&self) -> bool;
    /// Makes it absent.
    fn leave_out(&mut self);
    /// Makes it present where it is absent: run-time parameters take the place of all that would be 0.
    fn put_in(&mut self, fresh: &mut Fresh<'_>);
    /// What is 0 where it is written, but out.
    fn zero(&self) -> &'static str {
        "the coefficient is 0"
    }
    /// Its numbers, and what each may be.
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

/// The untensioned length; absent where the belt is just taut at the start.
impl Part for BeltLength {
    fn is_in(&self) -> bool {
        match self {
            BeltLength::Given(_) => true,
            BeltLength::Slack(number) | BeltLength::Pretension(number) => !number.is_zero(),
        }
    }
    fn leave_out(&mut self) {
        *self = BeltLength::Slack(Number::ZERO);
    }
    fn put_in(&mut self, fresh: &mut Fresh<'_>) {
        if !self.is_in() {
            *self = BeltLength::Slack(fresh.number(0.0));
        }
    }
    fn zero(&self) -> &'static str {
        "the belt is just taut at the start"
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        vec![match self {
            BeltLength::Given(number) => Ruled::itself(Rule::Positive, number),
            BeltLength::Slack(number) => Ruled::beside("slack", Rule::NotNegative, number),
            BeltLength::Pretension(number) => {
                Ruled::beside("pretension", Rule::NotNegative, number)
            }
        }]
    }
}

/// Implements [`Part`] for what is as it is: not 0 where it is written, and not added to a scene that does not have it. Its numbers stand
/// below its key by their names.
macro_rules! as_written {
    ($($part:ident { $($number:ident: $rule:ident),* } { $($optional:ident: $may:ident),* } [$($curve:ident),*] $(- $rest:ident)*;)*) => {$(
        impl Part for Option<$part> {
            fn is_in(&self) -> bool {
                self.is_some()
            }
            fn leave_out(&mut self) {
                *self = None;
            }
            fn put_in(&mut self, _: &mut Fresh<'_>) {}
            fn numbers(&mut self) -> Vec<Ruled<'_>> {
                let mut numbers: Vec<Ruled<'_>> = Vec::new();
                if let Some($part { $($number,)* $($optional,)* $($curve,)* $($rest: _,)* }) = self {
                    $(numbers.push(Ruled::below(stringify!($number), Rule::$rule, $number));)*
                    $(numbers.extend($optional.iter_mut().map(|number| {
                        Ruled::below(stringify!($optional), Rule::$may, number)
                    }));)*
                    $(numbers.extend($curve.numbers().into_iter().map(|number| {
                        number.under(stringify!($curve))
                    }));)*
                }
                numbers
            }
            fn curves(&mut self) -> Vec<&mut ScaledCurve> {
                match self {
                    Some(_part) => {
                        let curves: [Vec<&mut ScaledCurve>; _] = [$(_part.$curve.curves()),*];
                        curves.into_iter().flatten().collect()
                    }
                    None => Vec::new(),
                }
            }
        }
    )*};
}
as_written! {
    Stop { stiffness: NotNegative } {
        from: Finite, to: Finite, damping: NotNegative, damping_angle: NotNegative
    } [];
    Lock { stiffness: NotNegative } { damping: NotNegative } [] - by;
    Retractor { spool: NotNegative } {} [] - lock;
    Pretensioner {} { delay: NotNegative } [retract] - fire;
    Inflow { temperature: Positive } {} [flow] - fire;
    Filled { pressure: Positive, temperature: Positive } {} [];
    Drive { stiffness: NotNegative } { damping: NotNegative, limit: Positive } [to];
}

/// The curve of unloading, and the line that leads to it.
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

/// By what friction holds.
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

/// Where a plane ends.
impl Part for Option<Extent> {
    fn is_in(&self) -> bool {
        self.is_some()
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let Some(Extent { half_lengths, rule }) = self else {
            return Vec::new();
        };
        let one = half_lengths.len() == 1;
        let lengths = half_lengths.iter_mut().enumerate();
        let mut numbers: Vec<Ruled<'_>> = lengths
            .map(|(index, length)| match one {
                true => Ruled::itself(Rule::Positive, length),
                false => Ruled::item(index, Rule::Positive, length),
            })
            .collect();
        match rule {
            EdgeRule::Cut => {}
            EdgeRule::Fade(width) => {
                numbers.push(Ruled::beside("edge.width", Rule::Positive, width));
            }
        }
        numbers
    }
}

/// The function of a user force, with what it is given whatever the motion.
impl Part for UserFunction {
    fn is_in(&self) -> bool {
        !self.name.is_empty()
    }
    fn leave_out(&mut self) {
        *self = UserFunction {
            name: String::new(),
            source: None,
            parameters: Vec::new(),
            curves: Vec::new(),
        };
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn zero(&self) -> &'static str {
        "there is no function"
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let UserFunction {
            name: _,
            source: _,
            parameters,
            curves,
        } = self;
        let mut numbers = Vec::new();
        for Port { name, value } in parameters {
            let UserParameter { value, unit: _ } = value;
            numbers.extend(beside("parameters", name, value.numbers()));
        }
        for Port { name, value } in curves {
            numbers.extend(beside("curves", name, value.numbers()));
        }
        numbers
    }
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        let parameters = self.parameters.iter_mut();
        let mut curves: Vec<&mut ScaledCurve> = parameters
            .flat_map(|port| port.value.value.curves())
            .collect();
        curves.extend(self.curves.iter_mut().flat_map(|port| port.value.curves()));
        curves
    }
}

/// Numbers of a port of a user force, where they stand in the YAML.
fn beside<'a>(
    list: &'a str,
    name: &'a str,
    numbers: Vec<Ruled<'a>>,
) -> impl Iterator<Item = Ruled<'a>> {
    numbers.into_iter().map(move |number| Ruled {
        key: Key::Beside(number.key.path(&format!("{list}.{name}"))),
        ..number
    })
}

/// Where parameters and curves for absent parts come from.
pub struct Fresh<'a> {
    /// The model's parameters; new ones are added.
    pub parameters: &'a mut Vec<Parameter>,
    /// The model's curves; one is added where it is wanted.
    pub curves: &'a mut Vec<Curve>,
    /// The curve added.
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
                told: true,
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

const AXES: [&str; 3] = ["x", "y", "z"];

impl ForceKind {
    /// The key that names a force of this kind.
    pub fn key(&self) -> &'static str {
        match self {
            ForceKind::Joint { .. } | ForceKind::Freedom { .. } => "joint",
            ForceKind::Field { .. } => "field",
            ForceKind::Contact(_) => "contact",
            ForceKind::Belt(_) => "belt",
            ForceKind::Spring(_) => "spring",
            ForceKind::Airbag(_) => "airbag",
            ForceKind::Load(_) => "load",
            ForceKind::User(_) => "user",
        }
    }

    /// Everything of a law but what the dimension does not have.
    pub fn fields(&mut self, dimension: Dimension) -> Vec<Field<'_>> {
        let mut fields = Vec::new();
        match self {
            ForceKind::Joint {
                child,
                about,
                bending,
            } => {
                fields.push(Field::Body(Body::Element(*child)));
                if let Some(bending) = bending {
                    let Bending {
                        axis: _,
                        flexion,
                        torsion,
                    } = &mut **bending;
                    torque(flexion, " of flexion", "flexion.", &mut fields);
                    torque(torsion, " of torsion", "torsion.", &mut fields);
                }
                for (axis, law) in about.iter_mut().enumerate() {
                    match dimension {
                        Dimension::Space => {
                            let (axis, key) = (AXES[axis], format!("about.{}.", AXES[axis]));
                            torque(law, &format!(" about {axis}"), &key, &mut fields);
                        }
                        Dimension::Plane if axis == 1 => torque(law, "", "", &mut fields),
                        Dimension::Plane => {}
                    }
                }
            }
            ForceKind::Freedom {
                child,
                freedom: _,
                law,
            } => {
                fields.push(Field::Body(Body::Element(*child)));
                torque(law, "", "", &mut fields);
            }
            ForceKind::Field { on, acceleration } => {
                fields.extend(on.iter().map(|&id| Field::Body(Body::Element(id))));
                components(acceleration, "", "acceleration", dimension, &mut fields);
            }
            ForceKind::Contact(contact) => contact.fields(dimension, &mut fields),
            ForceKind::Belt(belt) => belt.fields(&mut fields),
            ForceKind::Spring(spring) => spring.fields(&mut fields),
            ForceKind::Airbag(airbag) => airbag.fields(dimension, &mut fields),
            ForceKind::Load(load) => load.fields(dimension, &mut fields),
            ForceKind::User(user) => user.fields(&mut fields),
        }
        fields
    }

    /// Leaves out what cannot do anything without what is absent, and absent parts in any other form.
    pub fn settle(&mut self, dimension: Dimension) {
        for field in self.fields(dimension) {
            if let Field::Term(_, part) = field
                && !part.is_in()
            {
                part.leave_out();
            }
        }
        match self {
            ForceKind::Joint { about, bending, .. } => {
                let bent = bending.iter_mut();
                for law in about
                    .iter_mut()
                    .chain(bent.flat_map(|b| [&mut b.flexion, &mut b.torsion]))
                {
                    law.settle();
                }
                let nothing = JointTorque::default();
                if bending
                    .as_ref()
                    .is_some_and(|b| b.flexion == nothing && b.torsion == nothing)
                {
                    *bending = None;
                }
            }
            ForceKind::Freedom { law, .. } => {
                law.settle();
            }
            ForceKind::Contact(contact) => {
                if contact.elastic.is_none() {
                    contact.hysteresis = None;
                }
                if contact.damping.is_none() {
                    contact.damping_depth = None;
                }
                if contact.elastic.is_none() && contact.damping.is_none() {
                    contact.friction = None;
                }
                if contact.friction.is_none() {
                    contact.bristle = None;
                }
                let idle = contact.elastic.is_none() && contact.damping.is_none();
                if let Against::Plane(plane) = &mut contact.against {
                    if idle {
                        plane.extent = None;
                    }
                    if contact.bristle.is_none() && plane.extent.is_none() {
                        plane.tangent = [Number::ZERO; 3];
                    }
                }
            }
            ForceKind::Belt(belt) => {
                // No length is such that no force is the pretension.
                if !belt.force.is_in() && matches!(belt.length, BeltLength::Pretension(_)) {
                    belt.length.leave_out();
                }
                if !belt.force.is_in() {
                    belt.hysteresis = None;
                }
                if belt.damping.is_none() {
                    belt.damping_stretch = None;
                }
                // The length is what the reel has paid out.
                match belt.retractor {
                    Some(_) => belt.length.leave_out(),
                    None => belt.film_spool = None,
                }
            }
            ForceKind::Load(load) => {
                if !load.force.iter().any(Part::is_in) {
                    load.on.at = [Number::ZERO; 3];
                }
            }
            ForceKind::User(user) => {
                for port in &mut user.function.parameters {
                    if !port.value.value.is_in() {
                        port.value.value.leave_out();
                    }
                }
                for port in &mut user.function.curves {
                    if !port.value.is_in() {
                        port.value.leave_out();
                    }
                }
            }
            ForceKind::Spring(spring) => {
                if spring.elastic.is_none() {
                    spring.length = None;
                }
            }
            ForceKind::Field { .. } | ForceKind::Airbag(_) => {}
        }
    }

    /// The terms, and whether each is in.
    pub fn terms(&self, dimension: Dimension) -> Vec<(Term, bool)> {
        let mut copy = self.clone();
        let fields = copy.fields(dimension).into_iter();
        let terms = fields.filter_map(|field| match field {
            Field::Term(term, part) => Some((term, part.is_in())),
            Field::Body(_) | Field::Number(..) => None,
        });
        terms.collect()
    }

    /// Whether it does anything: a term that acts alone is in.
    pub fn acts(&self, dimension: Dimension) -> bool {
        let mut terms = self.terms(dimension).into_iter();
        terms.any(|(term, is_in)| is_in && term.needs.is_empty())
    }
}

impl JointTorque {
    /// Leaves out what cannot do anything without what is absent.
    fn settle(&mut self) {
        if self.elastic.is_none() {
            self.neutral = None;
            self.hysteresis = None;
        }
        if self.friction.is_none() {
            self.bristle = None;
        }
    }
}

/// The law about one relative rotation.
fn torque<'a>(law: &'a mut JointTorque, about: &str, below: &str, fields: &mut Vec<Field<'a>>) {
    let JointTorque {
        elastic,
        neutral,
        hysteresis,
        damping,
        friction,
        bristle,
        stop,
        lock,
        motor,
        drive,
    } = law;
    let term = |name: &str, key: &str, rule| {
        Term::new(format!("{name}{about}"), format!("{below}{key}"), rule)
    };
    let mut elastics = term("elastic", "elastic", Rule::Finite);
    elastics.keys.push(format!("{below}stiffness"));
    fields.push(Field::Term(elastics, elastic));
    let angle = term("neutral angle", "neutral", Rule::Finite);
    let angle = angle.needs("there is no elastic torque");
    fields.push(Field::Term(angle, neutral));
    let mut unloading = term("hysteresis", "unloading", Rule::Finite);
    unloading.keys.push(format!("{below}unloading_slope"));
    let unloading = unloading.needs("there is no elastic torque");
    fields.push(Field::Term(unloading, hysteresis));
    let dampings = term("damping", "damping", Rule::NotNegative);
    fields.push(Field::Term(dampings, damping));
    let frictions = term("friction", "friction", Rule::NotNegative);
    fields.push(Field::Term(frictions, friction));
    let holds = term("friction holds", "friction_displacement", Rule::Positive);
    let holds = holds.needs("there is no friction");
    fields.push(Field::Term(holds, bristle));
    fields.push(Field::Term(term("stop", "stop", Rule::Finite), stop));
    fields.push(Field::Term(term("lock", "lock", Rule::Finite), lock));
    let motors = term("motor", "motor", Rule::Finite).only_as_written();
    fields.push(Field::Term(motors, motor));
    fields.push(Field::Term(term("drive", "drive", Rule::Finite), drive));
}

impl Contact {
    fn fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Contact {
            ellipsoid,
            semi_axes,
            axes,
            degree: _,
            against,
            elastic,
            hysteresis,
            damping,
            damping_depth,
            friction,
            bristle,
        } = self;
        attachment(ellipsoid, "ellipsoid.center", fields);
        shape(semi_axes, axes, "ellipsoid", dimension, fields);
        let mut edge = None;
        match against {
            Against::Plane(Plane {
                at,
                normal,
                tangent,
                extent,
            }) => {
                attachment(at, "plane.at", fields);
                finite(normal, "plane.normal", fields);
                // without edges and bristles nothing tells one tangent from another
                if extent.is_some() || bristle.is_some() {
                    finite(tangent, "plane.along", fields);
                }
                edge = Some(extent);
            }
            Against::Ellipsoid(Ellipsoid {
                center,
                semi_axes,
                axes,
            }) => {
                attachment(center, "with.center", fields);
                shape(semi_axes, axes, "with", dimension, fields);
            }
        }
        let term = |name: &str, key: &str| Term::new(name, key, Rule::NotNegative);
        let mut elastics = term("elastic", "elastic");
        elastics.keys.push("stiffness".into());
        fields.push(Field::Term(elastics, elastic));
        let mut unloading = term("hysteresis", "unloading").needs("there is no elastic force");
        unloading.keys.push("unloading_slope".into());
        fields.push(Field::Term(unloading, hysteresis));
        fields.push(Field::Term(term("damping", "damping"), damping));
        let fade = term("damping fades in", "damping_depth").needs("there is no damping");
        fields.push(Field::Term(fade.only_as_written(), damping_depth));
        let sliding = term("friction", "friction").needs("nothing presses");
        fields.push(Field::Term(sliding, friction));
        let holds = term("friction holds", "friction_displacement");
        let holds = holds.needs("there is no friction");
        fields.push(Field::Term(holds, bristle));
        if let Some(extent) = edge {
            let ends = term("edge", "plane.extent").needs("nothing presses");
            fields.push(Field::Term(ends, extent));
        }
    }
}

impl Belt {
    fn fields<'a>(&'a mut self, fields: &mut Vec<Field<'a>>) {
        let Belt {
            from,
            to,
            rings,
            force,
            hysteresis,
            damping,
            damping_stretch,
            length,
            retractor,
            film_spool,
            pretensioner,
            limiter,
        } = self;
        attachment(from, "from.at", fields);
        for (index, ring) in rings.iter_mut().enumerate() {
            let Ring {
                name,
                on,
                friction,
                resistance,
            } = ring;
            let key = |key: &str| format!("through[{index}].{key}");
            attachment(on, &key("at"), fields);
            let slips = Field::Number(key("resistance"), Rule::Positive, resistance);
            fields.push(slips);
            let rubs = Term::new(
                format!("friction of ring {name}"),
                key("friction"),
                Rule::NotNegative,
            );
            fields.push(Field::Term(rubs.needs("it has no elastic force"), friction));
        }
        attachment(to, "to.at", fields);
        let name = match length {
            BeltLength::Given(_) => "given length",
            BeltLength::Slack(_) => "slack",
            BeltLength::Pretension(_) => "pretension",
        };
        let term = |name: &str, key: &str| Term::new(name, key, Rule::NotNegative);
        let mut elastics = term("elastic", "force");
        elastics.keys.push("stiffness".into());
        fields.push(Field::Term(elastics, force));
        let mut unloading = term("hysteresis", "unloading").needs("it has no elastic force");
        unloading.keys.push("unloading_slope".into());
        fields.push(Field::Term(unloading, hysteresis));
        fields.push(Field::Term(term("damping", "damping"), damping));
        let fade = term("damping fades in", "damping_stretch").needs("there is no damping");
        fields.push(Field::Term(fade.only_as_written(), damping_stretch));
        let needs = "it has no elastic force";
        let device = |name: &str, rule| Term::new(name, name, rule).needs(needs).only_as_written();
        fields.push(Field::Term(device("retractor", Rule::Finite), retractor));
        let film = Term::new("film spool", "retractor.film_spool", Rule::Finite);
        let film = film.needs("there is no retractor").only_as_written();
        fields.push(Field::Term(film, film_spool));
        fields.push(Field::Term(
            device("pretensioner", Rule::Finite),
            pretensioner,
        ));
        fields.push(Field::Term(device("limiter", Rule::Positive), limiter));
        let mut untensioned = term(name, "length").needs("it has no elastic force");
        untensioned
            .keys
            .extend(["slack", "pretension"].map(String::from));
        fields.push(Field::Term(untensioned, length));
    }
}

impl Spring {
    fn fields<'a>(&'a mut self, fields: &mut Vec<Field<'a>>) {
        let Spring {
            from,
            to,
            elastic,
            length,
            damping,
        } = self;
        attachment(from, "from.at", fields);
        attachment(to, "to.at", fields);
        let term = |name: &str, key: &str| Term::new(name, key, Rule::NotNegative);
        let mut elastics = term("elastic", "elastic");
        elastics.keys.push("stiffness".into());
        fields.push(Field::Term(elastics, elastic));
        if let Some(length) = length {
            fields.push(Field::Number("length".into(), Rule::NotNegative, length));
        }
        fields.push(Field::Term(term("damping", "damping"), damping));
    }
}

impl Airbag {
    fn fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Airbag {
            bag,
            against,
            inflow,
            vent,
            constant,
            gamma,
            ambient_pressure,
            ambient_temperature,
            start,
        } = self;
        let mut ellipsoid = |ellipsoid: &'a mut Ellipsoid, key: &str| {
            let Ellipsoid {
                center,
                semi_axes,
                axes,
            } = ellipsoid;
            attachment(center, &format!("{key}.center"), fields);
            shape(semi_axes, axes, key, dimension, fields);
        };
        ellipsoid(bag, "ellipsoid");
        for (index, other) in against.iter_mut().enumerate() {
            ellipsoid(other, &format!("against[{index}]"));
        }
        for (key, number) in [
            ("gas.constant", constant),
            ("gas.gamma", gamma),
            ("ambient.pressure", ambient_pressure),
            ("ambient.temperature", ambient_temperature),
        ] {
            fields.push(Field::Number(key.into(), Rule::Positive, number));
        }
        let flows = Term::new("inflow", "inflow", Rule::Finite).only_as_written();
        fields.push(Field::Term(flows, inflow));
        let filled = Term::new("gas at the start", "start", Rule::Positive).only_as_written();
        fields.push(Field::Term(filled, start));
        let leaves = Term::new("vent", "vent.area", Rule::NotNegative);
        fields.push(Field::Term(leaves.needs("there is no gas"), vent));
    }
}

impl Load {
    fn fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Load { on, force, moment } = self;
        attachment(on, "at", fields);
        components(force, "force ", "force", dimension, fields);
        match dimension {
            Dimension::Plane => {
                fields.push(Field::Term(
                    Term::new("moment", "moment", Rule::Finite),
                    &mut moment[1],
                ));
            }
            Dimension::Space => components(moment, "moment ", "moment", dimension, fields),
        }
    }
}

impl User {
    fn fields<'a>(&'a mut self, fields: &mut Vec<Field<'a>>) {
        let User {
            function,
            dimension: _,
            scale: _,
            points,
            bodies,
            lines,
            joints,
            freedoms,
            states,
        } = self;
        for Port { name, value } in points {
            attachment(value, &format!("points.{name}.at"), fields);
        }
        for Port { name, value } in lines {
            let UserLine { from, to } = value;
            attachment(from, &format!("lines.{name}.from.at"), fields);
            attachment(to, &format!("lines.{name}.to.at"), fields);
        }
        let elements = bodies.iter().chain(joints.iter());
        fields.extend(elements.map(|port| Field::Body(Body::Element(port.value))));
        for Port { name: _, value } in freedoms {
            let UserFreedom {
                element,
                freedom: _,
                turns: _,
            } = value;
            fields.push(Field::Body(Body::Element(*element)));
        }
        for Port { name, value } in states {
            let UserState {
                initial,
                unit: _,
                rate_unit: _,
            } = value;
            let key = format!("states.{name}.initial");
            fields.push(Field::Number(key, Rule::Finite, initial));
        }
        let calls = Term::new("function", "function", Rule::Finite);
        fields.push(Field::Term(calls, function));
    }
}

fn attachment<'a>(attachment: &'a mut Attachment, key: &str, fields: &mut Vec<Field<'a>>) {
    let Attachment { on, at } = attachment;
    fields.push(Field::Body(*on));
    finite(at, key, fields);
}

/// Numbers that may be any, of one key.
fn finite<'a>(numbers: &'a mut [Number; 3], key: &str, fields: &mut Vec<Field<'a>>) {
    let numbers = numbers.iter_mut();
    fields.extend(numbers.map(|number| Field::Number(key.to_owned(), Rule::Finite, number)));
}

/// The shape of an ellipsoid.
fn shape<'a>(
    semi_axes: &'a mut [Number; 3],
    axes: &'a mut [Number; 3],
    key: &str,
    dimension: Dimension,
    fields: &mut Vec<Field<'a>>,
) {
    for (axis, number) in semi_axes.iter_mut().enumerate() {
        // in the plane the second is not used
        let (place, rule) = match (dimension, axis) {
            (Dimension::Space, _) => (axis, Rule::Positive),
            (Dimension::Plane, 1) => (axis, Rule::Finite),
            (Dimension::Plane, _) => (axis / 2, Rule::Positive),
        };
        let key = format!("{key}.semi_axes[{place}]");
        fields.push(Field::Number(key, rule, number));
    }
    finite(axes, &format!("{key}.axes"), fields);
}

/// A vector's components, those that the dimension has.
fn components<'a>(
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

impl Model {
    /// Every number of the model, wherever it stands.
    pub fn numbers_mut(&mut self) -> Vec<&mut Number> {
        let dimension = self.dimension;
        let Model {
            name: _,
            title: _,
            dimension: _,
            coordinates: _,
            parameters: _,
            curves: _,
            vehicles,
            systems,
            forces,
            switches,
            outputs,
            run: _,
            digest: _,
        } = self;
        let mut numbers = Vec::new();
        for vehicle in vehicles {
            let Vehicle {
                name: _,
                position,
                velocity,
                translation,
                angles,
                angles_at_start,
            } = vehicle;
            numbers.extend(position.iter_mut().chain(velocity).chain(angles_at_start));
            let curves = translation.curves.iter_mut().flat_map(Part::numbers);
            let angles = angles.iter_mut().flat_map(Part::numbers);
            numbers.extend(curves.chain(angles).map(|ruled| ruled.number));
        }
        for system in systems {
            let System {
                name: _,
                elements,
                reference,
                position,
                velocity,
            } = system;
            numbers.extend(elements.iter_mut().flat_map(of_element));
            numbers.extend(position.iter_mut().chain(velocity));
            match reference {
                Reference::Free | Reference::Fixed => {}
                Reference::Prescribed(translation) => {
                    let curves = translation.curves.iter_mut().flat_map(Part::numbers);
                    numbers.extend(curves.map(|ruled| ruled.number));
                }
                Reference::Riding { vehicle: _, at } => numbers.extend(at),
            }
        }
        for force in forces {
            for field in force.kind.fields(dimension) {
                match field {
                    Field::Body(_) => {}
                    Field::Number(_, _, number) => numbers.push(number),
                    // A term of a law lives as long as the law.
                    Field::Term(_, part) => {
                        numbers.extend(part.numbers().into_iter().map(|ruled| ruled.number));
                    }
                }
            }
        }
        for Output {
            name: _,
            quantity,
            unit: _,
            code: _,
            filter: _,
        } in outputs
        {
            numbers.extend(of_quantity(quantity));
        }
        for switch in switches {
            let Switch {
                name: _,
                trigger,
                after,
            } = switch;
            numbers.extend(after);
            match trigger {
                Trigger::Time(time) => numbers.push(time),
                Trigger::Above(quantity, threshold) | Trigger::Below(quantity, threshold) => {
                    numbers.push(threshold);
                    numbers.extend(of_quantity(quantity));
                }
            }
        }
        numbers
    }

    /// Every use of a curve.
    pub fn curve_uses_mut(&mut self) -> Vec<&mut ScaledCurve> {
        let dimension = self.dimension;
        let mut uses = Vec::new();
        for vehicle in &mut self.vehicles {
            uses.extend(of_translation(&mut vehicle.translation));
            uses.extend(vehicle.angles.iter_mut().flat_map(Part::curves));
        }
        for system in &mut self.systems {
            if let Reference::Prescribed(translation) = &mut system.reference {
                uses.extend(of_translation(translation));
            }
        }
        for force in &mut self.forces {
            for field in force.kind.fields(dimension) {
                if let Field::Term(_, part) = field {
                    uses.extend(part.curves());
                }
            }
        }
        uses
    }
}

/// The curves of a given motion.
fn of_translation(translation: &mut Translation) -> impl Iterator<Item = &mut ScaledCurve> {
    let Translation {
        given: _,
        curves,
        stops,
    } = translation;
    curves.iter_mut().chain([stops]).flatten()
}

fn of_quantity(quantity: &mut Quantity) -> &mut [Number] {
    match quantity {
        Quantity::Point { at, .. } => at,
        Quantity::Rotation { .. }
        | Quantity::JointLoad { .. }
        | Quantity::ForceOn { .. }
        | Quantity::Joint { .. }
        | Quantity::Contact { .. }
        | Quantity::Belt { .. }
        | Quantity::ForceOnPoints { .. }
        | Quantity::Spring { .. }
        | Quantity::Airbag { .. }
        | Quantity::Freedom { .. }
        | Quantity::Switch { .. }
        | Quantity::User { .. }
        | Quantity::System { .. } => &mut [],
    }
}

fn of_element(element: &mut Element) -> impl Iterator<Item = &mut Number> {
    let Element {
        name: _,
        parent: _,
        at,
        joint,
        mass,
        cg,
        inertia,
        axes,
        angles,
        angular_velocity,
    } = element;
    let vectors = [at, cg, inertia, axes, angles, angular_velocity];
    let freedoms = joint.freedoms_mut().iter_mut().flat_map(of_freedom);
    vectors.into_iter().flatten().chain([mass]).chain(freedoms)
}

fn of_freedom(freedom: &mut Freedom) -> impl Iterator<Item = &mut Number> {
    let Freedom {
        name: _,
        kind,
        axis,
        zero,
        position,
        rate,
        armature,
        follows,
    } = freedom;
    let coupled = follows.iter_mut().flat_map(|follows| {
        let Follows {
            element: _,
            freedom: _,
            ratio,
            offset,
        } = follows;
        [ratio, offset]
    });
    let own = [zero, position, rate, armature];
    axis.iter_mut()
        .chain(own)
        .chain(kind.numbers_mut())
        .chain(coupled)
}

impl Quantity {
    /// The bodies that are looked at, or from; elements that joints carry, systems and bodies of forces are not among them.
    pub fn bodies_mut(&mut self) -> impl Iterator<Item = &mut Body> {
        let bodies = match self {
            Quantity::Point {
                body,
                relative_to,
                projection,
                ..
            }
            | Quantity::Rotation {
                body,
                relative_to,
                projection,
                ..
            } => [Some(body), Some(relative_to), Some(&mut projection.axes)],
            Quantity::JointLoad { projection, .. }
            | Quantity::ForceOn { projection, .. }
            | Quantity::ForceOnPoints { projection, .. }
            | Quantity::User {
                what: UserQuantity::Force(_, projection) | UserQuantity::Moment(_, projection),
                ..
            }
            | Quantity::System { projection, .. } => [Some(&mut projection.axes), None, None],
            Quantity::Joint { .. }
            | Quantity::Freedom { .. }
            | Quantity::Contact { .. }
            | Quantity::Belt { .. }
            | Quantity::Spring { .. }
            | Quantity::Airbag { .. }
            | Quantity::Switch { .. }
            | Quantity::User { .. } => [None, None, None],
        };
        bodies.into_iter().flatten()
    }

    /// The force that is looked at, by its index.
    pub fn force_mut(&mut self) -> Option<&mut usize> {
        match self {
            Quantity::Joint { force, .. }
            | Quantity::Contact { force, .. }
            | Quantity::Belt { force, .. }
            | Quantity::ForceOnPoints { force, .. }
            | Quantity::Spring { force, .. }
            | Quantity::Airbag { force, .. }
            | Quantity::ForceOn { force, .. }
            | Quantity::User { force, .. } => Some(force),
            Quantity::Point { .. }
            | Quantity::Rotation { .. }
            | Quantity::JointLoad { .. }
            | Quantity::Freedom { .. }
            | Quantity::Switch { .. }
            | Quantity::System { .. } => None,
        }
    }
}
