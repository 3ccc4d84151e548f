use bryant_generator::names::{Names, RESERVED, camel, screaming, snake};

#[test]
fn words_become_identifiers() {
    assert_eq!(snake("man/head.angle"), "man_head_angle");
    assert_eq!(snake("Lap belt -- left"), "lap_belt_left");
    assert_eq!(snake("3yo"), "n3yo");
    assert_eq!(snake("ω"), "value");
    assert_eq!(screaming("belt chest force"), "BELT_CHEST_FORCE");
    assert_eq!(camel("mass_matrix"), "MassMatrix");
}

#[test]
fn keywords_are_avoided() {
    for word in [
        "type", "self", "fn", "loop", "async", "gen", "Self", "super", "crate",
    ] {
        let name = snake(word);
        assert!(syn::parse_str::<syn::Ident>(&name).is_ok(), "{name}");
        assert_ne!(name, word.to_ascii_lowercase());
    }
}

#[test]
fn what_is_reserved_is_a_keyword_of_rust() {
    for word in RESERVED.iter().filter(|&&word| word != "gen") {
        assert!(syn::parse_str::<syn::Ident>(word).is_err(), "{word}");
    }
}

#[test]
fn a_name_is_given_once() {
    let mut names = Names::with(&["q"]);
    let given = ["a", "a", "q", "a_2", "a"].map(|name| names.take(name));
    assert_eq!(given, ["a", "a_2", "q_2", "a_2_2", "a_3"]);
}
