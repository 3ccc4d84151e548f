//! The force laws, a folder for each.
//!
//! | file of a folder | has |
//! |---|---|
//! | `keys.rs` | the keys of the YAML ([`Keys`]), with what a mirror image makes of them |
//! | `check.rs` | the checked form, and how it is made of the keys |
//! | `terms.rs` | its numbers and terms ([`Terms`]): what each may be, what may be left out |
//! | `force.rs` | the equations ([`Equations`]): forces and moments on bodies, events, states, powers |
//! | `outputs.rs` | what can be asked of it, and what is seen of it ([`Outputs`], [`Measures`], [`OfLaw`], [`Look`]) |
//!
//! A further law is a folder such as `bushing/`, its `mod` here and its line in `laws!`. Equations, effects, pictures and reports ask no force which law it is. Pages and tests are
//! beside that: `docs/forces/`, `docs/reference.md`, `generator/tests/{effects,short}.rs`, `tests/suite/trust/`, and two lists of all laws in `tests/suite/{snapshots,invariance}.rs`.

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
use crate::model::part::Field;
use crate::model::requirement::{Curves, List};
use crate::model::resolve::Resolver;
use crate::model::{Body, Component, Dimension, Model, Projection, Quantity};
pub use look::{Line, Look, Round};
use serde::Serialize;
use std::fmt;
use std::ops::{Deref, DerefMut};

/// A law as written.
pub trait Keys: Record {
    /// The key that names a force and says that it is this law.
    const KEY: &'static str;

    /// Two keys whose values may be exchanged: the law is the same.
    const EXCHANGEABLE: Option<[&'static str; 2]> = None;

    /// Whether something can be asked of it.
    const OBSERVABLE: bool = true;

    /// Whether outputs name a part of it behind its name: `of: user drag/head`.
    const HAS_PORTS: bool = false;

    /// What to do about two of the same name, if it is not to call one of them otherwise.
    const TWICE: Option<&'static str> = None;

    /// What all laws have.
    fn header(&self) -> Header<'_>;

    /// The checked form; what is wrong is reported, and none where nothing sensible can be made of it.
    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<ForceKind>;

    /// Its records, in the order of the reference page.
    fn records() -> Vec<(&'static str, &'static [Key])>;

    /// Makes the mirror image of a copy, but for its name.
    fn mirror(_: &Expander<'_>, _image: &mut Node) {}

    /// Makes the mirror image of a copy of a force; none where there is none, which is reported.
    fn image(expander: &mut Expander<'_>, force: &Node, image: &mut Node) -> Option<()> {
        expander.image_of_named(force, image, Self::KEY)?;
        Self::mirror(expander, image);
        expander.differs(force, image, Self::KEY, Self::EXCHANGEABLE)
    }
}

/// What all laws have as written.
pub struct Header<'a> {
    /// By which outputs and messages call it.
    pub name: String,
    /// The key under which the user gave it a name, and the name.
    pub called: Option<(&'static str, &'a str)>,
    /// Whether it acts.
    pub enabled: Option<bool>,
    /// The switch from which on it acts.
    pub since: Option<&'a str>,
    /// The switch up to which it acts.
    pub until: Option<&'a str>,
}

/// What a law is made of: its bodies, its numbers, its terms.
pub trait Terms: fmt::Debug {
    /// Adds everything of it but what the dimension does not have.
    fn fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>);

    /// Leaves out what cannot do anything without what is absent.
    fn settle(&mut self) {}

    /// Leaves out axes of what is the same in all directions.
    fn forget_directions(&mut self, _: Dimension) {}

    /// Adds what several of its numbers must keep together, where that is judged before each of them.
    fn require_first(&self, _: Dimension, _: &mut List<'_>) {}

    /// Adds what several of its numbers must keep together.
    fn require(&self, _: Dimension, _: Curves<'_>, _: &mut List<'_>) {}

    /// Its bodies, as far as they may be vehicles.
    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        Vec::new()
    }

    /// The switches that it waits for by itself: indices into [`Model::switches`].
    fn switches_mut(&mut self) -> Vec<&mut usize> {
        Vec::new()
    }

    /// Whether there is such a law in the plane.
    fn exists_in_plane(&self) -> bool {
        true
    }

    /// Makes of a law in space what is left of it in the plane x–z; false where that is nothing.
    fn flatten(&mut self) -> bool;

    /// Makes of a planar law one in space that does the same in the plane; numbers are those at these parameters.
    fn embed(&mut self, _defaults: &[f64]) {}
}

/// How a law becomes forces and moments on bodies.
pub trait Equations {
    /// Applies it.
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g>;

    /// What must not be negative for it to have a meaning in a run that starts with this motion, and how a message says so.
    fn condition<'g>(
        &self,
        _graph: &'g Graph,
        _start: &Motion<'g>,
        _name: &str,
    ) -> Option<(String, Expr<'g>)> {
        None
    }
}

/// What a law is applied in.
#[derive(Clone, Copy)]
pub struct Setting<'a, 'g> {
    /// Where expressions are made.
    pub graph: &'g Graph,
    /// The whole model.
    pub model: &'a Model,
    /// Its motion.
    pub motion: &'a Motion<'g>,
    /// Its motion where a run starts.
    pub start: &'a Motion<'g>,
    /// Index of the force in the model.
    pub index: usize,
    /// Its name.
    pub name: &'a str,
    /// When it acts.
    pub gate: Gate<'g>,
}

/// What can be asked of a law.
pub trait Outputs {
    /// What an output asks of it, and the unit; reported where there is no such thing. `force` is its index.
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &WrittenOutput,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)>;

    /// What is seen of it.
    fn looks(&self) -> Vec<Look<'_>> {
        Vec::new()
    }
}

/// Expressions of what can be asked of a law.
pub trait Measures<'g> {
    /// The force on each of its points \[N\], for [`Quantity::ForceOn`] and [`Quantity::ForceOnPoints`].
    fn on(&self) -> Vec<Vec3<'g>> {
        Vec::new()
    }

    /// A quantity of the law.
    fn value(&self, asked: &Asked) -> Option<Value<'g>>;
}

/// Of a law that has nothing to ask.
impl<'g> Measures<'g> for () {
    fn value(&self, _: &Asked) -> Option<Value<'g>> {
        None
    }
}

/// A value of a law.
pub enum Value<'g> {
    /// A number.
    Scalar(Expr<'g>),
    /// One number of a vector in absolute axes.
    Along(Projection, Vec3<'g>),
}

/// A quantity of a law.
pub trait OfLaw: fmt::Debug {
    /// Of a vector: which number of it.
    fn projection_mut(&mut self) -> Option<&mut Projection> {
        None
    }

    /// Of a vector: which component of it, or its resultant.
    fn component(&self) -> Option<Component> {
        None
    }

    /// Whether it is not 0 by itself in the plane x–z.
    fn exists_in_plane(&self) -> bool {
        true
    }
}

/// There is nothing to ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Nothing {}

impl OfLaw for Nothing {}

/// A checked law.
pub trait Law: Terms + Equations + Outputs {}

impl<L: Terms + Equations + Outputs> Law for L {}

/// What the language knows of a law.
pub struct Registered {
    /// The key that names a force.
    pub key: &'static str,
    /// What it is called, with its article.
    pub title: &'static str,
    /// Reports what does not have its shape.
    pub shape: fn(At<'_>, &Problems),
    /// Reads it.
    pub read: fn(&serde_yaml::Value) -> Result<Written, Misfit>,
    /// Its records, in the order of the reference page.
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
    /// What it is called, without an article: "joint force", "spring".
    pub fn called(&self) -> &'static str {
        self.title
            .split_once(' ')
            .map_or(self.title, |(_, called)| called)
    }
}

/// A record: what it is called, and its keys.
pub(crate) fn record<R: Record>() -> (&'static str, &'static [Key]) {
    (R::TITLE, R::KEYS)
}

/// Registers the laws, in the order of the reference page: the folder and the struct of its keys, the structs of its checked forms, and what can be
/// asked of it.
macro_rules! laws {
    ($(
        $(#[$of_keys:meta])*
        $folder:ident::$keys:ident { $($(#[$of_law:meta])* $law:ident,)* } asks $asked:ty;
    )*) => {
        /// The checked forms of all laws, and what can be asked of them.
        pub mod types {
            $(pub use super::$folder::check::*;
            #[allow(unused_imports, reason = "some laws have nothing to ask")]
            pub use super::$folder::outputs::*;)*
        }

        /// A force as written.
        #[derive(Clone, Debug)]
        pub enum Written {
            $($(#[$of_keys])* $keys(Box<$folder::keys::$keys>),)*
        }

        impl Written {
            /// What the language knows of its law.
            pub fn law(&self) -> &'static Registered {
                let key = match self {
                    $(Written::$keys(_) => <$folder::keys::$keys as Keys>::KEY,)*
                };
                LAWS.iter().find(|law| law.key == key).unwrap_or(&LAWS[0])
            }

            /// What all laws have.
            pub fn header(&self) -> Header<'_> {
                match self {
                    $(Written::$keys(law) => law.header(),)*
                }
            }

            /// Its checked form.
            pub(crate) fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<ForceKind> {
                match self {
                    $(Written::$keys(law) => law.check(resolver, at),)*
                }
            }
        }

        /// The laws.
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
    /// In a joint.
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
    /// By a function of the user's.
    user::User {
        /// Forces computed by a function of the user's.
        User,
    } asks user::UserQuantity;
}
