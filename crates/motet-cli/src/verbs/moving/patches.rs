//! Parts of the boundary, by the names that the call uses for them.

use motet::mesh::Labels;
use motet::motion::{FacetSet, match_patch};
use motet::{Error, Mesh, io};

use super::parsers::PatchFile;

/// The patches of a mesh: those labelled in it, and those that surface files define.
pub(crate) struct Patches<'a> {
    mesh: &'a Mesh,
    labels: Option<Labels>,
    from_files: Vec<FacetSet>,
}

impl<'a> Patches<'a> {
    pub(crate) fn new(mesh: &'a Mesh, files: &[PatchFile]) -> motet::Result<Self> {
        let read = |patch: &PatchFile| {
            let surface = io::read(&patch.file)?;
            let vertices = match_patch(mesh, &surface).map_err(|e| e.in_file(&patch.file))?;
            let facets = FacetSet::of_surface(&surface, &patch.name, &vertices);
            if facets.is_empty() {
                return Err(Error::input("has no surface cells").in_file(&patch.file));
            }
            Ok(facets)
        };
        let from_files = files.iter().map(read).collect::<motet::Result<_>>()?;
        Ok(Self { mesh, labels: mesh.patches(), from_files })
    }

    /// The patch that `word` means: one named by the call, otherwise the mesh's own, by name or number.
    pub(crate) fn find(&self, word: &str) -> motet::Result<FacetSet> {
        if let Some(facets) = self.from_files.iter().find(|facets| facets.name == word) {
            return Ok(facets.clone());
        }
        match self.labels.as_ref().and_then(|labels| labels.find(word)) {
            Some(id) => Ok(FacetSet::of_patch(self.mesh, id)),
            None => Err(Error::options(format!("the mesh has no patch `{word}`")).remedy(self.known())),
        }
    }

    fn known(&self) -> String {
        let own = self.labels.iter().flat_map(|labels| labels.used().into_iter().map(|id| labels.name(id)));
        let names: Vec<String> =
            own.chain(self.from_files.iter().map(|facets| facets.name.clone())).collect();
        let give = "give one by --patch NAME=FILE, a surface cut out of the mesh";
        match names.as_slice() {
            [] => format!("it has no patches: {give}"),
            names => format!("it has {}; or {give}", names.join(", ")),
        }
    }
}
