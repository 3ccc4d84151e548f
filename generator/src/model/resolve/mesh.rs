//! Meshes: which body shows which file or shape, how large, and where on it. Files are not read here: what is shown has
//! no influence.

use super::Resolver;
use crate::description::load::Loaded;
use crate::description::measure::Measured;
use crate::description::mesh::{Mesh as Written, Meshes};
use crate::description::place::At;
use crate::description::quantity::{Number as WrittenNumber, OneOrThree};
use crate::model::{Body, Mesh, Shown, Triangles};

impl Resolver<'_> {
    /// The meshes of all bodies, at the default parameters.
    pub(super) fn meshes(&self, loaded: &Loaded) -> Vec<Shown> {
        let mut all = Vec::new();
        let mut add = |on: Option<Body>, written: &Option<Meshes>, at: At<'_>| {
            let (Some(on), Some(Meshes(written))) = (on, written) else {
                return;
            };
            let at = at.key("mesh");
            for (index, mesh) in written.iter().enumerate() {
                all.extend(self.mesh(on, mesh, at.item(index)).map(Shown::Mesh));
            }
        };
        for file in &loaded.files {
            let (at, contents) = (file.source.at(), &file.contents);
            add(Some(Body::Frame), &contents.mesh, at);
            for (index, written) in contents.vehicles.iter().flatten().enumerate() {
                let known = self.vehicles.iter().position(|v| v.name == written.name);
                let at = at.key("vehicles").item(index);
                add(known.map(Body::Vehicle), &written.mesh, at);
            }
            for (index, system) in contents.systems.iter().flatten().enumerate() {
                let at = at.key("systems").item(index).key("elements");
                for (index, written) in system.elements.iter().flatten().enumerate() {
                    let path = format!("{}/{}", system.name, written.name);
                    let id = self.elements.get(&path).copied();
                    add(id.map(Body::Element), &written.mesh, at.item(index));
                }
            }
        }
        all
    }

    fn mesh(&self, on: Body, written: &Written, at: At<'_>) -> Option<Mesh> {
        let of = match (&written.file, written.shape) {
            (Some(file), None) => Triangles::File(file.clone()),
            (None, Some(solid)) => Triangles::Solid(solid),
            _ => {
                self.problems.add(at.problem(
                    "a mesh is either a file or a shape",
                    "write `{ file: car.stl }`, or `{ shape: box, size: [4, 1.8, 1.4] }`",
                ));
                return None;
            }
        };
        let size = match (&written.size, &of) {
            (Some(size), Triangles::Solid(_)) => self.three(size, [true; 3], at.key("size"))?,
            (None, Triangles::File(_)) => [1.0; 3],
            (Some(_), Triangles::File(_)) => {
                let help = "write a factor on the numbers of the file: `scale`";
                let problem = at.key("size").key_problem("a file has its own size", help);
                self.problems.add(problem);
                return None;
            }
            (None, Triangles::Solid(_)) => {
                let help = "write how long it is along its axes: `size: [4, 1.8, 1.4]`";
                self.problems
                    .add(at.problem("this shape has no size", help));
                return None;
            }
        };
        if size.iter().any(|size| *size <= 0.0) {
            self.problems.add(at.key("size").problem(
                "a shape has a length above 0 along each axis",
                "write one length, or three",
            ));
        }
        let scale = match &written.scale {
            Some(scale) => self.three(scale, [true; 3], at.key("scale"))?,
            None => [1.0; 3],
        };
        if scale.contains(&0.0) {
            self.problems.add(at.key("scale").problem(
                "a mesh of no size is not seen",
                "write a factor that is not 0; below 0 it makes a mirror image",
            ));
        }
        let place = match &written.at {
            Some(at_body) => self.vector(at_body, at.key("at")),
            None => super::NOWHERE,
        };
        let angles = match &written.angles {
            Some(angles) => self.three(angles, [false, true, false], at.key("angles"))?,
            None => [0.0; 3],
        };
        let place = place.map(|number| number.value(&self.defaults));
        let told = at.problem("", "");
        Some(Mesh {
            on,
            of,
            source: at.source.name.clone(),
            line: told.line,
            at: place,
            angles,
            scale: std::array::from_fn(|axis| scale[axis] * size[axis]),
        })
    }

    /// Three numbers, also in the plane; or one number, for the axes in `of_one`.
    fn three<U: Measured>(
        &self,
        written: &OneOrThree<WrittenNumber<U>>,
        of_one: [bool; 3],
        at: At<'_>,
    ) -> Option<[f64; 3]> {
        let value = |written, at| self.number(written, at).value(&self.defaults);
        match written {
            OneOrThree::One(one) => {
                let one = value(one, at);
                Some(of_one.map(|is_of| if is_of { one } else { 0.0 }))
            }
            OneOrThree::List(list) if list.len() == 3 => Some(std::array::from_fn(|axis| {
                value(&list[axis], at.item(axis))
            })),
            OneOrThree::List(list) => {
                self.problems.add(at.problem(
                    format!("a mesh has three axes, but this list has {}", list.len()),
                    "write one number or three",
                ));
                None
            }
        }
    }
}
