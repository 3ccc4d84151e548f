use bryant_study::criteria::limits::{Limit, all, find};
use bryant_study::criteria::{CRITERIA, Measure};

#[test]
fn every_limit_is_of_a_criterion_and_positive() {
    let all = all();
    assert!(all.len() >= 6);
    for limits in &all {
        for (name, limit) in &limits.limits {
            let criterion = CRITERIA.iter().find(|one| one.name == name).unwrap();
            match limit {
                Limit::Constant(limit) => assert!(*limit > 0.0, "{name}"),
                Limit::Falling(_) => {
                    assert!(limits.falling(criterion).is_some(), "{name}");
                    // others have no levels that last
                    assert!(matches!(criterion.measure, Measure::Of(..)), "{name}");
                }
            }
        }
        for (name, class) in &limits.filters {
            let criterion = CRITERIA.iter().find(|one| one.name == name).unwrap();
            let found = criterion.class(limits).unwrap();
            assert_eq!(found.number(), *class, "{name}");
            assert!(limits.limits.contains_key(name), "{name}");
        }
        // criteria that need additional values have them
        assert_eq!(limits.limits.contains_key("Nij"), limits.nij.is_some());
        assert_eq!(limits.limits.contains_key("VC"), limits.chest.is_some());
        let of_tibia = limits.limits.contains_key("tibia left");
        assert_eq!(of_tibia, limits.tibia.is_some());
        // what is judged on one side is judged on the other
        for (name, limit) in &limits.limits {
            if let Some(part) = name.strip_suffix("left") {
                let other = limits.limits.get(&format!("{part}right"));
                assert_eq!(other, Some(limit), "{name}");
            }
        }
    }
}

/// The limits of UN R94 and R137 as the program pyisomme 0.0.3 has them.
#[test]
fn limits_are_those_of_their_source() {
    let of = |standard: &str, dummy: &str, name: &str| {
        let limits = find(standard, dummy).unwrap();
        limits.limits[name].text("")
    };
    for (name, limit) in [
        ("neck tension", "3300 at 0 ms, 2900 at 35 ms, 1100 at 60 ms"),
        (
            "neck shear",
            "3100 at 0 ms, 1500 at 25 ms, 1500 at 35 ms, 1100 at 45 ms",
        ),
        ("femur right", "9070 at 0 ms, 7580 at 10 ms"),
        ("knee left", "15"),
        ("tibia force left", "8000"),
    ] {
        assert_eq!(of("UN R94", "Hybrid III 50M", name), limit, "{name}");
    }
    for (name, driver, passenger) in [
        ("HIC36", "1000", "1000"),
        ("head 3 ms", "80", "80"),
        ("neck tension", "3300", "2900"),
        ("neck shear", "3100", "2900"),
        ("neck extension", "57", "57"),
        ("chest deflection", "42", "34"),
        ("VC", "1", "1"),
        ("femur left", "9070", "7000"),
    ] {
        assert_eq!(of("UN R137", "Hybrid III 50M", name), driver, "{name}");
        assert_eq!(of("UN R137", "Hybrid III 5F", name), passenger, "{name}");
    }
}
