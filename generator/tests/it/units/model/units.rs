use bryant_generator::model::units::UnitSystem;

#[test]
fn engineering_units_are_those_of_crash_tests() {
    let shown = |si: &str, value: f64| {
        let unit = UnitSystem::Engineering.unit(si);
        format!("{} {}", unit.of_si(value), unit.name)
    };
    assert_eq!(shown("m/s^2", 9.80665), "1 g");
    assert_eq!(shown("m", 0.25), "250 mm");
    assert_eq!(shown("N", 10_008.0), "10.008 kN");
    assert_eq!(shown("rad", std::f64::consts::FRAC_PI_2), "90 deg");
    assert_eq!(shown("Pa", 125_500.0), "125.5 kPa");
    assert_eq!(shown("s", 0.074), "74 ms");
    assert_eq!(shown("N*m", 31.0), "31 N*m");
    let si = UnitSystem::Si.unit("m");
    assert_eq!((si.name.as_str(), si.of_si(0.1)), ("m", 0.1));
    for name in UnitSystem::NAMES {
        assert!(UnitSystem::named(name).is_some(), "{name}");
    }
}
