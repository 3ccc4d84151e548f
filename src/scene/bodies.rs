//! The bodies of a model in one list.

use super::Named;
use bryant_generator::model::{Body, ElementId, Model, Reference};

/// The bodies of a model in one list.
pub struct Bodies<'a> {
    pub(super) model: &'a Model,
    /// Index of the first body of each system; vehicles follow after all elements.
    first: Vec<usize>,
    elements: usize,
}

impl<'a> Bodies<'a> {
    /// Those of a model.
    pub fn of(model: &'a Model) -> Self {
        let mut elements = 0;
        let first = model.systems.iter().map(|system| {
            elements += system.elements.len();
            elements - system.elements.len()
        });
        let first = first.collect();
        Bodies {
            model,
            first,
            elements,
        }
    }

    pub(super) fn ids(&self) -> impl Iterator<Item = ElementId> + '_ {
        let systems = self.model.systems.iter().enumerate();
        systems.flat_map(|(system, of)| {
            (0..of.elements.len()).map(move |element| ElementId { system, element })
        })
    }

    pub(super) fn all(&self) -> impl Iterator<Item = Body> + '_ {
        let vehicles = (0..self.model.vehicles.len()).map(Body::Vehicle);
        self.ids().map(Body::Element).chain(vehicles)
    }

    /// The index of a body; `None` for the frame.
    pub fn index(&self, body: Body) -> Option<usize> {
        match body {
            Body::Frame => None,
            Body::Element(id) => Some(self.first[id.system] + id.element),
            Body::Vehicle(index) => Some(self.elements + index),
        }
    }

    pub(super) fn named(&self) -> Vec<Named> {
        let named = |body| match body {
            Body::Element(ElementId { system, element }) => {
                let of = &self.model.systems[system];
                Named {
                    name: format!("{}/{}", of.name, of.elements[element].name),
                    system: Some(system),
                    parent: match (of.elements[element].parent, &of.reference) {
                        (Some(parent), _) => Some(self.first[system] + parent),
                        (None, Reference::Riding { vehicle, .. }) => {
                            self.index(Body::Vehicle(*vehicle))
                        }
                        (None, _) => None,
                    },
                }
            }
            Body::Vehicle(index) => Named {
                name: self.model.vehicles[index].name.clone(),
                system: None,
                parent: None,
            },
            Body::Frame => unreachable!("it is no body of the list"),
        };
        self.all().map(named).collect()
    }
}
