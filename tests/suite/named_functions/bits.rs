//! The same bits from the interpreter, from machine code, from Rust and from C.

use super::{all, engine};
use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::{Adjustable, Dual, Dynamics, Real};
use bryant_tests::trees::Random;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

mod machine {
    bryant_runtime::include_model!("machine");
}

/// The functions that `build.rs` asks for.
const FRAME: &str = "arm/tip";

fn asked() -> Vec<String> {
    all(&[FRAME.to_owned()])
}

fn model() -> bryant_generator::model::Model {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/functions/machine.yaml");
    bryant_generator::read(&file).expect("a model").0
}

/// States and accelerations.
fn cases(engine: &Engine) -> Vec<(Vec<f64>, Vec<f64>)> {
    let machine = engine.over::<f64>();
    let mut random = Random::new(47);
    let case = |_| {
        let mut y = vec![0.0; engine.info().state_length()];
        machine.initial_state(&mut y);
        y.iter_mut().for_each(|y| *y += random.uniform(-1.0, 1.0));
        machine.normalize(&mut y);
        let a = engine.info().velocities.iter();
        (y, a.map(|_| random.uniform(-9.0, 9.0)).collect())
    };
    (0..20).map(case).collect()
}

/// All functions, one after the other.
fn values<T: Real>(engine: &Engine, run: &dyn Fn(usize, &mut [T])) -> Vec<T> {
    let mut values = Vec::new();
    for (index, function) in engine.functions().iter().enumerate() {
        let mut results = vec![T::from_f64(0.5); function.rows.len() * function.columns.len()];
        run(index, &mut results);
        values.extend(results);
    }
    values
}

#[test]
fn the_interpreter_gives_the_bits_of_machine_code() {
    let engine = engine(&model(), &asked());
    fn compare<T: Real>(engine: &Engine, of: impl Fn(f64) -> T, bits: impl Fn(&T) -> Vec<u64>) {
        let (mut code, mut interpreted) = (engine.over::<T>(), engine.interpreted::<T>());
        for payload in [3.0, 0.5] {
            code.set_parameters(&[of(payload)]);
            interpreted.set_parameters(&[of(payload)]);
            for (y, a) in cases(engine) {
                let [y, a] = [y, a].map(|list| list.into_iter().map(&of).collect::<Vec<T>>());
                let t = of(0.1);
                let one = values(engine, &|k, out| code.function(k, t, &y, &a, out));
                let other = values(engine, &|k, out| interpreted.function(k, t, &y, &a, out));
                let bits = |values: Vec<T>| values.iter().flat_map(&bits).collect::<Vec<u64>>();
                assert_eq!(bits(one), bits(other));
            }
        }
    }
    compare::<f64>(&engine, |x| x, |x| vec![x.to_bits()]);
    compare::<f32>(&engine, |x| x as f32, |x| vec![x.to_bits().into()]);
    let dual = |x: f64| Dual {
        value: x,
        slope: 0.7 - x,
    };
    compare::<Dual<f64>>(&engine, dual, |x| {
        vec![x.value.to_bits(), x.slope.to_bits()]
    });
}

/// The functions of the generated Rust, in the order of the table.
fn of_rust(mechanism: &machine::Mechanism<f64>, y: &[f64], a: &[f64]) -> Vec<f64> {
    let (q, rest) = y.split_first_chunk().expect("q");
    let v = rest.first_chunk().expect("v");
    let a = a.first_chunk().expect("a");
    [
        mechanism.inverse_dynamics(q, v, a).to_vec(),
        mechanism.mass_matrix(q).concat(),
        mechanism.bias(q, v).to_vec(),
        mechanism.gravity_forces(q).to_vec(),
        mechanism.applied_forces(q, v).to_vec(),
        mechanism.regressor(q, v, a).concat(),
        mechanism.pose_arm_tip(q).concat(),
        mechanism.velocity_arm_tip(q, v).to_vec(),
        mechanism.acceleration_arm_tip(q, v, a).to_vec(),
        mechanism.jacobian_arm_tip(q).concat(),
        mechanism.bias_acceleration_arm_tip(q, v).to_vec(),
        mechanism.center_of_mass(q).to_vec(),
        mechanism.centroidal_momentum(q, v).to_vec(),
        mechanism.centroidal_matrix(q).concat(),
        mechanism.contacts(q, v).concat(),
        vec![mechanism.kinetic_energy_at(0.1, q, v)],
        vec![mechanism.potential_energy(q)],
    ]
    .concat()
}

#[test]
fn rust_gives_the_bits_of_the_engine() {
    let lists = Config::new()
        .matrices(false)
        .functions(asked())
        .lists(&model());
    let engine = Engine::new(lists).expect("no user function");
    let code = engine.over::<f64>();
    let mechanism = machine::Mechanism::new(machine::Parameters::default());
    for (y, a) in cases(&engine) {
        let ours = of_rust(&mechanism, &y, &a);
        let theirs = values(&engine, &|k, out| code.function(k, 0.1, &y, &a, out));
        assert_eq!(ours.len(), theirs.len());
        for (k, (one, other)) in ours.iter().zip(&theirs).enumerate() {
            assert_eq!(one.to_bits(), other.to_bits(), "{k}: {one} {other}");
        }
    }
}

#[test]
fn c_gives_the_bits_of_the_engine() {
    let mut config = Config::new();
    let config = config.matrices(false).functions(asked());
    let source = config.c_source(&model()).expect("C");
    let engine = Engine::new(config.lists(&model())).expect("no user function");
    let [state, n] = [engine.info().state_length(), engine.info().velocities.len()];
    let mut calls = String::new();
    for function in engine.functions() {
        let (identifier, count) = (
            &function.identifier,
            function.rows.len() * function.columns.len(),
        );
        let given = if function.accelerations {
            ", given + STATE"
        } else {
            ""
        };
        calls += &match &identifier[..] {
            "kinetic_energy" => {
                "result[0] = machine_kinetic_energy(&model, 0.1, given);".to_owned()
            }
            _ => format!("machine_{identifier}(&model, 0.1, given{given}, result);"),
        };
        calls += &format!(" fwrite(result, sizeof(double), {count}, stdout);\n");
    }
    let program = format!(
        "#include \"machine.h\"\n#include <stdio.h>\nenum {{ STATE = {state} }};\nint main(void)\n{{\n\
         double given[{state} + {n}], result[2000];\nmachine_model model;\nmachine_new(&model, NULL);\n\
         while (fread(given, sizeof(double), {state} + {n}, stdin) == {state} + {n}) {{\n{calls}}}\nreturn 0;\n}}\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let files = [
        ("machine.h", &source.header),
        ("machine.c", &source.source),
        ("main.c", &program),
    ];
    compile(
        folder.path(),
        &files,
        &["-o", "program", "main.c", "machine.c", "-lm"],
    );
    let code = engine.over::<f64>();
    let (mut input, mut expected) = (Vec::new(), Vec::new());
    for (y, a) in cases(&engine) {
        input.extend(y.iter().chain(&a).flat_map(|x| x.to_ne_bytes()));
        let values = values(&engine, &|k, out| code.function(k, 0.1, &y, &a, out));
        expected.extend(values.iter().flat_map(|x| x.to_ne_bytes()));
    }
    let mut run = Command::new(folder.path().join("program"));
    let run = run.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut run = run.spawn().expect("it runs");
    run.stdin
        .take()
        .expect("a pipe")
        .write_all(&input)
        .expect("written");
    let found = run.wait_with_output().expect("it ends").stdout;
    assert_eq!(found.len(), expected.len());
    assert!(found == expected, "the bits differ");
}

/// Compiles C without a warning.
fn compile(folder: &Path, files: &[(&str, &String)], arguments: &[&str]) {
    for (file, text) in files {
        std::fs::write(folder.join(file), text).expect("written");
    }
    let compiled = Command::new("cc")
        .current_dir(folder)
        .args(["-O1", "-std=c99", "-Wall", "-Wextra", "-Werror"])
        .args(arguments)
        .status()
        .expect("a C compiler");
    assert!(compiled.success());
}

/// A function without values is one all the same: a mechanism without contacts has no row of them.
#[test]
fn nothing_is_written_in_c_where_there_is_nothing() {
    let (model, _) = bryant_generator::read(Path::new("../models/dummy15.yaml")).expect("a model");
    let mut config = Config::new();
    let config = config.matrices(false).functions(["contacts"]);
    let source = config.c_source(&model).expect("C");
    let folder = tempfile::tempdir().expect("a folder");
    let header = format!("{}.h", source.name);
    let files = [(&header[..], &source.header), ("arm.c", &source.source)];
    compile(folder.path(), &files, &["-c", "arm.c"]);
    assert!(source.source.contains("_contacts(const") && source.source.contains("(void)results;"));
}
