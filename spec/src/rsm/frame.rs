//! All stages of a frame.

use super::{
    Blocked, Coarse, Colour, Direct, Gbuffer, Lamp, Model, Parameters, Place, Rsm, RsmError, View,
    block, blur, compose, direct, gather, gbuffer, place, rsm,
};
use crate::grid::{Blockers, Grid};

/// What a frame is made of.
#[derive(Clone, Copy, Debug)]
pub struct Setting<'a> {
    /// What eye and light see.
    pub model: &'a Model,
    /// From where.
    pub eye: &'a View,
    /// What lights it.
    pub lamp: &'a Lamp,
    /// What blocks indirect light, and only that.
    pub blockers: &'a Blockers,
    /// The blockers' cells.
    pub grid: &'a Grid,
    /// Of the scene.
    pub parameters: Parameters,
    /// Linear colour where nothing is seen.
    pub background: [f32; 3],
}

/// What every stage gave. Bounds run on from stage to stage, but for the map's intensities:
/// the texels of a map are lights, given as they are ([`Rsm::lights`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// What the eye sees.
    pub seen: Gbuffer,
    /// What the light sees.
    pub rsm: Rsm,
    /// The eye's points in the light's map.
    pub places: Vec<Option<Place>>,
    /// Light that comes straight.
    pub direct: Direct,
    /// Buffer A.
    pub all: Vec<Colour>,
    /// Buffer B.
    pub blocked: Blocked,
    /// What buffer B's pixels see.
    pub coarse: Coarse,
    /// Buffer B, averaged.
    pub blurred: Vec<Colour>,
    /// The picture.
    pub picture: Vec<Colour>,
}

impl Frame {
    /// Runs all stages.
    ///
    /// # Errors
    /// A parameter beyond its limits.
    pub fn render(setting: &Setting) -> Result<Self, RsmError> {
        let Setting {
            model,
            lamp,
            parameters,
            ..
        } = setting;
        parameters.check(setting.eye.size)?;
        let seen = gbuffer(model, setting.eye, parameters);
        let rsm = rsm(model, lamp, parameters);
        let places = place(&lamp.view, &seen);
        let (lights, size) = (rsm.lights(), rsm.seen.size);
        let direct = direct(model, &seen, &places, lamp, &rsm.seen.keys, parameters);
        let all = gather(model, &seen, &places, &lights, size, parameters);
        let cells = (setting.grid, setting.blockers);
        let blocked = block(model, &seen, &places, &lights, size, cells, parameters);
        let coarse = Coarse::new(&seen, parameters);
        let blurred = blur(model, &coarse, &blocked.light, parameters);
        let picture = compose(
            model,
            &seen,
            [&direct.light, &all],
            (&coarse, &blurred),
            parameters,
            setting.background,
        );
        Ok(Self {
            seen,
            rsm,
            places,
            direct,
            all,
            blocked,
            coarse,
            blurred,
            picture,
        })
    }
}
