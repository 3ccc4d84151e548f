//! Meshes as written: files of triangles that are only shown.

use super::place::At;
use super::quantity::{OneOrThree, Quantity};
use super::shape::{Misfit, Problems, Shape, check_record, record};
use super::tree::Kind;
use serde_yaml::Value;

record! {
    /// A mesh that is shown with a body.
    Mesh as "a mesh" {
        /// A file of triangles, relative to this one: STL, OBJ, glTF or GLB.
        file: String,
        /// Factor on its coordinates, or one for each of its axes: 0.001 of a file in mm.
        scale: Option<OneOrThree>,
        /// Where its origin is, frame of the body \[m\].
        at: Option<Vec<Quantity>>,
        /// Bryant angles of its axes relative to those of the body, or the one about y \[rad\].
        angles: Option<OneOrThree>,
    }
}

/// The meshes of a body: the path of a file, a mesh, or several.
#[derive(Clone, Debug)]
pub struct Meshes(pub Vec<Mesh>);

impl Shape for Meshes {
    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            Kind::List(items) => {
                for index in 0..items.len() {
                    one(at.item(index), problems);
                }
            }
            _ => one(at, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        let all = match value {
            Value::Sequence(all) => all.iter().map(read_one).collect::<Result<_, _>>()?,
            one => vec![read_one(one)?],
        };
        Ok(Meshes(all))
    }
}

fn one(at: At<'_>, problems: &Problems) {
    match &at.node.kind {
        Kind::Map(_) => check_record::<Mesh>(at, problems),
        Kind::Scalar { text, .. } if !text.is_empty() && at.node.article() == "a text" => {}
        _ => problems.add(at.problem(
            format!("here stands {}, but a mesh is needed", at.node.article()),
            "write the path of a file, such as `car.stl`, or `{ file: car.stl, scale: 0.001 }`",
        )),
    }
}

fn read_one(value: &Value) -> Result<Mesh, Misfit> {
    match value.as_str() {
        Some(file) => Ok(Mesh {
            file: file.to_owned(),
            scale: None,
            at: None,
            angles: None,
        }),
        None => Mesh::read(value),
    }
}
