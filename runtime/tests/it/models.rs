//! Small models written by hand, for the tests of integrators and runs.

use bryant_runtime::curve::{Curve, Extrapolate};
use bryant_runtime::{
    CurveInfo, Info, Model, OutputInfo, ParameterInfo, ParameterSet, Real, StateKind,
};

/// No parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct None;

impl<T> ParameterSet<T> for None {
    fn defaults() -> Self {
        None
    }
    fn get(&self, _: usize) -> Option<T> {
        Option::None
    }
    fn set(&mut self, _: usize, _: T) -> bool {
        false
    }
}

/// The unit of what is of this kind.
const fn unit(kind: StateKind) -> &'static str {
    match kind {
        StateKind::Position => "m",
        StateKind::Angle => "rad",
        StateKind::Velocity => "m/s",
        StateKind::AngularVelocity => "rad/s",
        StateKind::Law | StateKind::Memory => "",
    }
}

/// A mass at x that has nothing else: what is not said of a model below.
pub const BARE: Info = Info {
    name: "",
    digest: "",
    dimension: 2,
    coordinates: &["x"],
    velocities: &["v"],
    kinds: &[StateKind::Position, StateKind::Velocity],
    units: &["m", "m/s"],
    auxiliaries: &[],
    memory: &[],
    event_functions: &[],
    kinks: &[],
    onsets: &[],
    corners: 0,
    longest_step: f64::INFINITY,
    powers: &[],
    curves: &[],
    time_ends: false,
    pivots: &[],
    conditions: &[],
    free: false,
    outputs: &[],
    parameters: &[],
    breakpoints: &[],
    duration: 1.0,
    every: 0.1,
};

/// What models on unit structs have in common: how many numbers there are of each kind, and where a run starts. q̇ is
/// that of time 0, which counts only where it depends on time.
macro_rules! bare {
    ($model:ident, state $state:expr, from $y0:expr) => {
        type With<U: Real> = $model;
        type Parameters = None;
        type State = [T; $state];
        fn new(_: None) -> Self {
            $model
        }
        fn parameters(&self) -> &None {
            &None
        }
        fn initial_state(&self) -> Self::State {
            $y0.map(T::from_f64)
        }
        fn coordinate_rates(&self, y: &Self::State, rate: &mut Self::State) {
            let all: Self::State = self.derivative(T::from_f64(0.0), y);
            let coordinates = <Self as Model<T>>::INFO.coordinates.len();
            rate[..coordinates].copy_from_slice(&all[..coordinates]);
        }
    };
}

/// A model without parameters and outputs, on a unit struct: names, initial state, derivative. q̇ is that of time 0,
/// which matters only if it depends on time.
macro_rules! model {
    ($(#[$doc:meta])* $model:ident, [$($q:literal: $q_kind:ident),*], [$($v:literal: $v_kind:ident),*], $kinks:expr, $duration:expr,
     $y0:expr, |$t:ident, $y:ident| $rate:expr) => {
        model! {
            $(#[$doc])* $model, [$($q: $q_kind),*], [$($v: $v_kind),*], $kinks, $duration, $y0, |$t, $y| $rate,
            [], |_y| []
        }
    };
    // the same, with the kinks of a law
    ($(#[$doc:meta])* $model:ident, [$($q:literal: $q_kind:ident),*], [$($v:literal: $v_kind:ident),*], $kinks:expr, $duration:expr,
     $y0:expr, |$t:ident, $y:ident| $rate:expr, [$($name:literal),*], |$at:ident| $law_kinks:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $model;

        impl<T: Real> Model<T> for $model {
            bare!($model, state [$($q,)* $($v,)*].len(), from $y0);
            const INFO: &'static Info<'static> = &Info {
                name: stringify!($model),
                coordinates: &[$($q),*],
                velocities: &[$($v),*],
                kinds: &[$(StateKind::$q_kind,)* $(StateKind::$v_kind,)*],
                units: &[$(unit(StateKind::$q_kind),)* $(unit(StateKind::$v_kind),)*],
                kinks: &[$($name),*],
                breakpoints: $kinks,
                duration: $duration,
                ..BARE
            };
            fn derivative(&self, $t: T, $y: &Self::State) -> Self::State {
                $rate
            }
            fn normalize(&self, _: &mut Self::State) {}
            fn kinks(&self, _: T, $at: &Self::State, results: &mut [T]) {
                results.copy_from_slice(&$law_kinks);
            }
        }
    };
}

/// x = cos(√k t), unit mass, with the stiffness k as parameter and the energy as output.
#[derive(Clone, Copy, Debug)]
pub struct Oscillator<T = f64> {
    stiffness: T,
}

impl Oscillator {
    /// The information on the model, the same for every scalar.
    pub const INFO: &'static Info<'static> = &Info {
        name: "oscillator",
        digest: "0123",
        coordinates: &["mass.x"],
        velocities: &["mass.x"],
        outputs: &[OutputInfo {
            name: "energy",
            unit: "J",
        }],
        parameters: &[ParameterInfo {
            name: "stiffness",
            unit: "N/m",
            default: 1.0,
            min: 0.0,
            max: 100.0,
            input: false,
        }],
        duration: 2.0,
        ..BARE
    };
}

impl<T: Real> ParameterSet<T> for Oscillator<T> {
    fn defaults() -> Self {
        Oscillator {
            stiffness: T::from_f64(1.0),
        }
    }
    fn get(&self, index: usize) -> Option<T> {
        (index == 0).then_some(self.stiffness)
    }
    fn set(&mut self, index: usize, value: T) -> bool {
        if index == 0 {
            self.stiffness = value;
        }
        index == 0
    }
}

impl<T: Real> Model<T> for Oscillator<T> {
    type With<U: Real> = Oscillator<U>;
    type Parameters = Oscillator<T>;
    type State = [T; 2];
    const INFO: &'static Info<'static> = Oscillator::INFO;
    fn new(parameters: Self) -> Self {
        parameters
    }
    fn parameters(&self) -> &Self {
        self
    }
    fn initial_state(&self) -> [T; 2] {
        [1.0, 0.0].map(T::from_f64)
    }
    fn derivative(&self, _: T, y: &[T; 2]) -> [T; 2] {
        [y[1], -self.stiffness * y[0]]
    }
    fn coordinate_rates(&self, y: &[T; 2], rate: &mut [T; 2]) {
        rate[0] = y[1];
    }
    fn outputs(&self, _: T, y: &[T; 2], results: &mut [T]) {
        results.copy_from_slice(&[T::from_f64(0.5) * (y[1] * y[1] + self.stiffness * y[0] * y[0])]);
    }
    fn normalize(&self, _: &mut [T; 2]) {}
}

model! {
    /// A mathematical pendulum, L = 1 m, g = 9.81 m/s², released at rest at 90° from the downward vertical:
    /// φ(t) = 2 asin(k sn(K − ω₀t, k)), k = sin 45°, ω₀ = √(g/L), period 4K/ω₀.
    Pendulum, ["arm.angle": Angle], ["arm.angle": AngularVelocity], &[], 10.0, [core::f64::consts::FRAC_PI_2, 0.0],
    |_t, y| [y[1], T::from_f64(-9.81) * y[0].sin_cos().0]
}

model! {
    /// An ellipse of eccentricity 0.5 around a unit centre of gravitation, from the pericentre; period 2π.
    Kepler, ["x": Position, "z": Position], ["x": Velocity, "z": Velocity], &[], core::f64::consts::TAU, [0.5, 0.0, 0.0, 1.732_050_807_568_877_2],
    |_t, y| {
        let r2 = y[0] * y[0] + y[1] * y[1];
        let pull = -(T::from_f64(1.0) / (r2 * r2.sqrt()));
        [y[2], y[3], pull * y[0], pull * y[1]]
    }
}

/// ẍ = pulse(t): zero until 0.1 s, up to 198 m/s² at 0.2 s, constant.
pub const PULSE: Curve<3> = Curve::new([[0.0, 0.0], [0.1, 0.0], [0.2, 198.0]], Extrapolate::Hold);

model! {
    /// A mass under [`PULSE`]: x is a cubic between the kinks.
    Sled, ["x": Position], ["x": Velocity], &[0.1, 0.2], 0.5, [0.0, 0.0],
    |t, y| [y[1], PULSE.value(t)]
}

model! {
    /// A velocity that follows the slope of [`PULSE`], which jumps at the kinks: x = pulse(t).
    Follower, ["x": Position], [], &[0.1, 0.2], 0.5, [0.0],
    |t, _y| [PULSE.slope(t)]
}

model! {
    /// ẋ = −10⁵ (x − cos t): stability, not accuracy, bounds the steps.
    Stiff, ["x": Position], [], &[], 1.0, [1.0],
    |t, y| [T::from_f64(-1e5) * (y[0] - t.sin_cos().1)]
}

model! {
    /// ẋ = x²: x = 1/(1 − t) grows without bound at t = 1.
    Explosion, ["x": Position], [], &[], 2.0, [1.0],
    |_t, y| [y[0] * y[0]]
}

model! {
    /// A model whose initial state has a NaN.
    Undefined, ["x": Position], ["x": Velocity], &[], 1.0, [0.0, f64::NAN],
    |_t, y| [y[1], y[0]]
}

model! {
    /// A model whose derivative is NaN from the start.
    Undetermined, ["x": Position], ["x": Velocity], &[], 1.0, [0.0, 0.0],
    |_t, y| [y[1], T::from_f64(0.0) / y[0]]
}

/// A mass at 1 m/s on a spring whose curve ends at 0.45 m.
#[derive(Clone, Copy, Debug)]
pub struct Runaway;

/// The curve of [`Runaway`].
pub const SPRING: Curve<2> = Curve::new([[-1.0, 0.0], [0.45, 1e-3]], Extrapolate::Error);

impl<T: Real> Model<T> for Runaway {
    bare!(Runaway, state 2, from [0.0, 1.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "runaway",
        coordinates: &["mass.x"],
        velocities: &["mass.x"],
        curves: &[CurveInfo {
            name: "spring: curve",
            unit: "m",
            first: -1.0,
            last: 0.45,
            ends: [0.0, 1e-3],
            extrapolate: Extrapolate::Error,
            told: true,
            kind: bryant_runtime::CurveKind::Curve,
        }],
        outputs: &[
            OutputInfo {
                name: "place",
                unit: "m",
            },
            OutputInfo {
                name: "spring force",
                unit: "N",
            },
        ],
        ..BARE
    };
    fn derivative(&self, _: T, y: &[T; 2]) -> [T; 2] {
        [y[1], -SPRING.value(y[0])]
    }
    fn outputs(&self, _: T, y: &[T; 2], results: &mut [T]) {
        results.copy_from_slice(&[y[0], SPRING.value(y[0])]);
    }
    fn curves(&self, _: T, y: &[T; 2], results: &mut [T]) {
        results.copy_from_slice(&[y[0]]);
    }
    fn normalize(&self, _: &mut [T; 2]) {}
}

/// A unit quaternion turning at ω = (0, 0, 2) rad/s: q = (cos t, 0, 0, sin t).
#[derive(Clone, Copy, Debug)]
pub struct Spin;

impl<T: Real> Model<T> for Spin {
    bare!(Spin, state 4, from [1.0, 0.0, 0.0, 0.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "spin",
        dimension: 3,
        coordinates: &["w", "x", "y", "z"],
        velocities: &[],
        kinds: &[StateKind::Angle; 4],
        units: &["rad", "rad", "rad", "rad"],
        duration: 100.0,
        every: 10.0,
        ..BARE
    };
    fn derivative(&self, _: T, q: &[T; 4]) -> [T; 4] {
        [-q[3], -q[2], q[1], q[0]]
    }
    fn normalize(&self, q: &mut [T; 4]) {
        let norm = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
        *q = q.map(|x| x / norm);
    }
}

/// x = −cos t. An event function changes its sign where x turns round, at t = π, 2π …; the memory is the largest x at
/// the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct Ratchet;

impl<T: Real> Model<T> for Ratchet {
    bare!(Ratchet, state 3, from [-1.0, 0.0, -2.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "ratchet",
        kinds: &[StateKind::Position, StateKind::Velocity, StateKind::Memory],
        units: &["m", "m/s", ""],
        memory: &["largest"],
        event_functions: &["turns"],
        duration: 10.0,
        every: 0.5,
        ..BARE
    };
    fn derivative(&self, _: T, &[x, v, _]: &[T; 3]) -> [T; 3] {
        [v, -x, T::from_f64(0.0)]
    }
    fn normalize(&self, _: &mut [T; 3]) {}
    fn renew(&self, _: T, y: &mut [T; 3]) {
        y[2] = y[2].max(y[0]);
    }
    fn event_functions(&self, _: T, y: &[T; 3], results: &mut [T]) {
        results.copy_from_slice(&[y[1]]);
    }
}

/// x = t. From t = 0.5 on, the event function changes its sign wherever x leaves the place of the last update, so every
/// step is cut down to a rounding of x.
#[derive(Clone, Copy, Debug)]
pub struct Ledge;

impl<T: Real> Model<T> for Ledge {
    bare!(Ledge, state 3, from [0.0, 1.0, 0.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "ledge",
        kinds: &[StateKind::Position, StateKind::Velocity, StateKind::Memory],
        units: &["m", "m/s", ""],
        memory: &["largest"],
        event_functions: &["leaves"],
        duration: 10.0,
        every: 0.5,
        ..BARE
    };
    fn derivative(&self, _: T, &[_, v, _]: &[T; 3]) -> [T; 3] {
        [v, T::from_f64(0.0), T::from_f64(0.0)]
    }
    fn normalize(&self, _: &mut [T; 3]) {}
    fn renew(&self, _: T, y: &mut [T; 3]) {
        y[2] = y[0];
    }
    fn event_functions(&self, _: T, y: &[T; 3], results: &mut [T]) {
        let one = T::from_f64(1.0);
        let left = T::select(y[2].lt(y[0]), -one, one);
        results.copy_from_slice(&[T::select(y[0].lt(T::from_f64(0.5)), one, left)]);
    }
}

/// A point that is pushed hard from a certain moment on, at which no step ends. It counts how often it is updated.
#[derive(Clone, Copy, Debug)]
pub struct Counter;

impl<T: Real> Model<T> for Counter {
    bare!(Counter, state 3, from [0.0, 1.0, 0.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "counter",
        kinds: &[StateKind::Position, StateKind::Velocity, StateKind::Memory],
        units: &["m", "m/s", ""],
        memory: &["renewals"],
        duration: 2.0,
        ..BARE
    };
    fn derivative(&self, t: T, &[_, v, _]: &[T; 3]) -> [T; 3] {
        let (zero, push) = (T::from_f64(0.0), T::from_f64(1e4));
        [v, T::select(T::from_f64(1.234).lt(t), push, zero), zero]
    }
    fn normalize(&self, _: &mut [T; 3]) {}
    fn renew(&self, _: T, y: &mut [T; 3]) {
        y[2] += T::from_f64(1.0);
    }
}

/// Time passes. A first switch fires at 1 s, a second one after the first, a third after the second.
#[derive(Clone, Copy, Debug)]
pub struct Chain;

impl<T: Real> Model<T> for Chain {
    bare!(Chain, state 5, from [0.0, 0.0, 9.0, 9.0, 9.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "chain",
        kinds: &[
            StateKind::Position,
            StateKind::Velocity,
            StateKind::Memory,
            StateKind::Memory,
            StateKind::Memory,
        ],
        units: &["m", "m/s", "", "", ""],
        memory: &["first", "second", "third"],
        event_functions: &["first", "second", "third"],
        duration: 2.0,
        every: 0.5,
        ..BARE
    };
    fn derivative(&self, _: T, &[_, v, ..]: &[T; 5]) -> [T; 5] {
        let zero = T::from_f64(0.0);
        [v, zero, zero, zero, zero]
    }
    fn normalize(&self, _: &mut [T; 5]) {}
    fn renew(&self, t: T, y: &mut [T; 5]) {
        let mut event_functions = [T::from_f64(0.0); 3];
        self.event_functions(t, y, &mut event_functions);
        for (time, event_function) in y[2..].iter_mut().zip(event_functions) {
            *time = T::select(event_function.lt(T::from_f64(0.0)), t, *time);
        }
    }
    fn event_functions(&self, t: T, &[_, _, first, second, third]: &[T; 5], results: &mut [T]) {
        let (one, ever) = (T::from_f64(1.0), T::from_f64(8.0));
        // the event function of a switch that has fired stays at 1
        let waiting = |time: T, event_function: T| T::select(time.lt(ever), one, event_function);
        results.copy_from_slice(&[
            waiting(first, one - t),
            waiting(second, first - ever),
            waiting(third, second - ever),
        ]);
    }
}

model! {
    /// A ball that falls from 1 m onto a spring of 100 N/m: the force has a kink where it touches.
    Ball, ["z": Position], ["z": Velocity], &[], 3.0, [1.0, 0.0],
    |_t, y| {
        let (zero, stiffness) = (T::from_f64(0.0), T::from_f64(100.0));
        let touches = y[0].lt(zero);
        [y[1], T::from_f64(-10.0) - T::select(touches, stiffness * y[0], zero)]
    },
    ["touches"], |y| [y[0]]
}

model! {
    /// A mass of 1 kg that runs into a belt at 2 m/s. From 1 m on the belt pulls it back with 100 N/m and 4 N s/m, and
    /// never pushes. The force jumps where the belt goes taut.
    Tether, ["x": Position], ["x": Velocity], &[], 1.5, [0.0, 2.0],
    |_t, y| {
        let zero = T::from_f64(0.0);
        let stretch = y[0] - T::from_f64(1.0);
        let pull = T::from_f64(100.0) * stretch + T::from_f64(4.0) * y[1];
        [y[1], -T::select(zero.lt(stretch), pull.max(zero), zero)]
    },
    ["goes taut", "pulls"], |y| {
        let stretch = y[0] - T::from_f64(1.0);
        let pull = T::from_f64(100.0) * stretch + T::from_f64(4.0) * y[1];
        [stretch, T::select(T::from_f64(0.0).lt(stretch), pull, stretch)]
    }
}

/// A mass of 1 kg under 1 N, whose reported power is a tenth too small from 0.5 s on.
#[derive(Clone, Copy, Debug)]
pub struct Leaky;

impl<T: Real> Model<T> for Leaky {
    bare!(Leaky, state 2, from [0.0, 0.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "Leaky",
        powers: &["thrust"],
        breakpoints: &[0.5],
        ..BARE
    };
    fn derivative(&self, _: T, y: &[T; 2]) -> [T; 2] {
        [y[1], T::from_f64(1.0)]
    }
    fn normalize(&self, _: &mut [T; 2]) {}
    fn kinetic_energy(&self, _: T, y: &[T; 2], results: &mut [T]) {
        results[0] = T::from_f64(0.5) * y[1] * y[1];
    }
    fn powers(&self, t: T, y: &[T; 2], results: &mut [T]) {
        let share = T::select(t.lt(T::from_f64(0.5)), T::from_f64(1.0), T::from_f64(0.9));
        results.copy_from_slice(&[share * y[1]]);
    }
}

/// A mass of 1 kg on a spring of 1 N/m, from 1 m at rest, with the power of the spring.
#[derive(Clone, Copy, Debug)]
pub struct Stage;

impl<T: Real> Model<T> for Stage {
    bare!(Stage, state 2, from [1.0, 0.0]);
    const INFO: &'static Info<'static> = &Info {
        name: "Stage",
        powers: &["spring"],
        ..BARE
    };
    fn derivative(&self, _: T, y: &[T; 2]) -> [T; 2] {
        [y[1], -y[0]]
    }
    fn normalize(&self, _: &mut [T; 2]) {}
    fn kinetic_energy(&self, _: T, y: &[T; 2], results: &mut [T]) {
        results[0] = T::from_f64(0.5) * y[1] * y[1];
    }
    fn powers(&self, _: T, y: &[T; 2], results: &mut [T]) {
        results.copy_from_slice(&[-(y[0] * y[1])]);
    }
}
