//! The force laws. Each has a folder.
//!
//! | file of a folder | has |
//! |---|---|
//! | `keys.rs` | the keys of the YAML ([`Keys`]), and how they change in a mirror image |
//! | `check.rs` | the checked form, and how it is made from the keys |
//! | `terms.rs` | its numbers and terms ([`Terms`]): the permitted values, and which parts may be left out |
//! | `force.rs` | its equations ([`Equations`]): forces and moments on bodies, events, states, powers |
//! | `outputs.rs` | its outputs, and its visible parts ([`Outputs`], [`Measures`], [`OfLaw`], [`Look`]) |
//!
//! To add a law, add a folder such as `bushing/`, its `mod` here and its line in `laws!`. Equations, effects, pictures
//! and reports never ask a force which law it is. Pages and tests must be extended besides: `docs/forces/`,
//! `docs/reference.md`, `generator/tests/{effects,short}.rs`, `tests/suite/trust/`, and two lists of all laws in
//! `tests/suite/{snapshots,invariance}.rs`.

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
use crate::dynamics::force::AppliedForces;
use crate::dynamics::force::switch::Gate;
use crate::dynamics::kinematics::Motion;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::model::law::{Keys, Law, OfLaw, Registered};
use crate::model::{Force, Model, Projection};

/// The equations of a law: it becomes forces and moments on bodies.
pub trait Equations {
    /// Applies the law to the bodies, and returns its measures.
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g>;

    /// An expression that must not be negative for the law to make sense in a run that starts with this motion, and its
    /// text in messages.
    fn condition<'g>(
        &self,
        _graph: &'g Graph,
        _start: &Motion<'g>,
        _name: &str,
    ) -> Option<(String, Expr<'g>)> {
        None
    }
}

/// The surroundings in which a law is applied.
#[derive(Clone, Copy)]
pub struct Setting<'a, 'g> {
    /// The graph in which expressions are made.
    pub graph: &'g Graph,
    /// The whole model.
    pub model: &'a Model,
    /// The motion of the model.
    pub motion: &'a Motion<'g>,
    /// The motion of the model at the start of a run.
    pub start: &'a Motion<'g>,
    /// Index of the force in the model.
    pub index: usize,
    /// Name of the force.
    pub name: &'a str,
    /// Condition under which the force acts.
    pub gate: Gate<'g>,
}

/// Expressions of the quantities of a law.
pub trait Measures<'g> {
    /// The force on each point of the law \[N\], for [`Quantity::ForceOn`] and [`Quantity::ForceOnPoints`].
    fn on(&self) -> Vec<Vec3<'g>> {
        Vec::new()
    }

    /// A quantity of the law.
    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>>;
}

/// The measures of a law without outputs.
impl<'g> Measures<'g> for () {
    fn value(&self, _: &dyn OfLaw) -> Option<Value<'g>> {
        None
    }
}

/// The value of a quantity of a law.
pub enum Value<'g> {
    /// A number.
    Scalar(Expr<'g>),
    /// A component, or the magnitude, of a vector in absolute axes.
    Along(Projection, Vec3<'g>),
}

/// Registers the laws, in the order of the reference page. For each: the folder, the struct of its keys, and the structs
/// of its checked forms.
macro_rules! laws {
    ($($folder:ident::$keys:ident { $($(#[$meta:meta])* $law:ident,)* })*) => {
        /// The checked forms of all laws, and the types of their quantities.
        pub mod types {
            $(pub use super::$folder::check::*;
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
    joint::Joint {
        /// Torques about the relative rotations of a joint.
        Joint,
        /// Torque or force of one freedom of a joint.
        Freedom,
    }
    field::Field {
        /// Uniform acceleration: a force m·a at the centre of gravity of every element that feels it.
        Field,
    }
    contact::Contact {
        /// Contact of an ellipsoid (an ellipse in the plane) with a plane (a line) or another ellipsoid.
        Contact,
    }
    belt::Belt {
        /// A belt: a tensile force along the lines between two attachments and the rings between them.
        Belt,
    }
    spring::Spring {
        /// Spring and damper between two points.
        Spring,
    }
    bushing::Bushing {
        /// Springs and dampers in six directions between frames of two bodies.
        Bushing,
    }
    airbag::Airbag {
        /// An airbag.
        Airbag,
    }
    load::Load {
        /// A given force and moment on an element.
        Load,
    }
    user::User {
        /// Forces computed by a function of the user's.
        User,
    }
}
