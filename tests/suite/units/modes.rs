use bryant::modes::{Mode, NoModes, Number, modes};

/// [0 1; −ω² −2ζω]
#[test]
fn an_oscillator_has_its_frequency_and_damping() {
    let (omega, zeta) = (30.0, 0.05);
    let found = modes(&[0.0, 1.0, -omega * omega, -2.0 * zeta * omega], 2, &[]).unwrap();
    assert_eq!(found.len(), 1);
    let rate = found[0].rate;
    assert!((rate.norm() - omega).abs() < 1e-12 * omega, "{rate}");
    assert!((-rate.re / rate.norm() - zeta).abs() < 1e-13, "{rate}");
    // v = λ q
    let [q, v] = found[0].shape[..] else { panic!() };
    assert!((v - rate * q).norm() < 1e-12, "{q} {v}");
}

#[test]
fn a_free_motion_is_hidden_and_an_unstable_one_grows() {
    let free = modes(&[0.0, 1.0, 0.0, 0.0], 2, &[]).unwrap();
    assert!(free.iter().all(|mode| mode.rate.norm() <= 1e-7), "{free:?}");
    let falls = modes(&[0.0, 1.0, 9.0, 0.0], 2, &[]).unwrap();
    let rates: Vec<f64> = falls.iter().map(|mode| mode.rate.re).collect();
    assert!(
        (rates[0].abs() - 3.0).abs() < 1e-14 && (rates[0] + rates[1]).abs() < 1e-14,
        "{rates:?}"
    );
    assert_eq!(modes(&[f64::NAN], 1, &[]).unwrap_err(), NoModes::NotFinite);
}

/// Two equal oscillators beside each other, in coordinates that mix them: each is a shape, and orthogonal in the mass
/// matrix.
#[test]
fn shapes_of_rates_that_coincide_are_orthogonal_in_the_mass_matrix() {
    // S = [2 1; 1 2], K = 9 S
    let a = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [-9.0, 0.0, 0.0, 0.0],
        [0.0, -9.0, 0.0, 0.0],
    ];
    let mass = [2.0, 1.0, 1.0, 2.0];
    let found = modes(a.as_flattened(), 4, &mass).unwrap();
    assert_eq!(found.len(), 2);
    let [p, q] = [0, 1].map(|k| &found[k].shape);
    let product: Number = (0..4).map(|k| p[k / 2].conj() * mass[k] * q[k % 2]).sum();
    assert!(product.norm() < 1e-13, "{p:?} {q:?}");
    // the first velocity alone, and what is orthogonal to it: [1, −2]
    assert!(p[1].norm() < 1e-13 * p[0].norm(), "{p:?}");
    assert!((q[1] + 2.0 * q[0]).norm() < 1e-13 * q[0].norm(), "{q:?}");
    assert!(found.iter().all(|mode| mode.residual < 1e-14), "{found:?}");
}

/// A body that nothing holds beside two that are held: all of its motions are found, and nothing else.
#[test]
fn free_motions_are_all_found() {
    // three velocities, of which the second is slowed down by damping
    let mut a = [[0.0; 6]; 6];
    (0..3).for_each(|k| a[k][3 + k] = 1.0);
    a[4][4] = -5.0;
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let found = modes(a.as_flattened(), 6, &mass).unwrap();
    let free: Vec<&Mode> = found.iter().filter(|m| m.rate.norm() < 1e-6).collect();
    assert_eq!(free.len(), 5);
    for k in 0..3 {
        let alone = |mode: &&&Mode| {
            (0..6).all(|i| (mode.shape[i].norm() - f64::from(u8::from(i == k))).abs() < 1e-12)
        };
        assert!(free.iter().any(|mode| alone(&mode)), "{k}: {free:?}");
    }
}

/// Two inverted pendulums: each rate twice, with two shapes.
#[test]
fn what_coincides_is_there_twice() {
    let a = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [16.0, 0.0, 0.0, 0.0],
        [0.0, 16.0, 0.0, 0.0],
    ];
    let found = modes(a.as_flattened(), 4, &[]).unwrap();
    let mut rates: Vec<f64> = found.iter().map(|mode| mode.rate.re).collect();
    rates.sort_by(f64::total_cmp);
    for (rate, expected) in rates.iter().zip([-4.0, -4.0, 4.0, 4.0]) {
        assert!((rate - expected).abs() < 1e-12, "{rates:?}");
    }
    assert!(found.iter().all(|mode| mode.residual < 1e-14), "{found:?}");
}

/// Badly scaled: lengths in nanometres beside angles.
#[test]
fn scales_do_not_matter() {
    let a = [0.0, 1e9, -4e-9, 0.0];
    let found = modes(&a, 2, &[]).unwrap();
    assert!(
        (found[0].rate - Number::new(0.0, 2.0)).norm() < 1e-14,
        "{found:?}"
    );
    assert!(found[0].residual < 1e-15);
}
