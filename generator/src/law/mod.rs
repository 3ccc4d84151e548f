//! The force laws. Each has a folder.
//!
//! | file of a folder | has |
//! |---|---|
//! | `keys.rs` | the keys, each declared once ([`declare!`](crate::declare)): meaning, unit, permitted values, default, term; the structs of the law follow |
//! | `check.rs` | if there is much of it: what several keys mean together, and kinds of keys that no other law has |
//! | `terms.rs` | if there is much of it: conditions on several numbers, and what has no effect without something else ([`Terms`](crate::model::law::Terms)) |
//! | `force.rs` | its equations ([`Equations`]): forces and moments on bodies, events, states, powers |
//! | `outputs.rs` | its outputs, and its visible parts (`Outputs`, [`Measures`](crate::force::Measures), [`Visible`](crate::model::law::Visible)) |
//!
//! To add a law, add a folder such as `spring/`, its `mod` here and its line in `laws!`. Equations, effects, pictures
//! and reports never ask a force which law it is. Pages and tests must be extended besides: `docs/forces/`,
//! `docs/reference.md`, `generator/tests/it/{effects,short_forms}.rs`, `tests/suite/trust/`, and two lists of all laws
//! in `tests/suite/{snapshots,invariance}.rs`.

pub mod airbag;
pub mod belt;
pub mod bushing;
pub mod contact;
pub mod field;
pub mod joint;
pub mod load;
pub mod spring;
pub mod user;

use crate::description::force::LawKeys;
use crate::expression::Graph;
use crate::force::{AppliedForces, Equations, Events, LawState, Setting, States, Wrenches};
use crate::model::law::Law;
use crate::model::resolve::law::{Keys, Outputs, Registered};
use crate::model::{Force, Model};
use crate::motion::Motion;

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

/// Registers the laws, in the order of the reference page. For each: the folder, the type of its keys, the file of its
/// public types, and the structs of its checked forms.
macro_rules! laws {
    ($($folder:ident::$keys:ident in $types:ident { $($(#[$meta:meta])* $law:ident,)* })*) => {
        /// The checked forms of all laws, and the types of their quantities.
        pub mod types {
            $(pub use super::$folder::$types::*;
            #[allow(unused_imports, reason = "some laws have nothing to ask")]
            pub use super::$folder::outputs::*;)*
        }

        /// All laws, and how each is read.
        pub(crate) const LAWS: &[Registered] =
            &[$(Registered::of::<$folder::keys::$keys>(),)*];

        /// [`LAWS`] as written.
        pub(crate) const KEYS: &[LawKeys] = &[$(Registered::of::<$folder::keys::$keys>().keys,)*];

        /// The law of a force by its type, for code that treats each law apart.
        #[derive(Clone, Copy, Debug)]
        pub enum ForceKind<'a> {
            $($($(#[$meta])* $law(&'a $folder::$law),)*)*
        }

        impl<'a> ForceKind<'a> {
            /// The law of a force.
            pub fn of(force: &'a Force) -> Self {
                $($(if let Some(law) = force.law.get() {
                    return ForceKind::$law(law);
                })*)*
                unreachable!("the law of {} is in the list of laws", force.name)
            }

            /// The outputs of the law.
            pub(crate) fn outputs(self) -> &'a dyn Outputs {
                match self {
                    $($(ForceKind::$law(law) => law,)*)*
                }
            }

            /// The equations of the law.
            pub(crate) fn equations(self) -> &'a dyn Equations {
                match self {
                    $($(ForceKind::$law(law) => law,)*)*
                }
            }
        }

        $($(impl Law for $folder::$law {
            fn key(&self) -> &'static str {
                <$folder::keys::$keys as Keys>::KEY
            }

            fn boxed(&self) -> Box<dyn Law> {
                Box::new(self.clone())
            }
        })*)*
    };
}

laws! {
    joint::Joint in check {
        /// Torques about the relative rotations of a joint.
        Joint,
        /// Torque or force of one freedom of a joint.
        Freedom,
    }
    field::FieldKeys in keys {
        /// Uniform acceleration: a force m·a at the centre of gravity of every element that feels it.
        Field,
    }
    contact::ContactKeys in check {
        /// Contact of an ellipsoid (an ellipse in the plane) with a plane (a line) or another ellipsoid.
        Contact,
    }
    belt::BeltKeys in check {
        /// A belt: a tensile force along the lines between two attachments and the rings between them.
        Belt,
    }
    spring::SpringKeys in keys {
        /// Spring and damper between two points.
        Spring,
    }
    bushing::BushingKeys in keys {
        /// Springs and dampers in six directions between frames of two bodies.
        Bushing,
    }
    airbag::AirbagKeys in check {
        /// An airbag.
        Airbag,
    }
    load::LoadKeys in keys {
        /// A given force and moment on an element.
        Load,
    }
    user::User in check {
        /// Forces computed by a function of the user's.
        User,
    }
}
