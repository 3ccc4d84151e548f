use bryant::command::model_argument::{looks_like_path, nearest};

#[test]
fn near_misses_are_near() {
    let names = ["child-seat", "double-pendulum"];
    assert_eq!(nearest("childseat", &names), Some("child-seat"));
    assert_eq!(nearest("Child-Seat", &names), Some("child-seat"));
    assert_eq!(nearest("dummy", &names), None);
}

#[test]
fn paths_are_told_from_names() {
    assert!(looks_like_path("my.yaml") && looks_like_path("a/b") && looks_like_path("x.yml"));
    assert!(!looks_like_path("child-seat") && !looks_like_path("v1.2"));
}
