//! The bundled scenes of applications: that they run as their pages say.

use super::called::call;
use super::directory;
use super::slipping::column;
use std::fs;
use std::path::Path;

/// The table of a run of a bundled scene, which must be trusted: exit code 0, no doubt.
fn run(path: &Path, arguments: &[&str]) -> Vec<(String, Vec<f64>)> {
    let mut all = vec!["run"];
    all.extend(arguments);
    all.extend(["--csv", "run.csv", "--no-files"]);
    let (_, told) = call(path, &all, 0);
    assert!(!told.contains("warning"), "{told}");
    let text = fs::read_to_string(path.join("run.csv")).unwrap();
    let mut rows = text.lines();
    let names = rows.next().unwrap().split(',').map(str::to_owned);
    let mut columns: Vec<(String, Vec<f64>)> = names.map(|name| (name, Vec::new())).collect();
    for row in rows {
        for (cell, column) in row.split(',').zip(&mut columns) {
            column.1.push(cell.parse().unwrap());
        }
    }
    columns
}

fn largest(columns: &[(String, Vec<f64>)], name: &str) -> f64 {
    column(columns, name).iter().copied().fold(0.0, f64::max)
}

#[test]
fn the_driver_begins_at_rest_and_is_held() {
    let directory = directory();
    let path = directory.path();
    let held = run(path, &["frontal"]);
    // accelerometers of what rests read gn; the reel of 10 N is all that is not in balance
    for name in [
        "head acceleration resultant",
        "chest acceleration resultant",
    ] {
        let at_start = column(&held, name)[0];
        assert!(
            (at_start - 9.80665).abs() < 0.05 * 9.80665,
            "{name}: {at_start}"
        );
    }
    let reel = largest(&held, "belt at the reel");
    assert!((reel - 3000.0).abs() < 1e-6, "the limiter: {reel}");
    assert!(largest(&held, "bag on the head") > 100.0);
    // each device does what it is for
    let loose = run(path, &["frontal", "--set", "pulled_in=0"]);
    assert!(
        largest(&loose, "chest acceleration resultant")
            > 1.1 * largest(&held, "chest acceleration resultant")
    );
    let stiff = run(path, &["frontal", "--set", "limit=20 kN"]);
    assert!(largest(&stiff, "belt at the reel") > 1.2 * reel);
    let bare = run(path, &["frontal", "--set", "gas=0"]);
    assert_eq!(largest(&bare, "bag on the head"), 0.0);
    assert!(largest(&bare, "head excursion") > largest(&held, "head excursion") + 0.04);
}

/// Searle and Searle (SAE 831622, 1983): who is thrown at the speed v and slides with μ comes to rest within v²/(2 μ g) and (1 + μ²) v²/(2 μ g).
#[test]
fn the_pedestrian_is_thrown_as_far_as_published_bounds_say() {
    let directory = directory();
    let long = [
        "pedestrian",
        "--set",
        "speed=30 km/h",
        "--duration",
        "3.5 s",
        "--every",
        "5 ms",
    ];
    let thrown = run(directory.path(), &long);
    let far = column(&thrown, "thrown");
    let (first, last) = (far[0], far[far.len() - 1]);
    // he lies still
    assert!((last - far[far.len() - 40]).abs() < 0.01, "{last}");
    let (speed, friction) = (30.0 / 3.6, 0.6);
    let least = speed * speed / (2.0 * friction * 9.80665);
    let most = (1.0 + friction * friction) * least;
    assert!(
        (least..most).contains(&(last - first)),
        "{} in {least}..{most}",
        last - first
    );
    // the head meets the car before anything of it meets the ground
    let windscreen = column(&thrown, "head on the windscreen");
    let met = windscreen.iter().position(|force| *force > 0.0).unwrap();
    let time = column(&thrown, "time")[met];
    assert!((0.14..0.20).contains(&time), "{time}");
}
