//! Stage `mirror`: what is seen in the direction nearest to the mirror direction.

use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{self, Receiver, Sky};

use super::light::padded;
use super::stages::Stages;
use crate::error::GpuError;

/// What a receiver mirrors. Twin: `Mirrored` in `mirror.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Mirrored {
    light: [f32; 3],
    map: u32,
    side: u32,
    key: i32,
    hit: u32,
    unused: u32,
}

impl Mirrored {
    /// Before any map was looked through.
    const NONE: Self = Self {
        light: [0.0; 3],
        map: NOTHING,
        side: 0,
        key: 0,
        hit: NOTHING,
        unused: 0,
    };
}

impl From<Mirrored> for ldm::Mirrored {
    fn from(own: Mirrored) -> Self {
        let some = |number: u32| (number != NOTHING).then_some(number);
        Self {
            map: some(own.map),
            opposite: own.side != 0,
            key: own.key,
            hit: some(own.hit),
            light: own.light,
        }
    }
}

impl Stages<'_> {
    /// Stage `mirror`, of all maps; a sky for each. Of each receiver `views` has the vector to the
    /// eye, as [`ldm::view`] makes it.
    ///
    /// # Panics
    /// If there are more or fewer of one than of the other.
    pub fn mirror(
        &mut self,
        receivers: &[Receiver],
        views: &[Point],
        skies: &[Sky],
    ) -> Result<Vec<ldm::Mirrored>, GpuError> {
        assert_eq!(receivers.len(), views.len(), "a view of each receiver");
        let gpu = self.device.gpu;
        let own = self.upload(receivers)?;
        let views: Vec<[i32; 4]> = views.iter().map(|[x, y, z]| [*x, *y, *z, 0]).collect();
        let views = gpu.upload("views of receivers", &views)?;
        let skies: Vec<[[f32; 4]; 2]> = skies.iter().map(padded).collect();
        let skies = gpu.upload("skies of maps", &skies)?;
        let found = gpu.upload("what is mirrored", &vec![Mirrored::NONE; receivers.len()])?;
        self.time = Duration::ZERO;
        self.ask(
            ("mirror", |_| true),
            self.device.told,
            super::light::count(receivers),
            &[
                ("receivers", &own),
                ("views", &views),
                ("skies", &skies),
                ("mirrored", &found),
            ],
        )?;
        let found: Vec<Mirrored> = gpu.read(&found, receivers.len())?;
        Ok(found.into_iter().map(ldm::Mirrored::from).collect())
    }
}
