use bryant::scene::route::{CLEAR, Solid, band};
use bryant::scene::{from_to, length};

/// Around a sphere the shortest way is two tangents and an arc: √(d² − r²) each, and r (π − 2 acos(r/d)) between them.
#[test]
fn a_band_over_a_sphere_is_as_long_as_two_tangents_and_an_arc() {
    let sphere = Solid {
        center: [0.0; 3],
        scaled: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        degree: 2.0,
    };
    let (points, met) = band([-2.0, 0.0, 0.2], [2.0, 0.0, 0.2], &[sphere]);
    assert!(met);
    let sum: f64 = points
        .windows(2)
        .map(|ends| length(from_to(ends[0], ends[1])))
        .sum();
    let d = f64::hypot(2.0, 0.2);
    let angle = 2.0 * f64::atan2(2.0, 0.2) - 2.0 * (CLEAR / d).acos();
    let shortest = 2.0 * (d * d - CLEAR * CLEAR).sqrt() + CLEAR * angle;
    // chords of 1/24 of the way cut corners by less, and a band that is not yet tight is longer
    assert!((sum / shortest - 1.0).abs() < 0.02, "{sum} {shortest}");
    assert!(points.iter().all(|p| length(*p) > 1.0 && p[2] > 0.0));
    // a line that passes by is straight
    let sphere = Solid {
        center: [0.0, 3.0, 0.0],
        scaled: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        degree: 2.0,
    };
    assert!(!band([-2.0, 0.0, 0.2], [2.0, 0.0, 0.2], &[sphere]).1);
}
