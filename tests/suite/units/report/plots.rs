use bryant::report::plots::{Measurand, plots};

fn at(what: &str, place: &str) -> Measurand {
    Measurand {
        what: what.into(),
        place: place.into(),
    }
}

#[test]
fn components_stand_together_and_lonely_outputs_with_their_like() {
    let places = [
        at("acceleration", "head"),
        at("belt force", "lap"),
        at("acceleration", "head"),
        at("acceleration", "chest"),
        at("belt force", "shoulder"),
        at("acceleration", "pelvis"),
        at("belt force", "crotch"),
    ];
    let units = ["g", "N", "g", "g", "N", "g", "kN"];
    let names = ["a", "b", "c", "d", "e", "f", "g"];
    let found = plots(&places, &units, &names, &[1.0; 7]);
    let found: Vec<(&str, &[usize])> = found
        .iter()
        .map(|plot| (plot.title.as_str(), &plot.curves[..]))
        .collect();
    let expected: [(&str, &[usize]); 4] = [
        ("acceleration, head", &[0, 2]),
        ("belt force", &[1, 4]),
        ("acceleration", &[3, 5]),
        // another unit has an axis of its own
        ("g", &[6]),
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_plot_has_six_curves_and_small_ones_are_not_beside_large_ones() {
    let places: Vec<Measurand> = (0..14)
        .map(|k| at("contact force", &k.to_string()))
        .collect();
    let sizes: Vec<f64> = (0..14)
        .map(|k| if k % 3 == 0 { 1e4 } else { f64::from(k) })
        .collect();
    let found = plots(&places, &["N"; 14], &["x"; 14], &sizes);
    assert_eq!(found.len(), 3);
    assert_eq!(found[0].curves, [0, 3, 6, 9, 12]);
    assert!(found.iter().all(|plot| plot.curves.len() <= 6));
    let mut all: Vec<usize> = found.iter().flat_map(|plot| plot.curves.clone()).collect();
    all.sort_unstable();
    assert_eq!(all, (0..14).collect::<Vec<_>>());
    assert_eq!(found[2].title, "contact force, 3 of 3");
}
