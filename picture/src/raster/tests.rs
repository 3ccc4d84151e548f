use super::*;
use crate::drawing::Anchor;

const STYLE: &str = "\
text{font-family:'DejaVu Sans',sans-serif;font-size:16px}
.red{fill:#f00}
.line{stroke:#000;stroke-width:2}
.dashed{stroke-dasharray:4 4}
";

fn blank() -> Drawing {
    Drawing::new(40.0, 20.0, "", STYLE)
}

/// Red, green and blue at a pixel of the drawing, from the first pixel of its raster.
fn colour(drawing: &Drawing, [x, y]: [usize; 2]) -> [u8; 3] {
    let ([width, height], points) = points(drawing).unwrap();
    assert_eq!((width, height), (80, 40));
    let at = 3 * (2 * y * width + 2 * x);
    [points[at], points[at + 1], points[at + 2]]
}

/// The amount of ink, as the number of black pixels of the raster with the same sum.
fn ink(drawing: &Drawing) -> f64 {
    let (_, points) = points(drawing).unwrap();
    let greens = points.iter().skip(1).step_by(3);
    greens.map(|green| f64::from(255 - green) / 255.0).sum()
}

const WHITE: [u8; 3] = [255; 3];

#[test]
fn areas_are_those_of_geometry() {
    let area = |draw: &dyn Fn(&mut Drawing)| {
        let mut drawing = blank();
        draw(&mut drawing);
        // 4 pixels of the raster are one pixel of the drawing
        ink(&drawing) / 4.0
    };
    let close = |area: f64, expected: f64| {
        assert!((area / expected - 1.0).abs() < 0.01, "{area}, {expected}");
    };
    let rectangle = area(&|d| d.rectangle("", [3.1, 4.2, 10.3, 5.4]));
    close(rectangle, 10.3 * 5.4);
    let pi = std::f64::consts::PI;
    close(area(&|d| d.circle("", [20.0, 10.0], 7.0)), pi * 49.0);
    let ellipse = area(&|d| d.ellipse("", [20.0, 10.0], [9.0, 3.0], 30.0));
    close(ellipse, pi * 27.0);
    close(
        area(&|d| d.line("line", [5.0, 5.0], [29.0, 15.0])),
        2.0 * 26.0,
    );
    // two dashes of 4 and a gap of 4 between them
    let dashed = area(&|d| d.line("line dashed", [10.0, 10.0], [22.0, 10.0]));
    close(dashed, 2.0 * 8.0);
    let crossing = [([10.0, 10.0], [20.0, 10.0]), ([15.0, 5.0], [15.0, 15.0])];
    close(
        area(&|d| d.lines("line", &crossing)),
        2.0 * 10.0 + 2.0 * 8.0,
    );
}

#[test]
fn an_ellipse_turns_clockwise() {
    let mut drawing = blank();
    drawing.ellipse("red", [20.0, 10.0], [9.0, 2.0], 45.0);
    assert_eq!(colour(&drawing, [24, 14]), [255, 0, 0]);
    assert_eq!(colour(&drawing, [24, 6]), WHITE);
}

#[test]
fn what_is_outside_of_a_clip_is_cut_off() {
    let mut drawing = blank();
    drawing.open_clipped("half", [0.0, 0.0, 10.25, 20.0]);
    drawing.rectangle("red", [5.0, 5.0, 30.0, 10.0]);
    drawing.close();
    drawing.rectangle("red", [30.0, 5.0, 2.0, 10.0]);
    assert_eq!(colour(&drawing, [9, 10]), [255, 0, 0]);
    // half of this pixel is inside
    assert_eq!(colour(&drawing, [10, 10]), [255, 128, 128]);
    assert_eq!(colour(&drawing, [11, 10]), WHITE);
    assert_eq!(colour(&drawing, [31, 10]), [255, 0, 0]);
}

#[test]
fn a_group_is_drawn_by_itself_before_its_opacity_counts() {
    let mut drawing = blank();
    drawing.open("", 0.5);
    for x in [5.0, 7.0] {
        drawing.rectangle("red", [x, 5.0, 10.0, 10.0]);
    }
    drawing.close();
    // the overlap at [10, 10] looks like one rectangle alone at [6, 10]
    assert_eq!(colour(&drawing, [6, 10]), [255, 128, 128]);
    assert_eq!(colour(&drawing, [10, 10]), [255, 128, 128]);
}

#[test]
fn text_is_drawn_without_fonts_of_the_system() {
    let label = |text: &str, x: f64, anchor| {
        let mut drawing = blank();
        drawing.label("", [x, 16.0], anchor, text);
        drawing
    };
    assert_eq!(ink(&label(" ", 2.0, Anchor::Start)), 0.0);
    for text in ["M", "10⁻⁶", "≤", "\u{fffff}"] {
        assert!(ink(&label(text, 2.0, Anchor::Start)) > 20.0, "{text}");
    }
    // In the font, the outline of "=" is two bars of 1282 by 170, of 2048 units per em; the upper one is 168 high.
    let equals = ink(&label("=", 2.0, Anchor::Start)) / 4.0;
    let outline = 1282.0 * (168.0 + 170.0) * (16.0f64 / 2048.0).powi(2);
    assert!((equals / outline - 1.0).abs() < 0.01, "{equals}, {outline}");
    // an anchor moves the text by its width, which is a whole number of pixels here: 2048 units are 32 pixels, and "—"
    // has 2048
    let starts = points(&label("—", 2.0, Anchor::Start)).unwrap();
    assert_eq!(starts, points(&label("—", 10.0, Anchor::Middle)).unwrap());
    assert_eq!(starts, points(&label("—", 18.0, Anchor::End)).unwrap());
    // "AV" is kerned: it is narrower than its letters together
    let ends = |text| {
        let (_, points) = points(&label(text, 2.0, Anchor::Start)).unwrap();
        let columns = points.chunks(3).enumerate().filter(|(_, c)| c[0] < 255);
        columns.map(|(i, _)| i % 80).max().unwrap()
    };
    assert!(ends("AVA") < ends("AHA"));
}

#[test]
fn a_file_holds_every_point() {
    let mut drawing = blank();
    drawing.open("", 0.5);
    drawing.label("red", [2.0, 16.0], Anchor::Start, "AV");
    drawing.close();
    drawing.polyline("line", &[[1.0, 1.0], [30.0, 12.0], [39.0, 3.0]]);
    let png = drawing.png().unwrap();
    let ([width, height], points) = points(&drawing).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(png[16..20], (width as u32).to_be_bytes());
    assert_eq!(png[20..24], (height as u32).to_be_bytes());
    let length = |block: &[u8]| u32::from_be_bytes([block[0], block[1], block[2], block[3]]);
    // a text names the program
    let text = &png[33..];
    assert_eq!(&text[4..8], b"tEXt");
    let block = &text[length(text) as usize + 12..];
    let length = length(block) as usize;
    assert_eq!(&block[4..8], b"IDAT");
    let compressed = &block[8..8 + length];
    let rows = miniz_oxide::inflate::decompress_to_vec_zlib(compressed).unwrap();
    let rows = rows.chunks(1 + 3 * width).flat_map(|row| &row[1..]);
    assert!(rows.eq(&points));
    assert_eq!(block.len(), 8 + length + 4 + 12);
}

#[test]
fn what_cannot_be_drawn_is_an_error() {
    let png = |drawing: &Drawing| drawing.png().unwrap_err();
    let huge = Drawing::new(1e5, 1e5, "", "");
    assert_eq!(png(&huge), RasterError::Size([2e5, 2e5]));
    assert!(matches!(
        png(&Drawing::new(f64::NAN, 1.0, "", "")),
        RasterError::Size(_)
    ));
    let blurred = Drawing::new(10.0, 10.0, "", ".a{filter:blur(2px)}");
    assert_eq!(png(&blurred), RasterError::Style("filter:blur(2px)".into()));
    for x in [f64::NAN, f64::INFINITY, -1e9] {
        let mut nowhere = blank();
        nowhere.line("line", [x, 1.0], [2.0, 2.0]);
        assert!(matches!(png(&nowhere), RasterError::Place(_)), "{x}");
    }
    let mut styled = Drawing::new(10.0, 10.0, "", ".a{fill:#fff}");
    styled.open("a", 1.0);
    assert_eq!(png(&styled), RasterError::Style("g.a".into()));
}
