//! Rotations of a set of directions, one for each frame of a progressive picture.

use std::f64::consts::TAU;

/// A rotation as a unit quaternion, real part first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation(pub [f64; 4]);

impl Rotation {
    /// The rotation of a frame (paper section 6, "Progressive Rendering"): none for frame 0, the
    /// deterministic set itself; else one of all rotations, none more likely than another
    /// (Shoemake 1992). The same for the same seed and frame.
    pub fn of(seed: u64, frame: u32) -> Self {
        if frame == 0 {
            return Self([1.0, 0.0, 0.0, 0.0]);
        }
        let mut state = seed ^ u64::from(frame).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let [u, v, w] = [(); 3].map(|()| uniform(&mut state));
        let (inner, outer) = (libm::sqrt(1.0 - u), libm::sqrt(u));
        let (sin_v, cos_v) = libm::sincos(TAU * v);
        let (sin_w, cos_w) = libm::sincos(TAU * w);
        Self([outer * cos_w, inner * sin_v, inner * cos_v, outer * sin_w])
    }

    /// The vector, turned.
    pub fn turn(&self, v: [f64; 3]) -> [f64; 3] {
        let [w, x, y, z] = self.0;
        let axis = [x, y, z];
        let twice = cross(axis, v).map(|c| 2.0 * c);
        let more = cross(axis, twice);
        [0, 1, 2].map(|i| v[i] + w * twice[i] + more[i])
    }
}

/// A set of directions in a frame.
pub fn rotated(directions: &[[f64; 3]], seed: u64, frame: u32) -> Vec<[f64; 3]> {
    let rotation = Rotation::of(seed, frame);
    directions.iter().map(|d| rotation.turn(*d)).collect()
}

/// A number of [0, 1) by SplitMix64 (Steele, Lea and Flood 2014).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
