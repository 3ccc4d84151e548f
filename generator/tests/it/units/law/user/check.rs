use bryant_generator::law::user::check::relative;
use std::path::Path;

#[test]
fn a_file_has_the_same_name_from_everywhere() {
    for (path, directory, name) in [
        ("models/drag.rs", "models", "drag.rs"),
        ("drag.rs", "", "drag.rs"),
        ("/a/models/parts/drag.rs", "/a/models", "parts/drag.rs"),
        ("../models/drag.rs", "models", "../../models/drag.rs"),
        (
            "/a/models/drag.rs",
            "/a/tests/models",
            "../../models/drag.rs",
        ),
        ("/a/drag.rs", "models", "/a/drag.rs"),
    ] {
        let found = relative(Path::new(path), Path::new(directory));
        assert_eq!(found, Path::new(name), "{path} from {directory}");
    }
}
