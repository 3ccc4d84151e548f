//! Meshes of files (STL, OBJ and glTF) and of simple shapes, as triangles in the frame of a body, and no more of them than a picture shows.

mod gltf;
mod obj;
mod outline;
mod solid;
mod stl;

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

/// The meshes of a model whose files are there, and a note for each that cannot be read, or is shown with fewer triangles than it has.
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

/// The triangles of a mesh, in the frame of its body, and a note where there are fewer than in the file. `count` meshes share what a scene may have.
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
fn of_bytes(path: &Path, bytes: &[u8]) -> Result<Triangles, String> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("stl") => stl::read(bytes),
        Some("obj") => obj::read(bytes),
        Some("glb" | "gltf") => gltf::read(bytes, path.parent().unwrap_or(Path::new(""))),
        _ => Err("it is none of .stl, .obj, .gltf and .glb".to_owned()),
    }
}

/// The path of a file. That of `package://NAME/…` is below a folder NAME that contains the file that names it, or is beside one that does, or is named in
/// `ROS_PACKAGE_PATH`.
fn found(mesh: &model::Mesh, file: &str) -> Result<PathBuf, String> {
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
    fn welded(each: impl Iterator<Item = [[f32; 3]; 3]>) -> Self {
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

/// At most so many triangles with about the same surface: all corners in a cell of a grid become one in the middle of them, and triangles that have lost an edge are
/// left out. The grid is the finest of those tried.
fn coarser(triangles: &Triangles, most: usize) -> Triangles {
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

/// Area of a surface \[m²\].
#[cfg(test)]
fn area(triangles: &Triangles) -> f64 {
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|c| triangles.places[c as usize]);
        let sides = [b, c].map(|end| crate::scene::from_to(a, end));
        0.5 * crate::scene::length(crate::pose::cross(sides[0], sides[1]))
    };
    triangles.corners.iter().map(area).sum()
}

/// Volume inside of a closed surface \[m³\]: positive if its triangles are counter-clockwise from outside.
#[cfg(test)]
fn volume(triangles: &Triangles) -> f64 {
    let part = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|c| triangles.places[c as usize]);
        dot(a, crate::pose::cross(b, c)) / 6.0
    };
    triangles.corners.iter().map(part).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere of many triangles, by rings.
    fn sphere(rings: usize) -> Triangles {
        use std::f64::consts::{PI, TAU};
        let at = |i: usize, j: usize| -> [f32; 3] {
            let (s, c) = (PI * i as f64 / rings as f64).sin_cos();
            let (y, x) = (TAU * (j % (2 * rings)) as f64 / (2 * rings) as f64).sin_cos();
            [s * x, s * y, c].map(|x| x as f32)
        };
        let cells = (0..rings).flat_map(|i| (0..2 * rings).map(move |j| (i, j)));
        Triangles::welded(cells.flat_map(|(i, j)| {
            [
                [at(i, j), at(i + 1, j), at(i + 1, j + 1)],
                [at(i, j), at(i + 1, j + 1), at(i, j + 1)],
            ]
        }))
    }

    /// A tetrahedron in each format.
    fn seeds() -> Vec<(&'static str, Vec<u8>)> {
        let places = [
            [0.0f32; 3],
            [2.0, 0.0, 0.0],
            [0.0, 3.0, 1.0],
            [0.0, 0.0, 4.0],
        ];
        let faces = [[0u8, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mut text = "solid part\n".to_owned();
        let mut stl = vec![b' '; 80];
        stl.extend(4u32.to_le_bytes());
        let mut obj = String::new();
        for [x, y, z] in places {
            obj += &format!("v {x} {y} {z}\n");
        }
        for face in faces {
            text += "facet normal 0 0 1\nouter loop\n";
            stl.extend([0; 12]);
            for [x, y, z] in face.map(|corner| places[usize::from(corner)]) {
                text += &format!("vertex {x} {y} {z}\n");
                stl.extend([x, y, z].iter().flat_map(|x| x.to_le_bytes()));
            }
            text += "endloop\nendfacet\n";
            stl.extend([0; 2]);
            let [a, b, c] = face.map(|corner| corner + 1);
            obj += &format!("f {a}/1/1 {b}//2 -{} {c}\n", 5 - b);
        }
        let mut buffer: Vec<u8> = places
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        buffer.extend(faces.as_flattened());
        let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],"scale":[1,2,3]},{"mesh":0,"translation":[1,0,0],"rotation":[0,0,0,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],"buffers":[{"byteLength":60@}]}"#;
        const DIGITS: &[u8; 64] =
            b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let coded: String = (buffer.chunks(3))
            .flat_map(|three| {
                let bits = three
                    .iter()
                    .fold(0, |bits, byte| bits << 8 | u32::from(*byte));
                [18, 12, 6, 0].map(|shift| char::from(DIGITS[(bits >> shift & 63) as usize]))
            })
            .collect();
        let uri = format!(r#","uri":"data:application/octet-stream;base64,{coded}""#);
        let gltf = json.replace('@', &uri);
        let mut json = json.replace('@', "").into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut glb = b"glTF".to_vec();
        let length = 12 + 8 + json.len() + 8 + buffer.len();
        glb.extend(
            [2, length as u32, json.len() as u32]
                .iter()
                .flat_map(|n| n.to_le_bytes()),
        );
        glb.extend(b"JSON");
        glb.extend(json);
        glb.extend((buffer.len() as u32).to_le_bytes());
        glb.extend(b"BIN\0");
        glb.extend(buffer);
        vec![
            ("a.stl", stl),
            ("b.stl", text.into_bytes()),
            ("c.obj", obj.into_bytes()),
            ("d.gltf", gltf.into_bytes()),
            ("e.glb", glb),
        ]
    }

    /// Files that are damaged in any way are read or refused: no panic, no corner that is not there, no wait.
    #[test]
    fn damaged_files_are_read_or_refused() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut random = |below: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as usize % below.max(1)
        };
        for (name, seed) in seeds() {
            let whole = of_bytes(Path::new(name), &seed).unwrap();
            assert!(volume(&whole) > 3.9, "{name}: {}", volume(&whole));
            let (mut read, mut refused) = (0, 0);
            for _ in 0..200 {
                let mut bytes = seed.clone();
                for _ in 0..=random(3) {
                    let at = random(bytes.len());
                    let end = (at + random(24)).min(bytes.len());
                    match random(6) {
                        0 => bytes.truncate(at),
                        1 => drop(bytes.drain(at..end)),
                        2 => {
                            let part = bytes[at..end].to_vec();
                            drop(bytes.splice(at..at, part));
                        }
                        3 => {
                            let words: [&[u8]; 7] = [
                                b"-1",
                                b"1e999",
                                b"4294967295",
                                b"nan",
                                b"{",
                                b"\"",
                                b"\xff\xff\xff\xff",
                            ];
                            let word = words[random(words.len())].to_vec();
                            drop(bytes.splice(at..(at + word.len()).min(bytes.len()), word));
                        }
                        // a digit of a text becomes another: counts, offsets, indices
                        4 => {
                            let digits: Vec<usize> = (0..bytes.len())
                                .filter(|i| bytes[*i].is_ascii_digit())
                                .collect();
                            if let Some(at) = digits.get(random(digits.len())) {
                                bytes[*at] = b'0' + random(10) as u8;
                            }
                        }
                        _ if at < bytes.len() => bytes[at] ^= 1 << random(8),
                        _ => {}
                    }
                }
                match of_bytes(Path::new(name), &bytes) {
                    Ok(triangles) => {
                        let count = triangles.places.len() as u32;
                        let corners = triangles.corners.as_flattened();
                        assert!(corners.iter().all(|corner| *corner < count), "{name}");
                        read += 1;
                    }
                    Err(why) => {
                        assert!(!why.is_empty());
                        refused += 1;
                    }
                }
            }
            assert!(
                read > 5 && refused > 20,
                "{name}: {read} read, {refused} refused"
            );
        }
    }

    #[test]
    fn a_coarser_mesh_has_the_same_surface() {
        let fine = sphere(200);
        assert!(fine.corners.len() > 150_000);
        let coarse = coarser(&fine, 3000);
        assert!(coarse.corners.len() <= 3000 && coarse.corners.len() > 1000);
        let whole = 4.0 * std::f64::consts::PI;
        assert!(
            (area(&coarse) / whole - 1.0).abs() < 0.1,
            "{}",
            area(&coarse)
        );
        assert!((volume(&coarse) / (whole / 3.0) - 1.0).abs() < 0.1);
    }

    #[test]
    fn a_package_is_looked_for_around_the_file_that_names_it() {
        let folder = std::env::temp_dir().join(format!("bryant-mesh-{}", std::process::id()));
        let robot = folder.join("arm/urdf");
        std::fs::create_dir_all(&robot).unwrap();
        std::fs::create_dir_all(folder.join("arm/meshes")).unwrap();
        std::fs::write(folder.join("arm/meshes/a.stl"), "").unwrap();
        let found = |file: &str| {
            let mesh = model::Mesh {
                on: model::Body::Frame,
                of: model::Triangles::File(file.to_owned()),
                source: robot.join("arm.urdf").display().to_string(),
                line: 1,
                at: [0.0; 3],
                angles: [0.0; 3],
                scale: [1.0; 3],
            };
            found(&mesh, file)
        };
        let there = found("package://arm/meshes/a.stl").unwrap();
        assert!(there.is_file(), "{there:?}");
        assert!(found("../meshes/a.stl").unwrap().is_file());
        assert!(found("package://leg/a.stl").is_err());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
