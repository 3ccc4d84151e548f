//! Turns written forces into checked ones. A coefficient that is 0, or a curve that is 0 everywhere, counts as not
//! written.

use super::Resolver;
use super::name::Style;
use super::switch::active;
use crate::description::force::LawKeys;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::Force;
use crate::model::law::Law;
use crate::model::resolve::law::Header;

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
        check_name(resolver, name, keys, at.key(key));
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
fn check_name(resolver: &Resolver<'_>, name: &str, law: &LawKeys, place: At<'_>) {
    let same = resolver.forces.iter().filter(|f| f.law.key() == law.key);
    let off = resolver.disabled.iter().filter(|(key, _)| *key == law.key);
    let mut earlier = same
        .map(|f| f.name.as_str())
        .chain(off.map(|(_, name)| name.as_str()));
    let all = law.called();
    match law.same_name_advice {
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
