//! The balances of energy and momentum, and the stability of fixed steps, in plain numbers: the same for a single run
//! and for a lane.

use crate::Info;
use crate::integrate::control::root;

/// Steps above the limit of stability before this is reported, and steps in a row below it before the count is
/// forgotten (Hairer & Wanner).
const ABOVE: u32 = 15;
const BELOW: u32 = 6;

/// Two states of the same time are compared only if they differ by more than this share of the change in the step; less
/// may be rounding.
const DIFFERENT: f64 = 1e-3;
/// They must also differ by this many roundings of the state: if nothing moves any more, the difference is rounding
/// only.
const ROUNDINGS: f64 = 100.0;
/// They must also differ by at least this much \[m, rad, …\], squared: after a motion has died out, forces still vary
/// by roundings, while an unstable motion does not stay so small.
const SMALLEST_SQUARE: f64 = 1e-24;

/// A balance that does not close.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    /// The time since which the gap exceeds what is allowed, if it does.
    pub since: Option<f64>,
    /// The largest gap since then.
    pub largest: f64,
}

impl Gap {
    pub const NONE: Gap = Gap {
        since: None,
        largest: 0.0,
    };

    /// Takes the gap at the end of a step that began at `t`. Returns true if the gap begins to exceed what is `allowed`
    /// in this step.
    #[inline(always)]
    pub fn observe(&mut self, t: f64, gap: f64, allowed: f64) -> bool {
        if gap > allowed {
            self.largest = self.largest.max(gap);
            if self.since.is_none() {
                self.since = Some(t);
                return true;
            }
        } else if self.largest <= allowed {
            *self = Gap::NONE;
        }
        false
    }
}

/// The balances of energy and momentum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Account {
    /// Share of energy and of momentum that may be missing; +∞ for any.
    limit: f64,
    energy: Gap,
    momentum: Gap,
    /// Largest kinetic energy and largest work of an effect so far \[J\].
    fastest: f64,
    largest: f64,
    /// Kinetic energy of velocities as large as their absolute tolerance \[J\]; 0 where steps are fixed.
    tolerated: f64,
    /// Energy exchanged at kinetic energies of the size of `tolerated`, and so not resolved \[J\].
    ignored: f64,
    /// The root of the mass of the freely moving bodies, and their squared radius of gyration.
    inertia: Option<[f64; 2]>,
    /// Steps so far.
    steps: f64,
    /// Largest distance from the origin so far, squared \[m²\].
    distance: f64,
}

/// Energies at the end of a step \[J\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energies {
    /// Kinetic energy at the start and at the end of the step.
    pub kinetic: [f64; 2],
    /// Energy exchanged in the step.
    pub exchanged: f64,
    /// What is missing in the balance: |T(t) − T(0) − Σ W|.
    pub gap: f64,
}

impl Account {
    /// An account before a run, with this limit on the share of energy and momentum that may be missing.
    pub fn new(limit: f64) -> Self {
        Account {
            limit,
            energy: Gap::NONE,
            momentum: Gap::NONE,
            fastest: 0.0,
            largest: 0.0,
            tolerated: 0.0,
            ignored: 0.0,
            inertia: None,
            steps: 0.0,
            distance: 0.0,
        }
    }

    /// Opens the account with the kinetic energy at the start, and that of velocities as large as their absolute
    /// tolerance, 0 if steps are fixed \[J\].
    pub fn open(&mut self, kinetic: f64, tolerated: f64) {
        (self.fastest, self.tolerated) = (kinetic, tolerated);
    }

    /// Sets mass and inertia of the freely moving bodies, from their kinetic energies when all velocities, or all
    /// angular velocities, are 1 \[J\].
    pub fn weigh_at_start(&mut self, dimension: u8, [moving, turning]: [f64; 2]) {
        let mass = 2.0 * moving / f64::from(dimension);
        self.inertia = (mass > 0.0).then(|| [root(mass, 2), 2.0 * turning / mass]);
    }

    /// Closes a step that began at `t`, with the work of all effects so far. Returns true if a gap in energy begins in
    /// it.
    #[inline(always)]
    pub fn close(&mut self, t: f64, energies: Energies, works: impl Iterator<Item = f64>) -> bool {
        let [before, kinetic] = energies.kinetic;
        self.fastest = self.fastest.max(kinetic);
        for work in works {
            self.largest = self.largest.max(work.abs());
        }
        let slow = self.tolerated / kinetic.max(before);
        if slow > 0.0 {
            self.ignored += energies.exchanged * root(slow.min(1.0), 2);
        }
        let share = self.limit * self.fastest.max(self.largest);
        let drift = 2.0 * root(self.fastest * self.tolerated, 2) + self.tolerated;
        let allowed = share + drift + self.ignored;
        self.energy.observe(t, energies.gap, allowed)
    }

    /// Balances momentum at the end of a step that began at `t`, in units of a velocity times the root of a mass.
    /// Returns true if a gap begins. `missing` is in N s and, about the origin, N m s; `size` is the largest number in
    /// the balance and `epsilon` its relative rounding; `distance` is the squared distance from the origin \[m²\].
    pub fn weigh(
        &mut self,
        t: f64,
        missing: [f64; 2],
        [size, epsilon]: [f64; 2],
        distance: f64,
    ) -> bool {
        let Some([mass, gyration]) = self.inertia else {
            return false;
        };
        self.distance = self.distance.max(distance);
        let arm = root(gyration + self.distance, 2);
        let gap = (missing[0] / mass).max(missing[1] / (mass * arm));
        self.steps += 1.0;
        let allowed =
            self.limit * root(2.0 * self.fastest, 2) + self.steps * root(2.0 * self.tolerated, 2);
        // if nothing moves, the gap consists of roundings of large numbers
        let rounding = self.steps * epsilon * size / mass;
        self.momentum.observe(t, gap, allowed + rounding)
    }

    /// The time since which energy is missing \[s\], and the largest gap as a share of the largest energy.
    pub fn energy(&self) -> Option<(f64, f64)> {
        let share = self.energy.largest / self.fastest.max(self.largest);
        self.energy.since.map(|since| (since, share))
    }

    /// The time since which momentum is missing \[s\], and the largest gap as a share of the largest momentum possible.
    pub fn momentum(&self) -> Option<(f64, f64)> {
        let share = self.momentum.largest / root(2.0 * self.fastest, 2);
        self.momentum.since.map(|since| (since, share))
    }
}

/// Counts steps above the limit of stability, and averages the rate of their fastest motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stability {
    /// The time when the series of steps above the limit began, and the length of its last step \[s\].
    since: f64,
    step: f64,
    /// Steps above the limit in the series, and steps in a row below it.
    above: u32,
    below: u32,
    /// Σ |λ|² over the steps above the limit.
    squares: f64,
    index: usize,
}

/// Steps above the limit of stability.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unstable {
    /// The time when the series began, and the length of a step \[s\].
    pub since: f64,
    pub step: f64,
    /// |λ| of the fastest motion \[1/s\].
    pub rate: f64,
    /// The entry of the state that this motion moves most.
    pub index: usize,
}

impl Stability {
    pub const NONE: Stability = Stability {
        since: 0.0,
        step: 0.0,
        above: 0,
        below: 0,
        squares: 0.0,
        index: 0,
    };

    /// True if enough steps were above the limit to report it.
    pub fn known(&self) -> bool {
        self.above >= ABOVE
    }

    /// Takes |λ|² of a step of length `h` from `t`, with the entry of the state that moves most, and the stability
    /// limit of the method.
    pub fn observe(&mut self, [t, h]: [f64; 2], (square, index): (f64, usize), limit: f64) {
        if self.known() {
            return;
        }
        if square * h * h > limit * limit {
            if self.above == 0 {
                self.since = t;
            }
            self.above += 1;
            self.below = 0;
            self.squares += square;
            (self.index, self.step) = (index, h);
        } else if self.above > 0 {
            self.below += 1;
            if self.below >= BELOW {
                *self = Stability::NONE;
            }
        }
    }

    /// The series of steps above the limit, if it is long enough; one step is enough if the run has `failed`.
    pub fn unstable(&self, failed: bool) -> Option<Unstable> {
        let enough = if failed { 1 } else { ABOVE };
        (self.above >= enough).then(|| Unstable {
            since: self.since,
            step: self.step,
            rate: root(self.squares / f64::from(self.above), 2),
            index: self.index,
        })
    }
}

/// An entry of two states of the same time, `end` and `near`, and of the state at the start of the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub before: f64,
    /// The entry and its rate, in either state.
    pub end: [f64; 2],
    pub near: [f64; 2],
}

/// |λ|² of the fastest motion, from two states of the same time and their derivatives, and the entry of the state that
/// it moves most; `None` if the states are too close to tell. Numbers have the relative rounding `epsilon`.
pub(crate) fn rate_squared(
    info: &Info,
    epsilon: f64,
    entry: impl Fn(usize) -> Entry,
) -> Option<(f64, usize)> {
    let coordinates = info.coordinates.len();
    let motion = coordinates + info.velocities.len();
    let laws = info.varying_length();
    // ‖Δy‖, ‖Δẏ‖ squared, and where Δy is largest
    let compare = |from: usize, to: usize| {
        let (mut apart, mut rates, mut change, mut size) = (0.0, 0.0, 0.0, 0.0);
        let (mut index, mut most) = (from, 0.0);
        for i in from..to {
            let Entry { before, end, near } = entry(i);
            let square = |x: f64| x * x;
            let distance = square(end[0] - near[0]);
            if distance > most {
                (index, most) = (i, distance);
            }
            apart += distance;
            rates += square(end[1] - near[1]);
            change += square(end[0] - before);
            size += square(end[0]);
        }
        // the states must differ by more than a part of the change in the step, and by more than rounding
        let least =
            DIFFERENT * DIFFERENT * change + ROUNDINGS * ROUNDINGS * epsilon * epsilon * size;
        let tells = apart > least.max(SMALLEST_SQUARE) && rates.is_finite();
        tells.then(|| (rates / apart, index))
    };
    let of_motion = match info.velocities.is_empty() {
        true => compare(0, motion),
        false => compare(0, coordinates)
            .zip(compare(coordinates, motion))
            .map(|((of_coordinates, _), (of_velocities, index))| {
                (root(of_coordinates, 2) * root(of_velocities, 2), index)
            }),
    };
    let of_laws = compare(motion, laws);
    match (of_motion, of_laws) {
        (Some(motion), Some(laws)) if laws.0 > motion.0 => Some(laws),
        (Some(motion), _) => Some(motion),
        (None, laws) => laws,
    }
}
