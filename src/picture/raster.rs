//! A picture of lines as one of points: PNG, with a font that is part of the program, so that the text does not depend on
//! what the machine has.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::Arc;

/// The picture could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("the picture cannot be drawn as points: {0}")]
pub struct RasterError(String);

/// Points per pixel of the SVG: sharp on screens of high resolution and in print.
const SCALE: f32 = 2.0;

/// The PNG of an SVG.
///
/// # Errors
/// An SVG that is none, or one that is too large.
pub fn png(svg: &str) -> Result<Vec<u8>, RasterError> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = Options {
        font_family: "DejaVu Sans".to_owned(),
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options).map_err(|e| RasterError(e.to_string()))?;
    let size = tree.size().to_int_size();
    let scaled = |length: u32| (length as f32 * SCALE) as u32;
    let pixels = Pixmap::new(scaled(size.width()), scaled(size.height()));
    let mut pixels = pixels.ok_or_else(|| RasterError("it is too large".into()))?;
    let transform = Transform::from_scale(SCALE, SCALE);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| RasterError(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use resvg::tiny_skia::{Pixmap, PremultipliedColorU8};

    const HEAD: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"20\">\
        <style>text{font-family:'DejaVu Sans',sans-serif;font-size:16px}</style>\
        <rect width=\"40\" height=\"20\" fill=\"#fff\"/>";

    fn dark(svg: &str) -> usize {
        let pixels = Pixmap::decode_png(&png(svg).unwrap()).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (80, 40));
        let is_dark = |p: &&PremultipliedColorU8| p.red() < 128;
        pixels.pixels().iter().filter(is_dark).count()
    }

    #[test]
    fn text_is_drawn_without_fonts_of_the_system() {
        assert_eq!(dark(&format!("{HEAD}</svg>")), 0);
        for text in ["M", "10⁻⁶", "≤"] {
            let svg = format!("{HEAD}<text x=\"2\" y=\"16\">{text}</text></svg>");
            assert!(dark(&svg) > 20, "{text}");
        }
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        assert!(png("<html>").is_err());
    }
}
