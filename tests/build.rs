//! Compiles the models of the motion tests.

use bryant_generator::dynamics::functions::FUNCTIONS;

fn main() {
    bryant_generator::Config::new()
        .models_in("models")
        .generate_or_report();
    // The mass matrix of a hundred elements is not needed by the tests and takes long to compile. The shorter chains
    // are for benchmarks.
    for folder in ["models/large", "models/chains"] {
        bryant_generator::Config::new()
            .models_in(folder)
            .matrices(false)
            .generate_or_report();
    }
    // each function that can be asked for, of one frame
    let always = FUNCTIONS.iter().filter(|of| !of.may_be_impossible());
    let functions = always.map(|function| match function.is_of_frame() {
        true => format!("{}(arm/tip)", function.name),
        false => function.name.to_owned(),
    });
    bryant_generator::Config::new()
        .model("models/functions/machine.yaml")
        .matrices(false)
        .functions(functions)
        .generate_or_report();
}
