use bryant::scene::mesh::outline;
use bryant::scene::mesh::outline::Point;

fn area(line: &[Point]) -> f64 {
    let pairs = line.windows(2);
    0.5 * pairs
        .map(|p| p[0][0] * p[1][1] - p[1][0] * p[0][1])
        .sum::<f64>()
}

#[test]
fn the_outline_of_a_frame_has_a_hole() {
    // a square of 4 with a square hole of 2, of eight triangles
    let outer = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let inner = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
    let places: Vec<Point> = outer.into_iter().chain(inner).collect();
    let triangles: Vec<[u32; 3]> = (0..4)
        .flat_map(|i| {
            let j = (i + 1) % 4;
            [[i, j, 4 + i], [j, 4 + j, 4 + i]]
        })
        .collect();
    let mut areas: Vec<f64> = outline(&places, &triangles)
        .iter()
        .map(|l| area(l))
        .collect();
    areas.sort_by(f64::total_cmp);
    assert_eq!(areas.len(), 2, "{areas:?}");
    // within a square of the grid, 4/160, along the edges of 8 and of 16
    assert!((areas[0] + 4.0).abs() < 8.0 / 40.0, "{areas:?}");
    assert!((areas[1] - 16.0).abs() < 16.0 / 40.0, "{areas:?}");
    assert!(
        outline(&places, &triangles)
            .iter()
            .all(|line| line.len() < 12)
    );
    assert!(outline(&[], &[]).is_empty());
}
