//! Points with names: their mirror images, and what is refused.

use super::{engine, values};
use bryant_generator::model::Model;
use std::path::Path;

fn read(points: &str) -> Result<Model, String> {
    let text = format!(
        "model: two-arms
dimension: 3
systems:
  - name: robot
    reference: fixed
    elements:
      - {{ name: body, joint: {{ hinge: z }}, mass: 5, cg: [0, 0, 0.1], inertia: [0.1, 0.1, 0.1] }}
      - name: left-arm
        mirror: true
        on: body
        at: [0.1, 0.2, 0.3]
        joint: {{ hinge: [0.6, 0, 0.8] }}
        mass: 1
        cg: [0.2, 0, 0]
        inertia: [0.1, 0.1, 0.1]
        points: {points}
"
    );
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let read = bryant_generator::read_str("two-arms.yaml", &text, &none);
    read.map(|(model, _)| model)
        .map_err(|problems| problems.to_string())
}

#[test]
fn the_image_of_a_point_is_its_mirror_image() {
    let points = "[{ name: left-tool, at: [0.3, 0.1, 0.05], angles: [20 deg, 30 deg, 40 deg] }]";
    let model = read(points).expect("a model");
    let names = ["pose(left-tool)", "pose(right-tool)"].map(String::from);
    let engine = engine(&model, &names);
    // equal angles of the arms are mirror images of each other
    let y = [0.0, 0.7, 0.7, 0.0, 0.0, 0.0];
    let machine = engine.over::<f64>();
    let [left, right] = names.map(|name| values(&engine, &machine, &name, (0.0, &y), &[]));
    let sign = |k: usize| if k == 1 { -1.0 } else { 1.0 };
    for row in 0..3 {
        for column in 0..4 {
            // M R M and M p, with M = diag(1, -1, 1)
            let expected =
                sign(row) * left[4 * row + column] * if column < 3 { sign(column) } else { 1.0 };
            let found = right[4 * row + column];
            assert!(
                (found - expected).abs() < 1e-15,
                "{row} {column}: {found}, not {expected}"
            );
        }
    }
    assert!(
        (left[7]).abs() > 0.1,
        "the point is beside the plane of the mirror"
    );
}

#[test]
fn points_with_names_that_are_taken_or_wrong_are_refused() {
    for (points, said) in [
        (
            "[{ name: left-arm }]",
            "elements or points called \"left-arm\"",
        ),
        (
            "[{ name: left-a }, { name: left-a }]",
            "elements or points called \"left-a\"",
        ),
        ("[{ name: Left }]", "cannot be the name of a point"),
        ("[{ name: tool }]", "does not tell the sides apart"),
        ("[{ name: left-a, at: [1, 2] }]", "two-arms.yaml"),
        (
            "[{ name: left-a, axis: [1, 2, 3] }]",
            "a point has no key \"axis\"",
        ),
        ("[{ at: [0, 0, 0] }]", "a point lacks the key \"name\""),
    ] {
        let problems = read(points).expect_err(points);
        assert!(problems.contains(said), "{points}: {problems}");
    }
}
