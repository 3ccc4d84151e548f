//! The texts of people and of parts of a car.

use bryant_generator::car_part::{CarPart, CarPartKind};
use bryant_generator::human::{NAMES, Neutral, Person, Posture, Sex, Size, Written, yaml};

/// Texts by what they were asked for: people of every name and of three sizes, in both postures, and parts of a car.
fn texts() -> Vec<(String, String)> {
    let sizes = [
        (Sex::Female, 1.5, 45.0),
        (Sex::Male, 1.75, 80.0),
        (Sex::Male, 2.0, 120.0),
    ];
    let sizes = sizes.map(|(sex, stature, mass)| {
        let name = format!("{sex:?} {stature} {mass}");
        (name, Person::Size(Size { sex, stature, mass }))
    });
    let people = NAMES.map(|name| (name.to_owned(), Person::named(name).unwrap()));
    let bent = Posture::seated().with("head", 0.2).unwrap();
    let mut texts = Vec::new();
    for (of, person) in sizes.into_iter().chain(people) {
        for (posture, neutral) in [
            (Posture::STANDING, Neutral::Posture),
            (bent, Neutral::Posture),
            (bent, Neutral::Upright),
        ] {
            for planar in [true, false] {
                let written = Written {
                    name: "driver",
                    posture,
                    planar,
                    neutral,
                };
                let angle = posture.angle("head");
                let asked = format!("{of}, head {angle}, {neutral:?}, planar {planar}");
                texts.push((asked, yaml(&person, written).unwrap()));
            }
        }
    }
    for kind in [
        CarPartKind::Cushion,
        CarPartKind::Seat,
        CarPartKind::KneeBolster,
        CarPartKind::SteeringColumn,
    ] {
        for planar in [true, false] {
            for angle in [None, Some(0.3), Some(-0.2), Some(0.0)] {
                for against in [&[][..], &["man"], &["man", "child-2"]] {
                    let part = CarPart {
                        kind,
                        name: "seat-2".into(),
                        on: "car".into(),
                        at: [0.4, if planar { 0.0 } else { -0.35 }, 0.25],
                        angle,
                        against: against.iter().map(|name| (*name).to_owned()).collect(),
                        times: "1".into(),
                        planar,
                    };
                    let asked = format!("{kind:?} {planar} {angle:?} {against:?}");
                    texts.push((asked, part.yaml()));
                }
            }
        }
    }
    texts
}

/// The texts as they were when their numbers were still part of the program: a change of one is to be meant. Each has
/// its length and its hash (FNV-1a, 64 bits).
#[test]
fn texts_of_people_and_parts_stay_as_they_are() {
    let hash = |text: &str| {
        let mixed = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        text.bytes().fold(0xcbf2_9ce4_8422_2325, mixed)
    };
    let texts = texts().into_iter();
    let lines =
        texts.map(|(asked, text)| format!("{asked}: {} {:016x}\n", text.len(), hash(&text)));
    insta::assert_snapshot!("texts", lines.collect::<String>());
}
