//! The C99 text of every model, compared with the engine to the last bit, at many states, with and without fused
//! multiply-adds.
//!
//! Each model becomes a program that reads states and writes the results of all methods as raw doubles.

use crate::share::share;
use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_generator::program::{Lists, Method};
use bryant_generator::target::c::Source;
use bryant_runtime::real::lanes::{MOST_LANES, OfAnyWidth, Several, with_width};
use bryant_runtime::{Dynamics, Real, Section, Width};
use std::fmt::Write as _;
use std::io::Write as _;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A generator of pseudo-random numbers between −1 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// The inputs of one evaluation of a model.
struct Case {
    parameters: Vec<f64>,
    t: f64,
    state: Vec<f64>,
}

const CASES: usize = 24;

/// States at the start of a run, near it and far from it, with parameters near their defaults; and one state of NaN.
fn cases(engine: &Engine) -> Vec<Case> {
    let info = engine.info();
    let mut random = Random(info.name.bytes().map(u64::from).sum::<u64>() * 2 + 1);
    let machine = engine.over::<f64>();
    let mut start = vec![0.0; info.state_length()];
    machine.initial_state(&mut start);
    let case = |k: usize| {
        let parameters = info.parameters.iter().map(|parameter| {
            let value = parameter.default * (1.0 + 0.1 * random.next());
            match k % 2 {
                0 => parameter.default,
                _ => value.clamp(parameter.min, parameter.max),
            }
        });
        let parameters = parameters.collect();
        let far = [0.01, 0.3, 3.0][k % 3];
        let entries = start.iter().enumerate().map(|(i, entry)| match i {
            // charts and switches are 0 or 1 or a time
            i if i >= info.varying_length() => *entry,
            _ => entry + far * random.next(),
        });
        let mut state: Vec<f64> = entries.collect();
        if k == CASES - 1 {
            state[0] = f64::NAN;
        } else {
            machine.normalize(&mut state);
        }
        let t = (1.1 * random.next()).abs() * info.duration;
        Case {
            parameters,
            t,
            state,
        }
    };
    (0..CASES).map(case).collect()
}

/// The methods whose results a program prints, in order, and the number of results of each.
fn printed(lists: &Lists) -> Vec<(&'static str, Method, usize)> {
    let facts = &lists.facts;
    let state = facts.kinds.len();
    let all = [
        ("derivative", Method::Derivative, state),
        ("outputs", Method::Outputs, facts.outputs.len()),
        (
            "event_functions",
            Method::EventFunctions,
            facts.event_functions.len(),
        ),
        ("kinks", Method::Kinks, facts.kinks.len()),
        ("onsets", Method::Onsets, 2 * facts.onsets.len()),
        ("curves", Method::Curves, facts.curves.len()),
        ("powers", Method::Powers, facts.powers.len()),
        ("momentum", Method::Momentum, 6),
        ("external_wrench", Method::ExternalWrench, 6),
    ];
    let there = |(_, method, _): &(&str, Method, usize)| !lists.list(*method).results.is_empty();
    all.into_iter().filter(there).collect()
}

/// The text of a program that evaluates a model.
fn program(source: &Source, lists: &Lists) -> String {
    let (name, upper) = (&source.name, source.name.to_ascii_uppercase());
    let facts = &lists.facts;
    let (parameters, state) = (facts.parameters.len(), facts.kinds.len());
    let mut text = format!(
        "#include \"{name}.h\"\n#include <stdio.h>\n
static void put(const double *values, size_t count) {{ fwrite(values, sizeof(double), count, stdout); }}
int main(void)
{{
    double given[{parameters} + 1 + {state}], y[{state}], result[4096];
    {name}_model model;
    while (fread(given, sizeof(double), {upper}_PARAMETERS + 1 + {upper}_STATE, stdin) == {upper}_PARAMETERS + 1 + {upper}_STATE) {{
        const double t = given[{parameters}], *const at = given + {parameters} + 1;
        int i;
        {name}_new(&model, given);
        {name}_initial_state(&model, y);
        put(y, {state});
"
    );
    for (method, _, count) in printed(lists) {
        let _ = write!(
            text,
            "        {name}_{method}(&model, t, at, result);\n        put(result, {count});\n"
        );
    }
    if !lists.list(Method::CoordinateRates).results.is_empty() {
        let count = facts.coordinates.len();
        let _ = write!(
            text,
            "        {name}_coordinate_rates(&model, at, result);\n        put(result, {count});\n"
        );
    }
    let numbers = [
        (
            Method::KineticEnergy,
            format!("{name}_kinetic_energy(&model, t, at)"),
        ),
        (Method::Conditions, format!("{name}_violated(&model)")),
        (
            Method::Pivots,
            format!("{name}_smallest_pivot(&model, t, at, result + 1)"),
        ),
    ];
    for (method, call) in numbers {
        if !lists.list(method).results.is_empty() {
            let count = 1 + usize::from(method == Method::Pivots);
            let _ = write!(
                text,
                "        result[0] = {call};\n        put(result, {count});\n"
            );
        }
    }
    if !lists.list(Method::Renewed).results.is_empty() {
        let _ = write!(
            text,
            "        for (i = 0; i < {state}; i++) result[i] = at[i];\n        {name}_renew(&model, t, result);\n        put(result, {state});\n"
        );
    }
    let _ = write!(
        text,
        "        for (i = 0; i < {state}; i++) result[i] = 2.0 * at[i];\n        {name}_normalize(result);\n        put(result, {state});\n        \
         result[0] = {name}_kink_after(&model, t);\n        put(result, 1);\n    }}\n    return 0;\n}}\n"
    );
    text
}

/// The same results by the engine, over a scalar of one lane.
struct ByEngine<'a> {
    engine: &'a Engine,
    cases: &'a [Case],
}

impl ByEngine<'_> {
    fn over<T: Real>(&self) -> Vec<f64> {
        let mut values = Vec::new();
        for case in self.cases {
            values.extend(self.of_case::<T>(case));
        }
        values
    }

    fn of_case<T: Real>(&self, case: &Case) -> Vec<f64> {
        use bryant_runtime::Adjustable as _;
        let (info, lists) = (self.engine.info(), self.engine.lists());
        let number = |values: &[f64]| values.iter().map(|v| T::from_f64(*v)).collect::<Vec<T>>();
        let zeros = |count: usize| vec![T::from_f64(0.0); count];
        let mut model = self.engine.over::<T>();
        model.set_parameters(&number(&case.parameters));
        let (t, y) = (T::from_f64(case.t), number(&case.state));
        let mut all = zeros(y.len());
        model.initial_state(&mut all);
        let sections = Section::ALL.iter().copied();
        for (_, method, count) in printed(lists) {
            let mut results = zeros(count);
            match sections.clone().find(|of| of.name() == method.name()) {
                Some(section) => model.section(section, t, &y, &mut results),
                None => model.derivative(t, &y, &mut results),
            }
            all.extend(results);
        }
        if !lists.list(Method::CoordinateRates).results.is_empty() {
            let mut results = zeros(y.len());
            model.coordinate_rates(&y, &mut results);
            all.extend(&results[..info.coordinates.len()]);
        }
        if !lists.list(Method::KineticEnergy).results.is_empty() {
            all.push(model.kinetic_energy(t, &y));
        }
        if !lists.list(Method::Conditions).results.is_empty() {
            all.push(T::from_f64(
                model.violated().map_or(-1.0, |index| index as f64),
            ));
        }
        if !lists.list(Method::Pivots).results.is_empty() {
            let (index, share) = model.smallest_pivot(t, &y).expect("there are pivots");
            all.extend([T::from_f64(index as f64), share]);
        }
        if !lists.list(Method::Renewed).results.is_empty() {
            let mut state = y.clone();
            model.renewed(t, &y, &mut state);
            all.extend(state);
        }
        let mut state: Vec<T> = y.iter().map(|entry| T::from_f64(2.0) * *entry).collect();
        model.normalize(&mut state);
        all.extend(state);
        let fixed = info.breakpoints.iter().copied().find(|kink| *kink > case.t);
        let stretched = model.kink_after(case.t).to_f64();
        all.push(T::from_f64(stretched.min(fixed.unwrap_or(f64::INFINITY))));
        all.iter().map(|value| value.to_f64()).collect()
    }
}

/// A double whose products and sums are rounded once, whatever target this test is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Fused(f64);

/// The elementary functions in lanes with fused multiply-adds, as tasks.
enum Elementary {
    SinCos(f64),
    Atan2(f64, f64),
    Power(f64, f64),
}

impl OfAnyWidth<f64> for Elementary {
    type Output = [f64; 2];
    fn run<T: Several<One = f64>>(self) -> [f64; 2] {
        let of = |x: f64| T::of_lanes(&[x; MOST_LANES]);
        let (first, second) = match self {
            Elementary::SinCos(x) => of(x).sin_cos(),
            Elementary::Atan2(y, x) => (of(y).atan2(of(x)), of(0.0)),
            Elementary::Power(x, power) => (of(x).powf(of(power)), of(0.0)),
        };
        [first.lane(0), second.lane(0)]
    }
}

impl Elementary {
    fn fused(self) -> [Fused; 2] {
        let found = with_width(Width::One, self).expect("a processor that fuses");
        found.map(Fused)
    }
}

macro_rules! operators {
    ($($operator:ident $function:ident),*) => {
        $(impl $operator for Fused {
            type Output = Fused;
            fn $function(self, other: Fused) -> Fused {
                Fused(self.0.$function(other.0))
            }
        })*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Fused {
    type Output = Fused;
    fn neg(self) -> Fused {
        Fused(-self.0)
    }
}

impl AddAssign for Fused {
    fn add_assign(&mut self, other: Fused) {
        self.0 += other.0;
    }
}

impl Real for Fused {
    type Mask = bool;
    type Value = Self;

    #[inline(always)]
    fn value(self) -> Self {
        self
    }

    #[inline(always)]
    fn of_value(value: Self) -> Self {
        value
    }

    fn from_f64(value: f64) -> Self {
        Fused(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        Fused(f64::mul_add(self.0, a.0, b.0))
    }
    fn sqrt(self) -> Self {
        Fused(self.0.sqrt())
    }
    fn sin_cos(self) -> (Self, Self) {
        Elementary::SinCos(self.0).fused().into()
    }
    fn atan2(self, x: Self) -> Self {
        Elementary::Atan2(self.0, x.0).fused()[0]
    }
    fn powf(self, power: Self) -> Self {
        Elementary::Power(self.0, power.0).fused()[0]
    }
    fn abs(self) -> Self {
        Fused(self.0.abs())
    }
    fn lt(self, other: Self) -> bool {
        self.0 < other.0
    }
    fn select(mask: bool, then: Self, otherwise: Self) -> Self {
        if mask { then } else { otherwise }
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

/// Compiles a program and a model in a directory.
fn compile(directory: &Path, name: &str, options: &[&str]) -> PathBuf {
    let binary = directory.join("program");
    let compiled = Command::new("cc")
        .args([
            "-std=c99",
            "-pedantic",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-O1",
        ])
        .args(options)
        .args([&format!("{name}.c"), "program.c", "-lm", "-o"])
        .arg(&binary)
        .current_dir(directory)
        .output()
        .expect("a C compiler, which Rust needs, too");
    let messages = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{name}: {messages}");
    binary
}

/// The results of a program for these cases.
fn by_c(directory: &Path, name: &str, options: &[&str], cases: &[Case]) -> Vec<f64> {
    let binary = compile(directory, name, options);
    let mut child = Command::new(&binary)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut given = Vec::new();
    for case in cases {
        let numbers = case.parameters.iter().chain([&case.t]).chain(&case.state);
        given.extend(numbers.flat_map(|number| number.to_ne_bytes()));
    }
    let mut input = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || input.write_all(&given));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    assert!(output.status.success(), "{name}");
    let numbers = output.stdout.as_chunks::<8>().0;
    numbers
        .iter()
        .map(|bytes| f64::from_ne_bytes(*bytes))
        .collect()
}

fn compare(name: &str, how: &str, ours: &[f64], expected: &[f64]) {
    assert_eq!(ours.len(), expected.len(), "{name} {how}");
    let bits = |value: f64| {
        if value.is_nan() {
            u64::MAX
        } else {
            value.to_bits()
        }
    };
    let per_case = ours.len() / CASES;
    for (k, (a, b)) in ours.iter().zip(expected).enumerate() {
        let (case, place) = (k / per_case, k % per_case);
        assert!(
            bits(*a) == bits(*b),
            "{name} {how}, case {case}, result {place}: {a:e} in C, {b:e} by the engine"
        );
    }
}

fn models() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for directory in ["models", "tests/models", "tests/models/large"] {
        let entries = std::fs::read_dir(root.join(directory)).unwrap();
        let paths = entries.map(|entry| entry.unwrap().path());
        found.extend(paths.filter(|path| path.extension().is_some_and(|e| e == "yaml")));
    }
    found.sort();
    found
}

/// Compares one in eight of every second model, beginning with this one: most of the time goes into compiling.
fn compare_models(first: usize) {
    let fuses = is_fused();
    let models = models();
    assert!(models.len() > 50, "{models:?}");
    for path in share(8, models.into_iter().skip(first).step_by(2)) {
        let (model, _) =
            bryant_generator::read(&path).unwrap_or_else(|problems| panic!("{problems}"));
        let mut config = Config::new();
        // S of a chain of a hundred elements takes ten million operations
        config.matrices(!path.to_string_lossy().contains("large"));
        let source = match config.c_source(&model) {
            Ok(source) => source,
            Err(none) => {
                assert!(!none.functions.is_empty());
                continue;
            }
        };
        let engine = Engine::new(config.lists(&model)).expect("no functions of the user's");
        let cases = cases(&engine);
        let directory = tempfile::tempdir().unwrap();
        let name = &source.name;
        let write = |file: String, text: &str| std::fs::write(directory.path().join(file), text);
        write(format!("{name}.h"), &source.header).unwrap();
        write(format!("{name}.c"), &source.source).unwrap();
        write("program.c".to_owned(), &program(&source, engine.lists())).unwrap();
        let by_engine = ByEngine {
            engine: &engine,
            cases: &cases,
        };
        // bundled models are optimised as users compile them; for the others, most of the time goes into compiling
        let bundled = path
            .parent()
            .is_some_and(|folder| folder.ends_with("../models"));
        let options: &[&str] = if bundled { &[] } else { &["-O0"] };
        let plain = by_c(directory.path(), name, options, &cases);
        compare(name, "unfused", &plain, &by_engine.over::<f64>());
        if fuses {
            // with optimisation, GCC gives −(a·b + c) the sign of −a·b − c where the result is 0
            let fused = by_c(
                directory.path(),
                name,
                &["-mfma", "-DBRYANT_FUSED", "-O0"],
                &cases,
            );
            compare(name, "fused", &fused, &by_engine.over::<Fused>());
        }
    }
}

#[test]
fn c_has_the_bits_of_the_engine() {
    compare_models(0);
}

#[test]
fn c_of_the_other_models_has_the_bits_of_the_engine() {
    compare_models(1);
}

/// S by rows, r_s and r_k of a bundled model, as in the Rust text.
macro_rules! matrices {
    ($module:ident) => {
        |case: &Case| {
            use bryant_generated::$module::{COORDINATES, Mechanism, VELOCITIES};
            let mechanism = Mechanism::<f64>::new(Default::default());
            let (q, rest) = case.state.split_first_chunk::<COORDINATES>().unwrap();
            let v = rest.first_chunk::<VELOCITIES>().unwrap();
            let mut values = mechanism.mass_matrix(q).as_slice().to_vec();
            values.extend(mechanism.velocity_forces(q, v).as_slice());
            values.extend(mechanism.applied_forces(case.t, q, v).as_slice());
            values
        }
    };
}

#[test]
fn matrices_in_c_are_those_of_the_rust_text() {
    type Expected = fn(&Case) -> Vec<f64>;
    let models: [(&str, Expected); 3] = [
        ("sled-pendulum", matrices!(sled_pendulum)),
        ("robot-arm", matrices!(robot_arm)),
        ("dummy15", matrices!(dummy15)),
    ];
    for (file, expected) in models {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{file}.yaml"));
        let (model, _) =
            bryant_generator::read(&path).unwrap_or_else(|problems| panic!("{problems}"));
        let source = Config::new().c_source(&model).unwrap();
        let engine = Engine::new(Config::new().lists(&model)).unwrap();
        let mut cases = cases(&engine);
        for case in &mut cases {
            case.parameters = engine.info().parameters.iter().map(|p| p.default).collect();
        }
        let (n, state) = (engine.info().velocities.len(), engine.info().state_length());
        let (name, given) = (&source.name, engine.info().parameters.len() + 1 + state);
        let program = format!(
            "#include \"{name}.h\"\n#include <stdio.h>\nint main(void)\n{{\n    double given[{given}], result[{n} * {n} + 2 * {n}];\n    \
             {name}_model model;\n    while (fread(given, 8, {given}, stdin) == {given}) {{\n        \
             const double *const t = given + {given} - 1 - {state};\n        {name}_new(&model, NULL);\n        \
             {name}_mass_matrix(&model, *t, t + 1, result);\n        \
             {name}_velocity_forces(&model, *t, t + 1, result + {n} * {n});\n        \
             {name}_applied_forces(&model, *t, t + 1, result + {n} * {n} + {n});\n        \
             fwrite(result, 8, {n} * {n} + 2 * {n}, stdout);\n    }}\n    return 0;\n}}\n"
        );
        let directory = tempfile::tempdir().unwrap();
        let write = |file: String, text: &str| std::fs::write(directory.path().join(file), text);
        write(format!("{name}.h"), &source.header).unwrap();
        write(format!("{name}.c"), &source.source).unwrap();
        write("program.c".to_owned(), &program).unwrap();
        let ours = by_c(directory.path(), name, &[], &cases);
        let expected: Vec<f64> = cases.iter().flat_map(expected).collect();
        compare(name, "matrices", &ours, &expected);
    }
}

/// The program of `docs/c.md` compiles, and its result agrees with that of ten times as many steps.
#[test]
fn the_program_of_the_page_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = std::fs::read_to_string(root.join("docs/c.md")).unwrap();
    let program = page
        .split("```c\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    let program = program.expect("a program on the page");
    let (model, _) = bryant_generator::read(&root.join("models/sled-pendulum.yaml")).unwrap();
    let source = Config::new().c_source(&model).unwrap();
    let run = |program: &str| {
        let directory = tempfile::tempdir().unwrap();
        let write = |file: &str, text: &str| std::fs::write(directory.path().join(file), text);
        write("sled_pendulum.h", &source.header).unwrap();
        write("sled_pendulum.c", &source.source).unwrap();
        write("program.c", program).unwrap();
        compile(directory.path(), "sled_pendulum", &["-O2"]);
        let output = Command::new(directory.path().join("program"))
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let values = text.lines().map(|line| {
            let value = line.split(": ").nth(1).unwrap().split(' ').next().unwrap();
            value.parse().unwrap()
        });
        values.collect::<Vec<f64>>()
    };
    let ours = run(program);
    let finer = run(&program.replace("steps = 10000", "steps = 100000"));
    assert_eq!(ours.len(), model.outputs.len());
    for (ours, finer) in ours.iter().zip(&finer) {
        // the step of 1e-4 of the run that crosses a point of the pulse has an error of some squares of its length
        let scale = finer.abs().max(1e-3);
        assert!((ours - finer).abs() <= 1e-5 * scale, "{ours} {finer}");
    }
}

#[test]
fn a_force_in_rust_has_no_c() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/skydiver.yaml");
    let (model, _) = bryant_generator::read(&path).unwrap_or_else(|problems| panic!("{problems}"));
    let none = Config::new().c_source(&model).unwrap_err();
    assert_eq!(none.functions, ["drag"]);
}

/// Whether the processor has fused multiply-adds and the compiler accepts `-mfma`.
fn is_fused() -> bool {
    #[cfg(target_arch = "x86_64")]
    return is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    false
}
