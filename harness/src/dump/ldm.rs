//! The layout of layered depth maps, and of what is seen through them.

use std::io;

use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::ldm::{Hits, Map, Maps, Receiver};
use triptych_spec::scene::Size;

use super::LegDump;

/// Most traces of a rotation that are written: 192 MiB.
const HITS_MAX: usize = 1 << 24;

/// What all rotations of a scene share, and what they add up to.
#[derive(Clone, Copy)]
pub struct MapArrays<'a> {
    /// World space and the lattice.
    pub lattice: &'a Lattice,
    /// Of the picture.
    pub size: Size,
    /// What is in the maps.
    pub blockers: &'a Blockers,
    /// Pixel of each receiver.
    pub pixels: &'a [u32],
    /// Who asks.
    pub receivers: &'a [Receiver],
    /// What is open over each of them.
    pub openness: &'a [f32],
    /// The picture by the light of the sky.
    pub picture: Option<&'a [[f32; 3]]>,
}

/// What a leg made of one rotation.
#[derive(Clone, Copy)]
pub struct TurnArrays<'a> {
    /// Where its maps lie.
    pub maps: &'a Maps,
    /// Where each list starts.
    pub offsets: &'a [u32],
    /// Keys.
    pub keys: &'a [u32],
    /// What is open as a whole, of each receiver: the sum of this rotation and all before it.
    pub whole: &'a [u32],
    /// What a receiver finds in each map, if that is written: too much to hold for all of them.
    pub hits: Option<&'a dyn Fn(usize) -> Vec<Hits>>,
}

impl LegDump {
    /// Writes the folder `ldm`.
    ///
    /// # Errors
    ///
    /// If results are not those of as many receivers, or a file cannot be written.
    pub fn maps(&self, arrays: &MapArrays<'_>) -> io::Result<()> {
        let MapArrays {
            lattice,
            size,
            blockers,
            pixels,
            receivers,
            openness,
            picture,
        } = arrays;
        self.lattice("ldm", lattice)?;
        let corner = |row: &u32| blockers.vertices[*row as usize];
        let corners: Vec<i32> = blockers
            .triangles
            .as_flattened()
            .iter()
            .flat_map(corner)
            .collect();
        let shape = [blockers.triangles.len(), 3, 3];
        self.i32("ldm", "triangles", &shape, &corners)?;
        self.u32("ldm", "pixel", &[receivers.len()], pixels)?;
        let points: Vec<i32> = receivers.iter().flat_map(|r| r.point).collect();
        self.i32("ldm", "point", &[receivers.len(), 3], &points)?;
        let normals: Vec<i32> = receivers.iter().flat_map(|r| r.normal).collect();
        self.i32("ldm", "normal", &[receivers.len(), 3], &normals)?;
        let mut grey = vec![[0.0; 3]; size.pixels()];
        for (pixel, open) in pixels.iter().zip(*openness) {
            grey[*pixel as usize] = [*open; 3];
        }
        self.image("ldm", "openness", *size, &grey)?;
        picture.map_or(Ok(()), |picture| self.image("ldm", "image", *size, picture))
    }

    /// Writes the folder of one rotation, counted from 1.
    ///
    /// # Errors
    ///
    /// As [`Self::maps`].
    pub fn turn(&self, number: u32, arrays: &TurnArrays<'_>) -> io::Result<()> {
        let folder = format!("ldm-{number}");
        let TurnArrays {
            maps,
            offsets,
            keys,
            whole,
            hits,
        } = arrays;
        let count = maps.maps.len();
        let of = |numbers: fn(&Map) -> Vec<i32>| maps.maps.iter().flat_map(numbers).collect();
        let directions: Vec<f64> = maps.maps.iter().flat_map(|map| map.direction).collect();
        self.f64(&folder, "directions", &[count, 3], &directions)?;
        let rows: Vec<i32> = of(|map| map.rows.as_flattened().to_vec());
        self.i32(&folder, "rows", &[count, 3, 3], &rows)?;
        let shifts = [maps.shifts[0], maps.shifts[1], maps.bits];
        self.u32(&folder, "shifts", &[3], &shifts)?;
        let places: Vec<i32> = of(|map| {
            let size = [map.size.width, map.size.height, map.first].map(u32::cast_signed);
            [map.origin, size].concat()
        });
        self.i32(&folder, "maps", &[count, 6], &places)?;
        let offsets: Vec<u64> = offsets.iter().copied().map(u64::from).collect();
        self.u64(&folder, "offsets", &[offsets.len()], &offsets)?;
        self.u32(&folder, "depth", &[keys.len()], keys)?;
        self.u32(&folder, "whole", &[whole.len()], whole)?;
        let fits = whole.len().saturating_mul(count) <= HITS_MAX;
        let Some(hits) = hits.filter(|_| fits) else {
            return Ok(());
        };
        let key = |key: Option<u32>| key.map_or(-1, u32::cast_signed);
        let hits: Vec<i32> = (0..whole.len())
            .flat_map(hits)
            .flat_map(|hits| [hits.key, key(hits.before), key(hits.behind)])
            .collect();
        self.i32(&folder, "hits", &[whole.len(), count, 3], &hits)
    }
}
