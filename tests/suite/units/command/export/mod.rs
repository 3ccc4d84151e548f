mod library;

use bryant::command::export::identifier;

#[test]
fn identifiers_are_those_of_c() {
    assert_eq!(identifier("child-seat"), "child_seat");
    assert_eq!(identifier("15-dummy"), "model_15_dummy");
    assert_eq!(identifier("Kopfstütze"), "Kopfst_tze");
}
