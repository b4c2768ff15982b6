//! The motion of the walls of a job over time.

use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::sub;
use motet::mesh::Surface;
use motet::motion::{FacetSet, Matching, Motion, Prescribed, SurfaceCarrier, SurfaceMotion};
use motet::moving::{InTime, Script, normals};
use motet::{Error, Mesh, Result, io};

use super::job::{Course, Job, Match, Move};
use crate::console::Console;

/// The script of a job.
///
/// # Errors
/// When the job names something that does not exist, surfaces do not fit, or a motion is not valid.
pub(super) fn script(
    job: &Job,
    mesh: &Mesh,
    motion: &Motion,
    threads: &Threads,
    console: &Console,
) -> Result<Script> {
    let mut script = Script::still(&motion.driven(mesh)?, &mesh.points);
    script.hold(&vertices(mesh, &job.motion.walls.fixed).map_err(|e| job.with_job_file(e))?);
    if let Some(series) = &job.motion.walls.surfaces {
        frames(job, &job.path(series), mesh, &mut script, threads)?;
    }
    for spec in &job.motion.walls.moves {
        add_move(spec, mesh, &mut script).map_err(|e| job.with_job_file(e))?;
        warn_of_contradiction(spec, mesh, &script, console);
    }
    if job.motion.walls.surfaces.is_none() && job.motion.walls.moves.is_empty() {
        return Err(job
            .with_job_file(Error::input("nothing moves").remedy("add [[motion.move]], or motion.surfaces")));
    }
    Ok(script)
}

/// Adds the motion of `surfaces`: each is a frame of a period, and the first follows the last.
fn frames(
    job: &Job,
    series: &std::path::Path,
    mesh: &Mesh,
    script: &mut Script,
    threads: &Threads,
) -> Result<()> {
    let files: Vec<_> = io::read_series(series)?.into_iter().map(|(_, file)| file).collect();
    if job.motion.walls.matching == Match::Nearest {
        return nearest(job, &files, mesh, script, threads);
    }
    let matching = match job.motion.walls.matching {
        Match::Position => Matching::Position,
        _ => Matching::Id,
    };
    let mut reader = SurfaceMotion::new(mesh, matching);
    let mut driven: Vec<VertexId> = Vec::new();
    let mut frames = Vec::new();
    for file in &files {
        let moved = reader.next(&io::read(file)?).map_err(|e| e.in_file(file))?;
        let (now, by): (Vec<_>, Vec<_>) = moved.into_iter().unzip();
        if frames.is_empty() {
            driven = now;
        } else if now != driven {
            return Err(
                Error::input("matches other vertices of the mesh than the first frame does").in_file(file)
            );
        }
        frames.push(by);
    }
    script.frames(&driven, frames, true).map(|_| ()).map_err(|e| e.in_file(series))
}

/// Adds the motion of surfaces with other triangles than the mesh: each vertex of the mesh moves with the
/// nearest place of the first surface.
fn nearest(
    job: &Job,
    files: &[std::path::PathBuf],
    mesh: &Mesh,
    script: &mut Script,
    threads: &Threads,
) -> Result<()> {
    let words: Vec<String> = job.motion.walls.patch.iter().cloned().collect();
    let followers = match words.is_empty() {
        true => motet::mesh::Boundary::of(&mesh.cells).vertices,
        false => vertices(mesh, &words).map_err(|e| job.with_job_file(e))?,
    };
    let places: Vec<Point> = followers.iter().map(|v| mesh.points[v.index()]).collect();
    let first = io::read(&files[0])?;
    let triangles = Surface::of(&first).triangles;
    let carrier =
        SurfaceCarrier::new(&first.points, &triangles, &places, threads).map_err(|e| e.in_file(&files[0]))?;
    let mut frames = Vec::new();
    for file in files {
        let surface = io::read(file)?;
        if surface.points.len() != first.points.len() {
            return Err(Error::input(format!(
                "has {} points, but the first frame has {}",
                surface.points.len(),
                first.points.len()
            ))
            .in_file(file)
            .remedy("frames of one surface have the same points in the same order"));
        }
        let moved: Vec<Point> = surface.points.iter().zip(&first.points).map(|(&p, &q)| sub(p, q)).collect();
        frames.push(carrier.carry(&moved));
    }
    script.frames(&followers, frames, true).map(|_| ())
}

/// Adds the motion of one `[[motion.move]]`.
fn add_move(spec: &Move, mesh: &Mesh, script: &mut Script) -> Result<()> {
    let facets = FacetSet::find(mesh, &spec.patch)?;
    let in_time = in_time(&spec.in_time)?;
    let motions = motions(spec, mesh, &facets);
    let n = match (spec.swell, motions.is_empty()) {
        (Some(by), true) => {
            let outward = outward(mesh, &facets);
            script.go(&facets.vertices, outward.iter().map(|n| n.map(|x| by * x)).collect(), in_time)?
        }
        (None, false) => script.follow(&facets.vertices, Prescribed::sequence(motions), in_time)?,
        (None, true) => {
            return Err(Error::input(format!("motion.move of patch {} specifies no motion", spec.patch))
                .remedy("add shift, turn, affine, bend or swell"));
        }
        (Some(_), false) => {
            return Err(Error::input(format!(
                "motion.move of patch {} has both swell and another motion",
                spec.patch
            ))
            .remedy("give two entries for two patches; a vertex follows the first entry that contains it"));
        }
    };
    match n {
        0 => Err(Error::input(format!("no vertex of patch {} is left to move by this entry", spec.patch))
            .remedy("earlier entries move all of them, or the patch is inside: name it in motion.inside")),
        _ => Ok(()),
    }
}

/// Warns of entries that share vertices and move them to different places: the earlier one is obeyed, and the
/// edge between them is bent.
fn warn_of_contradiction(spec: &Move, mesh: &Mesh, script: &Script, console: &Console) {
    let contradicted = script.contradicted();
    if let Some(&first) = contradicted.first() {
        let [x, y, z] = mesh.points[first.index()];
        console.warn(format_args!(
            "motion.move of patch {}: {} of its vertices follow an earlier entry that moves them elsewhere; \
             the first: {first} at ({x:.6}, {y:.6}, {z:.6})",
            spec.patch,
            contradicted.len()
        ));
    }
}

fn motions(spec: &Move, mesh: &Mesh, facets: &FacetSet) -> Vec<Prescribed> {
    let turn = spec.turn.as_ref().map(|turn| Prescribed::Turn {
        axis: turn.axis,
        angle: turn.degrees.to_radians(),
        centre: turn.centre.unwrap_or_else(|| Prescribed::middle(&mesh.points, &facets.vertices)),
    });
    let bend = spec.bend.as_ref().map(|bend| Prescribed::Bend {
        hinge: bend.hinge,
        along: bend.along,
        towards: bend.towards,
        length: bend.length,
        angle: bend.degrees.to_radians(),
    });
    let affine = spec.affine.map(Prescribed::Affine);
    [bend, turn, affine, spec.shift.map(Prescribed::Shift)].into_iter().flatten().collect()
}

fn in_time(course: &Course) -> Result<InTime> {
    Ok(match course {
        Course::Table(table) => InTime::Table(table.clone()),
        Course::Name(name) => match name.as_str() {
            "beat" => InTime::Beat,
            "swing" => InTime::Swing,
            "ramp" => InTime::Ramp,
            _ => {
                return Err(Error::input(format!("in_time = \"{name}\" is not a known course")).remedy(
                    "give \"beat\", \"swing\", \"ramp\", or a table such as [[0, 0], [0.3, 1], [1, 0]]",
                ));
            }
        },
    })
}

/// Unit normals of the vertices of a patch: pointing out of the volume on the boundary, however its facets
/// are oriented; inside, as the facets are oriented.
fn outward(mesh: &Mesh, facets: &FacetSet) -> Vec<Point> {
    let own: Vec<_> = facets.triangles().collect();
    let turned = Surface::boundary_of(mesh).turned(&own).unwrap_or(own);
    normals(&FacetSet::of_rings(facets.name.clone(), turned.iter().map(|t| t.as_slice())), &mesh.points)
}

/// The vertices of patches, ascending.
fn vertices(mesh: &Mesh, words: &[String]) -> Result<Vec<VertexId>> {
    let sets = words.iter().map(|word| FacetSet::find(mesh, word)).collect::<Result<Vec<_>>>()?;
    Ok(FacetSet::joined(sets).unwrap_or_default().vertices)
}
