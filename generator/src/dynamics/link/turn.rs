//! Constant and variable rotations between the axes of two links, in few operations.

use crate::dynamics::augmented_body::rotated;
use crate::expression::Expr;
use crate::expression::vector::{Mat3, Sym3, Vec3};

/// A rotation from the axes of one frame to those of another: v ↦ R v.
#[derive(Clone, Copy)]
pub enum Turn<'g> {
    /// A rotation by this number of right angles, 1 to 3, about the axis with this index. It needs no operation.
    Quarters(usize, u8),
    /// A rotation by an angle about the axis with this index.
    About {
        axis: usize,
        sine: Expr<'g>,
        cosine: Expr<'g>,
    },
    /// A rotation by a matrix.
    Matrix(Mat3<'g>),
}

impl<'g> Turn<'g> {
    /// The inverse rotation.
    pub fn inverse(&self) -> Self {
        match *self {
            Turn::Quarters(axis, quarters) => Turn::Quarters(axis, 4 - quarters),
            Turn::About { axis, sine, cosine } => Turn::About {
                axis,
                sine: -sine,
                cosine,
            },
            Turn::Matrix(matrix) => Turn::Matrix(matrix.transposed()),
        }
    }

    /// R v
    pub fn vector(&self, v: Vec3<'g>) -> Vec3<'g> {
        let mut turned = v;
        match *self {
            Turn::Quarters(axis, quarters) => {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                for _ in 0..quarters {
                    (turned.0[i], turned.0[j]) = (-turned.0[j], turned.0[i]);
                }
            }
            Turn::About { axis, sine, cosine } => {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                turned.0[i] = cosine * v.0[i] - sine * v.0[j];
                turned.0[j] = sine * v.0[i] + cosine * v.0[j];
            }
            Turn::Matrix(matrix) => turned = matrix.times(v),
        }
        turned
    }

    /// R M Rᵀ for a symmetric M
    pub fn symmetric(&self, m: Sym3<'g>) -> Sym3<'g> {
        match *self {
            Turn::Quarters(..) => {
                let turned =
                    self.general(Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| m.entry(i, j)))));
                Sym3::from_fn(|i, j| turned.0[i][j])
            }
            Turn::About { axis, sine, cosine } => {
                let (i, j, k) = ((axis + 1) % 3, (axis + 2) % 3, axis);
                let [xx, yy, xy] = in_plane(
                    [m.entry(i, i), m.entry(j, j), m.entry(i, j)],
                    (sine, cosine),
                );
                let (x, y) = (m.entry(i, k), m.entry(j, k));
                let (xz, yz) = (cosine * x - sine * y, sine * x + cosine * y);
                Sym3::from_fn(|a, b| match (a == k, b == k) {
                    (true, true) => m.entry(k, k),
                    (true, false) | (false, true) if a + b == i + k => xz,
                    (true, false) | (false, true) => yz,
                    _ if a != b => xy,
                    _ if a == i => xx,
                    _ => yy,
                })
            }
            Turn::Matrix(matrix) => rotated(m.diagonal[0].graph(), &matrix, &m),
        }
    }

    /// R M Rᵀ
    pub fn general(&self, m: Mat3<'g>) -> Mat3<'g> {
        match *self {
            Turn::About { axis, sine, cosine } => {
                let (i, j, k) = ((axis + 1) % 3, (axis + 2) % 3, axis);
                let e = m.0;
                let mut turned = m;
                // xx −= s w, yy += s w, xy = c w − yx, yx = c w − xy, with w = s (xx − yy) + c (xy + yx)
                let w = sine * (e[i][i] - e[j][j]) + cosine * (e[i][j] + e[j][i]);
                let (sw, cw) = (sine * w, cosine * w);
                turned.0[i][i] = e[i][i] - sw;
                turned.0[j][j] = e[j][j] + sw;
                turned.0[i][j] = cw - e[j][i];
                turned.0[j][i] = cw - e[i][j];
                turned.0[i][k] = cosine * e[i][k] - sine * e[j][k];
                turned.0[j][k] = sine * e[i][k] + cosine * e[j][k];
                turned.0[k][i] = cosine * e[k][i] - sine * e[k][j];
                turned.0[k][j] = sine * e[k][i] + cosine * e[k][j];
                turned
            }
            _ => {
                let half = Mat3(m.0.map(|row| self.vector(Vec3(row)).0));
                Mat3::from_columns([0, 1, 2].map(|j| self.vector(half.column(j))))
            }
        }
    }
}

/// xx, yy and xy of a symmetric matrix, rotated in their plane: with A = xx − yy and w = s A + 2 c xy, xx − s w,
/// yy + s w, c w − xy.
fn in_plane<'g>(
    [xx, yy, xy]: [Expr<'g>; 3],
    (sine, cosine): (Expr<'g>, Expr<'g>),
) -> [Expr<'g>; 3] {
    let difference = xx - yy;
    // if the entries are constant, s² and s c are shared by all matrices that turn by this angle
    let constant = |e: Expr<'g>| e.as_constant().is_some();
    if constant(difference) && constant(xy) {
        if xy.is_zero() {
            let w = difference * (sine * sine);
            return [xx - w, yy + w, difference * (sine * cosine)];
        }
        if difference.is_zero() {
            let w = (2.0 * xy) * (sine * cosine);
            return [xx - w, yy + w, (2.0 * xy) * (cosine * cosine) - xy];
        }
    }
    let w = sine * difference + (2.0 * cosine) * xy;
    let s = sine * w;
    [xx - s, yy + s, cosine * w - xy]
}

/// A vector after several rotations, in order.
pub fn through<'g>(turns: &[Turn<'g>], v: Vec3<'g>) -> Vec3<'g> {
    turns.iter().fold(v, |v, turn| turn.vector(v))
}

/// A vector after the inverse of several rotations.
pub fn back_through<'g>(turns: &[Turn<'g>], v: Vec3<'g>) -> Vec3<'g> {
    turns
        .iter()
        .rev()
        .fold(v, |v, turn| turn.inverse().vector(v))
}
