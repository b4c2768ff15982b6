//! The construction of a complex from plain arrays.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::base::{Error, Result, TetId, Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::quality::POSITIVE_EAS;
use crate::geometry::tet::FACETS;
use crate::kernel::complex::Complex;
use crate::kernel::hold::Hold;
use crate::kernel::journal::Journal;
use crate::kernel::lines::Lines;
use crate::kernel::link::{Behind, HalfFacet, Link, NO_TRIANGLE, Wall, WallId};
use crate::kernel::locks::Locks;
use crate::kernel::overlaps::Overlaps;
use crate::kernel::provenance::Provenance;
use crate::kernel::qualities::Qualities;
use crate::kernel::star::Star;
use crate::kernel::tets::{NO_TET, Tets};
use crate::kernel::vertices::Vertices;
use crate::kernel::walls::Walls;
use crate::mesh::orientation::{self, orient, see_from_opposite_sides};
use crate::mesh::tet_facets::{Sharing, tet_facets_in_parts};
use crate::mesh::{self, MAX_TETS, TetMesh};

impl Complex {
    /// The complex of a mesh. All tets are oriented as most are; see [`crate::mesh::OrientedTets`].
    ///
    /// # Errors
    /// If an array does not fit ([`TetMesh::validate`]), if there are too many tets, if more than two tets
    /// share a facet, and if the mesh is not orientable; the error names the first such tet.
    pub fn new(mesh: &TetMesh) -> Result<Self> {
        Self::new_on(mesh, &Threads::single())
    }

    /// The complex of a mesh, joined on several threads. All tets are oriented as most are; see
    /// [`crate::mesh::OrientedTets`].
    ///
    /// # Errors
    /// The errors of [`Self::new`].
    pub fn new_on(mesh: &TetMesh, threads: &Threads) -> Result<Self> {
        mesh.validate()?;
        if mesh.tets.len() >= MAX_TETS as usize {
            return Err(Error::input(format!("{} tets exceed the limit of {MAX_TETS}", mesh.tets.len()))
                .remedy("split the mesh"));
        }
        let TetMesh { points, regions, triangles, patches, .. } = mesh;
        let mut tets = mesh.tets.clone();
        let mut joined = Joined::of(&tets, regions, triangles, patches, threads)?;
        let mut qualities = mesh::Qualities::eas_of_each(points, &tets, threads);
        let (mut n_reversed, mut folded) = (0, Vec::new());
        if joined.has_same_side || qualities.iter().any(|&q| q <= 0.0) {
            let across = joined.across();
            let is_reversed =
                orient(&mut tets, behind(&across), points).map_err(|tet| not_orientable(tet.index()))?;
            n_reversed = is_reversed.iter().filter(|reversed| **reversed).count();
            if n_reversed > 0 {
                joined = Joined::of(&tets, regions, triangles, patches, threads)?;
                qualities = mesh::Qualities::eas_of_each(points, &tets, threads);
                let across = joined.across();
                folded = orientation::folded(&tets, points, &is_reversed, behind(&across));
            }
        }
        let n_tets = tets.len();
        let (lines, loose) = Lines::of(mesh);
        let mut complex = Self {
            overlaps: Overlaps::new(&tets, points.len(), folded),
            provenance: Provenance::new(n_tets, points.len(), 2 * n_reversed > n_tets),
            tets: Tets::new(tets, joined.links, points.len()),
            regions: regions.clone(),
            vertices: Vertices::new(points.clone()),
            walls: Walls::new(joined.walls),
            lines,
            locks: Locks::new(&mesh.fixed_edges),
            qualities: Qualities::new(qualities),
            journal: Journal::default(),
        };
        complex.constrain_walls(mesh);
        complex.constrain_lines(&loose);
        complex.overlaps.is_tangled =
            complex.has_flat_or_inverted() || complex.has_disconnected_star(&mesh.cut_vertices);
        Ok(complex)
    }

    /// Constrains vertices of walls to the surface, and fixes vertices that are marked as fixed, are on the
    /// cut or have no tet.
    fn constrain_walls(&mut self, mesh: &TetMesh) {
        for (_, wall) in self.walls.iter() {
            let facet = self.tets.outward(wall.sides[0]);
            facet.into_iter().for_each(|v| self.vertices.set_hold(v, Hold::Surface));
        }
        for v in self.vertices.slots().filter(|&v| self.tets.tet_of(v) == NO_TET) {
            self.vertices.set_hold(v, Hold::Fixed);
        }
        let fixed = mesh.fixed_vertices.iter().chain(&mesh.cut_vertices);
        for &v in fixed.chain(self.locks.edges().as_flattened()) {
            self.vertices.set_hold(v, Hold::Fixed);
        }
    }

    fn has_flat_or_inverted(&self) -> bool {
        let near_flat = self.tets().filter(|t| self.quality(*t) < POSITIVE_EAS);
        near_flat.map(|t| self.corners(t)).any(|[a, b, c, d]| orient3d(a, b, c, d) <= 0)
    }

    /// Whether the tets of a vertex at a wall are connected only by the vertex, or by an edge. This is so
    /// where parts of a mesh touch, and where a tet has a wrong vertex: it may then be positive and overlap
    /// others. Vertices of the cut are left out.
    fn has_disconnected_star(&self, cut: &[VertexId]) -> bool {
        let mut star = Star::default();
        let is_checked =
            |v: &VertexId| self.hold(*v) != Hold::Free && self.is_used(*v) && cut.binary_search(v).is_err();
        self.vertices.slots().filter(is_checked).any(|v| !self.is_one_star(v, &mut star))
    }
}

/// What lies behind every facet.
struct Joined {
    links: Vec<[Link; 4]>,
    walls: Vec<Wall>,
    /// Whether two tets see their common facet from the same side: one is numbered the other way round, or
    /// lies on the other.
    has_same_side: bool,
}

/// What the facets of a part of a mesh are, besides links between tets.
#[derive(Default)]
struct Joints {
    walls: Vec<Wall>,
    has_same_side: bool,
    /// The first facet that more than two tets share, by one of them, and how many there are.
    fault: Option<((TetId, usize), usize)>,
}

impl Joined {
    fn of(
        tets: &[[VertexId; 4]],
        regions: &[i32],
        triangles: &[[VertexId; 3]],
        patches: &[i32],
        threads: &Threads,
    ) -> Result<Self> {
        // Most meshes have only one, which saves two random memory reads per facet.
        let one_region = regions.windows(2).all(|pair| pair[0] == pair[1]);
        // Each facet has links of its own, so threads may set them in any order.
        let links = threads.map(tets.len(), |_| [const { AtomicU32::new(HalfFacet::NONE.0) }; 4]);
        let link = |from: HalfFacet, to: HalfFacet| {
            links[from.tet().index()][from.facet()].store(Link::tet(to).0, Ordering::Relaxed);
        };
        let join = |part: &mut Joints, Sharing { tets: uses, triangles }: Sharing| {
            if let [(t, i), (u, j)] = *uses {
                let [x, y] = [(t, i), (u, j)].map(|(t, i)| orientation::facet(&tets[t.index()], i));
                part.has_same_side |= !see_from_opposite_sides(x, y);
            }
            let half = |i: usize| HalfFacet::new(uses[i].0, uses[i].1);
            let same_region = |x: TetId, y: TetId| one_region || regions[x.index()] == regions[y.index()];
            match *uses {
                [(t, _), (u, _)] if triangles.is_empty() && same_region(t, u) => {
                    link(half(0), half(1));
                    link(half(1), half(0));
                }
                [_] | [_, _] => {
                    let triangle = triangles.first().copied().unwrap_or(NO_TRIANGLE);
                    let sides = [half(0), if uses.len() == 2 { half(1) } else { HalfFacet::NONE }];
                    let patch = patches.get(triangle as usize).copied().unwrap_or(0);
                    part.walls.push(Wall { sides, patch, triangle, is_new: false });
                }
                // A triangle that is not a facet, or not the first on its facet, is left as it is; the caller
                // has to fix its vertices and edges.
                [] => {}
                _ => {
                    part.fault.get_or_insert((uses[0], uses.len()));
                }
            }
        };
        let parts = tet_facets_in_parts(tets, triangles, threads, join);
        // A vector collected from its own elements keeps its memory.
        let links = links.into_iter().map(|links| links.map(|link| Link(link.into_inner()))).collect();
        let mut joined = Self { links, walls: Vec::new(), has_same_side: false };
        let mut fault = None;
        for part in parts {
            part.walls.into_iter().for_each(|wall| joined.add_wall(wall));
            joined.has_same_side |= part.has_same_side;
            fault = fault.or(part.fault);
        }
        match fault {
            None => Ok(joined),
            Some(((tet, i), n)) => Err(Error::input(format!(
                "{n} tets share the facet of the points {:?}; at most two can",
                FACETS[i].map(|place| tets[tet.index()][place].0)
            ))
            .at(format!("tet {tet}"))
            .remedy("`motet info` lists what is wrong with a mesh")),
        }
    }

    fn add_wall(&mut self, wall: Wall) {
        let id = WallId(self.walls.len() as u32);
        self.walls.push(wall);
        for side in wall.sides.into_iter().filter(|side| !side.is_none()) {
            self.links[side.tet().index()][side.facet()] = Link::wall(id);
        }
    }

    /// The facet behind each facet, through walls.
    fn across(&self) -> Vec<[HalfFacet; 4]> {
        let across = |t: usize, i: usize| match self.links[t][i].behind() {
            Behind::Tet(half) => half,
            Behind::Wall(wall) => self.walls[wall.index()].other(HalfFacet::new(TetId::new(t), i)),
        };
        (0..self.links.len()).map(|t| [0, 1, 2, 3].map(|i| across(t, i))).collect()
    }
}

/// What lies behind facets, as indices of tet and facet.
fn behind(across: &[[HalfFacet; 4]]) -> impl Fn(usize, usize) -> Option<(usize, usize)> {
    move |t, i| {
        Some(across[t][i]).filter(|half| !half.is_none()).map(|half| (half.tet().index(), half.facet()))
    }
}

fn not_orientable(tet: usize) -> Error {
    Error::input("the tets around it cannot all be oriented consistently")
        .at(format!("tet {tet}"))
        .remedy("the mesh is not orientable: mesh it again")
}
