//! What a law is made of: its bodies, its numbers, and its terms, each of which may be absent.
//!
//! law = geometry + Σ terms, a term being one summand of the force that a coefficient or a curve calls for
//!
//! Every struct of a law is taken apart here without `..`: a field that is added to one does not compile until it is
//! said here what it is. What is said here is all that the vocabulary of effects, the normal form of a model and the
//! scene with nothing left out know of a law.

use super::{
    Against, Attachment, Belt, BeltLength, Bending, Body, Bristle, Contact, Curve, Dimension,
    EdgeRule, Element, Ellipsoid, Extent, Extrapolate, FieldComponent, ForceKind, Friction,
    Hysteresis, Interpolate, JointTorque, Load, Lock, Model, Number, Output, Parameter, Plane,
    Port, Pretensioner, Quantity, Reference, Retractor, ScaledCurve, Stop, Switch, System, Trigger,
    User, UserFunction, UserLine, UserParameter, UserState, Vehicle,
};

/// Something of a law.
pub enum Field<'a> {
    /// A body that feels it.
    Body(Body),
    /// A number of its geometry, always there.
    Number(&'a mut Number),
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
    /// True for what cannot be there with a coefficient of 0, and so is not added to a scene that does not have it.
    pub as_written: bool,
}

impl Term {
    fn new(name: impl Into<String>, key: impl Into<String>) -> Self {
        Term {
            name: name.into(),
            keys: vec![key.into()],
            needs: "",
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
    /// Its numbers.
    fn numbers(&mut self) -> Vec<&mut Number>;
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
    fn numbers(&mut self) -> Vec<&mut Number> {
        self.iter_mut().collect()
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
    fn numbers(&mut self) -> Vec<&mut Number> {
        self.iter_mut()
            .flat_map(|Friction { limit, tolerance }| [limit, tolerance])
            .collect()
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
    fn numbers(&mut self) -> Vec<&mut Number> {
        let ScaledCurve {
            curve: _,
            times,
            stretch,
        } = self;
        vec![times, stretch]
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
    fn numbers(&mut self) -> Vec<&mut Number> {
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
    fn numbers(&mut self) -> Vec<&mut Number> {
        match self {
            FieldComponent::Constant(number) => vec![number],
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
    fn numbers(&mut self) -> Vec<&mut Number> {
        match self {
            BeltLength::Given(number)
            | BeltLength::Slack(number)
            | BeltLength::Pretension(number) => vec![number],
        }
    }
}

/// Implements [`Part`] for what is as it is: not 0 where it is written, and not added to a scene that does not have it.
macro_rules! as_written {
    ($($part:ident { $($number:ident),* } { $($optional:ident),* } [$($curve:ident),*] $(- $rest:ident)*;)*) => {$(
        impl Part for Option<$part> {
            fn is_in(&self) -> bool {
                self.is_some()
            }
            fn leave_out(&mut self) {
                *self = None;
            }
            fn put_in(&mut self, _: &mut Fresh<'_>) {}
            fn numbers(&mut self) -> Vec<&mut Number> {
                let mut numbers: Vec<&mut Number> = Vec::new();
                if let Some($part { $($number,)* $($optional,)* $($curve,)* $($rest: _,)* }) = self {
                    $(numbers.push($number);)*
                    $(numbers.extend($optional.iter_mut());)*
                    $(numbers.extend($curve.numbers());)*
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
    Hysteresis { slope, foot } {} [unloading];
    Stop { stiffness } { from, to, damping, damping_angle } [];
    Lock { stiffness } { damping } [] - by;
    Retractor { spool } {} [] - lock;
    Pretensioner {} {} [retract] - fire;
    Bristle { displacement } {} [];
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
    fn numbers(&mut self) -> Vec<&mut Number> {
        let Some(Extent { half_lengths, rule }) = self else {
            return Vec::new();
        };
        let width = match rule {
            EdgeRule::Cut => None,
            EdgeRule::Fade(width) => Some(width),
        };
        half_lengths.iter_mut().chain(width).collect()
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
    fn numbers(&mut self) -> Vec<&mut Number> {
        let UserFunction {
            name: _,
            source: _,
            parameters,
            curves,
        } = self;
        let mut numbers = Vec::new();
        for Port { name: _, value } in parameters {
            let UserParameter { value, unit: _ } = value;
            numbers.extend(value.numbers());
        }
        for Port { name: _, value } in curves {
            numbers.extend(value.numbers());
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
        }
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl ForceKind {
    /// The key that names a force of this kind.
    pub fn key(&self) -> &'static str {
        match self {
            ForceKind::Joint { .. } => "joint",
            ForceKind::Field { .. } => "field",
            ForceKind::Contact(_) => "contact",
            ForceKind::Belt(_) => "belt",
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
            ForceKind::Field { on, acceleration } => {
                fields.extend(on.iter().map(|&id| Field::Body(Body::Element(id))));
                components(acceleration, "", "acceleration", dimension, &mut fields);
            }
            ForceKind::Contact(contact) => contact.fields(&mut fields),
            ForceKind::Belt(belt) => belt.fields(&mut fields),
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
                    if law.elastic.is_none() {
                        law.neutral = None;
                    }
                }
                let nothing = JointTorque::default();
                if bending
                    .as_ref()
                    .is_some_and(|b| b.flexion == nothing && b.torsion == nothing)
                {
                    *bending = None;
                }
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
                if belt.retractor.is_some() {
                    belt.length.leave_out();
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
            ForceKind::Field { .. } => {}
        }
    }

    /// The terms, and whether each is in.
    pub fn terms(&self, dimension: Dimension) -> Vec<(Term, bool)> {
        let mut copy = self.clone();
        let fields = copy.fields(dimension).into_iter();
        let terms = fields.filter_map(|field| match field {
            Field::Term(term, part) => Some((term, part.is_in())),
            Field::Body(_) | Field::Number(_) => None,
        });
        terms.collect()
    }

    /// Whether it does anything: a term that acts alone is in.
    pub fn acts(&self, dimension: Dimension) -> bool {
        let mut terms = self.terms(dimension).into_iter();
        terms.any(|(term, is_in)| is_in && term.needs.is_empty())
    }
}

/// The law about one relative rotation.
fn torque<'a>(law: &'a mut JointTorque, about: &str, below: &str, fields: &mut Vec<Field<'a>>) {
    let JointTorque {
        elastic,
        neutral,
        damping,
        friction,
        stop,
        lock,
    } = law;
    let term = |name: &str, key: &str| Term::new(format!("{name}{about}"), format!("{below}{key}"));
    fields.push(Field::Term(term("elastic", "elastic"), elastic));
    let angle = term("neutral angle", "neutral").needs("there is no elastic torque");
    fields.push(Field::Term(angle, neutral));
    fields.push(Field::Term(term("damping", "damping"), damping));
    fields.push(Field::Term(term("friction", "friction"), friction));
    fields.push(Field::Term(term("stop", "stop"), stop));
    fields.push(Field::Term(term("lock", "lock"), lock));
}

impl Contact {
    fn fields<'a>(&'a mut self, fields: &mut Vec<Field<'a>>) {
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
        attachment(ellipsoid, fields);
        fields.extend(semi_axes.iter_mut().chain(axes).map(Field::Number));
        let mut edge = None;
        match against {
            Against::Plane(Plane {
                at,
                normal,
                tangent,
                extent,
            }) => {
                attachment(at, fields);
                fields.extend(normal.iter_mut().map(Field::Number));
                // without edges and bristles nothing tells one tangent from another
                if extent.is_some() || bristle.is_some() {
                    fields.extend(tangent.iter_mut().map(Field::Number));
                }
                edge = Some(extent);
            }
            Against::Ellipsoid(Ellipsoid {
                center,
                semi_axes,
                axes,
            }) => {
                attachment(center, fields);
                fields.extend(semi_axes.iter_mut().chain(axes).map(Field::Number));
            }
        }
        fields.push(Field::Term(Term::new("elastic", "elastic"), elastic));
        let mut unloading = Term::new("hysteresis", "unloading").needs("there is no elastic force");
        unloading.keys.push("unloading_slope".into());
        fields.push(Field::Term(unloading, hysteresis));
        fields.push(Field::Term(Term::new("damping", "damping"), damping));
        let fade = Term::new("damping fades in", "damping_depth").needs("there is no damping");
        fields.push(Field::Term(fade.only_as_written(), damping_depth));
        let sliding = Term::new("friction", "friction").needs("nothing presses");
        fields.push(Field::Term(sliding, friction));
        let holds = Term::new("friction holds", "friction_displacement");
        let holds = holds.needs("there is no friction");
        fields.push(Field::Term(holds, bristle));
        if let Some(extent) = edge {
            let ends = Term::new("edge", "plane.extent").needs("nothing presses");
            fields.push(Field::Term(ends, extent));
        }
    }
}

impl Belt {
    fn fields<'a>(&'a mut self, fields: &mut Vec<Field<'a>>) {
        let Belt {
            from,
            to,
            force,
            hysteresis,
            damping,
            damping_stretch,
            length,
            retractor,
            pretensioner,
            limiter,
        } = self;
        attachment(from, fields);
        attachment(to, fields);
        let name = match length {
            BeltLength::Given(_) => "given length",
            BeltLength::Slack(_) => "slack",
            BeltLength::Pretension(_) => "pretension",
        };
        fields.push(Field::Term(Term::new("elastic", "force"), force));
        let mut unloading = Term::new("hysteresis", "unloading").needs("it has no elastic force");
        unloading.keys.push("unloading_slope".into());
        fields.push(Field::Term(unloading, hysteresis));
        fields.push(Field::Term(Term::new("damping", "damping"), damping));
        let fade = Term::new("damping fades in", "damping_stretch").needs("there is no damping");
        fields.push(Field::Term(fade.only_as_written(), damping_stretch));
        let needs = "it has no elastic force";
        let term = |name: &str| Term::new(name, name).needs(needs).only_as_written();
        fields.push(Field::Term(term("retractor"), retractor));
        fields.push(Field::Term(term("pretensioner"), pretensioner));
        fields.push(Field::Term(term("limiter"), limiter));
        let mut untensioned = Term::new(name, "length").needs("it has no elastic force");
        untensioned
            .keys
            .extend(["slack", "pretension"].map(String::from));
        fields.push(Field::Term(untensioned, length));
    }
}

impl Load {
    fn fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Load { on, force, moment } = self;
        attachment(on, fields);
        components(force, "force ", "force", dimension, fields);
        match dimension {
            Dimension::Plane => {
                fields.push(Field::Term(Term::new("moment", "moment"), &mut moment[1]));
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
            states,
        } = self;
        for Port { name: _, value } in points {
            attachment(value, fields);
        }
        for Port { name: _, value } in lines {
            let UserLine { from, to } = value;
            attachment(from, fields);
            attachment(to, fields);
        }
        let elements = bodies.iter().chain(joints.iter());
        fields.extend(elements.map(|port| Field::Body(Body::Element(port.value))));
        for Port { name: _, value } in states {
            let UserState {
                initial,
                unit: _,
                rate_unit: _,
            } = value;
            fields.push(Field::Number(initial));
        }
        fields.push(Field::Term(Term::new("function", "function"), function));
    }
}

fn attachment<'a>(attachment: &'a mut Attachment, fields: &mut Vec<Field<'a>>) {
    let Attachment { on, at } = attachment;
    fields.push(Field::Body(*on));
    fields.extend(at.iter_mut().map(Field::Number));
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
        let term = Term::new(format!("{name}{}", AXES[axis]), format!("{key}[{place}]"));
        fields.push(Field::Term(term, component));
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
            numbers.extend(translation.curves.iter_mut().flat_map(Part::numbers));
            numbers.extend(angles.iter_mut().flat_map(Part::numbers));
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
                    numbers.extend(translation.curves.iter_mut().flat_map(Part::numbers));
                }
                Reference::Riding { vehicle: _, at } => numbers.extend(at),
            }
        }
        for force in forces {
            for field in force.kind.fields(dimension) {
                match field {
                    Field::Body(_) => {}
                    Field::Number(number) => numbers.push(number),
                    // A term of a law lives as long as the law.
                    Field::Term(_, part) => numbers.extend(part.numbers()),
                }
            }
        }
        for Output {
            name: _,
            quantity,
            unit: _,
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
            uses.extend(vehicle.translation.curves.iter_mut().flatten());
            uses.extend(vehicle.angles.iter_mut().flat_map(Part::curves));
        }
        for system in &mut self.systems {
            if let Reference::Prescribed(translation) = &mut system.reference {
                uses.extend(translation.curves.iter_mut().flatten());
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

fn of_quantity(quantity: &mut Quantity) -> &mut [Number] {
    match quantity {
        Quantity::Point { at, .. } | Quantity::Vehicle { at, .. } => at,
        Quantity::Rotation { .. }
        | Quantity::Joint { .. }
        | Quantity::Contact { .. }
        | Quantity::Belt { .. }
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
        mass,
        cg,
        inertia,
        axes,
        angles,
        angular_velocity,
    } = element;
    let vectors = [at, cg, inertia, axes, angles, angular_velocity];
    vectors.into_iter().flatten().chain([mass])
}

impl Quantity {
    /// The force that is looked at, by its index.
    pub fn force_mut(&mut self) -> Option<&mut usize> {
        match self {
            Quantity::Joint { force, .. }
            | Quantity::Contact { force, .. }
            | Quantity::Belt { force, .. }
            | Quantity::User { force, .. } => Some(force),
            Quantity::Point { .. }
            | Quantity::Vehicle { .. }
            | Quantity::Rotation { .. }
            | Quantity::Switch { .. }
            | Quantity::System { .. } => None,
        }
    }
}
