//! The comparison: every method of two models, at many states, to the last bit.

use bryant_engine::{Engine, UserFunctions};
use bryant_generator::Config;
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::real::{Base, Form};
use bryant_runtime::{
    Adjustable, Compiled, DoubleDouble, Dual, Dynamics, Family, Fast, Model, Real, Section,
    Several, Width,
};
use std::path::Path;
use std::sync::Arc;

/// Writes results of a model.
pub type Writes<'a, T> = dyn Fn(&dyn Dynamics<T>, &mut [T]) + 'a;

/// The bits of a scalar. All NaN have the same bits.
pub trait Bits {
    fn bits(&self) -> Vec<u64>;
}

impl Bits for f64 {
    fn bits(&self) -> Vec<u64> {
        vec![if self.is_nan() {
            u64::MAX
        } else {
            self.to_bits()
        }]
    }
}

impl Bits for f32 {
    fn bits(&self) -> Vec<u64> {
        vec![if self.is_nan() {
            u64::MAX
        } else {
            self.to_bits().into()
        }]
    }
}

impl Bits for Fast {
    fn bits(&self) -> Vec<u64> {
        self.0.bits()
    }
}

impl<T: Bits> Bits for Dual<T> {
    fn bits(&self) -> Vec<u64> {
        [self.value.bits(), self.slope.bits()].concat()
    }
}

impl Bits for DoubleDouble {
    fn bits(&self) -> Vec<u64> {
        self.parts().iter().flat_map(Bits::bits).collect()
    }
}

/// A generator of pseudo-random numbers.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// A number between −1 and 1.
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// The user functions of bundled models.
#[derive(Debug)]
enum Users {
    Drag,
    Muscle,
}

impl UserFunctions for Users {
    fn knows(&self, _force: usize) -> bool {
        true
    }

    fn call(&self, _force: usize, form: Form, arguments: &[f64], results: &mut [f64]) {
        let given = arguments.chunks_exact(arguments.len() / form.lanes);
        let returned = results.chunks_exact_mut(results.len() / form.lanes);
        for (arguments, results) in given.zip(returned) {
            self.of_lane(form, arguments, results);
        }
    }
}

impl Users {
    /// Calls a function for one lane, over the scalar of a form.
    fn of_lane(&self, form: Form, arguments: &[f64], results: &mut [f64]) {
        let lane = Lane {
            users: self,
            arguments,
            results,
        };
        match (form.base, form.order) {
            (Base::Double, 0) => lane.over::<f64>(),
            (Base::Double, 1) => lane.over::<Dual<f64>>(),
            (Base::Single, 0) => lane.over::<f32>(),
            (Base::Fast, 0) => lane.over::<Fast>(),
            (Base::DoubleDouble, 0) => lane.over::<DoubleDouble>(),
            (Base::Lane, 0) => with_width(Width::One, lane).expect("registers"),
            (Base::Lane, 1) => with_width(Width::One, WithSlope(lane)).expect("registers"),
            _ => panic!("nothing is compared over {form:?}"),
        }
    }
}

/// The call of one lane, in words.
struct Lane<'a> {
    users: &'a Users,
    arguments: &'a [f64],
    results: &'a mut [f64],
}

impl Lane<'_> {
    fn over<T: Real>(self) {
        match self.users {
            Users::Drag => self.by(bryant_generated::skydiver::drag::scalars::<T>),
            Users::Muscle => self.by(bryant_generated::elbow::muscle::scalars::<T>),
        }
    }

    fn by<T: Real, const A: usize, const R: usize>(self, function: impl Fn([T; A]) -> [T; R]) {
        let words = T::FORM.expect("a form").words();
        let given = std::array::from_fn(|i| T::of_words(words, &self.arguments[i * words..]));
        let returned = self.results.chunks_exact_mut(words);
        for (result, place) in function(given).into_iter().zip(returned) {
            result.put(words, place);
        }
    }
}

impl OfAnyWidth for Lane<'_> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        self.over::<T>();
    }
}

/// The call of one lane over dual numbers.
struct WithSlope<'a>(Lane<'a>);

impl OfAnyWidth for WithSlope<'_> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        self.0.over::<Dual<T>>();
    }
}

/// The engine of a bundled model.
pub fn engine(name: &str, matrices: bool) -> Engine {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{name}.yaml"));
    let (model, _) = bryant_generator::read(&path).expect("bundled models are right");
    let lists = Config::new().matrices(matrices).lists(&model);
    let users = match name {
        "skydiver" => Some(Users::Drag),
        "elbow" => Some(Users::Muscle),
        _ => None,
    };
    let users = users.map(|users| Arc::new(users) as Arc<dyn UserFunctions>);
    Engine::with_functions(lists, users).expect("all functions of bundled models are known")
}

/// Asserts that two models give the same bits at many states and for several parameters.
pub fn compare<T: Real, O: Of<T>>(expected: &mut dyn Adjustable<T>, found: &mut dyn Adjustable<T>) {
    assert_eq!(expected.info(), found.info());
    let mut random = Random::new(expected.info().state_length() as u64);
    for round in 0..6 {
        if round > 0 {
            let size = 0.05 * f64::from(round);
            let near = |parameter: &bryant_runtime::ParameterInfo<'_>, random: &mut Random| {
                O::near(parameter.default, size * parameter.default, random)
            };
            let parameters = expected.info().parameters.iter();
            let values: Vec<T> = parameters.map(|p| near(p, &mut random)).collect();
            expected.set_parameters(&values);
            found.set_parameters(&values);
        }
        compare_constants::<T, O>(&*expected, &*found);
        let info = expected.info();
        for state in 0..20 {
            let mut y = vec![T::from_f64(0.0); info.state_length()];
            expected.initial_state(&mut y);
            let size = [0.0, 0.01, 0.3, 1.0][state % 4];
            for (entry, kind) in y.iter_mut().zip(info.kinds) {
                if *kind != bryant_runtime::StateKind::Memory {
                    *entry += O::near(0.0, size, &mut random);
                }
            }
            if state % 5 == 3 {
                // Zeros of both signs are included.
                for entry in y.iter_mut().step_by(3) {
                    *entry = O::near(
                        if random.next() < 0.0 { 0.0 } else { -0.0 },
                        0.0,
                        &mut random,
                    );
                }
            }
            let t = O::near(0.05, 0.1, &mut random);
            compare_at::<T, O>(&*expected, &*found, t, &y);
        }
    }
}

fn same<T: Real, O: Of<T>>(name: &str, what: &str, expected: &[T], found: &[T]) {
    let bits = |values: &[T]| values.iter().map(O::bits).collect::<Vec<_>>();
    if bits(expected) != bits(found) {
        for (i, (a, b)) in expected.iter().zip(found).enumerate() {
            assert_eq!(O::bits(a), O::bits(b), "{name}: {what}[{i}]: {a:?}, {b:?}");
        }
    }
    assert_eq!(expected.len(), found.len());
}

fn compare_constants<T: Real, O: Of<T>>(expected: &dyn Dynamics<T>, found: &dyn Dynamics<T>) {
    let info = expected.info();
    let mut both = [(); 2].map(|()| vec![T::from_f64(0.5); info.state_length()]);
    expected.initial_state(&mut both[0]);
    found.initial_state(&mut both[1]);
    same::<T, O>(info.name, "initial state", &both[0], &both[1]);
    assert_eq!(expected.violated(), found.violated(), "{}", info.name);
    for t in [0.0, 0.01, 0.1, 1.0] {
        let kinks = [expected.kink_after(t), found.kink_after(t)];
        same::<T, O>(info.name, "kink after", &kinks[..1], &kinks[1..]);
    }
}

/// Compares all methods at one state.
fn compare_at<T: Real, O: Of<T>>(
    expected: &dyn Dynamics<T>,
    found: &dyn Dynamics<T>,
    t: T,
    y: &[T],
) {
    let info = expected.info();
    let name = info.name;
    let mut y = y.to_vec();
    let mut other = y.clone();
    expected.normalize(&mut y);
    found.normalize(&mut other);
    same::<T, O>(name, "normalized", &y, &other);
    let compare = |what: &str, length: usize, method: &Writes<'_, T>| {
        let mut both = [(); 2].map(|()| vec![T::from_f64(0.25); length]);
        method(expected, &mut both[0]);
        method(found, &mut both[1]);
        same::<T, O>(name, what, &both[0], &both[1]);
    };
    compare("derivative", y.len(), &|m, out| m.derivative(t, &y, out));
    compare("coordinate rates", y.len(), &|m, out| {
        m.coordinate_rates(&y, out)
    });
    for &section in Section::ALL {
        let length = info.length(section);
        compare(section.name(), length, &|m, out| {
            if length > 0 {
                m.section(section, t, &y, out);
            }
        });
    }
    let pivots = [expected.smallest_pivot(t, &y), found.smallest_pivot(t, &y)];
    assert_eq!(
        pivots[0].map(|pivot| pivot.0),
        pivots[1].map(|pivot| pivot.0)
    );
    let pivot = |of: &Option<(usize, T)>| of.map_or(T::from_f64(0.0), |pivot| pivot.1);
    same::<T, O>(name, "pivot", &[pivot(&pivots[0])], &[pivot(&pivots[1])]);
    compare_at_once::<T, O>(expected, found, t, &y);
}

/// Compares what both models compute at once with what one returns one by one.
fn compare_at_once<T: Real, O: Of<T>>(
    expected: &dyn Dynamics<T>,
    found: &dyn Dynamics<T>,
    t: T,
    y: &[T],
) {
    use Section::*;
    let info = expected.info();
    let sets: [&[Section]; 7] = [
        &[Powers, ExternalWrench],
        &[EventFunctions, Onsets, Renewed],
        &[EventFunctions, Onsets, Renewed, Curves],
        &[
            EventFunctions,
            Onsets,
            Renewed,
            Curves,
            KineticEnergy,
            Powers,
            Momentum,
            ExternalWrench,
        ],
        Section::ALL,
        // in another order, and one twice
        &[Outputs, Powers, Renewed, Kinks],
        &[Momentum, Powers, Powers],
    ];
    for sections in sets {
        let of = |section: &Section| vec![T::from_f64(0.25); info.length(*section)];
        let mut one_by_one: Vec<Vec<T>> = sections.iter().map(of).collect();
        for (section, results) in sections.iter().zip(&mut one_by_one) {
            if !results.is_empty() {
                expected.section(*section, t, y, results);
            }
        }
        for model in [expected, found] {
            let mut at_once: Vec<Vec<T>> = sections.iter().map(of).collect();
            let places = at_once.iter_mut().map(|place| &mut place[..]);
            let mut wanted: Vec<_> = sections.iter().copied().zip(places).collect();
            model.sections(t, y, &mut wanted);
            let what = format!("{sections:?} at once");
            same::<T, O>(info.name, &what, &one_by_one.concat(), &at_once.concat());
        }
    }
}

/// A scalar that tests make from random numbers.
pub trait Near: Real + Bits {
    /// A scalar that differs from `value` by at most `size`.
    fn near(value: f64, size: f64, random: &mut Random) -> Self;
}

impl Near for f64 {
    fn near(value: f64, size: f64, random: &mut Random) -> f64 {
        match size == 0.0 {
            true => value,
            false => value + size * random.next(),
        }
    }
}

impl Near for f32 {
    fn near(value: f64, size: f64, random: &mut Random) -> f32 {
        f64::near(value, size, random) as f32
    }
}

impl Near for Fast {
    fn near(value: f64, size: f64, random: &mut Random) -> Fast {
        Fast(f64::near(value, size, random))
    }
}

impl<T: Near> Near for Dual<T> {
    fn near(value: f64, size: f64, random: &mut Random) -> Self {
        Dual {
            value: T::near(value, size, random),
            slope: T::near(0.0, size, random),
        }
    }
}

impl Near for DoubleDouble {
    fn near(value: f64, size: f64, random: &mut Random) -> Self {
        let rest = 1e-17 * size * random.next();
        DoubleDouble::new(f64::near(value, size, random), rest)
    }
}

/// How tests make scalars, and which bits they compare.
pub trait Of<T> {
    /// A scalar that differs from `value` by at most `size`.
    fn near(value: f64, size: f64, random: &mut Random) -> T;
    /// Its bits.
    fn bits(scalar: &T) -> Vec<u64>;
}

/// Scalars of one number.
pub struct Single;

impl<T: Near> Of<T> for Single {
    fn near(value: f64, size: f64, random: &mut Random) -> T {
        T::near(value, size, random)
    }

    fn bits(scalar: &T) -> Vec<u64> {
        scalar.bits()
    }
}

/// Scalars of several lanes, with another number in each.
pub struct InLanes;

impl<T: Several<One: Near>> Of<T> for InLanes {
    fn near(value: f64, size: f64, random: &mut Random) -> T {
        let zero = T::from_f64(0.0);
        (0..T::LANES).fold(zero, |lanes, lane| {
            lanes.with_lane(lane, T::One::near(value, size, random))
        })
    }

    fn bits(scalar: &T) -> Vec<u64> {
        let lanes = 0..T::LANES;
        lanes.flat_map(|lane| scalar.lane(lane).bits()).collect()
    }
}

/// Compares a bundled model over a scalar with its generated Rust.
pub fn check<M: Model<f64>, T: Real, O: Of<T>>(name: &str) {
    let engine = engine(name, true);
    let family = Compiled::<M>::new();
    let mut expected = family.over::<T>();
    compare::<T, O>(&mut *expected, &mut Engine::over::<T>(&engine));
    // starts again from the default parameters
    let mut expected = family.over::<T>();
    compare::<T, O>(&mut *expected, &mut engine.interpreted::<T>());
}
