//! What the numbers of a model must keep, each requirement in one sentence: of a constant it is judged when the model is read, of what
//! parameters decide before every run. Both say the same words.
//!
//! The numbers of a law are ruled in [`part`](super::part), one by one. What several of them must keep together stands here, as one
//! expression of them.

use super::part::{Field, Part};
use super::rule::{Rule, Ruled};
use super::unloading;
use super::{
    Against, Airbag, Belt, BeltLength, Contact, Curve, Dimension, EdgeRule, Element, Extrapolate,
    Force, ForceKind, Hysteresis, JointTorque, Model, Number, Plane, Reference, ScaledCurve,
    Switch, System, Vehicle,
};

/// Relative excess of a moment over the sum of the others that is rounding: a flat body has equality.
const ROUNDING: f64 = 1e-9;

/// Largest product of a tangent and a normal of a plane that is rounding, squared.
const SQUARE_TO: f64 = 1e-12;

/// What an elastic curve of a joint must do if it has a hysteresis.
const RETURNS: &str =
    "must be 0 at the neutral angle and push back to it everywhere, to have a hysteresis";

/// What a number, or several, must keep.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// In words: "`damping` of contact "floor" must not be negative".
    pub sentence: String,
    /// The path of the key where it is broken, below the force or the element.
    pub path: String,
    /// The number, or what is made of several.
    pub value: Number,
    /// What it may be.
    pub rule: Rule,
    /// What to do.
    pub help: &'static str,
    /// Whether the value is a number as written, and so worth showing.
    pub written: bool,
}

/// Curves by index; `None` for what is wrong.
pub type Curves<'a> = &'a dyn Fn(usize) -> Option<&'a Curve>;

/// Requirements of one owner: "contact "floor"", "man/head".
struct List<'a> {
    owner: &'a str,
    found: Vec<Requirement>,
}

impl List<'_> {
    /// A number as written.
    fn number(&mut self, path: String, value: &Number, rule: Rule) {
        self.found.push(Requirement {
            sentence: format!("`{path}` of {} {}", self.owner, rule.words()),
            path,
            value: value.clone(),
            rule,
            help: rule.help(),
            written: true,
        });
    }

    /// What several numbers must keep, in words behind the owner.
    fn together(&mut self, path: &str, must: &str, value: Number, rule: Rule, help: &'static str) {
        self.found.push(Requirement {
            sentence: format!("`{path}` of {} {must}", self.owner),
            path: path.to_owned(),
            value,
            rule,
            help,
            written: false,
        });
    }

    fn ruled(&mut self, term: &str, of_term: Rule, numbers: Vec<Ruled<'_>>) {
        for Ruled { rule, key, number } in numbers {
            self.number(key.path(term), number, rule.unwrap_or(of_term));
        }
    }
}

impl Model {
    /// All of the model.
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
    /// Of the curves of a vehicle.
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
    /// Of the curves of a reference joint.
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
    /// Of a switch.
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
    /// Of an element that is called `owner`.
    pub fn requirements(&self, owner: &str, dimension: Dimension) -> Vec<Requirement> {
        let mut list = List {
            owner,
            found: Vec::new(),
        };
        list.number("mass".into(), &self.mass, Rule::Positive);
        for freedom in self.joint.freedoms() {
            list.number("armature".into(), &freedom.armature, Rule::NotNegative);
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
    /// Of a force.
    pub fn requirements(&self, dimension: Dimension, curves: Curves<'_>) -> Vec<Requirement> {
        let mut kind = self.kind.clone();
        let owner = format!("{} \"{}\"", kind.key(), self.name);
        let mut list = List {
            owner: &owner,
            found: Vec::new(),
        };
        if let ForceKind::Contact(contact) = &self.kind
            && let Against::Plane(plane) = &contact.against
        {
            // before its components, which are no numbers where it has no direction
            let directed = dimension == Dimension::Space && contact.bristle.is_some();
            let ends = dimension == Dimension::Space && plane.extent.is_some();
            list.plane(plane, directed || ends);
        }
        for field in kind.fields(dimension) {
            match field {
                Field::Body(_) => {}
                Field::Number(path, rule, number) => list.number(path, number, rule),
                Field::Term(term, part) => list.ruled(&term.keys[0], term.rule, part.numbers()),
            }
        }
        match &self.kind {
            ForceKind::Joint { about, bending, .. } => {
                for (axis, law) in about.iter().enumerate() {
                    let below = match dimension {
                        Dimension::Plane => String::new(),
                        Dimension::Space => format!("about.{}.", ["x", "y", "z"][axis]),
                    };
                    list.law(law, &below, curves);
                }
                if let Some(bending) = bending {
                    list.both_ways(&bending.flexion, "flexion.", curves);
                    let to = bending.flexion.stop.as_ref().and_then(|s| s.to.as_ref());
                    if let Some(to) = to {
                        list.number("flexion.stop.to".into(), to, Rule::Positive);
                    }
                    list.law(&bending.torsion, "torsion.", curves);
                }
            }
            ForceKind::Freedom { law, .. } => list.law(law, "", curves),
            ForceKind::Contact(contact) => list.contact(contact, curves),
            ForceKind::Belt(belt) => list.belt(belt, curves),
            ForceKind::Airbag(airbag) => list.airbag(airbag),
            ForceKind::Field { .. }
            | ForceKind::Spring(_)
            | ForceKind::Load(_)
            | ForceKind::User(_) => {}
        }
        list.found
    }
}

impl List<'_> {
    /// The law of one coordinate of a joint.
    fn law(&mut self, law: &JointTorque, below: &str, curves: Curves<'_>) {
        self.stop(law, below);
        self.both_ways(law, below, curves);
    }

    /// A hysteresis on both sides of 0, whose curves must lie between 0 and each other there, the one of unloading below.
    fn both_ways(&mut self, law: &JointTorque, below: &str, curves: Curves<'_>) {
        let (Some(loading), Some(hysteresis)) = (&law.elastic, &law.hysteresis) else {
            return;
        };
        let Some(f) = curves(loading.curve) else {
            return;
        };
        self.steep((f, loading), hysteresis, below, curves);
        let u = hysteresis.unloading.as_ref();
        let u = u.and_then(|scaled| Some((curves(scaled.curve)?, scaled)));
        let nothing = unloading::nothing();
        let none = (&nothing, &unloading::unscaled());
        let ordered = match u {
            Some(u) => vec![
                (
                    u,
                    (f, loading),
                    "unloading",
                    "must lie between 0 and the elastic curve everywhere",
                ),
                (
                    none,
                    u,
                    "unloading",
                    "must lie between 0 and the elastic curve everywhere",
                ),
            ],
            None => vec![(none, (f, loading), "elastic", RETURNS)],
        };
        for (lower, upper, key, must) in ordered {
            let mirrored = [lower, upper].map(|(curve, _)| unloading::turned(curve));
            let sides = [
                unloading::clearances(lower, upper),
                unloading::clearances((&mirrored[0], lower.1), (&mirrored[1], upper.1)),
            ];
            for clearance in sides.into_iter().flatten() {
                self.together(
                    &format!("{below}{key}"),
                    must,
                    clearance,
                    Rule::NotNegative,
                    "let the torque be 0 at the neutral angle and push back to it everywhere; unloading gives back at most what loading took",
                );
            }
        }
    }

    fn stop(&mut self, law: &JointTorque, below: &str) {
        let Some(stop) = &law.stop else { return };
        if let (Some(from), Some(to)) = (&stop.from, &stop.to) {
            self.together(
                &format!("{below}stop.to"),
                "must be larger than `from`",
                Number::difference(to.clone(), from.clone()),
                Rule::Positive,
                "the rotation needs room between the ends; let `from` be smaller than `to`",
            );
        }
    }

    fn contact(&mut self, contact: &Contact, curves: Curves<'_>) {
        if let (Some(loading), Some(law)) = (&contact.elastic, &contact.hysteresis) {
            self.hysteresis("elastic", loading, law, curves);
        }
    }

    fn plane(&mut self, plane: &Plane, directed: bool) {
        let product = |a: &[Number; 3], b: &[Number; 3]| {
            let products = a.iter().zip(b);
            let products = products.map(|(a, b)| Number::product(a.clone(), b.clone()));
            products.fold(Number::ZERO, Number::sum)
        };
        let length = |vector| Number::difference(product(vector, vector), 0.5.into());
        self.together(
            "plane.normal",
            "must have a direction",
            length(&plane.normal),
            Rule::Positive,
            "write a vector of any finite length that points to the side where the ellipsoid belongs, such as `[1, 0]`",
        );
        let tangent = &plane.tangent;
        if directed {
            let along = product(tangent, &plane.normal);
            let slanting = Number::product(along.clone(), along);
            for value in [
                length(tangent),
                Number::difference(SQUARE_TO.into(), slanting),
            ] {
                self.together(
                    "plane.along",
                    "must be a direction along the plane",
                    value,
                    Rule::NotNegative,
                    "write a vector of any finite length that is not parallel to `normal`, such as `[1, 0, 0]`",
                );
            }
        }
        if let Some(extent) = &plane.extent
            && let EdgeRule::Fade(width) = &extent.rule
        {
            for half in &extent.half_lengths {
                self.together(
                    "plane.edge.width",
                    "must be at most the shorter half-length",
                    Number::difference(half.clone(), width.clone()),
                    Rule::NotNegative,
                    "the force fades inside the edge: give at most the shorter half-length",
                );
            }
        }
    }

    fn belt(&mut self, belt: &Belt, curves: Curves<'_>) {
        let times = &belt.force.times;
        match belt.force.stiffness {
            true => self.number("stiffness".into(), times, Rule::Positive),
            false => self.number("force.times".into(), times, Rule::NotZero),
        }
        if let Some(law) = &belt.hysteresis {
            self.hysteresis("force", &belt.force, law, curves);
        }
        if let Some(film) = &belt.film_spool {
            self.together(
                "retractor.film_spool",
                "must come to an end",
                film.times.clone(),
                Rule::Positive,
                "scale the curve by a factor above 0; leave `film_spool` out for a reel that holds at once",
            );
        }
        let spool = belt.retractor.as_ref().map(|r| &r.spool);
        if let (Some(spool), Some(limit)) = (spool, &belt.limiter) {
            self.together(
                "retractor.spool",
                "must be smaller than the force of the limiter",
                Number::difference(limit.clone(), spool.clone()),
                Rule::Positive,
                "let `spool` be smaller than the force of the limiter",
            );
        }
        let pretension = match &belt.length {
            BeltLength::Pretension(force) => Some(force),
            BeltLength::Given(_) | BeltLength::Slack(_) => None,
        };
        let tensions = [
            ("limiter", belt.limiter.as_ref()),
            ("retractor.spool", spool.filter(|spool| !spool.is_zero())),
            ("pretension", pretension),
        ];
        let Some(curve) = curves(belt.force.curve) else {
            return;
        };
        for (path, tension) in tensions {
            if let Some(tension) = tension {
                self.reached(path, tension, curve, times);
            }
        }
    }

    fn airbag(&mut self, airbag: &Airbag) {
        if let Some(inflow) = &airbag.inflow {
            let path = "inflow.flow.times".into();
            self.number(path, &inflow.flow.times, Rule::NotNegative);
        }
        self.together(
            "gas.gamma",
            "must be more than 1",
            Number::difference(airbag.gamma.clone(), 1.0.into()),
            Rule::Positive,
            "give the ratio of specific heats: 1.4 of air",
        );
        if let Some(start) = &airbag.start {
            self.together(
                "start.pressure",
                "must be at least that around the bag",
                Number::difference(start.pressure.clone(), airbag.ambient_pressure.clone()),
                Rule::NotNegative,
                "a full bag has at least the pressure around it; leave `start` out for one that is folded",
            );
        }
    }

    /// A tension belongs to one elongation only where the curve rises to it. That it does so all the way, or falls, is of its points.
    fn reached(&mut self, path: &str, tension: &Number, curve: &Curve, times: &Number) {
        let last = curve.points.len() - 1;
        let reach = curve.points[last][1];
        let rising = if reach < 0.0 { -1.0 } else { 1.0 };
        self.together(
            path,
            "must be reached by the force curve, which must rise",
            Number::product(rising.into(), times.clone()),
            Rule::Positive,
            "scale the curve by a factor that lets it rise",
        );
        let goes_on =
            curve.extrapolate == Extrapolate::Linear && curve.tangent(last) * rising > 0.0;
        if !goes_on {
            let most = Number::product(reach.into(), times.clone());
            self.together(
                path,
                "must be reached by the force curve, which must rise",
                Number::difference(most, tension.clone()),
                Rule::NotNegative,
                "add points to the curve, or write `extrapolate: linear`",
            );
        }
    }

    fn hysteresis(
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

    /// The line between two curves, which is at least as steep as both.
    fn steep(
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
