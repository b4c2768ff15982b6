//! A page whose mesh a program keeps up to date while a user moves it.
//!
//! The page is the one of [`write`](fn@crate::write), with a mesh in memory as its only input. A program
//! serves it, and answers the requests of `script/live.js`, relative to the address of the page:
//!
//! | request | answer |
//! |---|---|
//! | `GET facts` | JSON: the patches that can be moved, or why none can |
//! | `POST preview` | positions and values for a displacement, in the [`Order`] of the page, as binary numbers |
//! | `POST move`, `POST undo` | JSON: what became of the mesh |
//! | `GET update` | [`Live::update`] after either |
//! | `GET mesh.vtu`, `GET page.html` | the mesh, and a page that works without the program, to save |

use std::collections::BTreeSet;
use std::path::PathBuf;

use motet::base::{CellId, VertexId};
use motet::{Mesh, Result};

use crate::input::{Meshes, Source};
use crate::layout::Layout;
use crate::page::{Look, Page, Part};
use crate::plan;
use crate::skin::NONE;
use crate::store::Store;

/// A mesh as packed for a page that follows it.
pub struct Live {
    parts: [Part; 1],
    store: Store,
    used: BTreeSet<usize>,
    order: Order,
}

/// What replaces the data of a page that is already open, as JSON.
pub type Update = serde_json::Value;

/// The order in which a page has the vertices, triangles and volume cells of a mesh.
#[derive(Clone, Debug)]
pub struct Order {
    /// All vertices shown, those visible from outside first.
    pub vertices: Vec<VertexId>,
    /// How many vertices are visible from outside.
    pub n_skin: usize,
    /// The cell of each triangle of the skin: the volume cell behind it, or the surface cell if there is
    /// none.
    pub triangles: Vec<CellId>,
    /// The volume cells.
    pub solids: Vec<CellId>,
}

impl Live {
    /// Packs a mesh, whole, under a name.
    ///
    /// # Errors
    /// When its layout cannot be made.
    pub fn of(mesh: Mesh, name: &str) -> Result<Self> {
        let layout = Layout::of(&mesh);
        let cell = |&[volume, surface]: &[u32; 2]| CellId(if volume == NONE { surface } else { volume });
        let order = Order {
            triangles: layout.triangle_cells.iter().map(cell).collect(),
            n_skin: layout.n_skin,
            vertices: layout.vertices,
            solids: layout.solid_cells,
        };
        let frames = vec![(0.0, Source::Memory(Box::new(mesh)))];
        let input = Meshes { file: PathBuf::from(name), is_series: false, frames };
        let (mut store, mut used) = (Store::default(), BTreeSet::new());
        let shown = plan::shown(&input, usize::MAX, &mut store, &mut used)?;
        Ok(Self { parts: [Part::Meshes(Box::new(shown))], store, used, order })
    }

    /// The order of what is on the page.
    pub fn order(&self) -> &Order {
        &self.order
    }

    /// The page, in HTML.
    ///
    /// # Errors
    /// When it cannot be rendered.
    pub fn page(&self) -> Result<String> {
        self.shown().rendered(Look { is_live: true, ..Look::default() })
    }

    /// The data for a page that is open.
    pub fn update(&self) -> Update {
        self.shown().update()
    }

    /// A page that works without a program, in HTML.
    ///
    /// # Errors
    /// When it cannot be rendered.
    pub fn offline_page(&self) -> Result<String> {
        self.shown().rendered(Look::default())
    }

    fn shown(&self) -> Page<'_> {
        Page { parts: &self.parts, store: &self.store, used: &self.used }
    }
}
