//! The models that a batch works with, and where they come from.
//!
//! The time loop is compiled once for each scalar, in this crate. [`rows`](super::rows) receives a [`Family`]; only the
//! code that makes the models is generic over the family. A [`Source`] hands the models on as trait objects, so nothing
//! behind it is compiled again.

use crate::real::Several;
use crate::real::lanes::{OfAnyWidth, Width};
use crate::{Adjustable, Dual, Family, Info, Real, Schedule};

/// The models of one family that a batch needs.
pub(super) struct Models<'a, T: Several> {
    /// Names, units and sizes of all of them.
    pub(super) info: &'a Info<'a>,
    /// The model for all lanes.
    pub(super) all: Box<dyn Adjustable<T> + 'a>,
    /// The model with lanes in another order, to evaluate several places of one lane at once.
    pub(super) packed: Box<dyn Adjustable<T> + 'a>,
    /// For each lane, the conditions on its parameters, and its kinks in time.
    pub(super) lanes: Vec<Box<dyn Schedule<f64> + 'a>>,
    /// The kinks in time of one lane, with their derivatives. `None` where the scalar has no derivatives.
    pub(super) one: Option<Box<dyn Schedule<T::One> + 'a>>,
}

impl<'a, T: Several> Models<'a, T> {
    fn new(family: &'a impl Family, one: Option<Box<dyn Schedule<T::One> + 'a>>) -> Self {
        Models {
            info: family.info(),
            all: family.for_batch::<T>(),
            packed: family.for_batch::<T>(),
            lanes: schedules(family, T::LANES),
            one,
        }
    }

    /// The models of a family.
    pub(super) fn of(family: &'a impl Family) -> Self {
        let one = (T::PARTS > 1).then(|| family.schedule::<T::One>());
        Models::new(family, one)
    }
}

/// The conditions and kinks of so many lanes. This is a function of its own, so that it is compiled once for all
/// scalars.
fn schedules(family: &impl Family, lanes: usize) -> Vec<Box<dyn Schedule<f64> + '_>> {
    (0..lanes).map(|_| family.schedule::<f64>()).collect()
}

/// Numbers of one kind, and the registers that hold several of them, by width.
pub(super) trait Numbers {
    /// The scalar of one lane.
    type One: Real;
    /// The scalar of [`Width::One`], [`Width::Two`] and [`Width::Four`]. x86-64 processors with fused multiply-add have
    /// registers of four lanes, 64-bit ARM processors registers of two, and a lane has the same bits in each; so the
    /// time loop is not compiled separately for one lane. On other processors, which have no such registers, this
    /// scalar is one lane.
    type Narrow: Several<One = Self::One>;
    /// The scalar of [`Width::One`] on x86-64 processors without fused multiply-add, where a function does it.
    type OneLane: Several<One = Self::One>;
    /// The scalar of [`Width::Eight`]; on processors that have no such registers, that of [`Width::One`].
    type Wide: Several<One = Self::One>;
    /// The schedule of one lane, if the numbers have a derivative.
    fn one(family: &impl Family) -> Option<Box<dyn Schedule<Self::One> + '_>>;
}

/// Doubles.
pub(super) struct Doubles;
/// Singles.
pub(super) struct Singles;
/// Numbers with a derivative.
pub(super) struct Duals<N>(N);

#[cfg(target_arch = "x86_64")]
mod registers {
    use crate::real::lanes::{
        Alone, Avx2, Avx2Singles, Avx512, Avx512Singles, Emulated, Lanes, Width,
    };
    pub type Narrow = Lanes<Avx2>;
    pub type OneLane = Lanes<Alone<f64, Emulated>>;
    pub type Wide = Lanes<Avx512>;
    pub type NarrowOfSingles = Lanes<Avx2Singles>;
    pub type OneSingle = Lanes<Alone<f32, Emulated>>;
    pub type WideOfSingles = Lanes<Avx512Singles>;

    /// Whether this processor has the narrow registers.
    pub fn narrow_is_there() -> bool {
        Width::Four.is_available()
    }
}

#[cfg(target_arch = "aarch64")]
mod registers {
    use crate::real::lanes::{Lanes, Neon, NeonSingles};
    pub type Narrow = Lanes<Neon>;
    pub type OneLane = Narrow;
    pub type Wide = Narrow;
    pub type NarrowOfSingles = Lanes<NeonSingles>;
    pub type OneSingle = NarrowOfSingles;
    pub type WideOfSingles = NarrowOfSingles;

    pub fn narrow_is_there() -> bool {
        true
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod registers {
    use crate::real::lanes::{Alone, Emulated, Lanes};
    pub type Narrow = Lanes<Alone<f64, Emulated>>;
    pub type OneLane = Narrow;
    pub type Wide = Narrow;
    pub type NarrowOfSingles = Lanes<Alone<f32, Emulated>>;
    pub type OneSingle = NarrowOfSingles;
    pub type WideOfSingles = NarrowOfSingles;

    pub fn narrow_is_there() -> bool {
        true
    }
}

impl Numbers for Doubles {
    type One = f64;
    type Narrow = registers::Narrow;
    type OneLane = registers::OneLane;
    type Wide = registers::Wide;
    fn one(_: &impl Family) -> Option<Box<dyn Schedule<f64> + '_>> {
        None
    }
}

impl Numbers for Singles {
    type One = f32;
    type Narrow = registers::NarrowOfSingles;
    type OneLane = registers::OneSingle;
    type Wide = registers::WideOfSingles;
    fn one(_: &impl Family) -> Option<Box<dyn Schedule<f32> + '_>> {
        None
    }
}

impl<N: Numbers> Numbers for Duals<N> {
    type One = Dual<N::One>;
    type Narrow = Dual<N::Narrow>;
    type OneLane = Dual<N::OneLane>;
    type Wide = Dual<N::Wide>;
    fn one(family: &impl Family) -> Option<Box<dyn Schedule<Dual<N::One>> + '_>> {
        Some(family.schedule())
    }
}

/// Makes models over the registers of every width. Before calling the function of a width, check [`Width::there`].
pub(super) trait Source<N: Numbers> {
    fn narrow(&self) -> Models<'_, N::Narrow>;
    fn one_lane(&self) -> Models<'_, N::OneLane>;
    fn wide(&self) -> Models<'_, N::Wide>;
}

impl<N: Numbers, F: Family> Source<N> for F {
    fn narrow(&self) -> Models<'_, N::Narrow> {
        Models::new(self, N::one(self))
    }

    fn one_lane(&self) -> Models<'_, N::OneLane> {
        Models::new(self, N::one(self))
    }

    fn wide(&self) -> Models<'_, N::Wide> {
        Models::new(self, N::one(self))
    }
}

/// A task that works with models over registers of any width.
pub(super) trait OfModels<S: Real> {
    /// The result of the task.
    type Output;
    /// Performs the task.
    fn run<T: Several<One = S>>(self, models: Models<'_, T>) -> Self::Output;
}

/// Performs a task with registers of a width. `None` if this processor has no such registers.
pub(super) fn with_models<N: Numbers, W: OfModels<N::One>>(
    width: Width,
    source: &dyn Source<N>,
    task: W,
) -> Option<W::Output> {
    width.is_available().then(|| match width {
        Width::One if !registers::narrow_is_there() => task.run(source.one_lane()),
        Width::One | Width::Two | Width::Four => task.run(source.narrow()),
        Width::Eight => task.run(source.wide()),
    })
}

/// Does work with registers of doubles, as [`with_width`](crate::real::lanes::with_width), but with those for which the
/// time loop is compiled in this crate. For tests.
#[doc(hidden)]
pub fn with_compiled<W: OfAnyWidth>(width: Width, task: W) -> Option<W::Output> {
    with_numbers::<Doubles, W>(width, task)
}

/// [`with_compiled`], with registers of singles.
#[doc(hidden)]
pub fn with_compiled_singles<W: OfAnyWidth<f32>>(width: Width, task: W) -> Option<W::Output> {
    with_numbers::<Singles, W>(width, task)
}

fn with_numbers<N: Numbers, W: OfAnyWidth<N::One>>(width: Width, task: W) -> Option<W::Output> {
    width.is_available().then(|| match width {
        Width::One if !registers::narrow_is_there() => task.run::<N::OneLane>(),
        Width::One | Width::Two | Width::Four => task.run::<N::Narrow>(),
        Width::Eight => task.run::<N::Wide>(),
    })
}
