//! Robots from URDF beside Pinocchio, at 20 random states of each (`reference/robots/make.py`).

use super::{engine, values};
use bryant_generator::model::Model;
use bryant_generator::urdf::{Base, Options, import};
use serde_json::Value;
use std::path::Path;

/// The largest difference, of the largest number of a result.
const ROUNDING: f64 = 1e-12;

#[test]
fn robots_agree_with_pinocchio() {
    let text = read("robots.json");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    // a link that is not a body by itself is a part of another, and a frame all the same
    let elements = &robot_model("anymal", true).systems[0].elements;
    let points: Vec<_> = elements[0]
        .points
        .iter()
        .map(|point| &*point.name)
        .collect();
    assert_eq!(points, ["base", "imu_link"]);
    for (name, robot) in all["robots"].as_object().expect("robots") {
        let model = robot_model(name, robot["free"] == true);
        let frame = robot["frame"].as_str().expect("a frame").to_lowercase();
        let of_frame = |name: &str| format!("{name}({frame})");
        let functions = [
            ("inverse_dynamics", "inverse_dynamics".to_owned()),
            ("jacobian", of_frame("jacobian")),
            ("acceleration", of_frame("acceleration")),
            ("center_of_mass", "center_of_mass".to_owned()),
            ("centroidal_momentum", "centroidal_momentum".to_owned()),
            ("kinetic_energy", "kinetic_energy".to_owned()),
            ("potential_energy", "potential_energy".to_owned()),
        ];
        let mut asked: Vec<String> = functions.iter().map(|(_, asked)| asked.clone()).collect();
        asked.push(of_frame("pose"));
        let engine = engine(&model, &asked);
        let machine = engine.over::<f64>();
        let joints = numbers_of(&robot["joints"], |joint| {
            joint.as_str().expect("a name").to_lowercase()
        });
        let base = 6 * usize::from(robot["free"] == true);
        // for each joint of Pinocchio, the place of its velocity and of its coordinate here
        let info = engine.info();
        let end = |names: &[&str], joint: &str| {
            let is = |name: &&str| {
                name.trim_end_matches("-rate").rsplit(['.', '/']).next() == Some(joint)
            };
            names
                .iter()
                .position(is)
                .unwrap_or_else(|| panic!("{joint} in {names:?}"))
        };
        let places: Vec<usize> = joints
            .iter()
            .map(|joint| end(info.velocities, joint))
            .collect();
        let coordinates: Vec<usize> = joints
            .iter()
            .map(|joint| end(info.coordinates, joint))
            .collect();
        let row = |i: usize| if i < base { i } else { places[i - base] };
        for state in robot["states"].as_array().expect("states") {
            let list = |key: &str| numbers_of(&state[key], |n| n.as_f64().expect("a number"));
            let mut y = vec![0.0; info.state_length()];
            if base > 0 {
                y[..3].copy_from_slice(&list("place"));
                y[3..7].copy_from_slice(&list("quaternion"));
            }
            for (angle, &place) in list("q").iter().zip(&coordinates) {
                y[place] = *angle;
            }
            let (v, given) = (list("v"), list("a"));
            let mut a = vec![0.0; v.len()];
            for (i, (&v, &given)) in v.iter().zip(&given).enumerate() {
                y[info.coordinates.len() + row(i)] = v;
                a[row(i)] = given;
            }
            let found = |name: &str| values(&engine, &machine, name, (0.0, &y), &a);
            for (key, function) in &functions {
                let (found, expected) = (found(function), list(key));
                // the columns of what has one for each velocity are in the order of Pinocchio
                let width = if *key == "jacobian" { v.len() } else { 1 };
                let ordered = |k: usize| match *key {
                    "jacobian" => width * (k / width) + row(k % width),
                    "inverse_dynamics" => row(k),
                    _ => k,
                };
                let size = expected.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
                for (k, expected) in expected.iter().enumerate() {
                    let found = found[ordered(k)];
                    assert!(
                        (found - expected).abs() <= ROUNDING * size,
                        "{name}: {function}[{k}] is {found}, and not {expected}"
                    );
                }
            }
            // the axes of an element are those of the root link while all joints are at 0; those of a point are the
            // link's
            let elements = model.systems.iter().flat_map(|system| &system.elements);
            let mut points = elements.flat_map(|element| &element.points);
            let is_point = points.any(|point| point.name == frame);
            let pose = found(&of_frame("pose"));
            for (k, expected) in list("pose").iter().enumerate() {
                if is_point || k % 4 == 3 {
                    let most = ROUNDING * 10.0;
                    assert!(
                        (pose[k] - expected).abs() <= most,
                        "{name}: pose[{k}] is {}, and not {expected}",
                        pose[k]
                    );
                }
            }
        }
    }
}

/// The page has the counts.
#[test]
fn inverse_dynamics_takes_fewer_operations_than_pinocchio_s() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/functions.md");
    let page = std::fs::read_to_string(page).expect("a page");
    // of Pinocchio 4.1 through CasADi with common subexpressions
    for (name, free, said, pinocchio) in [
        ("panda", false, "panda, 7 joints", 1007),
        ("ur5", false, "ur5, 6 joints", 556),
        ("anymal", true, "ANYmal B, 12 joints and a free base", 2491),
    ] {
        let model = robot_model(name, free);
        let counts = bryant_generator::Config::new()
            .functions(["inverse_dynamics"])
            .costs(&model);
        let (_, table) = counts
            .iter()
            .find(|(of, _)| *of == "inverse_dynamics")
            .expect("it");
        let total = table.total.total();
        let row = format!("| {said} | {total} | {pinocchio} |");
        assert!(page.contains(&row), "docs/functions.md: {row}");
        assert!(3 * total <= 2 * pinocchio, "{name}: {total}");
    }
}

fn robot_model(name: &str, free: bool) -> Model {
    let file = format!("{name}.urdf");
    let options = Options {
        base: if free { Base::Free } else { Base::Fixed },
        ..Options::default()
    };
    let imported = import(&file, &read(&file), &options).unwrap_or_else(|e| panic!("{e}"));
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let read = bryant_generator::read_str("robot.yaml", &imported.yaml, &none);
    read.unwrap_or_else(|e| panic!("{e}")).0
}

fn read(file: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/robots");
    std::fs::read_to_string(folder.join(file)).expect("a file")
}

fn numbers_of<T>(list: &Value, of: impl Fn(&Value) -> T) -> Vec<T> {
    list.as_array().expect("a list").iter().map(of).collect()
}
