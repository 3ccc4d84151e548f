mod gltf;
mod obj;
mod outline;
mod solid;
mod stl;

use bryant::pose::{cross, dot};
use bryant::scene::mesh::{Triangles, coarser, found, of_bytes};
use bryant::scene::{from_to, length};
use bryant_generator::model;
use std::path::Path;

/// Area of a surface \[m²\].
pub fn area(triangles: &Triangles) -> f64 {
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|c| triangles.places[c as usize]);
        let sides = [b, c].map(|end| from_to(a, end));
        0.5 * length(cross(sides[0], sides[1]))
    };
    triangles.corners.iter().map(area).sum()
}

/// Volume inside of a closed surface \[m³\]: positive if its triangles are counter-clockwise from outside.
pub fn volume(triangles: &Triangles) -> f64 {
    let part = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|c| triangles.places[c as usize]);
        dot(a, cross(b, c)) / 6.0
    };
    triangles.corners.iter().map(part).sum()
}

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
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
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
