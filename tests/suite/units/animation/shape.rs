use bryant::animation::shape::{rod, sphere};
use bryant::pose::cross;

/// Triangles are counter-clockwise about their normals.
#[test]
fn meshes_look_outward() {
    for (places, normals, indices) in [sphere(2), sphere(8), rod()] {
        for three in indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|k| places[three[k] as usize]);
            let sides = [b, c].map(|p| std::array::from_fn(|i| p[i] - a[i]));
            let area = cross(sides[0], sides[1]);
            let outward: f64 = three
                .iter()
                .map(|k| normals[*k as usize])
                .map(|n| n.iter().zip(area).map(|(n, a)| n * a).sum::<f64>())
                .sum();
            assert!(outward >= -1e-12, "{three:?}");
        }
    }
}
