//! Joints with freedoms of their own: the equations against Lagrange's, against each other, and against closed forms.

use crate::share::share;
use bryant_generator::dynamics::lagrange::lagrange;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::{Equations, Route};
use bryant_generator::expression::NodeId;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::method::Method;
use bryant_generator::model::Model;
use bryant_generator::read_str;
use nalgebra::{DMatrix, DVector};
use std::path::Path;

fn read(text: &str) -> Model {
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    match read_str("model.yaml", text, &none) {
        Ok((model, _)) => model,
        Err(problems) => panic!("{problems}\n{text}"),
    }
}

fn derived(model: &Model, route: Route) -> Equations {
    let options = Options {
        matrices: true,
        route: Some(route),
    };
    derive_with(model, options)
}

/// Unrelated numbers from −1 to 1.
struct Numbers(f64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = (self.0 + 0.618_033_988_749_895).fract();
        let x = (self.0 * 7919.0).sin() * 43758.547;
        2.0 * (x - x.floor()) - 1.0
    }

    fn list(&mut self, count: usize, scale: f64) -> Vec<f64> {
        (0..count).map(|_| scale * self.next()).collect()
    }
}

fn values(equations: &Equations, roots: &[NodeId], q: &[f64], v: &[f64]) -> Vec<f64> {
    let charts = vec![0.0; equations.charts];
    let inputs = Inputs {
        time: 0.0,
        coordinates: q,
        velocities: v,
        parameters: &[],
        auxiliaries: &[],
        memory: &charts,
        accelerations: &[],
    };
    evaluate(&equations.graph, roots, &inputs, &|f, a: &[f64]| {
        choices(f, a)
    })
}

/// Only choices are called here.
fn choices(function: bryant_generator::expression::Function, arguments: &[f64]) -> f64 {
    match *arguments {
        [a, b, then, _] if a < b => then,
        [_, _, _, otherwise] => otherwise,
        _ => panic!("{function:?}"),
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |m, x| m.max(x.abs()))
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()))
}

/// The message about a model that is refused.
fn refused(text: &str) -> String {
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    match read_str("model.yaml", text, &none) {
        Ok(_) => panic!("it is accepted:\n{text}"),
        Err(problems) => problems.to_string(),
    }
}

/// The joints in space, as written.
const IN_SPACE: [&str; 15] = [
    "weld",
    "ball",
    "{ hinge: x }",
    "{ hinge: [1, -2, 0.5], zero: 30 deg }",
    "{ slider: -z }",
    "{ slider: [0.3, 1, -1], zero: 0.2 }",
    "{ screw: y, pitch: 0.4 }",
    "{ screw: [1, 1, 0.2], pitch: -0.3, zero: 0.4 }",
    "{ universal: [x, y] }",
    "{ cylinder: z }",
    "{ planar: y }",
    "translation",
    "free",
    "[{ hinge: z, name: a }, { slider: x, name: b }, { hinge: [0, 1, 1], name: c }]",
    "[{ slider: x, name: a }, { hinge: z, name: b }, { hinge: y, name: c }, { hinge: x, name: d }]",
];

const IN_PLANE: [&str; 9] = [
    "weld",
    "hinge",
    "{ hinge: -y, zero: 0.3 }",
    "{ slider: x }",
    "{ slider: [1, 2], zero: -0.1 }",
    "{ planar: y }",
    "translation",
    "free",
    "[{ hinge: y, name: a }, { slider: z, name: b }]",
];

/// A tree of four elements: a root, two in a chain on it, one beside.
fn tree(dimension: u32, coordinates: &str, reference: &str, joints: [&str; 4]) -> String {
    let [root, a, b, c] = joints;
    let vector = |x: f64, y: f64, z: f64| match dimension {
        2 => format!("[{x}, {z}]"),
        _ => format!("[{x}, {y}, {z}]"),
    };
    let inertia = |x: f64, y: f64, z: f64| match dimension {
        2 => format!("{y}"),
        _ => format!("[{x}, {y}, {z}]"),
    };
    let axes = match dimension {
        2 => String::new(),
        _ => ", axes: [0.3, -0.2, 0.5]".to_owned(),
    };
    let coordinates = match dimension {
        2 => String::new(),
        _ => format!("coordinates: {coordinates}\n"),
    };
    format!(
        "model: tree\ndimension: {dimension}\n{coordinates}systems:\n  - name: s\n    reference: {reference}\n    elements:\n      \
         - {{ name: root, joint: {root}, mass: 2, cg: {}, inertia: {} }}\n      \
         - {{ name: a, on: root, at: {}, joint: {a}, mass: 1.5, cg: {}, inertia: {}{axes} }}\n      \
         - {{ name: b, on: a, at: {}, joint: {b}, mass: 0.7, cg: {}, inertia: {} }}\n      \
         - {{ name: c, on: root, at: {}, joint: {c}, mass: 1.1, cg: {}, inertia: {} }}\n\
         run: {{ duration: 1 s, every: 0.1 s }}\n",
        vector(0.1, -0.05, 0.2),
        inertia(0.3, 0.25, 0.2),
        vector(0.2, 0.1, 0.4),
        vector(-0.1, 0.15, 0.3),
        inertia(0.11, 0.1, 0.07),
        vector(0.05, -0.1, 0.5),
        vector(0.1, 0.02, -0.2),
        inertia(0.05, 0.06, 0.04),
        vector(-0.3, 0.2, 0.1),
        vector(0.0, 0.1, -0.25),
        inertia(0.08, 0.09, 0.1),
    )
}

/// Checks S, r_s and v̇ of a model: v̇ by both routes against S⁻¹ (r_s + r_k), and S and r_s against Lagrange if v =
/// q̇.
fn check(text: &str, states: usize) {
    let model = read(text);
    let [equations, by_matrix] =
        [Route::Elimination, Route::MassMatrix].map(|route| derived(&model, route));
    let n = equations.velocities.len();
    if n == 0 {
        return;
    }
    let mut numbers = Numbers(0.1);
    let oracle = (equations.quaternions.is_empty()).then(|| lagrange(&model).expect("algebra"));
    for _ in 0..states {
        let mut q = numbers.list(equations.coordinates.len(), 1.2);
        for range in &equations.quaternions {
            let length = q[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
            q[range.clone()].iter_mut().for_each(|x| *x /= length);
        }
        let v = numbers.list(n, 3.0);
        let flat = values(&equations, &equations.mass_matrix.concat(), &q, &v);
        let s = DMatrix::from_row_slice(n, n, &flat);
        assert_eq!(s, s.transpose(), "S is symmetric to the last bit\n{text}");
        let r_s = values(&equations, &equations.velocity_forces, &q, &v);
        let r_k = values(&equations, &equations.applied_forces, &q, &v);
        if let Some(oracle) = &oracle {
            let charts = vec![0.0; equations.charts];
            let inputs = Inputs {
                time: 0.0,
                coordinates: &q,
                velocities: &v,
                parameters: &[],
                auxiliaries: &[],
                memory: &charts,
                accelerations: &[],
            };
            let roots = [oracle.mass_matrix.concat(), oracle.velocity_forces.clone()].concat();
            let expected = evaluate(&oracle.graph, &roots, &inputs, &|f, a: &[f64]| {
                choices(f, a)
            });
            let (of_s, of_r) = expected.split_at(n * n);
            let scale = largest(of_s);
            assert!(
                apart(&flat, of_s) <= 1e-12 * scale,
                "S: {:e}\n{text}",
                apart(&flat, of_s)
            );
            // an inertia times two rates
            let scale = scale * largest(&v).powi(2);
            assert!(
                apart(&r_s, of_r) <= 1e-12 * scale,
                "r_s: {:e}\n{text}",
                apart(&r_s, of_r)
            );
        }
        let right = DVector::from_iterator(n, r_s.iter().zip(&r_k).map(|(a, b)| a + b));
        let solved = s
            .clone()
            .cholesky()
            .expect("positive definite")
            .solve(&right);
        let condition = {
            let eigenvalues = s.symmetric_eigenvalues();
            eigenvalues.max() / eigenvalues.min()
        };
        // both are backward stable: they differ by the rounding of S times its condition
        let bound = 1e3 * f64::EPSILON * condition * largest(solved.as_slice());
        for equations in [&equations, &by_matrix] {
            let ours = values(equations, &equations.accelerations, &q, &v);
            let difference = apart(&ours, solved.as_slice());
            assert!(
                difference <= bound,
                "{:?}: {difference:e} of {bound:e}\n{text}",
                equations.route
            );
        }
    }
}

#[test]
fn every_joint_on_every_other_in_space() {
    let mut texts = Vec::new();
    for coordinates in ["bryant", "quaternion"] {
        for (i, first) in IN_SPACE.iter().enumerate() {
            for (j, second) in IN_SPACE.iter().enumerate() {
                let other = IN_SPACE[(i + 3 * j + 1) % IN_SPACE.len()];
                let reference = if (i + j) % 2 == 0 { "free" } else { "fixed" };
                let joints = ["ball", first, second, other];
                texts.push(tree(3, coordinates, reference, joints));
            }
        }
    }
    for text in share(20, texts) {
        check(&text, 2);
    }
}

#[test]
fn every_joint_as_root_in_space() {
    let mut texts = Vec::new();
    for coordinates in ["bryant", "quaternion"] {
        for (i, first) in IN_SPACE.iter().enumerate() {
            for reference in ["fixed", "free"] {
                let next = |k: usize| IN_SPACE[(i + k) % IN_SPACE.len()];
                let slides = ["slider", "cylinder", "planar", "translation", "free"];
                // a reference joint and a root that both slide move in the same way
                if reference == "free" && slides.iter().any(|word| first.contains(word)) {
                    let text = tree(3, coordinates, reference, [first, "ball", "ball", "ball"]);
                    assert!(refused(&text).contains("without any inertia"), "{text}");
                    continue;
                }
                let joints = [first, next(3), next(5), next(8)];
                texts.push(tree(3, coordinates, reference, joints));
            }
        }
    }
    for text in share(6, texts) {
        check(&text, 3);
    }
}

#[test]
fn every_joint_on_every_other_in_the_plane() {
    let count = IN_PLANE.len();
    let mut texts = Vec::new();
    for (i, root) in IN_PLANE.into_iter().enumerate() {
        for (j, first) in IN_PLANE.into_iter().enumerate() {
            // every pair of the three occurs
            for second in [0, 3, 6].map(|k| IN_PLANE[(i + 2 * j + k) % count]) {
                for reference in ["fixed", "free"] {
                    // the reference joint and a root that slides would move twice in the same way
                    let twice = reference == "free"
                        && !matches!(root, "weld" | "hinge" | "{ hinge: -y, zero: 0.3 }");
                    if !twice {
                        let joints = [root, first, second, "{ hinge: y }"];
                        texts.push(tree(2, "", reference, joints));
                    }
                }
            }
        }
    }
    for text in share(20, texts) {
        check(&text, 2);
    }
}

#[test]
fn freedoms_that_follow_others_and_rotors_in_space() {
    let follows = |joint: &str, what: &str| {
        format!("{joint}, follows: {{ joint: {what}, ratio: -0.7, offset: 0.2 }} }}")
    };
    let leaders = [
        "{ hinge: [0, 0.2, 1], armature: 0.3 }",
        "{ slider: x, zero: 0.1, armature: 0.4 }",
        "{ screw: y, pitch: 0.4, armature: 0.2 }",
    ];
    let followers = [
        "{ hinge: [1, -2, 0.5], zero: 30 deg, armature: 0.1",
        "{ slider: [0.3, 1, -1], armature: 0.6",
        "{ screw: z, pitch: -0.3",
    ];
    let mut texts = Vec::new();
    for (i, leader) in leaders.into_iter().enumerate() {
        for (j, follower) in followers.into_iter().enumerate() {
            for (reference, root) in [("free", "ball"), ("fixed", "{ hinge: y }")] {
                for coordinates in ["bryant", "quaternion"] {
                    let other = leaders[(i + j) % 3];
                    let [of_a, of_b, of_c] = ["a", "b", "c"].map(|led| follows(follower, led));
                    // within a list, and from one list to another
                    let list = format!(
                        "[{{ slider: y, name: p }}, {}, {{ hinge: x, name: r }}]",
                        follows(follower, "b, freedom: angle").replacen("{ ", "{ name: q, ", 1)
                    );
                    let led = "[{ hinge: z, armature: 0.2, name: angle }, { slider: x, follows: { joint: b, freedom: angle, ratio: 0.4 } }]";
                    // outboard of the leader; beside it; inboard of it; two followers of one leader, in a chain of
                    // followers
                    for joints in [
                        [root, leader, &of_a, other],
                        [root, leader, other, &of_b],
                        [root, &of_b, leader, other],
                        [root, leader, &of_c, &of_a],
                        [root, &of_c, "ball", leader],
                        [root, &list, led, leader],
                    ] {
                        texts.push(tree(3, coordinates, reference, joints));
                    }
                }
            }
        }
    }
    for text in share(20, texts) {
        check(&text, 2);
    }
}

#[test]
fn freedoms_that_follow_others_and_rotors_in_the_plane() {
    for leader in [
        "{ hinge: y, armature: 0.3 }",
        "{ slider: [1, 2], armature: 0.1 }",
    ] {
        for follower in ["{ hinge: y, armature: 0.2", "{ slider: x"] {
            let with =
                |joint: &str| format!("{follower}, follows: {{ joint: {joint}, ratio: 1.3 }} }}");
            for (reference, root) in [("free", "hinge"), ("fixed", "{ hinge: y }")] {
                check(
                    &tree(2, "", reference, [root, leader, &with("a"), "hinge"]),
                    2,
                );
                check(
                    &tree(2, "", reference, [root, &with("c"), "hinge", leader]),
                    2,
                );
            }
        }
    }
}

#[test]
fn gears_move_as_their_ratio_says() {
    // two geared wheels on fixed axes, both damped: (J + n² K) q̈ = −(d + n² e) q̇
    let text = "model: gears\ndimension: 3\nsystems:\n  - name: s\n    reference: fixed\n    elements:\n      \
        - { name: frame-part, joint: weld, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }\n      \
        - { name: pinion, on: frame-part, at: [0, 0, 0], joint: { hinge: z, armature: 0.05 }, mass: 1, cg: [0, 0, 0], inertia: [0.1, 0.1, 0.2] }\n      \
        - { name: wheel, on: frame-part, at: [0.3, 0, 0], joint: { hinge: z, follows: { joint: pinion, ratio: -1/3, offset: 10 deg } }, mass: 9, cg: [0, 0, 0], inertia: [1, 1, 1.8] }\n    \
        start: { joints: { pinion: 0.5 }, joint_rates: { pinion: 3 } }\n\
        forces:\n  - { joint: s/pinion, damping: 4 }\n  - { joint: s/wheel, name: brake, damping: 0.9 }\n\
        outputs:\n  - { name: turned, of: joint s/wheel, what: angle }\n  - { name: speed, of: joint s/wheel, what: rate }\n  - { name: acceleration, of: joint s/wheel, what: acceleration }\n\
        run: { duration: 1 s, every: 0.1 s }\n";
    let equations = derived(&read(text), Route::Elimination);
    assert_eq!(equations.velocities.len(), 1);
    let (q, v) = (0.5, 3.0);
    let found = values(&equations, &equations.accelerations, &[q], &[v])[0];
    let expected = -(4.0 + 0.9 / 9.0) * v / (0.2 + 0.05 + 1.8 / 9.0);
    assert!(
        (found - expected).abs() < 1e-14 * expected.abs(),
        "{found} {expected}"
    );
    let outputs = values(&equations, &equations.outputs, &[q], &[v]);
    let wheel = [10f64.to_radians() - q / 3.0, -v / 3.0, -expected / 3.0];
    assert!(
        apart(&outputs, &wheel) < 1e-14 * expected.abs(),
        "{outputs:?} {wheel:?}"
    );
    let energy = values(
        &equations,
        &[equations.section(Method::KineticEnergy)[0].value],
        &[q],
        &[v],
    )[0];
    assert!(
        (energy - 0.5 * (0.25 + 0.2) * 9.0).abs() < 1e-14,
        "{energy}"
    );
}

/// One element in space on a joint, and the rest of the text.
fn element(joint: &str, rest: &str) -> String {
    format!(
        "model: one\ndimension: 3\nsystems:\n  - name: s\n    reference: fixed\n    elements:\n      \
         - {{ name: body, joint: {joint}, mass: 1, cg: [0.1, 0, 0], inertia: [1, 1, 1] }}\n{rest}run: {{ duration: 1 s, every: 0.1 s }}\n"
    )
}

// Long: a line for each mistake.
#[test]
fn mistakes_are_told_with_their_remedy() {
    let joints = [
        ("{ hinge: [0, 0, 0] }", "the axis has no direction"),
        ("{ hinge: [1, 2] }", "3"),
        ("{ hinge: q }", "`x`, `y`, `z`"),
        ("hinge", "in space a hinge needs an axis"),
        ("hinged", "did you mean `hinge`?"),
        (
            "{ hinge: x, slider: y }",
            "a joint cannot be hinge and slider at once",
        ),
        ("{ zero: 3 }", "this does not say which joint it is"),
        ("[weld, { hinge: x }]", "a joint of a list has keys"),
        ("{ screw: x }", "a screw needs its pitch"),
        ("{ hinge: x, pitch: 1 }", "a hinge has no pitch"),
        ("{ hinge: x, zero: 3 m }", "an angle is needed here"),
        ("{ slider: x, zero: 3 deg }", "a length is needed here"),
        ("{ universal: [x] }", "a universal joint has two axes"),
        (
            "{ universal: [x, x] }",
            "two freedoms of this joint are called \"angle-x\"",
        ),
        (
            "{ universal: [x, [2, 0, 0]] }",
            "can move without any inertia",
        ),
        (
            "[{ slider: x }, { slider: y }, { slider: [1, 1, 0], name: c }]",
            "can move without any inertia",
        ),
        ("{ cylinder: x, zero: 1 }", "`zero` does not say which"),
        (
            "{ planar: [1, 1, 0] }",
            "the normal of a planar joint is one of the axes",
        ),
        (
            "[{ hinge: x }, { hinge: x }]",
            "two freedoms of this joint are called",
        ),
        (
            "[{ slider: x }, { slider: y }, { slider: z }, { hinge: x }, { hinge: y }, { hinge: z }, { hinge: x, name: more }]",
            "more than an element can have",
        ),
        ("[{ hinge: x, name: Bad Name }]", "Bad Name"),
        ("{ hinge: x, armature: -1 }", "must not be negative"),
        (
            "{ hinge: x, armature: 1 kg }",
            "a moment of inertia is needed here",
        ),
        (
            "{ universal: [x, y], armature: 1 }",
            "`armature` does not say which",
        ),
        (
            "{ universal: [x, y], follows: { joint: body } }",
            "`follows` does not say which",
        ),
        (
            "{ hinge: x, follows: { joint: body } }",
            "this freedom follows itself",
        ),
        (
            "{ hinge: x, follows: { joint: bodi } }",
            "has no element \"bodi\"",
        ),
        (
            "{ hinge: x, follows: { ratio: 2 } }",
            "lacks the key \"joint\"",
        ),
        (
            "[{ hinge: x, name: a }, { hinge: y, name: b, follows: { joint: body } }]",
            "several freedoms",
        ),
        (
            "[{ hinge: x, name: a }, { hinge: y, name: b, follows: { joint: body, freedom: d } }]",
            "has no freedom \"d\"",
        ),
        (
            "[{ hinge: x, name: a, follows: { joint: body, freedom: b } }, { hinge: y, name: b, follows: { joint: body, freedom: a } }]",
            "2 freedoms follow each other in a circle",
        ),
        (
            "[{ hinge: x, name: a }, { slider: y, name: b, follows: { joint: body, freedom: a, ratio: 2 kg } }]",
            "a length per angle is needed here",
        ),
        (
            "[{ hinge: x, name: a }, { slider: y, name: b, follows: { joint: body, freedom: a, offset: 2 deg } }]",
            "a length is needed here",
        ),
    ];
    for (joint, expected) in joints {
        let said = refused(&element(joint, ""));
        assert!(said.contains(expected), "{joint}: {said}");
    }
    let hinge = "{ hinge: x }";
    let list = "[{ hinge: x, name: a }, { slider: y, name: b }]";
    let others = [
        (
            hinge,
            "    start: { angles: { body: [1, 2, 3] } }\n",
            "write it below `joints`",
        ),
        (
            hinge,
            "    start: { joints: { body: [1, 2] } }\n",
            "has 1 freedoms, but here stand 2 values",
        ),
        (
            hinge,
            "    start: { joints: { body: 1 m } }\n",
            "an angle is needed here",
        ),
        (
            "weld",
            "    start: { joints: { body: 1 } }\n",
            "has 0 freedoms",
        ),
        (
            "ball",
            "    start: { joints: { body: 1 } }\n",
            "give `angles`",
        ),
        (
            "weld",
            "forces: [{ joint: s/body, damping: 1 }]\n",
            "is welded",
        ),
        (
            list,
            "forces: [{ joint: s/body, damping: 1 }]\n",
            "add `freedom:` with one of `a`, `b`",
        ),
        (
            list,
            "forces: [{ joint: s/body, freedom: c, damping: 1 }]\n",
            "has no freedom \"c\"",
        ),
        (
            list,
            "forces: [{ joint: s/body, freedom: b, stiffness: 3 N*m }]\n",
            "a stiffness is needed here",
        ),
        (
            hinge,
            "forces: [{ joint: s/body, about: { x: { damping: 1 } } }]\n",
            "is no ball",
        ),
        (
            "ball",
            "forces: [{ joint: s/body, freedom: x, about: { x: { damping: 1 } } }]\n",
            "no freedoms of its own",
        ),
        (
            "[{ hinge: x, name: a }, { hinge: y, name: b, follows: { joint: body, freedom: a } }]",
            "    start: { joints: { body: [1, 2] } }\n",
            "has 1 freedoms that follow no other",
        ),
        (
            hinge,
            "forces: [{ joint: s/body, damping: -1 }]\n",
            "must not be negative",
        ),
        (
            hinge,
            "outputs: [{ name: q, of: joint s/body, what: position }]\n",
            "has no quantity \"position\"",
        ),
        (
            list,
            "outputs: [{ name: q, of: joint s/body, what: angle }]\n",
            "several freedoms",
        ),
        (
            hinge,
            "outputs: [{ name: q, of: joint s/body, what: angle, about: x }]\n",
            "means nothing",
        ),
    ];
    for (joint, rest, expected) in others {
        let said = refused(&element(joint, rest));
        assert!(said.contains(expected), "{joint} {rest}: {said}");
    }
    let planar = |joint: &str| {
        let text = element(joint, "").replace("dimension: 3", "dimension: 2");
        refused(
            &text
                .replace("[0.1, 0, 0]", "[0.1, 0]")
                .replace("[1, 1, 1]", "1"),
        )
    };
    for (joint, expected) in [
        ("ball", "in the plane there is no ball joint"),
        ("{ hinge: x }", "in the plane nothing turns about x"),
        ("{ slider: y }", "in the plane nothing slides along y"),
        ("{ screw: y, pitch: 1 }", "leads out of the plane"),
    ] {
        assert!(
            planar(joint).contains(expected),
            "{joint}: {}",
            planar(joint)
        );
    }
    let mirrored = "model: one\ndimension: 3\nsystems:\n  - name: s\n    elements:\n      \
         - { name: body, mass: 1, cg: [0.1, 0, 0], inertia: [1, 1, 1] }\n      \
         - { name: left-arm, on: body, at: [0, 1, 0], mirror: true, joint: { hinge: x, follows: { joint: neck } }, mass: 1, cg: [0.1, 0, 0], inertia: [1, 1, 1] }\n\
         run: { duration: 1 s, every: 0.1 s }\n";
    assert!(refused(mirrored).contains("has no mirror image"));
    let on_a_ball = "model: one\ndimension: 3\nsystems:\n  - name: s\n    elements:\n      \
         - { name: body, mass: 1, cg: [0.1, 0, 0], inertia: [1, 1, 1] }\n      \
         - { name: arm, on: body, at: [0, 1, 0], joint: { hinge: x, follows: { joint: body } }, mass: 1, cg: [0.1, 0, 0], inertia: [1, 1, 1] }\n\
         run: { duration: 1 s, every: 0.1 s }\n";
    assert!(refused(on_a_ball).contains("there is no ratio to an orientation"));
    let element = |name: &str, joint: &str| {
        format!(
            "  - name: {name}\n    reference: fixed\n    elements: [{{ name: {name}-arm, joint: {joint}, mass: 1, cg: [0.1, 0, 0], inertia: [1, 1, 1] }}]\n"
        )
    };
    for leader in ["one/one-arm", "one-arm"] {
        let follower = format!("{{ hinge: x, follows: {{ joint: {leader} }} }}");
        let (one, other) = (element("one", "{ hinge: x }"), element("other", &follower));
        let text = format!(
            "model: two\ndimension: 3\nsystems:\n{one}{other}run: {{ duration: 1 s, every: 0.1 s }}\n"
        );
        let said = refused(&text);
        assert!(said.contains("of its own system alone"), "{said}");
    }
}

#[test]
fn the_length_of_an_axis_does_not_matter() {
    // also where squares of its components overflow, or have lost their digits
    let of = |axis: &str| read(&element(&format!("{{ hinge: {axis} }}"), ""));
    let model = of("[1, 2, 0]");
    for axis in [
        "[1e200, 2e200, 0]",
        "[1e-170, 2e-170, 0]",
        "[3e-310, 6e-310, 0]",
    ] {
        let [found, expected] = [&of(axis), &model].map(|model| {
            let axis = &model.systems[0].elements[0].joint.freedoms()[0].axis;
            axis.each_ref().map(|a| a.value(&[]))
        });
        for (found, expected) in found.into_iter().zip(expected) {
            // of the last, components themselves have eleven digits
            assert!(
                (found - expected).abs() < 1e-10,
                "{axis}: {found} {expected}"
            );
        }
    }
}

#[test]
fn a_ball_that_is_named_leaves_no_trace() {
    let [named, not] = [", joint: ball", ""].map(|joint| {
        format!(
            "model: one\ndimension: 3\nsystems:\n  - name: s\n    elements: [{{ name: body{joint}, mass: 1, cg: [0.1, 0, 0], inertia: [1, 2, 2] }}]\nrun: {{ duration: 1 s, every: 0.1 s }}\n"
        )
    });
    assert_eq!(read(&named), read(&not));
    assert_eq!(read(&named).digest, read(&not).digest);
}
