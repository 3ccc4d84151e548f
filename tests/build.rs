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
    // Models of similar elements are compiled in both ways: everything in one function, and with functions that the elements share.
    let out = std::env::var_os("OUT_DIR").map(std::path::PathBuf::from);
    for (folder, merged) in [("whole", usize::MAX), ("shared", 0)] {
        let mut config = bryant_generator::Config::new();
        config
            .models_in("models/like")
            .matrices(false)
            .merged(merged);
        if let Some(out) = &out {
            config.out_dir(out.join(folder));
        }
        config.generate_or_report();
    }
}
