//! Compiles the models of the motion tests.

fn main() {
    bryant_generator::Config::new()
        .models_in("models")
        .generate_or_report();
    // The mass matrix of a hundred elements is not needed by the tests and takes long to compile. The shorter chains are for benchmarks.
    for folder in ["models/large", "models/chains"] {
        bryant_generator::Config::new()
            .models_in(folder)
            .matrices(false)
            .generate_or_report();
    }
}
