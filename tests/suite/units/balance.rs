use bryant::balance;
use bryant::balance::{closes, joules, json};
use bryant_runtime::program::{Energy, Header};

fn header() -> Header {
    let names = |names: &[&str]| names.iter().map(|n| n.to_string()).collect();
    Header {
        name: "sled".into(),
        digest: String::new(),
        dimension: 2,
        coordinates: vec![],
        velocities: vec![],
        auxiliaries: vec![],
        memory: vec![],
        event_functions: vec![],
        kinks: vec![],
        powers: names(&["field sled", "belt chest", "joint man/head: damping"]),
        outputs: vec![],
        parameters: vec![],
        duration: 1.0,
        every: 0.1,
    }
}

fn energy(end: f64) -> Energy {
    Energy {
        start: 0.0,
        end,
        works: vec![1000.0, -900.0, -1.0],
        exchanged: 1901.0,
        momentum_gap: None,
    }
}

#[test]
fn the_work_of_each_effect_is_listed() {
    let text = balance::text(&header(), &energy(99.0));
    assert_eq!(
        text,
        "energy [J]\n  \
               kinetic energy at the start            0\n  \
               field sled                          1000\n  \
               belt chest                          -900\n  \
               joint man/head: damping               -1\n  \
               not accounted for                  0.0e0\n  \
               kinetic energy at the end             99"
    );
}

#[test]
fn one_line_says_whether_the_balance_closes() {
    let text = |gap: f64| closes(&energy(99.0 + gap));
    assert!(
        text(0.002).starts_with("closes to 2.0 mJ of 1.0 kJ"),
        "{}",
        text(0.002)
    );
    assert!(
        text(-25.0).starts_with("closes to 25 J of 1.0 kJ"),
        "{}",
        text(-25.0)
    );
    assert!(text(0.0).starts_with("closes to 0 J of"), "{}", text(0.0));
    let nothing = Energy::default();
    assert!(closes(&nothing).starts_with("there is none"));
}

#[test]
fn energies_have_the_multiple_of_a_joule_that_is_easiest_to_read() {
    for (energy, text) in [
        (412.1, "412 J"),
        (0.9996, "1.0 J"),
        (2.04e-3, "2.0 mJ"),
        (5.7e-5, "57 µJ"),
        (3.2e-11, "3e-11 J"),
        (9.96, "10 J"),
        (5.377e3, "5.4 kJ"),
    ] {
        assert_eq!(joules(energy), text);
    }
}

#[test]
fn a_gap_is_shown() {
    let text = balance::text(&header(), &energy(109.0));
    let gap = text.lines().find(|line| line.contains("not accounted for"));
    assert!(gap.is_some_and(|line| line.ends_with(" 1.0e1")), "{text}");
    let value = json(&header(), &energy(109.0));
    assert_eq!(value["not_accounted_for"], 10.0);
    assert_eq!(value["work"]["belt chest"], -900.0);
}
