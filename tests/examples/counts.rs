//! Operations of the reference trees.
use bryant_generator::equations::Route;
use bryant_generator::expression::count::Count;
use bryant_generator::formalism::{Options, derive_with};
use bryant_generator::model::Coordinates;

fn main() {
    for (name, c) in [
        ("planar9", Coordinates::Quaternion),
        ("chain5", Coordinates::Quaternion),
        ("dummy15", Coordinates::Quaternion),
        ("dummy15", Coordinates::Bryant),
    ] {
        let tree = bryant_tests::reference::load(name, c);
        let start = std::time::Instant::now();
        let e = derive_with(
            &tree.model,
            Options {
                matrices: false,
                route: Some(Route::Elimination),
            },
        );
        println!(
            "{name} {c:?} {:?} {}",
            start.elapsed(),
            Count::of(&e.graph, &e.accelerations)
        );
    }
}
