//! OBJ of Wavefront: places and the faces between them, as text. Materials, normals and textures are not used.

use super::Triangles;

/// The triangles of a file; a face of more corners becomes a fan.
pub fn read(bytes: &[u8]) -> Result<Triangles, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut triangles = Triangles::default();
    for (index, line) in text.lines().enumerate() {
        let wrong = |what: &str| format!("line {}: {what}", index + 1);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut number = || words.next().and_then(|word| word.parse().ok());
                let (Some(x), Some(y), Some(z)) = (number(), number(), number()) else {
                    return Err(wrong("a place has three numbers"));
                };
                triangles.places.push([x, y, z]);
            }
            Some("f") => {
                let count = triangles.places.len() as i64;
                // place/texture/normal, from 1, or from the end below 0
                let corner = |word: &str| {
                    let number: i64 = word.split('/').next()?.parse().ok()?;
                    let index = if number < 0 {
                        count + number
                    } else {
                        number - 1
                    };
                    (0..count).contains(&index).then_some(index as u32)
                };
                let corners: Option<Vec<u32>> = words.map(corner).collect();
                let corners =
                    corners.ok_or_else(|| wrong("a corner of this face does not exist"))?;
                for two in corners.get(1..).unwrap_or_default().windows(2) {
                    triangles.corners.push([corners[0], two[0], two[1]]);
                }
            }
            _ => {}
        }
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_four_corners_and_of_all_notations() {
        // a cube of edge 2, its faces counter-clockwise from outside
        let text = "# a cube\nmtllib a.mtl\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nvn 0 0 1\n\
                    f 4 3 2 1\nf 5//1 6//1 7//1 8//1\nf 1/1/1 2/1/1 6/1/1 5/1/1\nf 2 3 7 6\nf 3 4 8 7\nf -5 -8 -4 -1\n";
        let cube = read(text.as_bytes()).unwrap();
        assert_eq!((cube.places.len(), cube.corners.len()), (8, 12));
        assert_eq!(super::super::volume(&cube), 8.0);
        assert_eq!(super::super::area(&cube), 24.0);
        assert!(read(b"v 1 2\n").unwrap_err().contains("line 1"));
        assert!(read(b"v 1 2 3\nf 1 2 3\n").unwrap_err().contains("line 2"));
    }
}
