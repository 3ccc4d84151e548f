//! Given loads: a force at a point of an element and a moment, in absolute axes.

use super::keys::Load as Written;
use crate::description::measure::MOMENT;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::resolve::{NOWHERE, Resolver};
use crate::model::{Attachment, Body, ElementId, FieldComponent, Number};
use serde::Serialize;

/// A given force and moment in absolute axes: thrust, actuation, a reaction known from a test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Load {
    /// The point at which the force acts.
    pub on: Attachment,
    /// Components along the absolute axes \[N\], each a constant or a curve of time.
    pub force: [FieldComponent; 3],
    /// Components about the absolute axes \[N m\], each a constant or a curve of time. In the plane only the second is
    /// used.
    pub moment: [FieldComponent; 3],
}

/// The checked form of a load.
pub(crate) fn load(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<Load> {
    let element = loaded_element(resolver, &written.on, at.key("on"));
    if written.force.is_none() && written.moment.is_none() {
        resolver.problems.add(at.key("load").key_problem(
            format!(
                "the load {} has neither force nor moment",
                quoted(&written.load)
            ),
            "add `force: …` or `moment: …`; a load that is switched off says `enabled: false`",
        ));
    }
    let mut force = [0; 3].map(|_| FieldComponent::Constant(Number::ZERO));
    if let Some(components) = &written.force {
        force = resolver.components(components, at.key("force"));
    }
    let mut moment = [0; 3].map(|_| FieldComponent::Constant(Number::ZERO));
    if let Some(components) = &written.moment {
        for (axis, component, at) in resolver.about_axes(components, at.key("moment"), MOMENT) {
            moment[axis] = resolver.component(component, at);
        }
    }
    let element = element?;
    let point = match &written.at {
        Some(point) => resolver.point(point, element, at.key("at")),
        None => NOWHERE,
    };
    Some(Load {
        on: Attachment {
            on: Body::Element(element),
            at: point,
        },
        force,
        moment,
    })
}

/// The element that a load acts on. The absolute frame is refused.
fn loaded_element(resolver: &Resolver<'_>, path: &str, at: At<'_>) -> Option<ElementId> {
    if path == "frame" {
        resolver.problems.add(at.problem(
            "a load on the absolute frame moves nothing",
            "name an element, as `system/element`",
        ));
        return None;
    }
    resolver.element_id(path, at)
}
