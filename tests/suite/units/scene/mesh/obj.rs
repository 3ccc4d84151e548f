use bryant::scene::mesh::obj::read;

#[test]
fn faces_of_four_corners_and_of_all_notations() {
    // a cube of edge 2, its faces counter-clockwise from outside
    let text = "# a cube\nmtllib a.mtl\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nvn 0 0 1\n\
                    f 4 3 2 1\nf 5//1 6//1 7//1 8//1\nf 1/1/1 2/1/1 6/1/1 5/1/1\nf 2 3 7 6\nf 3 4 8 7\nf -5 -8 -4 -1\n";
    let cube = read(text.as_bytes()).unwrap();
    assert_eq!((cube.places.len(), cube.corners.len()), (8, 12));
    assert_eq!(super::volume(&cube), 8.0);
    assert_eq!(super::area(&cube), 24.0);
    assert!(read(b"v 1 2\n").unwrap_err().contains("line 1"));
    assert!(read(b"v 1 2 3\nf 1 2 3\n").unwrap_err().contains("line 2"));
}
