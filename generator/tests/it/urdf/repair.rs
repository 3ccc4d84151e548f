//! Inertias that are replaced on demand.

use super::{
    INERTIAL, Options, about_y, acceleration, arm, between, derive, imported, link, read, refused,
    robot,
};

const REPAIR: Options = Options {
    repair_inertias: Some(bryant_generator::read::check_str),
    base: super::Base::Fixed,
    right_angles: false,
    stops: None,
    uncouple: false,
    inputs: false,
};

/// The model of a robot that is refused without repair, and the changes. Each stands in the model, too.
fn repaired(text: &str) -> (String, Vec<String>) {
    let found = imported(text, &REPAIR);
    read(&found.yaml);
    let changes = found
        .notes
        .iter()
        .filter_map(|n| n.strip_prefix("repaired: "));
    let changes: Vec<String> = changes.map(str::to_owned).collect();
    for change in &changes {
        let comment = format!("#   {change}");
        assert!(found.yaml.contains(&comment), "{change}\n{}", found.yaml);
    }
    (found.yaml, changes)
}

const ABOUT_Y: &str = "<axis xyz=\"0 1 0\"/>";

#[test]
fn links_without_mass_get_one_or_are_fixed() {
    // no masses at all: each link has 1 kg, half way to what it carries
    let shape = robot(&[
        link("base", ""),
        link("a", ""),
        link("b", ""),
        between("one", "continuous", "base", "a", ABOUT_Y),
        between(
            "two",
            "continuous",
            "a",
            "b",
            &format!("{ABOUT_Y}<origin xyz=\"0 0 0.8\"/>"),
        ),
    ]);
    let found = refused(&shape).to_string();
    for part in [
        "no link of this robot has a mass",
        "2 of its 3 links move: \"a\", \"b\"",
        "--repair-inertias",
    ] {
        assert!(found.contains(part), "{part}\n{found}");
    }
    let (yaml, said) = repaired(&shape);
    assert_eq!(said.len(), 3, "{said:?}");
    assert!(yaml.contains("mass: 1, cg: [0, 0, 0.4]"), "{yaml}");
    // an end without mass is fixed, what carries others gets a thousandth of the mass of the robot
    let ends = robot(&[
        link("base", ""),
        link("a", ""),
        link("b", INERTIAL),
        link("c", INERTIAL),
        link("end", ""),
        between("one", "continuous", "base", "a", ABOUT_Y),
        between("two", "continuous", "a", "b", ABOUT_Y),
        between("three", "continuous", "a", "c", ABOUT_Y),
        between("four", "continuous", "c", "end", ABOUT_Y),
    ]);
    refused(&ends);
    let (yaml, said) = repaired(&ends);
    assert!(
        said.len() == 2 && yaml.contains("mass: 4e-3"),
        "{said:?}\n{yaml}"
    );
    assert_eq!(derive(&read(&yaml)).velocities.len(), 3);
    // axes that pass each other without a mass between them
    let apart = robot(&[
        link("base", ""),
        link("cross", ""),
        link("a", INERTIAL),
        between(
            "yaw",
            "continuous",
            "base",
            "cross",
            "<axis xyz=\"0 0 1\"/>",
        ),
        between(
            "pitch",
            "continuous",
            "cross",
            "a",
            &format!("{ABOUT_Y}<origin xyz=\"0.1 0 0\"/>"),
        ),
    ]);
    refused(&apart);
    let (yaml, said) = repaired(&apart);
    assert_eq!(
        (said.len(), derive(&read(&yaml)).velocities.len()),
        (1, 2),
        "{said:?}"
    );
    // an inertia and no mass
    let only_inertia = about_y("").replace("mass value=\"2\"", "mass value=\"0\"");
    refused(&only_inertia);
    assert_eq!(repaired(&only_inertia).1.len(), 1);
}

#[test]
fn tensors_of_no_body_become_the_nearest() {
    // moments of 0.06, 0.02 and 0.015: the nearest point with a = b + c is (0.06 − 0.035) / 3 from each, along (−1,
    // 1, 1)
    let flat = about_y("").replace("ixx=\"0.01\"", "ixx=\"0.06\"");
    refused(&flat);
    let (yaml, said) = repaired(&flat);
    assert!(said.len() == 1 && said[0].contains("Frobenius"), "{said:?}");
    let off = (0.06 - 0.035) / 3.0;
    let expected = 2.0 * 9.81 * 0.1 / (0.02 + off + 2.0 * 0.1 * 0.1);
    let found = acceleration(&yaml);
    assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
    // a point of mass on its axis has the moments of a ball of water: 2/5 m r², m = 4/3 π 1000 r³
    let point = ["0.01", "0.02", "0.015"]
        .iter()
        .fold(arm("", "", ""), |text, moment| {
            text.replace(&format!("=\"{moment}\""), "=\"0\"")
        });
    let (yaml, said) = repaired(&point);
    assert!(
        said.len() == 1 && said[0].contains("turns without inertia"),
        "{said:?}"
    );
    let radius = (2.0 / (4.0 / 3.0 * std::f64::consts::PI * 1000.0)).cbrt();
    let model = read(&yaml);
    let moment = model.systems[0].elements[0].inertia[0].constant().unwrap();
    assert!(
        (moment / (0.4 * 2.0 * radius * radius) - 1.0).abs() < 1e-14,
        "{moment}"
    );
}

#[test]
fn what_needs_no_repair_is_as_it_was() {
    let sound = about_y("");
    assert_eq!(
        imported(&sound, &REPAIR).yaml,
        imported(&sound, &Options::default()).yaml
    );
    // and what no change of inertia mends is refused as before
    let wrong = sound.replace("0 1 0", "0 0 0");
    let message = |options| {
        bryant_generator::urdf::import("robot.urdf", &wrong, options)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(message(&REPAIR), message(&Options::default()));
}
