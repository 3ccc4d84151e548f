use bryant_generator::target::machine::slots::Slots;

#[test]
fn the_lowest_free_slot_is_taken() {
    let mut slots = Slots::default();
    assert_eq!([0, 1, 2].map(|_| slots.take()), [0, 1, 2]);
    slots.give_back(1);
    slots.give_back(0);
    assert_eq!([0, 1, 2].map(|_| slots.take()), [0, 1, 3]);
    assert_eq!(slots.count(), 4);
}

#[test]
fn several_slots_stand_side_by_side() {
    let mut slots = Slots::default();
    assert_eq!(slots.take_several(130), 0);
    for slot in [3, 5, 6, 63, 64, 65] {
        slots.give_back(slot);
    }
    assert_eq!(slots.take_several(2), 5);
    assert_eq!(slots.take_several(3), 63);
    assert_eq!(slots.take_several(2), 130);
    assert_eq!(slots.take(), 3);
    assert_eq!(slots.take(), 132);
}
