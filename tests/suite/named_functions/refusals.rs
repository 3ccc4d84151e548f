//! What is asked for and does not exist is refused with a remedy.

use bryant_generator::dynamics::functions::requests;
use std::path::Path;

#[test]
fn a_function_that_does_not_exist_is_refused_with_a_remedy() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/functions/machine.yaml");
    let (model, _) = bryant_generator::read(&file).expect("a model");
    for (asked, message, help) in [
        (
            "inverse_dynamic",
            "there is no function \"inverse_dynamic\"",
            "did you mean \"inverse_dynamics\"?",
        ),
        (
            "jacobian(hnad)",
            "there is no frame \"hnad\"",
            "did you mean \"hand\"?",
        ),
        (
            "jacobian(arm/hnad)",
            "there is no frame \"arm/hnad\"",
            "did you mean \"arm/hand\"?",
        ),
        (
            "jacobian",
            "the function \"jacobian\" is of a frame",
            "write `jacobian(arm/slide)`",
        ),
        (
            "bias(hand)",
            "the function \"bias\" has no argument",
            "write `bias`",
        ),
        (
            "pose(hand",
            "\"pose(hand\" has no closing parenthesis",
            "write `jacobian(arm/hand)`",
        ),
        ("pose()", "there is no frame \"\"", "there is "),
    ] {
        let found = requests(&model, "machine.yaml", [asked]).expect_err(asked);
        let said = found.to_string();
        assert!(
            said.contains(message) && said.contains(help),
            "{asked}: {said}"
        );
        assert!(said.contains("machine.yaml"), "{said}");
    }
    let twice = requests(
        &model,
        "machine.yaml",
        [" pose( hand )", "pose(hand)", "bias"],
    );
    assert_eq!(twice.expect("they exist").len(), 2);
}
