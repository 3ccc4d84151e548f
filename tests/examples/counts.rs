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
    for count in [5, 30, 100] {
        let model = bryant_tests::trees::chain(
            bryant_generator::model::Dimension::Space,
            Coordinates::Quaternion,
            bryant_generator::model::Reference::Free,
            count,
        );
        let start = std::time::Instant::now();
        let e = derive_with(
            &model,
            Options {
                matrices: false,
                route: Some(Route::Elimination),
            },
        );
        println!(
            "chain {count} {:?} {}",
            start.elapsed(),
            Count::of(&e.graph, &e.accelerations)
        );
    }
    let mut r = bryant_tests::trees::Random::new(1);
    let model = bryant_tests::trees::random_tree(
        &mut r,
        bryant_generator::model::Dimension::Space,
        Coordinates::Quaternion,
        bryant_generator::model::Reference::Free,
        bryant_tests::trees::Shape::Chain,
        100,
    );
    let e = derive_with(
        &model,
        Options {
            matrices: false,
            route: Some(Route::Elimination),
        },
    );
    println!("random chain 100 {}", Count::of(&e.graph, &e.accelerations));
    let t = std::time::Instant::now();
    let f = bryant_generator::expression::passes::factor(&e.graph, &e.accelerations);
    println!(
        "   factored {:?} {}",
        t.elapsed(),
        Count::of(&f.graph, &f.roots)
    );
}
