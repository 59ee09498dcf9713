//! The format of a sheet's bytes. Its other end is `report/sheet.js`.
//!
//! A zlib stream of unsigned numbers in LEB128 (seven bits a byte, the lowest first, the
//! top bit set if more follow). Signed ones are folded: 0, -1, 1, -2, … are 0, 1, 2, 3.
//! Numbers of one kind stand together, which deflates to half of what entries one by one
//! would:
//!
//! 1. how many triangles, how many pixels, how many lists a pixel has;
//! 2. triangles, each a row of `prims` with a colour, in order: row less the one before;
//!    instance; triangle of the mesh, folded, less the one before; then the bits of the
//!    four components of colour, least significant bytes of all first, byte by byte;
//! 3. pixels in order: number less the one before;
//! 4. length of every list, pixel by pixel;
//! 5. of every entry the triangle's number in 2;
//! 6. of every entry the key, folded, less that of the one before in its list, or 0;
//! 7. of every entry the mask times 16, plus [`super::Kind`].

use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};

use super::{Entry, Pixel};

/// Packs lists; `pixels` are in order, and each has `lists` of them.
pub fn pack(pixels: &[Pixel], lists: usize) -> Vec<u8> {
    let all = || pixels.iter().flat_map(|(_, lists)| lists);
    let entries = || all().flatten();
    let mut triangles: Vec<Triangle> = entries().map(Triangle::of).collect();
    triangles.sort_unstable();
    triangles.dedup();
    let mut out = Numbers::default();
    for n in [triangles.len(), pixels.len(), lists] {
        out.number(n as u64);
    }
    out.triangles(&triangles);
    out.rising(pixels.iter().map(|(pixel, _)| *pixel));
    all().for_each(|list| out.number(list.len() as u64));
    for entry in entries() {
        let at = triangles.binary_search(&Triangle::of(entry));
        out.number(at.expect("every entry's triangle is in the table") as u64);
    }
    for list in all() {
        out.steps(list.iter().map(|entry| entry.key));
    }
    for entry in entries() {
        out.number(u64::from(entry.mask) << 4 | u64::from(entry.kind as u8));
    }
    out.deflated()
}

/// A row of `prims` as an entry shows it.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Triangle {
    prim: u32,
    source: [u32; 2],
    colour: [u32; 4],
}

impl Triangle {
    fn of(entry: &Entry) -> Self {
        Self {
            prim: entry.prim,
            source: entry.source,
            colour: entry.colour.map(f32::to_bits),
        }
    }
}

/// Numbers as bytes.
#[derive(Default)]
struct Numbers(Vec<u8>);

impl Numbers {
    fn number(&mut self, mut n: u64) {
        while n >= 0x80 {
            self.0.push(n.to_le_bytes()[0] | 0x80);
            n >>= 7;
        }
        self.0.push(n.to_le_bytes()[0]);
    }

    fn folded(&mut self, n: i64) {
        self.number((n << 1 ^ n >> 63).cast_unsigned());
    }

    fn rising(&mut self, numbers: impl Iterator<Item = u32>) {
        let mut last = 0;
        for n in numbers {
            self.number(u64::from(n - last));
            last = n;
        }
    }

    fn steps(&mut self, numbers: impl Iterator<Item = u32>) {
        let mut last = 0;
        for n in numbers.map(i64::from) {
            self.folded(n - last);
            last = n;
        }
    }

    fn triangles(&mut self, triangles: &[Triangle]) {
        self.rising(triangles.iter().map(|t| t.prim));
        for triangle in triangles {
            self.number(u64::from(triangle.source[0]));
        }
        self.steps(triangles.iter().map(|t| t.source[1]));
        for byte in 0..4 {
            for component in 0..4 {
                let bytes = triangles
                    .iter()
                    .map(|t| t.colour[component].to_le_bytes()[byte]);
                self.0.extend(bytes);
            }
        }
    }

    fn deflated(self) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(7));
        let done = encoder.write_all(&self.0).and_then(|()| encoder.finish());
        done.expect("writing to memory cannot fail")
    }
}
