//! The terms of a belt: its curves, its untensioned length, its devices.

use super::check::{Belt, BeltLength};
use crate::model::declared::declared_terms;
use crate::model::law::Terms;
use crate::model::part::{Fresh, Part};
use crate::model::requirement::{Curves, List};
use crate::model::rule::{Rule, Ruled};
use crate::model::{Curve, Dimension, Extrapolate, Number};

impl Terms for Belt {
    declared_terms!(flatten);

    fn settle_terms(&mut self) {
        // Without an elastic force, no length gives the pretension.
        if !self.force.is_in() && matches!(self.length, BeltLength::Pretension(_)) {
            self.length.leave_out();
        }
        if !self.force.is_in() {
            self.hysteresis = None;
        }
        if self.damping.is_none() {
            self.damping_stretch = None;
        }
        // With a retractor, the length follows from the tension of its spool.
        match self.retractor {
            Some(_) => self.length.leave_out(),
            None => self.film_spool = None,
        }
    }

    fn require(&self, _: Dimension, curves: Curves<'_>, list: &mut List<'_>) {
        let times = &self.force.times;
        match self.force.stiffness {
            true => list.number("stiffness".into(), times, Rule::Positive),
            false => list.number("force.times".into(), times, Rule::NotZero),
        }
        if let Some(law) = &self.hysteresis {
            list.hysteresis("force", &self.force, law, curves);
        }
        if let Some(film) = &self.film_spool {
            list.together(
                "retractor.film_spool",
                "must come to an end",
                film.times.clone(),
                Rule::Positive,
                "scale the curve by a factor above 0; leave `film_spool` out for a reel that holds at once",
            );
        }
        let spool = self.retractor.as_ref().map(|r| &r.spool);
        if let (Some(spool), Some(limit)) = (spool, &self.limiter) {
            list.together(
                "retractor.spool",
                "must be smaller than the force of the limiter",
                Number::difference(limit.clone(), spool.clone()),
                Rule::Positive,
                "let `spool` be smaller than the force of the limiter",
            );
        }
        let pretension = match &self.length {
            BeltLength::Pretension(force) => Some(force),
            BeltLength::Given(_) | BeltLength::Slack(_) => None,
        };
        let tensions = [
            ("limiter", self.limiter.as_ref()),
            ("retractor.spool", spool.filter(|spool| !spool.is_zero())),
            ("pretension", pretension),
        ];
        let Some(curve) = curves(self.force.curve) else {
            return;
        };
        for (path, tension) in tensions {
            if let Some(tension) = tension {
                list.reached(path, tension, curve, times);
            }
        }
    }
}

/// The untensioned length, as a part that may be left out: then the belt is just taut at the start.
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

impl List<'_> {
    /// Adds the condition that the curve rises up to this tension, so that the tension has exactly one elongation. Its
    /// points decide whether it rises all the way.
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
}
