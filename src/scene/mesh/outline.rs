//! The outline of a mesh as it is seen from one side: its triangles are laid on a grid of squares, and the outline
//! leads around the squares that they cover.

use std::collections::HashMap;

pub type Point = [f64; 2];

/// Squares along the longer side.
const SQUARES: usize = 160;

/// Corners that are less than this part of a square away from a straight line are left out.
const STRAIGHT: f64 = 1.1;

/// Closed lines around what triangles cover: their corners, and the indices of the corners of each.
pub fn outline(places: &[Point], triangles: &[[u32; 3]]) -> Vec<Vec<Point>> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for place in places {
        for i in 0..2 {
            low[i] = low[i].min(place[i]);
            high[i] = high[i].max(place[i]);
        }
    }
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    if !(size.is_finite() && size > 0.0) {
        return Vec::new();
    }
    let square = size / SQUARES as f64;
    let counts = [0, 1].map(|i| ((high[i] - low[i]) / square) as i32 + 1);
    let mut covered = vec![false; (counts[0] * counts[1]) as usize];
    for corners in triangles {
        let on_grid = corners.map(|c| {
            let place = places[c as usize];
            [0, 1].map(|i| (place[i] - low[i]) / square)
        });
        cover(&mut covered, counts, on_grid);
    }
    let loops = around(&covered, counts).into_iter();
    let back = |at: &Point| [0, 1].map(|i| low[i] + at[i] * square);
    let loops = loops.map(|line| straightened(&line).iter().map(back).collect::<Vec<_>>());
    loops.filter(|line| line.len() > 3).collect()
}

/// Marks the squares whose middle is in a triangle, and those of its corners, so that what is thin is seen.
fn cover(covered: &mut [bool], counts: [i32; 2], corners: [Point; 3]) {
    let mut mark = |x: i32, y: i32| {
        if (0..counts[0]).contains(&x) && (0..counts[1]).contains(&y) {
            covered[(y * counts[0] + x) as usize] = true;
        }
    };
    corners.iter().for_each(|[x, y]| mark(*x as i32, *y as i32));
    let ends = |i: usize| {
        let all = corners.map(|c| c[i]);
        let [low, high] =
            [f64::min, f64::max].map(|pick| all.into_iter().reduce(pick).unwrap_or(0.0));
        (low as i32, high as i32)
    };
    let (bottom, top) = ends(1);
    for y in bottom..=top {
        let middle = f64::from(y) + 0.5;
        let mut crossed = [f64::INFINITY, f64::NEG_INFINITY];
        for i in 0..3 {
            let ([x, y], [u, v]) = (corners[i], corners[(i + 1) % 3]);
            if (y <= middle) != (v <= middle) {
                let at = x + (middle - y) / (v - y) * (u - x);
                crossed = [crossed[0].min(at), crossed[1].max(at)];
            }
        }
        if crossed[0] <= crossed[1] {
            let (first, last) = (
                (crossed[0] - 0.5).ceil() as i32,
                (crossed[1] - 0.5).floor() as i32,
            );
            (first..=last).for_each(|x| mark(x, y));
        }
    }
}

/// Closed lines along the edges between squares that are covered and those that are not, with the first at the right
/// hand.
fn around(covered: &[bool], counts: [i32; 2]) -> Vec<Vec<Point>> {
    let is = |x: i32, y: i32| {
        (0..counts[0]).contains(&x)
            && (0..counts[1]).contains(&y)
            && covered[(y * counts[0] + x) as usize]
    };
    // from each corner of the grid to the next one
    let mut next: HashMap<(i32, i32), Vec<(i32, i32)>> = HashMap::new();
    let mut starts = Vec::new();
    let mut edge = |from: (i32, i32), to: (i32, i32)| {
        next.entry(from).or_default().push(to);
        starts.push(from);
    };
    for y in 0..counts[1] {
        for x in 0..counts[0] {
            if !is(x, y) {
                continue;
            }
            if !is(x, y - 1) {
                edge((x, y), (x + 1, y));
            }
            if !is(x + 1, y) {
                edge((x + 1, y), (x + 1, y + 1));
            }
            if !is(x, y + 1) {
                edge((x + 1, y + 1), (x, y + 1));
            }
            if !is(x - 1, y) {
                edge((x, y + 1), (x, y));
            }
        }
    }
    let mut loops = Vec::new();
    for start in starts {
        let mut line = Vec::new();
        let mut at = start;
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            line.push([f64::from(at.0), f64::from(at.1)]);
            at = to;
        }
        if line.len() > 3 {
            loops.push(line);
        }
    }
    loops
}

/// A closed line without the corners that are close to a straight line between others (Douglas and Peucker), closed by
/// its first point.
fn straightened(line: &[Point]) -> Vec<Point> {
    let far = (0..line.len()).fold(0, |best, i| {
        let distance = |i: usize| libm::hypot(line[i][0] - line[0][0], line[i][1] - line[0][1]);
        if distance(i) > distance(best) {
            i
        } else {
            best
        }
    });
    let mut kept = Vec::new();
    keep(&line[..=far], &mut kept);
    let mut rest = line[far..].to_vec();
    rest.push(line[0]);
    keep(&rest, &mut kept);
    kept.push(line[0]);
    kept
}

/// Adds the corners that matter, but for the last.
fn keep(line: &[Point], kept: &mut Vec<Point>) {
    let [first, .., last] = line else {
        return;
    };
    let along = [last[0] - first[0], last[1] - first[1]];
    let length = libm::hypot(along[0], along[1]).max(1e-12);
    let off =
        |p: &Point| ((p[0] - first[0]) * along[1] - (p[1] - first[1]) * along[0]).abs() / length;
    let worst = (1..line.len() - 1).max_by(|a, b| off(&line[*a]).total_cmp(&off(&line[*b])));
    match worst {
        Some(worst) if off(&line[worst]) > STRAIGHT => {
            keep(&line[..=worst], kept);
            keep(&line[worst..], kept);
        }
        _ => kept.push(*first),
    }
}
