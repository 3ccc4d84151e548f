//! Systems: their elements, the motion of their reference joints, and their state at the start.

use super::channel::{Anatomy as BodyAxes, BodyPart};
use super::coupling::start_followers;
use super::element::tree;
use super::joint::freedoms_at_start;
use super::translation::translation;
use super::vehicle::{ridden_at_start, vehicle_named};
use super::{NOWHERE, Resolver, name::Style};
use crate::description::element::Anatomy;
use crate::description::load::Loaded;
use crate::description::place::At;
use crate::description::quantity::{Number as WrittenNumber, OneOrThree};
use crate::description::shape::Named;
use crate::description::system::{
    Prescribed, Reference as WrittenReference, Riding, Start, System as Written,
};
use crate::diagnostic::{quoted, suggestion};
use crate::model::Joint;
use crate::model::{Element, Number, Reference, System};

/// Everything that the files say about a system: its description, and then changes of it.
struct Entry<'w> {
    written: &'w Written,
    at: At<'w>,
    reference: Option<(&'w WrittenReference, At<'w>)>,
    /// In the order of the files; a later one overrides an earlier one.
    starts: Vec<(&'w Start, At<'w>)>,
}

impl<'w> Entry<'w> {
    /// The place of the last start that has this key.
    fn start_with(&self, key: &str) -> Option<At<'w>> {
        let mut starts = self.starts.iter().rev().map(|(_, at)| *at);
        starts.find(|at| at.node.get(key).is_some())
    }
}

/// Enters the systems of all files, with the paths of their elements.
pub(super) fn systems(resolver: &mut Resolver<'_>, loaded: &Loaded) {
    let mut entries: Vec<Entry> = Vec::new();
    for file in &loaded.files {
        let list = file.source.at().key("systems");
        for (index, written) in file.contents.systems.iter().flatten().enumerate() {
            collect(resolver, &mut entries, written, list.item(index));
        }
    }
    let Some(last) = loaded.files.last() else {
        return;
    };
    if entries.is_empty() && resolver.problems.count() == 0 {
        resolver.problems.add(last.source.at().problem(
            "the model has no systems",
            "add `systems:` with at least one element, or include a file that has them",
        ));
    }
    for entry in &entries {
        let system = system(resolver, entry);
        resolver.enter_system(system);
        parts(resolver, entry);
    }
    resolver.too_many_elements(last.source.at());
}

/// Enters the axes of each element that are forward and up, and the heads that include the neck.
fn parts(resolver: &mut Resolver<'_>, entry: &Entry<'_>) {
    let planar = resolver.planar;
    let read = |resolver: &Resolver<'_>, written: Option<&Anatomy>, at: At<'_>| {
        let read = BodyAxes::of(written?, planar);
        if read.is_none() {
            resolver.problems.add(at.key("anatomy").problem(
                "forward and up are not at right angles, or not in the plane",
                "write `anatomy: { forward: x, up: z }` with other axes, such as -x",
            ));
        }
        read
    };
    let system = &entry.written.name;
    let of_all = read(resolver, entry.written.anatomy.as_ref(), entry.at);
    for (index, element) in entry.written.elements.iter().flatten().enumerate() {
        let at = entry.at.key("elements").item(index);
        let own = read(resolver, element.anatomy.as_ref(), at);
        let part = BodyPart {
            anatomy: own.or(of_all).unwrap_or_default(),
            neck: element.neck,
        };
        let path = format!("{system}/{}", element.name);
        if let Some(id) = resolver.elements.get(&path) {
            resolver.parts.insert(*id, part);
        }
    }
}

/// Adds a system, or changes of a system that an included file describes.
fn collect<'w>(
    resolver: &Resolver<'_>,
    entries: &mut Vec<Entry<'w>>,
    written: &'w Written,
    at: At<'w>,
) {
    let place = at.key("name");
    let reference = written.reference.as_ref().map(|r| (r, at.key("reference")));
    let start = written.start.as_ref().map(|s| (s, at.key("start")));
    if written.elements.is_none() {
        match entries.iter_mut().find(|e| e.written.name == written.name) {
            Some(entry) => {
                entry.reference = reference.or(entry.reference);
                entry.starts.extend(start);
            }
            None => {
                let known = entries.iter().map(|e| e.written.name.as_str());
                resolver.problems.add(place.problem(
                    format!("the system {} has no elements", quoted(&written.name)),
                    match crate::diagnostic::nearest(&written.name, known) {
                        Some(near) => format!("add `elements:`; or did you mean the system {} described before?", quoted(near)),
                        None => "add `elements:`; only a system that an included file describes may be named without them".to_owned(),
                    },
                ));
            }
        }
        return;
    }
    if written.name == "frame" {
        resolver.problems.add(place.problem(
            "\"frame\" is the absolute frame and cannot be the name of a system",
            "use another name",
        ));
    }
    if resolver.vehicles.iter().any(|v| v.name == written.name) {
        resolver.problems.add(place.problem(
            format!("{} is a vehicle and a system", quoted(&written.name)),
            "give one of them another name",
        ));
    }
    let earlier = entries.iter().map(|e| e.written.name.as_str());
    resolver.check_name(&written.name, "a system", Style::Either, place);
    if resolver.check_unique(&written.name, "systems", earlier, place) {
        entries.push(Entry {
            written,
            at,
            reference,
            starts: start.into_iter().collect(),
        });
    }
}

/// The checked form of a system.
fn system(resolver: &mut Resolver<'_>, entry: &Entry<'_>) -> System {
    let written = entry.written;
    let list = entry.at.key("elements");
    let elements = tree(
        resolver,
        &written.name,
        written.elements.as_deref().unwrap_or_default(),
        list,
    );
    let mut system = System {
        name: written.name.clone(),
        elements,
        reference: Reference::Free,
        position: NOWHERE,
        velocity: NOWHERE,
    };
    for (start, at) in &entry.starts {
        begin(resolver, &mut system, start, *at);
    }
    start_followers(&mut system.elements);
    if let Some((reference, at)) = entry.reference {
        let moves = system.velocity.iter().any(|v| !v.is_zero());
        system.reference = match reference {
            WrittenReference::Free => Reference::Free,
            WrittenReference::Fixed => {
                if moves && let Some(start) = entry.start_with("velocity") {
                    resolver.problems.add(start.key("velocity").problem(
                        format!(
                            "the reference joint of {} is fixed, but has a velocity",
                            quoted(&written.name)
                        ),
                        "remove the velocity, or write `reference: free`, or a prescribed `acceleration`",
                    ));
                }
                Reference::Fixed
            }
            WrittenReference::Riding(written) => riding(resolver, written, at, &mut system, entry),
            WrittenReference::Prescribed(written) => {
                let start = entry.start_with("velocity");
                prescribed(resolver, written, at, &mut system, start)
            }
        };
        resolver.judge(system.requirements(), at);
    }
    system
}

/// Sets the state of a system at the start.
fn begin(resolver: &Resolver<'_>, system: &mut System, start: &Start, at: At<'_>) {
    if let Some(position) = &start.position {
        system.position = resolver.vector(position, at.key("position"));
    }
    if let Some(velocity) = &start.velocity {
        system.velocity = resolver.vector(velocity, at.key("velocity"));
    }
    for (element, value, here) in
        per_element(resolver, system, start.angles.as_ref(), at.key("angles"))
    {
        if is_ball(resolver, system, element, here, "joints") {
            system.elements[element].angles = resolver.rotation(value, here);
        }
    }
    for (element, value, here) in
        per_element(resolver, system, start.rates.as_ref(), at.key("rates"))
    {
        if is_ball(resolver, system, element, here, "joint_rates") {
            system.elements[element].angular_velocity = resolver.rotation(value, here);
        }
    }
    begin_freedoms(
        resolver,
        system,
        start.joints.as_ref(),
        false,
        at.key("joints"),
    );
    let rates = start.joint_rates.as_ref();
    begin_freedoms(resolver, system, rates, true, at.key("joint_rates"));
}

/// Sets coordinates or rates of freedoms at the start.
fn begin_freedoms<U>(
    resolver: &Resolver<'_>,
    system: &mut System,
    entries: Option<&Named<OneOrThree<WrittenNumber<U>>>>,
    rates: bool,
    at: At<'_>,
) {
    for (element, value, here) in per_element(resolver, system, entries, at) {
        let path = format!("{}/{}", system.name, system.elements[element].name);
        let freedoms = system.elements[element].joint.freedoms_mut();
        freedoms_at_start(resolver, (&path, freedoms), value, rates, here);
    }
}

/// True if an element has an orientation of its own; otherwise reports it.
fn is_ball(
    resolver: &Resolver<'_>,
    system: &System,
    element: usize,
    at: At<'_>,
    instead: &str,
) -> bool {
    let element = &system.elements[element];
    let ball = element.joint == Joint::Ball;
    if !ball {
        resolver.problems.add(at.key_problem(
            format!(
                "how {} is turned follows from its carrier and the coordinates of its joint",
                quoted(&element.name)
            ),
            match element.joint.freedoms().is_empty() {
                true => "remove the line: it is welded".to_owned(),
                false => format!("write it below `{instead}`, relative to the carrier"),
            },
        ));
    }
    ball
}

/// Entries whose keys are the names of elements; reports other keys.
fn per_element<'w, T>(
    resolver: &Resolver<'_>,
    system: &System,
    entries: Option<&'w Named<T>>,
    at: At<'w>,
) -> Vec<(usize, &'w T, At<'w>)> {
    let mut found = Vec::new();
    for (name, value) in entries.iter().flat_map(|n| &n.0) {
        let here = at.key(name);
        match system.elements.iter().position(|e| e.name == *name) {
            Some(element) => found.push((element, value, here)),
            None => resolver.problems.add(here.key_problem(
                format!(
                    "the system {} has no element {}",
                    quoted(&system.name),
                    quoted(name)
                ),
                suggestion(
                    name,
                    system.elements.iter().map(|e: &Element| e.name.as_str()),
                    "it has no elements",
                ),
            )),
        }
    }
    found
}

/// A reference joint with a prescribed motion; a fixed one if it never moves.
fn prescribed(
    resolver: &mut Resolver<'_>,
    written: &Prescribed,
    at: At<'_>,
    system: &mut System,
    start: Option<At<'_>>,
) -> Reference {
    if written.count() == 0 {
        resolver.problems.add(at.problem(
            "this does not say how the reference joint moves",
            "give one of `displacement`, `velocity`, `acceleration`, or write `free` or `fixed`",
        ));
        return Reference::Fixed;
    }
    let start = start.map(|at| at.key("velocity"));
    resolver.owner = format!("reference {}", system.name);
    let translation = translation(resolver, written, at.base(), &mut system.velocity, start);
    let still = translation.curves.iter().all(Option::is_none)
        && system.velocity.iter().all(Number::is_zero);
    if still {
        Reference::Fixed
    } else {
        Reference::Prescribed(translation)
    }
}

/// A reference joint that moves with a vehicle, which determines its position and velocity at the start.
fn riding(
    resolver: &mut Resolver<'_>,
    written: &Riding,
    at: At<'_>,
    system: &mut System,
    entry: &Entry<'_>,
) -> Reference {
    for key in ["position", "velocity"] {
        if let Some(start) = entry.start_with(key) {
            resolver.problems.add(start.key(key).key_problem(
                format!(
                    "the reference joint of {} moves with {}, which says its {key}",
                    quoted(&system.name),
                    quoted(&written.on)
                ),
                format!("remove the {key} from the start; `at` of the reference says where on the vehicle it is"),
            ));
        }
    }
    let point = resolver.vector(&written.at, at.key("at"));
    let Some(vehicle) = vehicle_named(resolver, &written.on, at.key("on")) else {
        return Reference::Fixed;
    };
    system.position = ridden_at_start(resolver, vehicle, &point);
    system.velocity = NOWHERE;
    Reference::Riding { vehicle, at: point }
}
