//! Integrals of curves, by their antiderivatives.

use crate::real::{Real, Task};

/// A curve whose antiderivatives are known. `antiderivatives` is to be `#[inline(always)]`; it is compiled once for
/// each scalar.
pub trait Integrable: Copy {
    /// F with F' = the curve and G with G' = F, both 0 at the first point.
    fn antiderivatives<T: Real>(&self, x: T) -> [T; 2];

    /// ∫: [`Curve::integral`](super::Curve::integral).
    #[inline(always)]
    fn integral<T: Real>(&self, x: T) -> T {
        let [from, _] = apart(*self, T::from_f64(0.0));
        let [to, _] = apart(*self, x);
        to - from
    }

    /// ∬: [`Curve::double_integral`](super::Curve::double_integral).
    #[inline(always)]
    fn double_integral<T: Real>(&self, x: T) -> T {
        let [slope, from] = apart(*self, T::from_f64(0.0));
        let [_, to] = apart(*self, x);
        to - from - slope * x
    }
}

/// [`Integrable::antiderivatives`] as a task.
struct Antiderivatives<C, T> {
    curve: C,
    x: T,
}

impl<C: Integrable, T: Real> Task for Antiderivatives<C, T> {
    type Output = [T; 2];
    #[inline(always)]
    fn run(self) -> [T; 2] {
        self.curve.antiderivatives(self.x)
    }
}

#[inline(always)]
fn apart<C: Integrable, T: Real>(curve: C, x: T) -> [T; 2] {
    T::dispatch_apart(Antiderivatives { curve, x })
}
