//! Functions that similar elements share: the same operations in the same order as in one long function, so the same bits.

use bryant_runtime::real::lanes::{OfAnyWidth, with_one_lane};
use bryant_runtime::{Model, ParameterSet, Real, Section, Several, Task, Width};
use bryant_tests::trees::Random;
use std::marker::PhantomData;

macro_rules! module {
    ($module:ident, $file:literal) => {
        mod $module {
            include!(concat!(env!("OUT_DIR"), $file));
        }
    };
}

module!(rope, "/whole/rope.rs");
module!(rope_shared, "/shared/rope.rs");
module!(links, "/whole/links.rs");
module!(links_shared, "/shared/links.rs");
module!(chains, "/whole/chains.rs");
module!(chains_shared, "/shared/chains.rs");
module!(beads, "/whole/beads.rs");
module!(beads_shared, "/shared/beads.rs");

/// All results of two modules at a state, one after the other.
struct Everything<'a, M, S> {
    model: &'a M,
    y: &'a S,
}

impl<T: Real, M: Model<T>> Task for Everything<'_, (M, PhantomData<T>), M::State> {
    type Output = Vec<T>;

    #[inline(always)]
    fn run(self) -> Vec<T> {
        let (model, y) = (&self.model.0, self.y);
        let t = T::from_f64(0.13);
        let mut all = model.derivative(t, y).as_ref().to_vec();
        let mut add = |section, write: fn(&M, T, &M::State, &mut [T])| {
            let mut results = vec![T::from_f64(0.0); M::INFO.length(section)];
            write(model, t, y, &mut results);
            all.extend(results);
        };
        add(Section::Outputs, M::outputs);
        add(Section::Kinks, M::kinks);
        add(Section::Powers, M::powers);
        add(Section::Momentum, M::momentum);
        add(Section::KineticEnergy, M::kinetic_energy);
        let mut renewed = *y;
        model.renew(t, &mut renewed);
        all.extend_from_slice(renewed.as_ref());
        all
    }
}

/// A model over any scalar.
trait Scene {
    type Over<T: Real>: Model<T>;
}

macro_rules! scenes {
    ($($scene:ident: $module:ident,)*) => {$(
        struct $scene;
        impl Scene for $scene {
            type Over<T: Real> = $module::Mechanism<T>;
        }
    )*};
}

scenes! {
    Rope: rope,
    RopeShared: rope_shared,
    Links: links,
    LinksShared: links_shared,
    Chains: chains,
    ChainsShared: chains_shared,
    Beads: beads,
    BeadsShared: beads_shared,
}

/// Bits of all results at states around the start, with other parameters than the defaults.
fn bits<T: Several<One = f64>, S: Scene>() -> Vec<Vec<u64>> {
    let mut random = Random::new(3);
    let mut parameters = <S::Over<T> as Model<T>>::Parameters::defaults();
    assert!(parameters.set(0, T::from_f64(7.0)), "both have a parameter");
    let model = (<S::Over<T> as Model<T>>::new(parameters), PhantomData);
    let mut all = Vec::new();
    for _ in 0..20 {
        let mut y = model.0.initial_state();
        let moving = S::Over::<T>::INFO.coordinates.len() + S::Over::<T>::INFO.velocities.len();
        for i in 0..moving {
            y[i] += T::from_f64(random.uniform(-0.5, 0.5));
        }
        model.0.normalize(&mut y);
        let values = T::dispatch(Everything {
            model: &model,
            y: &y,
        });
        all.push(values.iter().map(|value| value.lane(0).to_bits()).collect());
    }
    all
}

/// A pair of modules of one model.
struct Pair<Whole, Shared>(PhantomData<(Whole, Shared)>);

impl<Whole: Scene, Shared: Scene> OfAnyWidth for Pair<Whole, Shared> {
    type Output = ();

    fn run<T: Several<One = f64>>(self) {
        assert_eq!(bits::<T, Whole>(), bits::<T, Shared>());
    }
}

fn compare<Whole: Scene, Shared: Scene>() {
    let done = with_one_lane(Pair::<Whole, Shared>(PhantomData));
    assert_eq!(done.is_some(), Width::One.there());
}

#[test]
fn like_elements_share_functions_and_nothing_changes() {
    compare::<Rope, RopeShared>();
    compare::<Links, LinksShared>();
    compare::<Chains, ChainsShared>();
    compare::<Beads, BeadsShared>();
}

/// The number of shared functions that a method calls, and the number of calls.
fn shared(text: &str, method: &str, type_of_task: &str) -> (usize, usize) {
    let functions = text.matches(&format!("    fn {method}_like_")).count();
    let calls = text
        .matches(&format!("T::dispatch_apart({type_of_task}LikeTask"))
        .count();
    (functions, calls)
}

#[test]
fn what_is_like_is_written_once() {
    let links = include_str!(concat!(env!("OUT_DIR"), "/shared/links.rs"));
    let rope = include_str!(concat!(env!("OUT_DIR"), "/shared/rope.rs"));
    let beads = include_str!(concat!(env!("OUT_DIR"), "/shared/beads.rs"));
    for (text, method, task) in [
        (links, "motion", "Motion"),
        (beads, "motion", "Motion"),
        (rope, "powers", "Powers"),
        (rope, "kinks", "Kinks"),
    ] {
        let (functions, calls) = shared(text, method, task);
        assert!(
            functions > 0 && calls >= 3 * functions,
            "{method}: {calls} calls of {functions}"
        );
    }
}

#[test]
fn what_is_made_of_inputs_is_not_kept_for_the_way_back() {
    let links = include_str!(concat!(env!("OUT_DIR"), "/shared/links.rs"));
    let function = |number: usize| {
        let of = links.split(&format!("fn motion_like_{number}(")).nth(1);
        of.and_then(|text| text.split("\n    }\n").next())
            .unwrap_or_default()
    };
    // the axes on the way down and on the way back, and q̇ where they are available
    for number in [1, 2] {
        assert!(function(number).contains("// axes along it"), "{number}");
    }
    assert!(!function(1).contains("// rate of orientation"));
    assert!(function(2).contains("// rate of orientation"));
    let returned = links.split("struct MotionLike1<T> {").nth(1);
    let returned = returned.and_then(|text| text.split('}').next());
    // 3 · 2 quotients that the pivots of two axes pass on, 1 between these, 2 forces, and a product of speeds
    let fields = returned.map(|fields| fields.matches(": T,").count());
    assert_eq!(fields, Some(10));
}

#[test]
fn accelerations_are_a_part_of_motion() {
    use links_shared::{COORDINATES, Mechanism, Parameters};
    let model = Mechanism::<f64>::new(Parameters::defaults());
    let mut random = Random::new(5);
    let mut y = model.initial_state();
    for entry in &mut y {
        *entry += random.uniform(-0.5, 0.5);
    }
    model.normalize(&mut y);
    let (t, rate) = (0.13, model.derivative(0.13, &y));
    let (Some(q), Some(v)) = (y.first_chunk(), y.last_chunk()) else {
        unreachable!("a state is as long as q and v together");
    };
    let (rates, accelerations) = rate.split_at(COORDINATES);
    assert_eq!(model.coordinate_rates_at(q, v), rates);
    assert_eq!(model.accelerations(t, q, v), accelerations);
}

#[test]
fn what_goes_from_call_to_call_stays_in_one_place() {
    let links = include_str!(concat!(env!("OUT_DIR"), "/shared/links.rs"));
    let chains = include_str!(concat!(env!("OUT_DIR"), "/shared/chains.rs"));
    let variables = |text: &str| {
        let runs = text.matches("let mut carried").count();
        (runs, text.contains(" = MotionCarried"))
    };
    assert!(variables(links).0 > 0 && variables(links).1);
    // one for each chain
    assert_eq!(variables(chains), (2, true));
    // results are written where they are computed: in the calls, and in the method
    let method = links
        .split("pub fn each_motion")
        .nth(1)
        .and_then(|text| text.split("\n    }\n").next());
    assert!(method.is_some_and(|method| method.contains("writer.put(0, ")));
    assert!(links.contains("writer.put(at, "));
}
