//! The test models, compiled.

macro_rules! modules {
    ($($module:ident = $file:literal),* $(,)?) => {$(
        #[doc = concat!("`models/", $file, ".yaml`")]
        pub mod $module {
            bryant_runtime::include_model!($file);
        }
    )*};
}

modules! {
    belt_spring = "belt-spring",
    chain100 = "chain100",
    double_pendulum_points = "double-pendulum-points",
    double_pendulum_rods = "double-pendulum-rods",
    free_top = "free-top",
    free_tree = "free-tree",
    free_tree_bryant = "free-tree-bryant",
    heavy_top = "heavy-top",
    kovalevskaya = "kovalevskaya",
    pendulum = "pendulum",
    spherical_pendulum = "spherical-pendulum",
}
