//! Systems: their elements, what their reference joints do, where they start.

use super::quantity::{ANGLE, LENGTH, RATE, SPEED};
use super::{NOWHERE, Resolver, name::Style};
use crate::description::load::Loaded;
use crate::description::place::At;
use crate::description::quantity::OneOrThree;
use crate::description::shape::Named;
use crate::description::system::{
    Prescribed, Reference as WrittenReference, Start, System as Written,
};
use crate::diagnostic::{quoted, suggestion};
use crate::model::{Element, ElementId, FieldComponent, Reference, System};

/// A system with all that the files say of it: where it is described, then where that is changed.
struct Entry<'w> {
    written: &'w Written,
    at: At<'w>,
    reference: Option<(&'w WrittenReference, At<'w>)>,
    start: Option<(&'w Start, At<'w>)>,
}

impl Resolver<'_> {
    /// Resolves the systems of all files.
    pub fn all_systems(&mut self, loaded: &Loaded) {
        let mut entries: Vec<Entry> = Vec::new();
        for file in &loaded.files {
            let list = file.source.at().key("systems");
            for (index, written) in file.contents.systems.iter().flatten().enumerate() {
                self.collect(&mut entries, written, list.item(index));
            }
        }
        let Some(last) = loaded.files.last() else {
            return;
        };
        if entries.is_empty() && self.problems.count() == 0 {
            self.problems.add(last.source.at().problem(
                "the model has no systems",
                "add `systems:` with at least one element, or include a file that has them",
            ));
        }
        for entry in &entries {
            self.system(entry);
        }
        self.too_many_elements(last.source.at());
    }

    /// Adds a system, or what a file says of a system that an included file describes.
    fn collect<'w>(&self, entries: &mut Vec<Entry<'w>>, written: &'w Written, at: At<'w>) {
        let place = at.key("name");
        let reference = written.reference.as_ref().map(|r| (r, at.key("reference")));
        let start = written.start.as_ref().map(|s| (s, at.key("start")));
        if written.elements.is_none() {
            match entries.iter_mut().find(|e| e.written.name == written.name) {
                Some(entry) => {
                    entry.reference = reference.or(entry.reference);
                    entry.start = start.or(entry.start);
                }
                None => {
                    let known = entries.iter().map(|e| e.written.name.as_str());
                    self.problems.add(place.problem(
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
            self.problems.add(place.problem(
                "\"frame\" is the absolute frame and cannot be the name of a system",
                "use another name",
            ));
        }
        let earlier = entries.iter().map(|e| e.written.name.as_str());
        self.check_name(&written.name, "a system", Style::Either, place);
        if self.check_unique(&written.name, "systems", earlier, place) {
            entries.push(Entry {
                written,
                at,
                reference,
                start,
            });
        }
    }

    fn system(&mut self, entry: &Entry<'_>) {
        let written = entry.written;
        let list = entry.at.key("elements");
        let elements = self.tree(
            &written.name,
            written.elements.as_deref().unwrap_or_default(),
            list,
        );
        let index = self.systems.len();
        for (element, e) in elements.iter().enumerate() {
            let path = format!("{}/{}", written.name, e.name);
            self.elements.insert(
                path.clone(),
                ElementId {
                    system: index,
                    element,
                },
            );
            self.paths.push(path);
        }
        let mut system = System {
            name: written.name.clone(),
            elements,
            reference: Reference::Free,
            position: NOWHERE,
            velocity: NOWHERE,
        };
        if let Some((start, at)) = entry.start {
            self.start(&mut system, start, at);
        }
        if let Some((reference, at)) = entry.reference {
            system.reference = self.reference(reference, at, &written.name);
            let moves = system.velocity.iter().any(|v| !v.is_zero());
            if moves && let Some((_, start)) = entry.start {
                let (what, help) = match reference {
                    WrittenReference::Free => ("", ""),
                    WrittenReference::Fixed => {
                        ("fixed", "remove the velocity, or write `reference: free`")
                    }
                    WrittenReference::Prescribed(_) => (
                        "prescribed",
                        "remove the velocity: it is the derivative of the displacement",
                    ),
                };
                if !what.is_empty() {
                    self.problems.add(start.key("velocity").problem(
                        format!(
                            "the reference joint of {} is {what}, but has a velocity",
                            quoted(&written.name)
                        ),
                        help,
                    ));
                }
            }
        }
        self.systems.push(system);
    }

    fn start(&self, system: &mut System, start: &Start, at: At<'_>) {
        if let Some(position) = &start.position {
            system.position = self.vector(position, at.key("position"), LENGTH);
        }
        if let Some(velocity) = &start.velocity {
            system.velocity = self.vector(velocity, at.key("velocity"), SPEED);
        }
        for (element, value, here) in
            self.per_element(system, start.angles.as_ref(), at.key("angles"))
        {
            system.elements[element].angles = self.rotation(value, here, ANGLE);
        }
        for (element, value, here) in
            self.per_element(system, start.rates.as_ref(), at.key("rates"))
        {
            system.elements[element].angular_velocity = self.rotation(value, here, RATE);
        }
    }

    /// Entries whose keys are elements; those that are not are reported.
    fn per_element<'w>(
        &self,
        system: &System,
        entries: Option<&'w Named<OneOrThree>>,
        at: At<'w>,
    ) -> Vec<(usize, &'w OneOrThree, At<'w>)> {
        let mut found = Vec::new();
        for (name, value) in entries.iter().flat_map(|n| &n.0) {
            let here = at.key(name);
            match system.elements.iter().position(|e| e.name == *name) {
                Some(element) => found.push((element, value, here)),
                None => self.problems.add(here.key_problem(
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

    fn reference(&mut self, reference: &WrittenReference, at: At<'_>, system: &str) -> Reference {
        let WrittenReference::Prescribed(Prescribed { displacement }) = reference else {
            return match reference {
                WrittenReference::Fixed => Reference::Fixed,
                _ => Reference::Free,
            };
        };
        let list = at.key("displacement");
        if !self.has_length(displacement.len(), list) {
            return Reference::Fixed;
        }
        let mut axes = [None, None, None];
        for (index, function) in displacement.iter().enumerate() {
            let axis = self.axis(index);
            let here = list.item(index);
            let owner = format!("{system} displacement {}", ["x", "y", "z"][axis]);
            axes[axis] = match self.component(function, here, &owner, LENGTH) {
                FieldComponent::Curve(curve) => Some(curve),
                FieldComponent::Constant(number) if number.is_zero() => None,
                FieldComponent::Constant(_) => {
                    self.problems.add(here.problem(
                        "a displacement is a curve of time or 0, but this is a constant",
                        "write 0 here and put the constant into the position of `start`",
                    ));
                    None
                }
            };
        }
        if axes.iter().all(Option::is_none) {
            return Reference::Fixed;
        }
        Reference::Prescribed(axes)
    }
}
