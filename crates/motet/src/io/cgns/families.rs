//! Families: names that zones, sections and boundary conditions share, and numbers for them.

use std::collections::BTreeMap;

use crate::base::Result;
use crate::io::cgns::node::Node;

/// The families of a base, by the names of their nodes.
#[derive(Default)]
pub(super) struct Families(BTreeMap<String, Family>);

/// A family.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Family {
    /// The name given by the user.
    pub(super) name: String,
    pub(super) number: Option<i32>,
}

impl Families {
    pub(super) fn of(base: &Node) -> Result<Self> {
        let nodes = base.children_of("Family_t")?;
        let names: Vec<&str> = nodes.iter().map(|node| node.name.as_str()).collect();
        let mut all = BTreeMap::new();
        for node in &nodes {
            // Gmsh names the family after its own entity, and stores the user's name inside it. If that name
            // is itself a family, this is a family of families and the name is not an alias.
            let within = node.text_of("FamilyName_t")?;
            let within = within.filter(|name| !name.is_empty() && !names.contains(&name.as_str()));
            let number = match node.child_of("Ordinal_t")? {
                Some(ordinal) => ordinal.ints()?.first().and_then(|&n| i32::try_from(n).ok()),
                None => None,
            };
            let name = within.unwrap_or_else(|| node.name.clone());
            all.insert(node.name.clone(), Family { name, number });
        }
        Ok(Self(all))
    }

    /// The family of this name, if there is one.
    pub(super) fn get(&self, name: &str) -> Option<&Family> {
        self.0.get(name)
    }

    /// The family with this name; if there is none, a family with just this name.
    pub(super) fn named(&self, name: &str) -> Family {
        // In nested families names are paths.
        let last = name.rsplit('/').next().unwrap_or(name);
        let found = self.get(name).or_else(|| self.get(last));
        found.cloned().unwrap_or_else(|| Family { name: last.to_owned(), number: None })
    }
}
