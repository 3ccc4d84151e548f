//! A canvas of pixels, with groups that clip or have an opacity.

use super::RasterError;
use super::style::Colour;
use zeno::{Command, Mask, Style};

/// Largest number of pixels of a picture; drawing it needs about 600 MB for each layer.
const MOST: usize = 40_000_000;

/// A picture under construction as pixels.
pub struct Canvas {
    width: usize,
    height: usize,
    /// Pixels of each layer: red, green, blue and opacity; colours are multiplied by the opacity. The first layer is
    /// white paper.
    layers: Vec<Vec<[f32; 4]>>,
    groups: Vec<Group>,
}

struct Group {
    /// Left, top, right, bottom; nothing is painted outside.
    clip: [f32; 4],
    /// Opacity of the group, if it has a layer of its own.
    opacity: Option<f32>,
}

impl Canvas {
    /// A canvas of white paper.
    pub fn new([width, height]: [f64; 2]) -> Result<Canvas, RasterError> {
        let fits = width >= 1.0 && height >= 1.0 && width * height <= MOST as f64;
        if !fits {
            return Err(RasterError::Size([width, height]));
        }
        let (width, height) = (width as usize, height as usize);
        Ok(Canvas {
            width,
            height,
            layers: vec![vec![[1.0; 4]; width * height]],
            groups: Vec::new(),
        })
    }

    fn clip(&self) -> [f32; 4] {
        let all = [0.0, 0.0, self.width as f32, self.height as f32];
        self.groups.last().map_or(all, |group| group.clip)
    }

    /// Opens a group that is clipped to left, top, right, bottom.
    pub fn open_clipped(&mut self, [left, top, right, bottom]: [f32; 4]) {
        let clip = self.clip();
        self.groups.push(Group {
            clip: [
                clip[0].max(left),
                clip[1].max(top),
                clip[2].min(right),
                clip[3].min(bottom),
            ],
            opacity: None,
        });
    }

    /// Opens a group with an opacity. It is painted on a layer of its own, which is then put on the layer below.
    pub fn open(&mut self, opacity: f32) {
        let clip = self.clip();
        let opacity = (opacity < 1.0).then_some(opacity);
        if opacity.is_some() {
            self.layers.push(vec![[0.0; 4]; self.width * self.height]);
        }
        self.groups.push(Group { clip, opacity });
    }

    /// Closes the group that was opened last.
    pub fn close(&mut self) {
        let Some(Group {
            opacity: Some(opacity),
            ..
        }) = self.groups.pop()
        else {
            return;
        };
        let Some(layer) = self.layers.pop() else {
            return;
        };
        for (below, above) in self.top().iter_mut().zip(layer) {
            over(below, above.map(|part| part * opacity));
        }
    }

    fn top(&mut self) -> &mut Vec<[f32; 4]> {
        // each layer but the first belongs to a group, and a group removes only its own layer
        self.layers.last_mut().expect("the paper stays")
    }

    /// Paints the inside or the stroke of a path; its points must be finite and not far outside the picture.
    pub fn paint(&mut self, path: &[Command], style: Style<'_>, colour: Colour, opacity: f32) {
        let clip = self.clip();
        let bounds = zeno::bounds(path, style, None);
        let left = bounds.min.x.max(clip[0]).floor() as usize;
        let top = bounds.min.y.max(clip[1]).floor() as usize;
        let right = bounds.max.x.min(clip[2]).ceil() as usize;
        let bottom = bounds.max.y.min(clip[3]).ceil() as usize;
        if left >= right || top >= bottom {
            return;
        }
        let (width, height) = (right - left, bottom - top);
        let mut mask = vec![0; width * height];
        Mask::new(path)
            .style(style)
            .offset([-(left as f32), -(top as f32)])
            .size(width as u32, height as u32)
            .render_into(&mut mask, None);
        // the share of a row or column of pixels that lies inside the clip
        let inside = |index: usize, low: f32, high: f32| {
            let (from, to) = (index as f32, index as f32 + 1.0);
            (to.min(high) - from.max(low)).clamp(0.0, 1.0)
        };
        let stride = self.width;
        let layer = self.top();
        for (row, coverages) in mask.chunks_exact(width).enumerate() {
            let y = top + row;
            let share = opacity * inside(y, clip[1], clip[3]) / 255.0;
            for (column, coverage) in coverages.iter().enumerate().filter(|(_, c)| **c > 0) {
                let x = left + column;
                let alpha = share * f32::from(*coverage) * inside(x, clip[0], clip[2]);
                let [red, green, blue] = colour.map(|part| part * alpha);
                over(&mut layer[y * stride + x], [red, green, blue, alpha]);
            }
        }
    }

    /// Width and height, and red, green and blue of each pixel, row after row.
    pub fn finish(mut self) -> ([usize; 2], Vec<u8>) {
        while !self.groups.is_empty() {
            self.close();
        }
        let byte = |part: &f32| (part * 255.0).round() as u8;
        let bytes = self.layers[0].iter().flat_map(|point| &point[..3]);
        ([self.width, self.height], bytes.map(byte).collect())
    }
}

fn over(below: &mut [f32; 4], above: [f32; 4]) {
    for (below, part) in below.iter_mut().zip(above) {
        *below = *below * (1.0 - above[3]) + part;
    }
}
