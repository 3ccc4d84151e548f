//! Given loads: a force at a point of an element and a moment, in absolute axes.

use super::keys::Load as Written;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::resolve::quantity::{FORCE, MOMENT};
use crate::model::resolve::{AXES, NOWHERE, Resolver};
use crate::model::{Attachment, Body, ElementId, FieldComponent, ForceKind, Number};

/// A given force and moment, absolute axes: thrust, actuation, a reaction known from a test.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Where the force acts.
    pub on: Attachment,
    /// Per absolute axis \[N\], constant or a curve of time.
    pub force: [FieldComponent; 3],
    /// Per absolute axis \[N m\], constant or a curve of time. In the plane only the second is used.
    pub moment: [FieldComponent; 3],
}

impl Resolver<'_> {
    /// Resolves a load.
    pub fn load(&mut self, written: &Written, at: At<'_>) -> Option<ForceKind> {
        let element = self.loaded_element(&written.on, at.key("on"));
        if written.force.is_none() && written.moment.is_none() {
            self.problems.add(at.key("load").key_problem(
                format!(
                    "the load {} has neither force nor moment",
                    quoted(&written.load)
                ),
                "add `force: …` or `moment: …`; a load that is switched off says `enabled: false`",
            ));
        }
        let mut force = [0; 3].map(|_| FieldComponent::Constant(Number::ZERO));
        if let Some(components) = &written.force {
            let owner = format!("load {} force", written.load);
            force = self.components(components, at.key("force"), &owner, FORCE);
        }
        let mut moment = [0; 3].map(|_| FieldComponent::Constant(Number::ZERO));
        if let Some(components) = &written.moment {
            for (axis, component, at) in self.about_axes(components, at.key("moment"), MOMENT) {
                let owner = match self.planar {
                    true => format!("load {} moment", written.load),
                    false => format!("load {} moment {}", written.load, AXES[axis]),
                };
                moment[axis] = self.component(component, at, &owner, MOMENT);
            }
        }
        let element = element?;
        let point = match &written.at {
            Some(point) => self.point(point, element, at.key("at")),
            None => NOWHERE,
        };
        Some(ForceKind::Load(Box::new(Load {
            on: Attachment {
                on: Body::Element(element),
                at: point,
            },
            force,
            moment,
        })))
    }

    /// The element that feels a load: the absolute frame feels nothing.
    fn loaded_element(&self, path: &str, at: At<'_>) -> Option<ElementId> {
        if path == "frame" {
            self.problems.add(at.problem(
                "a load on the absolute frame moves nothing",
                "name an element, as `system/element`",
            ));
            return None;
        }
        self.element_id(path, at)
    }
}
