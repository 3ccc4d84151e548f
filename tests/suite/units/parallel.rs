use bryant::parallel::map;

#[test]
fn results_are_in_order() {
    let items: Vec<usize> = (0..100).collect();
    let mut last = 0;
    let squares = map(&items, |i| i * i, &mut |done| last = done);
    assert_eq!(
        squares,
        items.iter().map(|i| Some(i * i)).collect::<Vec<_>>()
    );
    assert_eq!(last, 100);
    assert!(map(&[] as &[u8], |i| *i, &mut |_| {}).is_empty());
}
