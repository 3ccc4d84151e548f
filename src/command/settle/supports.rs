//! Finds out why a model slides instead of coming to rest: which contacts and belts carry load but give way.

use bryant_generator::law::ForceKind;
use bryant_generator::model::Model;
use bryant_runtime::Info;

/// A switch whose time of firing is larger has not fired \[s\].
const EVER: f64 = 1e9;
/// Largest number of reasons; those with the largest forces are kept.
const MOST: usize = 4;

/// A sentence for each contact and belt that gives way under any load and carried load during the search. `carried` has
/// names and largest forces \[N\].
pub fn reasons(
    model: &Model,
    info: &Info,
    state: &[f64],
    carried: &[(String, f64)],
) -> Vec<String> {
    let before = info.coordinates.len() + info.velocities.len() + info.auxiliaries.len();
    let fired = |switch: usize| {
        let name = format!("switch {}: fired", model.switches[switch].name);
        let index = info.memory.iter().position(|one| *one == name);
        index.is_some_and(|index| state[before + index] < EVER)
    };
    let carries = |name: &str| {
        let of = |(one, _): &&(String, f64)| {
            one == name
                || one
                    .strip_prefix(name)
                    .is_some_and(|rest| rest.starts_with(", segment"))
        };
        carried.iter().find(of).map(|(_, force)| *force)
    };
    let mut reasons: Vec<(f64, String)> = Vec::new();
    for force in &model.forces {
        let name = &force.name;
        let Some(load) = carries(name) else { continue };
        let reason = match ForceKind::of(force) {
            ForceKind::Contact(contact)
                if contact.friction.is_some() && contact.bristle.is_none() =>
            {
                format!(
                    "contact \"{name}\" (up to {load:.0} N) slides: friction by speed does not hold; give it `friction_displacement`"
                )
            }
            ForceKind::Belt(belt)
                if belt
                    .retractor
                    .as_ref()
                    .is_some_and(|reel| !fired(reel.lock)) =>
            {
                format!(
                    "belt \"{name}\" (up to {load:.0} N) hangs in a reel that is not locked, and pays out; let something else hold the body, or lock the reel"
                )
            }
            _ => continue,
        };
        reasons.push((load, reason));
    }
    reasons.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    reasons.truncate(MOST);
    reasons.into_iter().map(|(_, reason)| reason).collect()
}
