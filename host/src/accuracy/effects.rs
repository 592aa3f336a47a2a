//! The cost of each effect of a scene, the loss without it, and the order in which to leave effects out.

use super::ratio::Ratio;
use super::{Bench, MeasureError, Parameter, Point, Results, Setting};
use crate::measure::Errors;
use crate::measure::board::{Board, MemoryReport, Rendering, Target, instructions};
use crate::scene::shown_without;
use gridel_core::Effects;
use serde::{Deserialize, Serialize};

/// An effect, the loss without it, and its cost in the picture that the scene file states.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectCost {
    pub effect: String,
    /// The name of the setting without it.
    pub without: String,
    /// The part of a sentence about the picture without it.
    pub shown_without: String,
    /// The picture without it against the same picture with it.
    pub lost: Errors,
    /// Rays per pixel.
    pub rays: f64,
    /// Boxes and primitives tested per pixel.
    pub tests: f64,
    /// Part of the time that is saved without it, by the medians; negative where it takes longer.
    pub time: f64,
    /// The range of this part over the repeats; `None` if they were timed once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_range: Option<[f64; 2]>,
    /// Bytes of the blob.
    pub blob_bytes: i64,
    /// The least and the most instructions per pixel on [`BOARD`] in its best number format, of the rays that it sends;
    /// `None` where it sends none, or the format was not measured there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instructions: Option<[f64; 2]>,
    /// Bytes of flash on that board, of code and blob; `None` where no programs were built with the effect and
    /// without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flash: Option<i64>,
    /// Bytes of the workspace on a 32-bit board.
    pub ram: i64,
}

/// The board for figures when no board is given.
pub const BOARD: &str = "mps2-an386";

impl EffectCost {
    /// The error that leaving the effect out adds, per ray and test that it saves. The effect with the smallest price is
    /// left out first. What saves none of them follows, that with the smallest error first.
    fn price(&self) -> (bool, f64) {
        let saved = self.rays + self.tests;
        match saved > 0.0 {
            true => (false, self.lost.rmse / saved),
            false => (true, self.lost.rmse),
        }
    }
}

/// Returns the cost of every effect of a scene, in the order in which to leave them out. First are those that change
/// the picture least for the rays and tests that they save.
///
/// # Errors
/// If a setting cannot be built.
pub fn effect_costs(
    bench: &mut Bench<'_>,
    results: &Results,
) -> Result<Vec<EffectCost>, MeasureError> {
    let Some(all) = results.start() else {
        return Ok(Vec::new());
    };
    let mut effect_costs = Vec::new();
    for (effect, name) in Effects::NAMED {
        let found = results.points.iter().find(|it| {
            it.setting.differs(&results.base) == [Parameter::Effects]
                && it.setting.without == effect
        });
        let Some((point, lost)) = found.and_then(|it| Some((it, it.lost?))) else {
            continue;
        };
        let pixels = all.cost.pixels.max(1) as f64;
        let saved = |count: fn(&Point) -> u64| (count(all) as f64 - count(point) as f64) / pixels;
        let rays = saved(|it| it.cost.rays);
        let ratio = Ratio::of(&point.cost, &all.cost);
        let blob_bytes = all.cost.blob_bytes as i64 - point.cost.blob_bytes as i64;
        let code = code(bench, &results.base, name)?;
        let format = Board::named(BOARD).map(Board::format);
        effect_costs.push(EffectCost {
            effect: name.to_owned(),
            without: point.name.clone(),
            shown_without: shown_without(effect).to_owned(),
            lost,
            rays,
            tests: saved(|it| it.cost.tests),
            time: 1.0 - ratio.median,
            time_range: ratio.ends.map(|[low, high]| [1.0 - high, 1.0 - low]),
            blob_bytes,
            instructions: format
                .filter(|_| rays > 0.0)
                .and_then(|format| instructions(BOARD, format, rays)),
            flash: code.map(|code| code + blob_bytes),
            ram: all.cost.working_bytes as i64 - point.cost.working_bytes as i64,
        });
    }
    effect_costs.sort_by(|a, b| {
        let ((idle, price), (other_idle, other)) = (a.price(), b.price());
        idle.cmp(&other_idle).then(price.total_cmp(&other))
    });
    Ok(effect_costs)
}

/// Settings that give effects up one after the other, from the second on.
pub fn given_up(base: &Setting, effect_costs: &[EffectCost]) -> Vec<Setting> {
    let named = |cost: &EffectCost| crate::scene::effect_named(&cost.effect);
    let mut without = base.without;
    let settings = effect_costs.iter().filter_map(named).map(|effect| {
        without = without.with(effect);
        Setting { without, ..*base }
    });
    settings.skip(1).collect()
}

/// Bytes of an effect's own code on the board, where programs with and without it were built: see
/// [`MemoryReport`].
fn code(bench: &mut Bench<'_>, base: &Setting, effect: &str) -> Result<Option<i64>, MeasureError> {
    let Some(board) = Board::named(BOARD) else {
        return Ok(None);
    };
    let target = Target {
        board,
        flash: board.flash,
        ram: board.ram,
    };
    let blob = bench.blob(base)?;
    let report = {
        let scene = blob.scene()?;
        let rendering = Rendering::of(&scene, board.format());
        MemoryReport::of(&scene, blob.bytes(), &target, &rendering)
    };
    let report = report.ok();
    Ok(report
        .and_then(|it| it.code_of(effect))
        .map(|bytes| bytes as i64))
}
