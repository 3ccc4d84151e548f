use bryant::bundled::{all, file, find, scene};

#[test]
fn every_model_is_found_by_its_name() {
    assert!(!all().is_empty());
    for bundled in all() {
        let scene = scene(bundled).unwrap();
        assert_eq!(scene.model.name, bundled.name);
        assert!(find(bundled.name).is_some());
        assert!(scene.read.iter().all(|path| file(path).is_some()));
    }
}
