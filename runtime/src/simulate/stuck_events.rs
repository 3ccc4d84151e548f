//! Lets a run go on that is stuck at an event function: one that jumps at the current time may change its sign again
//! and again there, and cut every step to almost nothing.

/// Steps in a row that event functions may cut to almost nothing. Far more than a law has event functions at one time.
const STUCK: u32 = 100;

/// A step counts as nothing below this many times the finest resolution of time.
const STANDS: f64 = 4.0;

/// Counts steps in a row that event functions cut to almost nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Standing(u32);

impl Standing {
    /// Notes that an event function cuts a step of length `h` to its first `way`; times closer than `finest` \[s\], or
    /// than `width` of the step, cannot be told apart. Returns true if the step is to be taken whole anyway.
    pub fn goes_on(&mut self, [way, h]: [f64; 2], finest: f64, width: f64) -> bool {
        let stands = way <= STANDS * finest.max(width * h);
        self.0 = if stands { self.0 + 1 } else { 0 };
        self.0 > STUCK
    }

    /// Notes that a step was not cut.
    pub fn forget(&mut self) {
        self.0 = 0;
    }
}
