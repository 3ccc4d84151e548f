//! Vectors, rotations and tensors of plain numbers: for the places of bodies while a model is read, and for principal
//! axes.

/// A vector \[x, y, z\].
pub type Vector = [f64; 3];

/// A matrix by rows. A rotation matrix turns the local frame to the outer frame.
pub type Matrix = [[f64; 3]; 3];

/// The unit matrix.
pub const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// An angle that is closer than this to a multiple of 90° counts as that multiple, written with all digits of `f64`
/// \[rad\].
const RIGHT_ANGLE_TO: f64 = 1e-15;

/// a·b.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// a + b.
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a − b.
pub fn subtract(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a times a number.
pub fn scale(a: Vector, by: f64) -> Vector {
    a.map(|component| component * by)
}

/// Length of a vector.
pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// M a.
pub fn apply(m: &Matrix, a: Vector) -> Vector {
    [dot(m[0], a), dot(m[1], a), dot(m[2], a)]
}

/// Mᵀ.
pub fn transpose(m: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

/// A B.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transpose(b);
    std::array::from_fn(|i| std::array::from_fn(|j| dot(a[i], columns[j])))
}

/// R T Rᵀ, a tensor in outer axes.
pub fn turned(r: &Matrix, tensor: &Matrix) -> Matrix {
    product(&product(r, tensor), &transpose(r))
}

/// Sine and cosine, exact at multiples of 90°.
fn sine_cosine(angle: f64) -> (f64, f64) {
    let quarters = (angle / std::f64::consts::FRAC_PI_2).round();
    let near = quarters * std::f64::consts::FRAC_PI_2;
    if (angle - near).abs() > RIGHT_ANGLE_TO * quarters.abs().max(1.0) {
        return libm::sincos(angle);
    }
    match quarters.rem_euclid(4.0) as u8 {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// The rotation by roll, pitch and yaw about the fixed axes x, y and z: Rz(yaw) Ry(pitch) Rx(roll).
pub fn of_roll_pitch_yaw([roll, pitch, yaw]: Vector) -> Matrix {
    let [(sr, cr), (sp, cp), (sy, cy)] = [roll, pitch, yaw].map(sine_cosine);
    [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
}

/// The rotation of a quaternion (x, y, z, w) of any length; `None` if the length is zero or not finite.
pub fn of_quaternion(q: [f64; 4]) -> Option<Matrix> {
    let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
    if !(norm > 0.0 && norm.is_finite()) {
        return None;
    }
    let [x, y, z, w] = q.map(|c| c / norm);
    Some([
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - z * w),
            2.0 * (x * z + y * w),
        ],
        [
            2.0 * (x * y + z * w),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - x * w),
        ],
        [
            2.0 * (x * z - y * w),
            2.0 * (y * z + x * w),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ])
}

/// Bryant angles of a rotation, A = Rx(φ₁) Ry(φ₂) Rz(φ₃).
pub fn bryant_angles(a: &Matrix) -> Vector {
    let across = libm::hypot(a[0][0], a[0][1]);
    // close to φ₂ = ±90° only φ₁ ± φ₃ is determined, so φ₃ is set to 0
    if across < 1e-12 {
        let first = libm::atan2(a[2][1], a[1][1]);
        return [first, libm::atan2(a[0][2], across), 0.0];
    }
    [
        libm::atan2(-a[1][2], a[2][2]),
        libm::atan2(a[0][2], across),
        libm::atan2(-a[0][1], a[0][0]),
    ]
}

/// The principal values of a symmetric tensor, and the rotation from its principal axes to the axes in which it is
/// given.
///
/// Jacobi's method: each step makes one off-diagonal entry zero. Entries that are zero stay zero if possible; a
/// diagonal tensor is not turned.
pub fn principal(tensor: &Matrix) -> (Vector, Matrix) {
    let mut a = *tensor;
    let mut axes = IDENTITY;
    for _ in 0..60 {
        let (p, q) = [(0, 1), (0, 2), (1, 2)]
            .into_iter()
            .max_by(|&(i, j), &(k, l)| a[i][j].abs().total_cmp(&a[k][l].abs()))
            .unwrap_or((0, 1));
        let off = a[p][q];
        let size = (a[p][p].abs() * a[q][q].abs()).sqrt();
        if off == 0.0 || off.abs() <= 1e-18 * size {
            break;
        }
        let theta = (a[q][q] - a[p][p]) / (2.0 * off);
        let t = theta.signum() / (theta.abs() + libm::hypot(theta, 1.0));
        let c = 1.0 / libm::hypot(t, 1.0);
        let s = t * c;
        let mut turn = IDENTITY;
        (turn[p][p], turn[q][q], turn[p][q], turn[q][p]) = (c, c, s, -s);
        a = product(&product(&transpose(&turn), &a), &turn);
        (a[p][q], a[q][p]) = (0.0, 0.0);
        axes = product(&axes, &turn);
    }
    ([a[0][0], a[1][1], a[2][2]], axes)
}
