//! Compiles every bundled model: a new YAML file in `models/` needs no code.

use bryant_generator::{Config, Generated};
use std::fmt::Write;
use std::path::Path;

const MODELS: &str = "../models";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let models = Config::new().models_in(MODELS).generate_or_report();
    let out_dir = std::env::var("OUT_DIR")?;
    std::fs::write(Path::new(&out_dir).join("all.rs"), all(&models)?)?;
    Ok(())
}

/// A module for each model, and the table of all models.
fn all(models: &[Generated]) -> Result<String, Box<dyn std::error::Error>> {
    let here = std::env::var("CARGO_MANIFEST_DIR")?;
    let (mut modules, mut table) = (String::new(), String::new());
    for model in models {
        let name = &model.name;
        let module = name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        writeln!(modules, "#[doc = {:?}]", model.model.title)?;
        writeln!(
            modules,
            "pub mod {module} {{ bryant_runtime::include_model!({name:?}); }}"
        )?;

        let mut texts = Vec::new();
        for path in &model.read {
            let name = path
                .strip_prefix(MODELS)?
                .to_string_lossy()
                .replace('\\', "/");
            let place = std::path::absolute(Path::new(&here).join(path))?;
            texts.push(format!(
                "({name:?}, include_str!({:?}))",
                place.display().to_string()
            ));
        }
        let entry = format!("Entry::of::<{module}::Mechanism<f64>>()");
        writeln!(
            table,
            "    Bundled {{ entry: {entry}, texts: &[{}] }},",
            texts.join(", ")
        )?;
    }
    let head = "/// Every bundled model, by name.\n";
    Ok(format!(
        "{modules}\n{head}pub static MODELS: &[Bundled] = &[\n{table}];\n"
    ))
}
