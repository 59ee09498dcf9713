//! The layout of frames of indirect light.

use std::io;

use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::rsm::{Light, Model, Place, Surface};
use triptych_spec::scene::Size;

use super::LegDump;

/// What all frames of a scene share.
#[derive(Clone, Copy)]
pub struct FrameShape<'a> {
    /// World space and the lattice.
    pub lattice: &'a Lattice,
    /// Of the picture.
    pub eye: Size,
    /// Of the light's map.
    pub map: Size,
    /// Of buffer B.
    pub coarse: Size,
    /// Words of bits of each pixel of buffer B.
    pub words: usize,
}

/// What a leg made of one frame, stage by stage; colours are linear. A leg whose first results
/// are wrong comes no further: what it did not make is empty, and is not written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameArrays {
    /// What each pixel sees.
    pub seen: Vec<Option<Surface>>,
    /// What each texel of the light's map sees, and its intensity.
    pub lights: Vec<Option<Light>>,
    /// Where each pixel's point is in the light's map.
    pub places: Vec<Option<Place>>,
    /// Which pixels the light reaches.
    pub lit: Vec<bool>,
    /// Their direct light.
    pub direct: Vec<[f32; 3]>,
    /// Buffer A.
    pub all: Vec<[f32; 3]>,
    /// Which texels are blocked, of each pixel of buffer B.
    pub bits: Vec<u32>,
    /// Buffer B.
    pub blocked: Vec<[f32; 3]>,
    /// Buffer B, blurred.
    pub blurred: Vec<[f32; 3]>,
    /// The picture.
    pub picture: Vec<[f32; 3]>,
}

impl LegDump {
    /// Writes `rsm/lattice`, and of each frame, counted from 1, the triangles and all that the
    /// leg made.
    ///
    /// # Errors
    ///
    /// If a result has not the size of the frame, or a file cannot be written.
    pub fn frames<'a>(
        &self,
        shape: &FrameShape<'_>,
        frames: impl Iterator<Item = (&'a Model, &'a FrameArrays)>,
    ) -> io::Result<()> {
        self.lattice("rsm", shape.lattice)?;
        for (number, (model, arrays)) in (1..).zip(frames) {
            let frame = Frame {
                leg: self,
                folder: format!("rsm-{number}"),
            };
            frame.triangles(model)?;
            frame.integers(shape, arrays)?;
            frame.colours(shape, arrays)?;
            if !arrays.picture.is_empty() {
                self.image(&frame.folder, "image", shape.eye, &arrays.picture)?;
            }
        }
        Ok(())
    }
}

/// The folder of one frame.
struct Frame<'a> {
    leg: &'a LegDump,
    folder: String,
}

impl Frame<'_> {
    fn triangles(&self, model: &Model) -> io::Result<()> {
        let corner = |row: &u32| model.vertices[*row as usize];
        let corners: Vec<i32> = model
            .triangles
            .as_flattened()
            .iter()
            .flat_map(corner)
            .collect();
        let shape = [model.triangles.len(), 3, 3];
        self.leg.i32(&self.folder, "triangles", &shape, &corners)
    }

    fn integers(&self, shape: &FrameShape<'_>, arrays: &FrameArrays) -> io::Result<()> {
        let of_light = |light: &Option<Light>| light.as_ref().map(|light| light.surface);
        let texels: Vec<Option<Surface>> = arrays.lights.iter().map(of_light).collect();
        self.surfaces("seen", shape.eye, &arrays.seen)?;
        self.surfaces("map", shape.map, &texels)?;
        let texel = |place: &Option<Place>| place.as_ref().map_or([i32::MIN; 2], |p| p.texel);
        let texels: Vec<i32> = arrays.places.iter().flat_map(texel).collect();
        let key = |place: &Option<Place>| place.as_ref().map_or(NOTHING, |p| p.key);
        let keys: Vec<u32> = arrays.places.iter().map(key).collect();
        let lit: Vec<u32> = arrays.lit.iter().copied().map(u32::from).collect();
        let [eye, coarse] = [shape.eye, shape.coarse].map(rows);
        if !texels.is_empty() {
            let [h, w] = eye;
            self.leg.i32(&self.folder, "place", &[h, w, 2], &texels)?;
        }
        self.words("key", &eye, &keys)?;
        self.words("lit", &eye, &lit)?;
        let [h, w] = coarse;
        self.words("bits", &[h, w, shape.words], &arrays.bits)
    }

    fn words(&self, name: &str, shape: &[usize], data: &[u32]) -> io::Result<()> {
        match data.is_empty() {
            true => Ok(()),
            false => self.leg.u32(&self.folder, name, shape, data),
        }
    }

    /// Side and point of each; the triangle apart, since it may be no row of the model.
    fn surfaces(&self, name: &str, size: Size, seen: &[Option<Surface>]) -> io::Result<()> {
        if seen.is_empty() {
            return Ok(());
        }
        let [h, w] = rows(size);
        let prim = |s: &Option<Surface>| s.as_ref().map_or(NOTHING, |s| s.triangle);
        let prims: Vec<u32> = seen.iter().map(prim).collect();
        self.words(&format!("{name}_prim"), &[h, w], &prims)?;
        let point = |surface: &Option<Surface>| {
            surface.as_ref().map_or([0; 4], |surface| {
                let [x, y, z] = surface.point;
                [surface.side, x, y, z]
            })
        };
        let points: Vec<i32> = seen.iter().flat_map(point).collect();
        let name = format!("{name}_point");
        self.leg.i32(&self.folder, &name, &[h, w, 4], &points)
    }

    fn colours(&self, shape: &FrameShape<'_>, arrays: &FrameArrays) -> io::Result<()> {
        let intensity = |light: &Option<Light>| light.as_ref().map_or([0.0; 3], |l| l.intensity);
        let intensities: Vec<[f32; 3]> = arrays.lights.iter().map(intensity).collect();
        for (name, size, colours) in [
            ("intensity", shape.map, &intensities),
            ("direct", shape.eye, &arrays.direct),
            ("all", shape.eye, &arrays.all),
            ("blocked", shape.coarse, &arrays.blocked),
            ("blurred", shape.coarse, &arrays.blurred),
        ] {
            if colours.is_empty() {
                continue;
            }
            let [h, w] = rows(size);
            self.leg
                .f32(&self.folder, name, &[h, w, 3], colours.as_flattened())?;
        }
        Ok(())
    }
}

/// Rows, and pixels of each.
fn rows(size: Size) -> [usize; 2] {
    [size.height, size.width].map(|n| n as usize)
}
