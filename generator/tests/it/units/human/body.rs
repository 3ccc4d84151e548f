use bryant_generator::human::{Body, Person, Sex, Size, body};

fn made(sex: Sex, stature: f64, mass: f64) -> Result<Body, String> {
    body(&Person::Size(Size { sex, stature, mass }))
}

/// A man of 77.7 kg and 1.753 m and a woman of 49 kg and 1.501 m, derived independently from the same table, printed to
/// four decimals (moments to six).
// Long: the numbers of two bodies.
#[test]
fn bodies_are_those_of_an_independent_derivation() {
    let man = [
        (
            "pelvis",
            8.6791,
            [0.0, 0.0, 0.0570],
            [0.070650, 0.056710, 0.064363],
        ),
        (
            "thorax",
            12.4009,
            [0.0, 0.0, 0.1203],
            [0.187928, 0.075459, 0.159337],
        ),
        (
            "head",
            5.3924,
            [0.0, 0.0, 0.1222],
            [0.029613, 0.032005, 0.021973],
        ),
        (
            "left-upper-arm",
            2.1057,
            [0.0, 0.0, -0.1637],
            [0.013760, 0.012258, 0.004229],
        ),
        (
            "left-hand",
            0.4740,
            [0.0, 0.0, -0.0686],
            [0.001407, 0.000937, 0.000574],
        ),
        (
            "left-thigh",
            11.0023,
            [0.0, 0.0, -0.1741],
            [0.215218, 0.215218, 0.044143],
        ),
        (
            "left-shank",
            3.3644,
            [0.0, 0.0, -0.1948],
            [0.041660, 0.040017, 0.006880],
        ),
        (
            "left-foot",
            1.0645,
            [0.0644, 0.0, -0.0403],
            [0.001105, 0.004315, 0.004748],
        ),
    ];
    let woman = [
        (
            "abdomen",
            7.1785,
            [0.0, 0.0, 0.0975],
            [0.042457, 0.028378, 0.039001],
        ),
        (
            "left-forearm",
            0.6762,
            [0.0, 0.0, -0.1042],
            [0.002408, 0.002335, 0.000312],
        ),
        (
            "left-foot",
            0.6321,
            [0.0360, 0.0, -0.0346],
            [0.000476, 0.001919, 0.002204],
        ),
    ];
    let check = |sex, stature, total, expected: &[(&str, f64, [f64; 3], [f64; 3])]| {
        let body = made(sex, stature, total).unwrap();
        for (name, mass, cg, inertia) in expected {
            let element = body.elements.iter().find(|one| one.name == *name).unwrap();
            // the shares of the women sum to 0.9999; they are divided by this sum here
            assert!(
                (element.mass - mass).abs() < 6e-5 + 2e-4 * mass,
                "{name} {}",
                element.mass
            );
            for i in 0..3 {
                assert!(
                    (element.cg[i] - cg[i]).abs() < 6e-5,
                    "{name} {:?}",
                    element.cg
                );
                assert!(
                    (element.inertia[i] - inertia[i]).abs() < 6e-7 + 2e-4 * inertia[i],
                    "{name} {:?}",
                    element.inertia
                );
            }
        }
    };
    check(Sex::Male, 1.753, 77.7, &man);
    check(Sex::Female, 1.501, 49.0, &woman);
}

#[test]
fn masses_and_lengths_add_up_for_all_sizes() {
    for sex in [Sex::Female, Sex::Male] {
        for stature in [1.40, 1.55, 1.70, 1.85, 2.10] {
            for index in [15.1, 18.0, 25.0, 35.0, 44.9] {
                let total = index * stature * stature;
                let body = made(sex, stature, total).unwrap();
                assert!((body.mass() - total).abs() < 1e-9 * total);
                let part = |name: &str| body.elements.iter().find(|one| one.name == name).unwrap();
                let at = |name: &str| part(name).on.unwrap().1[2];
                // sole to hip, up the spine, and the head's length above the thorax
                let head = body.shapes.iter().find(|shape| shape.on == "head").unwrap();
                let top = body.thigh
                    + body.shank
                    + body.sole
                    + at("abdomen")
                    + at("thorax")
                    + at("head")
                    + head.center[2]
                    + head.semi_axes[2];
                assert!((top - stature).abs() < 1e-12, "{top}");
                for element in &body.elements {
                    let [a, b, c] = element.inertia;
                    assert!(
                        a > 0.0 && b > 0.0 && c > 0.0 && a < b + c && b < a + c && c < a + b,
                        "{element:?}"
                    );
                }
            }
        }
    }
    for (stature, mass) in [
        (1.2, 40.0),
        (1.75, 40.0),
        (1.75, 150.0),
        (f64::NAN, 70.0),
        (1.7, f64::NAN),
    ] {
        assert!(made(Sex::Male, stature, mass).is_err(), "{stature} {mass}");
    }
}
