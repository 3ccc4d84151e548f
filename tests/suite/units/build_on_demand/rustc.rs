use bryant::build_on_demand::rustc::{ask, digest, first_error};

#[test]
fn keys_tell_texts_apart() {
    assert_ne!(digest(["ab", "c"]), digest(["a", "bc"]));
    assert_eq!(digest(["ab", "c"]), digest(["ab", "c"]));
}

#[test]
fn the_first_error_is_found() {
    let messages = "warning: x\nerror[E0308]: mismatched types\n --> a.rs\nerror: aborting";
    assert_eq!(first_error(messages), "mismatched types");
    assert_eq!(first_error("\n segfault \n"), "segfault");
    assert_eq!(first_error(""), "the compiler printed no message");
}

#[test]
fn a_missing_compiler_is_named_with_the_remedy() {
    let error = ask(&"no-such-rustc".into(), &["-vV"])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("no-such-rustc") && error.contains("rustup.rs"),
        "{error}"
    );
}
