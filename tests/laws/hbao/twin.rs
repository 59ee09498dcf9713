//! The same in `f64`, with angles: what a pixel finds, and how far an `f32` evaluation may be.

use triptych_gpu::hbao::{LEVELS, Screen, Settings, TURNED, turns};
use triptych_spec::ldm::Falloff;

use super::scenes::{V, dot, kept, plus, unit};

/// Half a unit in the last place of an `f32` 1.
const U: f64 = 1.0 / 16_777_216.0;

/// How far an arc may be off besides: the angle by 2^-20, the rest by 16 roundings of numbers of
/// at most 2, among them those of the normal's parts.
const ARC: f64 = 48.0 * U;

/// How near, in pixels, a sample may come to another pixel or level before it may be read from
/// that one: places are at most 100 pixels off, with fewer than 40 roundings.
const PLACE: f64 = 1.0 / 4096.0;

/// What a pixel's slices find.
pub struct Found {
    pub open: f64,
    pub bound: f64,
    /// Whether no decision may go the other way in `f32`.
    pub certain: bool,
}

struct Pixel<'s> {
    screen: &'s Screen,
    settings: Settings,
    at: [f64; 2],
    point: V,
    viewer: V,
    normal: V,
    found: Found,
    blocked: f64,
}

fn place(screen: &Screen, [x, y]: [f64; 2], depth: f64) -> V {
    let half = [screen.size.width, screen.size.height].map(|side| f64::from(side) / 2.0);
    let by = if screen.near { depth } else { 1.0 };
    let [sx, sy] = screen.scale.map(f64::from);
    [(x - half[0]) / sx * by, (y - half[1]) / sy * by, depth]
}

/// The directions `right` and `down` that slices count from: those of the picture, turned with the
/// view ray by the least turn.
fn frame(ahead: V) -> [V; 2] {
    let turned = |axis: V| {
        let half = plus(ahead, [0.0, 0.0, 1.0], 1.0);
        plus(axis, half, -dot(axis, ahead) / (1.0 + ahead[2]))
    };
    [turned([1.0, 0.0, 0.0]), turned([0.0, 1.0, 0.0])]
}

/// What `pixel` finds, without denoising.
pub fn twin(screen: &Screen, settings: Settings, pixel: u32) -> Found {
    let own = screen.pixels[pixel as usize];
    let [x, y] = [pixel % screen.size.width, pixel / screen.size.width];
    let at = [x, y].map(|c| f64::from(c) + 0.5);
    let point = place(screen, at, own.depth.into());
    let ahead = match screen.near {
        true => unit(point),
        false => [0.0, 0.0, 1.0],
    };
    let mut state = Pixel {
        screen,
        settings,
        at,
        point,
        viewer: ahead.map(|c| -c),
        normal: own.normal.map(f64::from),
        found: Found {
            open: 1.0,
            bound: 0.0,
            certain: true,
        },
        blocked: 0.0,
    };
    if own.normal == [0.0; 3] {
        return state.found;
    }
    let [right, down] = frame(ahead);
    let first = (y % TURNED * TURNED + x % TURNED) * settings.slices;
    let turns = turns(settings.slices);
    for slice in first..first + settings.slices {
        let [c, s, jitter, _] = turns[slice as usize].map(f64::from);
        let out = plus(right.map(|r| c * r), down, s);
        state.side(out, jitter);
        state.side(out.map(|c| -c), jitter);
    }
    let mut found = state.found;
    let slices = f64::from(settings.slices);
    found.open = (1.0 - state.blocked / slices).max(0.0);
    found.bound = found.bound / slices + 4.0 * U;
    found
}

/// From the viewer to an angle, as Jimenez et al. have it.
fn arc(length: f64, n: f64, h: f64) -> f64 {
    length * (n.cos() - (2.0 * h - n).cos() + 2.0 * h * n.sin()) / 4.0
}

impl Pixel<'_> {
    fn decide(&mut self, certain: bool) {
        self.found.certain &= certain;
    }

    fn side(&mut self, out: V, jitter: f64) {
        let (v, o) = (
            dot(self.normal, self.viewer).max(0.0),
            dot(self.normal, out),
        );
        let (n, length) = (o.atan2(v), v.hypot(o));
        let mut horizon = n + std::f64::consts::FRAC_PI_2;
        // The first arc, as those of samples.
        self.found.bound += ARC;
        // The line that the slice is in the picture, from two points of it.
        let along = match self.screen.near {
            true => {
                let small = 1e-6 * self.point[2];
                let [a, b] = [small, -small].map(|by| self.project(plus(self.point, out, by)));
                [0, 1].map(|i| (a[i] - b[i]) / (2.0 * small))
            }
            false => self.project(out),
        };
        let long = along[0].hypot(along[1]);
        let way = along.map(|c| c / long);
        let far = self.far(out, way, long);
        self.decide((far - 1.0).abs() > PLACE);
        if far < 1.0 {
            return;
        }
        for step in 0..self.settings.steps {
            let part = (f64::from(step) + jitter) / f64::from(self.settings.steps);
            let pixels = 1.0 + (far - 1.0) * part * part;
            let Some(off) = self.sample(way, pixels) else {
                continue;
            };
            self.raise(off, [n, length], &mut horizon);
        }
    }

    /// From the middle of the picture, in pixels.
    fn project(&self, p: V) -> [f64; 2] {
        let by = if self.screen.near { p[2] } else { 1.0 };
        [0, 1].map(|i| p[i] / by * f64::from(self.screen.scale[i]))
    }

    /// Pixels to go; `long` are those of a step along an orthographic slice.
    fn far(&self, out: V, way: [f64; 2], long: f64) -> f64 {
        let size = [self.screen.size.width, self.screen.size.height].map(f64::from);
        let room = |i: usize| match way[i] > 0.0 {
            true => (size[i] - 0.5 - self.at[i]) / way[i],
            false => (self.at[i] - 0.5) / way[i].abs().max(1e-9),
        };
        let border = room(0).min(room(1));
        let Falloff::Distance { most, .. } = self.settings.falloff else {
            return border;
        };
        let most = f64::from(most);
        if !self.screen.near {
            return border.min(most * long);
        }
        // The angle at the eye between the point and what may be near enough.
        let angle = most / dot(self.point, self.point).sqrt();
        if angle >= 1.0 {
            return border;
        }
        let angle = angle.asin();
        let ahead = self.viewer.map(|c| -c * angle.cos());
        let ray = plus(ahead, out, angle.sin());
        if ray[2] <= 0.0 {
            return border;
        }
        let (here, there) = (self.project(self.point), self.project(ray));
        border.min((there[0] - here[0]).hypot(there[1] - here[1]))
    }

    /// The way to what is seen so many pixels away.
    fn sample(&mut self, way: [f64; 2], pixels: f64) -> Option<V> {
        let sides = [self.screen.size.width, self.screen.size.height];
        let power = pixels.log2().floor();
        if self.settings.detail < 31 {
            let (below, above) = (power.exp2(), (power + 1.0).exp2());
            self.decide(pixels - below > PLACE || power == 0.0);
            self.decide(above - pixels > PLACE);
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a power of two below 2^13, and pixels of the picture"
        )]
        let chosen = {
            let level = (power as u32).saturating_sub(self.settings.detail);
            let level = level.min(LEVELS as u32 - 1);
            [0, 1].map(|i| {
                let place = self.at[i] + pixels * way[i];
                self.decide((place - place.round()).abs() > PLACE);
                let pixel = (place.floor().max(0.0) as u32).min(sides[i] - 1);
                ((pixel >> level << level) + ((1 << level) >> 1)).min(sides[i] - 1)
            })
        };
        let there = self.screen.pixels[(chosen[1] * sides[0] + chosen[0]) as usize];
        let middle = chosen.map(|c| f64::from(c) + 0.5);
        let point = place(self.screen, middle, there.depth.into());
        (there.normal != [0.0; 3]).then(|| plus(point, self.point, -1.0))
    }

    /// What a sample blocks.
    fn raise(&mut self, off: V, [n, length]: [f64; 2], horizon: &mut f64) {
        let distance = dot(off, off).sqrt();
        // Each coordinate of both points has fewer than 5 roundings, the products with a unit 4
        // more: of a distance, so far along any unit.
        let end = plus(self.point, off, 1.0);
        let size = dot(self.point, self.point).max(dot(end, end)).sqrt();
        let moved = 24.0 * U * (size / distance + 1.0);
        let keeps = kept(self.settings.falloff, distance);
        let slip = match self.settings.falloff {
            Falloff::None => 0.0,
            Falloff::Distance { most, power } => {
                let part = distance / f64::from(most);
                self.decide(power > 0 || (part - 1.0).abs() > moved);
                f64::from(power) * part * moved
            }
        };
        let height = dot(self.normal, off) / distance;
        if height <= -moved || keeps <= 0.0 {
            return;
        }
        let plain = dot(self.viewer, off) / distance;
        let beyond = n > 0.0 && plain > n.cos();
        self.decide(height <= moved || (plain - n.cos()).abs() > moved / length || n < -moved);
        let at = |by: f64| {
            let c = if beyond { plain } else { height / length };
            let lies = (c + by).clamp(if beyond { -1.0 } else { 0.0 }, 1.0).acos();
            let lies = if beyond { lies } else { n + lies };
            lies.max(0.0).min(n + std::f64::consts::FRAC_PI_2)
        };
        let (low, middle, high) = (at(moved / length), at(0.0), at(-moved / length));
        let spread = arc(length, n, high) - arc(length, n, low);
        let above = arc(length, n, *horizon);
        if low < *horizon {
            self.found.bound += spread + slip + ARC;
        }
        if middle < *horizon {
            self.blocked += keeps * (above - arc(length, n, middle));
            *horizon = middle;
        }
    }
}
