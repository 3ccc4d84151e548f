//! Writes dummy15 as Rust, and its derivative as machine code for AArch64.

use bryant_generator::Config;
use bryant_generator::program::Method;
use bryant_generator::target::aarch64::{Target, assemble};
use bryant_generator::target::machine::Precision;
use std::path::Path;

fn main() {
    let path = "../../models/dummy15.yaml";
    let mut config = Config::new();
    config.model(path).matrices(false).generate_or_report();

    let (model, _) =
        bryant_generator::read(Path::new(path)).unwrap_or_else(|e| panic!("{e}"));
    let lists = Config::new().matrices(false).lists(&model);
    let target = Target {
        lanes: false,
        precision: Precision::Double,
        fused: false,
        slopes: false,
    };
    let code = assemble(lists.list(Method::Derivative), &lists.curves, &target);
    let out = std::env::var("OUT_DIR").unwrap_or_else(|e| panic!("{e}"));
    let path = Path::new(&out).join("derivative.bin");
    std::fs::write(path, code.bytes).unwrap_or_else(|e| panic!("{e}"));
}
