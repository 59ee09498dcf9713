//! A scene, its reference, and the settings that are held against it.

use triptych_spec::rsm::{
    Blocked, Coarse, DARK, Frame, Parameters, STRIDE_MAX, Setting, direct, gather, gbuffer, place,
    rsm,
};
use triptych_spec::vertex::{Primitives, SUBPIXEL_BITS, primitives};

use crate::replay::rsm::{Parts, Setup, reference};
use crate::scene::Loaded;

/// A scene's first frame.
pub(super) struct Case {
    pub(super) name: String,
    setup: Setup,
    pub(super) parts: Parts,
    background: [f32; 3],
    /// Snapped triangles of the eye's view, and of the lamp's.
    pub(super) drawn: [Primitives; 2],
    /// What does not depend on kernel, buffer B and blur; other buffers are dark.
    pub(super) base: Frame,
    /// The picture without noise.
    pub(super) reference: Vec<[f64; 3]>,
}

impl Case {
    /// Sets a scene up, and asks Embree for the reference.
    ///
    /// # Errors
    /// One line for a scene beyond the limits of the spec; what Embree reports.
    pub(super) fn new(loaded: &Loaded) -> Result<Self, String> {
        let setup = Setup::new(loaded)?;
        let parts = setup.parts(loaded, 0)?;
        let views = [&setup.eye, &setup.lamp.view];
        let drawn = views.map(|view| primitives(&view.scene(&parts.model), SUBPIXEL_BITS));
        let mut case = Self {
            name: loaded.name.clone(),
            base: base(&setup, &parts),
            background: loaded.scene.background,
            reference: Vec::new(),
            setup,
            parts,
            drawn,
        };
        let setting = case.setting(case.setup.parameters);
        case.reference = reference(&setting, &case.base).map_err(|e| e.to_string())?;
        Ok(case)
    }

    /// What stages are given.
    pub(super) fn setting(&self, parameters: Parameters) -> Setting<'_> {
        Setting {
            model: &self.parts.model,
            eye: &self.setup.eye,
            lamp: &self.setup.lamp,
            blockers: &self.parts.blockers,
            grid: &self.parts.grid,
            parameters,
            background: self.background,
        }
    }

    /// The scene's own parameters, then one of them changed: kernels of half and a quarter as
    /// many texels along a side, over the same part of the map; buffer B from every pixel to
    /// every eighth; up to two pixels of blur.
    pub(super) fn settings(&self) -> Vec<Parameters> {
        let own = self.setup.parameters;
        let kernels = [2, 4].map(|by| Parameters {
            radius: own.radius / by,
            stride: (own.stride * by).min(STRIDE_MAX),
            ..own
        });
        let divisors = [1, 2, 4, 8].map(|divisor| Parameters { divisor, ..own });
        let blurs = [0, 1, 2].map(|blur| Parameters { blur, ..own });
        let mut all = vec![own];
        for setting in kernels.into_iter().chain(divisors).chain(blurs) {
            if !all.contains(&setting) {
                all.push(setting);
            }
        }
        all
    }
}

/// What the eye and the lamp see, and the direct light.
fn base(setup: &Setup, parts: &Parts) -> Frame {
    let (model, lamp, parameters) = (&parts.model, &setup.lamp, &setup.parameters);
    let seen = gbuffer(model, &setup.eye, parameters);
    let rsm = rsm(model, lamp, parameters);
    let places = place(&lamp.view, &seen);
    let direct = direct(model, &seen, &places, lamp, &rsm.seen.keys, parameters);
    let coarse = Coarse::new(&seen, parameters);
    let dark = vec![DARK; coarse.size.pixels()];
    Frame {
        all: gather(
            model,
            &seen,
            &places,
            &rsm.lights(),
            rsm.seen.size,
            parameters,
        ),
        blocked: Blocked {
            size: coarse.size,
            bits: Vec::new(),
            rays: 0,
            light: dark.clone(),
        },
        blurred: dark,
        picture: Vec::new(),
        seen,
        rsm,
        places,
        direct,
        coarse,
    }
}

/// How far a picture is from the reference: root of the mean square, and the most.
pub(super) fn error(reference: &[[f64; 3]], picture: &[[f64; 3]]) -> [f64; 2] {
    let apart = reference.iter().flatten().zip(picture.iter().flatten());
    let (mut sum, mut most) = (0.0, 0.0_f64);
    for (a, b) in apart {
        sum += (a - b) * (a - b);
        most = most.max((a - b).abs());
    }
    [(sum / (3 * reference.len()).max(1) as f64).sqrt(), most]
}
