//! The compiled test models; each model in this list is also compared with its interpreted equations.

use crate::compiled_equations::Compiled;
use bryant_runtime::program::Entry;

macro_rules! models {
    (
        [$($module:ident = $file:literal,)*],
        in time: [$($timed:ident = $timed_file:literal,)*],
        in charts: [$($charted:ident = $charted_file:literal,)*],
        with states of laws: [$($lawful:ident = $lawful_file:literal,)*],
        without matrices: [$($plain:ident = $plain_file:literal,)*]
    ) => {
        $(
            #[doc = concat!("`models/", $lawful_file, ".yaml`")]
            pub mod $lawful {
                bryant_runtime::include_model!($lawful_file);
                use bryant_runtime::program::Entry;
                /// The model without its Jacobian.
                pub static ENTRY: Entry = Entry::without_jacobian::<Mechanism<f64>>();
            }
        )*
        $(
            #[doc = concat!("`models/", $timed_file, ".yaml`")]
            pub mod $timed {
                bryant_runtime::include_model!($timed_file);
                use bryant_runtime::program::Entry;
                /// The model without its Jacobian.
                pub static ENTRY: Entry = Entry::without_jacobian::<Mechanism<f64>>();
            }
        )*
        $(
            #[doc = concat!("`models/", $charted_file, ".yaml`")]
            pub mod $charted {
                bryant_runtime::include_model!($charted_file);
                use bryant_runtime::program::Entry;
                /// The model without its Jacobian.
                pub static ENTRY: Entry = Entry::without_jacobian::<Mechanism<f64>>();
            }
        )*
        $(
            #[doc = concat!("`models/", $file, ".yaml`")]
            pub mod $module {
                bryant_runtime::include_model!($file);
                use bryant_runtime::program::Entry;
                /// The model without its Jacobian.
                pub static ENTRY: Entry = Entry::without_jacobian::<Mechanism<f64>>();
            }
        )*
        $(
            #[doc = concat!("`models/large/", $plain_file, ".yaml`")]
            pub mod $plain {
                bryant_runtime::include_model!($plain_file);
            }
        )*

        /// Every test model.
        pub static MODELS: &[Compiled] = &[
            $(crate::compiled!(concat!("models/", $file, ".yaml"), $module),)*
            $(crate::compiled!(concat!("models/", $timed_file, ".yaml"), $timed, in t),)*
            $(crate::compiled!(concat!("models/", $charted_file, ".yaml"), $charted; m),)*
            $(Compiled {
                path: concat!("models/", $lawful_file, ".yaml"),
                entry: Entry::without_jacobian::<$lawful::Mechanism<f64>>(),
                // r_k also takes z and m
                matrices: None,
            },)*
            $(Compiled {
                path: concat!("models/large/", $plain_file, ".yaml"),
                entry: Entry::without_jacobian::<$plain::Mechanism<f64>>(),
                matrices: None,
            },)*
        ];
    };
}

models! {
    [
        belt_spring = "belt-spring",
        bounce = "bounce",
        curves = "curves",
        edge = "edge",
        edge_space = "edge-space",
        chest_drop = "chest-drop",
        double_pendulum_points = "double-pendulum-points",
        double_pendulum_rods = "double-pendulum-rods",
        elastic_joint = "elastic-joint",
        free_top = "free-top",
        free_tree = "free-tree",
        gripper = "gripper",
        heavy_top = "heavy-top",
        joint_stop = "joint-stop",
        kovalevskaya = "kovalevskaya",
        loads = "loads",
        motions = "motions",
        pendulum = "pendulum",
        prescribed = "prescribed",
        rocking = "rocking",
        slack_belt = "slack-belt",
        sliding_block = "sliding-block",
        sliding_sphere = "sliding-sphere",
        spherical_pendulum = "spherical-pendulum",
        tree2d = "tree2d",
        twin_joints = "twin-joints",
        twin_plane = "twin-plane",
        twin_space = "twin-space",
        user_joints = "user-joints",
        user_plane = "user-plane",
        user_space = "user-space",
        stops = "stops",
        vehicle = "vehicle",
        poles = "poles",
        vehicle_turned = "vehicle-turned",
    ],
    in time: [
        riders = "riders",
    ],
    in charts: [
        free_tree_bryant = "free-tree-bryant",
        poles_bryant = "poles-bryant",
    ],
    with states of laws: [
        bending = "bending",
        drives = "drives",
        elbow_hold = "elbow-hold",
        discs = "discs",
        incline = "incline",
        incline_space = "incline-space",
        joint_stops = "joint-stops",
        joints = "joints",
        plastic_bounce = "plastic-bounce",
        press = "press",
        restraints = "restraints",
        stones = "stones",
        switches = "switches",
        webbing = "webbing",
    ],
    without matrices: [
        chain100 = "chain100",
    ]
}
