//! The trait that every generated module implements, and that integrators and runners take.

use crate::section::sections;
use crate::{Extrapolate, Real};
use core::ops::{Index, IndexMut};

/// An output writer: takes results one by one, in the order in which they are computed ([`Model::each_rate`]).
///
/// An array stores them. Another writer may turn each result into something else, such as the state that it leads to,
/// while it is still in a register; then nothing is stored in between.
pub trait OutputWriter<T> {
    /// Takes the result with an index. Mark it `#[inline(always)]`: generated code calls it in straight lines, with
    /// indices known at compile time.
    fn put(&mut self, index: usize, value: T);
}

/// A change of each entry of a state, independent of the others.
pub trait Change<T> {
    /// The new value of the entry `index`, whose value is now `value`. Mark it `#[inline(always)]`.
    fn of(&self, index: usize, value: T) -> T;
}

impl<T, const N: usize> OutputWriter<T> for [T; N] {
    #[inline(always)]
    fn put(&mut self, index: usize, value: T) {
        self[index] = value;
    }
}

/// An offset view: the part of a writer that begins at the index `FROM`.
pub struct OffsetView<'a, S, const FROM: usize>(pub &'a mut S);

impl<T, S: OutputWriter<T>, const FROM: usize> OutputWriter<T> for OffsetView<'_, S, FROM> {
    #[inline(always)]
    fn put(&mut self, index: usize, value: T) {
        self.0.put(FROM + index, value);
    }
}

/// The opposite of an offset view: passes the results from index `FROM` on to the writer, as 0, 1, …, and drops those
/// before.
pub struct TailView<'a, S, const FROM: usize>(pub &'a mut S);

impl<T, S: OutputWriter<T>, const FROM: usize> OutputWriter<T> for TailView<'_, S, FROM> {
    #[inline(always)]
    fn put(&mut self, index: usize, value: T) {
        if let Some(index) = index.checked_sub(FROM) {
            self.0.put(index, value);
        }
    }
}

/// A fixed-size array of scalars.
pub trait Vector<T>:
    Copy + AsRef<[T]> + AsMut<[T]> + Index<usize, Output = T> + IndexMut<usize> + OutputWriter<T>
{
    /// Number of entries.
    const LEN: usize;
    /// A square matrix with as many rows and columns as the array has entries, by rows.
    type Square: AsRef<[Self]> + AsMut<[Self]>;
    /// An index for each entry.
    type Indices: AsRef<[usize]> + AsMut<[usize]>;
    /// The same scalar in every entry.
    fn splat(value: T) -> Self;
    /// The same scalar in every entry of a matrix.
    fn square(value: T) -> Self::Square;
    /// Zeros, one for each entry.
    fn indices() -> Self::Indices;
    /// The slice as such an array.
    ///
    /// # Panics
    /// Where the slice has another length.
    fn of(slice: &[T]) -> &Self;
    /// The mutable slice as such an array.
    ///
    /// # Panics
    /// Where the slice has another length.
    fn of_mut(slice: &mut [T]) -> &mut Self;
}

impl<T: Copy, const N: usize> Vector<T> for [T; N] {
    const LEN: usize = N;
    type Square = [[T; N]; N];
    type Indices = [usize; N];
    fn splat(value: T) -> Self {
        [value; N]
    }
    fn square(value: T) -> [[T; N]; N] {
        [[value; N]; N]
    }
    fn indices() -> [usize; N] {
        [0; N]
    }
    #[inline(always)]
    fn of(slice: &[T]) -> &Self {
        match slice.try_into() {
            Ok(array) => array,
            Err(_) => panic!("{} entries where there are {N}", slice.len()),
        }
    }
    #[inline(always)]
    fn of_mut(slice: &mut [T]) -> &mut Self {
        let length = slice.len();
        match slice.try_into() {
            Ok(array) => array,
            Err(_) => panic!("{length} entries where there are {N}"),
        }
    }
}

/// The methods of [`Model`] for its sections. A model that has no such results need not have the method. Where
/// [`Info`] lists results by name, a model without the method does not compile.
macro_rules! methods {
    ($($(#[$doc:meta])* $section:ident $name:ident $form:ident |$info:ident| $length:expr;)*) => {
        $(method! { $(#[$doc])* $form $section $name })*
    };
}
macro_rules! method {
    ($(#[$doc:meta])* state $section:ident $name:ident) => {};
    ($(#[$doc:meta])* many $section:ident $name:ident) => {
        $(#[$doc])*
        #[inline(always)]
        fn $name(&self, _t: T, _y: &Self::State, _results: &mut [T]) {
            const {
                assert!(
                    Self::INFO.length(crate::Section::$section) == 0,
                    concat!("the model lists results of `", stringify!($name), "`, but has no such method")
                );
            }
        }
    };
    ($(#[$doc:meta])* $form:ident $section:ident $name:ident) => {
        $(#[$doc])*
        #[inline(always)]
        fn $name(&self, _t: T, _y: &Self::State, results: &mut [T]) {
            results.fill(T::from_f64(0.0));
        }
    };
}

/// A generated model at one set of parameters.
///
/// The state y is the coordinates q followed by the velocities v. In space with quaternions an element has four
/// coordinates (w, x, y, z) and three velocities (ω, in absolute axes). Behind them stand, where the model has them,
/// the continuous states z of force laws, which are integrated with the rest, and the discrete states m (the memory),
/// whose rate is 0. m changes only by the discrete update after an accepted step ([`Model::renew`]), so no stage of a
/// step and no rejected step changes it.
///
/// With Bryant angles the first entries of m are the charts of the elements, which say what their angles mean. Two
/// states with different charts must not be compared or mixed entry by entry.
///
/// The methods of [sections](crate::Section) write to a slice that has exactly the length [`Info::length`].
pub trait Model<T: Real>: Sized {
    /// The same model over another scalar: [`over`] makes it with the same parameters.
    type With<U: Real>: Model<U>;
    /// The adjustable parameters of the model.
    type Parameters: ParameterSet<T>;
    /// y: `[T; STATE]`, with q, v, z and m together.
    type State: Vector<T>;
    /// Names, units, sizes.
    const INFO: &'static Info<'static>;

    /// Makes the model with these parameters. Everything that depends on parameters alone is computed here, once.
    fn new(parameters: Self::Parameters) -> Self;
    /// The parameters that it was made with.
    fn parameters(&self) -> &Self::Parameters;
    /// The state at which a run starts.
    fn initial_state(&self) -> Self::State;
    /// ẏ at time `t` \[s\] and state `y`.
    fn derivative(&self, t: T, y: &Self::State) -> Self::State;
    /// ẏ at time `t` \[s\] and state `y`, entry by entry: each index of the state once, in the order in which they are
    /// computed.
    #[inline(always)]
    fn each_rate(&self, t: T, y: &Self::State, writer: &mut impl OutputWriter<T>) {
        let rate = self.derivative(t, y);
        for i in 0..Self::State::LEN {
            writer.put(i, rate[i]);
        }
    }
    /// q̇ at the coordinates and velocities of `y`, written into the coordinates of `rate`. The rest of `rate` is not
    /// changed. The semi-implicit Euler method needs it at old coordinates and new velocities.
    fn coordinate_rates(&self, y: &Self::State, rate: &mut Self::State);
    /// Puts the state back on its manifold (unit quaternions). It is called after every accepted step.
    fn normalize(&self, y: &mut Self::State);
    /// Changes every entry, then normalizes the state ([`Self::normalize`]). A model that does both at once for each
    /// quaternion does its roots and divisions while entries of others are fetched.
    #[inline(always)]
    fn normalize_changed(&self, y: &mut Self::State, change: &impl Change<T>) {
        for i in (0..Self::State::LEN).rev() {
            y[i] = change.of(i, y[i]);
        }
        self.normalize(y);
    }
    /// The discrete update after an accepted step: it renews what is constant during a step, the memory of force laws
    /// and the charts of Bryant angles. Where a chart changes, the coordinates and velocities of its element change
    /// with it; they describe the same orientation and angular velocity as before, within rounding. The rest of the
    /// state, z included, is not changed. If there is nothing to update, the whole state keeps its bits.
    #[inline(always)]
    fn renew(&self, _t: T, _y: &mut Self::State) {}
    /// The smallest pivot of the elimination, as a share of the diagonal entry that stood there before the elimination,
    /// and the index of its element in [`Info::pivots`]. At 0 the accelerations are not determined. `None` where no
    /// pivot can vanish.
    #[inline(always)]
    fn smallest_pivot(&self, _t: T, _y: &Self::State) -> Option<(usize, T)> {
        None
    }
    /// The first condition on parameters that does not hold, an index in [`Info::conditions`].
    #[inline(always)]
    fn violated(&self) -> Option<usize> {
        None
    }
    /// The first time after `t` at which a curve of time has a kink whose time depends on parameters; +∞ if there is
    /// none. Kinks that are known beforehand are in [`Info::breakpoints`]. All lanes get the first time of any lane,
    /// each with its own derivatives.
    fn kink_after(&self, t: f64) -> T {
        let _ = t;
        T::from_f64(f64::INFINITY)
    }

    sections!(methods);
}

/// The same model over another scalar, with the same parameters; `convert` converts each. The states of both have the
/// same length and the same order of entries, and `M::INFO` holds for both.
///
/// A method that needs Jacobians thus makes a model of dual numbers from an `M: Model<f64>`, and a reference solution
/// makes one of double-doubles.
pub fn over<T: Real, U: Real, M: Model<T>>(model: &M, convert: impl Fn(T) -> U) -> M::With<U> {
    let given = model.parameters();
    let mut parameters = <M::With<U> as Model<U>>::Parameters::defaults();
    let mut index = 0;
    while let Some(value) = given.get(index) {
        parameters.set(index, convert(value));
        index += 1;
    }
    M::With::<U>::new(parameters)
}

/// A struct of parameters, which can be addressed by index as listed in [`Info::parameters`].
pub trait ParameterSet<T>: Clone {
    /// The default values of the model.
    fn defaults() -> Self;
    /// The value at an index; `None` beyond the last.
    fn get(&self, index: usize) -> Option<T>;
    /// Sets the value at an index; returns false beyond the last.
    fn set(&mut self, index: usize, value: T) -> bool;
}

/// Everything known of a model without evaluating it. It borrows its names: those of generated code last as long as the
/// program, those of a model that is read at run time as long as that model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Info<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// SHA-256 of the content of the model, hexadecimal. It does not depend on how the model is written.
    pub digest: &'a str,
    /// 2 or 3: a planar or a spatial model.
    pub dimension: u8,
    /// Names of q, in order ("man.x", "man/head.angle", "man/head.w").
    pub coordinates: &'a [&'a str],
    /// Names of v, in order.
    pub velocities: &'a [&'a str],
    /// The kind of each entry of the state, in its order: q, v, z, m.
    pub kinds: &'a [StateKind],
    /// SI unit of each entry of the state, in its order; "" for a pure number, such as a component of a quaternion.
    pub units: &'a [&'a str],
    /// Names of z, the continuous states of force laws, in order ("muscle biceps: activation").
    pub auxiliaries: &'a [&'a str],
    /// Names of m, the discrete states: first the charts of elements ("man/head: chart"), then the memory of force laws
    /// ("contact seat: permanent set").
    pub memory: &'a [&'a str],
    /// Names of the event functions ("belt lap: locks").
    pub event_functions: &'a [&'a str],
    /// Names of the non-smooth switching functions ("belt lap: goes taut").
    pub kinks: &'a [&'a str],
    /// Names of the onsets: first those of laws ("contact hit: touches"), then those of corners ("contact hit: corner
    /// of the curve").
    pub onsets: &'a [&'a str],
    /// Number of the onsets that are corners of curves; they come last.
    pub corners: usize,
    /// Longest allowed step of a method with error control \[s\]. A user force may begin to act at any time without an
    /// onset. Infinite if there is no such force.
    pub longest_step: f64,
    /// Names of the effects that do work ("contact seat: friction").
    pub powers: &'a [&'a str],
    /// The watched curves of the state, the bearings of joints that bend, and the directions in which pairs of
    /// ellipsoids push.
    pub curves: &'a [CurveInfo<'a>],
    /// True if a curve of time ends, and must not be left (`extrapolate: error`).
    pub time_ends: bool,
    /// Elements whose inertia may vanish in some position ("man/head").
    pub pivots: &'a [&'a str],
    /// Conditions that parameters must satisfy ("`mass` of man/head must be positive").
    pub conditions: &'a [&'a str],
    /// Whether the reference joint of some system is free, so that there is a momentum to balance.
    pub free: bool,
    /// Headings and units of the output columns.
    pub outputs: &'a [OutputInfo<'a>],
    /// Names, units and bounds of the parameters.
    pub parameters: &'a [ParameterInfo<'a>],
    /// Times at which a curve of time has a kink, increasing \[s\]: no step may cross one.
    pub breakpoints: &'a [f64],
    /// Length of a run \[s\].
    pub duration: f64,
    /// Time between samples \[s\].
    pub every: f64,
}

impl<'a> Info<'a> {
    /// The noun for an entry of the state: a coordinate, a velocity or a state of a force law.
    pub fn state_noun(&self, index: usize) -> &'static str {
        let coordinates = self.coordinates.len();
        match index {
            index if index < coordinates => "coordinate",
            index if index < coordinates + self.velocities.len() => "velocity",
            _ => "state of a force law",
        }
    }

    /// SI unit of an entry of the state, coordinates first, "" for a pure number; `None` beyond the last.
    pub fn state_unit(&self, index: usize) -> Option<&'a str> {
        self.units.get(index).copied()
    }

    /// Name of an entry of the state, coordinates first, `None` beyond the last.
    pub fn state_name(&self, index: usize) -> Option<&'a str> {
        self.coordinates
            .iter()
            .chain(self.velocities)
            .chain(self.auxiliaries)
            .chain(self.memory)
            .nth(index)
            .copied()
    }
}

/// The kind of an entry of the state. The allowed error of the entry depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StateKind {
    /// A coordinate of a reference joint \[m\].
    Position,
    /// An angle \[rad\], or a component of a unit quaternion, whose size is that of half an angle.
    Angle,
    /// A velocity of a reference joint \[m/s\].
    Velocity,
    /// An angular velocity of an element, or the rate of an angle \[rad/s\].
    AngularVelocity,
    /// A continuous state of a force law, in a unit of its own.
    Law,
    /// A discrete state: memory of a force law, or the chart of an element. Nothing integrates it.
    Memory,
}

/// The kind of an entry of [`Info::curves`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKind {
    /// A curve of the state.
    Curve,
    /// The bearing of a bent joint \[rad\], from −π to π: the direction, seen along the long axis of the carrying
    /// element, to which the other long axis is bent; [`CurveInfo::last`] while the bend is less than 90°. For a
    /// bushing, or for laws of a joint about x, y and z, the angle about x; [`CurveInfo::last`] while the angle about y
    /// is far from ±90°.
    Bearing,
    /// The sine of an angle of a joint or a bushing while its cosine is negative, else [`CurveInfo::last`]: at ±180°
    /// the torque jumps.
    HalfTurn,
    /// A component of the direction in which two ellipsoids push each other; [`CurveInfo::last`] while they do not
    /// push. The components of one contact follow each other, one for each dimension of the model. Their vector has the
    /// length 1, or less where no direction is determined. For a bushing with a law of the whole rotation, a component
    /// of the axis of this rotation while its angle is above 90°.
    Direction(u8),
    /// The share of the volume of an airbag that a penetrating body takes; 0 while it does not push. The law ends at
    /// [`CurveInfo::last`].
    Volume,
    /// The sideways force of the fading edge of a plane, as a share of the elastic force with which the plane pushes
    /// within its edges. Beyond [`CurveInfo::last`] the edge is too narrow for the depth.
    Edge,
}

/// A curve at an argument that depends on the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveInfo<'a> {
    /// Name of its effect ("joint man/head: elastic").
    pub name: &'a str,
    /// SI unit of its abscissa; "" for a pure number.
    pub unit: &'a str,
    /// Its first abscissa.
    pub first: f64,
    /// Its last abscissa.
    pub last: f64,
    /// Its values at the first and the last abscissa.
    pub ends: [f64; 2],
    /// Its continuation beyond them.
    pub extrapolate: Extrapolate,
    /// True if the description gives this continuation; false if it is the default.
    pub told: bool,
    /// The kind of this entry: a curve, or another quantity that is watched like one.
    pub kind: CurveKind,
}

impl CurveInfo<'_> {
    /// True if this entry belongs to a bushing: its name begins with the kind of its law.
    pub(crate) fn is_of_bushing(&self) -> bool {
        self.name.starts_with("bushing ")
    }

    /// The middle one of the three turns of a joint's laws about x, y and z. The name of the entry ends with their
    /// order: "joint man/head about x, y and z".
    pub(crate) fn middle(&self) -> Option<char> {
        let order = self.name.rsplit_once(" about ")?.1;
        let (first, others) = order.split_once(", ")?;
        let (middle, last) = others.split_once(" and ")?;
        let axis = |name: &str| matches!(name, "x" | "y" | "z");
        (axis(first) && axis(middle) && axis(last)).then(|| middle.chars().next())?
    }

    /// Says what became of the law of a [bearing](CurveKind::Bearing), an angle or a direction of a bushing that leapt.
    pub fn singular(&self) -> &'static str {
        match (self.kind, self.middle()) {
            (CurveKind::HalfTurn, _) => {
                "is turned through ±180°, where its angle and its torque jump to the other side"
            }
            (CurveKind::Direction(_), _) => {
                "is turned through 180°, where its torque jumps to the opposite direction"
            }
            (_, Some('x')) => {
                "is turned through ±90° about x, where the angles about y and z are not defined"
            }
            (_, Some('z')) => {
                "is turned through ±90° about z, where the angles about x and y are not defined"
            }
            (_, None) if !self.is_of_bushing() => {
                "is bent through 180°, where flexion has no direction and torsion no angle"
            }
            _ => "is turned through ±90° about y, where the angles about x and z are not defined",
        }
    }

    /// The interval of trusted arguments. Beyond it the values of the curve are invented: a straight line over more
    /// than the whole width of the points, or a held value other than 0 that the description did not ask for.
    pub fn trusted(&self) -> [f64; 2] {
        let endless = [f64::NEG_INFINITY, f64::INFINITY];
        match (self.kind, self.extrapolate) {
            (CurveKind::Curve, Extrapolate::Linear) => {
                let width = self.last - self.first;
                [self.first - width, self.last + width]
            }
            (CurveKind::Curve, Extrapolate::Hold) if !self.told => [
                if self.ends[0] == 0.0 {
                    endless[0]
                } else {
                    self.first
                },
                if self.ends[1] == 0.0 {
                    endless[1]
                } else {
                    self.last
                },
            ],
            (CurveKind::Volume | CurveKind::Edge, _) => [endless[0], self.last],
            _ => endless,
        }
    }

    /// The distance of `argument` beyond the first or the last point; 0 within.
    pub fn beyond(&self, argument: f64) -> f64 {
        (self.first - argument).max(argument - self.last).max(0.0)
    }
}

/// A column of the output table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputInfo<'a> {
    /// Heading.
    pub name: &'a str,
    /// SI unit, "" for a pure number.
    pub unit: &'a str,
}

/// An adjustable number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterInfo<'a> {
    /// Name.
    pub name: &'a str,
    /// SI unit, "" where unknown.
    pub unit: &'a str,
    /// Default (SI).
    pub default: f64,
    /// Smallest value allowed (SI), −∞ where unbounded.
    pub min: f64,
    /// Largest value allowed (SI), +∞ where unbounded.
    pub max: f64,
    /// True for an input: it may change during a run.
    pub input: bool,
}

impl Info<'_> {
    /// The inputs, as indices into [`Info::parameters`].
    pub fn inputs(&self) -> impl Iterator<Item = usize> {
        let parameters = self.parameters.iter().enumerate();
        parameters.filter_map(|(index, of)| of.input.then_some(index))
    }
}
