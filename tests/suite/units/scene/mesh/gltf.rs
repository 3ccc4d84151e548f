use bryant::scene::mesh::gltf::read;
use std::path::Path;

/// A triangle of the standard's own example (Khronos, "Triangle" of glTF-Sample-Models): its buffer is in the text.
const TRIANGLE: &str = r#"{ "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "translation": [0, 2, 0], "scale": [3, 1, 1] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 1 }, "indices": 0 }] }],
        "buffers": [{ "uri": "data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=", "byteLength": 44 }],
        "bufferViews": [{ "buffer": 0, "byteOffset": 0, "byteLength": 6, "target": 34963 }, { "buffer": 0, "byteOffset": 8, "byteLength": 36, "target": 34962 }],
        "accessors": [{ "bufferView": 0, "byteOffset": 0, "componentType": 5123, "count": 3, "type": "SCALAR" },
                      { "bufferView": 1, "byteOffset": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
        "asset": { "version": "2.0" } }"#;

#[test]
fn the_triangle_of_the_standard_stands_upright() {
    let found = read(TRIANGLE.as_bytes(), Path::new("")).unwrap();
    // (0, 0, 0), (1, 0, 0), (0, 1, 0), three times as wide and 2 higher; y of the file is z here
    assert_eq!(
        found.places,
        [[0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [0.0, 0.0, 3.0]]
    );
    assert_eq!(found.corners, [[0, 1, 2]]);
    let cut = TRIANGLE.replace("AAAAAAAAAAAAAAAAAACAPwAAAAA=", "");
    assert!(read(cut.as_bytes(), Path::new("")).is_err());
    let deep = TRIANGLE.replace("\"mesh\": 0,", "\"mesh\": 0, \"children\": [0],");
    assert!(read(deep.as_bytes(), Path::new("")).is_err());
}
