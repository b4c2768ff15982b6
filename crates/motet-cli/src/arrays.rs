//! Options for verbs that change a mesh: how arrays are carried, and the quality array and history written
//! with the result.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use motet::base::Threads;
use motet::geometry::quality::eas;
use motet::mesh::history::{Carry, History, Rules};
use motet::{Error, Mesh, Result, io};

use crate::writing::WritingArgs;

/// How arrays are carried, and what is written along with the mesh.
#[derive(Debug, Args)]
#[command(next_help_heading = "Arrays")]
pub(crate) struct ArrayArgs {
    /// How to carry an array where the mesh changes. Repeatable
    #[arg(long, value_name = "ARRAY=mean|linear|inherit|drop", value_parser = carry)]
    carry: Vec<(String, Carry)>,
    /// Add the cell array `eas`
    #[arg(long)]
    quality: bool,
    /// Write where each point and cell came from, with weights, as one JSON object
    #[arg(long, value_name = "FILE.json")]
    pub(crate) history: Option<PathBuf>,
}

/// The result of writing a mesh.
pub(crate) struct Written {
    /// What the format cannot hold, one sentence each.
    pub(crate) lost: Vec<String>,
    pub(crate) seconds: f64,
}

impl ArrayArgs {
    /// The rules that `--carry` gives for the arrays of `mesh`; a rule applies to the point array and to the
    /// cell array of its name.
    pub(crate) fn rules(&self, mesh: &Mesh) -> Result<Rules> {
        let mut rules = Rules::default();
        for (name, carry) in &self.carry {
            rules.carry(mesh, name, *carry)?;
        }
        Ok(rules)
    }

    /// Writes the mesh, with the quality of its tets and its history where requested.
    pub(crate) fn write(
        &self,
        mesh: &mut Mesh,
        history: Option<&History>,
        output: &Path,
        writing: &WritingArgs,
        threads: &Threads,
    ) -> Result<Written> {
        if self.quality {
            mesh.set_cell_field(mesh.tet_field("eas", eas));
        }
        let begin = Instant::now();
        let lost = io::write_on(output, mesh, &writing.options(), threads)?;
        if let (Some(file), Some(history)) = (&self.history, history) {
            write_history(file, history)?;
        }
        Ok(Written { lost, seconds: begin.elapsed().as_secs_f64() })
    }
}

/// Writes a history as one JSON object.
fn write_history(file: &Path, history: &History) -> Result<()> {
    let json = serde_json::to_vec(history).map_err(|e| Error::io(file, e.into()))?;
    io::replace(file, &json).map(drop)
}

/// Parses `ARRAY=mean|linear|inherit|drop`.
fn carry(text: &str) -> Result<(String, Carry), String> {
    let (name, rule) = text.rsplit_once('=').filter(|(name, _)| !name.is_empty()).unwrap_or_default();
    let carry = match rule {
        "mean" => Carry::Mean,
        "linear" => Carry::Linear,
        "inherit" => Carry::Inherit,
        "drop" => Carry::Drop,
        _ => return Err("ARRAY=mean, ARRAY=linear, ARRAY=inherit or ARRAY=drop is expected".into()),
    };
    Ok((name.to_owned(), carry))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_parted_from_rules_at_the_last_equals_sign() {
        assert_eq!(carry("a=b=drop"), Ok(("a=b".to_owned(), Carry::Drop)));
    }

    #[test]
    fn what_is_no_rule_is_reported() {
        assert!(carry("u").is_err() && carry("=drop").is_err() && carry("u=keep").is_err());
    }
}
