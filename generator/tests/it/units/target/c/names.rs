use bryant_generator::target::c::names::{Enumerators, model, snake};

#[test]
fn words_become_identifiers() {
    assert_eq!(snake("man/head.angle"), "man_head_angle");
    assert_eq!(snake("Lap belt -- left"), "lap_belt_left");
    assert_eq!(model("3yo"), "model_3yo");
    assert_eq!(model("ω"), "model");
    let mut names = Enumerators::default();
    let given = ["a b", "a-b", "ω"].map(|words| names.take("x_output", words));
    assert_eq!(given, ["X_OUTPUT_A_B", "X_OUTPUT_A_B_2", "X_OUTPUT_"]);
}
