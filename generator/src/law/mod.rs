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
mod look;
pub mod spring;
pub mod user;

use crate::description::expand::{Expander, Node};
use crate::description::output::Output as WrittenOutput;
use crate::description::place::At;
use crate::description::shape::{Key, Misfit, Problems, Record, Shape, check_record};
use crate::dynamics::force::AppliedForces;
use crate::dynamics::force::switch::Gate;
use crate::dynamics::kinematics::Motion;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
pub use crate::model::Round;
use crate::model::part::Field;
use crate::model::requirement::{Curves, List};
use crate::model::resolve::Resolver;
use crate::model::{Body, Component, Dimension, Model, Projection, Quantity};
pub use look::{Line, Look};
use serde::Serialize;
use std::fmt;
use std::ops::{Deref, DerefMut};

/// A law as the user writes it.
pub trait Keys: Record {
    /// The key that names a force and tells that it is of this law.
    const KEY: &'static str;

    /// Two keys whose values may be exchanged without changing the law.
    const EXCHANGEABLE: Option<[&'static str; 2]> = None;

    /// True if the law has outputs.
    const OBSERVABLE: bool = true;

    /// True if outputs name a part of the law after its name: `of: user drag/head`.
    const HAS_PORTS: bool = false;

    /// Advice for two forces with the same name, in place of renaming one of them.
    const TWICE: Option<&'static str> = None;

    /// The keys that all laws have.
    fn header(&self) -> Header<'_>;

    /// The checked form. Problems are reported; `None` if they leave no useful law.
    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<ForceKind>;

    /// The records of the law's keys, in the order of the reference page.
    fn records() -> Vec<(&'static str, &'static [Key])>;

    /// Turns a copy of the force, apart from its name, into its mirror image.
    fn mirror(_: &Expander<'_>, _image: &mut Node) {}

    /// Turns a copy of a force into its mirror image, with its name. `None`, with a report, if the force has no mirror
    /// image.
    fn image(expander: &mut Expander<'_>, force: &Node, image: &mut Node) -> Option<()> {
        expander.image_of_named(force, image, Self::KEY)?;
        Self::mirror(expander, image);
        expander.differs(force, image, Self::KEY, Self::EXCHANGEABLE)
    }
}

/// The keys that all laws have, as written.
pub struct Header<'a> {
    /// Name of the force in outputs and messages.
    pub name: String,
    /// The key under which the user names the force, and the name.
    pub called: Option<(&'static str, &'a str)>,
    /// False if the force is switched off.
    pub enabled: Option<bool>,
    /// The switch after which the force acts.
    pub since: Option<&'a str>,
    /// The switch up to which the force acts.
    pub until: Option<&'a str>,
}

/// The constituents of a law: its bodies, its numbers, its terms.
pub trait Terms: fmt::Debug {
    /// Adds all terms and numbers of the law, except those that do not exist in this dimension.
    fn fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>);

    /// Removes terms that have no effect without another term that is absent.
    fn settle(&mut self) {}

    /// Removes the axes of parts that are the same in all directions, such as spheres.
    fn forget_directions(&mut self, _: Dimension) {}

    /// Adds conditions on several numbers together that must be checked before those on each number.
    fn require_first(&self, _: Dimension, _: &mut List<'_>) {}

    /// Adds conditions on several numbers together.
    fn require(&self, _: Dimension, _: Curves<'_>, _: &mut List<'_>) {}

    /// The bodies of the law that may be vehicles.
    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        Vec::new()
    }

    /// The switches that the law itself waits for: indices into [`Model::switches`].
    fn switches_mut(&mut self) -> Vec<&mut usize> {
        Vec::new()
    }

    /// True if the law exists in the plane.
    fn exists_in_plane(&self) -> bool {
        true
    }

    /// Reduces a law in space to its part in the plane x–z. Returns false if nothing is left.
    fn flatten(&mut self) -> bool;

    /// Turns a planar law into one in space that acts in the same way in the plane. Numbers are evaluated at these
    /// values of the parameters.
    fn embed(&mut self, _defaults: &[f64]) {}
}

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

/// The outputs and visible parts of a law.
pub trait Outputs {
    /// The quantity that an output asks for, and its unit. `None`, with a report, if the law has no such quantity.
    /// `force` is the index of the force.
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &WrittenOutput,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)>;

    /// The visible parts of the law.
    fn looks(&self) -> Vec<Look<'_>> {
        Vec::new()
    }
}

/// Expressions of the quantities of a law.
pub trait Measures<'g> {
    /// The force on each point of the law \[N\], for [`Quantity::ForceOn`] and [`Quantity::ForceOnPoints`].
    fn on(&self) -> Vec<Vec3<'g>> {
        Vec::new()
    }

    /// A quantity of the law.
    fn value(&self, asked: &Asked) -> Option<Value<'g>>;
}

/// The measures of a law without outputs.
impl<'g> Measures<'g> for () {
    fn value(&self, _: &Asked) -> Option<Value<'g>> {
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

/// A quantity of a law, for outputs.
pub trait OfLaw: fmt::Debug {
    /// For a vector, the projection that is asked for.
    fn projection_mut(&mut self) -> Option<&mut Projection> {
        None
    }

    /// For a vector, the component that is asked for, or its magnitude.
    fn component(&self) -> Option<Component> {
        None
    }

    /// False if the quantity is always 0 in the plane x–z.
    fn exists_in_plane(&self) -> bool {
        true
    }
}

/// The quantities of a law that has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Nothing {}

impl OfLaw for Nothing {}

/// A checked law.
pub trait Law: Terms + Equations + Outputs {}

impl<L: Terms + Equations + Outputs> Law for L {}

/// Facts about a law for reading and checking models.
pub struct Registered {
    /// The key that names a force of this law.
    pub key: &'static str,
    /// Name of the law with its article.
    pub title: &'static str,
    /// Reports values that do not have the shape of this law.
    pub shape: fn(At<'_>, &Problems),
    /// Reads a force of this law.
    pub read: fn(&serde_yaml::Value) -> Result<Written, Misfit>,
    /// The records of the law's keys, in the order of the reference page.
    pub records: fn() -> Vec<(&'static str, &'static [Key])>,
    /// As [`Keys::image`].
    pub image: fn(&mut Expander<'_>, &Node, &mut Node) -> Option<()>,
    /// As [`Keys::TWICE`].
    pub twice: Option<&'static str>,
    /// As [`Keys::OBSERVABLE`].
    pub is_observable: bool,
    /// As [`Keys::HAS_PORTS`].
    pub has_ports: bool,
}

impl Registered {
    /// Name of the law without its article: "joint force", "spring".
    pub fn called(&self) -> &'static str {
        self.title
            .split_once(' ')
            .map_or(self.title, |(_, called)| called)
    }
}

/// The title of a record, and its keys.
pub(crate) fn record<R: Record>() -> (&'static str, &'static [Key]) {
    (R::TITLE, R::KEYS)
}

/// Registers the laws, in the order of the reference page. For each: the folder, the struct of its keys, the structs of
/// its checked forms, and the type of its quantities.
macro_rules! laws {
    ($(
        $(#[$of_keys:meta])*
        $folder:ident::$keys:ident { $($(#[$of_law:meta])* $law:ident,)* } asks $asked:ty;
    )*) => {
        /// The checked forms of all laws, and the types of their quantities.
        pub mod types {
            $(pub use super::$folder::check::*;
            #[allow(unused_imports, reason = "some laws have nothing to ask")]
            pub use super::$folder::outputs::*;)*
        }

        /// A force as the user writes it.
        #[derive(Clone, Debug)]
        pub enum Written {
            $($(#[$of_keys])* $keys(Box<$folder::keys::$keys>),)*
        }

        impl Written {
            /// Facts about the law of this force.
            pub fn law(&self) -> &'static Registered {
                let key = match self {
                    $(Written::$keys(_) => <$folder::keys::$keys as Keys>::KEY,)*
                };
                LAWS.iter().find(|law| law.key == key).unwrap_or(&LAWS[0])
            }

            /// The keys that all laws have.
            pub fn header(&self) -> Header<'_> {
                match self {
                    $(Written::$keys(law) => law.header(),)*
                }
            }

            /// The checked form; `None` if there is none.
            pub(crate) fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<ForceKind> {
                match self {
                    $(Written::$keys(law) => law.check(resolver, at),)*
                }
            }
        }

        /// All laws.
        pub const LAWS: &[Registered] = &[$(Registered {
            key: <$folder::keys::$keys as Keys>::KEY,
            title: <$folder::keys::$keys as Record>::TITLE,
            shape: check_record::<$folder::keys::$keys>,
            read: |value| Ok(Written::$keys(Box::new(Shape::read(value)?))),
            records: <$folder::keys::$keys as Keys>::records,
            image: <$folder::keys::$keys as Keys>::image,
            twice: <$folder::keys::$keys as Keys>::TWICE,
            is_observable: <$folder::keys::$keys as Keys>::OBSERVABLE,
            has_ports: <$folder::keys::$keys as Keys>::HAS_PORTS,
        },)*];

        /// The law of a force.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        pub enum ForceKind {
            $($($(#[$of_law])* $law(Box<$folder::$law>),)*)*
        }

        impl ForceKind {
            /// The key that names a force of this kind.
            pub fn key(&self) -> &'static str {
                match self {
                    $($(ForceKind::$law(_) => <$folder::keys::$keys as Keys>::KEY,)*)*
                }
            }
        }

        impl Deref for ForceKind {
            type Target = dyn Law;
            fn deref(&self) -> &Self::Target {
                match self {
                    $($(ForceKind::$law(law) => &**law,)*)*
                }
            }
        }

        impl DerefMut for ForceKind {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $($(ForceKind::$law(law) => &mut **law,)*)*
                }
            }
        }

        $($(impl From<$folder::$law> for ForceKind {
            fn from(law: $folder::$law) -> Self {
                ForceKind::$law(Box::new(law))
            }
        })*)*

        /// A quantity of a law.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        pub enum Asked {
            $($(#[$of_keys])* $keys($asked),)*
        }

        impl Deref for Asked {
            type Target = dyn OfLaw;
            fn deref(&self) -> &Self::Target {
                match self {
                    $(Asked::$keys(asked) => asked,)*
                }
            }
        }

        impl DerefMut for Asked {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $(Asked::$keys(asked) => asked,)*
                }
            }
        }
    };
}

laws! {
    /// A law in a joint.
    joint::Joint {
        /// Torques about the relative rotations of a joint.
        Joint,
        /// Torque or force of one freedom of a joint.
        Freedom,
    } asks joint::JointOutput;
    /// Uniform acceleration: a force m·a at the centre of gravity of every element that feels it.
    field::Field {
        /// Uniform acceleration: a force m·a at the centre of gravity of every element that feels it.
        Field,
    } asks Nothing;
    /// Contact of an ellipsoid with a plane or another ellipsoid.
    contact::Contact {
        /// Contact of an ellipsoid (an ellipse in the plane) with a plane (a line) or another ellipsoid.
        Contact,
    } asks contact::ContactQuantity;
    /// A belt.
    belt::Belt {
        /// A belt: a tensile force along the lines between two attachments and the rings between them.
        Belt,
    } asks belt::BeltOutput;
    /// Spring and damper between two points.
    spring::Spring {
        /// Spring and damper between two points.
        Spring,
    } asks spring::SpringQuantity;
    /// Springs and dampers in six directions between frames of two bodies.
    bushing::Bushing {
        /// Springs and dampers in six directions between frames of two bodies.
        Bushing,
    } asks bushing::BushingQuantity;
    /// An airbag.
    airbag::Airbag {
        /// An airbag.
        Airbag,
    } asks airbag::AirbagQuantity;
    /// A given force and moment on an element.
    load::Load {
        /// A given force and moment on an element.
        Load,
    } asks Nothing;
    /// A force by a function of the user's.
    user::User {
        /// Forces computed by a function of the user's.
        User,
    } asks user::UserQuantity;
}
