use bryant::scene::mesh::stl::read;

#[test]
fn text_and_bytes_say_the_same() {
    let corners = [
        [0.0f32, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 3.0, 1.0],
        [0.0, 0.0, 4.0],
    ];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mut text = "solid a part\n".to_owned();
    // as some programs begin files of bytes
    let mut bytes = b"solid".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for face in faces {
        text += "facet normal 0 0 1\n outer loop\n";
        bytes.extend([0; 12]);
        for [x, y, z] in face.map(|corner: usize| corners[corner]) {
            text += &format!("  vertex {x:e} {y} {z}\n");
            bytes.extend([x, y, z].iter().flat_map(|x| x.to_le_bytes()));
        }
        text += " endloop\nendfacet\n";
        bytes.extend([0; 2]);
    }
    text += "endsolid\n";
    let (a, b) = (read(text.as_bytes()).unwrap(), read(&bytes).unwrap());
    assert_eq!(a, b);
    assert_eq!((a.places.len(), a.corners.len()), (4, 4));
    // a tetrahedron: (2 × 3 × 4) / 6
    assert!((super::volume(&a) - 4.0).abs() < 1e-12);
    bytes.pop();
    assert!(read(&bytes).is_err());
    assert!(read(b"solid vertex 1 2").is_err());
    assert!(read(b"").is_err());
}
