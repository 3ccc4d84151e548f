//! Responses of a signal that jumps between samples: where a switch fires, or where a force begins with a jump.
//!
//! Samples give a jump only to within their interval, and do not show how a parameter moves its time. Here the time of
//! each jump and both its sides are known, so the signal is linear between knots: the samples, and two knots at each
//! jump. The answers are exact for that line, and so are their derivatives. The line moves its knots along both axes:
//! d/dp ∫ x dt contains (x⁻ − x⁺) dt_jump/dp.
//!
//! This code handles one signal at a time, because it branches and allocates.

use super::{Response, STANDARD_GRAVITY, exceedance, extremes, reduce};
use crate::Real;
use crate::real::mapped;

/// A jump of a signal: its time and both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump<T> {
    /// Time of the jump \[s\], from the first sample.
    pub t: T,
    /// The value just before the jump.
    pub before: T,
    /// The value from the jump on.
    pub after: T,
}

/// A point of the line.
#[derive(Clone, Copy)]
struct Knot<T> {
    /// \[s\]
    t: T,
    x: T,
}

/// A response of a signal that jumps between `samples`, which are `every` \[s\] apart. Jumps outside of the signal are
/// left out. Without any jump the response is that of [`reduce`]; so is it where [`reduce`] has no answer. A jump of
/// height 0 is a bend. Responses that need a signal that is smooth nearby ([`TimeOfPeak`](Response::TimeOfPeak) and the
/// like) ignore it.
///
/// Windows of the head injury criterion may also begin and end at a jump. The value at a time is that of the polynomial
/// through knots on the same side of each jump.
pub fn reduce_with_jumps<T: Real>(
    response: Response,
    samples: &[T],
    jumps: &[Jump<T>],
    every: f64,
) -> T {
    let mut scratch = vec![T::from_f64(0.0); response.scratch(samples.len())];
    let of_samples = reduce(response, samples, every, &mut scratch);
    let length = every * (samples.len() as f64 - 1.0);
    // a jump at the end has nothing behind it
    let within = |jump: &&Jump<T>| (0.0..length - HAIR * every).contains(&jump.t.to_f64());
    let mut jumps: Vec<Jump<T>> = jumps.iter().filter(within).copied().collect();
    if matches!(
        response,
        Response::TimeOfPeak | Response::TimeOfMinimum | Response::Value { .. }
    ) {
        let size = samples
            .iter()
            .fold(0.0, |most: f64, x| most.max(x.to_f64().abs()));
        let height = |jump: &Jump<T>| (jump.after.to_f64() - jump.before.to_f64()).abs();
        jumps.retain(|jump| height(jump) > HAIR * size || height(jump).is_nan());
    }
    jumps.sort_by(|a, b| a.t.to_f64().total_cmp(&b.t.to_f64()));
    // where the samples have no answer, the line through them has none either
    if jumps.is_empty() || !of_samples.to_f64().is_finite() {
        return of_samples;
    }
    let knots = knots(samples, &jumps, every);
    let values: Vec<T> = knots.iter().map(|knot| knot.x).collect();
    let largest = |seen: fn(T) -> T| extremes::peak_of(&values, seen);
    let answer = match response {
        // a jump of the velocity is no pulse
        Response::Final | Response::Olc => return of_samples,
        Response::Value { at } => {
            return value_at(samples, &jumps, every, at).unwrap_or(of_samples);
        }
        Response::Peak => largest(|x| x),
        Response::Minimum => largest(|x| -x).map(|x| -x),
        Response::Magnitude => largest(T::abs),
        Response::TimeOfPeak => time_of_peak(&knots, |x| x),
        Response::TimeOfMinimum => time_of_peak(&knots, |x| -x),
        Response::Range => largest(|x| x).and_then(|top| Some(top + largest(|x| -x)?)),
        Response::Excursion => extremes::peak_of(&values, |x| (x - samples[0]).abs()),
        Response::Integral => integrals(&knots).pop(),
        Response::Mean => integrals(&knots).pop().map(|sum| sum / T::from_f64(length)),
        Response::Hic { window } => Some(hic(&knots, window)),
        Response::Clip { duration } => Some(level(&knots, duration, false)),
        Response::ContiguousClip { duration } => Some(level(&knots, duration, true)),
        Response::Exceedance { limit } => {
            let size = |knot: &Knot<T>| Knot {
                x: knot.x.abs(),
                ..*knot
            };
            let sizes: Vec<Knot<T>> = knots.iter().map(size).collect();
            let points = sizes.iter().map(|knot| [knot.t, knot.x]);
            let worst = exceedance::worst(&limit, points, length, |duration| {
                (duration <= length).then(|| level(&sizes, duration, false))
            });
            Some(worst.ratio)
        }
    };
    let answer = answer.unwrap_or(of_samples);
    values.iter().fold(answer, |sum, x| sum + x.taint())
}

/// Adds to samples, which are `every` \[s\] apart, the slopes that come from the times of the jumps between them. The
/// values stay. The integral of the line through both sides of a jump differs from that of the line through the samples
/// around it. The slope of the difference is given to these samples, more of it to the nearer one. So a filter, which
/// takes integrals, gets the derivative that belongs to a moving jump.
pub fn move_with_jumps<T: Real>(
    samples: &mut [T],
    jumps: impl Iterator<Item = Jump<T>>,
    every: f64,
) {
    let half = T::from_f64(0.5);
    let last = samples.len() as f64 - 1.0;
    let within = |jump: &Jump<T>| (0.0..last).contains(&(jump.t.to_f64() / every));
    let mut jumps: Vec<Jump<T>> = jumps.filter(within).collect();
    jumps.sort_by(|a, b| a.t.to_f64().total_cmp(&b.t.to_f64()));
    let place = |jump: &Jump<T>| (jump.t.to_f64() / every) as usize;
    for together in jumps.chunk_by(|a, b| place(a) == place(b)) {
        let first = place(&together[0]);
        let [from, to] = mapped([first, first + 1], |i| T::from_f64(i as f64 * every));
        let (mut t, mut x) = (from, samples[first]);
        let mut area = T::from_f64(0.0);
        for jump in together {
            area += (x + jump.before) * (jump.t - t) * half;
            (t, x) = (jump.t, jump.after);
        }
        area += (x + samples[first + 1]) * (to - t) * half;
        let line = (samples[first] + samples[first + 1]) * (to - from) * half;
        let more = (area - line) * T::from_f64(1.0 / every);
        let slope = more - more.frozen();
        let times = together.iter().map(|jump| jump.t.to_f64() / every);
        let part = times.sum::<f64>() / together.len() as f64 - first as f64;
        samples[first] += slope * T::from_f64(1.0 - part);
        samples[first + 1] += slope * T::from_f64(part);
    }
}

/// Samples and both sides of jumps, in order of time. A sample at the time of a jump may be on either side, so it is
/// left out.
fn knots<T: Real>(samples: &[T], jumps: &[Jump<T>], every: f64) -> Vec<Knot<T>> {
    let mut knots = Vec::with_capacity(samples.len() + 2 * jumps.len());
    let mut due = jumps.iter().peekable();
    let hair = HAIR * every;
    for (i, x) in samples.iter().enumerate() {
        let t = i as f64 * every;
        let mut taken = false;
        while let Some(jump) = due.next_if(|jump| jump.t.to_f64() < t + hair) {
            let Jump {
                t: at,
                before,
                after,
            } = *jump;
            knots.extend([Knot { t: at, x: before }, Knot { t: at, x: after }]);
            taken |= at.to_f64() > t - hair;
        }
        if !taken {
            let t = T::from_f64(t);
            knots.push(Knot { t, x: *x });
        }
    }
    knots
}

/// The integral from the first knot to each.
fn integrals<T: Real>(knots: &[Knot<T>]) -> Vec<T> {
    let mut sum = T::from_f64(0.0);
    let mut integrals = vec![sum; knots.len().min(1)];
    for pair in knots.windows(2) {
        let half = T::from_f64(0.5) * (pair[1].t - pair[0].t);
        sum = (pair[0].x + pair[1].x).mul_add(half, sum);
        integrals.push(sum);
    }
    integrals
}

/// The time when a function of the knots is largest: the first such knot, moved to the top of the parabola through it
/// and its neighbours. At either end of the signal and at a jump it is not moved.
fn time_of_peak<T: Real>(knots: &[Knot<T>], seen: fn(T) -> T) -> Option<T> {
    let mut top = 0;
    for (i, knot) in knots.iter().enumerate() {
        if seen(knots[top].x).to_f64() < seen(knot.x).to_f64() {
            top = i;
        }
    }
    let here = *knots.get(top)?;
    let neighbours = top
        .checked_sub(1)
        .and_then(|left| knots.get(left))
        .zip(knots.get(top + 1));
    let Some((left, right)) = neighbours else {
        return Some(here.t);
    };
    let (back, forth) = (here.t - left.t, right.t - here.t);
    if back.to_f64() <= 0.0 || forth.to_f64() <= 0.0 {
        return Some(here.t);
    }
    let rise = (seen(here.x) - seen(left.x)) / back;
    let fall = (seen(right.x) - seen(here.x)) / forth;
    let slope = rise * forth + fall * back;
    let bend = T::from_f64(2.0) * (fall - rise);
    match bend.to_f64() < 0.0 {
        true => Some(here.t - slope / bend),
        false => Some(here.t),
    }
}

/// The value at a time where a jump is among the samples that would be used; `None` where no jump is.
fn value_at<T: Real>(samples: &[T], jumps: &[Jump<T>], every: f64, at: f64) -> Option<T> {
    // the samples that would be used are not further away
    let near = |t: f64| (t - at).abs() < 3.0 * every;
    if !jumps.iter().any(|jump| near(jump.t.to_f64())) {
        return None;
    }
    let before = jumps.iter().rfind(|jump| jump.t.to_f64() <= at);
    let behind = jumps.iter().find(|jump| at < jump.t.to_f64());
    // the polynomial is steep between a jump and a sample that is too near to it
    let margin = 0.5 * every;
    let from = before.map_or(f64::NEG_INFINITY, |jump| jump.t.to_f64() + margin);
    let to = behind.map_or(f64::INFINITY, |jump| jump.t.to_f64() - margin);
    let sample = |(i, x): (usize, &T)| (i as f64 * every, *x);
    let mut piece: Vec<Knot<T>> = samples
        .iter()
        .enumerate()
        .map(sample)
        .filter(|(t, _)| from <= *t && *t <= to)
        .map(|(t, x)| Knot {
            t: T::from_f64(t),
            x,
        })
        .collect();
    piece.extend(before.map(|jump| Knot {
        t: jump.t,
        x: jump.after,
    }));
    piece.extend(behind.map(|jump| Knot {
        t: jump.t,
        x: jump.before,
    }));
    let away = |knot: &Knot<T>| (knot.t.to_f64() - at).abs();
    piece.sort_by(|a, b| away(a).total_cmp(&away(b)));
    piece.truncate(4);
    let lagrange = |i: usize| {
        let others = piece.iter().enumerate().filter(|(j, _)| *j != i);
        others.fold(piece[i].x, |product, (_, other)| {
            product * (T::from_f64(at) - other.t) / (piece[i].t - other.t)
        })
    };
    (0..piece.len())
        .map(lagrange)
        .reduce(|sum, term| sum + term)
}

/// The relative difference of lengths that counts as rounding.
const HAIR: f64 = 1e-9;

/// A window of the head injury criterion.
#[derive(Clone, Copy)]
struct Window<T> {
    /// The velocity gained in it.
    gain: T,
    /// \[s\]
    length: T,
}

/// The head injury criterion. It compares all windows that begin and end on knots and are shorter than the longest, and
/// all windows of the longest length that begin or end on a knot. The length of the latter stays when a jump moves.
fn hic<T: Real>(knots: &[Knot<T>], longest: f64) -> T {
    let velocity = integrals(knots);
    let mut best = Best {
        score: 0.0,
        window: None,
    };
    let length = T::from_f64(longest);
    let jumps = knots
        .windows(2)
        .map(|pair| [pair[0].t.to_f64(), pair[1].t.to_f64()]);
    let jumps: Vec<f64> = jumps.filter(|[a, b]| a == b).map(|[at, _]| at).collect();
    let jumps_at = |t: T| {
        jumps
            .iter()
            .any(|jump| (jump - t.to_f64()).abs() <= HAIR * longest)
    };
    for (knot, velocity_here) in knots.iter().zip(&velocity) {
        // A window from a sample that ends at a jump gains as much as the window that is attached to the jump. Only the
        // latter moves with the jump and has the correct derivative, so the former is left out.
        let stays = !jumps_at(knot.t);
        let to = |t: T| integral_to(knots, &velocity, t).filter(|_| !(stays && jumps_at(t)));
        let ahead = to(knot.t + length).map(|end| end - *velocity_here);
        let behind = to(knot.t - length).map(|start| *velocity_here - start);
        for gain in ahead.into_iter().chain(behind) {
            best.take(gain.to_f64(), longest, || Window { gain, length });
        }
    }
    let highest = knots
        .iter()
        .fold(0.0_f64, |most, knot| most.max(knot.x.to_f64()));
    let end = |i: usize| [knots[i].t.to_f64(), velocity[i].to_f64()];
    let ends: Vec<[f64; 2]> = (0..knots.len()).map(end).collect();
    let mut first = 0;
    for (j, [t, v]) in ends.iter().enumerate() {
        while t - ends[first][0] > longest * (1.0 - HAIR) {
            first += 1;
        }
        for (i, [from, before]) in ends.iter().enumerate().take(j).skip(first) {
            let length = t - from;
            // shorter windows gain too little even on the highest level
            if to_the_fifth(highest) * length * length <= best.score {
                break;
            }
            best.take(v - before, length, || Window {
                gain: velocity[j] - velocity[i],
                length: knots[j].t - knots[i].t,
            });
        }
    }
    match best.window {
        Some(Window { gain, length }) => {
            let mean = gain / (T::from_f64(STANDARD_GRAVITY) * length);
            mean * mean * mean.sqrt() * length
        }
        None => T::from_f64(0.0),
    }
}

fn to_the_fifth(x: f64) -> f64 {
    let square = x * x;
    square * square * x
}

/// The window found so far with the largest score, and its score: the mean to the fifth power times the square of the
/// length.
struct Best<T> {
    score: f64,
    window: Option<Window<T>>,
}

impl<T> Best<T> {
    fn take(&mut self, gain: f64, length: f64, window: impl FnOnce() -> Window<T>) {
        // compared without a division
        let (above, below) = (to_the_fifth(gain), length * length * length);
        if gain > 0.0 && above > self.score * below {
            self.score = above / below;
            self.window = Some(window());
        }
    }
}

/// The integral from the first knot up to a time; `None` outside of the signal.
fn integral_to<T: Real>(knots: &[Knot<T>], integrals: &[T], t: T) -> Option<T> {
    let hair = HAIR * (knots.last()?.t.to_f64() - knots[0].t.to_f64());
    let next = knots.partition_point(|knot| knot.t.to_f64() <= t.to_f64());
    // a time that should meet the first or the last knot may miss it by rounding
    let next = match next {
        0 => knots.partition_point(|knot| knot.t.to_f64() <= t.to_f64() + hair),
        _ if next == knots.len() => {
            knots.partition_point(|knot| knot.t.to_f64() <= t.to_f64() - hair)
        }
        within => within,
    };
    let (a, b) = (knots.get(next.checked_sub(1)?)?, knots.get(next)?);
    let (since, span) = (t - a.t, b.t - a.t);
    let rise = (b.x - a.x) * since / span;
    Some(integrals[next - 1] + since * (a.x + T::from_f64(0.5) * rise))
}

/// A stretch of time above a level: its length, and how fast that decreases as the level rises.
#[derive(Clone, Copy)]
struct Stretch<T> {
    /// \[s\]
    length: T,
    fall: T,
}

/// The level that is exceeded for a duration, in total or without a break.
fn level<T: Real>(knots: &[Knot<T>], duration: f64, in_a_row: bool) -> T {
    let mut heights: Vec<T> = knots.iter().map(|knot| knot.x).collect();
    heights.sort_by(|a, b| a.to_f64().total_cmp(&b.to_f64()));
    heights.dedup_by(|a, b| a.to_f64() == b.to_f64());
    // Between neighbouring heights of knots, the same knots are above a level, and all times are linear in the level.
    let reached = |k: usize| {
        let (low, high) = (heights[k], heights[k + 1]);
        let middle = 0.5 * (low.to_f64() + high.to_f64());
        let over = stretches(knots, middle);
        let over = if in_a_row { over } else { vec![joined(&over)] };
        let solved = over.iter().filter_map(|stretch| {
            let excess = stretch.length - T::from_f64(duration);
            let level = match stretch.fall.to_f64() > 0.0 {
                true => T::from_f64(middle) + excess / stretch.fall,
                false if excess.to_f64() < 0.0 => low,
                false => high,
            };
            let level = if level.to_f64() < high.to_f64() {
                level
            } else {
                high
            };
            (low.to_f64() < level.to_f64()).then_some(level)
        });
        solved.reduce(larger)
    };
    let (mut found, mut low, mut high) = (heights[0], 0, heights.len() - 1);
    while low < high {
        let middle = usize::midpoint(low, high);
        match reached(middle) {
            Some(level) => (found, low) = (level, middle + 1),
            None => high = middle,
        }
    }
    found
}

fn larger<T: Real>(a: T, b: T) -> T {
    if a.to_f64() < b.to_f64() { b } else { a }
}

/// All stretches as one: the sums of their lengths and decreases.
fn joined<T: Real>(stretches: &[Stretch<T>]) -> Stretch<T> {
    let zero = T::from_f64(0.0);
    let none = Stretch {
        length: zero,
        fall: zero,
    };
    stretches.iter().fold(none, |sum, stretch| Stretch {
        length: sum.length + stretch.length,
        fall: sum.fall + stretch.fall,
    })
}

/// The stretches in which the line is above a level; no knot is on that level.
fn stretches<T: Real>(knots: &[Knot<T>], level: f64) -> Vec<Stretch<T>> {
    let over = |knot: &Knot<T>| knot.x.to_f64() > level;
    let zero = T::from_f64(0.0);
    let mut stretches = Vec::new();
    // the time when the line rose above the level, and how much later that is when the level rises
    let mut risen = knots
        .first()
        .filter(|first| over(first))
        .map(|first| (first.t, zero));
    for pair in knots.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if over(&a) == over(&b) {
            continue;
        }
        let delay = (b.t - a.t) / (b.x - a.x);
        let t = a.t + (T::from_f64(level) - a.x) * delay;
        match risen.take() {
            None => risen = Some((t, delay)),
            Some((start, later)) => stretches.push(Stretch {
                length: t - start,
                fall: later - delay,
            }),
        }
    }
    if let (Some((start, later)), Some(last)) = (risen, knots.last()) {
        stretches.push(Stretch {
            length: last.t - start,
            fall: later,
        });
    }
    stretches
}
