//! The emitted Rust: the text for a reader, and its values.

mod interpret;
use bryant_generator::dynamics::derive;
use bryant_generator::equations::Equations;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::expression::{Function, NodeId};
use bryant_generator::model::{Coordinates, Model};
use bryant_generator::program::Options;
use bryant_generator::read;
use bryant_generator::read_str;
use bryant_generator::target::rust;
use interpret::{Module, Value};
use std::path::Path;

fn model(path: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    read(&path).expect("a valid model").0
}

/// Models with all parts that a module can have: parameters, laws, quaternions, Bryant angles, a large matrix.
fn models() -> Vec<Model> {
    let of = |path: &str, coordinates| Model {
        coordinates,
        ..model(path)
    };
    vec![
        model("models/sled-pendulum.yaml"),
        model("models/child-seat.yaml"),
        of("models/dummy15.yaml", Coordinates::Quaternion),
        of("models/dummy15.yaml", Coordinates::Bryant),
        parametric(),
    ]
}

/// A model in which every number is a parameter, with names that Rust does not allow or that the emitted text uses
/// itself.
fn parametric() -> Model {
    let text = "
model: parametric
dimension: 3
parameters: { num: 2, t1: 0.5, v: 0.1, gravity: 9.81, q: 0.3, parameters: 1, zero: 0.7 }
curves:
  info: { points: [[0, 0], [1, 2]] }
systems:
  - name: a
    elements:
      - { name: s, mass: num, cg: [0, 0, 0.5 * t1], inertia: [v, 2 * v, 1.5 * v] }
      - { name: t, on: s, at: [q, 0, t1], mass: 2 * num, cg: [0, 0.1 * t1, t1], inertia: [v, v, v] }
    start: { angles: { s: [0.1, q, 0.2] } }
  - name: b
    elements:
      - { name: s, mass: num + zero * parameters, cg: [0, 0, t1], inertia: [v, v, v] }
    start: { position: [t1, 0, 0] }
forces:
  - field: gravity
    acceleration: [0, info, -1 * gravity]
  - joint: a/t
    about: { y: { damping: 0.2 * num } }
  - contact: chest
    ellipsoid: { on: a/t, center: [0.1, 0, 0], semi_axes: [0.3, t1, 0.2], axes: [0.1, 0.2, 0.3], degree: 4 }
    plane: { on: b/s, at: [0, 0, -1], normal: [0, 0.1, 1] }
    elastic: { points: [[-10, 0], [10, 20]] }
  - contact: stones
    ellipsoid: { on: a/t, center: [0.1, 0, 0], semi_axes: [0.3, t1, 0.2], axes: [0.1, 0.2, 0.3] }
    with: { on: b/s, center: [0.1, 0, 0], semi_axes: [0.3, 0.1, 0.2] }
    elastic: { points: [[-10, 0], [10, 20]] }
outputs:
  - { name: num, of: a/t, what: acceleration }
  - { name: self, of: b/s, what: velocity, component: x }
  - { name: 1 + 1, of: a, what: kinetic_energy }
";
    let loader = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    read_str("parametric.yaml", text, &loader)
        .unwrap_or_else(|problems| panic!("{problems}"))
        .0
}

fn text(model: &Model, options: &Options) -> String {
    rust::module(model, &derive(model), options)
}

/// An arbitrary law that depends on all arguments and on its name, because the test checks only which law is called
/// with which arguments. Only a choice is real, because rotations are made with it.
fn law(name: &str, arguments: &[f64]) -> f64 {
    if let ("force::switch::choose", &[a, b, then, otherwise]) = (name, arguments) {
        return if a < b { then } else { otherwise };
    }
    let seed = name.bytes().fold(1.0, |seed: f64, byte| {
        (seed * 31.0 + f64::from(byte)) % 97.0
    });
    arguments.iter().enumerate().fold(seed, |sum, (i, x)| {
        sum + (i as f64 + 2.0) * (x / (1.0 + x * x))
    })
}

/// The same law for a call in the graph.
fn call(model: &Model, function: Function, arguments: &[f64]) -> f64 {
    let curve = |i: u32, method: &str| {
        let name = &model.curves[i as usize].name;
        let name: String = name
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        // The names of the size and of the table of the module are already used.
        let suffix = if name == "info" { "_2" } else { "" };
        format!("{}{suffix}.{method}", name.to_ascii_uppercase())
    };
    let name = match function {
        Function::Curve(i) => curve(i, "value"),
        Function::CurveSlope(i) => curve(i, "slope"),
        Function::CurveSecondDerivative(i) => curve(i, "second_derivative"),
        Function::CurveInverse(i) => curve(i, "inverse"),
        Function::CurveIntegral(i) => curve(i, "integral"),
        Function::CurveDoubleIntegral(i) => curve(i, "double_integral"),
        Function::CurveBreakpoints(i) => curve(i, "breakpoint_indicator"),
        Function::CurveStop(i) => curve(i, "stop"),
        Function::Choose => "force::switch::choose".into(),
        Function::Power => "force::power::power".into(),
        Function::User(_) => unreachable!("none of these models has a function of the user's"),
        Function::Approach(call) => format!("{} {}", call.path(), call.part),
        Function::Support(part) => format!("force::ellipsoid::support {part}"),
    };
    law(&name, arguments)
}

/// A state without any symmetry; quaternions of length 1; every other element in the second chart.
fn state(equations: &Equations) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let wave = |i: usize| (1.0 + 1.7 * i as f64).sin();
    let mut q: Vec<f64> = (0..equations.coordinates.len()).map(wave).collect();
    for quaternion in &equations.quaternions {
        let length = q[quaternion.clone()]
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt();
        q[quaternion.clone()].iter_mut().for_each(|x| *x /= length);
    }
    (
        q,
        (0..equations.velocities.len())
            .map(|i| wave(i + 7))
            .collect(),
        (0..equations.charts).map(|i| (i % 2) as f64).collect(),
    )
}

/// The results of each method of a module.
fn values(model: &Model, equations: &Equations, text: &str) -> Vec<(&'static str, Vec<f64>)> {
    let module = Module::new(text, &law);
    let names = model
        .parameters
        .iter()
        .map(|parameter| parameter.name.clone());
    let defaults = model
        .parameters
        .iter()
        .map(|parameter| Value::Number(parameter.default));
    let parameters = Value::Struct(names.zip(defaults).collect());
    let mechanism = module.call("new", &[parameters]);
    let (q, v, m) = state(equations);
    let (t, q, v, m) = (
        Value::Number(0.03),
        Value::numbers(&q),
        Value::numbers(&v),
        Value::numbers(&m),
    );
    let charted = equations.charts > 0;
    let plain = |name: &str, arguments: &[&Value]| {
        let arguments: Vec<Value> = std::iter::once(&mechanism)
            .chain(arguments.iter().copied())
            .cloned()
            .collect();
        module.call(name, &arguments)
    };
    // methods that depend on orientation get the charts
    let call = |name: &str, arguments: &[&Value]| {
        plain(name, &[arguments, &[&m][..usize::from(charted)]].concat())
    };
    let entries = match call("mass_matrix", &[&q]) {
        Value::Struct(entries) => {
            let n = equations.velocities.len();
            let entry = |i, j| entries.get(&format!("{i},{j}")).map_or(0.0, Value::number);
            (0..n * n).map(|k| entry(k / n, k % n)).collect()
        }
        rows => rows.flat(),
    };
    vec![
        (
            "initial_conditions",
            plain("initial_conditions", &[]).flat(),
        ),
        ("mass_matrix", entries),
        ("velocity_forces", call("velocity_forces", &[&q, &v]).flat()),
        (
            "applied_forces",
            call("applied_forces", &[&t, &q, &v]).flat(),
        ),
        ("accelerations", call("accelerations", &[&t, &q, &v]).flat()),
        (
            "coordinate_rates",
            plain("coordinate_rates_at", &[&q, &v]).flat(),
        ),
        ("outputs", call("outputs_at", &[&t, &q, &v]).flat()),
        (
            "renewed",
            match charted {
                true => call("renewed", &[&t, &q, &v]).flat(),
                false => Vec::new(),
            },
        ),
    ]
}

#[test]
fn a_pendulum_with_a_belt_reads_as_if_written_by_hand() {
    let text = text(&model("models/sled-pendulum.yaml"), &Options::default());
    insta::assert_snapshot!("sled_pendulum", text);
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    for model in models() {
        let options = Options::default();
        assert!(
            text(&model, &options) == text(&model, &options),
            "{}",
            model.name
        );
    }
}

#[test]
fn the_text_evaluates_to_what_the_graph_means() {
    for model in models() {
        let equations = derive(&model);
        let (q, v, m) = state(&equations);
        let parameters: Vec<f64> = model
            .parameters
            .iter()
            .map(|parameter| parameter.default)
            .collect();
        let inputs = Inputs {
            time: 0.03,
            coordinates: &q,
            velocities: &v,
            parameters: &parameters,
            auxiliaries: &[],
            memory: &m,
            accelerations: &[],
        };
        let expected = |roots: &[NodeId]| {
            let functions =
                |function: Function, arguments: &[f64]| call(&model, function, arguments);
            evaluate(&equations.graph, roots, &inputs, &functions)
        };
        let start = [
            &equations.initial_coordinates[..],
            &equations.initial_velocities,
        ]
        .concat();
        let next: Vec<NodeId> = equations.memory.iter().map(|state| state.next).collect();
        let renewed = [
            &equations.renewed_coordinates[..],
            &equations.renewed_velocities,
            &next,
        ]
        .concat();
        let expected = [
            expected(&start),
            expected(&equations.mass_matrix.concat()),
            expected(&equations.velocity_forces),
            expected(&equations.applied_forces),
            expected(&equations.accelerations),
            expected(&equations.coordinate_rates),
            expected(&equations.outputs),
            match equations.charts {
                0 => Vec::new(),
                _ => expected(&renewed),
            },
        ];
        let values = values(
            &model,
            &equations,
            &rust::module(&model, &equations, &Options::default()),
        );
        for ((method, values), expected) in values.iter().zip(&expected) {
            assert_eq!(values.len(), expected.len(), "{} {method}", model.name);
            // Both round thousands of operations differently; a condition of S of 10⁴ loses four more digits.
            let scale = expected
                .iter()
                .fold(1.0, |scale: f64, x| scale.max(x.abs()));
            for (value, expected) in values.iter().zip(expected) {
                let close = (value - expected).abs() <= 1e-9 * scale;
                assert!(
                    close,
                    "{} {method}: {value} instead of {expected}",
                    model.name
                );
            }
        }
    }
}

#[test]
fn pieces_give_the_bits_of_the_whole() {
    for model in models() {
        let equations = derive(&model);
        let with = |statements| {
            rust::module(
                &model,
                &equations,
                &Options {
                    statements,
                    ..Options::default()
                },
            )
        };
        let (whole, pieces) = (with(usize::MAX), with(40));
        assert!(Module::new(&pieces, &law).methods() > Module::new(&whole, &law).methods());
        assert!(
            values(&model, &equations, &whole) == values(&model, &equations, &pieces),
            "{}",
            model.name
        );
    }
}

#[test]
fn no_function_is_longer_than_the_compiler_bears() {
    for model in models() {
        let equations = derive(&model);
        let laws = equations.auxiliaries.len() + equations.memory.len();
        let inputs = equations.coordinates.len() + equations.velocities.len() + laws;
        for statements in [200, 900] {
            let options = Options {
                statements,
                ..Options::default()
            };
            let text = text(&model, &options);
            // Besides the statements: inputs, each read at most once, `num`, the slices that are read, the results.
            let allowed = statements + inputs + 40;
            let large_matrix = 2 * 51 * 51;
            let longest = Module::new(&text, &law).longest();
            assert!(
                longest <= allowed + large_matrix,
                "{}: {longest}",
                model.name
            );
            let lets = text
                .split("\n    }\n")
                .map(|method| method.matches("\n        let ").count());
            assert!(lets.max() <= Some(allowed), "{}", model.name);
        }
    }
}

#[test]
fn only_very_long_methods_are_compiled_in_calls() {
    let options = |merged| Options {
        matrices: false,
        merged,
        ..Options::default()
    };
    let calls = |path, merged| {
        let text = text(&model(path), &options(merged));
        let of = |method, task| text.contains(&format!("T::dispatch_apart({method}{task}1 {{"));
        of("Motion", "Task")
    };
    let always = Options::default().merged;
    assert!(!calls("models/dummy15.yaml", always));
    assert!(calls("models/dummy15.yaml", 1000));
    assert!(calls("tests/models/large/chain100.yaml", always));
}

#[test]
fn without_matrices_there_is_no_nalgebra() {
    for model in models() {
        let options = Options {
            matrices: false,
            ..Options::default()
        };
        let text = text(&model, &options);
        assert!(
            !text.contains("SMatrix") && !text.contains("SVector") && !text.contains("nalgebra")
        );
    }
}

/// The constants of a module of constants, in their order.
fn constants(text: &str, module: &str) -> Vec<(String, String)> {
    let Some((_, rest)) = text.split_once(&format!("\npub mod {module} {{\n")) else {
        return Vec::new();
    };
    let (body, _) = rest.split_once("\n}\n").expect("its end");
    let constants = body.lines().filter_map(|line| {
        let line = line.trim().strip_prefix("pub const ")?;
        let (name, index) = line.strip_suffix(';')?.split_once(": usize = ")?;
        Some((name.to_owned(), index.to_owned()))
    });
    constants.collect()
}

#[test]
fn every_place_has_a_name_of_its_own() {
    for model in models() {
        let text = text(&model, &Options::default());
        let equations = derive(&model);
        for (module, length) in [
            ("coordinates", equations.coordinates.len()),
            ("velocities", equations.velocities.len()),
            ("outputs", equations.outputs.len()),
            ("parameters", model.parameters.len()),
        ] {
            let found = constants(&text, module);
            let indices: Vec<String> = found.iter().map(|(_, index)| index.clone()).collect();
            let expected: Vec<String> = (0..length).map(|index| index.to_string()).collect();
            assert_eq!(indices, expected, "{module} of {}", model.name);
            let names: std::collections::BTreeSet<_> = found.iter().map(|(name, _)| name).collect();
            assert_eq!(names.len(), length, "{module} of {}", model.name);
        }
    }
    let text = text(&parametric(), &Options::default());
    let names = |module| -> Vec<String> {
        let found = constants(&text, module).into_iter();
        found.map(|(name, _)| name).collect()
    };
    assert_eq!(names("outputs"), ["NUM", "SELF", "N1_1"]);
    assert_eq!(
        names("parameters"),
        ["NUM", "T1", "V", "GRAVITY", "Q", "PARAMETERS", "ZERO"]
    );
}

/// The whole state is one argument, so that its parts do not change signatures: models with memory (Bryant angles) and
/// without.
#[test]
fn accelerations_of_a_state_have_one_signature() {
    for model in models() {
        let text = text(&model, &Options::default());
        let signature = "pub fn accelerations_of(&self, t: T, y: &[T; STATE]) -> [T; VELOCITIES] {";
        let (_, body) = text.split_once(signature).expect("the method");
        let (body, _) = body.split_once("\n    }\n").expect("its end");
        let charts = derive(&model).charts > 0;
        let call = if charts {
            "self.accelerations(t, q, v, m)"
        } else {
            "self.accelerations(t, q, v)"
        };
        assert!(body.contains(call), "{}: {body}", model.name);
    }
}

#[test]
fn no_method_hides_one_of_the_trait() {
    let hidden = [
        "coordinate_rates",
        "curves",
        "event_functions",
        "kinetic_energy",
        "kinks",
        "momentum",
        "onsets",
        "outputs",
        "powers",
        "external_wrench",
        "derivative",
        "each_rate",
        "normalize",
        "renew",
        "smallest_pivot",
        "violated",
        "initial_state",
        "parameters",
    ];
    for model in models() {
        let text = text(&model, &Options::default());
        for name in hidden {
            assert!(!text.contains(&format!("    pub fn {name}(")), "{name}");
        }
    }
}

#[test]
fn the_text_names_no_date_and_no_place() {
    for model in models() {
        let text = text(&model, &Options::default());
        assert!(!text.contains(env!("CARGO_MANIFEST_DIR")) && !text.contains('\r'));
        assert!(text.starts_with("// @generated by bryant-generator"));
    }
}

/// The module for the examples of the runtime's front page: `INSTA_UPDATE=always` writes it again.
#[test]
fn the_examples_of_the_runtime_use_what_is_written_now() {
    let text = text(
        &model("examples/own-crate/double-pendulum.yaml"),
        &Options::default(),
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/doc/double-pendulum.rs");
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(&path, &text).expect("written");
    }
    let kept = std::fs::read_to_string(&path).expect("the module");
    assert!(
        kept == text,
        "INSTA_UPDATE=always renews {}",
        path.display()
    );
}
