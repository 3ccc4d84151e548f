//! Turns written forces into checked ones; also the parts that several laws have: friction, its bristles, and damping
//! that fades in.
//!
//! A coefficient that is 0, or a curve that is 0 everywhere, counts as not written.

use super::Resolver;
use super::name::Style;
use super::switch::active;
use crate::description::force::LawKeys;
use crate::description::measure::Expected;
use crate::description::place::At;
use crate::description::quantity::Quantity as WrittenQuantity;
use crate::diagnostic::quoted;
use crate::model::law::Law;
use crate::model::resolve::law::Header;
use crate::model::{Bristle, Force, Friction, Number};

/// Checks a law as written. `None`, with a report, if nothing useful is left.
pub(crate) type Check<'w> = dyn Fn(&mut Resolver<'_>, At<'_>) -> Option<Box<dyn Law>> + 'w;

/// Enters a force of the law with this key: its checked form, or the fact that it is switched off.
pub(crate) fn force(
    resolver: &mut Resolver<'_>,
    key: &'static str,
    header: &Header<'_>,
    check: &Check<'_>,
    at: At<'_>,
) {
    let mut laws = resolver.kinds.language.laws.iter();
    let Some(keys) = laws.find(|law| law.key == key) else {
        return;
    };
    let name = &header.name;
    let active = active(resolver, header.since, header.until, at);
    let called = header.called.is_none_or(|(key, name)| {
        resolver.check_name(name, keys.title, Style::Either, at.key(key))
    });
    if called {
        check_twice(resolver, name, keys, at.key(key));
    }
    resolver.owner = format!("{key} {name}");
    resolver.owners.push(resolver.owner.clone());
    resolver.of_force = true;
    let resolved = check(resolver, at.base());
    resolver.of_force = false;
    let off = header.enabled == Some(false);
    if off || resolved.is_none() {
        resolver.disabled.push((key, name.clone()));
    }
    if let Some(law) = resolved {
        let name = name.clone();
        let force = Force { name, law, active };
        let curve = |index: usize| resolver.curves.get(index)?.as_ref().map(|m| &m.curve);
        resolver.judge(force.requirements(resolver.dimension(), &curve), at);
        let list = if off {
            &mut resolver.off
        } else {
            &mut resolver.forces
        };
        list.push(force);
    }
}

/// Reports a force with the same name as another of the same law.
fn check_twice(resolver: &Resolver<'_>, name: &str, law: &LawKeys, place: At<'_>) {
    let same = resolver.forces.iter().filter(|f| f.law.key() == law.key);
    let off = resolver.disabled.iter().filter(|(key, _)| *key == law.key);
    let mut earlier = same
        .map(|f| f.name.as_str())
        .chain(off.map(|(_, name)| name.as_str()));
    let all = law.called();
    match law.twice {
        Some(help) if earlier.any(|other| other == name) => {
            let message = format!("there are two {all}s {}", quoted(name));
            resolver.problems.add(place.problem(message, help));
        }
        Some(_) => {}
        None => {
            resolver.check_unique(name, &format!("{all}s"), earlier, place);
        }
    }
}

impl Resolver<'_> {
    /// Coulomb friction; `None` if its limit is 0 or missing.
    pub fn friction(
        &self,
        limit: Option<&WrittenQuantity>,
        speed: Option<&WrittenQuantity>,
        at: At<'_>,
        (of_limit, of_speed, default): (Expected, Expected, f64),
    ) -> Option<Friction> {
        let tolerance = match speed {
            None => Number::Constant(default),
            Some(speed) => {
                let place = at.key("friction_speed");
                if limit.is_none() {
                    self.problems.add(place.key_problem(
                        "a friction speed means nothing without friction",
                        "add `friction: …`, or remove `friction_speed`",
                    ));
                }
                self.number_in(speed, place, of_speed)
            }
        };
        let limit = self.coefficient_in(limit, at.key("friction"), of_limit)?;
        Some(Friction { limit, tolerance })
    }

    /// The bristle by which friction holds; `None` if there is no friction or no displacement.
    ///
    /// `limit` is the friction limit as written, `rubs` is true if there is friction; `displacement` is the value of
    /// the key `friction_displacement`, a quantity `expected`.
    pub fn bristle(
        &self,
        (limit, rubs): (Option<&WrittenQuantity>, bool),
        displacement: Option<&WrittenQuantity>,
        at: At<'_>,
        expected: Expected,
    ) -> Option<Bristle> {
        let place = at.key("friction_displacement");
        if displacement.is_some() && limit.is_none() {
            self.problems.add(place.key_problem(
                "a friction displacement means nothing without friction",
                "add `friction: …`, or remove `friction_displacement`",
            ));
        }
        self.coefficient_in(displacement, place, expected)
            .filter(|_| rubs)
            .map(|displacement| Bristle { displacement })
    }

    /// The abscissa up to which damping fades in; `None` if it is 0 or there is no damping.
    ///
    /// `damping` is the coefficient as written, and `damps` is true if it is not 0; `written` is the value of the key
    /// at `at`, a quantity `expected`, and `default` its default.
    pub fn fade(
        &self,
        (damping, damps): (Option<&WrittenQuantity>, bool),
        (written, at): (Option<&WrittenQuantity>, At<'_>),
        (expected, default): (Expected, f64),
    ) -> Option<Number> {
        let Some(quantity) = written else {
            return damps.then_some(Number::Constant(default));
        };
        if damping.is_none() {
            self.problems.add(at.key_problem(
                "there is no damping to fade in",
                "add `damping: …`, or remove this key",
            ));
        }
        self.coefficient_in(Some(quantity), at, expected)
            .filter(|_| damps)
    }
}
