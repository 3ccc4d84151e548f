//! A glTF file: its lists, its buffer, its bytes.

use super::shape::Shape;
use crate::pose::Vec3;
use crate::scene::Scene;
use serde_json::{Value, json};

/// A glTF file under construction.
pub struct File<'a> {
    /// What it shows.
    pub scene: &'a Scene,
    json: Value,
    binary: Vec<u8>,
    /// The accessor of the times.
    times: usize,
    /// The node of each body.
    pub bodies: Vec<usize>,
    /// Meshes of unit size with their colours: spheres and rods.
    meshes: Vec<(Shape, [f64; 4], usize)>,
    shapes: Vec<(Shape, Accessors)>,
}

/// The accessors of places, of normals if there are any, and of indices.
pub type Accessors = (usize, Option<usize>, usize);

impl<'a> File<'a> {
    /// An empty one.
    pub fn new(title: &str, scene: &'a Scene) -> Self {
        let half = f64::sqrt(0.5);
        let mut file = File {
            scene,
            json: json!({
                "asset": { "version": "2.0", "generator": format!("bryant {}", env!("CARGO_PKG_VERSION")) },
                "scene": 0,
                "scenes": [{ "name": title, "nodes": [0] }],
                "nodes": [{ "name": title, "rotation": [-half, 0.0, 0.0, half], "children": [] }],
                "meshes": [],
                "materials": [],
                "cameras": [],
                "accessors": [],
                "bufferViews": [],
                "animations": [{ "name": "run", "channels": [], "samplers": [] }],
            }),
            binary: Vec::new(),
            times: 0,
            bodies: Vec::new(),
            meshes: Vec::new(),
            shapes: Vec::new(),
        };
        // players expect that times begin at 0
        let times = scene.times.iter();
        let relative: Vec<f64> = times.map(|t| t - scene.times[0]).collect();
        file.times = file.floats(&relative, 1, None);
        file
    }

    /// A list of the file.
    pub fn list(&mut self, key: &str) -> &mut Vec<Value> {
        match &mut self.json[key] {
            Value::Array(list) => list,
            _ => unreachable!("all lists are made by `new`"),
        }
    }

    /// Adds an entry to a list; returns its index.
    pub fn add(&mut self, key: &str, value: Value) -> usize {
        let list = self.list(key);
        list.push(value);
        list.len() - 1
    }

    /// Adds a node below another one.
    pub fn node(&mut self, parent: usize, node: Value) -> usize {
        let index = self.add("nodes", node);
        let children = &mut self.json["nodes"][parent]["children"];
        match children {
            Value::Array(list) => list.push(json!(index)),
            other => *other = json!([index]),
        }
        index
    }

    /// Adds bytes to the buffer.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        while !self.binary.len().is_multiple_of(4) {
            self.binary.push(0);
        }
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.binary.extend_from_slice(bytes);
        self.add("bufferViews", view)
    }

    /// Adds an accessor of numbers, `width` of them in each entry, with their bounds.
    pub fn floats(&mut self, values: &[f64], width: usize, target: Option<u32>) -> usize {
        let single: Vec<f32> = values.iter().map(|value| *value as f32).collect();
        let bytes: Vec<u8> = single
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let view = self.view(&bytes, target);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        let of = |k: usize, first: f32, better: fn(f32, f32) -> f32| {
            single
                .iter()
                .skip(k)
                .step_by(width)
                .copied()
                .fold(first, better)
        };
        let low: Vec<f32> = (0..width).map(|k| of(k, f32::INFINITY, f32::min)).collect();
        let high: Vec<f32> = (0..width)
            .map(|k| of(k, f32::NEG_INFINITY, f32::max))
            .collect();
        let accessor = json!({
            "bufferView": view,
            "componentType": 5126,
            "count": values.len() / width,
            "type": kind,
            "min": low,
            "max": high,
        });
        self.add("accessors", accessor)
    }

    /// Adds an accessor of indices.
    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices
            .iter()
            .flat_map(|index| index.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(34963));
        let accessor = json!({ "bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR" });
        self.add("accessors", accessor)
    }

    /// The accessors of places, normals and indices.
    pub fn triangles(&mut self, places: &[Vec3], normals: &[Vec3], indices: &[u32]) -> Accessors {
        let places = self.floats(places.as_flattened(), 3, Some(34962));
        let normals = self.floats(normals.as_flattened(), 3, Some(34962));
        (places, Some(normals), self.indices(indices))
    }

    /// Adds a mesh in a colour.
    pub fn mesh(
        &mut self,
        name: &str,
        (places, normals, indices): Accessors,
        colour: [f64; 4],
    ) -> usize {
        let mut material = json!({
            "pbrMetallicRoughness": { "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.8 },
            "doubleSided": true,
        });
        if colour[3] < 1.0 {
            material["alphaMode"] = json!("BLEND");
        }
        let known = self
            .list("materials")
            .iter()
            .position(|other| *other == material);
        let material = match known {
            Some(index) => index,
            None => self.add("materials", material),
        };
        let mut attributes = json!({ "POSITION": places });
        if let Some(normals) = normals {
            attributes["NORMAL"] = json!(normals);
        }
        let primitive =
            json!({ "attributes": attributes, "indices": indices, "material": material });
        self.add("meshes", json!({ "name": name, "primitives": [primitive] }))
    }

    /// The mesh of a shape in a colour; each is made once.
    pub fn shape(&mut self, shape: Shape, colour: [f64; 4]) -> usize {
        if let Some((.., mesh)) = self
            .meshes
            .iter()
            .find(|(s, c, _)| *s == shape && *c == colour)
        {
            return *mesh;
        }
        let known = self.shapes.iter().find(|(s, _)| *s == shape);
        let accessors = match known.map(|(_, accessors)| *accessors) {
            Some(accessors) => accessors,
            None => {
                let (places, normals, indices) = shape.triangles();
                let accessors = self.triangles(&places, &normals, &indices);
                self.shapes.push((shape, accessors));
                accessors
            }
        };
        let mesh = self.mesh(shape.name(), accessors, colour);
        self.meshes.push((shape, colour, mesh));
        mesh
    }

    /// Adds keyframes of a node at all times. The first is also where the node rests: what shows the file without
    /// playing it shows the start.
    pub fn key(&mut self, node: usize, path: &str, values: &[f64], width: usize) {
        debug_assert_eq!(values.len(), width * self.scene.times.len());
        self.list("nodes")[node][path] = json!(values[..width]);
        let output = self.floats(values, width, None);
        self.channel(node, path, (self.times, output, "LINEAR"));
    }

    /// Adds keyframes of their own times, and how players go from one to the next.
    pub fn channel(&mut self, node: usize, path: &str, (input, output, how): (usize, usize, &str)) {
        let sampler = json!({ "input": input, "output": output, "interpolation": how });
        let channel = json!({ "node": node, "path": path });
        let animation = &mut self.json["animations"][0];
        let mut push = |key: &str, value: Value| match &mut animation[key] {
            Value::Array(list) => {
                list.push(value);
                list.len() - 1
            }
            _ => unreachable!("both lists are made by `new`"),
        };
        let sampler = push("samplers", sampler);
        push("channels", json!({ "sampler": sampler, "target": channel }));
    }

    /// The bytes of the file: a header, the JSON and the buffer, each a multiple of four bytes long.
    pub fn finish(mut self) -> Vec<u8> {
        while !self.binary.len().is_multiple_of(4) {
            self.binary.push(0);
        }
        self.json["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        // glTF has no empty lists
        if let Value::Object(map) = &mut self.json {
            map.retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        }
        let mut text = self.json.to_string().into_bytes();
        while !text.len().is_multiple_of(4) {
            text.push(b' ');
        }
        let total = 12 + 8 + text.len() + 8 + self.binary.len();
        let mut file = Vec::with_capacity(total);
        let word = |file: &mut Vec<u8>, word: u32| file.extend(word.to_le_bytes());
        for header in [0x4654_6C67, 2, total as u32, text.len() as u32, 0x4E4F_534A] {
            word(&mut file, header);
        }
        file.extend(text);
        word(&mut file, self.binary.len() as u32);
        word(&mut file, 0x004E_4942);
        file.extend(self.binary);
        file
    }
}
