//! Switches are resolved in two steps: names come first, because forces wait for switches; triggers come after the
//! forces, because a trigger may observe a force.

use super::Resolver;
use super::name::Style;
use crate::description::expression::{ExpressionKind, parse};
use crate::description::load::Loaded;
use crate::description::measure::Expected;
use crate::description::output::Output as Looked;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::short_forms::Each;
use crate::description::switch::{Switch as Written, Trigger as WrittenTrigger};
use crate::description::unit::{Dimension, product};
use crate::model::{Active, Switch, Trigger};

/// The keys by which a trigger names a quantity.
const OF_QUANTITY: [&str; 12] = [
    "segment",
    "ring",
    "of",
    "what",
    "at",
    "component",
    "axes",
    "relative_to",
    "on",
    "about",
    "above",
    "below",
];

/// The names of all switches.
pub(super) fn switch_names(resolver: &Resolver<'_>, loaded: &Loaded) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for file in &loaded.files {
        let at = file.source.at().key("switches");
        for (index, written) in file.contents.switches.iter().flatten().enumerate() {
            let place = at.item(index).key("switch");
            if resolver.check_name(&written.switch, "a switch", Style::Either, place) {
                let names = all.iter().map(String::as_str);
                resolver.check_unique(&written.switch, "switches", names, place);
            }
            all.push(written.switch.clone());
        }
    }
    all
}

/// The checked forms of all switches; `None` for one that is wrong.
pub(super) fn switches(resolver: &Resolver<'_>, loaded: &Loaded) -> Vec<Option<Switch>> {
    let mut all = Vec::new();
    for file in &loaded.files {
        let at = file.source.at().key("switches");
        for (index, written) in file.contents.switches.iter().flatten().enumerate() {
            all.push(switch(resolver, written, at.item(index)));
        }
    }
    all
}

/// The time during which a force acts.
pub(super) fn active(
    resolver: &Resolver<'_>,
    since: Option<&str>,
    until: Option<&str>,
    at: At<'_>,
) -> Active {
    let of = |name: Option<&str>, key| resolver.switch_id(name?, at.key(key));
    let active = Active {
        since: of(since, "since"),
        until: of(until, "until"),
    };
    if active.since.is_some() && active.since == active.until {
        resolver.problems.add(at.key("until").problem(
            "the force begins and ends with the same switch, and so never acts",
            "name another switch, remove one of the two keys, or write `enabled: false`",
        ));
    }
    active
}

/// The checked form of a switch.
fn switch(resolver: &Resolver<'_>, written: &Written, at: At<'_>) -> Option<Switch> {
    let after = resolver.coefficient(written.after.as_ref(), at.key("after"));
    let (trigger, shown) = trigger(resolver, &written.when, at.key("when"))?;
    let switch = Switch {
        name: written.switch.clone(),
        trigger,
        after,
        shown,
    };
    resolver.judge(switch.requirements(), at);
    Some(switch)
}

/// The trigger of a switch: a time, or a quantity and its threshold. Also the unit in which the time or threshold is
/// written, with its SI value.
fn trigger(
    resolver: &Resolver<'_>,
    written: &WrittenTrigger,
    at: At<'_>,
) -> Option<(Trigger, (String, f64))> {
    const HELP: &str = "write `{ time: 10 ms }`, or `{ of: man/head, what: displacement, component: x, above: 0.1 }` with a quantity as in an output";
    if let Some(time) = &written.time {
        for key in OF_QUANTITY {
            if at.node.get(key).is_some() {
                resolver.problems.add(at.key(key).key_problem(
                    format!("the key \"{key}\" means nothing beside `time`"),
                    "a switch fires at a time or by a quantity; keep one of them",
                ));
            }
        }
        let time = Trigger::Time(resolver.number(time, at.key("time")));
        return Some((time, ("s".to_owned(), 1.0)));
    }
    let (Some(of), Some(what)) = (&written.of, &written.what) else {
        resolver
            .problems
            .add(at.problem("it is not said what makes the switch fire", HELP));
        return None;
    };
    let looked = Looked {
        name: String::new(),
        enabled: None,
        of: Each(of.clone()),
        what: what.clone(),
        at: written.at.clone(),
        component: written.component.map(Each),
        axes: written.axes.clone(),
        relative_to: written.relative_to.clone(),
        on: written.on.clone(),
        segment: written.segment,
        ring: written.ring.clone(),
        about: written.about,
        freedom: written.freedom.clone(),
        code: None,
        filter: None,
        unit: None,
        mirror: None,
    };
    let quantity = resolver.quantity(&looked, at, false);
    let (key, threshold) = match (&written.above, &written.below) {
        (Some(above), None) => ("above", above),
        (None, Some(below)) => ("below", below),
        (Some(_), Some(_)) => {
            resolver.problems.add(at.key("below").key_problem(
                "the switch has two thresholds",
                "keep one of `above` and `below`; a second switch may have the other",
            ));
            return None;
        }
        (None, None) => {
            resolver.problems.add(at.problem(
                "the switch has no threshold",
                "add `above: …` or `below: …`: it fires when the quantity is larger, or smaller, than that",
            ));
            return None;
        }
    };
    let (quantity, unit) = quantity?;
    let expected = Expected {
        name: "a threshold",
        dimension: product(unit).map_or(Dimension::ONE, |unit| unit.dimension),
    };
    let shown = written_in(threshold).unwrap_or((unit.to_owned(), 1.0));
    resolver.inputs_may_stand.set(true);
    let threshold = resolver.number_in(threshold, at.key(key), expected);
    resolver.inputs_may_stand.set(false);
    let trigger = match key {
        "above" => Trigger::Above(quantity, threshold),
        _ => Trigger::Below(quantity, threshold),
    };
    Some((trigger, shown))
}

/// The unit of a written number, and its SI value.
fn written_in(quantity: &Quantity) -> Option<(String, f64)> {
    let Quantity::Text(text) = quantity else {
        return None;
    };
    let unit = match parse(text).ok()?.kind {
        ExpressionKind::Quantity(_, unit) => unit,
        ExpressionKind::Negative(positive) => match positive.kind {
            ExpressionKind::Quantity(_, unit) => unit,
            _ => return None,
        },
        _ => return None,
    };
    let number = |c: char| c.is_ascii_digit() || ".+-eE ".contains(c);
    Some((
        text.trim_start_matches(number).trim().to_owned(),
        unit.factor,
    ))
}
