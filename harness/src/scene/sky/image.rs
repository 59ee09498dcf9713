//! Pictures of the sky: their texels, from files that are not trusted.

use std::io::Cursor;
use std::path::Path;

use exr::meta::{BlockDescription, MetaData};
use exr::prelude::{ReadChannels, ReadLayers, read};
use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;
use triptych_spec::scene::Size;

use super::{COLOUR_MAX, Filter};
use crate::error::InputError;

/// Largest file.
pub const SKY_BYTES_MAX: u64 = 1 << 27;

/// Most texels of a picture, and of a tile in its file: 8192 x 4096.
pub const SKY_PIXELS_MAX: u64 = 1 << 25;

/// Most layers and channels of a file.
const PARTS_MAX: usize = 64;

/// Most bytes of a block of an `.exr`, which is a tile or some lines in all channels: it is unpacked
/// as a whole, however few channels are needed, and a file that is a thousandth of it may say that it
/// has it.
const SKY_BLOCK_MAX: usize = 1 << 27;

/// A picture of everything: rows of radiance from the top, columns from the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    size: Size,
    texels: Vec<[f32; 3]>,
}

impl Panorama {
    /// Of texels row by row.
    ///
    /// # Errors
    /// No texel, not one for each pixel, radiance that is negative, not finite or beyond
    /// [`COLOUR_MAX`], in words.
    pub fn new(size: Size, texels: Vec<[f32; 3]>) -> Result<Self, String> {
        if texels.is_empty() || texels.len() != size.pixels() {
            return Err(format!("{} texels for {size:?}", texels.len()));
        }
        let wrong = |c: &f32| !(0.0..=COLOUR_MAX).contains(&f64::from(*c));
        if let Some(at) = texels.iter().position(|texel| texel.iter().any(wrong)) {
            let (x, y) = (at % size.width as usize, at / size.width as usize);
            return Err(format!(
                "texel ({x}, {y}) is {:?}; 0 to {COLOUR_MAX:e} is right",
                texels[at]
            ));
        }
        Ok(Self { size, texels })
    }

    /// Radiance at a place in parts of the picture's width and height.
    pub(super) fn at(&self, [u, v]: [f64; 2], filter: Filter) -> [f64; 3] {
        let Size { width, height } = self.size;
        let (x, y) = (u * f64::from(width), v * f64::from(height));
        match filter {
            Filter::Nearest => self.texel(libm::floor(x), libm::floor(y)),
            Filter::Bilinear => {
                let (left, top) = (libm::floor(x - 0.5), libm::floor(y - 0.5));
                let (right, down) = (x - 0.5 - left, y - 0.5 - top);
                let row = |y: f64| mix(self.texel(left, y), self.texel(left + 1.0, y), right);
                mix(row(top), row(top + 1.0), down)
            }
        }
    }

    /// Columns go around, rows end.
    fn texel(&self, x: f64, y: f64) -> [f64; 3] {
        let Size { width, height } = self.size;
        let around = x - libm::floor(x / f64::from(width)) * f64::from(width);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the picture"
        )]
        let within = |c: f64, end: u32| c.clamp(0.0, f64::from(end - 1)) as usize;
        let (column, row) = (within(around, width), within(y, height));
        self.texels[row * width as usize + column].map(f64::from)
    }
}

fn mix(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * part)
}

/// A picture's texels, by the ending of its file's name.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<Panorama, InputError> {
    let ending = path.extension().map(|e| e.to_ascii_lowercase());
    let decoded = match ending.as_ref().and_then(|e| e.to_str()) {
        Some("hdr") => hdr(bytes),
        Some("exr") => open_exr(bytes),
        _ => Err("a sky is an .exr or .hdr".to_owned()),
    };
    let panorama = decoded.and_then(|(size, texels)| Panorama::new(size, texels));
    // Words of a decoder may hold bytes of the file.
    let printable = |message: String| message.replace(char::is_control, " ");
    panorama.map_err(|message| InputError::new(path, printable(message)))
}

type Decoded = Result<(Size, Vec<[f32; 3]>), String>;

/// Refuses sides that are too long before anything is unpacked.
fn sized(width: u64, height: u64) -> Result<Size, String> {
    let texels = width.checked_mul(height);
    let fits = texels.filter(|n| (1..=SKY_PIXELS_MAX).contains(n));
    let sides = [width, height].map(|n| u32::try_from(n).ok());
    match (fits, sides) {
        (Some(_), [Some(width), Some(height)]) => Ok(Size { width, height }),
        _ => Err(format!(
            "has {width} x {height} texels; 1 to {SKY_PIXELS_MAX} are allowed"
        )),
    }
}

/// Radiance HDR: shared exponents.
fn hdr(bytes: &[u8]) -> Decoded {
    let words = |e: image::ImageError| e.to_string();
    let decoder = HdrDecoder::new(Cursor::new(bytes)).map_err(words)?;
    let (width, height) = decoder.dimensions();
    let size = sized(width.into(), height.into())?;
    let mut texels = vec![[0.0_f32; 3]; size.pixels()];
    let buffer = bytemuck::cast_slice_mut(&mut texels);
    decoder.read_image(buffer).map_err(words)?;
    Ok((size, texels))
}

/// OpenEXR: channels R, G and B of the first layer that has them, in its largest resolution; what
/// the file holds (its data window) is the picture.
fn open_exr(bytes: &[u8]) -> Decoded {
    let words = |e: exr::error::Error| e.to_string();
    let meta = MetaData::read_from_buffered(bytes, false).map_err(words)?;
    let channels = |h: &exr::meta::header::Header| h.channels.list.len();
    let parts = meta.headers.iter().map(channels).sum::<usize>() + meta.headers.len();
    if parts > PARTS_MAX {
        return Err(format!(
            "has {parts} layers and channels; {PARTS_MAX} are allowed"
        ));
    }
    for header in &meta.headers {
        let [width, height] = [header.layer_size.0, header.layer_size.1].map(|n| n as u64);
        sized(width, height)?;
        if let BlockDescription::Tiles(tiles) = header.blocks {
            let [width, height] = [tiles.tile_size.0, tiles.tile_size.1].map(|n| n as u64);
            sized(width, height)?;
        }
        // Of sides that are within limits, so the product is within 64 bits.
        let block = header.max_block_byte_size();
        if block > SKY_BLOCK_MAX {
            return Err(format!(
                "has blocks of {block} bytes in {} channels; {SKY_BLOCK_MAX} are allowed",
                channels(header)
            ));
        }
    }
    let create = |size: exr::math::Vec2<usize>, _: &_| {
        let texels = vec![[0.0_f32; 3]; size.area()];
        (size.width(), texels)
    };
    let set = |image: &mut (usize, Vec<[f32; 3]>), at: exr::math::Vec2<usize>, (r, g, b)| {
        image.1[at.y() * image.0 + at.x()] = [r, g, b];
    };
    let layer = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(create, set)
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(words)?;
    let size = layer.layer_data.size;
    let size = sized(size.width() as u64, size.height() as u64)?;
    Ok((size, layer.layer_data.channel_data.pixels.1))
}
