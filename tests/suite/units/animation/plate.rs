use bryant::animation::plate::Plate;
use bryant::pose::{cross, dot};
use bryant::scene::Plane;

#[test]
fn a_plate_is_a_closed_box_behind_its_plane() {
    let plane = Plane {
        name: String::new(),
        body: None,
        corners: [
            [0.0, 0.0, 1.0],
            [2.0, 0.0, 1.0],
            [2.0, 0.5, 1.0],
            [0.0, 0.5, 1.0],
        ],
        normal: [0.0, 0.0, 1.0],
    };
    for turned in [false, true] {
        let mut plane = plane.clone();
        if turned {
            plane.corners.reverse();
        }
        let plate = Plate::of(&plane);
        let place = |i: u32| plate.places[i as usize];
        // Σ a · (b × c)/6: counter-clockwise from outside all around
        let each = plate.corners.chunks(3);
        let volume: f64 = each
            .map(|c| dot(place(c[0]), cross(place(c[1]), place(c[2]))) / 6.0)
            .sum();
        assert!((volume - 2.0 * 0.5 * 0.01).abs() < 1e-12, "{volume}");
        assert!(
            plate
                .places
                .iter()
                .all(|p| p[2] <= 1.0 && p[2] >= 0.99 - 1e-12)
        );
    }
}
