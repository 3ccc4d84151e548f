//! An effect that is off leaves no trace: the text of a scene with an effect switched off, in every way that the
//! language has, equals byte for byte the text of a scene that never mentions it.
//!
//! The [table](cases) has a case for every effect. The test lists all words of the vocabulary and fails if a term of a
//! law, a kind of force or a kind of effect has no case.

mod cases;

use bryant_generator::Config;
use bryant_generator::dynamics;
use bryant_generator::effect::{self, Effect, Reason, Variant};
use bryant_generator::expression::Function;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::{Dimension, Model, Reference};
use cases::{CASES, plane, space};
use std::collections::BTreeSet;
use std::io;
use std::path::Path;

/// The word of a case, for effects that are not terms of forces.
fn word(effect: Effect, model: &Model) -> Option<String> {
    Some(match effect {
        Effect::OutOfPlane => "out of plane".into(),
        Effect::FreeTranslation { .. } => "free translation".into(),
        Effect::PrescribedTranslation { .. } => "prescribed translation".into(),
        Effect::FirstMoment(_) => "first moment".into(),
        Effect::GyroscopicMoment(_) => "gyroscopic moment".into(),
        Effect::Armature(_) => "armature".into(),
        Effect::Coupling(_) => "coupling".into(),
        Effect::Force { force } => {
            // A kind of force that is added here needs a case above.
            format!("force {}", model.forces[force].law.key())
        }
        Effect::FieldByElement { .. } => "field by element".into(),
        Effect::Parameter(_) => "parameter".into(),
        Effect::Output(_) => "output".into(),
        Effect::Term { .. } => return None,
    })
}

/// The words for the terms of all forces of a model. The terms of contacts do not depend on the dimension.
fn terms(model: &Model) -> impl Iterator<Item = String> {
    let dimension = match model.dimension {
        Dimension::Plane => "plane",
        Dimension::Space => "space",
    };
    let forces = model.forces.iter().flat_map(move |force| {
        let terms = force.law.terms(model.dimension).into_iter();
        let kind = force.law.key();
        terms.map(move |(term, _)| format!("{dimension} {kind} {}", term.name))
    });
    forces.collect::<Vec<_>>().into_iter()
}

fn read(text: &str) -> AnnotatedModel {
    let nothing = |_: &Path| Err(io::ErrorKind::NotFound.into());
    bryant_generator::read_annotated_str("m.yaml", text, &nothing)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn source(scene: &AnnotatedModel) -> String {
    source_of(&scene.model)
}

fn source_of(model: &Model) -> String {
    Config::new().source(model)
}

#[test]
fn an_effect_that_is_off_leaves_no_trace() {
    for case in CASES {
        let word = case.word;
        let [on, never] = [case.on, case.never].map(|text| read(&(case.scene)(text)));
        let without = source(&never);
        assert_ne!(source(&on), without, "{word} is not called for");
        // Effects without a coefficient that could be 0 are either mentioned or not.
        let always = [
            "out of plane",
            "coupling",
            "space airbag gas at the start",
            "space airbag inflow",
            "plane belt film spool",
            "plane belt limiter",
            "plane belt retractor",
            "plane contact edge",
        ];
        assert!(!case.off.is_empty() || always.contains(&word), "{word}");
        for off in case.off {
            let off = read(&(case.scene)(off));
            assert_eq!(off.model, never.model, "{word}");
            assert!(source(&off) == without, "{word}: {:?}", off.model);
        }
        if case.effect.is_empty() {
            continue;
        }
        // The program leaves the effect out as the user does.
        let entries = effect::of_annotated_model(&on);
        let entry = entries.iter().find(|e| e.name == case.effect);
        let entry = entry.unwrap_or_else(|| panic!("{word}: {} is no effect", case.effect));
        assert!(entry.is_in, "{word}");
        let effect = entry.effect.expect("what is in is of the model");
        let variant = effect::without(&on.model, effect).expect("a model is left");
        assert_eq!(variant.model, never.model, "{word}");
        assert_eq!(variant.omitted, None, "{word}");
    }
}

#[test]
fn every_effect_has_a_case() {
    let cases: BTreeSet<&str> = CASES.iter().map(|case| case.word).collect();
    let mut words: BTreeSet<String> = BTreeSet::new();
    for case in CASES {
        let scene = read(&(case.scene)(case.on));
        words.extend(terms(&scene.model));
        let effects = effect::of_model(&scene.model).into_iter();
        let effects = effects.filter_map(|entry| word(entry.effect?, &scene.model));
        words.extend(effects);
    }
    // In the plane a belt has one of three lengths; the word for no length is that of the first.
    let missing: Vec<&String> = words
        .iter()
        .filter(|w| !cases.contains(w.as_str()))
        .collect();
    assert!(missing.is_empty(), "no case for {missing:?}");
    let unknown: Vec<&&str> = cases.iter().filter(|c| !words.contains(**c)).collect();
    assert!(unknown.is_empty(), "no effect is called {unknown:?}");
}

// Long: a model, and what is out in it.
#[test]
fn what_is_out_is_listed_with_the_line_that_switches_it_off() {
    let text = "model: m
dimension: 2
parameters: { mu: 0.3 }
systems:
  - name: man
    reference: fixed
    elements:
      - { name: torso, mass: 30, cg: [0, 0], inertia: 1.1 }
forces:
  - contact: seat
    ellipsoid: { on: man/torso, center: [0, 0], semi_axes: [1, 1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { points: [[0, 0], [1, 9]] }
    damping: 0
  - joint: man/torso
    damping: 0.5
    friction: mu
    enabled: false
  - belt: lap
    from: { on: man/torso, at: [1, 0] }
    to: { on: frame, at: [-1, 0] }
    force: { points: [[0, 0], [1, 9]] }
    pretension: 0
outputs:
  - { name: turn, of: man/torso, what: angle, enabled: false }
";
    let scene = read(text);
    let entries = effect::of_annotated_model(&scene);
    let found = |name: &str| {
        let mut all = entries.iter().filter(|e| e.name == name);
        let entry = all.next().unwrap_or_else(|| panic!("{name} is not listed"));
        assert!(all.next().is_none(), "{name} is listed twice");
        let line = entry.place.as_ref().map_or(0, |place| place.line);
        (entry.is_in, entry.reason, entry.why.as_str(), line)
    };
    use Reason::{Absent, Structure, SwitchedOff, Written};
    assert_eq!(found("contact seat: elastic"), (true, Written, "", 13));
    assert_eq!(
        found("contact seat: damping"),
        (false, SwitchedOff, "the coefficient is 0", 14)
    );
    assert_eq!(
        found("contact seat: friction"),
        (false, Absent, "not mentioned", 10)
    );
    assert_eq!(
        found("joint man/torso"),
        (false, SwitchedOff, "the force is switched off", 18)
    );
    assert_eq!(
        found("joint man/torso: friction"),
        (false, SwitchedOff, "the force is switched off", 18)
    );
    assert_eq!(
        found("belt lap: slack"),
        (false, SwitchedOff, "the belt is just taut at the start", 23)
    );
    assert_eq!(
        found("parameter mu"),
        (
            false,
            SwitchedOff,
            "everything that it is used for is out",
            3
        )
    );
    assert_eq!(
        found("output turn"),
        (false, SwitchedOff, "the output is switched off", 25)
    );
    assert_eq!(
        found("element man/torso: first moment about its joint"),
        (false, Structure, "the joint is at the centre of gravity", 8)
    );
    assert_eq!(
        found("system man: free translation of the reference joint"),
        (false, Structure, "the reference joint is fixed", 6)
    );
    assert_eq!(
        found("motion out of the x–z plane (along y, about x and z)").3,
        2
    );
}

/// A model of the repository.
fn bundled(path: &str) -> AnnotatedModel {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    bryant_generator::read_annotated(&path).unwrap_or_else(|e| panic!("{e}"))
}

/// v̇ of a model at a time and a state, with the names of its entries.
fn accelerations(model: &Model, t: f64, q: &[f64], v: &[f64]) -> Vec<(String, f64)> {
    let options = dynamics::Options {
        matrices: false,
        ..Default::default()
    };
    let equations = dynamics::derive_with(model, options);
    let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let inputs = Inputs {
        time: t,
        coordinates: q,
        velocities: v,
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
        parameters: &parameters,
    };
    let law = |function: Function, a: &[f64]| law(model, function, a);
    let values = evaluate(&equations.graph, &equations.accelerations, &inputs, &law);
    let names = equations.velocities.iter().map(|v| v.name.clone());
    names.zip(values).collect()
}

/// Laws with the property that matters here: no force without a coefficient.
fn law(model: &Model, function: Function, a: &[f64]) -> f64 {
    let slope = |curve: u32, x: f64| {
        let points = &model.curves[curve as usize].points;
        let ([x0, y0], [x1, y1]) = (points[0], points[points.len() - 1]);
        y0 + (y1 - y0) / (x1 - x0) * (x - x0)
    };
    match function {
        Function::Curve(curve) => slope(curve, a[0]),
        Function::Choose if a[0] < a[1] => a[2],
        Function::Choose => a[3],
        _ => 0.5 * a[0],
    }
}

/// With nothing left out, the motion is that of the scene: a planar state in space has the same accelerations.
///
/// Both routes are backward stable and the numbers of the two models are the same. So the difference is rounding times
/// the condition of S, which is about 1e4 for these trees: 1e4 × 1e2 operations in a row × ε ≈ 2e-10 of the largest
/// acceleration.
#[test]
fn nothing_left_out_moves_as_the_scene_does() {
    for path in [
        "models/child-seat.yaml",
        "models/sled-pendulum.yaml",
        "tests/models/slack-belt.yaml",
        "tests/models/prescribed.yaml",
        "tests/models/sliding-block.yaml",
        "tests/models/rocking.yaml",
        "tests/models/tree2d.yaml",
    ] {
        let scene = bundled(path);
        let general = effect::general(&scene.written);
        assert_eq!(general.dimension, Dimension::Space);
        let mut numbers = general.clone();
        let constants = numbers.numbers_mut().into_iter();
        assert_eq!(
            constants.filter(|n| n.constant().is_some()).count(),
            0,
            "{path}"
        );

        let wave = |i: usize| (1.0 + 1.7 * i as f64).sin();
        let (mut q, mut v, mut q3, mut v3) = (vec![], vec![], vec![], vec![]);
        for system in &scene.model.systems {
            if system.reference == Reference::Free {
                let (x, z, u, w) = (
                    wave(q.len()),
                    wave(q.len() + 1),
                    wave(q.len() + 2),
                    wave(q.len() + 3),
                );
                q.extend([x, z]);
                v.extend([u, w]);
                q3.extend([x, 0.0, z]);
                v3.extend([u, 0.0, w]);
            }
            for _ in &system.elements {
                let (angle, rate) = (wave(q.len()), wave(q.len() + 5));
                q.push(angle);
                v.push(rate);
                q3.extend([(0.5 * angle).cos(), 0.0, (0.5 * angle).sin(), 0.0]);
                v3.extend([0.0, rate, 0.0]);
            }
        }
        let planar = accelerations(&scene.model, 0.03, &q, &v);
        let space = accelerations(&general, 0.03, &q3, &v3);
        let largest = planar.iter().map(|(_, a)| a.abs()).fold(0.0, f64::max);
        assert!(largest > 0.0 && largest.is_finite(), "{path}");
        for (name, value) in &space {
            let same = match name.rsplit_once('.') {
                Some((owner, "wy")) => format!("{owner}.omega"),
                _ => name.clone(),
            };
            let expected = planar
                .iter()
                .find(|(n, _)| *n == same)
                .map_or(0.0, |(_, a)| *a);
            let error = (value - expected).abs() / largest;
            assert!(
                error < 2e-10,
                "{path}: {name} {value} instead of {expected}"
            );
        }
    }
}

/// An effect that vanishes by structure costs nothing, and an effect that is in costs something: the graph itself shows
/// this.
#[test]
fn effects_of_inertia_cost_nothing_where_they_vanish() {
    let mut compared = 0;
    for path in [
        "models/child-seat.yaml",
        "models/dummy15.yaml",
        "tests/models/free-top.yaml",
        "tests/models/sliding-sphere.yaml",
    ] {
        let model = bundled(path).model;
        let variant = Variant::of(&model);
        let all = effect::cost(&variant).accelerations;
        for entry in effect::of_model(&model) {
            let Some(effect @ (Effect::FirstMoment(_) | Effect::GyroscopicMoment(_))) =
                entry.effect
            else {
                continue;
            };
            // The first moment of the carried elements is in the positions of joints.
            let Some(without) = effect::without(&model, effect) else {
                assert!(
                    matches!(effect, Effect::FirstMoment(_)),
                    "{path}: {}",
                    entry.name
                );
                continue;
            };
            compared += 1;
            let cost = effect::cost(&without).accelerations;
            if entry.is_in {
                assert!(cost.total() < all.total(), "{path}: {}", entry.name);
            } else {
                assert_eq!(cost, all, "{path}: {}", entry.name);
            }
        }
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn a_parameter_left_out_is_its_default_folded() {
    let on = read(&plane(
        "forces: [{ joint: man/head, damping: 2 * mu }, { field: sled, acceleration: [mu, -9.81] }]",
    ));
    let folded = read(&plane(
        "forces: [{ joint: man/head, damping: 0.6 }, { field: sled, acceleration: [0.3, -9.81] }]",
    ));
    let variant = effect::without(&on.model, Effect::Parameter(0)).expect("a model is left");
    assert_eq!(source_of(&variant.model), source_of(&folded.model));
    assert!(variant.model.parameters.is_empty());
    let [all, without] = [Variant::of(&on.model), variant].map(|v| effect::cost(&v));
    assert!(all.accelerations.total() >= without.accelerations.total());
}

/// Items that only give meaning to other items: bending, switches and vehicles of which nothing is left.
#[test]
fn what_nothing_is_left_of_leaves_no_trace() {
    const NEVER: &str = "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]";
    for off in [
        "forces: [{ joint: man/head, about: { y: { damping: 1 } }, flexion: { damping: 0 } }]",
        "forces: [{ joint: man/head, about: { y: { damping: 1 } }, torsion: { elastic: never, friction: 0 } }]",
        "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]\nswitches: [{ switch: crash, when: { time: 1 ms } }]",
        "forces: [{ joint: man/head, about: { y: { damping: 1 } } }, { field: g, since: crash, acceleration: [0, 0, 0] }]\nswitches: [{ switch: crash, when: { time: 1 ms } }]",
        "forces: [{ joint: man/head, about: { y: { damping: 1 } } }]\nvehicles: [{ name: car, acceleration: [pulse, 0, 0] }]",
    ] {
        let [off, never] = [off, NEVER].map(|text| read(&space(text)));
        assert_eq!(off.model, never.model);
        assert!(source(&off) == source(&never));
    }
}
