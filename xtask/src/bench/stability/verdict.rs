//! What a cell of the table comes to.

use super::super::program::Measured;
use super::super::table::Tone;
use super::stresses::Stress;
use std::fmt;

/// Share of the energies' range by which their sum may rise: what remeshing and contact add.
const RISE: f64 = 0.02;
/// By how much a stiffer cloth may stretch more than the plain one (1).
const MORE_STRETCH: f64 = 0.01;

/// What a run showed.
pub(super) struct Findings {
    is_stiffer: bool,
    is_finite: bool,
    /// By how much the energy rose above that of the start, as a share of the range of the energies; none
    /// if something else than gravity did work.
    rise: Option<f64>,
    /// Largest stretch at the end (1).
    stretch: f64,
    /// Crossings at the start and at the end.
    crossings: [f64; 2],
    iterations: f64,
    seconds: f64,
}

/// The outcome.
pub(super) enum Verdict {
    Stable(String),
    Refused(String),
    Unstable(String),
}

impl Findings {
    pub(super) fn of(measured: &Measured, stress: &Stress) -> Findings {
        let info = &measured.info;
        let kinetic = info.each("/kinetic_energy_j");
        let potential = info.each("/potential_energy_j");
        let all = info.n_frames();
        let is_finite = kinetic.len() == all
            && potential.len() == all
            && info.each("/stretch/max").len() == all;
        let last = |pointer| info.each(pointer).last().copied().unwrap_or(0.0);
        let start = info.initial("/kinetic_energy_j").unwrap_or(0.0)
            + info.initial("/potential_energy_j").unwrap_or(0.0);
        let most = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let total: Vec<f64> = kinetic.iter().zip(&potential).map(|(k, p)| k + p).collect();
        let lowest = potential.iter().copied().fold(f64::INFINITY, f64::min);
        let range = most(&kinetic).max(start - lowest);
        let is_windless = info.skipped().iter().any(|why| why.starts_with("wind: "));
        let rise = (most(&total) - start).max(0.0) / range.max(f64::MIN_POSITIVE);
        Findings {
            is_stiffer: stress.is_stiffer,
            is_finite,
            rise: (stress.is_closed && is_windless).then_some(rise),
            stretch: last("/stretch/max"),
            crossings: [info.initial("/crossings").unwrap_or(0.0), last("/crossings")],
            iterations: info.sum("/newton_iterations") / info.sum("/stages"),
            seconds: measured.cpu_s,
        }
    }

    /// The verdict, beside what the scene shows without stress.
    pub(super) fn verdict(&self, plain: Option<&Findings>) -> Verdict {
        let text = self.to_string();
        let complain = |what: &str| Verdict::Unstable(format!("{what}: {text}"));
        if !self.is_finite {
            return complain("not finite");
        }
        if self.rise.is_some_and(|rise| rise > RISE) {
            return complain("energy from nowhere");
        }
        if self.crossings[1] > self.crossings[0] {
            return complain("passes through");
        }
        let allowed = plain.map_or(f64::INFINITY, |plain| plain.stretch + MORE_STRETCH);
        if self.is_stiffer && self.stretch > allowed {
            return complain("stretches more");
        }
        Verdict::Stable(text)
    }
}

impl Verdict {
    /// How its cell is to be taken.
    pub(super) fn tone(&self) -> Tone {
        match self {
            Verdict::Stable(_) => Tone::Good,
            Verdict::Refused(_) => Tone::Plain,
            Verdict::Unstable(_) => Tone::Bad,
        }
    }
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Findings { rise, stretch, crossings: [_, crossings], iterations, seconds, .. } = self;
        if let Some(rise) = rise {
            write!(f, "energy rises by {rise:.1e}, ")?;
        }
        write!(
            f,
            "stretch {stretch:.3}, {crossings} crossings, {iterations:.1} iterations a stage, \
             {seconds:.1} CPU s"
        )
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Verdict::Stable(text) => write!(f, "stable ({text})"),
            Verdict::Refused(text) => write!(f, "refused: {text}"),
            Verdict::Unstable(text) => write!(f, "UNSTABLE, {text}"),
        }
    }
}
