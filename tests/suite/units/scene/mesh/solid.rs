use super::volume;
use bryant::scene::mesh::solid::{AROUND, triangles};
use bryant_generator::description::mesh::Solid;
use std::f64::consts::PI;

#[test]
fn shapes_are_closed_and_of_length_1_along_each_axis() {
    // the circle is a polygon of n corners: n/2 sin(2π/n) r²
    let polygon = AROUND as f64 / 2.0 * libm::sin(2.0 * PI / AROUND as f64) * 0.25;
    for (solid, least, most) in [
        (Solid::Box, 1.0, 1.0),
        (Solid::Cylinder, polygon, polygon),
        (Solid::Sphere, 0.95 * PI / 6.0, PI / 6.0),
    ] {
        let of = triangles(solid);
        let found = volume(&of);
        let rounding = 1e-12;
        assert!(
            (least - rounding..=most + rounding).contains(&found),
            "{solid:?}: {found}"
        );
        for bound in of.around().as_flattened() {
            assert!((bound.abs() - 0.5).abs() < 1e-12, "{solid:?}");
        }
        // every edge is there once in each direction: by places, as corners at the axis are one
        let key = |i: u32| of.places[i as usize].map(|x| (1e9 * x).round() as i64);
        let mut edges: Vec<_> = (of.corners.iter())
            .flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)])
            .map(|(a, b)| (key(a), key(b)))
            .collect();
        edges.sort_unstable();
        let mut others: Vec<_> = edges.iter().map(|(a, b)| (*b, *a)).collect();
        others.sort_unstable();
        assert_eq!(edges, others, "{solid:?}");
        edges.dedup();
        assert_eq!(edges.len(), others.len(), "{solid:?}");
    }
}
