//! An event function that jumps where a run stands changes its sign there again and again, and cuts every step down to nothing. After a while one goes on.

/// Steps in a row that event functions may cut down to nothing. Far more than a law has event functions at one time.
const STUCK: u32 = 100;

/// A step of so many times the finest length of time is nothing: the time goes on by a few roundings.
const STANDS: f64 = 4.0;

/// Steps in a row that event functions cut down to nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Standing(u32);

impl Standing {
    /// An event function cuts a step of the length `h` to its first `way`, where times closer than `finest` \[s\], or than `width` of the step, are not told
    /// apart. Whether the step is to go on all the same.
    pub fn goes_on(&mut self, [way, h]: [f64; 2], finest: f64, width: f64) -> bool {
        let stands = way <= STANDS * finest.max(width * h);
        self.0 = if stands { self.0 + 1 } else { 0 };
        self.0 > STUCK
    }

    /// A step went all its way.
    pub fn forget(&mut self) {
        self.0 = 0;
    }
}
