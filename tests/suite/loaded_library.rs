//! Code that is compiled as a library and loaded: user functions over every scalar, equal to the last bit to the
//! generated Rust; models compiled by rustc; and user functions that misbehave.
//!
//! Each test is a process of its own, because some of them end it.

use bryant::build_on_demand::{RustcModel, Text, Unit, UserForces};
use bryant_engine::{Engine, UserFunctions};
use bryant_generated::{elbow, skydiver};
use bryant_generator::Config;
use bryant_generator::law::ForceKind;
use bryant_generator::model::Model;
use bryant_runtime::real::Form;
use bryant_runtime::real::lanes::{OfAnyWidth, Several, with_width, with_width_of_singles};
use bryant_runtime::{
    Adjustable, Compiled, DoubleDouble, Dual, Dynamics, Family, Fast, Model as _, Real, Width,
};
use libtest_mimic::{Arguments, Failed, Trial};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

/// The argument for a process of this program that does one thing only; the name of the thing follows.
const ALONE: &str = "--alone";
const CALLS: usize = 50;

/// The work of such a process.
type Alone = fn();

/// Works that succeed.
const CHECKS: [(&str, Alone); 4] = [
    ("functions have the bits of generated Rust", the_same_bits),
    ("an engine calls them", an_engine_calls_them),
    ("a model that rustc compiled is the model", a_model_of_rustc),
    ("what is compiled is found again", found_again),
];

/// User functions that misbehave: the text in place of a result, the exit code, and expected words of the messages.
/// `functions.rs` has one that does not return.
const ENDS: [(&str, &str, Option<i32>, &[&str]); 7] = [
    (
        "exit",
        "std::process::exit(0)",
        Some(3),
        &["\"pulse\" (exit.rs)", "calls `exit`", "help: "],
    ),
    (
        "panic",
        "panic!(\"boom {}\", 1)",
        Some(5),
        &["\"pulse\" panicked: boom 1", "panic.rs:3:5"],
    ),
    (
        "abort",
        "std::process::abort()",
        Some(3),
        &["\"pulse\" (abort.rs)", "aborted the program", "help: "],
    ),
    (
        "endless",
        "#[allow(unconditional_recursion)] fn f(n: u64) -> u64 { f(std::hint::black_box(n) + 1) + 1 } f(0); Output::zero()",
        Some(3),
        &["\"pulse\" (endless.rs)", "calls itself without end"],
    ),
    (
        "print-nothing",
        "println!(); Output::zero()",
        Some(0),
        &["[user force]\n"],
    ),
    (
        "print",
        "println!(\"hello\"); Output::zero()",
        Some(0),
        &["[user force] hello\n"],
    ),
    (
        "mistake",
        "input.wrong; Output::zero()",
        Some(2),
        &["mistake.rs:3:11", "no field `wrong`"],
    ),
];

fn main() {
    let mut words = std::env::args().skip(1);
    if words.next().as_deref() == Some(ALONE) {
        return alone(&words.next().expect("a name"));
    }
    let check = |name: &'static str| {
        Trial::test(name, move || {
            let (code, said, _) = process(name)?;
            match code == Some(0) {
                true => Ok(()),
                false => Err(Failed::from(said)),
            }
        })
    };
    let end = |(name, _, expected, words): (&'static str, _, Option<i32>, &'static [&str])| {
        Trial::test(format!("a function that does this: {name}"), move || {
            let (code, said, printed) = process(name)?;
            let whole = words.iter().all(|word| said.contains(word));
            match code == expected && whole && printed.is_empty() {
                true => Ok(()),
                false => Err(Failed::from(format!("{code:?}\n{printed}\n{said}"))),
            }
        })
    };
    let trials = CHECKS.iter().map(|(name, _)| check(name));
    let trials = trials.chain(ENDS.into_iter().map(end)).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Does one thing in a process of its own; returns its exit code, standard error and standard output.
fn process(name: &str) -> Result<(Option<i32>, String, String), Failed> {
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("apart-cache");
    let output = Command::new(std::env::current_exe()?)
        .args([ALONE, name])
        .env("BRYANT_CACHE", cache)
        .output()?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ok((
        output.status.code(),
        text(&output.stderr),
        text(&output.stdout),
    ))
}

fn alone(name: &str) {
    if let Some((_, check)) = CHECKS.iter().find(|(of, _)| *of == name) {
        return check();
    }
    let end = ENDS.iter().find(|(of, ..)| *of == name);
    let (name, text, ..) = end.expect("a name");
    std::process::exit(ended(name, text));
}

/// A model with user functions, as read, and the files with the functions.
fn read(path: &Path) -> (Model, Vec<(String, String)>) {
    let model = bryant_generator::read_annotated(path)
        .expect("a model")
        .model;
    let mut sources = Vec::new();
    for force in &model.forces {
        if let ForceKind::User(user) = ForceKind::of(force)
            && let Some(source) = &user.function.source
        {
            sources.push((source.name.clone(), source.text.clone()));
        }
    }
    (model, sources)
}

fn bundled(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.yaml"))
}

fn forces(path: &Path) -> (Model, Arc<UserForces>) {
    let (model, sources) = read(path);
    let forces = UserForces::of(&model, sources, &mut |_| {}).expect("a library");
    (model, Arc::new(forces.expect("functions of the user's")))
}

/// The index of the only user force.
fn only(model: &Model) -> usize {
    let user = |force| matches!(ForceKind::of(force), ForceKind::User(_));
    model.forces.iter().position(user).expect("a user force")
}

/// Pseudo-random numbers between 0.1 and 1.1.
fn numbers(seed: usize) -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(2 * seed as u64 + 1);
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        0.1 + (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A generated function with A arguments and R results.
trait Generated<const A: usize, const R: usize> {
    fn call<T: Real>(arguments: [T; A]) -> [T; R];
}

struct Drag;

impl Generated<9, 2> for Drag {
    fn call<T: Real>(arguments: [T; 9]) -> [T; 2] {
        skydiver::drag::scalars(arguments)
    }
}

struct Muscle;

impl Generated<11, 2> for Muscle {
    fn call<T: Real>(arguments: [T; 11]) -> [T; 2] {
        elbow::muscle::scalars(arguments)
    }
}

struct Compare<'a, const A: usize, const R: usize> {
    functions: &'a Arc<dyn UserFunctions>,
    force: usize,
}

impl<const A: usize, const R: usize> Clone for Compare<'_, A, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<const A: usize, const R: usize> Copy for Compare<'_, A, R> {}

impl<const A: usize, const R: usize> Compare<'_, A, R> {
    /// Compares the results over one scalar, made from the words of each lane.
    fn over<T: Real, F: Generated<A, R>>(self) {
        let form = T::FORM.expect("a form");
        for seed in 0..CALLS {
            let mut next = numbers(seed);
            let arguments: [T; A] = std::array::from_fn(|_| scalar(form, &mut next));
            let expected = F::call(arguments);
            let mut results = [T::from_f64(f64::NAN); R];
            self.functions
                .call_over(self.force, &arguments, &mut results);
            assert_eq!(results, expected, "{form:?} of {arguments:?}");
            assert!(results.iter().all(|result| result.is_finite()));
        }
    }

    fn all<F: Generated<A, R>>(self) {
        self.with_slopes::<f64, F>();
        self.with_slopes::<f32, F>();
        self.with_slopes::<Fast, F>();
        self.with_slopes::<DoubleDouble, F>();
        for width in Width::ALL {
            let task = Lanes::<F, A, R>(self, std::marker::PhantomData);
            with_width(width, task);
            let task = Lanes::<F, A, R>(self, std::marker::PhantomData);
            with_width_of_singles(width, task);
        }
    }

    fn with_slopes<T: Real, F: Generated<A, R>>(self) {
        self.over::<T, F>();
        self.over::<Dual<T>, F>();
    }
}

struct Lanes<'a, F, const A: usize, const R: usize>(Compare<'a, A, R>, std::marker::PhantomData<F>);

impl<O: Real, F: Generated<A, R>, const A: usize, const R: usize> OfAnyWidth<O>
    for Lanes<'_, F, A, R>
{
    type Output = ();
    fn run<T: Several<One = O>>(self) {
        self.0.with_slopes::<T, F>();
    }
}

/// A scalar of any form, with different numbers in its words; the lower words of a double-double are small.
fn scalar<T: Real>(form: Form, next: &mut dyn FnMut() -> f64) -> T {
    let words = form.words();
    let mut all: Vec<f64> = (0..words * form.lanes)
        .map(|_| f64::from(next() as f32))
        .collect();
    if form.base == bryant_runtime::real::Base::DoubleDouble {
        for pair in all.chunks_exact_mut(2) {
            pair[1] *= 1e-17 * pair[0];
        }
    }
    T::of_words(words, &all)
}

fn the_same_bits() {
    let (model, functions) = forces(&bundled("skydiver"));
    let force = only(&model);
    let functions: Arc<dyn UserFunctions> = functions;
    let of_drag = Compare::<9, 2> {
        functions: &functions,
        force,
    };
    of_drag.all::<Drag>();
    let (model, functions) = forces(&bundled("elbow"));
    let force = only(&model);
    let functions: Arc<dyn UserFunctions> = functions;
    let of_muscle = Compare::<11, 2> {
        functions: &functions,
        force,
    };
    of_muscle.all::<Muscle>();
}

/// Compares every method of two models, at a few states and with two sets of parameters.
fn alike(ours: &mut dyn Adjustable<f64>, theirs: &mut dyn Adjustable<f64>, within: f64) {
    let info = ours.info();
    let parameters: Vec<f64> = info.parameters.iter().map(|p| p.default).collect();
    let mut y = vec![0.0; info.state_length()];
    let near = |a: &[f64], b: &[f64], what: &str| {
        let size = b.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= within * size, "{what}: {a} {b}");
        }
    };
    for factor in [1.0, 0.9] {
        let values: Vec<f64> = parameters.iter().map(|value| factor * value).collect();
        ours.set_parameters(&values);
        theirs.set_parameters(&values);
        for k in 0..parameters.len() + 1 {
            assert_eq!(ours.parameter(k), theirs.parameter(k));
        }
        let info = ours.info();
        ours.initial_state(&mut y);
        let mut other = vec![0.0; y.len()];
        theirs.initial_state(&mut other);
        near(&y, &other, "start");
        let mut next = numbers(3);
        for entry in &mut y {
            *entry += 0.3 * next();
        }
        let t = 0.2;
        type Evaluation = fn(&dyn Dynamics<f64>, f64, &[f64], &mut [f64]);
        let methods: [(&str, usize, Evaluation); 7] = [
            ("rate", y.len(), |m, t, y, out| m.derivative(t, y, out)),
            ("outputs", info.outputs.len(), |m, t, y, out| {
                m.outputs(t, y, out);
            }),
            (
                "event_functions",
                info.event_functions.len(),
                |m, t, y, out| {
                    m.event_functions(t, y, out);
                },
            ),
            ("kinks", info.kinks.len(), |m, t, y, out| m.kinks(t, y, out)),
            ("powers", info.powers.len(), |m, t, y, out| {
                m.powers(t, y, out);
            }),
            ("momentum", 6, |m, t, y, out| {
                out.copy_from_slice(&m.momentum(t, y));
            }),
            ("others", 3, |m, t, y, out| {
                let pivot = m
                    .smallest_pivot(t, y)
                    .map_or(-1.0, |(index, _)| index as f64);
                out.copy_from_slice(&[m.kinetic_energy(t, y), m.kink_after(t).min(1e9), pivot]);
            }),
        ];
        for (what, length, method) in methods {
            let [mut a, mut b] = [vec![0.0; length], vec![0.0; length]];
            method(ours, t, &y, &mut a);
            method(theirs, t, &y, &mut b);
            near(&a, &b, what);
        }
        let mut other = y.clone();
        let before = y.clone();
        ours.renewed(t, &before, &mut y);
        theirs.renewed(t, &before, &mut other);
        ours.normalize(&mut y);
        theirs.normalize(&mut other);
        near(&y, &other, "state");
        assert_eq!(ours.violated(), theirs.violated());
    }
}

fn an_engine_calls_them() {
    let (model, functions) = forces(&bundled("elbow"));
    let lists = Config::new().matrices(false).lists(&model);
    let engine = Engine::with_functions(lists, Some(functions)).expect("an engine");
    let compiled = Compiled::<elbow::Mechanism<f64>>::new();
    let mut theirs = compiled.over::<f64>();
    alike(&mut *Family::over(&engine), &mut *theirs, 0.0);
    let lists = Config::new().matrices(false).lists(&model);
    assert!(Engine::with_functions(lists, None).is_err());
}

fn rustc_model(name: &str) -> RustcModel<'static> {
    let path = bundled(name);
    let (model, sources) = read(&path);
    let texts: Vec<Text<'_>> = sources
        .iter()
        .map(|(name, text)| Text { name, text })
        .collect();
    let unit = Unit {
        name: &model.name,
        digest: &model.digest,
        texts: &texts,
    };
    let info = elbow::Mechanism::<f64>::INFO;
    let source = &mut || Config::new().matrices(false).source(&model);
    RustcModel::of(unit, info, true, source, &mut |_| {}).expect("a model")
}

/// Equal up to rounding: products and sums may be fused, and the muscle amplifies the errors of both by less than 10³.
fn a_model_of_rustc() {
    let model = rustc_model("elbow");
    let compiled = Compiled::<elbow::Mechanism<f64>>::new();
    let (mut ours, mut theirs) = (model.model(), compiled.over::<f64>());
    alike(&mut *ours, &mut *theirs, 1e3 * f64::EPSILON);
    let n = ours.info().state_length();
    let mut y = vec![0.0; n];
    ours.initial_state(&mut y);
    let (mut by_state, mut by_time) = (vec![0.0; n * n], vec![0.0; n]);
    assert!(ours.jacobian(0.0, &y, &mut by_state, &mut by_time));
    // the rate of an angle is a velocity
    assert_eq!(by_state[n / 2], 1.0, "{by_state:?}");
    assert_eq!(model.failure(), None);
}

fn found_again() {
    let (model, sources) = read(&bundled("skydiver"));
    let mut stages = 0;
    for _ in 0..2 {
        stages = 0;
        UserForces::of(&model, sources.clone(), &mut |_| stages += 1).expect("a library");
    }
    assert_eq!(stages, 0);
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let yaml = "model: none\ndimension: 2\nsystems:\n  - name: a\n    elements: [{ name: b, mass: 1, cg: [0, 0], inertia: 1 }]\n\
                run: { duration: 1, every: 1 }\n";
    let (model, _) = bryant_generator::read_str("none.yaml", yaml, &none).expect("a model");
    assert!(UserForces::of(&model, Vec::new(), &mut |_| {}).is_ok_and(|forces| forces.is_none()));
}

/// The result of a function with this text in place of a result.
fn ended(name: &str, text: &str) -> i32 {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("apart-{name}"));
    std::fs::create_dir_all(&directory).expect("a directory");
    let yaml = format!(
        "model: {name}
dimension: 2
systems:
  - name: ball
    elements: [{{ name: body, mass: 1, cg: [0, 0], inertia: 1 }}]
forces: [{{ user: pulse, function: pulse, source: {name}.rs, points: {{ p: {{ on: ball/body, at: cg }} }} }}]
run: {{ duration: 1 s, every: 10 ms }}
"
    );
    let function = format!(
        "pub fn pulse<T: Real>(input: &Input<T>) -> Output<T> {{\n    let _ = (input.points.p.position, input.time);\n    {text}\n}}\n"
    );
    let path = directory.join(format!("{name}.yaml"));
    std::fs::write(&path, yaml).expect("a file");
    std::fs::write(directory.join(format!("{name}.rs")), function).expect("a file");
    let (model, sources) = read(&path);
    let forces = match UserForces::of(&model, sources, &mut |_| {}) {
        Ok(forces) => forces.expect("a function"),
        Err(error) => {
            eprintln!("{error}");
            return 2;
        }
    };
    let form = <f64 as Real>::FORM.expect("a form");
    let mut results = [0.0; 2];
    forces.call(0, form, &[0.5; 5], &mut results);
    match forces.failure() {
        Some(failure) => {
            assert!(results.iter().all(|result| result.is_nan()));
            eprintln!("{failure}");
            5
        }
        None => 0,
    }
}
