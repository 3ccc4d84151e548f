use bryant_generator::description::vocabulary;
use bryant_study::criteria::{PLACES, fits};
use bryant_study::facts::ModelFacts;

/// The keys of `criteria` in a model are the places, in the same order.
#[test]
fn a_model_has_all_places_as_keys() {
    let all = vocabulary(bryant_generator::read::LANGUAGE);
    let (_, keys) = all
        .iter()
        .find(|(title, _)| *title == "a set of criteria")
        .unwrap();
    // a head is three places of the neck
    let keys = keys.iter().filter(|key| key.name != "neck");
    let keys = keys.map(|key| key.name.replace('_', "-"));
    let places = PLACES.iter().map(|place| place.name.to_owned());
    let others = ["standard", "dummy", "filter-standard", "occupant"].map(str::to_owned);
    assert!(keys.eq(others.into_iter().chain(places)));
    assert!(ModelFacts::default().criteria.is_none());
}

#[test]
fn codes_fit_with_wild_cards() {
    assert!(fits("11HEADCG00H3ACXA", PLACES[1].code));
    assert!(!fits("11HEADCG00H3ACXA", PLACES[2].code));
    assert!(!fits("", ""));
}

/// Spellings in use, and codes of the same quantity that are no time history of a sensor there.
#[test]
fn codes_are_those_of_sensors() {
    let of = |place: &str| PLACES.iter().find(|one| one.name == place).unwrap().code;
    for (place, code) in [
        ("head-x", "11HEAD0000H3ACXA"),
        ("head-x", "11HEADCGRDH3ACXP"),
        ("head-x", "13HEADCG00HFACX0"),
        ("head", "11HEAD0000H3ACRA"),
        ("head-wy", "11HEAD0000THAVYD"),
        ("chest-x", "11CHSTUP00H3ACXC"),
        ("chest-deflection", "11CHST0003H3DSXC"),
        ("chest-deflection", "11CHSTLEUPTHDSXC"),
        ("knee-left", "11KNSLLE00H3DSXC"),
        ("tibia-left-my", "11TIBILEUPH3MOYB"),
    ] {
        assert!(fits(code, of(place)), "{place} {code}");
    }
    for (place, code) in [
        // 3 ms values, a sum, an average, a constant
        ("chest", "11CHST003CH3ACRX"),
        ("chest", "11CHST003CH3ACRC"),
        ("head", "11HEAD003SH3ACRA"),
        ("head", "11HEADCG3CH3ACR0"),
        ("femur-left", "11FEMRLESUH3FOZB"),
        ("chest-deflection", "11CHSTAV00THDSXC"),
        ("chest-deflection", "11CHST0000H3DSXX"),
        // elsewhere in the head, another quantity, signs that differ from those of SAE J211
        ("head-x", "11HEADFR00H3ACXA"),
        ("head-x", "11HEADTP00H3ACXA"),
        ("head-x", "11HEAD0000H3AVXA"),
        ("neck-fz", "11NECKUP00H3FO3A"),
        ("neck-fz", "11NECKLO00H3FOZA"),
    ] {
        assert!(!fits(code, of(place)), "{place} {code}");
    }
}
