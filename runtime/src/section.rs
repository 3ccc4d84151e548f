//! The sections of a model: what it computes at a time and a state besides the rates of the state.
//!
//! Each is declared here, once. From this table follow [`Section`], its length, the methods of [`Model`](crate::Model)
//! and of [`Dynamics`](crate::Dynamics), how a generated model is called over any scalar, and the numbers by which a
//! library that is loaded at run time is called.

use crate::Info;

/// Hands the table to a macro. A row has: the variant of [`Section`], the name of the methods, the form of the results,
/// and their number.
///
/// | form | [`Dynamics`](crate::Dynamics) returns |
/// |---|---|
/// | `many` | nothing: it writes them to a slice |
/// | `one` | the one result |
/// | `six` | an array of six, which are 0 where the model has none |
/// | `state` | nothing: it writes a whole state to a slice, from the method `renew` of [`Model`](crate::Model) |
macro_rules! sections {
    ($with:ident) => {
        $with! {
            /// Event functions, in the order of [`Info::event_functions`]. Where one changes its sign, a force law
            /// changes its branch. A step with error control ends there.
            EventFunctions event_functions many |info| info.event_functions.len();
            /// Non-smooth switching functions (kinks), in the order of [`Info::kinks`]. Where one changes its sign, a
            /// force law is not smooth, though no discrete state depends on it: a contact begins to touch, a point of a
            /// curve is passed. A method keeps its order where its steps end there. A step that passes over it is still
            /// correct, but less accurate.
            Kinks kinks many |info| info.kinks.len();
            /// Tells when laws that do not act may begin to act, in the order of [`Info::onsets`]. First come the gaps.
            /// The gap of a law is positive while the law certainly does not act; the gap of a corner is the distance
            /// to the nearest corner of a curve, with opposite signs on its two sides. Then come the speeds: bounds of
            /// the rate of each gap, in its unit per second. From both follows whether a step can have missed a law
            /// that begins and ends to act within it.
            Onsets onsets many |info| 2 * info.onsets.len();
            /// The state after the discrete update at the end of a step, if the model has memory:
            /// [`Model::renew`](crate::Model::renew).
            Renewed renewed state |info| match info.memory.len() {
                0 => 0,
                _ => info.state_length(),
            };
            /// The arguments of the curves that depend on the state, in the order of [`Info::curves`]. Only a watch
            /// needs them, to see whether a curve was left. For a curve whose force is 0 it is its first abscissa.
            Curves curves many |info| info.curves.len();
            /// Kinetic energy T \[J\], in absolute axes; 0 for a model that does not compute it.
            KineticEnergy kinetic_energy one |_info| 1;
            /// The power of each effect \[W\], in the order of [`Info::powers`]. Their sum is the rate of the kinetic
            /// energy.
            Powers powers many |info| info.powers.len();
            /// Linear momentum \[N s\] and angular momentum about the origin \[N m s\], in absolute axes x, y, z: the
            /// sum over all systems whose reference joint is free, if there is one ([`Info::free`]).
            Momentum momentum six |info| if info.free { 6 } else { 0 };
            /// The net external wrench on the systems of `momentum`, in absolute axes: the force \[N\] of force laws
            /// and fields, and their moment about the origin \[N m\]. It is the rate of the momentum.
            ExternalWrench external_wrench six |info| if info.free { 6 } else { 0 };
            /// The model's outputs, in the order and units of [`Info::outputs`].
            Outputs outputs many |info| info.outputs.len();
        }
    };
}
pub(crate) use sections;

macro_rules! declared {
    ($($(#[$doc:meta])* $section:ident $name:ident $form:ident |$info:ident| $length:expr;)*) => {
        /// What a model computes at a time and a state, besides the rates of the state. Its results have
        /// [`Info::length`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Section {
            $($(#[$doc])* $section,)*
        }

        impl Section {
            /// All sections, in the order of their numbers.
            pub const ALL: &[Section] = &[$(Section::$section),*];

            /// The name of its methods.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Section::$section => stringify!($name),)*
                }
            }
        }

        impl Info<'_> {
            /// The number of results of a section.
            pub const fn length(&self, section: Section) -> usize {
                match section {
                    $(Section::$section => {
                        let $info = self;
                        $length
                    })*
                }
            }
        }
    };
}
sections!(declared);
