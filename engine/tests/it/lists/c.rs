//! The laws and curves of the C text, compared with those of the runtime to the last bit, at many kinds of numbers.

use super::evaluate::{called, curves};
use super::random::Random;
use bryant_engine::internals::Library;
use bryant_generator::expression::{ApproachCall, Function};
use bryant_generator::program::{Curve, Input, List, Operation, Value};
use bryant_generator::target::c;
use bryant_generator::target::machine::Callee;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const CASES: usize = 4000;

/// A call of a function, with the state as its arguments.
fn list(callee: Callee) -> List {
    let arity = callee.arguments() as u32;
    let operation = match callee {
        Callee::SinCos => Operation::SinCos(Value(0)),
        Callee::Function(function) => Operation::Call { function, first: 0 },
        Callee::Atan2 => unreachable!("it is that of the platform, in C as in Rust"),
    };
    let results = operation.defines() as u32;
    List {
        constants: Vec::new(),
        inputs: (0..arity).map(Input::State).collect(),
        operations: vec![operation],
        arguments: (0..arity).map(Value).collect(),
        results: (arity..arity + results).map(Value).collect(),
    }
}

/// Arguments for a function: any numbers, places near the points of curves, bodies that overlap and bodies that do not.
fn arguments(callee: Callee, random: &mut Random) -> Vec<f64> {
    let arity = callee.arguments();
    let Callee::Function(function) = callee else {
        // numbers of all sizes, and multiples of a quarter turn
        let mut number = || {
            let size = 10f64.powi(random.below(80) as i32 * 8 - 320);
            match random.below(4) {
                0 => random.any(),
                1 => std::f64::consts::FRAC_PI_2 * random.below(100_000) as f64,
                2 => random.ordinary(),
                _ => size * random.ordinary(),
            }
        };
        return (0..arity).map(|_| number()).collect();
    };
    match function {
        Function::Support(_) => {
            let mut given: Vec<f64> = (0..3).map(|_| random.any()).collect();
            given.push(1.0 + 1.0 / (1 + random.below(20)) as f64);
            given
        }
        Function::Approach(call) => {
            // Q = R diag(a²) Rᵀ + a share of noise that keeps it positive
            let n = call.components();
            let mut given = Vec::new();
            for _ in 0..2 {
                let root: Vec<f64> = (0..n * n).map(|_| 0.1 * random.ordinary()).collect();
                let entry = |i: usize, j: usize| {
                    let sum: f64 = (0..n).map(|k| root[n * i + k] * root[n * j + k]).sum();
                    sum + if i == j { 1e-3 } else { 0.0 }
                };
                let places: &[(usize, usize)] = match n {
                    2 => &[(0, 0), (1, 1), (0, 1)],
                    _ => &[(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)],
                };
                given.extend(places.iter().map(|&(i, j)| entry(i, j)));
            }
            let scale = [0.0, 1e-12, 0.01, 0.3, 3.0][random.below(5)];
            given.extend((0..n).map(|_| scale * random.ordinary()));
            given
        }
        Function::CurveStop(_) => vec![random.any(), random.any()],
        _ if random.below(4) == 0 => (0..arity).map(|_| random.any()).collect(),
        _ => (0..arity).map(|_| 3.0 * random.ordinary()).collect(),
    }
}

fn functions() -> Vec<Callee> {
    let mut functions = vec![Function::Choose, Function::Power, Function::Support(0)];
    for curve in 0..curves().len() as u32 {
        functions.extend([
            Function::Curve(curve),
            Function::CurveSlope(curve),
            Function::CurveSecondDerivative(curve),
            Function::CurveInverse(curve),
            Function::CurveIntegral(curve),
            Function::CurveDoubleIntegral(curve),
            Function::CurveBreakpoints(curve),
            Function::CurveStop(curve),
        ]);
    }
    for planar in [true, false] {
        for early in [true, false] {
            functions.push(Function::Approach(ApproachCall {
                planar,
                early,
                part: 0,
            }));
        }
    }
    let functions = functions.into_iter().map(Callee::Function);
    functions.chain([Callee::SinCos]).collect()
}

/// Compiles a program that reads [`CASES`] times the arguments of each function and writes its results.
fn compile(functions: &[Callee], curves: &[Curve], directory: &Path) -> PathBuf {
    let write = |name: &str, text: &str| std::fs::write(directory.join(name), text).unwrap();
    let mut names = vec!["program.c".to_owned()];
    let mut program = String::from("#include <stdio.h>\n");
    let mut calls = String::new();
    for (k, function) in functions.iter().enumerate() {
        let (name, list) = (format!("function_{k}"), list(*function));
        let text = c::function(&list, curves, &name).unwrap();
        write(
            &format!("{name}.c"),
            &format!("void {name}(double t, const double y[], double results[]);\n{text}"),
        );
        names.push(format!("{name}.c"));
        program.push_str(&format!(
            "void {name}(double t, const double y[], double results[]);\n"
        ));
        let (given, results) = (function.arguments(), list.results.len());
        calls.push_str(&format!(
            "    for (i = 0; i < {CASES}; i++) {{ if (fread(y, 8, {given}, stdin) != {given}) return 1; {name}(0.0, y, r); \
             fwrite(r, 8, {results}, stdout); }}\n"
        ));
    }
    program.push_str(&format!(
        "int main(void)\n{{\n    double y[16], r[16];\n    int i;\n{calls}    return 0;\n}}\n"
    ));
    write("program.c", &program);
    let compiled = Command::new("cc")
        .args([
            "-std=c99",
            "-pedantic",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-O1",
        ])
        .args(&names)
        .args(["-lm", "-o", "program"])
        .current_dir(directory)
        .output()
        .expect("a C compiler, which Rust needs, too");
    let messages = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{messages}");
    directory.join("program")
}

#[test]
fn laws_and_curves_in_c_have_the_bits_of_the_runtime() {
    let curves = curves();
    let library = Library::new(&curves, None);
    let directory = tempfile::tempdir().unwrap();
    let functions = functions();
    let program = compile(&functions, &curves, directory.path());
    let mut random = Random::new(7);
    let (mut given, mut expected) = (Vec::new(), Vec::new());
    for function in &functions {
        for _ in 0..CASES {
            let arguments = arguments(*function, &mut random);
            let mut found = vec![0.0; function.results()];
            match *function {
                Callee::Function(function) => library.call(function, &arguments, &mut found),
                _ => found = called(*function, &arguments),
            }
            expected.extend(
                found
                    .iter()
                    .map(|value| (*function, arguments.clone(), *value)),
            );
            given.extend(arguments.iter().flat_map(|number| number.to_ne_bytes()));
        }
    }
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || input.write_all(&given));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    let ours = output.stdout.as_chunks::<8>().0;
    assert_eq!(ours.len(), expected.len());
    let bits = |value: f64| {
        if value.is_nan() {
            u64::MAX
        } else {
            value.to_bits()
        }
    };
    for (bytes, (function, arguments, expected)) in ours.iter().zip(expected) {
        let ours = f64::from_ne_bytes(*bytes);
        assert!(
            bits(ours) == bits(expected),
            "{function:?} of {arguments:?}: {ours:e} in C, {expected:e} by the runtime"
        );
    }
}
