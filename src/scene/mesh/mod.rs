//! Meshes of files (STL, OBJ and glTF) and of simple shapes, as triangles in the frame of a body, and no more of them
//! than a picture shows.

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod gltf;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod obj;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod outline;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod solid;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod stl;

use super::Bodies;
use crate::pose::{Vec3, bryant_rotation, dot};
use bryant_generator::model::{self, Model, Shown};
use std::collections::HashMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};

pub use outline::outline;

/// Larger files are not read \[bytes\].
const LARGEST: u64 = 512 << 20;

/// All meshes of a scene together have at most so many triangles, about 15 bytes each in a report.
const MOST: usize = 60_000;

/// One mesh has at most so many.
const MOST_OF_ONE: usize = 20_000;

/// Triangles with common corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// \[m\], once it is in the frame of a body.
    pub places: Vec<Vec3>,
    /// Counter-clockwise from outside.
    pub corners: Vec<[u32; 3]>,
}

/// A mesh that is shown with a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The name of its file without folders, or of its shape.
    pub name: String,
    /// The index of the body; `None` for the frame.
    pub body: Option<usize>,
    /// In the frame of the body.
    pub triangles: Triangles,
    /// Of the box around them.
    pub corners: [Vec3; 8],
}

/// The meshes of a model whose files are there, and a note for each that cannot be read, or is shown with fewer
/// triangles than it has.
pub fn meshes(model: &Model) -> (Vec<Mesh>, Vec<String>) {
    let written = || {
        model.shown.iter().filter_map(|shown| match shown {
            Shown::Mesh(mesh) => Some(mesh),
            _ => None,
        })
    };
    let bodies = Bodies::of(model);
    let (mut meshes, mut notes) = (Vec::new(), Vec::new());
    let count = written().count();
    for mesh in written().filter(|mesh| missing(mesh).is_none()) {
        match read(mesh, count) {
            Ok((triangles, note)) => {
                let [low, high] = triangles.around();
                let corner = |n: usize| -> Vec3 {
                    std::array::from_fn(|i| if n >> i & 1 == 0 { low[i] } else { high[i] })
                };
                meshes.push(Mesh {
                    name: name(mesh).to_owned(),
                    body: bodies.index(mesh.on),
                    corners: std::array::from_fn(corner),
                    triangles,
                });
                notes.extend(note);
            }
            Err(why) => notes.push(format!(
                "warning: {}: the mesh is not shown: {why}",
                place(mesh)
            )),
        }
    }
    (meshes, notes)
}

/// The name of its file without folders, or of its shape.
fn name(mesh: &model::Mesh) -> &str {
    match &mesh.of {
        model::Triangles::File(file) => file.rsplit(['/', '\\']).next().unwrap_or_default(),
        model::Triangles::Solid(solid) => solid.word(),
    }
}

/// Where a mesh is named.
pub fn place(mesh: &model::Mesh) -> String {
    match mesh.line {
        0 => mesh.source.clone(),
        line => format!("{}:{line}", mesh.source),
    }
}

/// Why the file of a mesh is not there.
pub fn missing(mesh: &model::Mesh) -> Option<String> {
    let model::Triangles::File(file) = &mesh.of else {
        return None;
    };
    match found(mesh, file) {
        Ok(path) if path.exists() => None,
        Ok(path) => Some(format!("there is no file {}", path.display())),
        Err(why) => Some(why),
    }
}

/// The triangles of a mesh, in the frame of its body, and a note where there are fewer than in the file. `count` meshes
/// share what a scene may have.
///
/// # Errors
/// Why they cannot be had, and what to do.
fn read(mesh: &model::Mesh, count: usize) -> Result<(Triangles, Option<String>), String> {
    let (mut triangles, path) = match &mesh.of {
        model::Triangles::Solid(solid) => (solid::triangles(*solid), PathBuf::new()),
        model::Triangles::File(file) => {
            let path = found(mesh, file)?;
            (of_file(&path)?, path)
        }
    };
    let has = triangles.corners.len();
    triangles
        .corners
        .retain(|[a, b, c]| a != b && b != c && c != a);
    if triangles.corners.is_empty() || !triangles.places.iter().flatten().all(|x| x.is_finite()) {
        let what = match triangles.corners.is_empty() {
            true => "no triangles",
            false => "numbers that are not finite",
        };
        return Err(format!("{} has {what}", path.display()));
    }
    let turn = bryant_rotation(mesh.angles);
    for place in &mut triangles.places {
        let scaled: Vec3 = std::array::from_fn(|i| place[i] * mesh.scale[i]);
        *place = std::array::from_fn(|i| mesh.at[i] + dot(turn[i], scaled));
    }
    if mesh.scale.iter().product::<f64>() < 0.0 {
        triangles
            .corners
            .iter_mut()
            .for_each(|corners| corners.swap(1, 2));
    }
    let most = (MOST / count.max(1)).min(MOST_OF_ONE);
    let note = (has > most).then(|| {
        triangles = coarser(&triangles, most);
        format!(
            "{} has {has} triangles: {} are shown",
            path.display(),
            triangles.corners.len()
        )
    });
    Ok((triangles, note))
}

/// The triangles of a file, as they stand there.
fn of_file(path: &Path) -> Result<Triangles, String> {
    let triangles = of_bytes(path, &bytes(path)?);
    triangles.map_err(|why| format!("{} cannot be read: {why}", path.display()))
}

/// The triangles in the bytes of a file of this name.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn of_bytes(path: &Path, bytes: &[u8]) -> Result<Triangles, String> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("stl") => stl::read(bytes),
        Some("obj") => obj::read(bytes),
        Some("glb" | "gltf") => gltf::read(bytes, path.parent().unwrap_or(Path::new(""))),
        _ => Err("it is none of .stl, .obj, .gltf and .glb".to_owned()),
    }
}

/// The path of a file. That of `package://NAME/…` is below a folder NAME that contains the file that names it, or is
/// beside one that does, or is named in `ROS_PACKAGE_PATH`.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn found(mesh: &model::Mesh, file: &str) -> Result<PathBuf, String> {
    let folder = Path::new(&mesh.source).parent().unwrap_or(Path::new(""));
    let written = file.replace('\\', "/");
    let Some(package) = written.strip_prefix("package://") else {
        let path = written.strip_prefix("file://").unwrap_or(&written);
        return Ok(folder.join(path));
    };
    let (name, rest) = package.split_once('/').unwrap_or((package, ""));
    let folder = std::path::absolute(folder).unwrap_or(folder.to_owned());
    let listed = std::env::var_os("ROS_PACKAGE_PATH");
    let listed = listed.iter().flat_map(std::env::split_paths);
    let folders = folder.ancestors().map(Path::to_owned).chain(listed);
    let candidates = folders.flat_map(|folder| {
        let itself = folder.file_name().is_some_and(|last| last == name);
        let beside = folder.join(name).join(rest);
        itself
            .then(|| folder.join(rest))
            .into_iter()
            .chain([beside])
    });
    let mut there = candidates.filter(|path| path.is_file());
    there.next().ok_or_else(|| {
        format!(
            "{written} is in no folder \"{name}\" around or beside that of {}",
            mesh.source
        )
    })
}

fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    let error = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => format!("there is no file {}", path.display()),
        _ => format!("{} cannot be read: {error}", path.display()),
    };
    let file = std::fs::metadata(path).map_err(error)?;
    if !file.is_file() || file.len() > LARGEST {
        let what = match file.is_file() {
            true => "is larger than 512 MiB",
            false => "is no file",
        };
        return Err(format!("{} {what}", path.display()));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(error)?;
    file.take(LARGEST).read_to_end(&mut bytes).map_err(error)?;
    Ok(bytes)
}

impl Triangles {
    /// Of triangles that share no corners.
    // Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn welded(each: impl Iterator<Item = [[f32; 3]; 3]>) -> Self {
        let mut triangles = Triangles::default();
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        for triangle in each {
            let corners = triangle.map(|place| {
                // 0 and −0 are one place
                let key = place.map(|x| (x + 0.0).to_bits());
                *known.entry(key).or_insert_with(|| {
                    triangles.places.push(place.map(f64::from));
                    triangles.places.len() as u32 - 1
                })
            });
            triangles.corners.push(corners);
        }
        triangles
    }

    /// Low and high corner of the box around them.
    pub fn around(&self) -> [Vec3; 2] {
        let mut around = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for place in &self.places {
            for i in 0..3 {
                around[0][i] = around[0][i].min(place[i]);
                around[1][i] = around[1][i].max(place[i]);
            }
        }
        around
    }
}

/// At most so many triangles with about the same surface: all corners in a cell of a grid become one in the middle of
/// them, and triangles that have lost an edge are left out. The grid is the finest of those tried.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn coarser(triangles: &Triangles, most: usize) -> Triangles {
    let [low, high] = triangles.around();
    let size = (0..3).fold(0.0f64, |size, i| size.max(high[i] - low[i]));
    let (mut coarse, mut fine) = (2.0f64, 4096.0f64);
    let mut best = Triangles::default();
    for _ in 0..12 {
        let cells = (coarse * fine).sqrt();
        let found = clustered(triangles, low, size / cells);
        match found.corners.len() <= most {
            true => (coarse, best) = (cells, found),
            false => fine = cells,
        }
    }
    best
}

fn clustered(triangles: &Triangles, low: Vec3, cell: f64) -> Triangles {
    let mut cells: HashMap<[i32; 3], u32> = HashMap::new();
    let mut sums: Vec<(Vec3, f64)> = Vec::new();
    let new: Vec<u32> = (triangles.places.iter())
        .map(|place| {
            let key = std::array::from_fn(|i| ((place[i] - low[i]) / cell) as i32);
            let index = *cells.entry(key).or_insert_with(|| {
                sums.push(([0.0; 3], 0.0));
                sums.len() as u32 - 1
            });
            let (sum, count) = &mut sums[index as usize];
            *sum = std::array::from_fn(|i| sum[i] + place[i]);
            *count += 1.0;
            index
        })
        .collect();
    let mut seen = std::collections::HashSet::new();
    let corners = triangles
        .corners
        .iter()
        .map(|corners| corners.map(|c| new[c as usize]));
    let corners = corners.filter(|[a, b, c]| a != b && b != c && c != a);
    let corners = corners.filter(|corners| {
        let mut key = *corners;
        key.sort_unstable();
        seen.insert(key)
    });
    Triangles {
        corners: corners.collect(),
        places: sums
            .iter()
            .map(|(sum, count)| sum.map(|x| x / count))
            .collect(),
    }
}
