//! What a run is watched for in plain numbers, the same for a single run and for a lane: whether the balances of energy and momentum close, and
//! whether fixed steps are above the limit of stability.

use crate::Info;
use crate::integrate::control::root;

/// Steps in a row above the limit of stability before it is said, and below it before they are forgotten (Hairer & Wanner).
const ABOVE: u32 = 15;
const BELOW: u32 = 6;

/// Share of the change in a step that two states of the same time must differ by, to tell of anything but rounding.
const DIFFERENT: f64 = 1e-3;
/// Roundings of the state that they must differ by: where nothing moves any more their difference is that of roundings.
const ROUNDINGS: f64 = 100.0;
/// And no less than this \[m, rad, …\], squared: where a motion has died out, forces come in roundings of whatever they are computed of, and
/// what is unstable does not stay so small.
const SMALLEST_SQUARE: f64 = 1e-24;

/// A balance that does not close.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    /// Since when it was more than allowed, if it is.
    pub since: Option<f64>,
    /// The largest since then.
    pub largest: f64,
}

impl Gap {
    pub const NONE: Gap = Gap {
        since: None,
        largest: 0.0,
    };

    /// Takes the gap at the end of a step that began at `t`; true where more than what is `allowed` begins.
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
    /// What was exchanged at kinetic energies of this size \[J\].
    ignored: f64,
    /// √ of the mass of what is free, and its squared radius of gyration.
    inertia: Option<[f64; 2]>,
    /// Steps so far.
    steps: f64,
    /// Largest distance from the origin so far, squared \[m²\].
    distance: f64,
}

/// Energies at the end of a step \[J\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energies {
    /// Kinetic energy where it began, and where it ends.
    pub kinetic: [f64; 2],
    /// What was exchanged in it.
    pub exchanged: f64,
    /// What is missing in the balance: |T(t) − T(0) − Σ W|.
    pub gap: f64,
}

impl Account {
    /// Before a run, with this limit on the share of energy and momentum that may be missing.
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

    /// The start of a run: kinetic energy, and that of velocities as large as their absolute tolerance, 0 where steps are fixed \[J\].
    pub fn open(&mut self, kinetic: f64, tolerated: f64) {
        (self.fastest, self.tolerated) = (kinetic, tolerated);
    }

    /// Of what moves freely: the kinetic energies where all its velocities, and all its angular velocities, are 1 \[J\].
    pub fn weigh_at_start(&mut self, dimension: u8, [moving, turning]: [f64; 2]) {
        let mass = 2.0 * moving / f64::from(dimension);
        self.inertia = (mass > 0.0).then(|| [root(mass, 2), 2.0 * turning / mass]);
    }

    /// The end of a step that began at `t`, with the work of all effects so far; true where a gap in energy begins.
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

    /// The balance of momentum at the end of a step that began at `t`, as a velocity times the root of a mass; true where a gap begins. `missing` is
    /// in N s and, about the origin, N m s; `size` is the largest number in it, which errs by `epsilon`; `distance` that from the origin,
    /// squared \[m²\].
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
        // where nothing moves there are roundings of large numbers
        let rounding = self.steps * epsilon * size / mass;
        self.momentum.observe(t, gap, allowed + rounding)
    }

    /// Since when energy is missing \[s\], and the largest gap as a share of the largest energy.
    pub fn energy(&self) -> Option<(f64, f64)> {
        let share = self.energy.largest / self.fastest.max(self.largest);
        self.energy.since.map(|since| (since, share))
    }

    /// Since when momentum is missing \[s\], and the largest gap as a share of what there can be.
    pub fn momentum(&self) -> Option<(f64, f64)> {
        let share = self.momentum.largest / root(2.0 * self.fastest, 2);
        self.momentum.since.map(|since| (since, share))
    }
}

/// Where the motion is fastest, step by step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stability {
    /// When the series began, and the length of its last step \[s\].
    since: f64,
    step: f64,
    /// Steps above the limit, and in a row below it.
    above: u32,
    below: u32,
    /// Σ |λ|² over those above.
    squares: f64,
    index: usize,
}

/// Steps above the limit of stability.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unstable {
    /// Since when, and the length of a step \[s\].
    pub since: f64,
    pub step: f64,
    /// |λ| of the fastest motion \[1/s\].
    pub rate: f64,
    /// The entry of the state that it moves most.
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

    /// Whether it is known that steps are above the limit.
    pub fn known(&self) -> bool {
        self.above >= ABOVE
    }

    /// Takes |λ|² of a step from `t` of the length `h`, with the entry of the state that moves most, and the limit of the method.
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

    /// What is known of steps above the limit; after one of them where the run has `failed`.
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

/// An entry of two states of the same time, and of the one where the step began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub before: f64,
    /// The entry and its rate, of either.
    pub end: [f64; 2],
    pub near: [f64; 2],
}

/// |λ|² of the fastest motion by two states and their derivatives, and the entry of the state that it moves most; `None` where
/// they are too much alike to tell. Numbers err by `epsilon`.
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
        // more than a part of the step, more than rounding
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
