//! Which methods are compiled for a model: each has a time loop of its own, and its size times the number of models is what
//! a compiler works on.

use super::Sample;
use super::run::{End, Run};
#[cfg(feature = "std")]
use crate::failure::Reason;
use crate::integrate::euler::SemiImplicitEuler;
use crate::integrate::explicit::Explicit;
use crate::integrate::rosenbrock::Rosenbrock;
use crate::integrate::tableau::dormand_prince::{Dop853, Dopri5};
use crate::integrate::tableau::kutta::{Heun, Merson, Rk4};
use crate::integrate::tableau::tsitouras::Tsit5;
use crate::{Formula, Model, Real};
use core::ops::ControlFlow;

/// A selection of methods.
pub(crate) trait Methods {
    /// Runs to the end by the method that the settings ask for.
    fn go<T: Real, M: Model<T>, F>(run: &mut Run<'_, M, T, F>) -> Result<(), End>
    where
        F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>;
}

/// All there are.
pub(crate) struct AllMethods;

/// Those of everyday work: Dormand & Prince 5(4) and Runge–Kutta 4.
#[cfg(feature = "std")]
pub(crate) struct UsualMethods;

impl Methods for AllMethods {
    #[inline(always)]
    fn go<T: Real, M: Model<T>, F>(run: &mut Run<'_, M, T, F>) -> Result<(), End>
    where
        F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
    {
        match run.settings().method.formula {
            Formula::SemiImplicitEuler => run.go::<SemiImplicitEuler<M::State>>(),
            Formula::Heun => run.go::<Explicit<M::State, Heun>>(),
            Formula::Rk4 => run.go::<Explicit<M::State, Rk4>>(),
            Formula::Merson => run.go::<Explicit<M::State, Merson>>(),
            Formula::Dopri5 => run.go::<Explicit<M::State, Dopri5>>(),
            Formula::Tsit5 => run.go::<Explicit<M::State, Tsit5>>(),
            Formula::Dop853 => run.go::<Explicit<M::State, Dop853>>(),
            Formula::Rodas5 => run.go::<Rosenbrock<T, M>>(),
        }
    }
}

#[cfg(feature = "std")]
impl Methods for UsualMethods {
    #[inline(always)]
    fn go<T: Real, M: Model<T>, F>(run: &mut Run<'_, M, T, F>) -> Result<(), End>
    where
        F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
    {
        match run.settings().method.formula {
            Formula::Rk4 => run.go::<Explicit<M::State, Rk4>>(),
            Formula::Dopri5 => run.go::<Explicit<M::State, Dopri5>>(),
            formula => Err(End::Failed(Reason::NotCompiled { formula })),
        }
    }
}
