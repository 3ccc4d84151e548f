//! The frame: the values of an evaluation.

use super::encode::Code;
use crate::call::Library;
use bryant_generator::expression::Function;
use bryant_runtime::Real;

/// The values of one scalar that a piece of code reads and writes. All places of the code lie in the frame. This is
/// checked once, when the frame is made, and not at each access.
pub struct Frame<'a, T> {
    values: &'a mut [T],
    /// Room for the arguments of a call.
    arguments: &'a mut [T],
}

impl<'a, T: Real> Frame<'a, T> {
    /// A frame of `values`; `arguments` has room for the longest call of the code.
    ///
    /// # Panics
    /// If the code has places beyond the values.
    pub fn new(values: &'a mut [T], arguments: &'a mut [T], code: &Code) -> Self {
        assert!(code.end() <= values.len(), "a place beyond the frame");
        Frame { values, arguments }
    }

    /// The value at a place of the code.
    #[expect(unsafe_code, reason = "the place was checked with the code")]
    #[inline(always)]
    pub fn get(&self, place: u16) -> T {
        debug_assert!(usize::from(place) < self.values.len());
        // SAFETY: `place` belongs to the code that the frame was made for. So it is below `Code::end`, and `new` has
        // checked that the frame is at least as long.
        unsafe { *self.values.get_unchecked(usize::from(place)) }
    }

    /// Writes a value to a place of the code.
    #[expect(unsafe_code, reason = "the place was checked with the code")]
    #[inline(always)]
    pub fn set(&mut self, place: u16, value: T) {
        debug_assert!(usize::from(place) < self.values.len());
        // SAFETY: as above.
        unsafe { *self.values.get_unchecked_mut(usize::from(place)) = value };
    }

    /// Calls a function with the values at `places`. Its results go to `count` neighbouring places from `first` on.
    #[inline(always)]
    pub fn call(
        &mut self,
        library: &Library,
        function: Function,
        places: &[u16],
        (first, count): (u16, u16),
    ) {
        for (argument, &place) in self.arguments.iter_mut().zip(places) {
            *argument = self.values[usize::from(place)];
        }
        let given = &self.arguments[..places.len()];
        let results = usize::from(first)..usize::from(first) + usize::from(count);
        library.call(function, given, &mut self.values[results]);
    }
}
