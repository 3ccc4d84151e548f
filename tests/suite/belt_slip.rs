//! Belts that slip through rings, against the equation of a rope on a drum.

use super::command_call::call;
use super::directory;
use super::tables::{column, energy, run};
use std::fs;

/// A rope of two segments of 1 m around a pin at a right angle. Its end is pulled by 100 mm and, with `back`, released
/// by 90 mm again.
fn rope(back: bool) -> String {
    // a triangle up and one down: 0.1 m within 0.4 s, at rest at both ends
    let pull = "[0, 0], [0.1, 5], [0.2, 0], [0.3, -5], [0.4, 0]";
    let release = match back {
        true => ", [0.5, 0], [0.6, -4.5], [0.7, 0], [0.8, 4.5], [0.9, 0], [2, 0]",
        false => ", [2, 0]",
    };
    format!(
        "model: rope
dimension: 2
parameters: {{ mu: 0.2, resistance: 50 }}
vehicles:
  - name: puller
    acceleration: [{{ unit: [s, m/s^2], points: [{pull}{release}] }}, 0]
systems:
  - name: weight
    elements: [{{ name: mass, mass: 1, cg: [0, 0], inertia: 1 }}]
forces:
  - belt: rope
    from: {{ on: puller, at: [1, 0] }}
    through: [{{ ring: pin, on: frame, at: [0, 0], friction: mu, resistance: resistance }}]
    to: {{ on: frame, at: [0, 1] }}
    stiffness: 70 kN
outputs:
  - {{ name: pulled, of: belt rope, what: force, segment: 1 }}
  - {{ name: held, of: belt rope, what: force, segment: 2 }}
  - {{ name: slip, of: belt rope, what: slip, ring: pin }}
  - {{ name: on the pin, of: belt rope, what: force, on: frame, component: x }}
run: {{ duration: 1 s, every: 0.1 s }}
"
    )
}

/// A run has an error of at most its steps times its tolerance: 2000 · 1e-11 m, and 4e-7 of 3500 N at 70 kN/m.
fn close(what: &str, ours: f64, expected: f64) {
    let error = (ours - expected).abs() / expected.abs();
    assert!(error < 1e-6, "{what}: {ours} instead of {expected}");
}

#[test]
fn a_rope_around_a_pin_slips_to_the_ratio_of_tensions() {
    // EA (1.1/(1 + s) − 1) = e^(μ π/2) EA (1/(1 − s) − 1), by the secant method
    for (friction, pulled, held, slip) in [
        ("mu=0", 3500.0, 3500.0, 1.0 / 21.0),
        ("mu=0.2", 4020.0862, 2936.2818, 0.0402581777),
    ] {
        let (table, _) = run(&rope(false), &["--set", friction, "--tolerance", "1e-11"]);
        let last = |name| *column(&table, name).last().unwrap();
        close("pulled", last("pulled"), pulled);
        close("held", last("held"), held);
        // webbing comes from behind the pin
        close("slip", -last("slip"), slip);
        // the frame holds the pin and the other end: only the pulled segment acts along x
        close("on the frame", last("on the pin"), pulled);
    }
}

#[test]
fn between_the_two_ratios_a_rope_sticks() {
    let (table, _) = run(
        &rope(true),
        &["--set", "mu=0.6", "--every", "0.05", "--tolerance", "1e-11"],
    );
    let [pulled, held, slip] = ["pulled", "held", "slip"].map(|name| column(&table, name));
    let ratio = f64::exp(0.6 * std::f64::consts::FRAC_PI_2);
    let (mut stuck, mut slipped_back) = (0, 0);
    for k in 1..pulled.len() {
        let now = held[k] / pulled[k];
        if now > 1.02 / ratio && now < ratio / 1.02 {
            // strictly between the two limits: no slip at all since the row before, if that was also between them
            let before = held[k - 1] / pulled[k - 1];
            if before > 1.02 / ratio && before < ratio / 1.02 {
                assert_eq!(slip[k], slip[k - 1], "row {k}");
                stuck += 1;
            }
        }
        slipped_back += usize::from(slip[k] > slip[k - 1] + 1e-9);
    }
    // after a release by 90 mm, the pulled side is the looser one, and the rope slips back
    assert!(stuck > 0 && slipped_back > 0, "{stuck} {slipped_back}");
    close(
        "the ratio at the end",
        held[held.len() - 1] / pulled[pulled.len() - 1],
        ratio,
    );
}

#[test]
fn a_pin_takes_energy_and_never_gives_it() {
    let (_, printed) = run(&rope(true), &[]);
    assert!(energy(&printed, "belt rope: ring pin") < -1.0, "{printed}");
    // the balance of energy closes to the tolerance: it contains 200 J
    assert!(
        energy(&printed, "not accounted for").abs() < 1e-5,
        "{printed}"
    );
}

/// A head that is stopped by a strap over two rings, with all devices of a belt.
const STRAPPED: &str = "model: strapped
dimension: 3
parameters: { mu: 0.25 }
systems:
  - name: man
    elements: [{ name: torso, mass: 40, cg: [0, 0, 0.2], inertia: [1.5, 1.5, 0.4] }]
    start: { velocity: [8, 0, 0] }
forces:
  - belt: strap
    from: { on: frame, at: [-0.4, 0.3, 0.9] }
    through:
      - { ring: shoulder, on: man/torso, at: [0, 0.1, 0.5], friction: mu }
      - { ring: chest, on: man/torso, at: [0.13, 0, 0.25], friction: mu }
      - { ring: buckle, on: frame, at: [-0.1, -0.3, 0], friction: mu }
    to: { on: frame, at: [-0.1, 0.35, 0] }
    force: { points: [[0, 0], [5 %, 4 kN], [12 %, 11 kN]], extrapolate: linear }
    unloading: { points: [[0, 0], [5 %, 1 kN], [12 %, 5 kN]], extrapolate: linear }
    damping: 300 N*s/m
    retractor: { lock: crash, spool: 10 N, film_spool: { unit: [mm, N], points: [[0, 0], [40, 1000], [80, 5000]], extrapolate: linear } }
    pretensioner: { fire: crash, delay: 2 ms, retract: { unit: [ms, mm], points: [[0, 0], [6, 40]] } }
    limiter: { force: 5 kN }
switches:
  - { switch: crash, when: { time: 3 ms } }
outputs:
  - { name: one, of: belt strap, what: force, segment: 1 }
  - { name: four, of: belt strap, what: force, segment: 4 }
  - { name: payout, of: belt strap, what: payout }
  - { name: x, of: man/torso, what: displacement, component: x }
run: { duration: 100 ms, every: 1 ms }
";

#[test]
fn webbing_through_rings_keeps_its_length_and_its_energy() {
    let (table, printed) = run(STRAPPED, &[]);
    let [one, payout] = ["one", "payout"].map(|name| column(&table, name));
    assert!(one.iter().all(|force| (0.0..=5000.0).contains(force)));
    assert!(one.iter().any(|force| *force > 1000.0));
    // the reel gives webbing until it locks
    assert!(
        payout[3] > 0.01 && payout.iter().all(|p| p.abs() < 0.1),
        "{payout:?}"
    );
    // of 1280 J; the work is integrated to the tolerance, and kinks are passed: 1e-4 of it
    assert!(
        energy(&printed, "not accounted for").abs() < 0.1,
        "{printed}"
    );
    for work in ["film spool", "ring shoulder", "ring buckle", "pretensioner"] {
        assert!(printed.contains(work), "{work}: {printed}");
    }
}

/// s'(μ) of the pulled rope: f(s, μ) = 1.1/(1 + s) − 1 − R (1/(1 − s) − 1) = 0 with R = e^(μ π/2).
#[test]
fn gradients_go_through_rings() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("m.yaml"), rope(false)).unwrap();
    let arguments = [
        "gradient",
        "m.yaml",
        "--of",
        "final of pulled",
        "--wrt",
        "mu",
        "--json",
    ];
    let (printed, _) = call(path, &arguments, 0);
    let read: serde_json::Value = serde_json::from_str(&printed).unwrap();
    let found = find_number(&read, "derivative").unwrap_or_else(|| panic!("{printed}"));
    let (s, ratio) = (0.0402581777, f64::exp(0.1 * std::f64::consts::PI));
    let by_s = -1.1 / ((1.0 + s) * (1.0 + s)) - ratio / ((1.0 - s) * (1.0 - s));
    let by_mu = -std::f64::consts::FRAC_PI_2 * ratio * (1.0 / (1.0 - s) - 1.0);
    let expected = -70e3 * 1.1 / ((1.0 + s) * (1.0 + s)) * (-by_mu / by_s);
    close("derivative", found, expected);
}

/// The first number with a key, at any depth.
fn find_number(value: &serde_json::Value, key: &str) -> Option<f64> {
    match value {
        serde_json::Value::Object(map) => map.iter().find_map(|(k, v)| match v.as_f64() {
            Some(number) if k == key => Some(number),
            _ => find_number(v, key),
        }),
        serde_json::Value::Array(all) => all.iter().find_map(|v| find_number(v, key)),
        _ => None,
    }
}

#[test]
fn what_is_wrong_with_a_ring_is_said() {
    let directory = directory();
    let path = directory.path();
    let model = rope(false);
    for (wrong, instead, said) in [
        ("segment: 1", "segment: 3", "the belt has no segment 3"),
        (", segment: 1", "", "add `segment: 1`"),
        (
            ", ring: pin",
            "",
            "name one by `ring:`; the belt has \"pin\"",
        ),
        (
            "slip, ring: pin",
            "slip, ring: pen",
            "the belt has no ring \"pen\"",
        ),
        ("friction: mu", "friction: -0.1", "must not be negative"),
        (
            "resistance: resistance",
            "resistance: 0",
            "must be positive",
        ),
        (
            "on: puller, at: [1, 0]",
            "on: frame, at: [1, 0]",
            "the ends and all rings of belt \"rope\" are on the same body",
        ),
        (
            "what: force, segment: 2",
            "what: length, ring: pin",
            "means nothing for",
        ),
    ] {
        assert!(model.contains(wrong), "{wrong}");
        fs::write(path.join("m.yaml"), model.replacen(wrong, instead, 1)).unwrap();
        let (_, printed) = call(path, &["check", "m.yaml"], 2);
        assert!(printed.contains(said), "{said}: {printed}");
    }
    // a reel that gives webbing without end, or pulls when it should give
    for times in ["0", "-1"] {
        let reel = STRAPPED.replace(
            "film_spool: { unit: [mm, N], points: [[0, 0], [40, 1000], [80, 5000]], extrapolate: linear }",
            &format!("film_spool: {{ curve: {{ points: [[0, 0], [0.04, 1000]], extrapolate: linear }}, times: {times} }}"),
        );
        assert_ne!(reel, STRAPPED);
        fs::write(path.join("m.yaml"), reel).unwrap();
        let (_, printed) = call(path, &["check", "m.yaml"], 2);
        assert!(printed.contains("film_spool"), "{printed}");
    }
    // a parameter must not have a value that a constant must not have
    fs::write(path.join("m.yaml"), &model).unwrap();
    for wrong in ["mu=-1", "resistance=0", "resistance=-1"] {
        call(path, &["run", "m.yaml", "--set", wrong, "--no-files"], 2);
    }
}
