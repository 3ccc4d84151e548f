//! Bushings against closed forms: what hangs on one, what turns on one, and what one stores.

use super::sound;
use bryant::simulation::{self, Recording};
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};
use std::f64::consts::TAU;

const TOLERANCE: f64 = 1e-10;

/// A body of 2 kg on a bushing, with these laws; the run is of 1 s.
fn on_a_bushing(dimension: u8, laws: &str, rest: &str) -> Recording {
    let [origin, inertia] = match dimension {
        2 => ["[0, 0]", "0.5"],
        _ => ["[0, 0, 0]", "[0.5, 0.5, 0.5]"],
    };
    let text = format!(
        "model: mount\ndimension: {dimension}\nsystems:\n  - name: one\n    elements: [{{ name: body, mass: 2, cg: {origin}, inertia: {inertia} }}]\n{rest}run: {{ duration: 1 s, every: 10 ms }}\n"
    )
    .replace(
        "BUSHING",
        &format!("{{ bushing: mount, from: {{ on: frame, at: {origin} }}, to: {{ on: one/body, at: {origin} }}, {laws} }}"),
    );
    let (_, engine) = sound(&text);
    let job = Job {
        method: Some(Integrator::adaptive(
            Formula::Dopri5,
            Tolerances::of(TOLERANCE),
        )),
        ..Job::default()
    };
    let recording = simulation::run(&engine, &job, &mut |_| ());
    assert!(recording.result.is_ok(), "{:?}", recording.result.err());
    recording
}

fn column<'r>(recording: &'r Recording, name: &str) -> &'r [f64] {
    let columns = &recording.table.columns;
    let found = columns.iter().find(|column| column.name == name);
    &found.unwrap_or_else(|| panic!("no column {name}")).values
}

/// An error of the tolerance in each step, where the largest rate is this \[1/s\].
fn bound(recording: &Recording, rate: f64) -> f64 {
    let steps = recording.result.as_ref().map_or(0, |report| report.steps);
    steps as f64 * TOLERANCE * rate.max(1.0)
}

#[test]
fn a_weight_sinks_by_its_force_over_the_stiffness() {
    // ω = √(k/m) = 100/s; with c = 2 √(k m) it is at rest after 1 s within e⁻¹⁰⁰
    let laws = "along: { x: { stiffness: 5e3, damping: 200 }, z: { stiffness: 2e4, damping: 400 } }, about: { y: { stiffness: 1 } }";
    let forces = "forces: [BUSHING, { field: gravity, acceleration: [3, -9.81] }]\noutputs:\n  - { name: x, of: bushing mount, what: displacement, component: x }\n  - { name: z, of: bushing mount, what: displacement, component: z }\n  - { name: up, of: bushing mount, what: force, component: z, on: one/body }\n";
    let run = on_a_bushing(2, laws, forces);
    let bound = bound(&run, 100.0);
    let last = |name: &str| *column(&run, name).last().expect("samples");
    for (name, expected) in [("x", 2.0 * 3.0 / 5e3), ("z", -2.0 * 9.81 / 2e4)] {
        assert!(
            (last(name) - expected).abs() < bound,
            "{name}: {}",
            last(name)
        );
    }
    let weight = 2.0 * 9.81;
    assert!((last("up") - weight).abs() < bound * 2e4, "{}", last("up"));
}

#[test]
fn a_body_turns_on_a_bushing_with_the_period_of_a_torsional_pendulum() {
    for axis in ["x", "y", "z"] {
        let component = |i: &str| if i == axis { "1.5" } else { "0" };
        let rates = ["x", "y", "z"].map(component).join(", ");
        let rest = format!(
            "    start: {{ rates: {{ body: [{rates}] }} }}\nforces: [BUSHING]\noutputs: [{{ name: angle, of: bushing mount, what: angle, component: {axis} }}]\n"
        );
        let laws = format!("about: {{ {axis}: {{ stiffness: 300 }} }}");
        let run = on_a_bushing(3, &laws, &rest);
        // T = 2π √(J/k)
        let period = TAU * (0.5f64 / 300.0).sqrt();
        let bound = bound(&run, TAU / period);
        let times = &column(&run, "time");
        for (t, angle) in times.iter().zip(column(&run, "angle")) {
            let expected = 1.5 * period / TAU * (TAU * t / period).sin();
            assert!(
                (angle - expected).abs() < bound,
                "about {axis} at {t} s: {angle} instead of {expected}"
            );
        }
    }
}

#[test]
fn a_bushing_without_dampers_keeps_the_energy() {
    let outputs: String = ["x", "y", "z"]
        .iter()
        .flat_map(|axis| ["displacement", "angle"].map(|what| (what, axis)))
        .map(|(what, axis)| {
            format!("  - {{ name: {what} {axis}, of: bushing mount, what: {what}, component: {axis} }}\n")
        })
        .collect();
    let rest = format!(
        "    start: {{ velocity: [0.3, -0.2, 0.4], rates: {{ body: [4, -3, 5] }} }}\nforces: [BUSHING]\noutputs:\n  - {{ name: energy, of: one, what: kinetic_energy }}\n{outputs}"
    );
    let laws = "along: { x: { stiffness: 200 }, y: { stiffness: 300 }, z: { stiffness: 100 } }, about: { x: { stiffness: 20 }, y: { stiffness: 40 }, z: { stiffness: 30 } }";
    let run = on_a_bushing(3, laws, &rest);
    let stiffness = [
        ("displacement x", 200.0),
        ("displacement y", 300.0),
        ("displacement z", 100.0),
        ("angle x", 20.0),
        ("angle y", 40.0),
        ("angle z", 30.0),
    ];
    let energy = |index: usize| {
        let stored = stiffness.map(|(name, k)| 0.5 * k * column(&run, name)[index].powi(2));
        column(&run, "energy")[index] + stored.iter().sum::<f64>()
    };
    let (first, count) = (energy(0), column(&run, "energy").len());
    // ½ m v² + ½ J ω² at the start, where the frames coincide
    assert!((first - (0.29 + 0.25 * 50.0)).abs() < 1e-12, "{first}");
    let turned = column(&run, "angle y");
    assert!(
        turned.iter().any(|angle| angle.abs() > 0.3),
        "it must turn far"
    );
    // an error e of a coordinate or a velocity is one of 2 √(E k) e or 2 √(E m) e
    let bound = bound(&run, 20.0) * 2.0 * (first * 300.0).sqrt();
    for index in 0..count {
        let error = (energy(index) - first).abs();
        assert!(
            error < bound,
            "{error:e} of {first} J at sample {index}, allowed {bound:e}"
        );
    }
}

/// A body of 0.5 kg m² that begins to turn in a bushing at these rates.
fn turned(rates: &str, laws: &str) -> Vec<String> {
    let rest = format!(
        "    start: {{ rates: {{ body: [{rates}] }} }}\nforces: [BUSHING]\noutputs: [{{ name: angle, of: bushing mount, what: angle, component: y }}]\n"
    );
    let run = on_a_bushing(3, laws, &rest);
    run.doubts
        .iter()
        .map(|doubt| doubt.message.clone())
        .collect()
}

#[test]
fn a_bushing_through_its_singular_angle_says_so() {
    // 3 rad/s for 1 s about y, with next to no law
    for laws in [
        "about: { x: { damping: 1e-3 } }",
        "about: { y: { damping: 1e-3 } }",
        "about: { z: { stiffness: 1e-3 } }",
    ] {
        for rates in ["0, 3, 0", "0, -3, 0"] {
            let found = turned(rates, laws);
            let said = found.iter().any(|said| {
                said.contains("\"bushing mount\" is turned through ±90° about y")
                    && said.contains("since t = ")
            });
            assert!(said, "{laws} {rates}: {found:?}");
        }
    }
    // ½ J ω² < ½ k (π/2)²: it turns back before; or it turns about another axis, passes beside, or no law asks for an
    // angle
    let about_y = "about: { x: { damping: 1e-3 }, y: { stiffness: 3 } }";
    for (rates, laws) in [
        ("0, 3, 0", about_y),
        (
            "3, 0, 0",
            "about: { x: { damping: 1e-3 }, z: { damping: 1e-3 } }",
        ),
        (
            "0, 0, 3",
            "about: { x: { damping: 1e-3 }, z: { damping: 1e-3 } }",
        ),
        ("0.6, 3, 0", "about: { x: { damping: 1e-3 } }"),
        ("0, 3, 0", "along: { x: { stiffness: 5 } }"),
    ] {
        let found = turned(rates, laws);
        assert!(found.is_empty(), "{laws} {rates}: {found:?}");
    }
}

#[test]
fn a_bushing_that_may_come_to_its_singular_angle_is_named() {
    let warned = |about: &str| {
        let bushing = format!(
            "{{ bushing: mount, from: {{ on: frame, at: [0, 0, 0] }}, to: {{ on: one/body, at: [0, 0, 0] }}, about: {{ {about} }} }}"
        );
        let text = format!(
            "model: mount\ndimension: 3\nsystems:\n  - name: one\n    elements: [{{ name: body, mass: 2, cg: [0, 0, 0], inertia: [1, 1, 1] }}]\nforces: [{bushing}]\nrun: {{ duration: 1 s, every: 1 s }}\n"
        );
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("mount.yaml"), text).expect("a file");
        let (stdout, stderr) =
            crate::command_call::call(folder.path(), &["check", "mount.yaml"], 0);
        (stdout + &stderr).contains("nothing ends the rotation about y")
    };
    assert!(warned("x: { stiffness: 1 }"));
    assert!(warned("z: { damping: 1 }, y: { damping: 1 }"));
    assert!(!warned("x: { stiffness: 1 }, y: { stiffness: 1 }"));
    assert!(!warned("y: { damping: 1 }"));
}
