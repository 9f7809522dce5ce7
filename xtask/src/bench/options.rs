//! The arguments of `cargo xtask bench`.

use super::BENCHMARKS;
use serde_json::{Value, json};
use std::path::PathBuf;

/// What help says of the options.
pub(super) const HELP: &str = "  \
  --quick       few frames, each run once: shows that it works, and roughly what it costs
  --frames N    frames of each run, where a suite has none of its own [default: 20; 6 with --quick]
  --runs N      how often each run is repeated [default: 3; 1 with --quick]
  --scene S     scene of the suite flag [default: scenes/flag.json5], and the only one of pareto, stability,
                peers and view
  --out DIR     folder of report.json, report.html and the recordings [default: target/bench]
  --baseline DIR  folder of an earlier report.json to compare with
  --plots DIR   folder for every plot as an SVG file too
  --fresh       forget what a stopped run has measured
";

/// What was asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Options {
    /// Benchmarks; empty for all.
    pub(super) names: Vec<String>,
    pub(super) quick: bool,
    frames: Option<usize>,
    runs: Option<usize>,
    pub(super) scene: Option<PathBuf>,
    pub(super) out: Option<PathBuf>,
    pub(super) baseline: Option<PathBuf>,
    pub(super) plots: Option<PathBuf>,
    pub(super) fresh: bool,
}

impl Options {
    /// Frames of each run.
    pub(super) fn frames(&self) -> usize {
        self.frames.unwrap_or(if self.quick { 6 } else { 20 })
    }

    /// Repetitions of each run.
    pub(super) fn runs(&self) -> usize {
        self.runs.unwrap_or(if self.quick { 1 } else { 3 })
    }

    /// What figures depend on: two runs that differ in it do not measure the same.
    pub(super) fn that_matter(&self) -> Value {
        let scene = self.scene.as_ref().map(|path| path.display().to_string());
        json!({
            "quick": self.quick, "frames": self.frames(), "runs": self.runs(), "scene": scene,
        })
    }

    /// Reads the arguments; the error says what is wrong with them.
    pub(super) fn parse(arguments: &[String]) -> Result<Options, String> {
        let mut options = Options::default();
        let mut arguments = arguments.iter();
        while let Some(argument) = arguments.next() {
            let mut value = || {
                let value = arguments.next().filter(|v| !v.starts_with("--"));
                value.cloned().ok_or(format!("`{argument}` needs a value; see --help"))
            };
            match argument.as_str() {
                "--quick" => options.quick = true,
                "--frames" => options.frames = Some(count(argument, &value()?)?),
                "--runs" => options.runs = Some(count(argument, &value()?)?),
                "--scene" => options.scene = Some(value()?.into()),
                "--baseline" => options.baseline = Some(value()?.into()),
                "--plots" => options.plots = Some(value()?.into()),
                "--fresh" => options.fresh = true,
                "--out" => options.out = Some(value()?.into()),
                name if BENCHMARKS.iter().any(|b| b.name == name) => {
                    options.names.push(name.to_owned());
                }
                other => return Err(format!("does not know the argument `{other}`; see --help")),
            }
        }
        Ok(options)
    }
}

fn count(option: &str, text: &str) -> Result<usize, String> {
    let wrong = || format!("`{option}` needs a whole number above zero, not `{text}`");
    text.parse().ok().filter(|&n| n > 0).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Options, String> {
        let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        Options::parse(&words)
    }

    #[test]
    fn defaults_depend_on_quick() {
        let (full, quick) = (parse("").unwrap(), parse("flag --quick").unwrap());
        assert_eq!((full.frames(), full.runs(), full.names.len()), (20, 3, 0));
        assert_eq!((quick.frames(), quick.runs()), (6, 1));
        assert_eq!(quick.names, ["flag"]);
    }

    #[test]
    fn options_are_taken_in_any_order() {
        let options = parse("--out a/b --frames 4 flag --runs 5 --scene s.json5").unwrap();
        assert_eq!((options.frames(), options.runs()), (4, 5));
        assert!(options.baseline.is_none() && !options.fresh);
        assert_eq!((options.out, options.scene), (Some("a/b".into()), Some("s.json5".into())));
    }

    #[test]
    fn only_what_figures_depend_on_matters() {
        let plain = parse("--runs 1").unwrap().that_matter();
        let same = parse("flag --runs 1 --out a --baseline b --plots c --fresh").unwrap();
        assert_eq!(same.that_matter(), plain);
        assert_eq!((same.baseline, same.fresh), (Some("b".into()), true));
        for other in ["--runs 2", "--runs 1 --quick", "--runs 1 --scene s"] {
            assert_ne!(parse(other).unwrap().that_matter(), plain, "{other}");
        }
    }

    #[test]
    fn wrong_arguments_are_named() {
        for (line, word) in [
            ("--frames", "--frames"),
            ("--frames 0", "`0`"),
            ("--runs -3", "`-3`"),
            ("--out --quick", "--out"),
            ("flags", "`flags`"),
            ("--fats", "`--fats`"),
        ] {
            let why = parse(line).unwrap_err();
            assert!(why.contains(word), "{line}: {why}");
        }
    }
}
