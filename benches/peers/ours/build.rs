//! Writes the equations of the models, and their trees as JSON for the other engines: so all are built from one
//! description.
//!
//! The trees are those of the model as it was resolved, in SI units. A model that holds what the comparison does not
//! know (parameters, a second system, forces but gravity) stops the build.
//!
//! Where the variable `ROBOTS` names a folder, its robots are built, too: those of `robots.py`.

use bryant_generator::Config;
use bryant_generator::law::ForceKind;
use bryant_generator::model::{Dimension, FieldComponent, Model, Number, Reference};
use std::path::Path;

#[path = "src/robots.rs"]
mod robots;

const MODELS: [&str; 5] = [
    "../models/planar9.yaml",
    "../models/chain5.yaml",
    "../../../models/dummy15.yaml",
    "../models/chain30.yaml",
    "../../../tests/models/large/chain100.yaml",
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut config = Config::new();
    config.matrices(false);
    for path in MODELS {
        config.model(path);
    }
    let mut trees = Vec::new();
    for generated in config.generate_or_report() {
        let model = &generated.model;
        let tree =
            tree(model).ok_or_else(|| format!("{}: the peers have no such model", model.name))?;
        trees.push(tree);
    }
    let out = std::env::var("OUT_DIR")?;
    println!("cargo::rustc-check-cfg=cfg(robots)");
    println!("cargo::rerun-if-env-changed=ROBOTS");
    if let Ok(folder) = std::env::var("ROBOTS") {
        let mut config = Config::new();
        config.matrices(false);
        for (name, base) in robots::ROBOTS {
            let urdf = Path::new(&folder).join(name).with_extension("urdf");
            println!("cargo::rerun-if-changed={}", urdf.display());
            let imported = robots::read(Path::new(&folder), name, base)?;
            let yaml = Path::new(&out).join(name).with_extension("yaml");
            std::fs::write(&yaml, imported.yaml)?;
            config.model(yaml);
        }
        config.generate_or_report();
        println!("cargo::rustc-cfg=robots");
    }
    std::fs::write(
        Path::new(&out).join("trees.json"),
        format!("[{}]\n", trees.join(",\n")),
    )?;
    Ok(())
}

/// A model as JSON; `None` where it holds what the comparison does not know.
fn tree(model: &Model) -> Option<String> {
    let [system] = &model.systems[..] else {
        return None;
    };
    let [force] = &model.forces[..] else {
        return None;
    };
    let ForceKind::Field(field) = ForceKind::of(force) else {
        return None;
    };
    let mut gravity = [0.0; 3];
    for (value, component) in gravity.iter_mut().zip(&field.acceleration) {
        let FieldComponent::Constant(number) = component else {
            return None;
        };
        *value = constant(number)?;
    }
    let mut elements = Vec::new();
    for element in &system.elements {
        if vector(&element.axes)? != [0.0; 3] {
            return None;
        }
        let parent = element
            .parent
            .map_or("null".to_owned(), |index| index.to_string());
        elements.push(format!(
            r#"{{"parent": {parent}, "at": {:?}, "mass": {:?}, "cg": {:?}, "inertia": {:?}}}"#,
            vector(&element.at)?,
            constant(&element.mass)?,
            vector(&element.cg)?,
            vector(&element.inertia)?,
        ));
    }
    let plane = model.dimension == Dimension::Plane;
    let free = match system.reference {
        Reference::Free => true,
        Reference::Fixed => false,
        _ => return None,
    };
    Some(format!(
        r#"{{"name": {:?}, "plane": {plane}, "free": {free}, "gravity": {gravity:?}, "elements": [{}]}}"#,
        model.name,
        elements.join(", ")
    ))
}

fn vector(numbers: &[Number; 3]) -> Option<[f64; 3]> {
    let [x, y, z] = numbers;
    Some([constant(x)?, constant(y)?, constant(z)?])
}

fn constant(number: &Number) -> Option<f64> {
    match number {
        Number::Constant(value) => Some(*value),
        _ => None,
    }
}
