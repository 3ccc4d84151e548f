use bryant::orientation::{CHANGE, WithoutCharts, in_chart, without_chart};
use bryant::pose::{bryant_rotation, rotation};
use bryant_runtime::program::Header;

fn header(coordinates: &[&str], velocities: &[&str], memory: &[&str]) -> Header {
    let strings = |names: &[&str]| names.iter().map(|n| n.to_string()).collect();
    Header {
        name: "top".into(),
        digest: String::new(),
        dimension: 3,
        coordinates: strings(coordinates),
        velocities: strings(velocities),
        auxiliaries: vec!["bristle".into()],
        memory: strings(memory),
        event_functions: vec![],
        kinks: vec![],
        powers: vec![],
        outputs: vec![],
        parameters: vec![],
        duration: 1.0,
        every: 0.1,
    }
}

#[test]
fn angles_of_both_charts_become_quaternions() {
    let header = header(
        &[
            "top.x",
            "top.y",
            "top.z",
            "top/a.phi1",
            "top/a.phi2",
            "top/a.phi3",
        ],
        &[
            "top.vx",
            "top.vy",
            "top.vz",
            "top/a.dphi1",
            "top/a.dphi2",
            "top/a.dphi3",
        ],
        &["top/a: chart", "contact seat: permanent set"],
    );
    let without = WithoutCharts::of(&header);
    assert_eq!(without.coordinates[2..5], ["top.z", "top/a.qw", "top/a.qx"]);
    assert_eq!(
        without.velocities[2..],
        ["top.vz", "top/a.wx", "top/a.wy", "top/a.wz"]
    );
    let angles = [0.4, -0.7, 1.1];
    for chart in [0.0, 1.0] {
        let mut state = vec![1.0, 2.0, 3.0];
        state.extend(angles);
        state.extend([4.0, 5.0, 6.0, 0.0, 0.0, 2.0, 0.125, chart, 7.0]);
        let y = without.state(&state);
        assert_eq!(y.len(), 3 + 4 + 3 + 3 + 3);
        assert_eq!((&y[..3], &y[7..10]), (&state[..3], &state[6..9]));
        assert_eq!(y[13..], [0.125, chart, 7.0]);
        // a quarter of a turn about y takes x to −z and z to x; before that turn, the columns of A are (r₃, r₂, −r₁)
        let r = bryant_rotation(angles);
        let expected = match chart {
            0.0 => r,
            _ => r.map(|[x, y, z]| [z, y, -x]),
        };
        let ours = rotation(&y[3..7]);
        for (a, b) in ours.iter().flatten().zip(expected.iter().flatten()) {
            assert!((a - b).abs() < 8.0 * f64::EPSILON, "{ours:?} {expected:?}");
        }
        // a rate of φ₃ alone is a rotation about the third axis of R
        for i in 0..3 {
            assert!((y[10 + i] - 2.0 * r[i][2]).abs() < 8.0 * f64::EPSILON);
        }
    }
}

/// A state in quaternions becomes one in angles, in either chart, and the same again.
#[test]
fn angles_and_quaternions_convert_both_ways() {
    for angles in [[0.4, -0.7, 1.1], [2.0, 1.4, -3.0], [0.1, -1.5, 0.2]] {
        for chart in [0.0, 1.0] {
            let rates = [2.0, -0.5, 0.25];
            let (q, w) = without_chart(angles, rates, chart);
            let (found, of_found, its_chart) = in_chart(q, w);
            let (again, w_again) = without_chart(found, of_found, its_chart);
            // q and −q are the same orientation
            let sign = (0..4).map(|i| q[i] * again[i]).sum::<f64>().signum();
            for i in 0..4 {
                assert!((sign * again[i] - q[i]).abs() < 1e-14, "{angles:?} {chart}");
            }
            for i in 0..3 {
                assert!((w_again[i] - w[i]).abs() < 1e-13, "{angles:?} {chart}");
            }
            // in its chart the middle angle is far from ±90°
            assert!(found[1].sin().abs() <= CHANGE + 1e-12, "{found:?}");
        }
    }
}

#[test]
fn other_states_stay() {
    let header = header(
        &["top.x", "top/a.phi"],
        &["top.vx", "top/a.omega"],
        &["set"],
    );
    let without = WithoutCharts::of(&header);
    let state = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(without.state(&state), state);
    assert_eq!(without.q(&state), state[..2]);
    assert_eq!(without.coordinates, header.coordinates);
}
