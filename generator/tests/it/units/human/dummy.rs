use bryant_generator::human::data::Segment;
use bryant_generator::human::dummy::dummy;
use bryant_generator::human::{NAMES, Person, body};

/// Totals as printed by NHTSA, in pounds; parts are rounded to 0.01 lb.
#[test]
fn dummies_have_the_masses_that_are_printed() {
    for (name, pounds) in [
        ("child-3", 34.09),
        ("child-6", 51.60),
        ("hybrid-3-50", 172.3),
        ("hybrid-3-5", 108.03),
    ] {
        let mass = dummy(name).unwrap().mass;
        assert!((mass / 0.453_592_37 - pounds).abs() < 0.05, "{name} {mass}");
    }
    assert!(dummy("male-50").is_none());
}

/// A child's torso, neck, head and limbs, derived independently from the same page: `models/data/child-3yo.yaml`, where
/// legs and arms are pairs.
#[test]
fn the_three_year_old_is_that_of_an_independent_derivation() {
    let made = dummy("child-3").unwrap();
    let inertia = |segment: &Segment, axis: usize| {
        segment.mass * (1e-3 * segment.radii[axis] * segment.length).powi(2)
    };
    let of = &made.segments;
    // ellipsoid and cylinder about the common centre of gravity; forward offsets are left out there
    let (head, neck, distance) = (2.685, 0.748, 0.1256 - 0.038);
    let between = head * neck / (head + neck) * distance * distance;
    let expected = [
        0.00690 + 0.00060 + between,
        0.00841 + 0.00060 + between,
        0.00700 + 0.00034,
    ];
    for (axis, expected) in expected.into_iter().enumerate() {
        let found = inertia(&of.head, axis);
        assert!(
            (found / expected - 1.0).abs() < 0.03,
            "{axis} {found} {expected}"
        );
    }
    let arms = 2.0 * inertia(&of.upper_arm, 1);
    assert!((arms / 0.00216 - 1.0).abs() < 0.02, "{arms}");
    assert!((2.0 * inertia(&of.thigh, 1) / 0.00708 - 1.0).abs() < 0.02);
}

#[test]
fn a_body_is_made_of_every_name() {
    for name in NAMES {
        let body = body(&Person::named(name).unwrap()).unwrap();
        for element in &body.elements {
            let [a, b, c] = element.inertia;
            assert!(a < b + c && b < a + c && c < a + b, "{name} {element:?}");
        }
    }
}
