//! Writes the models as Rust.

fn main() {
    let mut config = bryant_generator::Config::new();
    for model in [
        "../../models/dummy15.yaml",
        "../../models/child-seat.yaml",
        "../../tests/models/large/chain100.yaml",
        "../scenes/occupant.yaml",
        "../scenes/pedestrian.yaml",
    ] {
        config.model(model);
    }
    config.matrices(false).generate_or_report();
}
