use bryant::picture::corridor::Corridor;

#[test]
fn corridors_are_read_in_units_and_refused_with_the_reason() {
    let columns = [("time", "s"), ("neck: rotation", "rad"), ("moment", "N*m")];
    let read = |text| Corridor::read(text, &columns);
    let found = read("neck: rotation: 57 ms to 0.064 s, 0.5 to 90 deg").unwrap();
    assert_eq!(found.of, "neck: rotation");
    assert_eq!(found.bounds[0], [0.057, 0.064]);
    assert_eq!(found.bounds[1], [0.5, std::f64::consts::FRAC_PI_2]);
    let open = read("moment: any, -1 to 2 N*m").unwrap();
    assert_eq!(open.bounds[0], [f64::NEG_INFINITY, f64::INFINITY]);
    for (text, told) in [
        ("moment", "not understood"),
        ("moment: 1 ms to 2 ms", "not understood"),
        ("moment: 1 ms, 2 to 3", "not understood"),
        ("force: any, any", "no column \"force\""),
        ("moment: any, 3 N to 4 N", "N*m"),
        ("moment: any, 4 to 3", "ends before"),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.contains(told), "{text}: {error}");
    }
}
