//! Butcher tableaux, checked below against the order conditions of rooted trees (Butcher 1963).

/// The classical method of order 4 (Kutta 1901):
///
/// ```text
///   0  |
///  1/2 | 1/2
///  1/2 |  0   1/2
///   1  |  0    0    1
/// -----+--------------------
///      | 1/6  1/3  1/3  1/6
/// ```
pub mod kutta {
    /// Nodes.
    pub const C: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
    /// Coefficients of the second to fourth stage.
    pub const A: [[f64; 3]; 3] = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.0]];
    /// Weights.
    pub const B: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
}

/// The pair of orders 5 and 4 by Dormand & Prince (J. Comp. Appl. Math. 6, 1980); the last stage of a step is the first
/// of the next:
///
/// ```text
///   0   |
///  1/5  |     1/5
///  3/10 |     3/40        9/40
///  4/5  |    44/45      −56/15       32/9
///  8/9  | 19372/6561 −25360/2187  64448/6561  −212/729
///   1   |  9017/3168    −355/33   46732/5247    49/176   −5103/18656
///   1   |    35/384        0        500/1113   125/192   −2187/6784    11/84
/// ------+-----------------------------------------------------------------------
///   5th |    35/384        0        500/1113   125/192   −2187/6784    11/84    0
///   4th |  5179/57600      0       7571/16695  393/640  −92097/339200 187/2100 1/40
/// ```
pub mod dormand_prince {
    /// Nodes.
    pub const C: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

    /// Coefficients of the second to seventh stage; the last row is the result of order 5.
    pub const A: [[f64; 6]; 6] = [
        [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
            0.0,
            0.0,
        ],
        [
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
            0.0,
        ],
        [
            35.0 / 384.0,
            0.0,
            500.0 / 1113.0,
            125.0 / 192.0,
            -2187.0 / 6784.0,
            11.0 / 84.0,
        ],
    ];

    /// Weights of order 5.
    pub const B: [f64; 7] = [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
        0.0,
    ];

    /// Weights of order 5 less those of order 4: the estimate of the error.
    pub const E: [f64; 7] = [
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ];

    /// What the interpolant adds to the cubic Hermite polynomial of the step, times θ²(1−θ)² (Shampine 1986; the numbers
    /// as in Hairer, Nørsett & Wanner, *Solving ODEs I*, dopri5).
    pub const D: [f64; 7] = [
        -12715105075.0 / 11282082432.0,
        0.0,
        87487479700.0 / 32700410799.0,
        -10690763975.0 / 1880347072.0,
        701980252875.0 / 199316789632.0,
        -1453857185.0 / 822651844.0,
        69997945.0 / 29380423.0,
    ];

    /// Weights b(θ) of the interpolant of order 4: y(t + θh) = y + h Σ b_i(θ) k_i, for θ in 0..=1.
    pub fn interpolation_weights(theta: f64) -> [f64; 7] {
        let rest = 1.0 - theta;
        core::array::from_fn(|i| {
            // y = y₀ + θ(Δ + (1−θ)(h k₁ − Δ + θ(2Δ − h k₁ − h k₇ + (1−θ) h Σ d k))), Δ = h Σ b k
            let first = if i == 0 { 1.0 } else { 0.0 };
            let last = if i == 6 { 1.0 } else { 0.0 };
            let quartic = 2.0 * B[i] - first - last + rest * D[i];
            theta * (B[i] + rest * (first - B[i] + theta * quartic))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{dormand_prince, kutta};

    /// The rooted trees of up to five nodes as (order, density γ, elementary weight Φ(b, A, c)): b·Φ = 1/γ.
    fn residuals(order: usize, b: &[f64], a: &dyn Fn(usize, usize) -> f64, theta: f64) -> Vec<f64> {
        let n = b.len();
        let apply = |v: &[f64]| -> Vec<f64> {
            (0..n)
                .map(|i| (0..n).map(|j| a(i, j) * v[j]).sum())
                .collect()
        };
        let times =
            |u: &[f64], v: &[f64]| -> Vec<f64> { u.iter().zip(v).map(|(u, v)| u * v).collect() };
        let one = vec![1.0; n];
        let c = apply(&one);
        let c2 = times(&c, &c);
        let c3 = times(&c2, &c);
        let ac = apply(&c);
        let ac2 = apply(&c2);
        let aac = apply(&ac);
        let trees: [(usize, f64, Vec<f64>); 17] = [
            (1, 1.0, one.clone()),
            (2, 2.0, c.clone()),
            (3, 3.0, c2.clone()),
            (3, 6.0, ac.clone()),
            (4, 4.0, c3.clone()),
            (4, 8.0, times(&c, &ac)),
            (4, 12.0, ac2.clone()),
            (4, 24.0, aac.clone()),
            (5, 5.0, times(&c2, &c2)),
            (5, 10.0, times(&c2, &ac)),
            (5, 15.0, times(&c, &ac2)),
            (5, 30.0, times(&c, &aac)),
            (5, 20.0, times(&ac, &ac)),
            (5, 20.0, apply(&c3)),
            (5, 40.0, apply(&times(&c, &ac))),
            (5, 60.0, apply(&ac2)),
            (5, 120.0, apply(&aac)),
        ];
        trees
            .iter()
            .filter(|(nodes, ..)| *nodes <= order)
            .map(|(nodes, density, weight)| {
                let sum: f64 = b.iter().zip(weight).map(|(b, w)| b * w).sum();
                sum - theta.powi(*nodes as i32) / density
            })
            .collect()
    }

    fn check(order: usize, b: &[f64], a: &dyn Fn(usize, usize) -> f64, theta: f64) {
        for (tree, residual) in residuals(order, b, a, theta).iter().enumerate() {
            // sums of some ten terms up to 12 in size
            assert!(
                residual.abs() < 100.0 * f64::EPSILON,
                "tree {tree}: {residual:e}"
            );
        }
    }

    fn kutta_a(i: usize, j: usize) -> f64 {
        if i > 0 && j < 3 {
            kutta::A[i - 1][j]
        } else {
            0.0
        }
    }

    fn dormand_prince_a(i: usize, j: usize) -> f64 {
        if i > 0 && j < 6 {
            dormand_prince::A[i - 1][j]
        } else {
            0.0
        }
    }

    #[test]
    fn nodes_are_row_sums() {
        for (i, c) in kutta::C.iter().enumerate() {
            assert_eq!((0..4).map(|j| kutta_a(i, j)).sum::<f64>(), *c);
        }
        for (i, c) in dormand_prince::C.iter().enumerate() {
            let sum: f64 = (0..7).map(|j| dormand_prince_a(i, j)).sum();
            assert!((sum - c).abs() < 40.0 * f64::EPSILON);
        }
    }

    #[test]
    fn kutta_has_order_4_and_no_more() {
        check(4, &kutta::B, &kutta_a, 1.0);
        assert!(
            residuals(5, &kutta::B, &kutta_a, 1.0)
                .iter()
                .any(|r| r.abs() > 1e-3)
        );
    }

    #[test]
    fn dormand_prince_has_orders_5_and_4() {
        use dormand_prince::{B, E};
        check(5, &B, &dormand_prince_a, 1.0);
        let fourth: Vec<f64> = B.iter().zip(E).map(|(b, e)| b - e).collect();
        check(4, &fourth, &dormand_prince_a, 1.0);
        let misses = residuals(5, &fourth, &dormand_prince_a, 1.0);
        assert!(
            misses.iter().any(|r| r.abs() > 1e-4),
            "the pair would see no error"
        );
        let weights = [
            5179.0 / 57600.0,
            0.0,
            7571.0 / 16695.0,
            393.0 / 640.0,
            -92097.0 / 339200.0,
        ];
        for (b, printed) in fourth.iter().zip(weights) {
            assert!((b - printed).abs() < 1e-15);
        }
    }

    #[test]
    fn interpolant_has_order_4_everywhere_and_meets_the_ends() {
        use dormand_prince::{B, interpolation_weights};
        for step in 0..=20 {
            let theta = f64::from(step) / 20.0;
            check(4, &interpolation_weights(theta), &dormand_prince_a, theta);
        }
        assert_eq!(interpolation_weights(0.0), [0.0; 7]);
        assert_eq!(interpolation_weights(1.0), B);
    }
}
