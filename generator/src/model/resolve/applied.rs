//! Forces as written to laws: fields here, the others in files of their own.
//!
//! A coefficient that is 0 and a curve that is 0 everywhere are as if they had not been written.

use super::Resolver;
use super::name::Style;
use super::quantity::{ACCELERATION, Expected};
use crate::description::force::{Field, Force as Written};
use crate::description::place::At;
use crate::description::quantity::Quantity as WrittenQuantity;
use crate::diagnostic::{quoted, suggestion};
use crate::model::{ElementId, Force, ForceKind, Friction, Number};

impl Resolver<'_> {
    /// Resolves a force.
    pub fn force(&mut self, written: &Written, at: At<'_>) {
        let (kind, name, enabled) = match written {
            Written::Joint(f) => ("joint", f.path(), f.enabled),
            Written::Field(f) => ("field", f.field.clone(), f.enabled),
            Written::Contact(f) => ("contact", f.contact.clone(), f.enabled),
            Written::Belt(f) => ("belt", f.belt.clone(), f.enabled),
            Written::Spring(f) => ("spring", f.spring.clone(), f.enabled),
            Written::Airbag(f) => ("airbag", f.airbag.clone(), f.enabled),
            Written::Load(f) => ("load", f.load.clone(), f.enabled),
            Written::User(f) => ("user", f.user.clone(), f.enabled),
        };
        let name = name.as_str();
        let (since, until) = match written {
            Written::Joint(f) => (&f.since, &f.until),
            Written::Field(f) => (&f.since, &f.until),
            Written::Contact(f) => (&f.since, &f.until),
            Written::Belt(f) => (&f.since, &f.until),
            Written::Spring(f) => (&f.since, &f.until),
            Written::Airbag(_) => (&None, &None),
            Written::Load(f) => (&f.since, &f.until),
            Written::User(f) => (&f.since, &f.until),
        };
        let active = self.active(since.as_deref(), until.as_deref(), at);
        let place = at.key(kind);
        let named = match (kind, written) {
            (_, Written::Joint(f)) => f.name.as_ref().is_none_or(|name| {
                self.check_name(name, "a joint force", Style::Either, at.key("name"))
            }),
            ("user", _) => self.check_name(name, "a user force", Style::Either, place),
            ("airbag", _) => self.check_name(name, "an airbag", Style::Either, place),
            _ => self.check_name(name, &format!("a {kind}"), Style::Either, place),
        };
        if named {
            let same = self
                .forces
                .iter()
                .filter(|f| kind_of(&f.kind) == kind)
                .map(|f| f.name.as_str());
            let off = self
                .disabled
                .iter()
                .filter(|(k, _)| *k == kind)
                .map(|(_, n)| n.as_str());
            if kind == "joint" {
                if same.chain(off).any(|n| n == name) {
                    self.problems.add(place.problem(
                        format!("there are two joint forces {}", quoted(name)),
                        "write all laws of a joint in one force, or give one of them a name: `name: broken`",
                    ));
                }
            } else {
                let all = match kind {
                    "user" => "user forces".to_owned(),
                    kind => format!("{kind}s"),
                };
                self.check_unique(name, &all, same.chain(off), place);
            }
        }
        let resolved = match written {
            Written::Joint(f) => self.joint(f, at),
            Written::Field(f) => self.field(f, at),
            Written::Contact(f) => self.contact(f, at),
            Written::Belt(f) => self.belt(f, at),
            Written::Spring(f) => self.spring(f, at),
            Written::Airbag(f) => self.airbag(f, at),
            Written::Load(f) => self.load(f, at),
            Written::User(f) => self.user(f, at),
        };
        let off = enabled == Some(false);
        if off || resolved.is_none() {
            self.disabled.push((kind, name.to_owned()));
        }
        if let Some(kind) = resolved {
            let force = Force {
                name: name.to_owned(),
                kind,
                active,
            };
            let curve = |index: usize| self.curves.get(index)?.as_ref().map(|m| &m.curve);
            self.judge(force.requirements(self.dimension(), &curve), at);
            let list = if off { &mut self.off } else { &mut self.forces };
            list.push(force);
        }
    }

    /// Coulomb friction; `None` where its limit is 0 or left out.
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
                self.number(speed, place, of_speed)
            }
        };
        let limit = self.coefficient(limit, at.key("friction"), of_limit)?;
        Some(Friction { limit, tolerance })
    }

    /// The abscissa up to which damping fades in; `None` where it is 0 or nothing is damped.
    ///
    /// `damping` as written, and whether it is there; the key as written, with its place; what it is, and its default.
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
        self.coefficient(Some(quantity), at, expected)
            .filter(|_| damps)
    }

    fn field(&mut self, written: &Field, at: At<'_>) -> Option<ForceKind> {
        let acceleration = self.components(
            &written.acceleration,
            at.key("acceleration"),
            &format!("field {}", written.field),
            ACCELERATION,
        );
        Some(ForceKind::Field {
            on: self.elements_of(written.on.as_deref(), at.key("on"))?,
            acceleration,
        })
    }

    /// The elements of systems and elements named; all where nothing is named.
    fn elements_of(&self, names: Option<&[String]>, at: At<'_>) -> Option<Vec<ElementId>> {
        let of_system = |system: usize| {
            (0..self.systems[system].elements.len())
                .map(move |element| ElementId { system, element })
        };
        let Some(names) = names else {
            return Some((0..self.systems.len()).flat_map(of_system).collect());
        };
        let mut chosen = Vec::new();
        let before = self.problems.count();
        for (index, name) in names.iter().enumerate() {
            let here = at.item(index);
            let added: Vec<ElementId> = match self.systems.iter().position(|s| s.name == *name) {
                Some(system) => of_system(system).collect(),
                None if name.contains('/') => self.element_id(name, here).into_iter().collect(),
                None => {
                    let systems = self.systems.iter().map(|s| s.name.as_str());
                    let inside = self
                        .paths
                        .iter()
                        .find(|p| p.rsplit('/').next() == Some(name));
                    self.problems.add(here.problem(
                        format!("there is no system {}", quoted(name)),
                        match inside {
                            Some(path) => format!("did you mean the element {}?", quoted(path)),
                            None => suggestion(name, systems, "the model has no systems"),
                        },
                    ));
                    continue;
                }
            };
            if let Some(&twice) = added.iter().find(|id| chosen.contains(*id)) {
                self.problems.add(here.problem(
                    format!(
                        "the element {} feels this field twice",
                        quoted(&self.path(twice))
                    ),
                    "name a system, or some of its elements, and each once",
                ));
            }
            chosen.extend(added);
        }
        if names.is_empty() {
            self.problems.add(at.problem(
                "the field acts on nothing",
                "name systems or elements, or leave `on` out for all",
            ));
        }
        chosen.sort_unstable();
        chosen.dedup();
        (self.problems.count() == before).then_some(chosen)
    }
}

/// The key that names a force of this kind.
pub fn kind_of(kind: &ForceKind) -> &'static str {
    kind.key()
}
