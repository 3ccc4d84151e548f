use bryant::command::Error;
use bryant::command::outputs::{NOWHERE, Outputs, Replacing, exists_on_windows, picture};
use bryant::signature::ContentKind;
use std::path::{Path, PathBuf};

#[test]
fn places_are_taken_once() {
    let mut outputs = Outputs::of(&[PathBuf::from("model.yaml")], Replacing::default());
    let mut told = |option: &str, path: &str| match outputs.take(
        option,
        Path::new(path),
        ContentKind::Table,
    ) {
        Ok(()) => String::new(),
        Err(Error::Input(message)) => message,
        Err(error) => panic!("{error:?}"),
    };
    assert_eq!(told("--csv", "a.csv"), "");
    let message = told("--picture", "./a.csv");
    assert!(message.starts_with("--csv and --picture both write to ./a.csv"));
    assert!(told("--markdown", "./model.yaml").contains("model.yaml, which is read"));
    assert_eq!(told("--json", "-") + &told("--plot", "b.csv"), "");
    assert!(
        told("--csv", "/dev/stdout").contains("--json and --csv both write to standard output")
    );
    assert_eq!(told("--csv", NOWHERE) + &told("--picture", NOWHERE), "");
}

#[test]
fn a_name_that_windows_has_not_is_refused_with_the_option() {
    let told = |path: &str| {
        exists_on_windows("--csv", Path::new(path)).map_err(|error| match error {
            Error::Input(message) => message,
            error => panic!("{error:?}"),
        })
    };
    assert_eq!(told("../out/child-seat.csv"), Ok(()));
    for bad in ["con.csv", "out/aux.csv", "nul/a.csv"] {
        let message = told(bad).unwrap_err();
        assert!(
            message.contains("--csv") && message.contains(bad) && message.contains("device"),
            "{message}"
        );
    }
}

#[test]
fn pictures_are_told_by_their_endings() {
    for good in ["a.svg", "b/a.PNG", "-"] {
        assert!(picture(good).is_ok(), "{good}");
    }
    for bad in ["a.jpg", "a", "png", "a.svg.bak", ""] {
        let message = picture(bad).unwrap_err();
        assert!(message.contains(".svg or as .png") && message.contains("help:"));
    }
}
