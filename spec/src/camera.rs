//! Cameras: clip space from world space, in WebGPU's convention.

use crate::matrix::Matrix;

/// Largest magnitude of a matrix entry. Products with `f32` coordinates and the
/// products of those in clipping then stay far below the largest `f64`.
pub const ENTRY_MAX: f64 = 1e100;

/// How depth and size on screen relate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Vertical field of view in degrees, in (0, 180).
    Perspective {
        /// Full vertical angle.
        fov: f64,
    },
    /// World units from the bottom of the picture to its top.
    Orthographic {
        /// Height of the view volume.
        height: f64,
    },
}

/// A camera that looks from `eye` to `target`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position in world space.
    pub eye: [f64; 3],
    /// Point in the middle of the picture.
    pub target: [f64; 3],
    /// Any vector that has an upward part and is not parallel to the view.
    pub up: [f64; 3],
    /// Perspective or orthographic.
    pub projection: Projection,
    /// Distance of the plane with depth 0; positive for a perspective.
    pub near: f64,
    /// Distance of the plane with depth 1.
    pub far: f64,
}

/// Why a camera has no matrix.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A number is NaN, infinite, or so large or small that the matrix is.
    #[error("camera: {0} is out of range")]
    OutOfRange(&'static str),
    /// The view direction is zero or parallel to `up`.
    #[error("camera: eye, target and up must span a plane")]
    NoDirection,
    /// Planes or angles outside what a projection allows.
    #[error("camera: {0}")]
    Projection(&'static str),
}

impl Camera {
    /// Clip space from world space for a picture of the given aspect (width over
    /// height). Right-handed world, y up in clip space, depth 0 at `near`, 1 at
    /// `far`.
    ///
    /// # Errors
    /// Whatever makes the matrix meaningless, by name.
    pub fn matrix(&self, aspect: f64) -> Result<Matrix, CameraError> {
        self.check()?;
        let m = self.projection(aspect).times(&self.view()?);
        if m.rows.iter().flatten().all(|v| v.abs() <= ENTRY_MAX) {
            Ok(m)
        } else {
            Err(CameraError::OutOfRange("the matrix"))
        }
    }

    fn check(&self) -> Result<(), CameraError> {
        let vectors = [self.eye, self.target, self.up];
        if !vectors.iter().flatten().all(|v| v.is_finite()) {
            return Err(CameraError::OutOfRange("a coordinate"));
        }
        if !(self.near.is_finite() && self.far.is_finite() && self.near < self.far) {
            return Err(CameraError::Projection("near must be less than far"));
        }
        match self.projection {
            Projection::Perspective { fov } if !(fov > 0.0 && fov < 180.0) => {
                Err(CameraError::Projection("fov must lie in (0, 180) degrees"))
            }
            Projection::Perspective { .. } if self.near <= 0.0 => Err(CameraError::Projection(
                "near must be positive for a perspective",
            )),
            Projection::Orthographic { height } if !(height.is_finite() && height > 0.0) => {
                Err(CameraError::Projection("height must be positive"))
            }
            _ => Ok(()),
        }
    }

    /// View space from world space: x right, y up, looking along -z.
    fn view(&self) -> Result<Matrix, CameraError> {
        let forward = normalize(sub(self.target, self.eye))?;
        let right = cross(forward, normalize(self.up)?);
        // Closer to parallel than this, rounding picks the direction.
        if dot(right, right) < 1e-18 {
            return Err(CameraError::NoDirection);
        }
        let right = normalize(right)?;
        let up = cross(right, forward);
        let row = |v: [f64; 3]| [v[0], v[1], v[2], -dot(v, self.eye)];
        let back = forward.map(|v| -v);
        Ok(Matrix {
            rows: [row(right), row(up), row(back), [0.0, 0.0, 0.0, 1.0]],
        })
    }

    /// From the middle of the picture to the middles of its right and upper sides, and straight
    /// ahead: of a perspective at distance 1, of an orthographic view as large as it is.
    ///
    /// # Errors
    /// Those of [`Camera::matrix`].
    pub fn axes(&self, aspect: f64) -> Result<[[f64; 3]; 3], CameraError> {
        self.matrix(aspect)?;
        let [right, up, back, _] = self.view()?.rows.map(|[x, y, z, _]| [x, y, z]);
        let half = match self.projection {
            Projection::Perspective { fov } => libm::tan(fov.to_radians() / 2.0),
            Projection::Orthographic { height } => height / 2.0,
        };
        Ok([
            right.map(|c| c * half * aspect),
            up.map(|c| c * half),
            back.map(|c| -c),
        ])
    }

    fn projection(&self, aspect: f64) -> Matrix {
        let (n, f) = (self.near, self.far);
        match self.projection {
            Projection::Perspective { fov } => {
                let y = 1.0 / libm::tan(fov.to_radians() / 2.0);
                Matrix {
                    rows: [
                        [y / aspect, 0.0, 0.0, 0.0],
                        [0.0, y, 0.0, 0.0],
                        [0.0, 0.0, -f / (f - n), -(f / (f - n)) * n],
                        [0.0, 0.0, -1.0, 0.0],
                    ],
                }
            }
            Projection::Orthographic { height } => {
                let y = 2.0 / height;
                let mut m = Matrix::scale([y / aspect, y, -1.0 / (f - n)]);
                m.rows[2][3] = -n / (f - n);
                m
            }
        }
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Unit vector; scaled by the largest component first, so that lengths from
/// 1e-300 to 1e300 neither vanish nor overflow.
fn normalize(v: [f64; 3]) -> Result<[f64; 3], CameraError> {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return Err(CameraError::NoDirection);
    }
    let v = v.map(|x| x / largest);
    let length = dot(v, v).sqrt();
    Ok(v.map(|x| x / length))
}
