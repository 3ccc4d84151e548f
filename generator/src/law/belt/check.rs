//! Belts: two ends, a tension curve against relative elongation, a positive untensioned length, and devices that change
//! it.

use super::keys::{
    Belt as Written, Limiter as WrittenLimiter, Pretensioner as WrittenPretensioner,
    Retractor as WrittenRetractor,
};
use crate::description::measure::{Expected, FORCE, LENGTH, PURE, STIFFNESS};
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::diagnostic::quoted;
use crate::model::resolve::Resolver;
use crate::model::resolve::hysteresis::Unloading;
use crate::model::resolve::kinematics::{IDENTITY, Matrix, distance, place, start, vehicle_start};
use crate::model::resolve::quantity::Measure;
use crate::model::{Attachment, Hysteresis, Number, Reference, Rule, ScaledCurve, System};
use serde::Serialize;

/// Stretch from which on damping has its full size, if the user gives none \[m\].
const DAMPING_STRETCH: f64 = 1e-3;

/// Slope of a curve against relative elongation.
const SLOPE: Expected = Expected {
    name: "a force per elongation",
    dimension: FORCE.dimension,
};

/// The condition on the factor of a belt's curve, in the words of a requirement.
fn no_force(belt: &str) -> String {
    let rule = Rule::NotZero.words();
    format!("`force.times` of belt {} {rule}", quoted(belt))
}

/// A belt between two attachments.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Belt {
    /// One end.
    pub from: Attachment,
    /// The other end.
    pub to: Attachment,
    /// The rings that it runs through, in order from `from`.
    pub rings: Vec<Ring>,
    /// Tension as a function of the relative elongation (L − L₀)/L₀ → \[N\].
    pub force: ScaledCurve,
    /// A different curve for unloading, against the relative elongation.
    pub hysteresis: Option<Hysteresis>,
    /// Viscous coefficient on the rate of stretch \[N s/m\]; the tension is never negative, and zero while the belt is
    /// slack.
    pub damping: Option<Number>,
    /// Stretch up to which damping grows from 0 to its full size \[m\]; `None` for full damping at once.
    pub damping_stretch: Option<Number>,
    /// Untensioned length L₀; not used with a retractor.
    pub length: BeltLength,
    /// Pays out webbing until it locks. It is at the end `from`, as are pretensioner and limiter.
    pub retractor: Option<Retractor>,
    /// Tension of the reel beyond that of the spool once the retractor has locked, against the webbing that has come
    /// off the reel since \[m\] → \[N\].
    pub film_spool: Option<ScaledCurve>,
    /// Takes webbing in after its switch fires.
    pub pretensioner: Option<Pretensioner>,
    /// Largest tension \[N\]. Where the tension would be larger, webbing is paid out for good.
    pub limiter: Option<Number>,
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

/// A reel that pays out and takes in webbing under a constant tension until it locks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Retractor {
    /// The switch that locks the reel: index into [`Model::switches`](crate::model::Model::switches).
    pub lock: usize,
    /// Tension until the reel locks \[N\], not negative.
    pub spool: Number,
}

/// A ring that a belt slips through.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ring {
    /// Name, unique in the belt.
    pub name: String,
    /// The position of the ring.
    pub on: Attachment,
    /// Coefficient of friction μ: webbing slips if the tensions differ by more than the factor e^(μ θ).
    pub friction: Option<Number>,
    /// Resistance: tension beyond the ratio e^(μθ), divided by the rate of slip \[N s/m\], positive.
    pub resistance: Number,
}

/// A device that takes webbing in.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pretensioner {
    /// The switch that fires the device: index into [`Model::switches`](crate::model::Model::switches).
    pub fire: usize,
    /// Time from firing until webbing is taken in \[s\], not negative.
    pub delay: Option<Number>,
    /// Length taken in against the time since then \[s\] → \[m\], beginning at (0, 0).
    pub retract: ScaledCurve,
}

/// The checked form of a belt.
pub(crate) fn belt(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<Belt> {
    let name = &written.belt;
    let from = resolver.end(&written.from, at.key("from"));
    let to = resolver.end(&written.to, at.key("to"));
    let rings = rings(resolver, written, at);
    if let (Some(from), Some(to)) = (&from, &to) {
        check_bodies(resolver, name, [from, to], rings.as_deref(), at.key("to"));
    }
    let force = acting_tension(resolver, written, at);
    let length = untensioned(resolver, written, at, force.as_ref());
    let damping = resolver.coefficient(written.damping.as_ref(), at.key("damping"));
    let damping_stretch = resolver.fade(
        (written.damping.as_deref(), damping.is_some()),
        (
            written.damping_stretch.as_deref(),
            at.key("damping_stretch"),
        ),
        (LENGTH, DAMPING_STRETCH),
    );
    let hysteresis = resolver.hysteresis(
        force.as_ref(),
        Unloading {
            curve: written.unloading.as_deref(),
            slope: written.unloading_slope.as_deref(),
            loading: ("force", true),
            at,
            expected: [PURE, FORCE, SLOPE],
        },
    );
    let limiter = written
        .limiter
        .as_ref()
        .map(|l| limiter(resolver, l, at.key("limiter"), force.as_ref()));
    let reel = written.retractor.as_ref();
    let retractor = reel.map(|r| retractor(resolver, r, at, force.as_ref()));
    let film_spool = reel.and_then(|r| film_spool(resolver, &written.belt, r, at.key("retractor")));
    let pretensioner = written
        .pretensioner
        .as_ref()
        .and_then(|p| pretensioner(resolver, p, at.key("pretensioner")));
    Some(Belt {
        from: from?,
        to: to?,
        rings: rings?,
        force: force?,
        hysteresis,
        damping,
        damping_stretch,
        length,
        retractor: match retractor {
            Some(retractor) => Some(retractor?),
            None => None,
        },
        film_spool,
        pretensioner,
        limiter,
    })
}

/// Reports a belt whose ends and rings are all on one body. `rings` is `None` if one of them is wrong.
fn check_bodies(
    resolver: &Resolver<'_>,
    name: &str,
    [from, to]: [&Attachment; 2],
    rings: Option<&[Ring]>,
    at: At<'_>,
) {
    let mut others = rings.into_iter().flatten();
    if from.on != to.on || others.any(|ring| ring.on.on != from.on) {
        return;
    }
    let (message, help) = match rings.is_some_and(<[Ring]>::is_empty) {
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
    resolver.problems.add(at.problem(message, help));
}

/// The rings that the belt runs through; `None` if one of them is wrong.
fn rings(resolver: &Resolver<'_>, written: &Written, at: At<'_>) -> Option<Vec<Ring>> {
    let at = at.key("through");
    let mut rings: Vec<Ring> = Vec::new();
    let mut all = true;
    for (index, ring) in written.through.iter().flatten().enumerate() {
        let at = at.item(index);
        let name = &ring.ring;
        if rings.iter().any(|other| other.name == *name) {
            resolver.problems.add(at.key("ring").problem(
                format!(
                    "belt {} has two rings {}",
                    quoted(&written.belt),
                    quoted(name)
                ),
                "give each ring of a belt another name",
            ));
        }
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            resolver.problems.add(at.key("ring").problem(
                "the name of a ring is empty or not one line",
                "give it a name: outputs and effects call it by that",
            ));
        }
        let friction = resolver.coefficient(ring.friction.as_ref(), at.key("friction"));
        let resistance = match &ring.resistance {
            Some(given) => resolver.number(given, at.key("resistance")),
            None => RESISTANCE.into(),
        };
        let position = resolver.vector(&ring.at, at.key("at"));
        match resolver.body(&ring.on, at.key("on")) {
            Some(on) => rings.push(Ring {
                name: name.clone(),
                on: Attachment { on, at: position },
                friction,
                resistance,
            }),
            None => all = false,
        }
    }
    all.then_some(rings)
}

/// The curve of the film spool: tension of a locked reel beyond that of the spool, against the webbing that has come
/// off it.
fn film_spool(
    resolver: &mut Resolver<'_>,
    belt: &str,
    written: &WrittenRetractor,
    at: At<'_>,
) -> Option<ScaledCurve> {
    let place = at.key("film_spool");
    let before = resolver.problems.count();
    let film = resolver.function(written.film_spool.as_ref()?, place);
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

/// The curve of tension against relative elongation. A curve that is 0 everywhere is reported.
fn acting_tension(
    resolver: &mut Resolver<'_>,
    written: &Written,
    at: At<'_>,
) -> Option<ScaledCurve> {
    let name = &written.belt;
    let before = resolver.problems.count();
    let force = tension(resolver, written, at);
    if force.is_none() && resolver.problems.count() == before {
        let (place, times) = match &written.force {
            Some(_) => {
                let place = at.key("force");
                (place, place.node.get("times").is_some())
            }
            None => (at.key("stiffness"), false),
        };
        resolver.problems.add(place.problem(
            match times {
                true => no_force(name),
                false => format!("belt {} has no force at any elongation", quoted(name)),
            },
            "give a curve that is not zero everywhere, or switch the belt off by `enabled: false`",
        ));
    }
    force
}

/// The curve of tension against relative elongation; `None` if it is wrong, missing, or 0 everywhere.
fn tension(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<ScaledCurve> {
    if written.force.is_none() && written.stiffness.is_none() {
        resolver.problems.add(at.problem(
            format!("belt {} has no force", quoted(&written.belt)),
            "add `force: …`, a curve of the relative elongation, or `stiffness: …` for a straight one",
        ));
        return None;
    }
    if let (None, Some(stiffness)) = (&written.force, &written.stiffness)
        && let Some(slope) = per_length(resolver, written, stiffness, at)
    {
        return resolver.line(at.key("stiffness"), slope);
    }
    resolver.elastic_in(
        ("force", written.force.as_deref()),
        written.stiffness.as_deref(),
        at,
        [PURE, FORCE, SLOPE],
    )
}

/// A stiffness in newtons per metre, converted to force per relative elongation; `None` for a stiffness in newtons.
fn per_length(
    resolver: &Resolver<'_>,
    written: &Written,
    stiffness: &Quantity,
    at: At<'_>,
) -> Option<Number> {
    let place = at.key("stiffness");
    let before = resolver.problems.count();
    let measured = resolver.measured(stiffness, place);
    let Some((number, Measure::Known(dimension))) = measured else {
        // 0 after a problem, so that the caller does not report it again
        return (resolver.problems.count() > before).then_some(Number::ZERO);
    };
    if dimension != STIFFNESS.dimension {
        return None;
    }
    let Some(length) = &written.length else {
        resolver.problems.add(place.problem(
            "a stiffness per length needs the untensioned length of the belt, which here follows from the scene",
            "give `length` too, or the force per relative elongation: 50 N/mm of a belt of 0.5 m are 25 kN",
        ));
        return Some(Number::ZERO);
    };
    let length = resolver.number(length, at.key("length"));
    Some(Number::product(number, length))
}

/// The largest tension.
fn limiter(
    resolver: &Resolver<'_>,
    written: &WrittenLimiter,
    at: At<'_>,
    force: Option<&ScaledCurve>,
) -> Number {
    let place = at.key("force");
    if let Some(force) = force {
        check_invertible(resolver, force, "limiter", place);
    }
    resolver.number(&written.force, place)
}

/// The reel; `None` if its switch is wrong.
fn retractor(
    resolver: &Resolver<'_>,
    written: &WrittenRetractor,
    at: At<'_>,
    force: Option<&ScaledCurve>,
) -> Option<Retractor> {
    for key in ["slack", "pretension", "length"] {
        if at.node.get(key).is_some() {
            resolver.problems.add(at.key(key).key_problem(
                "with a retractor the untensioned length follows from where it locks",
                format!("remove `{key}`; the tension until it locks is its `spool`"),
            ));
        }
    }
    let at = at.key("retractor");
    let lock = resolver.switch_id(&written.lock, at.key("lock"));
    let place = at.key("spool");
    let spool = resolver.coefficient(written.spool.as_ref(), place);
    let spool = spool.unwrap_or(Number::ZERO);
    if let (Some(force), false) = (force, spool.is_zero()) {
        check_invertible(resolver, force, "retractor", place);
    }
    Some(Retractor { lock: lock?, spool })
}

/// The pretensioner; `None` if its switch is wrong, or it takes nothing in.
fn pretensioner(
    resolver: &mut Resolver<'_>,
    written: &WrittenPretensioner,
    at: At<'_>,
) -> Option<Pretensioner> {
    let fire = resolver.switch_id(&written.fire, at.key("fire"));
    let place = at.key("retract");
    let retract = resolver.function(&written.retract, place)?;
    let first = resolver
        .curve_of(&retract)
        .map(|(curve, _)| curve.points[0]);
    if first.is_some_and(|point| point != [0.0, 0.0]) {
        resolver.problems.add(place.problem(
            "a pretensioner begins with nothing at the time of its firing",
            "begin the curve with [0, 0]; its abscissa is the time since the switch",
        ));
    }
    let delay = resolver.coefficient(written.delay.as_ref(), at.key("delay"));
    Some(Pretensioner {
        fire: fire?,
        delay,
        retract,
    })
}

/// The untensioned length, in the way in which it is written.
fn untensioned(
    resolver: &Resolver<'_>,
    written: &Written,
    at: At<'_>,
    force: Option<&ScaledCurve>,
) -> BeltLength {
    let given: Vec<(&str, &Quantity)> = [
        ("slack", written.slack.as_deref()),
        ("pretension", written.pretension.as_deref()),
        ("length", written.length.as_deref()),
    ]
    .into_iter()
    .filter_map(|(key, quantity)| Some((key, quantity?)))
    .collect();
    let none = BeltLength::Slack(Number::ZERO);
    let &[(key, quantity)] = given.as_slice() else {
        if let [_, (second, _), ..] = given[..] {
            resolver.problems.add(at.key(second).key_problem(
                format!("the length of belt {} is given twice, by {} and {second}", quoted(&written.belt), given[0].0),
                "keep one of `slack`, `pretension`, `length`; without any the belt is just taut at the start",
            ));
        }
        return none;
    };
    let place = at.key(key);
    let expected = if key == "pretension" { FORCE } else { LENGTH };
    let number = resolver.number_in(quantity, place, expected);
    match key {
        "length" => BeltLength::Given(number),
        "slack" => BeltLength::Slack(number),
        _ if number.is_zero() => none,
        _ => {
            if let Some(force) = force {
                check_invertible(resolver, force, "pretension", place);
            }
            BeltLength::Pretension(number)
        }
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
