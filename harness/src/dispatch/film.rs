//! Pictures that several threads add to.

use std::hint::spin_loop;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

use triptych_spec::dispatch::{Sums, units};
use triptych_spec::scene::Size;

/// A framebuffer.
pub trait Film: Sync {
    /// No light, of a size.
    fn new(size: Size) -> Self;
    /// Adds light to a pixel.
    fn add(&self, pixel: u32, light: [f32; 3]);
    /// Takes all light out, for another frame, while nobody adds any.
    fn clear(&self);
}

/// The spec's sums ([`triptych_spec::dispatch::deposit`]): integers, so that pictures do not
/// depend on who adds when. Nothing else is ordered by an addition, hence relaxed.
pub struct Units {
    size: Size,
    pixels: Vec<[AtomicU64; 3]>,
}

impl Units {
    /// The sums.
    pub fn sums(&mut self) -> Sums {
        let pixel = |p: &mut [AtomicU64; 3]| p.each_mut().map(|c| *c.get_mut());
        Sums {
            size: self.size,
            pixels: self.pixels.iter_mut().map(pixel).collect(),
        }
    }
}

impl Film for Units {
    fn new(size: Size) -> Self {
        let pixel = || [0; 3].map(AtomicU64::new);
        Self {
            size,
            pixels: (0..size.pixels()).map(|_| pixel()).collect(),
        }
    }

    fn add(&self, pixel: u32, light: [f32; 3]) {
        for (sum, light) in self.pixels[pixel as usize].iter().zip(light) {
            let units = units(light);
            if units > 0 {
                sum.fetch_add(units, Ordering::Relaxed);
            }
        }
    }

    fn clear(&self) {
        let all = self.pixels.iter().flatten();
        all.for_each(|sum| sum.store(0, Ordering::Relaxed));
    }
}

/// The paper's framebuffer (section 3): floats under one spin lock in user space. What a float
/// sum is depends on the order of its terms, so no two frames need be alike; for `bench dispatch`
/// alone.
pub struct Spinning {
    locked: AtomicBool,
    /// Bits of `f32`; read and written under the lock.
    pixels: Vec<[AtomicU32; 3]>,
}

impl Spinning {
    /// Linear light of the pixels.
    pub fn light(&mut self) -> Vec<[f32; 3]> {
        let pixel = |p: &mut [AtomicU32; 3]| p.each_mut().map(|c| f32::from_bits(*c.get_mut()));
        self.pixels.iter_mut().map(pixel).collect()
    }
}

impl Film for Spinning {
    fn new(size: Size) -> Self {
        let pixel = || [0; 3].map(AtomicU32::new);
        Self {
            locked: AtomicBool::new(false),
            pixels: (0..size.pixels()).map(|_| pixel()).collect(),
        }
    }

    fn add(&self, pixel: u32, light: [f32; 3]) {
        while self.locked.swap(true, Ordering::Acquire) {
            // Whoever has the lock may be waiting for this core.
            for _ in 0..64 {
                if !self.locked.load(Ordering::Relaxed) {
                    break;
                }
                spin_loop();
            }
            if self.locked.load(Ordering::Relaxed) {
                std::thread::yield_now();
            }
        }
        for (sum, light) in self.pixels[pixel as usize].iter().zip(light) {
            let before = f32::from_bits(sum.load(Ordering::Relaxed));
            sum.store((before + light).to_bits(), Ordering::Relaxed);
        }
        self.locked.store(false, Ordering::Release);
    }

    fn clear(&self) {
        let all = self.pixels.iter().flatten();
        all.for_each(|sum| sum.store(0, Ordering::Relaxed));
    }
}
