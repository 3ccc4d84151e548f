//! The page of modes: the mechanism in each of its motions.
//!
//! A mode is drawn without its damping: the coordinates follow q(φ) = q₀ + a · Re(shape · e^(iφ)) along the motions of
//! the velocities. Where an element has an orientation, the part of it is a rotation vector, by which the element is
//! turned from q₀. A mode that does not oscillate is drawn as it decays or grows, and a free one to and fro.

use super::Shown;
use crate::modes::Number;
use crate::orientation::WithoutCharts;
use crate::picture::Instant;
use crate::pose::{Frame, Mismatch, Vec3};
use crate::report::{self, short};
use crate::scene::mesh::Mesh;
use crate::scene::{Scene, length};
use bryant_engine::Evaluated;
use bryant_generator::model::Model;
use bryant_runtime::program::Header;
use bryant_runtime::{Dynamics, Info, StateKind};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Poses of a loop; the last is the first again. A straight line from one to the next is off by 0.9 % of the amplitude.
const POSES: usize = 25;

/// The farthest point of a mode moves by this share of the size of what moves, unless a body turned by more than this
/// angle \[rad\].
const SHARE: f64 = 0.1;
const WIDEST: f64 = 0.5;

/// The amplitude at which displacements are still in proportion to it \[m, rad\].
const SMALL: f64 = 1e-5;

/// How many times its time constant a mode is drawn that does not oscillate.
const TIMES: f64 = 3.0;

/// What a page draws at the state of rest.
pub struct Rest<'a> {
    pub model: &'a Model,
    /// The equations at the parameters of the state.
    pub dynamics: &'a Evaluated<f64>,
    pub parameters: &'a [f64],
    pub t: f64,
    pub state: &'a [f64],
    /// What a scene with forces asks for, at the state.
    pub forces: &'a [f64],
    pub meshes: Vec<Mesh>,
}

/// How a mode is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ModeMotion {
    Oscillates,
    Decays,
    Grows,
    /// To and fro.
    Free,
}

impl ModeMotion {
    const ALL: [ModeMotion; 4] = [
        ModeMotion::Oscillates,
        ModeMotion::Decays,
        ModeMotion::Grows,
        ModeMotion::Free,
    ];

    /// The factors on the shape at the poses of a loop.
    fn factors(self) -> impl Iterator<Item = Number> {
        (0..POSES).map(move |pose| self.factor(part(pose)))
    }

    fn of(shown: &Shown<'_>) -> Self {
        match shown.mode.rate {
            _ if shown.free => ModeMotion::Free,
            rate if rate.im != 0.0 => ModeMotion::Oscillates,
            rate if rate.re > 0.0 => ModeMotion::Grows,
            _ => ModeMotion::Decays,
        }
    }

    /// The factor on the shape in a part of the loop.
    fn factor(self, part: f64) -> Number {
        match self {
            ModeMotion::Oscillates => Number::from_polar(1.0, TAU * part),
            ModeMotion::Free => Number::new(libm::cos(TAU * part), 0.0),
            ModeMotion::Decays => Number::new(libm::exp(-TIMES * part), 0.0),
            ModeMotion::Grows => Number::new(libm::exp(TIMES * (part - 1.0)), 0.0),
        }
    }

    fn word(self) -> &'static str {
        match self {
            ModeMotion::Oscillates => "oscillates",
            ModeMotion::Decays => "decays",
            ModeMotion::Grows => "grows",
            ModeMotion::Free => "free",
        }
    }
}

/// The part of a loop at which a pose is.
fn part(pose: usize) -> f64 {
    pose as f64 / (POSES - 1) as f64
}

/// The motions away from the state.
struct Motions<'a> {
    rest: &'a Rest<'a>,
    without: WithoutCharts,
    /// For each orientation, its first coordinate and its first velocity, as without charts.
    orientations: Vec<[usize; 2]>,
}

impl<'a> Motions<'a> {
    fn new(rest: &'a Rest<'a>) -> Self {
        let without = WithoutCharts::of(&Header::of(rest.dynamics.info()));
        let places = |names: &[String], last: &str| -> Vec<usize> {
            let names = names.iter().enumerate();
            let found = names.filter(|(_, name)| name.ends_with(last));
            found.map(|(index, _)| index).collect()
        };
        let first = places(&without.coordinates, ".qw").into_iter();
        let orientations = first.zip(places(&without.velocities, ".wx"));
        Motions {
            rest,
            orientations: orientations.map(|(q, w)| [q, w]).collect(),
            without,
        }
    }

    /// The state moved along the motions of its velocities \[m, rad\].
    fn along(&self, displacement: impl Iterator<Item = f64>) -> Instant {
        let Rest {
            dynamics, state, ..
        } = *self.rest;
        let count = dynamics.info().coordinates.len();
        let mut moved = state.to_vec();
        // those of the state itself are no displacement
        let along = displacement.chain(std::iter::repeat(0.0));
        let velocities = moved[count..].iter_mut().zip(along);
        velocities
            .take(dynamics.info().velocities.len())
            .for_each(|(velocity, along)| *velocity = along);
        let mut by = vec![0.0; state.len()];
        dynamics.coordinate_rates(&moved, &mut by);
        // angular velocities in absolute axes: here rotation vectors
        let turns = self
            .without
            .state(&moved)
            .split_off(self.without.coordinates.len());
        let before = self.without.q(state);
        for (q, by) in moved[..count].iter_mut().zip(by) {
            *q += by;
        }
        let mut coordinates = self.without.q(&moved);
        for &[q, w] in &self.orientations {
            let turned = turned(&before[q..q + 4], [turns[w], turns[w + 1], turns[w + 2]]);
            coordinates[q..q + 4].copy_from_slice(&turned);
        }
        Instant {
            time: self.rest.t,
            coordinates,
            state: state.to_vec(),
        }
    }

    /// The state moved along a shape with a factor on it.
    fn displaced(&self, shape: &[Number], factor: Number) -> Instant {
        self.along(shape.iter().map(|entry| (entry * factor).re))
    }

    /// Multiplies each shape so that it is as large as it is drawn \[m, rad\]. Returns the size of what moves \[m\].
    fn size_as_drawn(&self, shapes: &mut [Vec<Number>]) -> Result<f64, Mismatch> {
        // displacements in proportion to the amplitude, at both ends of a quarter of a turn
        let quarter = [0.0, 0.25].map(|part| ModeMotion::Oscillates.factor(part) * SMALL);
        let small = shapes
            .iter()
            .flat_map(|shape| quarter.map(|factor| self.displaced(shape, factor)));
        let small = self.scene(small.collect())?;
        let size = small.size(0);
        for (mode, shape) in shapes.iter_mut().enumerate() {
            let [moved, angle] = [Scene::displacement, turn].map(|of| {
                let ends = [1, 2].map(|end| of(&small, 0, 2 * mode + end));
                ends[0].max(ends[1]) / SMALL
            });
            let amplitude = (SHARE * size / moved).min(WIDEST / angle);
            let amplitude = if amplitude.is_finite() {
                amplitude
            } else {
                0.0
            };
            shape.iter_mut().for_each(|entry| *entry *= amplitude);
        }
        Ok(size)
    }

    /// A scene at the state, and behind it at these instants, with the forces of the state.
    fn scene(&self, instants: Vec<Instant>) -> Result<Scene, Mismatch> {
        let Rest {
            model,
            parameters,
            forces,
            ref meshes,
            ..
        } = *self.rest;
        let mut all = vec![self.along(std::iter::empty())];
        all.extend(instants);
        let forces: Vec<Vec<f64>> = forces.iter().map(|force| vec![*force; all.len()]).collect();
        let names = &self.without.coordinates;
        let mut scene = Scene::new(model, names, parameters, &all, &forces)?;
        scene.meshes.clone_from(meshes);
        Ok(scene)
    }
}

/// An orientation (w, x, y, z), turned by a rotation vector in absolute axes \[rad\].
fn turned(before: &[f64], by: Vec3) -> [f64; 4] {
    let angle = length(by);
    let (sine, cosine) = libm::sincos(0.5 * angle);
    let share = if angle > 0.0 { sine / angle } else { 0.5 };
    let [x, y, z] = by.map(|component| share * component);
    let [a, b, c, d] = [before[0], before[1], before[2], before[3]];
    [
        cosine * a - x * b - y * c - z * d,
        cosine * b + x * a + y * d - z * c,
        cosine * c + y * a + z * b - x * d,
        cosine * d + z * a + x * c - y * b,
    ]
}

/// The largest angle by which a body is turned from one time of a scene to another \[rad\].
fn turn(scene: &Scene, from: usize, to: usize) -> f64 {
    let bodies = scene.frames[from].iter().zip(&scene.frames[to]);
    let angle = |(a, b): (&Frame, &Frame)| {
        let rows = a
            .rotation
            .as_flattened()
            .iter()
            .zip(b.rotation.as_flattened());
        // |A − B| = 2 √2 sin(θ/2)
        let apart: f64 = rows.map(|(a, b)| (a - b) * (a - b)).sum();
        2.0 * libm::asin((apart / 8.0).sqrt().min(1.0))
    };
    bodies.map(angle).fold(0.0, f64::max)
}

/// The displacements of a shape, turned so that the coordinate with the largest share of the energy is at its largest
/// first.
fn displacements(shown: &Shown<'_>, names: &[&str]) -> Vec<Number> {
    let along = &shown.mode.shape[..names.len()];
    if shown.mode.moves_nothing(names.len()) {
        return vec![Number::ZERO; names.len()];
    }
    let first = shown.shares.first().map(|(name, _)| *name);
    let index = names.iter().position(|name| Some(*name) == first);
    let leads = index.map_or(Number::ZERO, |index| along[index]);
    let turn = match leads.norm() > 0.0 {
        true => leads.conj() / leads.norm(),
        false => Number::ONE,
    };
    along.iter().map(|entry| entry * turn).collect()
}

/// The scene of the page, and its modes with how each is drawn.
///
/// # Errors
/// The coordinates do not fit the model.
pub fn json(rest: &Rest<'_>, shown: &[Shown<'_>]) -> Result<Value, Mismatch> {
    let info = rest.dynamics.info();
    let motions = Motions::new(rest);
    let mut shapes: Vec<Vec<Number>> = shown
        .iter()
        .map(|one| displacements(one, info.velocities))
        .collect();
    let size = motions.size_as_drawn(&mut shapes)?;
    let poses = shown.iter().zip(&shapes).flat_map(|(one, shape)| {
        let factors = ModeMotion::of(one).factors();
        factors.map(|factor| motions.displaced(shape, factor))
    });
    let mut scene = motions.scene(poses.collect())?;
    let modes = shown.iter().zip(&shapes).enumerate();
    let modes = modes.map(|(index, (one, shape))| {
        let poses = 1 + POSES * index..1 + POSES * (index + 1);
        let farthest = poses.map(|k| scene.displacement(0, k));
        one.drawn(shape, farthest.fold(0.0, f64::max), info)
    });
    let modes: Vec<Value> = modes.collect();
    keep_forces_of_rest(&mut scene);
    let mut drawn = report::json(&scene);
    // parts of a loop, of which each mode has one
    drawn["times"] = (0..POSES).map(|pose| json!(part(pose))).collect();
    let factors = ModeMotion::ALL.map(|course| {
        let factors = course.factors().map(|factor| json!([factor.re, factor.im]));
        (course.word().to_owned(), factors.collect())
    });
    let factors: serde_json::Map<String, Value> = factors.into_iter().collect();
    Ok(json!({ "scene": drawn, "size": short(size), "factors": factors, "modes": modes }))
}

impl Shown<'_> {
    /// The mode as it is drawn, with displacements \[m, rad\] of this shape, of which the farthest point has the
    /// largest \[m\].
    fn drawn(&self, shape: &[Number], farthest: f64, info: &Info) -> Value {
        let course = ModeMotion::of(self);
        let lasts = match course {
            ModeMotion::Oscillates => Some(TAU / self.mode.rate.im.abs()),
            ModeMotion::Decays | ModeMotion::Grows => Some(TIMES / self.mode.rate.re.abs()),
            ModeMotion::Free => None,
        };
        let coordinates = self.shares.iter().filter_map(|(name, share)| {
            let place = info.velocities.iter().position(|one| one == name)?;
            let entry = shape[place];
            let (factor, unit) = match info.kind(info.coordinates.len() + place) {
                StateKind::AngularVelocity => (1f64.to_degrees(), "deg"),
                _ => (1e3, "mm"),
            };
            Some(json!({
                "name": name,
                "share": short(*share),
                "amplitude": short(factor * entry.norm()),
                "unit": unit,
                "phase": short(entry.arg().to_degrees()),
            }))
        });
        json!({
            "cells": [self.frequency(), self.damping(), self.time(), self.moves()],
            "course": course.word(),
            "lasts": lasts,
            "farthest": short(farthest),
            "coordinates": coordinates.collect::<Vec<_>>(),
        })
    }
}

/// Leaves the forces of the state of rest, which is the first instant, and no others.
fn keep_forces_of_rest(scene: &mut Scene) {
    scene.pushes.clear();
    for line in &mut scene.lines {
        line.pulls.iter_mut().for_each(|pulls| pulls.truncate(1));
    }
    for ellipsoid in &mut scene.ellipsoids {
        if let Some(fill) = &mut ellipsoid.fill {
            fill.truncate(1);
        }
    }
}
