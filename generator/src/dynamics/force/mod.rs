//! The force interactions of a scene, as forces and moments on its elements.
//!
//! Each [law](crate::law) adds to the [`Wrench`] of the elements that it touches and leaves its [`Measures`] for the
//! outputs.

pub mod events;
pub(crate) mod fade;
pub(crate) mod hysteresis;
pub mod onset;
pub mod states;
pub mod switch;
pub mod work;
pub mod wrenches;

pub use events::{Acts, Events};
pub use states::{LawState, NEVER, States};
pub use work::{Product, Work};
pub use wrenches::{Wrench, Wrenches};

pub(crate) use super::kinematics::{ElementMotion, Motion};
use crate::dynamics::numbers::{curve, number};
use crate::dynamics::time;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph};
use crate::law::ForceKind;
use crate::law::{Measures, Setting};
use crate::model::{FieldComponent, Model};

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

/// The forces applied in a model in motion. `start` is the motion at the start of a run, which determines the lengths
/// of belts. `charts` are the memories that come before those of force laws.
pub fn applied_forces<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    start: &Motion<'g>,
    charts: Vec<LawState<'g>>,
) -> AppliedForces<'g> {
    let mut applied = AppliedForces {
        wrenches: Wrenches::none(graph, model),
        states: States {
            auxiliaries: Vec::new(),
            memory: charts,
            switches: Vec::new(),
        },
        events: Events::none(model),
        works: Vec::new(),
        measures: Vec::new(),
    };
    applied.declare_switches(graph, model);
    for (index, force) in model.forces.iter().enumerate() {
        graph.section(format!("{} {}", force.law.key(), force.name));
        let setting = Setting {
            graph,
            model,
            motion,
            start,
            index,
            name: &force.name,
            gate: applied.gate(force.active),
        };
        let measures = ForceKind::of(force)
            .equations()
            .apply(setting, &mut applied);
        applied.measures.push(measures);
    }
    applied
}

/// `then` if a < b, otherwise `otherwise`. Both are always computed. If derivatives are wanted, neither may be infinite
/// or NaN even where it is not chosen.
pub fn choose<'g>(a: Expr<'g>, b: Expr<'g>, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
    match (a.as_constant(), b.as_constant()) {
        (Some(a), Some(b)) if a < b => then,
        (Some(_), Some(_)) => otherwise,
        _ if then.id() == otherwise.id() => then,
        _ => a.graph().call(Function::Choose, &[a, b, then, otherwise]),
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
