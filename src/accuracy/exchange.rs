//! Exchanges the curves of a scene: straight lines become cubics through the same points, and cubics become straight
//! lines.

use bryant_generator::model::{FieldComponent, Interpolate, Model, Reference, Translation};

/// The model with its curves exchanged; `None` if no curve can be exchanged. Curves that prescribe motions are not
/// exchanged, because their slopes must not jump.
pub fn exchanged(model: &Model) -> Option<Model> {
    let kept = of_motion(model);
    let mut other = model.clone();
    let mut changed = false;
    for (index, curve) in other.curves.iter_mut().enumerate() {
        // with two points, the cubic is the same line
        if kept.contains(&index) || curve.points.len() < 3 {
            continue;
        }
        curve.interpolate = match curve.interpolate {
            Interpolate::Linear => Interpolate::Cubic,
            Interpolate::Cubic => Interpolate::Linear,
        };
        changed = true;
    }
    other.digest = other.sha256();
    changed.then_some(other)
}

/// The indices of the curves that prescribe motions.
fn of_motion(model: &Model) -> Vec<usize> {
    let mut curves = Vec::new();
    let mut add = |translation: &Translation| {
        let given = translation.curves.iter().chain([&translation.stops]);
        curves.extend(given.flatten().map(|c| c.curve));
    };
    for vehicle in &model.vehicles {
        add(&vehicle.translation);
    }
    for system in &model.systems {
        if let Reference::Prescribed(translation) = &system.reference {
            add(translation);
        }
    }
    for vehicle in &model.vehicles {
        for angle in &vehicle.angles {
            if let FieldComponent::Curve(curve) = angle {
                curves.push(curve.curve);
            }
        }
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(rest: &str) -> Model {
        let text = format!(
            "model: one\ndimension: 2\ncurves:\n  bent: {{ points: [[0, 0], [1, 2], [2, 3]], extrapolate: linear }}\n  \
             straight: {{ points: [[0, 0], [1, 2]], extrapolate: linear }}\n  smooth: {{ points: [[0, 0], [1, 2], [2, \
             3]], extrapolate: linear, interpolate: cubic }}\nsystems:\n  - name: a\n    elements:\n      - {{ name: b, \
             mass: 2 kg, cg: [0.1, -0.4], inertia: 0.05 }}\n{rest}run: {{ duration: 1 s, every: 0.1 s }}\n"
        );
        let none = |_: &std::path::Path| Err(std::io::Error::from(std::io::ErrorKind::NotFound));
        bryant_generator::read_str("one.yaml", &text, &none)
            .unwrap_or_else(|e| panic!("{e}"))
            .0
    }

    #[test]
    fn lines_and_cubics_change_places_and_back() {
        let forces = "forces:\n  - { field: f, acceleration: [bent, smooth] }\n  - { field: g, acceleration: [straight, 0] }\n";
        let before = model(forces);
        let after = exchanged(&before).unwrap();
        assert_ne!(before.digest, after.digest);
        for (a, b) in before.curves.iter().zip(&after.curves) {
            assert_eq!(a.points, b.points);
            assert_eq!(
                a.interpolate == b.interpolate,
                a.name == "straight",
                "{}",
                a.name
            );
        }
        assert_eq!(exchanged(&after).unwrap(), before);
    }

    #[test]
    fn a_scene_without_bent_curves_has_nothing_to_exchange() {
        let forces = "forces:\n  - { field: g, acceleration: [straight, 0] }\n";
        assert_eq!(exchanged(&model(forces)), None);
    }
}
