//! 4x4 matrices in `f64`, column vectors, rows first.

/// A 4x4 matrix; `rows[r][c]` multiplies component `c` into component `r`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix {
    /// The four rows.
    pub rows: [[f64; 4]; 4],
}

impl Matrix {
    /// The identity.
    pub const IDENTITY: Self = Self::scale([1.0, 1.0, 1.0]);

    /// Scales each axis.
    pub const fn scale(s: [f64; 3]) -> Self {
        Self {
            rows: [
                [s[0], 0.0, 0.0, 0.0],
                [0.0, s[1], 0.0, 0.0],
                [0.0, 0.0, s[2], 0.0],
                [0.0, 0.0, 0.0, 1.0],
            ],
        }
    }

    /// Moves by `t`.
    pub const fn translate(t: [f64; 3]) -> Self {
        Self {
            rows: [
                [1.0, 0.0, 0.0, t[0]],
                [0.0, 1.0, 0.0, t[1]],
                [0.0, 0.0, 1.0, t[2]],
                [0.0, 0.0, 0.0, 1.0],
            ],
        }
    }

    /// Rotates by `degrees` about `axis` (0, 1, 2 for x, y, z), right-handed.
    /// Multiples of 90 degrees are exact.
    pub fn rotate(axis: usize, degrees: f64) -> Self {
        let (sin, cos) = sin_cos_degrees(degrees);
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut m = Self::IDENTITY;
        m.rows[i][i] = cos;
        m.rows[i][j] = -sin;
        m.rows[j][i] = sin;
        m.rows[j][j] = cos;
        m
    }

    /// `self * other`: `other` is applied first.
    pub fn times(&self, other: &Self) -> Self {
        let mut rows = [[0.0; 4]; 4];
        for (r, row) in rows.iter_mut().enumerate() {
            for (c, out) in row.iter_mut().enumerate() {
                *out = (0..4).map(|k| self.rows[r][k] * other.rows[k][c]).sum();
            }
        }
        Self { rows }
    }

    /// Applies the matrix to the point `p`, ignoring the fourth row.
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let row = |r: usize| {
            let m = self.rows[r];
            m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3]
        };
        [row(0), row(1), row(2)]
    }
}

/// Sine and cosine from `libm`, exact at multiples of a right angle.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        d => libm::sincos(d.to_radians()),
    }
}
