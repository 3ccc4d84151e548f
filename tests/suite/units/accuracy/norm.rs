use bryant::accuracy::norm::{Names, Norm};

fn strings(names: &[&str]) -> Vec<String> {
    names.iter().map(|n| n.to_string()).collect()
}

fn run(states: &[&[f64]]) -> Vec<Vec<f64>> {
    states.iter().map(|s| s.to_vec()).collect()
}

fn norm(coordinates: &[&str], velocities: &[&str], auxiliaries: &[&str], r: &[Vec<f64>]) -> Norm {
    let [coordinates, velocities, auxiliaries] =
        [coordinates, velocities, auxiliaries].map(strings);
    Norm::of(
        Names {
            coordinates: &coordinates,
            velocities: &velocities,
            auxiliaries: &auxiliaries,
        },
        r,
    )
}

#[test]
fn positions_and_angles_are_relative_to_their_range() {
    // x goes from 100 to 102, phi from 1 to 5; their rates reach 4 and 8
    let reference = run(&[&[100.0, 1.0, -4.0, 8.0], &[102.0, 5.0, 2.0, 0.0]]);
    let norm = norm(&["a.x", "a/b.phi"], &["a.vx", "a/b.omega"], &[], &reference);
    let of = |y: &[f64]| norm.error(&reference, &run(&[&[100.0, 1.0, -4.0, 8.0], y]));
    assert_eq!(of(&[102.0, 5.0, 2.0, 0.0]).error, 0.0);
    let x = of(&[102.5, 5.0, 2.0, 0.0]);
    assert_eq!((x.error, x.entry.as_str()), (0.25, "a.x"));
    let phi = of(&[102.0, 5.5, 2.0, 0.0]);
    assert_eq!((phi.error, phi.entry.as_str()), (0.125, "a/b.phi"));
    assert_eq!(of(&[102.0, 5.0, 2.5, 0.0]).error, 0.125);
    assert_eq!(of(&[102.0, 5.0, 2.0, 1.0]).error, 0.125);
    assert_eq!(of(&[102.0, 5.0, f64::NAN, 1.0]).error, f64::INFINITY);
    assert_eq!(
        norm.error(&reference, &run(&[&[100.0; 4]])).error,
        f64::INFINITY
    );
}

#[test]
fn what_hardly_moves_is_measured_by_its_companions() {
    let reference = run(&[&[0.0, 0.0, 1.0, 0.0], &[10.0, 1e-12, 1.0, 0.0]]);
    let norm = norm(
        &["a.x", "a.z", "a/b.phi"],
        &[],
        &["muscle: state"],
        &reference,
    );
    let of = |y: &[f64]| {
        norm.error(&reference, &run(&[&[0.0, 0.0, 1.0, 0.0], y]))
            .error
    };
    // a hundredth of the 10 m along x
    let expected = (1e-3 - 1e-12) / 0.1;
    assert!((of(&[10.0, 1e-3, 1.0, 0.0]) - expected).abs() < 1e-15);
    // no angle moves, so that the error is in radians; no such state moves, so that the error is in its unit
    assert!((of(&[10.0, 1e-12, 1.5, 0.0]) - 0.5).abs() < 1e-15);
    assert!((of(&[10.0, 1e-12, 1.0, 0.25]) - 0.25).abs() < 1e-15);
}

#[test]
fn orientations_differ_by_an_angle_whatever_the_sign() {
    let about_z = |angle: f64| [(0.5 * angle).cos(), 0.0, 0.0, (0.5 * angle).sin()];
    let names = ["a/b.qw", "a/b.qx", "a/b.qy", "a/b.qz"];
    let reference = run(&[&about_z(0.3), &about_z(2.3)]);
    let norm = norm(&names, &[], &[], &reference);
    let of = |q: [f64; 4]| norm.error(&reference, &run(&[&about_z(0.3), &q]));
    let off = of(about_z(2.31));
    // 0.01 of 2 rad
    assert!((off.error - 5e-3).abs() < 1e-14, "{off:?}");
    assert_eq!(off.entry, "a/b");
    assert!(of(about_z(2.3).map(|q| -q)).error < 1e-15);
    // A whole turn less 0.1 rad is an error of 0.1 rad.
    let turn = of(about_z(2.3 + 2.0 * std::f64::consts::PI - 0.1));
    assert!((turn.error - 0.05).abs() < 1e-14);
}
