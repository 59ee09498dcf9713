//! Named mesh generators: same seed and parameters, same mesh.

mod flat;
mod scatter;
mod solid;
#[cfg(test)]
mod tests;

use serde::Deserialize;

use crate::mesh::{Mesh, TRIANGLES_MAX, VERTICES_MAX};
use crate::scene::value::{Number, Point, exactly};

/// A generator and its parameters. Lengths are in object space.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Generator {
    /// The polygons written in the scene; more than three corners become a fan
    /// around the first.
    Faces {
        /// Positions.
        vertices: Vec<Point>,
        /// Corners by number, from 0.
        faces: Vec<Vec<u32>>,
    },
    /// Quads of two triangles each that face +z, around the origin: layer `i` at
    /// `z = -i * spacing`.
    Stack {
        /// Number of quads.
        layers: u32,
        /// Width and height.
        #[serde(deserialize_with = "exactly")]
        size: [Number; 2],
        /// Distance of neighbours; 0 makes them coplanar.
        spacing: Number,
        /// In which order the layers are numbered.
        #[serde(default)]
        order: Order,
    },
    /// Triangles around the origin in the xy plane that share edges and close the
    /// circle: together they cover a polygon exactly once.
    Fan {
        /// Number of triangles, at least 3.
        spokes: u32,
        /// Distance of the rim; not negative.
        radius: Number,
        /// Height of the hub over the rim.
        #[serde(default)]
        hub: Number,
    },
    /// A rectangle in the xy plane, around the origin, of cells of two triangles
    /// each, which together cover it exactly once.
    Grid {
        /// Columns and rows.
        #[serde(deserialize_with = "exactly")]
        cells: [u32; 2],
        /// Width and height of a cell.
        #[serde(deserialize_with = "exactly")]
        cell: [Number; 2],
        /// How far inner vertices stray, as a share of the cell; under 0.25, so
        /// that no triangle turns over.
        #[serde(default)]
        jitter: Number,
        /// How far vertices stray along z.
        #[serde(default)]
        relief: Number,
    },
    /// Triangles of one length and width, anywhere in a box, turned at random.
    Scatter {
        /// How many different ones.
        count: u32,
        /// Sides of the box, around the origin.
        extent: Point,
        /// Longest edge.
        length: Number,
        /// Altitude over the longest edge; 0 makes triangles without area.
        width: Number,
        /// How often each occurs, exactly coincident.
        #[serde(default = "one")]
        copies: u32,
        /// Whether all lie parallel to the xy plane.
        #[serde(default)]
        flat: bool,
    },
    /// A sphere around the origin, poles on the y axis.
    Sphere {
        /// Radius; not negative.
        radius: Number,
        /// Segments from pole to pole, at least 2, and around, at least 3.
        #[serde(deserialize_with = "exactly")]
        segments: [u32; 2],
    },
    /// A torus around the y axis.
    Torus {
        /// Radius of the ring, and of the tube; neither negative.
        #[serde(deserialize_with = "exactly")]
        radii: [Number; 2],
        /// Segments around the ring and around the tube, at least 3 each.
        #[serde(deserialize_with = "exactly")]
        segments: [u32; 2],
    },
    /// A box around the origin, of 12 triangles.
    Box {
        /// Lengths of the sides.
        size: Point,
    },
}

/// In which order the layers of a stack are numbered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// Nearest to +z first.
    #[default]
    FrontToBack,
    /// Nearest to +z last.
    BackToFront,
    /// At random.
    Shuffled,
}

fn one() -> u32 {
    1
}

impl Generator {
    /// The name that a scene calls it by.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Faces { .. } => "faces",
            Self::Stack { .. } => "stack",
            Self::Fan { .. } => "fan",
            Self::Grid { .. } => "grid",
            Self::Scatter { .. } => "scatter",
            Self::Sphere { .. } => "sphere",
            Self::Torus { .. } => "torus",
            Self::Box { .. } => "box",
        }
    }

    /// The mesh.
    ///
    /// # Errors
    /// A parameter out of its range, by name and value.
    pub fn mesh(&self, seed: u64) -> Result<Mesh, String> {
        let mut random = Random::new(seed);
        let shape = match self {
            Self::Faces { vertices, faces } => flat::faces(vertices, faces),
            Self::Stack {
                layers,
                size,
                spacing,
                order,
            } => flat::stack(*layers, numbers(*size), spacing.0, *order, &mut random),
            Self::Fan {
                spokes,
                radius,
                hub,
            } => flat::fan(*spokes, radius.0, hub.0),
            Self::Grid {
                cells,
                cell,
                jitter,
                relief,
            } => flat::grid(*cells, numbers(*cell), [jitter.0, relief.0], &mut random),
            Self::Scatter { .. } => scatter::scatter(self, &mut random),
            Self::Sphere { radius, segments } => solid::sphere(radius.0, *segments),
            Self::Torus { radii, segments } => solid::torus(numbers(*radii), *segments),
            Self::Box { size } => solid::cuboid(size.0),
        }?;
        shape.mesh()
    }
}

/// Refuses a negative radius: it would turn a surface inside out.
fn check_radius(name: &str, value: f64) -> Result<(), String> {
    match value < 0.0 {
        false => Ok(()),
        true => Err(format!("{name} = {value} is negative; 0 or more is right")),
    }
}

fn numbers([a, b]: [Number; 2]) -> [f64; 2] {
    [a.0, b.0]
}

/// A mesh in the making, in `f64`.
#[derive(Default)]
struct Shape {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// Refuses what would exceed the limits of a mesh, before anything is made.
    fn with(vertices: u128, triangles: u128) -> Result<Self, String> {
        if vertices > VERTICES_MAX.into() || triangles > TRIANGLES_MAX.into() {
            return Err(format!(
                "{triangles} triangles and {vertices} vertices exceed the limits of {TRIANGLES_MAX} and {VERTICES_MAX}"
            ));
        }
        if triangles == 0 {
            return Err("no triangles".to_owned());
        }
        Ok(Self::default())
    }

    /// Adds a vertex and returns its number.
    fn vertex(&mut self, position: [f64; 3]) -> u32 {
        self.vertices.push(position);
        index(self.vertices.len() - 1)
    }

    /// Adds two triangles.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    fn mesh(self) -> Result<Mesh, String> {
        let positions: Vec<[f32; 3]> = self.vertices.iter().map(|v| v.map(single)).collect();
        if let Some(v) = positions
            .iter()
            .position(|p| p.iter().any(|x| !x.is_finite()))
        {
            let message = format!("vertex {v} at {:?} is beyond f32", self.vertices[v]);
            return Err(message);
        }
        Ok(Mesh::of_triangles(positions, self.triangles))
    }
}

/// A vertex number; [`Shape::with`] has bounded it.
fn index(n: usize) -> u32 {
    u32::try_from(n).expect("fewer vertices than VERTICES_MAX")
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the purpose; overflow is checked"
)]
fn single(v: f64) -> f32 {
    v as f32
}

/// Pseudo-random numbers: SplitMix64 (Steele, Lea and Flood 2014). A sequence is
/// part of a snapshot's meaning, so it must never change.
pub struct Random(u64);

impl Random {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), in steps of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Uniform in 0..n, but for a bias under n / 2^64.
    pub fn below(&mut self, n: usize) -> usize {
        let product = u128::from(self.bits()) * n as u128;
        usize::try_from(product >> 64).expect("less than n")
    }
}
