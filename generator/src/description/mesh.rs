//! Meshes as written: files of triangles, and simple shapes, that are only shown.

use super::measure::{Angle, Length, Pure};
use super::place::At;
use super::quantity::{Number, OneOrThree};
use super::schema::{Schema, any_of, list_of, typed};
use super::shape::{Misfit, Problems, Shape, check_record, record, words};
use super::tree::NodeKind;
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
        /// path relative to this file, of STL (text or binary), OBJ, glTF or GLB, by its ending; of glTF y is up in the
        /// file, and z in the model. `package://NAME/…`, as URDF has it, is looked for in the folders around the file
        /// that are called `NAME` or have a folder `NAME`, and in those of `ROS_PACKAGE_PATH`
        file: Option<String> = "this or `shape`",
        /// `box`, `sphere`, or `cylinder` along z, in the middle of its axes
        shape: Option<Solid> = "this or `file`",
        /// its lengths along x, y and z, or one for all of them
        size: Option<OneOrThree<Number<Length>>> = "required of a shape",
        /// factor on the coordinates of the file, or three of them, in the plane too: 0.001 of a file in mm; a mirror
        /// image has one below 0
        scale: Option<OneOrThree<Number<Pure>>> = "1",
        /// where its origin is, local frame
        at: Option<Vec<Number<Length>>> = "0",
        /// three Bryant angles of its axes relative to the local frame, in the plane too; a single number is the angle
        /// about y
        angles: Option<OneOrThree<Number<Angle>>> = "0",
    }
}

/// The meshes of a body: the path of a file, a mesh, or several.
#[derive(Clone, Debug)]
pub struct Meshes(pub Vec<Mesh>);

impl Shape for Meshes {
    fn schema(to: &mut Schema) -> Value {
        let each = any_of([typed("string"), Mesh::schema(to)]);
        any_of([each.clone(), list_of(each)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            NodeKind::List(items) => {
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
        NodeKind::Map(_) => check_record::<Mesh>(at, problems),
        NodeKind::Scalar { text, .. } if !text.is_empty() && at.node.article() == "a text" => {}
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
