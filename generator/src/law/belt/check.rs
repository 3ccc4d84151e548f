//! What a belt is made of: the rings that it runs through, its tension curve, its untensioned length, and the devices
//! that change it.

use super::keys::Limiter;
pub use super::keys::{Belt, Pretensioner, Retractor, Ring};
use crate::description::curve::FunctionOf;
use crate::description::expand::{Expander, Node};
use crate::description::measure::{
    Expected, FORCE, FORCE_PER_ELONGATION, Force, LENGTH, Length, PURE, Pure, STIFFNESS, Webbing,
};
use crate::description::place::At;
use crate::description::quantity::{Number as WrittenNumber, Quantity};
use crate::diagnostic::quoted;
use crate::model::declared::{
    Condition, Declaration, Declared, Kind, Loading, Names, NoKey, Reader,
};
use crate::model::part::{Field, Term};
use crate::model::resolve::Resolver;
use crate::model::resolve::kinematics::{IDENTITY, Matrix, distance, place, start, vehicle_start};
use crate::model::resolve::quantity::Measure;
use crate::model::{Attachment, Body, Number, Reference, Rule, ScaledCurve, System};
use serde::Serialize;
use serde_yaml::Value;

/// The condition on the factor of a belt's curve, in the words of a requirement.
fn no_force(belt: &str) -> String {
    let rule = Rule::NotZero.words();
    format!("`force.times` of belt {} {rule}", quoted(belt))
}

/// The way in which the untensioned length of a belt is given.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum BeltLength {
    /// Directly \[m\].
    Given(Number),
    /// Initial distance of the attachments plus this slack \[m\].
    Slack(Number),
    /// By the force \[N\] with which the belt pulls at the initial distance.
    Pretension(Number),
}

impl Belt {
    /// The points between which the belt runs straight: the end `from`, the rings, the end `to`.
    pub fn points(&self) -> impl Iterator<Item = &Attachment> {
        let rings = self.rings.iter().map(|ring| &ring.on);
        std::iter::once(&self.from).chain(rings).chain([&self.to])
    }

    /// Like [`points`](Self::points), mutable.
    pub fn points_mut(&mut self) -> impl Iterator<Item = &mut Attachment> {
        let rings = self.rings.iter_mut().map(|ring| &mut ring.on);
        std::iter::once(&mut self.from)
            .chain(rings)
            .chain([&mut self.to])
    }
}

/// Shortest untensioned length, also of a belt whose pretensioner takes webbing in \[m\].
pub const SHORTEST: f64 = 1e-6;

/// Untensioned length of a segment at which its webbing has run out, so that no more slips out of it \[m\]. Between
/// this and twice this length the slip slows down.
pub const RUN_OUT: f64 = 5e-3;

/// Resistance of a ring, and of webbing that tightens on a reel, if the user gives none \[N s/m\].
pub const RESISTANCE: f64 = 50.0;

/// The condition on a belt whose length at the start follows from the positions of its ends, in words.
pub fn must_have_length(belt: &str) -> String {
    format!("the ends of belt \"{belt}\" must not coincide at the start")
}

/// The name of the belt that is read.
fn name<'w>(reader: &Reader<'_, '_, 'w>) -> &'w str {
    let name = reader.value.get("belt").and_then(Value::as_str);
    name.unwrap_or_default()
}

/// The rings at the key `through`.
pub struct Rings;

impl Kind for Rings {
    type Written = NoKey;
    type Kept = Vec<Ring>;

    fn keep(reader: &mut Reader<'_, '_, '_>, _: &'static str) -> Option<Vec<Ring>> {
        let belt = name(reader);
        let mut rings: Vec<Ring> = Vec::new();
        let mut all = true;
        reader.each_below("through", |mut reader| {
            let Some(ring) = Ring::read(&mut reader) else {
                all = false;
                return;
            };
            let (problems, at) = (&reader.resolver.problems, reader.at.key("ring"));
            if rings.iter().any(|other| other.name == ring.name) {
                problems.add(at.problem(
                    format!("belt {} has two rings {}", quoted(belt), quoted(&ring.name)),
                    "give each ring of a belt another name",
                ));
            }
            if ring.name.trim().is_empty() || ring.name.chars().any(char::is_control) {
                problems.add(at.problem(
                    "the name of a ring is empty or not one line",
                    "give it a name: outputs and effects call it by that",
                ));
            }
            rings.push(ring);
        });
        all.then_some(rings)
    }

    fn add_fields<'a>(kept: &'a mut Vec<Ring>, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        for (index, ring) in kept.iter_mut().enumerate() {
            let (about, below) = (
                format!(" of ring {}", ring.name),
                format!("through[{index}]."),
            );
            ring.add_fields(names.within(&about, &below), to);
        }
    }

    fn add_bodies<'a>(kept: &'a mut Vec<Ring>, bodies: &mut Vec<&'a mut Body>) {
        for ring in kept {
            ring.add_bodies(bodies);
        }
    }

    fn flatten(kept: &mut Vec<Ring>) {
        kept.iter_mut().for_each(Declaration::flatten);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, _: &str) {
        expander.mirrored_list(record, "through");
    }
}

/// The name at the key `ring`.
pub struct RingName;

impl Kind for RingName {
    type Written = NoKey;
    type Kept = String;

    fn keep(reader: &mut Reader<'_, '_, '_>, _: &'static str) -> Option<String> {
        reader.written("ring")
    }
}

/// Tension as a function of the relative elongation (L − L₀)/L₀ → \[N\].
pub struct Tension;

impl Kind for Tension {
    type Written = Option<FunctionOf<Pure, Force>>;
    type Kept = ScaledCurve;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<ScaledCurve> {
        let before = reader.resolver.problems.count();
        let curve = tension(reader);
        if curve.is_none() && reader.resolver.problems.count() == before {
            let (place, times) = match reader.has(key) {
                true => {
                    let place = reader.at.key(key);
                    (place, place.node.get("times").is_some())
                }
                false => (reader.at.key("stiffness"), false),
            };
            let belt = name(reader);
            reader.resolver.problems.add(place.problem(
                match times {
                    true => no_force(belt),
                    false => format!("belt {} has no force at any elongation", quoted(belt)),
                },
                "give a curve that is not zero everywhere, or switch the belt off by `enabled: false`",
            ));
        }
        reader.loading = Loading {
            key,
            curve: curve.clone(),
        };
        curve
    }

    fn add_fields<'a>(kept: &'a mut ScaledCurve, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let mut term = names.term(Rule::NotNegative);
        term.keys.push("stiffness".into());
        to.push(Field::Term(term, kept));
    }
}

/// The curve of tension against relative elongation; `None` if it is wrong, missing, or 0 everywhere.
fn tension(reader: &mut Reader<'_, '_, '_>) -> Option<ScaledCurve> {
    let force: Option<FunctionOf<Pure, Force>> = reader.written("force")?;
    let stiffness: Option<WrittenNumber<Webbing>> = reader.written("stiffness")?;
    if force.is_none() && stiffness.is_none() {
        reader.resolver.problems.add(reader.at.problem(
            format!("belt {} has no force", quoted(name(reader))),
            "add `force: …`, a curve of the relative elongation, or `stiffness: …` for a straight one",
        ));
        return None;
    }
    if let (None, Some(stiffness)) = (&force, &stiffness)
        && let Some(slope) = per_length(reader, stiffness)
    {
        return reader.resolver.line(reader.at.key("stiffness"), slope);
    }
    reader.resolver.elastic_in(
        ("force", force.as_deref()),
        stiffness.as_deref(),
        reader.at,
        [PURE, FORCE, FORCE_PER_ELONGATION],
    )
}

/// A stiffness in newtons per metre, converted to force per relative elongation; `None` for a stiffness in newtons.
fn per_length(reader: &Reader<'_, '_, '_>, stiffness: &Quantity) -> Option<Number> {
    let (resolver, place) = (&reader.resolver, reader.at.key("stiffness"));
    let before = resolver.problems.count();
    let measured = resolver.measured(stiffness, place);
    let Some((number, Measure::Known(dimension))) = measured else {
        // 0 after a problem, so that the caller does not report it again
        return (resolver.problems.count() > before).then_some(Number::ZERO);
    };
    if dimension != STIFFNESS.dimension {
        return None;
    }
    let length: Option<WrittenNumber<Length>> = reader.written("length")?;
    let Some(length) = length else {
        resolver.problems.add(place.problem(
            "a stiffness per length needs the untensioned length of the belt, which here follows from the scene",
            "give `length` too, or the force per relative elongation: 50 N/mm of a belt of 0.5 m are 25 kN",
        ));
        return Some(Number::ZERO);
    };
    let length = resolver.number(&length, reader.at.key("length"));
    Some(Number::product(number, length))
}

/// The curve of the film spool at the key `retractor.film_spool`: tension of a locked reel beyond that of the spool,
/// against the webbing that has come off it.
pub struct FilmSpool;

impl Kind for FilmSpool {
    type Written = NoKey;
    type Kept = Option<ScaledCurve>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        let belt = name(reader);
        let Some(reel) = reader.below("retractor") else {
            return Some(None);
        };
        let written: Option<FunctionOf<Length, Force>> = reel.written(key)?;
        let Some(written) = written else {
            return Some(None);
        };
        Some(film_spool(reel.resolver, belt, &written, reel.at.key(key)))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let term = Term::new(names.name, "retractor.film_spool", Rule::Finite);
        let term = term.needs(names.needs).only_as_written();
        to.push(Field::Term(term, kept));
    }
}

fn film_spool(
    resolver: &mut Resolver<'_>,
    belt: &str,
    written: &FunctionOf<Length, Force>,
    place: At<'_>,
) -> Option<ScaledCurve> {
    let before = resolver.problems.count();
    let film = resolver.function(written, place);
    // a curve that is 0 everywhere is none
    if film.is_none() && resolver.problems.count() > before {
        return None;
    }
    let ends = film.as_ref().and_then(|film| {
        let (curve, _) = resolver.curve_of(film)?;
        let (first, last) = (curve.points[0], curve.points[curve.points.len() - 1]);
        let rises = curve.points.windows(2).all(|pair| pair[1][1] >= pair[0][1]);
        Some(first == [0.0, 0.0] && rises && last[1] > 0.0)
    });
    if ends != Some(true) {
        resolver.problems.add(place.problem(
            format!("`retractor.film_spool` of belt {} must come to an end", quoted(belt)),
            "begin the curve with [0, 0], let no ordinate be smaller than the one before, and the last be more than 0; leave `film_spool` out for a reel that holds at once",
        ));
    }
    film
}

/// A curve of what has been taken in that begins with nothing.
pub struct FromZero;

impl Condition<ScaledCurve> for FromZero {
    fn check(kept: &ScaledCurve, resolver: &Resolver<'_>, at: At<'_>) {
        let curve = resolver.curve_of(kept);
        if curve.is_some_and(|(curve, _)| curve.points[0] != [0.0, 0.0]) {
            resolver.problems.add(at.problem(
                "a pretensioner begins with nothing at the time of its firing",
                "begin the curve with [0, 0]; its abscissa is the time since the switch",
            ));
        }
    }
}

/// The largest tension, at the key `limiter.force`. Where the tension would be larger, webbing is paid out for good.
pub struct LimiterForce;

impl Kind for LimiterForce {
    type Written = Option<Limiter>;
    type Kept = Option<Number>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Self::Kept> {
        let written: Option<Limiter> = reader.written(key)?;
        let place = reader.at.key(key).key("force");
        Some(written.map(|limiter| reader.resolver.number(&limiter.force, place)))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let term = names.term(Rule::Positive).only_as_written();
        to.push(Field::Term(term, kept));
    }
}

/// The untensioned length, in the way in which it is written: at one of the keys `slack`, `pretension`, `length`.
pub struct UntensionedLength;

/// The keys of [`UntensionedLength`], and what each measures.
const LENGTHS: [(&str, Expected); 3] =
    [("slack", LENGTH), ("pretension", FORCE), ("length", LENGTH)];

impl Kind for UntensionedLength {
    type Written = NoKey;
    type Kept = BeltLength;

    fn keep(reader: &mut Reader<'_, '_, '_>, _: &'static str) -> Option<BeltLength> {
        let mut given = LENGTHS.into_iter().filter(|(key, _)| reader.has(key));
        let none = BeltLength::Slack(Number::ZERO);
        let Some((key, expected)) = given.next() else {
            return Some(none);
        };
        if let Some((second, _)) = given.next() {
            reader.resolver.problems.add(reader.at.key(second).key_problem(
                format!("the length of belt {} is given twice, by {key} and {second}", quoted(name(reader))),
                "keep one of `slack`, `pretension`, `length`; without any the belt is just taut at the start",
            ));
            return Some(none);
        }
        let written: Quantity = reader.written(key)?;
        let number = reader
            .resolver
            .number_in(&written, reader.at.key(key), expected);
        Some(match key {
            "length" => BeltLength::Given(number),
            "slack" => BeltLength::Slack(number),
            _ if number.is_zero() => none,
            _ => BeltLength::Pretension(number),
        })
    }

    fn add_fields<'a>(kept: &'a mut BeltLength, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let name = match kept {
            BeltLength::Given(_) => "given length",
            BeltLength::Slack(_) => "slack",
            BeltLength::Pretension(_) => "pretension",
        };
        let mut term = Term::new(name, "length", Rule::NotNegative).needs(names.needs);
        term.keys.extend(["slack", "pretension"].map(String::from));
        to.push(Field::Term(term, kept));
    }
}

/// Reports an untensioned length beside a retractor.
pub(super) fn check_keys(reader: &Reader<'_, '_, '_>) {
    for (key, _) in LENGTHS {
        if reader.has("retractor") && reader.has(key) {
            reader.resolver.problems.add(reader.at.key(key).key_problem(
                "with a retractor the untensioned length follows from where it locks",
                format!("remove `{key}`; the tension until it locks is its `spool`"),
            ));
        }
    }
}

/// Reports a belt whose ends and rings are all on one body.
pub(super) fn check_bodies(reader: &Reader<'_, '_, '_>, name: &str, belt: &Belt) {
    let mut others = belt.points().map(|point| point.on);
    if others.any(|on| on != belt.from.on) {
        return;
    }
    let (message, help) = match belt.rings.is_empty() {
        true => (
            format!("both ends of belt {} are on the same body", quoted(name)),
            "a belt runs between two bodies; `frame` is the absolute frame",
        ),
        false => (
            format!(
                "the ends and all rings of belt {} are on the same body",
                quoted(name)
            ),
            "a belt acts between two bodies: put an end or a ring on another; `frame` is the absolute frame",
        ),
    };
    reader
        .resolver
        .problems
        .add(reader.at.key("to").problem(message, help));
}

/// Reports a curve that does not rise all the way where a tension must have one elongation.
pub(super) fn check_tensions(reader: &Reader<'_, '_, '_>, belt: &Belt) {
    let check =
        |what, path| check_invertible(reader.resolver, &belt.force, what, reader.at.path(path));
    if belt.limiter.is_some() {
        check("limiter", "limiter.force");
    }
    if belt
        .retractor
        .as_ref()
        .is_some_and(|reel| !reel.spool.is_zero())
    {
        check("retractor", "retractor.spool");
    }
    if matches!(belt.length, BeltLength::Pretension(_)) {
        check("pretension", "pretension");
    }
}

/// Reports a curve that does not rise, or fall, all the way from (0, 0): a tension then does not belong to exactly one
/// elongation, as `what` requires. The factor of the curve is checked by a requirement of the force.
fn check_invertible(resolver: &Resolver<'_>, force: &ScaledCurve, what: &str, at: At<'_>) {
    let Some((curve, _)) = resolver.curve_of(force) else {
        return;
    };
    let signs = curve.points.windows(2).map(|pair| pair[1][1] - pair[0][1]);
    let signs: Vec<f64> = signs.collect();
    let all = |sign: f64| signs.iter().all(|step| step * sign > 0.0);
    if curve.points[0] != [0.0, 0.0] || !(all(1.0) || all(-1.0)) {
        resolver.problems.add(at.problem(
            format!("with a {what}, the force curve must rise strictly from (0, 0), or the length is not determined"),
            match what {
                "pretension" => "begin the curve with [0, 0] and let every ordinate be larger than the one before, or give `length`",
                _ => "begin the curve with [0, 0] and let every ordinate be larger than the one before",
            },
        ));
    }
}

/// The rotation at the start of the vehicle or frame that carries the root of a system.
fn reference_rotation(resolver: &Resolver<'_>, system: &System) -> Matrix {
    match &system.reference {
        Reference::Riding { vehicle, .. } => {
            vehicle_start(&resolver.vehicles[*vehicle], &resolver.defaults).0
        }
        _ => IDENTITY,
    }
}

/// Reports a belt whose ends coincide at the start, so that its untensioned length is 0.
pub(crate) fn check_length(belt: &Belt, resolver: &Resolver<'_>, name: &str, at: At<'_>) {
    let slack = match &belt.length {
        BeltLength::Given(_) => return,
        BeltLength::Slack(slack) => slack.value(&resolver.defaults),
        BeltLength::Pretension(_) => 0.0,
    };
    let frames = resolver.systems.iter();
    let frames = frames.map(|s| start(s, reference_rotation(resolver, s), &resolver.defaults));
    let frames: Vec<_> = frames.collect();
    let place = |point| place(point, &frames, &resolver.vehicles, &resolver.defaults);
    let points: Vec<_> = belt.points().map(place).collect();
    let ends = points.windows(2);
    let apart: f64 = ends.map(|ends| distance(ends[0], ends[1])).sum();
    if apart + slack < SHORTEST {
        resolver.problems.add(at.key("belt").problem(
            must_have_length(name),
            "move one end, or give `length` or `slack`",
        ));
    }
}
