//! Examples of crates that measure, and the figures that they tell.

use super::program::{built, unable};
use crate::command::Failure;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// An example program of a crate.
#[derive(Clone, Debug)]
pub(super) struct Example {
    path: PathBuf,
}

/// What an example told in lines such as `figure throughput 1.5e6`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Told(Vec<(String, Vec<f64>)>);

impl Example {
    /// Builds an example with Cargo.
    ///
    /// # Errors
    /// If it does not build.
    pub(super) fn build(root: &Path, package: &str, name: &str) -> Result<Example, Failure> {
        let words = format!("--package {package} --example {name}");
        Ok(Example { path: built(root, &words, name, "example")? })
    }

    /// Builds the program of a crate outside of the workspace, in this folder of it.
    ///
    /// # Errors
    /// If it does not build.
    pub(super) fn apart(root: &Path, folder: &str, name: &str) -> Result<Example, Failure> {
        let words = format!("--locked --manifest-path {folder}/Cargo.toml");
        Ok(Example { path: built(root, &words, name, "bin")? })
    }

    /// Runs it to its end.
    ///
    /// # Errors
    /// If the run fails, or tells something that is not understood.
    pub(super) fn run(&self, arguments: &[&str]) -> Result<Told, Failure> {
        let mut command = Command::new(&self.path);
        let output = command.args(arguments).stderr(Stdio::inherit()).output();
        let output = output.map_err(unable(format!("cannot start {}", self.path.display())))?;
        if !output.status.success() {
            return Err(Failure::Unable(format!("{command:?} failed ({})", output.status)));
        }
        Told::parse(&String::from_utf8_lossy(&output.stdout))
    }
}

impl Told {
    pub(super) fn parse(text: &str) -> Result<Told, Failure> {
        let figures = text.lines().filter_map(|line| line.strip_prefix("figure "));
        let read = figures.map(|line| {
            let mut words = line.split_whitespace();
            let name = words.next()?.to_owned();
            Some((name, words.map(|word| word.parse().ok()).collect::<Option<Vec<f64>>>()?))
        });
        let told = read.collect::<Option<Vec<_>>>();
        told.map(Told).ok_or_else(|| Failure::Unable(format!("cannot read figures from `{text}`")))
    }

    /// All figures of a name, each of `N` numbers.
    ///
    /// # Errors
    /// If one has another number of numbers.
    pub(super) fn arrays<const N: usize>(&self, name: &str) -> Result<Vec<[f64; N]>, Failure> {
        let named = self.0.iter().filter(|(other, _)| other == name);
        let arrays = named.map(|(_, numbers)| numbers.as_slice().try_into().ok());
        let wrong = || Failure::Unable(format!("the figure `{name}` has not {N} numbers"));
        arrays.collect::<Option<Vec<_>>>().ok_or_else(wrong)
    }

    /// The first figure of a name.
    ///
    /// # Errors
    /// If there is none of `N` numbers.
    pub(super) fn array<const N: usize>(&self, name: &str) -> Result<[f64; N], Failure> {
        let missing = || Failure::Unable(format!("there is no figure `{name}`"));
        self.arrays(name)?.first().copied().ok_or_else(missing)
    }

    /// The same of one number.
    ///
    /// # Errors
    /// If there is none.
    pub(super) fn number(&self, name: &str) -> Result<f64, Failure> {
        self.array::<1>(name).map(|[number]| number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_found_among_other_lines() {
        let text = "5 particles\nfigure a 1e3\nfigure b 1 2\nfigure b 3 4.5\n\nend\n";
        let told = Told::parse(text).unwrap();
        assert_eq!(told.number("a").unwrap(), 1000.0);
        assert_eq!(told.arrays("b").unwrap(), [[1.0, 2.0], [3.0, 4.5]]);
        assert!(told.number("b").is_err() && told.number("c").is_err());
        assert!(Told::parse("figure a x").is_err());
    }
}
