//! A simplified child in a child seat, and motions of it, for the tests of the pictures.

use bryant::picture::figure::figures;
use bryant::picture::{Arrangement, Figure, Instant, View, draw};
use bryant::scene::Scene;
use bryant_generator::law::types::{Against, Belt, BeltLength, Contact};
use bryant_generator::model::*;

fn vector(x: f64, y: f64, z: f64) -> [Number; 3] {
    [x, y, z].map(Number::from)
}

fn element(name: &str, parent: Option<usize>, at: [f64; 2], mass: f64, cg: [f64; 2]) -> Element {
    Element {
        name: name.into(),
        parent,
        at: vector(at[0], 0.0, at[1]),
        joint: Joint::Ball,
        mass: mass.into(),
        cg: vector(cg[0], 0.0, cg[1]),
        inertia: vector(0.01, mass * 0.004, 0.01),
        axes: vector(0.0, 0.0, 0.0),
        angles: vector(0.0, 0.0, 0.0),
        angular_velocity: vector(0.0, 0.0, 0.0),
        points: Vec::new(),
    }
}

fn on(element: usize, x: f64, z: f64) -> Attachment {
    Attachment {
        on: Body::Element(ElementId { system: 0, element }),
        at: vector(x, 0.0, z),
    }
}

fn frame(x: f64, z: f64) -> Attachment {
    Attachment {
        on: Body::Frame,
        at: vector(x, 0.0, z),
    }
}

fn curve() -> ScaledCurve {
    ScaledCurve {
        curve: 0,
        times: 1.0.into(),
        stretch: 1.0.into(),
        stiffness: false,
    }
}

fn contact(ellipsoid: Attachment, semi: [f64; 2], plane: Attachment, normal: [f64; 2]) -> Force {
    Force {
        name: "contact".into(),
        law: Box::new(Contact {
            ellipsoid: Ellipsoid {
                center: ellipsoid,
                semi_axes: vector(semi[0], semi[0], semi[1]),
                axes: vector(0.0, 0.0, 0.0),
            },
            degree: 2,
            against: Against::Plane(Plane {
                at: plane,
                normal: vector(normal[0], 0.0, normal[1]),
                tangent: vector(0.0, 0.0, 0.0),
                extent: None,
            }),
            elastic: Some(curve()),
            hysteresis: None,
            damping: None,
            damping_depth: None,
            friction: None,
            bristle: None,
        }),
        active: Active::default(),
    }
}

fn belt(from: Attachment, to: Attachment) -> Force {
    Force {
        name: "belt".into(),
        law: Box::new(Belt {
            from,
            to,
            rings: Vec::new(),
            force: curve(),
            hysteresis: None,
            damping: None,
            damping_stretch: None,
            length: BeltLength::Slack(0.01.into()),
            retractor: None,
            film_spool: None,
            pretensioner: None,
            limiter: None,
        }),
        active: Active::default(),
    }
}

/// A child with pelvis and trunk, head, thigh and shank on a seat with a back, with a lap belt and a shoulder strap.
pub fn child() -> Model {
    Model {
        name: "child-seat".into(),
        title: "a child of three in a forward-facing seat".into(),
        dimension: Dimension::Plane,
        coordinates: Coordinates::Bryant,
        parameters: Vec::new(),
        curves: vec![Curve {
            name: "webbing".into(),
            points: vec![[0.0, 0.0], [1.0, 1.0]],
            interpolate: Interpolate::Linear,
            extrapolate: Extrapolate::Linear,
            states_extrapolation: true,
            thinned: None,
        }],
        vehicles: Vec::new(),
        systems: vec![System {
            name: "child".into(),
            elements: vec![
                element("torso", None, [0.0, 0.0], 6.5, [0.0, 0.13]),
                element("head", Some(0), [0.014, 0.33], 2.7, [0.02, 0.08]),
                element("thigh", Some(0), [0.0, 0.0], 1.9, [0.089, 0.0]),
                element("shank", Some(2), [0.198, 0.0], 1.8, [0.012, -0.128]),
            ],
            reference: Reference::Free,
            position: vector(0.0, 0.0, 0.3),
            velocity: vector(0.0, 0.0, 0.0),
        }],
        forces: vec![
            contact(
                on(0, 0.0, 0.02),
                [0.075, 0.065],
                frame(0.0, 0.26),
                [-0.17, 0.985],
            ),
            contact(
                on(0, 0.0, 0.02),
                [0.075, 0.065],
                frame(-0.08, 0.3),
                [0.97, 0.24],
            ),
            contact(
                on(0, 0.01, 0.18),
                [0.073, 0.14],
                frame(-0.08, 0.3),
                [0.97, 0.24],
            ),
            contact(
                on(1, 0.02, 0.08),
                [0.089, 0.088],
                frame(-0.08, 0.3),
                [0.97, 0.24],
            ),
            belt(on(0, 0.05, 0.03), frame(-0.12, 0.2)),
            belt(on(0, 0.08, 0.26), frame(-0.15, 0.62)),
        ],
        switches: Vec::new(),
        outputs: Vec::new(),
        run: Run {
            duration: 0.12,
            every: 0.002,
        },
        shown: Vec::new(),
        units: Default::default(),
        digest: String::new(),
    }
}

/// Names of the coordinates of [`child`].
pub fn names() -> Vec<String> {
    ["x", "z"]
        .iter()
        .map(|axis| format!("child.{axis}"))
        .chain(["torso", "head", "thigh", "shank"].map(|e| format!("child/{e}.angle")))
        .collect()
}

/// A forward motion of the child, made by hand.
pub fn lurch(count: usize) -> Vec<Instant> {
    let instant = |k: usize| {
        let s = k as f64 / (count - 1).max(1) as f64;
        Instant {
            state: Vec::new(),
            time: 0.12 * s,
            coordinates: vec![
                0.12 * s * s,
                0.3 - 0.02 * s,
                -0.25 + 0.9 * s * s,
                -0.1 + 1.6 * s * s * s,
                -0.15 - 0.2 * s,
                -0.6 * s,
            ],
        }
    };
    (0..count).map(instant).collect()
}

fn written(name: &str, svg: &str) {
    // To look at the pictures, name a directory by BRYANT_PICTURES.
    if let Some(directory) = std::env::var_os("BRYANT_PICTURES") {
        std::fs::write(std::path::Path::new(&directory).join(name), svg).unwrap();
    }
}

fn drawn(
    model: &Model,
    instants: &[Instant],
    arrangement: Arrangement,
    view: View,
) -> bryant_picture::Drawing {
    let scene = Scene::new(model, &names(), &[], instants, &[]).unwrap();
    let times = scene.times.clone();
    draw(model, &scene, &times, arrangement, view)
}

/// The stick figures of a motion side by side, from the side.
fn in_a_row(model: &Model, instants: &[Instant]) -> String {
    drawn(model, instants, Arrangement::Row, View::Side).svg()
}

fn count(svg: &str, what: &str) -> usize {
    svg.matches(what).count()
}

#[test]
fn every_time_has_a_panel_with_everything_in_it() {
    let svg = in_a_row(&child(), &lurch(7));
    written("row.svg", &svg);
    assert_eq!(count(&svg, "class=\"panel\""), 7);
    assert!(svg.contains(">0 ms<") && svg.contains(">20 ms<") && svg.contains(">120 ms<"));
    // torso, thigh with its two ends, and one line of the legend
    assert_eq!(count(&svg, "class=\"bone s0\""), 7 * 4 + 1);
    assert_eq!(count(&svg, "class=\"ellipse s0\""), 7 * 3);
    assert_eq!(count(&svg, "class=\"plane\""), 7 * 2 + 1);
    assert_eq!(count(&svg, "<g "), count(&svg, "</g>"));
    assert!(svg.contains("x [m]") && svg.contains("z [m]"));
}

#[test]
fn overlay_has_one_panel() {
    let svg = drawn(&child(), &lurch(5), Arrangement::Overlay, View::Side).svg();
    written("overlay.svg", &svg);
    assert_eq!(count(&svg, "class=\"panel\""), 1);
    // The legend shows the system and every time in its shade.
    assert_eq!(count(&svg, "class=\"bone s0\""), 5 * 4 + 1 + 5);
    assert_eq!(count(&svg, "<g "), count(&svg, "</g>"));
}

#[test]
fn a_slack_belt_is_dashed_and_a_taut_one_is_not() {
    let svg = in_a_row(&child(), &lurch(2));
    // Both begin with 10 mm of slack; the lurch of 0.12 m stretches both.
    assert_eq!(count(&svg, "<line class=\"slack\""), 2 + 1);
    assert_eq!(count(&svg, "<line class=\"taut\""), 2 + 1);
}

#[test]
fn a_motion_that_went_wrong_is_drawn_up_to_there() {
    let mut instants = lurch(4);
    instants[3].coordinates[1] = f64::NAN;
    let svg = in_a_row(&child(), &instants);
    assert_eq!(count(&svg, "class=\"panel\""), 3);
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn names_that_do_not_fit_are_an_error() {
    let error = Scene::new(&child(), &names()[..4], &[], &lurch(2), &[]).unwrap_err();
    assert!(error.to_string().contains("child/thigh"), "{error}");
}

#[test]
fn titles_are_escaped() {
    let mut model = child();
    model.title = "a < b & \"c\"".into();
    let svg = in_a_row(&model, &lurch(2));
    assert!(svg.contains("a &lt; b &amp; &quot;c&quot;"));
}

/// The raster format draws all parts of these pictures.
#[test]
fn every_picture_of_ours_can_be_had_as_png() {
    let stick = |arrangement, view| drawn(&child(), &lurch(5), arrangement, view);
    let pictures = [
        ("row", stick(Arrangement::Row, View::Side)),
        ("overlay", stick(Arrangement::Overlay, View::Side)),
        ("oblique", stick(Arrangement::Row, View::Oblique)),
        ("diagram", super::work_precision::diagram().drawing()),
    ];
    for (name, drawing) in pictures {
        let png = drawing.png().unwrap();
        assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n", "{name}");
        // To look at the pictures, name a directory by BRYANT_PICTURES.
        if let Some(directory) = std::env::var_os("BRYANT_PICTURES") {
            let path = std::path::Path::new(&directory);
            std::fs::write(path.join(format!("{name}.png")), &png).unwrap();
            std::fs::write(path.join(format!("{name}.svg")), drawing.svg()).unwrap();
        }
    }
}

/// A ball over a shelf with an end: the shelf is drawn up to its end, not up to the place where the ball flies.
#[test]
fn a_plane_is_drawn_as_far_as_it_extends() {
    let widths = |extent: Option<f64>| {
        let mut model = child();
        let contact = model.forces[0].law.get_mut::<Contact>();
        let contact = contact.expect("the first is a contact");
        let Against::Plane(plane) = &mut contact.against else {
            panic!("of a plane");
        };
        plane.normal = vector(0.0, 0.0, 1.0);
        plane.extent = extent.map(|half| Extent {
            half_lengths: vec![half.into()],
            rule: EdgeRule::Cut,
        });
        let mut instants = lurch(3);
        instants[2].coordinates[0] = 4.0;
        let scene = Scene::new(&model, &names(), &[], &instants, &[]).unwrap();
        let figures = figures(&scene, View::Side, None);
        let width = |figure: &Figure| {
            let plane = figure.planes[0];
            assert!((plane.normal[1] - 1.0).abs() < 1e-12);
            plane.to[0] - plane.from[0]
        };
        figures.iter().map(width).collect::<Vec<_>>()
    };
    for width in widths(Some(0.45)) {
        assert!((width.abs() - 0.9).abs() < 1e-12, "{width}");
    }
    // a shelf without end reaches as far as needed
    for width in widths(None) {
        assert!(width.abs() > 4.0 && width.abs() < 4.5, "{width}");
    }
}
