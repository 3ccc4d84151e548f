//! The time limit of the computation of a run.

use std::time::{Duration, Instant};

/// The window over which the speed of a run is measured \[s\].
const WINDOW: f64 = 10.0;
/// A run is given up before its limit if, at its speed, it would take this many times the limit.
const HOPELESS: f64 = 10.0;

/// Watches how long a run takes, and how fast its time advances.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience {
    start: Instant,
    limit: Option<Duration>,
    /// The time at which the run ends \[s\].
    end: f64,
    /// The clock time at which the current window began, and the time of the run then \[s\].
    window: [f64; 2],
    late: Option<Late>,
}

/// Why a run is given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Late {
    /// The computation took longer than this limit \[s\].
    Limit(f64),
    /// At the speed of the last window, the whole computation would take this long \[s\].
    Rate(f64),
}

impl Patience {
    pub fn new(limit: Option<Duration>, [begin, end]: [f64; 2]) -> Self {
        Patience {
            start: Instant::now(),
            limit,
            end,
            window: [0.0, begin],
            late: None,
        }
    }

    /// Whether a run that has reached the time `t` \[s\] is given up.
    pub fn ends_at(&mut self, t: f64) -> bool {
        if let Some(limit) = self.limit {
            let elapsed = self.start.elapsed();
            self.late = match elapsed > limit {
                true => Some(Late::Limit(limit.as_secs_f64())),
                false => self.by_rate(elapsed.as_secs_f64(), limit.as_secs_f64(), t),
            };
        }
        self.late.is_some()
    }

    /// The computing time of the run so far \[s\].
    pub fn elapsed(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    pub fn late(&self) -> Option<Late> {
        self.late
    }

    fn by_rate(&mut self, elapsed: f64, limit: f64, t: f64) -> Option<Late> {
        let [since, from] = self.window;
        if elapsed - since < WINDOW {
            return None;
        }
        self.window = [elapsed, t];
        let rate = (t - from) / (elapsed - since);
        let all = elapsed + (self.end - t) / rate;
        // a speed of 0 makes this infinite
        (all > HOPELESS * limit).then_some(Late::Rate(all))
    }
}

#[cfg(test)]
mod tests {
    use super::{Late, Patience};
    use std::time::Duration;

    #[test]
    fn a_hopeless_run_is_given_up_before_its_time_limit() {
        let limit = 60.0;
        let fresh = || Patience::new(Some(Duration::from_secs(60)), [0.0, 1.0]);
        // 10 s for a hundredth of the run: 1000 s in all is more than ten times the limit
        assert_eq!(fresh().by_rate(10.0, limit, 0.01), Some(Late::Rate(1000.0)));
        // a run twice as fast may go on
        assert_eq!(fresh().by_rate(10.0, limit, 0.02), None);
        // before the window is over, nothing is known
        assert_eq!(fresh().by_rate(9.9, limit, 0.0), None);
        // a stall after a good beginning
        let mut stalls = fresh();
        assert_eq!(stalls.by_rate(10.0, limit, 0.9), None);
        assert_eq!(
            stalls.by_rate(20.0, limit, 0.9),
            Some(Late::Rate(f64::INFINITY))
        );
    }
}
