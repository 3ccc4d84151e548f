use bryant_generator::equations::Route;
use bryant_generator::expression::count::*;
use bryant_generator::formalism::{Options, derive_with};
use bryant_generator::model::Coordinates;
fn main() {
    let tree = bryant_tests::reference::load("dummy15", Coordinates::Quaternion);
    let e = derive_with(
        &tree.model,
        Options {
            matrices: false,
            route: Some(Route::Elimination),
        },
    );
    println!("{}", Table::of(&e.graph, &e.accelerations));
}
