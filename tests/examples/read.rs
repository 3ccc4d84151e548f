fn main() {
    for path in std::env::args().skip(1) {
        match bryant_generator::model::read(path.as_ref()) {
            Ok((model, files)) => {
                let e = bryant_generator::formalism::derive(&model);
                println!(
                    "{} {:?} {}",
                    model.name,
                    files,
                    bryant_generator::expression::count::Count::of(&e.graph, &e.accelerations)
                );
            }
            Err(problems) => println!("{problems}"),
        }
    }
}
