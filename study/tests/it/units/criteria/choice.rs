use bryant_study::criteria::choice::{self, Asked, Candidate, Choice, Found, choose};

/// Candidates with these codes; `!` before a code: its channel failed.
fn chosen(codes: &[&str], asked: Asked) -> Result<Choice, String> {
    let each = codes.iter().map(|code| Candidate {
        name: code.trim_start_matches('!'),
        code: code.trim_start_matches('!'),
        doubt: code.starts_with('!').then_some("channel failed"),
    });
    choose(&each.collect::<Vec<_>>(), &asked)
}

fn patterns(all: &[(&str, &str)]) -> Asked {
    Asked {
        patterns: all
            .iter()
            .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()))
            .collect(),
        ..Asked::default()
    }
}

fn occupant(occupant: &str) -> Asked {
    Asked {
        occupant: Some(occupant.to_owned()),
        ..Asked::default()
    }
}

const TWO: [&str; 5] = [
    "11HEADCG00H3ACXP",
    "11HEADCG00H3ACZP",
    "13HEADCG00HFACXP",
    "13HEADCG00HFACYP",
    "13HEADCG00HFACZP",
];

#[test]
fn all_channels_are_of_one_occupant() {
    let error = chosen(&TWO, Asked::default()).unwrap_err();
    for told in [
        "11 (front left: head-x, head-z)",
        "13 (front right: head-x, head-y, head-z)",
        " 11",
    ] {
        assert!(error.contains(told), "{error}");
    }
    let driver = chosen(&TWO, occupant("11")).unwrap();
    assert_eq!(driver.at("head-x"), Some(&Found::Coded(vec![0])));
    assert_eq!(driver.at("head-y"), None);
    let passenger = chosen(&TWO, occupant("13")).unwrap();
    assert_eq!(passenger.found.len(), 3);
    assert_eq!(passenger.at("head-y"), Some(&Found::Coded(vec![3])));
    assert!(
        chosen(&TWO, occupant("14"))
            .unwrap_err()
            .contains("no channel of occupant 14")
    );
    // a named channel says the occupant, and two may not contradict each other
    let named = |all: &[(&str, usize)]| Asked {
        named: all
            .iter()
            .map(|(place, index)| ((*place).to_owned(), *index))
            .collect(),
        ..Asked::default()
    };
    let of_named = chosen(&TWO, named(&[("head-x", 2)])).unwrap();
    assert_eq!(of_named.at("head-z"), Some(&Found::Coded(vec![4])));
    assert!(
        chosen(&TWO, named(&[("head-x", 0), ("head-y", 3)]))
            .unwrap_err()
            .contains("name channels of one occupant")
    );
    let contradicted = Asked {
        occupant: Some("11".to_owned()),
        ..named(&[("head-y", 3)])
    };
    assert!(chosen(&TWO, contradicted).is_err());
}

#[test]
fn several_sensors_are_not_chosen_from() {
    for (codes, place, pattern, index) in [
        (
            &["11CHSTLEUP00DSXC", "11CHSTRIUP00DSXC", "11CHSTRILO00DSXC"][..],
            "chest-deflection",
            "??CHSTRILO*",
            2,
        ),
        (
            &["11CHSTUP00H3ACXC", "11CHSTLO00H3ACXC"],
            "chest-x",
            "??CHSTLO00H3ACX?",
            1,
        ),
        (
            &["11HEADCG00H3ACXA", "11HEADCGRDH3ACXA"],
            "head-x",
            "??HEADCG00*",
            0,
        ),
        (
            &["11HEADCG00H3ACXA", "11HEAD0000H3ACXA"],
            "head-x",
            "??HEAD00*",
            1,
        ),
        // the components of one resultant
        (
            &["11HEADCG00H3ACXA", "11HEADCGRDH3ACYA", "11HEADCG00H3ACYA"],
            "head-y",
            "??HEADCG00*",
            2,
        ),
        (
            &["11NECKUP00H3FOXA", "11NECKUPRDH3FOZA", "11NECKUP00H3FOZA"],
            "neck-fz",
            "??NECKUP00*",
            2,
        ),
        (
            &["11TIBILEUPH3MOXB", "11TIBILELOH3MOXB"],
            "tibia-left-mx",
            "??TIBILELO*",
            1,
        ),
    ] {
        let all = chosen(codes, Asked::default()).unwrap();
        assert!(
            matches!(all.at(place), Some(Found::Several(_))),
            "{codes:?} {all:?}"
        );
        let part = choice::part(place);
        for of in [place, part] {
            let one = chosen(codes, patterns(&[(part, pattern), (of, pattern)])).unwrap();
            assert_eq!(one.at(place), Some(&Found::Coded(vec![index])), "{codes:?}");
        }
    }
    // the same code twice
    let twice = chosen(&["11FEMRLE00H3FOZB", "11FEMRLE00H3FOZB"], Asked::default()).unwrap();
    assert!(matches!(twice.at("femur-left"), Some(Found::Several(_))));
    // filters do not make another sensor
    let filters = chosen(
        &["11NECKUP00H3FOZB", "11NECKUP00H3FOZA", "11NECKUP00H3MOYB"],
        Asked::default(),
    )
    .unwrap();
    assert_eq!(filters.at("neck-fz"), Some(&Found::Coded(vec![0, 1])));
    let error = chosen(&TWO[..2], patterns(&[("head", "??HEADXX*")])).unwrap_err();
    assert!(error.contains("no channel of the place head"), "{error}");
}

#[test]
fn what_failed_fills_no_place() {
    let head = [
        "!11HEADCG00H3ACXA",
        "11HEADCG00H3ACYA",
        "11HEADCG00H3ACZA",
        "11HEADCG00H3ACRA",
    ];
    let found = chosen(&head, Asked::default()).unwrap();
    assert_eq!(found.at("head-x"), Some(&Found::Doubtful(vec![0])));
    assert_eq!(found.at("head-y"), Some(&Found::Coded(vec![1])));
    // a redundant sensor takes the place of one that failed as a whole, and is not mixed with one that failed in part
    let whole = chosen(&["!11HEADCG00H3ACXA", "11HEADCGRDH3ACXA"], Asked::default()).unwrap();
    assert_eq!(whole.at("head-x"), Some(&Found::Coded(vec![1])));
    let part = chosen(
        &["!11HEADCG00H3ACXA", "11HEADCG00H3ACYA", "11HEADCGRDH3ACXA"],
        Asked::default(),
    )
    .unwrap();
    assert!(
        matches!(part.at("head-x"), Some(Found::Several(_))),
        "{part:?}"
    );
}
