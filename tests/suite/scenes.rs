//! The bundled scenes of applications run as their pages say.

use super::tables::{column, largest, run};

#[test]
fn the_driver_begins_at_rest_and_is_held() {
    // accelerometers at rest read gn; a reel of 1 N pulls the chest of 12 kg with at most 2 N, and only its tension is
    // not in balance
    let (still, _) = run("frontal", &["--set", "slack=1 N", "--duration", "1 ms"]);
    let at_start = column(&still, "chest acceleration resultant")[0];
    assert!((at_start - 9.80665).abs() < 2.0 / 12.0, "{at_start}");
    let (held, told) = run("frontal", &[]);
    assert!(!told.contains("warning"), "{told}");
    let reel = largest(&held, "belt at the reel");
    assert!((reel - 3000.0).abs() < 1e-6, "the limiter: {reel}");
    assert!(largest(&held, "bag on the head") > 0.0);
    // each device has its effect
    let chest = "chest acceleration resultant";
    let (loose, _) = run("frontal", &["--set", "pulled_in=0", "--no-verify"]);
    assert!(largest(&loose, chest) > largest(&held, chest));
    let (stiff, _) = run("frontal", &["--set", "limit=20 kN", "--no-verify"]);
    assert!(largest(&stiff, "belt at the reel") > reel);
    let (bare, _) = run("frontal", &["--set", "gas=0", "--no-verify"]);
    assert_eq!(largest(&bare, "bag on the head"), 0.0);
    assert!(largest(&bare, "head excursion") > largest(&held, "head excursion"));
}

/// The sled of the belt is in the corridor of the regulation, the manikin begins at rest and is held within the limits,
/// and each device has its effect.
#[test]
fn the_belt_holds_its_manikin_within_the_corridor() {
    let (still, _) = run(
        "belt-sled",
        &["--set", "reel_spring=1 N", "--duration", "1 ms"],
    );
    let at_start = column(&still, "chest acceleration resultant")[0];
    // as for the driver
    assert!((at_start - 9.80665).abs() < 2.0 / 12.0, "{at_start}");
    let (held, told) = run("belt-sled", &[]);
    assert!(!told.contains("warning"), "{told}");
    // limits as quoted in docs/applications/belt-sled.md
    let (chest, pelvis) = ("chest excursion", "pelvis excursion");
    assert!((0.1..0.3).contains(&largest(&held, chest)));
    assert!((0.08..0.2).contains(&largest(&held, pelvis)));
    let reel = largest(&held, "belt at the reel");
    assert!((reel - 4000.0).abs() < 1e-6, "the limiter: {reel}");
    let (soft, _) = run("belt-sled", &["--set", "limit=2 kN", "--no-verify"]);
    assert!(largest(&soft, chest) > largest(&held, chest));
    let (stiff, _) = run("belt-sled", &["--set", "stiffness=1.6", "--no-verify"]);
    assert!(largest(&stiff, pelvis) < largest(&held, pelvis));
}

/// Searle and Searle (SAE 831622, 1983): a pedestrian who is thrown at the speed v and slides with μ comes to rest
/// between v²/(2 μ g) and (1 + μ²) v²/(2 μ g).
#[test]
fn the_pedestrian_is_thrown_as_far_as_published_bounds_say() {
    let long = [
        "--set",
        "speed=30 km/h",
        "--duration",
        "3.5 s",
        "--every",
        "5 ms",
        // the motion on the ground is chaotic
        "--accuracy",
        "1%",
    ];
    let (thrown, _) = run("pedestrian", &long);
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
    assert!(largest(&thrown, "head on the windscreen") > 0.0);
}

/// The child restraint is within the limits of both fields, its harness and its belt hold it, and slack makes it worse.
#[test]
fn the_child_restraint_keeps_its_limits() {
    // limits as quoted in docs/applications/child-restraint.md
    let (head, chest) = ("head excursion", "chest acceleration resultant");
    for field in [["r44=1", "fmvss=0"], ["r44=0", "fmvss=1"]] {
        let (held, told) = run("child-restraint", &["--set", field[0], "--set", field[1]]);
        assert!(!told.contains("warning"), "{told}");
        assert!(largest(&held, head) < 0.55);
        assert!(largest(&held, "knee excursion") < 0.915);
        // nothing pulls or pushes at the start
        assert_eq!(column(&held, chest)[0], 0.0);
        assert_eq!(column(&held, "vehicle belt")[0], 0.0);
    }
    let (held, _) = run("child-restraint", &[]);
    let (loose, _) = run(
        "child-restraint",
        &["--set", "belt_slack=40 mm", "--no-verify"],
    );
    assert!(largest(&loose, chest) > largest(&held, chest));
    assert!(largest(&loose, head) > largest(&held, head));
    let (wide, _) = run(
        "child-restraint",
        &["--set", "harness_slack=60 mm", "--no-verify"],
    );
    assert!(largest(&wide, head) > largest(&held, head));
    let (below, _) = run(
        "child-restraint",
        &["--set", "anchor_x=0 mm", "--no-verify"],
    );
    assert!(largest(&below, head) > largest(&held, head));
}

/// The infant begins at rest and stays in its cot; straps, cover and padding have the effects in
/// docs/applications/carrycot.md.
#[test]
fn the_carrycot_holds_its_infant() {
    let (still, _) = run("carrycot", &["--set", "pulse=0", "--duration", "20 ms"]);
    for name in [
        "head acceleration resultant",
        "chest acceleration resultant",
    ] {
        // accelerometers at rest read gn
        let residual = column(&still, name).iter().map(|a| (a - 9.80665).abs());
        assert!(residual.fold(0.0, f64::max) < 0.0981, "{name}");
    }
    let (held, told) = run("carrycot", &[]);
    assert!(!told.contains("warning"), "{told}");
    let (head, wall) = ("head acceleration resultant", "head on the wall");
    assert!(largest(&held, wall) > 0.0);
    // the rim is 170 mm above the floor
    assert!(largest(&held, "head above the floor") < 0.17);
    let (soft, _) = run("carrycot", &["--set", "strap=0.3", "--no-verify"]);
    assert!(largest(&soft, head) < largest(&held, head));
    assert!(largest(&soft, "head forward") > largest(&held, "head forward"));
    let (bare, _) = run("carrycot", &["--set", "cover=0.001", "--no-verify"]);
    let chest = "chest acceleration resultant";
    assert!(largest(&bare, chest) > largest(&held, chest));
    let bent = |table| column(table, "neck").iter().copied().fold(0.0, f64::min);
    assert!(bent(&bare) > bent(&held));
}

/// The same as [`the_pedestrian_is_thrown_as_far_as_published_bounds_say`], in the plane; his head comes down faster
/// than the car's speed.
#[test]
fn the_pedestrian_in_the_plane_is_thrown_as_far_too() {
    let long = ["--duration", "4 s", "--every", "10 ms", "--no-verify"];
    let (thrown, _) = run("pedestrian-plane", &long);
    let far = column(&thrown, "thrown");
    let way = far[far.len() - 1] - far[0];
    assert!((far[far.len() - 1] - far[far.len() - 30]).abs() < 0.02);
    let (speed, friction) = (40.0 / 3.6, 0.6);
    let least = speed * speed / (2.0 * friction * 9.80665);
    assert!(
        (least..(1.0 + friction * friction) * least).contains(&way),
        "{way}"
    );
    let (hit, told) = run("pedestrian-plane", &[]);
    assert!(!told.contains("warning"), "{told}");
    let force = column(&hit, "head on the windscreen");
    let first = force.iter().position(|force| *force > 0.0).unwrap();
    assert!(column(&hit, "head speed against the car")[first - 1] > speed);
}
