use bryant::animation::turn::{along, continuous};
use bryant::pose::rotation;

#[test]
fn a_rod_is_turned_from_one_end_to_the_other() {
    for to in [
        [0.3, -0.2, 0.9],
        [0.0, 0.0, -2.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.0, 3.0],
    ] {
        let ([a, b, c, w], length) = along([0.0; 3], to);
        let tip = rotation(&[w, a, b, c]).map(|row| length * row[2]);
        assert!(
            tip.iter().zip(to).all(|(x, y)| (x - y).abs() < 1e-12),
            "{tip:?} {to:?}"
        );
    }
}

#[test]
fn turns_do_not_jump() {
    let turns = continuous(vec![[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -0.1, -0.99]]);
    assert!(turns[1][3] > 0.0 && turns[1][2] > 0.0);
}
