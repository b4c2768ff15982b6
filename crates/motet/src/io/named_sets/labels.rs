//! Decides which sets become labels; the others become arrays.

use std::collections::BTreeSet;

use super::{ELSET, Named, PATCH, REGION, Rank, SURFACE};
use crate::io::format::Notes;
use crate::io::label_numbers::{bare_number, numbers};
use crate::mesh::{Field, Labels, Mesh, Values};

/// Maximum number of arrays for sets that labels do not express; each takes a byte per cell.
const MAX_ARRAYS: usize = 1000;

/// Turns sets and surfaces into labels, and into arrays where labels do not express them. Cells from index
/// `n_own` on were added for surfaces.
pub(in crate::io) fn set_labels(mesh: &mut Mesh, n_own: usize, sets: &[Named], notes: &Notes) {
    let dims: Vec<usize> = mesh.cells.kinds().iter().map(|kind| kind.dim().unwrap_or(0)).collect();
    let regions = labelling_sets(sets, &dims[..n_own], 3);
    let mut patches = labelling_sets(sets, &dims[..n_own], 2);
    patches.resize(dims.len(), NONE);
    let surfaces: Vec<usize> = (0..sets.len()).filter(|&i| sets[i].rank == Rank::Surface).collect();
    label_greedily(&mut patches, &surfaces, sets, &dims, 2);
    let mut labels = regions;
    labels.resize(dims.len(), NONE);
    let in_surfaces = dims.iter().zip(&patches).enumerate().filter(|(_, (dim, _))| **dim == 2);
    in_surfaces.for_each(|(i, (_, &set))| labels[i] = set);
    let expressed: Vec<bool> = sets.iter().map(|set| is_expressed(set, sets, &labels, &dims)).collect();
    for which in [(3, REGION, "region"), (2, PATCH, "patch")] {
        let Some(labels) = numbered(sets, &labels, &dims, which) else { continue };
        let names = if which.0 == 3 { &mut mesh.label_names.regions } else { &mut mesh.label_names.patches };
        names.extend(labels.names);
        mesh.set_cell_field(Field::scalars(labels.array, labels.ids));
    }
    let n = mesh.cells.len();
    for (prefix, is_surface) in [(ELSET, false), (SURFACE, true)] {
        let unexpressed = sets
            .iter()
            .zip(&expressed)
            .filter(|(set, expressed)| !**expressed && (set.rank == Rank::Surface) == is_surface);
        set_arrays(&mut mesh.cell_data, prefix, unexpressed.map(|(set, _)| set), n, notes);
    }
}

/// Marks a cell without a set.
const NONE: u32 = u32::MAX;

/// The set that labels each cell of dimension `dim`, chosen from the rank that reaches most cells.
fn labelling_sets(sets: &[Named], dims: &[usize], dim: usize) -> Vec<u32> {
    let n_cells = dims.iter().filter(|&&d| d == dim).count();
    let n_of = |set: &Named| set.places().filter(|&place| dims.get(place) == Some(&dim)).count();
    // A set of all cells carries the least information, unless it has a section.
    let is_whole: Vec<bool> = sets.iter().map(|s| s.rank != Rank::Section && n_of(s) == n_cells).collect();
    let ranks = [Rank::Section, Rank::Declared, Rank::OfElements, Rank::Instance];
    let mut best = vec![NONE; dims.len()];
    let mut most = 0;
    for (whole, rank) in [false, true].into_iter().flat_map(|whole| ranks.map(|rank| (whole, rank))) {
        let of_rank: Vec<usize> =
            (0..sets.len()).filter(|&i| sets[i].rank == rank && is_whole[i] == whole).collect();
        let mut labels = vec![NONE; dims.len()];
        let n = label_greedily(&mut labels, &of_rank, sets, dims, dim);
        if n > most {
            (best, most) = (labels, n);
        }
        if most == n_cells {
            break;
        }
    }
    best
}

/// For each set in turn, labels its cells if none of them has a label yet; returns the number of labelled
/// cells.
fn label_greedily(labels: &mut [u32], order: &[usize], sets: &[Named], dims: &[usize], dim: usize) -> usize {
    let mut n = 0;
    for &i in order {
        let places = || sets[i].places().filter(|&place| dims[place] == dim);
        if places().all(|place| labels[place] == NONE) {
            places().for_each(|place| {
                labels[place] = i as u32;
                n += 1;
            });
        }
    }
    n
}

/// Whether the labels with the name of a set cover exactly the cells of the set.
fn is_expressed(set: &Named, sets: &[Named], labels: &[u32], dims: &[usize]) -> bool {
    let has_name = |place: usize| sets.get(labels[place] as usize).is_some_and(|s| s.name == set.name);
    let mut found = [0usize; 4];
    for place in set.places() {
        if !has_name(place) {
            return false;
        }
        found[dims[place]] += 1;
    }
    let Some(first) = set.places().next() else { return false };
    let by = &sets[labels[first] as usize];
    // A surface may share its name with a set that also holds solids.
    let same_size =
        |dim: usize| found[dim] == 0 || by.places().filter(|&place| dims[place] == dim).count() == found[dim];
    (0..4).all(same_size)
}

/// Labels of the cells of one dimension; `None` if no such cell is labelled.
fn numbered(
    sets: &[Named],
    labels: &[u32],
    dims: &[usize],
    (dim, prefix, array): (usize, &str, &str),
) -> Option<Labels> {
    let mut used: Vec<u32> =
        labels.iter().zip(dims).filter(|&(&set, &d)| d == dim && set != NONE).map(|(&set, _)| set).collect();
    used.sort_unstable();
    used.dedup();
    let names: Vec<&str> = used.iter().map(|&set| sets[set as usize].name.as_str()).collect();
    let numbers = own_numbers(&used, sets).unwrap_or_else(|| numbers(&names, prefix));
    let id = |(&set, &d): (&u32, &usize)| match used.binary_search(&set) {
        Ok(i) if d == dim => numbers[i],
        _ => 0,
    };
    let is_named = |(name, number): &(&&str, &i32)| bare_number(name, prefix) != Some(**number);
    let named = names.iter().zip(&numbers).filter(is_named);
    (!used.is_empty()).then(|| Labels {
        ids: labels.iter().zip(dims).map(id).collect(),
        names: named.map(|(name, &number)| (number, (*name).to_owned())).collect(),
        array: array.to_owned(),
    })
}

/// The numbers that the sets `used` have in the file, if they differ.
fn own_numbers(used: &[u32], sets: &[Named]) -> Option<Vec<i32>> {
    let numbers: Vec<i32> = used.iter().map(|&set| sets[set as usize].number).collect();
    let mut known = BTreeSet::from([0]);
    numbers.iter().all(|&number| known.insert(number)).then_some(numbers)
}

/// Adds an array of 0 and 1 for each set.
pub(in crate::io) fn set_arrays<'s>(
    fields: &mut Vec<Field>,
    prefix: &str,
    sets: impl Iterator<Item = &'s Named>,
    n: usize,
    notes: &Notes,
) {
    let mut n_skipped = 0;
    for set in sets {
        if fields.len() >= MAX_ARRAYS {
            n_skipped += 1;
            continue;
        }
        let mut values = vec![0u8; n];
        set.places().for_each(|place| values[place] = 1);
        fields.push(Field {
            name: format!("{prefix}{}", set.name),
            components: 1,
            values: Values::U8(values),
        });
    }
    if n_skipped > 0 {
        notes.add(format!("{n_skipped} sets beyond the first {MAX_ARRAYS} are skipped"));
    }
}
