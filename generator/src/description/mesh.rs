//! Meshes as written: files of triangles, and simple shapes, that are only shown.

use super::place::At;
use super::quantity::{OneOrThree, Quantity};
use super::shape::{Misfit, Problems, Shape, check_record, record, words};
use super::tree::Kind;
use serde_yaml::Value;

words! {
    /// A shape that needs no file.
    Solid {
        /// A box along the axes.
        Box = "box",
        /// A sphere, or an ellipsoid along the axes.
        Sphere = "sphere",
        /// A cylinder along z.
        Cylinder = "cylinder",
    }
}

record! {
    /// A mesh that is shown with a body.
    Mesh as "a mesh" {
        /// A file of triangles, relative to this one: STL, OBJ, glTF or GLB.
        file: Option<String>,
        /// In place of a file, a shape about the origin.
        shape: Option<Solid>,
        /// Of a shape how long it is along its axes, or one number for all of them \[m\].
        size: Option<OneOrThree>,
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
            "write the path of a file, such as `car.stl`, `{ file: car.stl, scale: 0.001 }`, or `{ shape: box, size: [4, 1.8, 1.4] }`",
        )),
    }
}

fn read_one(value: &Value) -> Result<Mesh, Misfit> {
    match value.as_str() {
        Some(file) => Ok(Mesh {
            file: Some(file.to_owned()),
            shape: None,
            size: None,
            scale: None,
            at: None,
            angles: None,
        }),
        None => Mesh::read(value),
    }
}
