use bryant_study::response::{MEANT, What, meant};

#[test]
fn other_words_mean_kinds_and_are_none_themselves() {
    for (name, words) in MEANT {
        assert!(What::named(name).is_some(), "{name}");
        for word in words {
            assert!(What::named(word).is_none(), "{word}");
            assert_eq!(meant(word), Some(name));
        }
    }
    assert_eq!(meant("Maximum"), Some("peak"));
    assert_eq!(meant("force"), None);
}

#[test]
fn units_follow_from_the_output() {
    assert_eq!(What::Integral.unit("N"), "kg*m/s");
    assert_eq!(What::Integral.unit(""), "s");
    assert_eq!(What::Peak.unit("m/s^2"), "m/s^2");
    assert_eq!(What::TimeOfPeak.unit("m/s^2"), "s");
    assert_eq!(What::Hic15.unit("m/s^2"), "");
}
