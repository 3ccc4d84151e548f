//! The error allowed in each entry of a state, in the number type of the registers.

use crate::integrate::control::Tolerances;
use crate::{Info, Real};

/// The error allowed in an entry of the state: absolute + relative · |y|.
#[derive(Clone, Copy, Debug)]
pub struct Allowed<P> {
    relative: P,
    absolute: P,
}

impl<P: Real> Allowed<P> {
    /// The allowed error of each entry, by its kind.
    pub fn of(tolerances: &Tolerances, info: &Info) -> Vec<Self> {
        let kinds = (0..info.state_length()).map(|index| info.kind(index));
        kinds
            .map(|kind| {
                let [relative, absolute] = tolerances.parts(kind);
                Allowed {
                    relative: P::from_f64(relative),
                    absolute: P::from_f64(absolute),
                }
            })
            .collect()
    }

    /// The allowed error at a magnitude of the entry.
    #[inline(always)]
    pub fn scale(&self, magnitude: P) -> P {
        self.relative.mul_add(magnitude, self.absolute)
    }
}
