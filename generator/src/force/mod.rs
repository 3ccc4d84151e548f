//! What force laws have in common in the equations, whatever they are: a law ([`Equations`]) adds to the [`Wrench`] of
//! the elements that it touches, has states and events, and leaves its [`Measures`] for the outputs. The laws
//! themselves are in [`law`](crate::law); no file of this folder names one.

// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod branches;
pub mod events;
pub(crate) mod fade;
pub(crate) mod hysteresis;
pub mod law;
pub mod onset;
pub mod states;
pub mod switch;
pub mod work;
pub mod wrenches;

use crate::motion::numbers::time;
pub use events::{Acts, Events};
pub use law::{ContactPoint, Equations, Measures, Setting, Value};
pub use states::{LawState, NEVER, States};
pub use work::{Product, Work};
pub use wrenches::{Wrench, Wrenches};

use crate::expression::Graph;
use crate::expression::vector::Vec3;
use crate::model::{FieldComponent, Model};
use crate::motion::element::ElementMotion;
use crate::motion::numbers::{curve, number};

/// All applied forces of a model, with the states and events of their laws.
pub struct AppliedForces<'g> {
    /// The forces and moments on bodies.
    pub wrenches: Wrenches<'g>,
    /// The states of laws besides q and v.
    pub states: States<'g>,
    /// Where laws change their branch, where they are not smooth, and when they begin to act.
    pub events: Events<'g>,
    /// The power of each effect, for the energy balance.
    pub works: Vec<Work<'g>>,
    /// By force of the model: the quantities that outputs can ask of it.
    pub measures: Vec<Box<dyn Measures<'g> + 'g>>,
}

impl<'g> AppliedForces<'g> {
    /// Wrenches alone, without states, events and works.
    pub fn of_wrenches(model: &Model, wrenches: Wrenches<'g>) -> Self {
        AppliedForces {
            wrenches,
            states: States {
                auxiliaries: Vec::new(),
                memory: Vec::new(),
                switches: Vec::new(),
            },
            events: Events::none(model),
            works: Vec::new(),
            measures: Vec::new(),
        }
    }
}

/// Three components, each constant or a curve of time.
pub(crate) fn components<'g>(graph: &'g Graph, components: &[FieldComponent; 3]) -> Vec3<'g> {
    Vec3(std::array::from_fn(|i| match &components[i] {
        FieldComponent::Constant(value) => number(graph, value),
        FieldComponent::Curve(scaled) => curve(graph, scaled, time(graph)),
    }))
}

/// Offset of a point from the joint of a body, and the velocity of the body's material there.
pub(crate) fn point_on<'g>(body: &ElementMotion<'g>, position: Vec3<'g>) -> (Vec3<'g>, Vec3<'g>) {
    let offset = position - body.position;
    (offset, body.velocity_at(offset))
}
