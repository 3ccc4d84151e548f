use bryant_study::results::ranges;

#[test]
fn neighbours_are_named_together() {
    assert_eq!(ranges([0, 1, 2, 5, 7, 8].into_iter()), "0–2, 5, 7–8");
    assert!(ranges((0..100).map(|k| 2 * k)).ends_with(", 38, …"));
}
