use bryant::criteria::mode;
use bryant_runtime::response::channel::Neck;

#[test]
fn the_mode_of_the_neck_is_told() {
    let critical = Neck {
        tension: 6806.0,
        compression: 6160.0,
        flexion: 310.0,
        extension: 135.0,
    };
    for (fx, fz, my, expected) in [
        (0.0, 680.6, 31.0, "tension and flexion"),
        (0.0, 680.6, -13.5, "tension and extension"),
        (0.0, -616.0, 31.0, "compression and flexion"),
        (0.0, -616.0, -13.5, "compression and extension"),
        // the shear force turns the moment: 10 − 0.01778 · 1000
        (1000.0, 0.0, 10.0, "tension and extension"),
    ] {
        let [fx, fz, my] = [fx, fz, my].map(|value| [0.0, value, 0.0]);
        let found = mode([&fx, &fz, &my], &critical, [0.0, 1e-4]);
        assert_eq!(found, format!("{expected} at 0.1 ms"));
    }
}
