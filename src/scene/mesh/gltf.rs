//! glTF 2.0, as text or as bytes (GLB): triangles of all meshes of the scene, where its nodes put them. In the file y
//! is up, here z. Skins, morphs and compressed meshes are not read.

use super::Triangles;
use crate::pose::Vec3;
use serde_json::Value;
use std::path::Path;

/// Nodes are nested at most so deep.
const DEEP: usize = 64;

/// A matrix that moves places: three rows of four.
type Move = [[f64; 4]; 3];

/// From y up to z up.
const UP: Move = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
];

/// The triangles of a file. Its buffers may be files of their own, in `folder`.
pub fn read(bytes: &[u8], folder: &Path) -> Result<Triangles, String> {
    let (json, binary) = match bytes.starts_with(b"glTF") {
        true => chunks(bytes).ok_or("it is cut off")?,
        false => (bytes, None),
    };
    let json: Value = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    let buffers =
        list(&json["buffers"])
            .iter()
            .map(|buffer| match (buffer["uri"].as_str(), binary) {
                (None, Some(binary)) => Ok(binary.to_vec()),
                (None, None) => Err("a buffer is missing".to_owned()),
                (Some(uri), _) => match uri
                    .strip_prefix("data:")
                    .and_then(|rest| rest.split_once(','))
                {
                    Some((_, text)) => base64(text).ok_or("a buffer is no base64".to_owned()),
                    None => super::bytes(&folder.join(uri)),
                },
            });
    let mut file = File {
        buffers: buffers.collect::<Result<_, _>>()?,
        json: &json,
        triangles: Triangles::default(),
    };
    let scene = json["scene"].as_u64().unwrap_or(0) as usize;
    for node in list(&json["scenes"][scene]["nodes"]) {
        file.node(node, &UP, 0)?;
    }
    Ok(file.triangles)
}

/// The JSON and the buffer of a file of bytes.
fn chunks(bytes: &[u8]) -> Option<(&[u8], Option<&[u8]>)> {
    let word = |at: usize| {
        let bytes = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize)
    };
    let json = bytes.get(20..20usize.checked_add(word(12)?)?)?;
    let next = 20 + json.len();
    let binary = word(next).and_then(|length| bytes.get(next + 8..(next + 8).checked_add(length)?));
    Some((json, binary))
}

struct File<'a> {
    json: &'a Value,
    buffers: Vec<Vec<u8>>,
    triangles: Triangles,
}

impl File<'_> {
    /// Adds the meshes of a node and of those below it.
    fn node(&mut self, index: &Value, above: &Move, depth: usize) -> Result<(), String> {
        if depth > DEEP {
            return Err("its nodes are nested too deep".into());
        }
        let json = self.json;
        let node = at(&json["nodes"], index);
        let here = product(above, &moved(node));
        if !node["mesh"].is_null() {
            for primitive in list(&at(&json["meshes"], &node["mesh"])["primitives"]) {
                self.primitive(primitive, &here)?;
            }
        }
        for child in list(&node["children"]) {
            self.node(child, &here, depth + 1)?;
        }
        Ok(())
    }

    fn primitive(&mut self, primitive: &Value, here: &Move) -> Result<(), String> {
        let draco = &primitive["extensions"]["KHR_draco_mesh_compression"];
        if !draco.is_null() {
            return Err("a mesh is compressed (KHR_draco_mesh_compression)".into());
        }
        // points and lines are left out
        let mode = primitive["mode"].as_u64().unwrap_or(4);
        if !(4..=6).contains(&mode) {
            return Ok(());
        }
        let places = self.numbers(&primitive["attributes"]["POSITION"], 3)?;
        let places: Vec<Vec3> = places.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        let corners: Vec<u32> = match primitive["indices"].is_null() {
            true => (0..places.len() as u32).collect(),
            false => {
                let numbers = self.numbers(&primitive["indices"], 1)?;
                numbers.iter().map(|index| *index as u32).collect()
            }
        };
        if corners
            .iter()
            .any(|corner| *corner as usize >= places.len())
        {
            return Err("a triangle has a corner that does not exist".into());
        }
        let first = self.triangles.places.len() as u32;
        self.triangles
            .places
            .extend(places.iter().map(|place| applied(here, *place)));
        let triples: Vec<[u32; 3]> = match mode {
            4 => corners
                .chunks_exact(3)
                .map(|c| [c[0], c[1], c[2]])
                .collect(),
            // every second triangle of a strip is the other way round
            5 => corners
                .windows(3)
                .enumerate()
                .map(|(i, c)| {
                    if i % 2 == 0 {
                        [c[0], c[1], c[2]]
                    } else {
                        [c[1], c[0], c[2]]
                    }
                })
                .collect(),
            _ => corners
                .get(1..)
                .unwrap_or_default()
                .windows(2)
                .map(|c| [corners[0], c[0], c[1]])
                .collect(),
        };
        let mirrored = determinant(here) < 0.0;
        self.triangles
            .corners
            .extend(triples.iter().map(|[a, b, c]| match mirrored {
                true => [first + a, first + c, first + b],
                false => [first + a, first + b, first + c],
            }));
        Ok(())
    }

    /// The numbers of an accessor with `width` of them in each entry.
    fn numbers(&self, accessor: &Value, width: usize) -> Result<Vec<f64>, String> {
        let accessor = at(&self.json["accessors"], accessor);
        if !accessor["sparse"].is_null() {
            return Err("an accessor is sparse".into());
        }
        let view = at(&self.json["bufferViews"], &accessor["bufferView"]);
        let whole = |value: &Value| value.as_u64().unwrap_or(0) as usize;
        let kind = whole(&accessor["componentType"]);
        let size = match kind {
            5121 => 1,
            5123 => 2,
            5125 | 5126 => 4,
            _ => return Err(format!("numbers of the type {kind} are not read")),
        };
        let (begin, count) = (
            whole(&view["byteOffset"]) + whole(&accessor["byteOffset"]),
            whole(&accessor["count"]),
        );
        let stride = match whole(&view["byteStride"]) {
            0 => size * width,
            stride => stride,
        };
        let buffer = self
            .buffers
            .get(whole(&view["buffer"]))
            .map_or(&[][..], Vec::as_slice);
        let number = |at: usize| -> Option<f64> {
            let bytes = buffer.get(at..at + size)?;
            Some(match kind {
                5121 => f64::from(bytes[0]),
                5123 => f64::from(u16::from_le_bytes([bytes[0], bytes[1]])),
                5125 => f64::from(u32::from_le_bytes(bytes.try_into().ok()?)),
                _ => f64::from(f32::from_le_bytes(bytes.try_into().ok()?)),
            })
        };
        if count > buffer.len() {
            return Err("a buffer is too short".into());
        }
        let entries =
            (0..count).flat_map(|i| (0..width).map(move |k| begin + i * stride + k * size));
        let numbers: Option<Vec<f64>> = entries.map(number).collect();
        numbers.ok_or("a buffer is too short".into())
    }
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// The entry of a list that an index names.
fn at<'a>(all: &'a Value, index: &Value) -> &'a Value {
    static NOTHING: Value = Value::Null;
    index
        .as_u64()
        .and_then(|index| all.get(index as usize))
        .unwrap_or(&NOTHING)
}

/// Where a node puts what is in it.
fn moved(node: &Value) -> Move {
    let numbers = |key: &str, otherwise: &[f64]| -> Vec<f64> {
        let all: Vec<f64> = list(&node[key]).iter().filter_map(Value::as_f64).collect();
        if all.len() == otherwise.len() {
            all
        } else {
            otherwise.to_vec()
        }
    };
    // by columns
    let matrix = numbers("matrix", &[0.0; 16]);
    if matrix[15] != 0.0 {
        return std::array::from_fn(|i| std::array::from_fn(|j| matrix[4 * j + i]));
    }
    let by = numbers("translation", &[0.0; 3]);
    let q = numbers("rotation", &[0.0, 0.0, 0.0, 1.0]);
    let scale = numbers("scale", &[1.0; 3]);
    let turn = crate::pose::rotation(&[q[3], q[0], q[1], q[2]]);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| if j < 3 { turn[i][j] * scale[j] } else { by[i] })
    })
}

fn applied(by: &Move, [x, y, z]: Vec3) -> Vec3 {
    by.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
}

fn product(a: &Move, b: &Move) -> Move {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let sum: f64 = (0..3).map(|k| a[i][k] * b[k][j]).sum();
            if j == 3 { sum + a[i][3] } else { sum }
        })
    })
}

fn determinant(of: &Move) -> f64 {
    let row = |i: usize| [of[i][0], of[i][1], of[i][2]];
    crate::pose::dot(row(0), crate::pose::cross(row(1), row(2)))
}

/// The bytes of base64; `None` where it is none.
fn base64(text: &str) -> Option<Vec<u8>> {
    let value = |letter: u8| match letter {
        b'A'..=b'Z' => Some(letter - b'A'),
        b'a'..=b'z' => Some(letter - b'a' + 26),
        b'0'..=b'9' => Some(letter - b'0' + 52),
        b'+' | b'-' => Some(62),
        b'/' | b'_' => Some(63),
        _ => None,
    };
    let letters = text.trim_end_matches('=').bytes();
    let (mut bytes, mut bits, mut held) = (Vec::new(), 0u32, 0);
    for letter in letters {
        bits = bits << 6 | u32::from(value(letter)?);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
            bits &= (1 << held) - 1;
        }
    }
    Some(bytes)
}
