//! Several scenarios side by side, one in each lane of a vector register.
//!
//! | file | what |
//! |---|---|
//! | `register` | the operations of a register; each width implements them |
//! | `avx512`, `avx2`, `neon`, `scalar_register` | eight doubles, four, two, one; sixteen singles, eight, four, one |
//! | `elementary` | the elementary functions, over any register |
//! | `several` | the operations on lanes that the time loop of a batch needs |
//!
//! One program has the code for all of them, and [`Width::widest`] is the widest that the processor has. Instructions
//! that not every processor has are used in functions that are compiled for them. A whole evaluation of the equations
//! must be inlined into such a function: see [`Real::dispatch`].
//!
//! Addition, multiplication, fused multiply-add, division and roots are correctly rounded in every width, and all other
//! functions consist of these operations. So a lane has the same bits in every register, whatever its neighbours hold.
//!
//! A register of singles has twice the lanes of the same register of doubles. Its elementary functions are those of
//! doubles, rounded: as fast as eight lanes, and exact to the last bit.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
pub(super) mod elementary;
#[cfg(target_arch = "aarch64")]
mod neon;
mod register;
mod scalar_register;
mod several;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::{Avx2, Avx2Singles};
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::{Avx512, Avx512Singles};
#[cfg(target_arch = "aarch64")]
pub(crate) use neon::{Neon, NeonSingles};
pub use register::MOST_LANES;
pub(crate) use register::{Instructions, Register};
pub(crate) use scalar_register::{Alone, Apart, Emulated, Fused};
pub use several::Several;

#[cfg(feature = "std")]
use super::Layout;
use super::{Form, Mask, Real, Task};
#[cfg(feature = "std")]
use core::any::TypeId;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A number in each lane of a register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Lanes<R>(pub(crate) R);

/// A truth value in each lane of a register.
#[derive(Clone, Copy)]
pub struct LaneMask<R: Register>(pub(crate) R::Mask);

/// A width of registers: the number of doubles in one. If there is more than one, a register holds twice as many
/// singles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Width {
    /// One double. A processor without fused multiply-adds calls a function for each, which is slow.
    One,
    /// Two doubles: 64-bit ARM (NEON).
    Two,
    /// Four doubles: AVX2.
    Four,
    /// Eight doubles: AVX-512.
    Eight,
}

impl Width {
    /// All of them, the narrowest first.
    pub const ALL: [Width; 4] = [Width::One, Width::Two, Width::Four, Width::Eight];

    /// Whether this processor has such registers.
    pub fn is_available(self) -> bool {
        match self {
            Width::One => true,
            Width::Two => cfg!(target_arch = "aarch64"),
            #[cfg(target_arch = "x86_64")]
            Width::Four => Avx2::is_available(),
            #[cfg(target_arch = "x86_64")]
            Width::Eight => Avx512::is_available(),
            #[cfg(not(target_arch = "x86_64"))]
            Width::Four | Width::Eight => false,
        }
    }

    /// Number of scenarios side by side, in doubles.
    pub const fn lanes(self) -> usize {
        match self {
            Width::One => 1,
            Width::Two => 2,
            Width::Four => 4,
            Width::Eight => 8,
        }
    }

    /// Number of scenarios side by side, in singles.
    pub const fn lanes_of_singles(self) -> usize {
        match self {
            Width::One => 1,
            Width::Two => 4,
            Width::Four => 8,
            Width::Eight => 16,
        }
    }

    /// Its name in commands and files.
    pub const fn name(self) -> &'static str {
        match self {
            Width::One => "1",
            Width::Two => "2",
            Width::Four => "4",
            Width::Eight => "8",
        }
    }

    /// The width with this name; `None` if there is none.
    pub fn named(name: &str) -> Option<Width> {
        Self::ALL.into_iter().find(|width| width.name() == name)
    }

    /// The widest that this processor has.
    pub fn widest() -> Width {
        let mut there = Self::ALL
            .into_iter()
            .rev()
            .filter(|width| width.is_available());
        there.next().unwrap_or(Width::One)
    }
}

/// Work with registers of any width: of doubles, or of another scalar `F`.
pub trait OfAnyWidth<F: Real = f64> {
    /// Its result.
    type Output;
    /// Does the work. Its expensive part is a [`Task`] for [`Real::dispatch`] of `T`.
    fn run<T: Several<One = F>>(self) -> Self::Output;
}

/// Does the work with registers of doubles of this width; `None` if the processor does not have them. Registers are
/// made only here and in [`with_width_of_singles`], so none is made on a processor without its instructions.
pub fn with_width<W: OfAnyWidth>(width: Width, task: W) -> Option<W::Output> {
    if !width.is_available() {
        return None;
    }
    Some(match width {
        Width::One if Alone::<f64, Fused>::is_available() => task.run::<Lanes<Alone<f64, Fused>>>(),
        Width::One => task.run::<Lanes<Alone<f64, Emulated>>>(),
        #[cfg(target_arch = "aarch64")]
        Width::Two => task.run::<Lanes<Neon>>(),
        #[cfg(not(target_arch = "aarch64"))]
        Width::Two => return None,
        #[cfg(target_arch = "x86_64")]
        Width::Four => task.run::<Lanes<Avx2>>(),
        #[cfg(target_arch = "x86_64")]
        Width::Eight => task.run::<Lanes<Avx512>>(),
        #[cfg(not(target_arch = "x86_64"))]
        Width::Four | Width::Eight => return None,
    })
}

/// Does the work with one double, as on a processor without fused multiply-adds. For tests.
#[doc(hidden)]
pub fn with_emulated<W: OfAnyWidth>(task: W) -> W::Output {
    task.run::<Lanes<Alone<f64, Emulated>>>()
}

/// Does the work with the registers of singles of this width, which have twice as many lanes; `None` if the processor
/// does not have them.
pub fn with_width_of_singles<W: OfAnyWidth<f32>>(width: Width, task: W) -> Option<W::Output> {
    if !width.is_available() {
        return None;
    }
    Some(match width {
        Width::One if Alone::<f32, Fused>::is_available() => task.run::<Lanes<Alone<f32, Fused>>>(),
        Width::One => task.run::<Lanes<Alone<f32, Emulated>>>(),
        #[cfg(target_arch = "aarch64")]
        Width::Two => task.run::<Lanes<NeonSingles>>(),
        #[cfg(not(target_arch = "aarch64"))]
        Width::Two => return None,
        #[cfg(target_arch = "x86_64")]
        Width::Four => task.run::<Lanes<Avx2Singles>>(),
        #[cfg(target_arch = "x86_64")]
        Width::Eight => task.run::<Lanes<Avx512Singles>>(),
        #[cfg(not(target_arch = "x86_64"))]
        Width::Four | Width::Eight => return None,
    })
}

/// The layout of a scalar that is a register of any width, or a dual number over one; `None` for any other scalar.
#[cfg(feature = "std")]
pub(super) fn layout(scalar: TypeId) -> Option<Layout> {
    fn is<R: Register>(scalar: TypeId) -> Option<Layout> {
        let layout = Layout {
            lanes: R::LANES,
            single: size_of::<R::One>() == size_of::<f32>(),
            fused: true,
            slopes: false,
        };
        layout.if_over::<Lanes<R>>(scalar)
    }
    let alone = is::<Alone<f64, Fused>>(scalar)
        .or(is::<Alone<f64, Emulated>>(scalar))
        .or(is::<Alone<f32, Fused>>(scalar))
        .or(is::<Alone<f32, Emulated>>(scalar));
    #[cfg(target_arch = "x86_64")]
    let wide = is::<Avx2>(scalar)
        .or(is::<Avx2Singles>(scalar))
        .or(is::<Avx512>(scalar))
        .or(is::<Avx512Singles>(scalar));
    #[cfg(target_arch = "aarch64")]
    let wide = is::<Neon>(scalar).or(is::<NeonSingles>(scalar));
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    let wide = None;
    alone.or(wide)
}

/// An operator, lane by lane.
macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<R: Register> $trait for Lanes<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Lanes(self.0.$method(other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<R: Register> Neg for Lanes<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Lanes(self.0.neg())
    }
}

impl<R: Register> AddAssign for Lanes<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// Equal in every lane.
impl<R: Register> PartialEq for Lanes<R> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        (0..R::LANES).all(|i| self.0.lane(i) == other.0.lane(i))
    }
}

impl<R: Register> Mask for LaneMask<R> {
    #[inline(always)]
    fn any(self) -> bool {
        R::any(self.0)
    }

    #[inline(always)]
    fn all(self) -> bool {
        R::all(self.0)
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        LaneMask(R::and(self.0, other.0))
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        LaneMask(R::or(self.0, other.0))
    }

    #[inline(always)]
    fn not(self) -> Self {
        LaneMask(R::not(self.0))
    }

    #[inline(always)]
    fn lanes(self) -> u32 {
        R::lanes_of(self.0)
    }

    #[inline(always)]
    fn of_lanes(lanes: u32) -> Self {
        LaneMask(R::mask_of(lanes))
    }
}

/// Computes a power in a function of its own: the code is long, and a law has several powers; the call takes a small
/// part of the time.
struct Power<R>(Lanes<R>, Lanes<R>);

impl<R: Register> Task for Power<R> {
    type Output = Lanes<R>;
    #[inline(always)]
    fn run(self) -> Lanes<R> {
        Lanes(self.0.0.powf(self.1.0))
    }
}

/// Computes a logarithm in a function of its own.
struct Logarithm<R>(Lanes<R>);

impl<R: Register> Task for Logarithm<R> {
    type Output = Lanes<R>;
    #[inline(always)]
    fn run(self) -> Lanes<R> {
        Lanes(self.0.0.ln())
    }
}

impl<R: Register> Real for Lanes<R> {
    type Mask = LaneMask<R>;
    without_slopes!();
    const FORM: Option<Form> = Some(Form::of(R::BASE).times(R::LANES));

    #[inline(always)]
    fn put(self, stride: usize, words: &mut [f64]) {
        let lanes = self.0.lanes();
        for lane in 0..R::LANES {
            words[lane * stride] = lanes[lane].to_f64();
        }
    }

    #[inline(always)]
    fn of_words(stride: usize, words: &[f64]) -> Self {
        let mut lanes = [R::One::from_f64(0.0); MOST_LANES];
        for lane in 0..R::LANES {
            lanes[lane] = R::One::from_f64(words[lane * stride]);
        }
        Lanes(R::load(&lanes))
    }

    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        R::dispatch(task)
    }

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Lanes(R::splat(value))
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        let mut largest = f64::NEG_INFINITY;
        for lane in self.0.lanes().into_iter().take(R::LANES) {
            // a lane that is NaN never is the largest
            largest = largest.max(lane.to_f64());
        }
        largest
    }

    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Lanes(self.0.mul_add(a.0, b.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Lanes(self.0.sqrt())
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.0.sin_cos();
        (Lanes(sine), Lanes(cosine))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Lanes(self.0.atan2(x.0))
    }

    #[inline(always)]
    fn powf(self, power: Self) -> Self {
        Self::dispatch_apart(Power(self, power))
    }

    #[inline(always)]
    fn exp(self) -> Self {
        Lanes(self.0.exp())
    }

    #[inline(always)]
    fn ln(self) -> Self {
        Self::dispatch_apart(Logarithm(self))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Lanes(self.0.abs())
    }

    #[inline(always)]
    fn lt(self, other: Self) -> LaneMask<R> {
        LaneMask(self.0.lt(other.0))
    }

    #[inline(always)]
    fn select(mask: LaneMask<R>, then: Self, otherwise: Self) -> Self {
        Lanes(R::select(mask.0, then.0, otherwise.0))
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        R::all(self.0.abs().lt(R::splat(f64::INFINITY)))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Lanes(self.0.max(other.0))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Lanes(self.0.min(other.0))
    }
}
