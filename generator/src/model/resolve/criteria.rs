//! By what a run is judged: the outputs of the places of a dummy. Whether there is such a regulation and such a dummy, whoever judges knows.

use super::Resolver;
use crate::description::criteria::{Criteria as Written, FilterStandard};
use crate::description::output::{Component, Output as WrittenOutput};
use crate::description::place::At;
use crate::description::short::Each;
use crate::diagnostic::{quoted, suggestion};
use crate::model::Criteria;

/// Places that may be an element, whose acceleration is measured at its centre of gravity.
const ELEMENTS: [&str; 2] = ["head", "chest"];

impl Resolver<'_> {
    /// The criteria; outputs of elements that they need are added to those of the model, headings to `headings`.
    pub fn criteria(
        &mut self,
        written: Option<&Written>,
        at: At<'_>,
        headings: &mut Vec<String>,
    ) -> Option<Criteria> {
        let written = written?;
        let mut places = Vec::new();
        for (key, text) in written.places() {
            let place = key.replace('_', "-");
            if self.outputs.iter().any(|output| output.name == text) {
                places.push((place, text.to_owned()));
            } else if ELEMENTS.contains(&key) && text.contains('/') {
                places.extend(self.components_of(text, &place, at.key(key), headings));
            } else {
                let names: Vec<&str> = self.outputs.iter().map(|o| o.name.as_str()).collect();
                self.problems.add(at.key(key).problem(
                    format!("there is no output {}", quoted(text)),
                    suggestion(
                        text,
                        names.iter().copied(),
                        match ELEMENTS.contains(&key) {
                            true => "name an output, or an element as `system/element`",
                            false => "name an output of the model",
                        },
                    ),
                ));
            }
        }
        Some(Criteria {
            standard: written.standard.trim().to_owned(),
            dummy: written.dummy.trim().to_owned(),
            sae: written.filter_standard == Some(FilterStandard::SaeJ211),
            places,
        })
    }

    /// Outputs of accelerometers at the centre of gravity of an element, along its own axes: in the plane along x and z. Fields do not act on what they read, so
    /// that the pulse of a sled may be a field.
    fn components_of(
        &mut self,
        element: &str,
        place: &str,
        at: At<'_>,
        headings: &mut Vec<String>,
    ) -> Vec<(String, String)> {
        if self.element_id(element, at).is_none() {
            return Vec::new();
        }
        let axes = [
            ("x", Component::X),
            ("y", Component::Y),
            ("z", Component::Z),
        ];
        let planar = self.planar;
        let there = axes.into_iter().filter(|(axis, _)| !planar || *axis != "y");
        let mut places = Vec::new();
        for (axis, component) in there {
            let name = format!("{place}-{axis}");
            let output = WrittenOutput {
                name: name.clone(),
                enabled: None,
                of: Each(element.to_owned()),
                what: "accelerometer".to_owned(),
                at: None,
                component: Some(Each(component)),
                axes: Some("local".to_owned()),
                relative_to: None,
                on: None,
                segment: None,
                ring: None,
                about: None,
                freedom: None,
                code: None,
                filter: None,
                mirror: None,
            };
            self.output(&output, at, headings);
            places.push((name.clone(), name));
        }
        places
    }
}
