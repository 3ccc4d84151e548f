//! Belts: two ends, a curve of relative elongation, and an untensioned length that is positive.

use super::Resolver;
use super::kinematics::{distance, place, start};
use super::quantity::{FORCE, LENGTH, LINEAR_DAMPING, PURE};
use crate::description::force::{Attachment as WrittenEnd, Belt as Written, Force};
use crate::description::load::Loaded;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::diagnostic::quoted;
use crate::model::{Attachment, Belt, BeltLength, Extrapolate, ForceKind, Number, ScaledCurve};

/// Shortest untensioned length \[m\].
const SHORTEST: f64 = 1e-6;

impl Resolver<'_> {
    /// Resolves a belt.
    pub fn belt(&mut self, written: &Written, at: At<'_>) -> Option<ForceKind> {
        let name = &written.belt;
        let from = self.end(&written.from, at.key("from"));
        let to = self.end(&written.to, at.key("to"));
        if let (Some(a), Some(b)) = (&from, &to)
            && a.on == b.on
        {
            self.problems.add(at.key("to").problem(
                format!("both ends of belt {} are on the same body", quoted(name)),
                "a belt runs between two bodies; `frame` is the absolute frame",
            ));
        }
        let place = at.key("force");
        let before = self.problems.count();
        let force = self.function(
            &written.force,
            place,
            &format!("belt {name} force"),
            PURE,
            FORCE,
        );
        if force.is_none() && self.problems.count() == before {
            self.problems.add(place.problem(
                format!("belt {} has no force at any elongation", quoted(name)),
                "give a curve that is not zero everywhere, or switch the belt off by `enabled: false`",
            ));
        }
        let length = self.untensioned(written, at, force.as_ref());
        let damping = self.coefficient(written.damping.as_ref(), at.key("damping"), LINEAR_DAMPING);
        Some(ForceKind::Belt(Box::new(Belt {
            from: from?,
            to: to?,
            force: force?,
            damping,
            length,
        })))
    }

    fn end(&self, written: &WrittenEnd, at: At<'_>) -> Option<Attachment> {
        let position = self.vector(&written.at, at.key("at"), LENGTH);
        self.body(&written.on, at.key("on"))
            .map(|on| Attachment { on, at: position })
    }

    fn untensioned(
        &self,
        written: &Written,
        at: At<'_>,
        force: Option<&ScaledCurve>,
    ) -> BeltLength {
        let given: Vec<(&str, &Quantity)> = [
            ("slack", &written.slack),
            ("pretension", &written.pretension),
            ("length", &written.length),
        ]
        .into_iter()
        .filter_map(|(key, quantity)| Some((key, quantity.as_ref()?)))
        .collect();
        let none = BeltLength::Slack(Number::ZERO);
        let &[(key, quantity)] = given.as_slice() else {
            if let [_, (second, _), ..] = given[..] {
                self.problems.add(at.key(second).key_problem(
                    format!("the length of belt {} is given twice, by {} and {second}", quoted(&written.belt), given[0].0),
                    "keep one of `slack`, `pretension`, `length`; without any the belt is just taut at the start",
                ));
            }
            return none;
        };
        let place = at.key(key);
        let expected = if key == "pretension" { FORCE } else { LENGTH };
        let (number, value) = self.valued(quantity, place, expected);
        let Some(value) = value else { return none };
        let (bad, help) = match key {
            "length" => (value <= 0.0, "give a positive length"),
            "slack" => (
                value < 0.0,
                "a belt that pulls at the start has a `pretension`",
            ),
            _ => (
                value < 0.0,
                "a belt does not push; one that hangs loose at the start has `slack`",
            ),
        };
        if bad {
            self.problems.add(place.problem(
                format!(
                    "the {key} of belt {} is {value}{}",
                    quoted(&written.belt),
                    self.by_default(&number)
                ),
                help,
            ));
        }
        match key {
            "length" => BeltLength::Given(number),
            "slack" => BeltLength::Slack(number),
            _ if number.is_zero() => none,
            _ => {
                if let Some(force) = force {
                    self.check_pretension(force, value, place);
                }
                BeltLength::Pretension(number)
            }
        }
    }

    /// A pretension belongs to one elongation only where the curve rises all the way from (0, 0) to it.
    fn check_pretension(&self, force: &ScaledCurve, pretension: f64, at: At<'_>) {
        let Some((curve, factor)) = self.curve_of(force) else {
            return;
        };
        let rises = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) * factor > 0.0;
        let starts = curve.points[0] == [0.0, 0.0];
        let reach = curve.points[curve.points.len() - 1][1] * factor;
        let goes_on = curve.extrapolate == Extrapolate::Linear
            && curve.tangent(curve.points.len() - 1) * factor > 0.0;
        let reached = pretension <= reach || goes_on;
        if !starts || !curve.points.windows(2).all(rises) {
            self.problems.add(at.problem(
                "with a pretension, the force curve must rise strictly from (0, 0), or the length is not determined",
                "begin the curve with [0, 0] and let every ordinate be larger than the one before, or give `length`",
            ));
        } else if !reached {
            self.problems.add(at.problem(
                format!("the force curve ends at {reach} N and never reaches the pretension of {pretension} N"),
                "add points to the curve, or write `extrapolate: linear`",
            ));
        }
    }

    /// Reports belts whose ends coincide at the start, so that their untensioned length is nothing.
    pub fn check_belts(&self, loaded: &Loaded) {
        let frames: Vec<_> = self
            .systems
            .iter()
            .map(|s| start(s, &self.defaults))
            .collect();
        for force in &self.forces {
            let ForceKind::Belt(belt) = &force.kind else {
                continue;
            };
            let apart = distance(
                place(&belt.from, &frames, &self.vehicles, &self.defaults),
                place(&belt.to, &frames, &self.vehicles, &self.defaults),
            );
            let slack = match &belt.length {
                BeltLength::Given(_) => continue,
                BeltLength::Slack(slack) => slack.value(&self.defaults),
                BeltLength::Pretension(_) => 0.0,
            };
            if apart + slack < SHORTEST
                && let Some(at) = belt_place(loaded, &force.name)
            {
                self.problems.add(at.problem(
                    format!(
                        "the ends of belt {} coincide at the start, so its length is nothing",
                        quoted(&force.name)
                    ),
                    "move one end, or give `length` or `slack`",
                ));
            }
        }
    }
}

fn belt_place<'w>(loaded: &'w Loaded, name: &str) -> Option<At<'w>> {
    loaded.files.iter().find_map(|file| {
        let list = file.source.at().key("forces");
        let forces = file.contents.forces.iter().flatten();
        forces
            .enumerate()
            .find(|(_, f)| matches!(f, Force::Belt(b) if b.belt == name))
            .map(|(index, _)| list.item(index).key("belt"))
    })
}
