//! Compiles the models that motion is tested by.

fn main() {
    bryant_generator::Config::new()
        .models_in("models")
        .generate_or_report();
    // The system matrix of a hundred elements is of no use to the tests, and long to compile. The shorter chains are for benchmarks.
    for folder in ["models/large", "models/chains"] {
        bryant_generator::Config::new()
            .models_in(folder)
            .matrices(false)
            .generate_or_report();
    }
}
