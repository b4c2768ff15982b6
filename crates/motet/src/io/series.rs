//! Time series of meshes: a PVD file that lists a file for each time, as read by ParaView, or a VTKHDF file
//! with steps.

use std::path::{Path, PathBuf};

use quick_xml::Reader;
use quick_xml::escape::{escape, unescape};
use quick_xml::events::{BytesStart, Event};

use crate::base::{Error, Result, Threads};
use crate::io::format::WriteOptions;
use crate::io::lock::OutputLock;
use crate::io::replace::replace_with;
use crate::io::{replace, vtkhdf, write_on};
use crate::mesh::Mesh;

/// Whether a path is that of a series: a `.pvd` file by its extension, or an existing VTKHDF file with
/// several steps.
pub fn is_series(path: impl AsRef<Path>) -> bool {
    can_write_series(&path) || vtkhdf::is_transient(path.as_ref())
}

/// Whether a path has the extension of series that [`SeriesWriter`] writes.
pub fn can_write_series(path: impl AsRef<Path>) -> bool {
    path.as_ref().extension().is_some_and(|extension| extension.eq_ignore_ascii_case("pvd"))
}

/// Whether [`write_series`] supports this extension.
pub fn can_be_series(path: impl AsRef<Path>) -> bool {
    can_write_series(&path) || vtkhdf::is_vtkhdf_name(path.as_ref())
}

/// The file that holds a path of [`read_series`]: the path itself, or the file whose step it refers to.
pub fn file_of(path: impl AsRef<Path>) -> PathBuf {
    vtkhdf::StepPath::of(path.as_ref()).map_or_else(|| path.as_ref().to_owned(), |step| step.file)
}

/// The times of a series and the file of each, in the order of the series.
///
/// A file without a time gets its index in the series. Names are relative to the folder of the series. The
/// steps of a VTKHDF file have paths such as `flow.vtkhdf#3`, which [`read`](super::read) accepts.
///
/// # Errors
/// If the file cannot be read or is not a series, a time is not finite, or several files share a time.
/// Reports the place.
pub fn read_series(path: impl AsRef<Path>) -> Result<Vec<(f64, PathBuf)>> {
    let path = path.as_ref();
    if !can_write_series(path) && vtkhdf::is_transient(path) {
        return vtkhdf::times(path).map_err(|e| e.in_file(path));
    }
    let bytes = std::fs::read(path).map_err(|e| Error::io(path, e))?;
    let damaged = |e: Error| e.in_file(path).remedy("the file is damaged or not a PVD file: write it again");
    let frames = parse_series(&bytes).map_err(damaged)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    Ok(frames.into_iter().map(|(time, file)| (time, folder.join(file))).collect())
}

/// Parses the content of a series file like [`read_series`]; names are returned as stored.
///
/// # Errors
/// The errors of [`read_series`], but for those of reading the file.
pub fn parse_series(bytes: &[u8]) -> Result<Vec<(f64, String)>> {
    let mut reader = Reader::from_reader(bytes);
    let mut is_series = false;
    let mut frames: Vec<(f64, String)> = Vec::new();
    loop {
        let at = reader.buffer_position();
        let event = reader
            .read_event()
            .map_err(|e| Error::input(format!("not well-formed XML: {e}")).at(format!("byte {at}")))?;
        match event {
            Event::Start(e) | Event::Empty(e) if e.name().as_ref() == "VTKFile" => {
                is_series = attribute(&e, "type")?.is_some_and(|t| t == "Collection");
            }
            Event::Start(e) | Event::Empty(e) if e.name().as_ref() == "DataSet" && is_series => {
                let place = format!("entry {}", frames.len());
                frames.push(frame(&e, frames.len()).map_err(|e| e.at(place))?);
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if !is_series {
        return Err(Error::input("is not a series: expected a VTKFile of type Collection"));
    }
    match frames.windows(2).position(|f| f[0].0 == f[1].0) {
        Some(i) => Err(Error::input(format!(
            "has time {} more than once, but expected one file per time",
            frames[i].0
        ))
        .at(format!("entry {}", i + 1))
        .remedy("join the parts of each time into one file")),
        None if frames.is_empty() => Err(Error::input("the series lists no files")),
        None => Ok(frames),
    }
}

fn frame(element: &BytesStart<'_>, place: usize) -> Result<(f64, String)> {
    let file = attribute(element, "file")?.ok_or_else(|| Error::input("has no attribute `file`"))?;
    let time = match attribute(element, "timestep")? {
        None => place as f64,
        Some(text) => text
            .trim()
            .parse()
            .ok()
            .filter(|t: &f64| t.is_finite())
            .ok_or_else(|| Error::input(format!("expected a finite number as time, found `{text}`")))?,
    };
    Ok((time, file))
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>> {
    let bad = |e: &dyn std::fmt::Display| Error::input(format!("not well-formed XML: {e}"));
    let Some(attribute) = element.try_get_attribute(name).map_err(|e| bad(&e))? else { return Ok(None) };
    Ok(Some(unescape(&attribute.value).map_err(|e| bad(&e))?.into_owned()))
}

/// Writes a complete series: a `.pvd` with its frames beside it, or the steps of a `.vtkhdf`, which are held
/// in memory until the last frame.
///
/// Returns what the format could not hold.
///
/// # Errors
/// The errors of reading the frames and of [`write_on`](super::write_on); if the extension is not that of a
/// series.
pub fn write_series(
    path: impl AsRef<Path>,
    frames: impl IntoIterator<Item = Result<(f64, Mesh)>>,
    options: &WriteOptions,
    threads: &Threads,
) -> Result<Vec<String>> {
    let path = path.as_ref();
    let mut lost = Vec::new();
    if can_write_series(path) {
        let mut series = SeriesWriter::new(path, options.clone());
        for frame in frames {
            let (time, mesh) = frame?;
            lost = series.add_on(time, &mesh, threads)?.1;
        }
        return Ok(lost);
    }
    if !vtkhdf::is_vtkhdf_name(path) {
        return Err(Error::options("series are written as .pvd or .vtkhdf").in_file(path));
    }
    let mut steps = vtkhdf::Steps::default();
    for frame in frames {
        let (time, mesh) = frame?;
        steps.add(time, &mesh).map_err(|e| e.in_file(path))?;
    }
    let (mut lost, note) = replace_with(path, threads, |output| steps.write_to(options, output))?;
    lost.extend(note);
    Ok(lost)
}

/// Writer of a series that grows frame by frame. The PVD file is replaced after each frame, so that an
/// interrupted run leaves a complete, shorter series. A series has one writer at a time: the first frame
/// takes its [`OutputLock`], which is released when the writer is dropped.
#[derive(Debug)]
pub struct SeriesWriter {
    path: PathBuf,
    frames: Vec<(f64, String)>,
    options: WriteOptions,
    lock: Option<OutputLock>,
}

impl SeriesWriter {
    /// A series at `path`, with its frames beside it. Nothing is written yet.
    pub fn new(path: impl Into<PathBuf>, options: WriteOptions) -> Self {
        Self { path: path.into(), frames: Vec::new(), options, lock: None }
    }

    /// Takes the lock of the series, unless this writer already has it; returns false on a file system
    /// without locks.
    ///
    /// # Errors
    /// If another writer holds the lock, whose process is reported, or the folder is not writable.
    pub fn lock(&mut self) -> Result<bool> {
        let lock = match self.lock.take() {
            Some(lock) => lock,
            None => OutputLock::take(&self.path)?,
        };
        Ok(self.lock.insert(lock).is_held())
    }

    /// Keeps the first `n` frames of the existing series; frames after them are written again.
    ///
    /// # Errors
    /// If there is no such series, or it has fewer frames.
    pub fn go_on_after(&mut self, n: usize) -> Result<()> {
        let bytes = std::fs::read(&self.path).map_err(|e| Error::io(&self.path, e))?;
        let mut frames = parse_series(&bytes).map_err(|e| e.in_file(&self.path))?;
        if frames.len() < n {
            return Err(Error::input(format!("expected at least {n} frames, found {}", frames.len()))
                .in_file(&self.path)
                .remedy("start the run again"));
        }
        frames.truncate(n);
        self.frames = frames;
        Ok(())
    }

    /// The path of frame `k`: beside the series, with its name and the number of the frame.
    pub fn frame_path(&self, k: usize) -> PathBuf {
        self.path.with_file_name(self.frame_name(k))
    }

    fn frame_name(&self, k: usize) -> String {
        let stem = self.path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        format!("{stem}_{k:04}.vtu")
    }

    /// Adds a frame: writes its file, then updates the series.
    ///
    /// Returns the file of the frame, and what the format could not hold.
    ///
    /// # Errors
    /// The errors of [`write_on`](super::write_on); if another writer is writing this series.
    pub fn add(&mut self, time: f64, mesh: &Mesh) -> Result<(PathBuf, Vec<String>)> {
        self.add_on(time, mesh, &Threads::single())
    }

    /// Adds a frame like [`add`](Self::add), on several threads.
    ///
    /// # Errors
    /// The errors of [`add`](Self::add).
    pub fn add_on(&mut self, time: f64, mesh: &Mesh, threads: &Threads) -> Result<(PathBuf, Vec<String>)> {
        self.lock()?;
        let k = self.frames.len();
        let file = self.frame_path(k);
        let mut lost = write_on(&file, mesh, &self.options, threads)?;
        self.frames.push((time, self.frame_name(k)));
        lost.extend(replace(&self.path, self.text().as_bytes())?);
        Ok((file, lost))
    }

    fn text(&self) -> String {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n",
        );
        for (time, file) in &self.frames {
            text += &format!("    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{}\"/>\n", escape(file));
        }
        text + "  </Collection>\n</VTKFile>\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_series_are_read_back() {
        let mut writer = SeriesWriter::new("a <b>.pvd", WriteOptions::default());
        writer.frames = (0..3).map(|k| (0.1 * f64::from(k), writer.frame_name(k as usize))).collect();
        assert_eq!(parse_series(writer.text().as_bytes()).unwrap(), writer.frames);
        assert_eq!(writer.frames[2], (0.2, "a <b>_0002.vtu".to_string()));
    }

    #[test]
    fn invalid_series_are_reported() {
        let refused = |text: &str| parse_series(text.as_bytes()).unwrap_err().to_string();
        assert!(refused("").contains("not a series"));
        assert!(refused("<VTKFile type=\"Collection\"/>").contains("lists no files"));
        assert!(refused("<VTKFile type=\"PolyData\"/>").contains("not a series"));
        assert!(
            refused("<VTKFile type=\"Collection\"><DataSet/></VTKFile>")
                .starts_with("entry 0: has no attribute `file`")
        );
        assert!(
            refused("<VTKFile type=\"Collection\"><DataSet file='a' timestep='x'/></VTKFile>")
                .contains("`x`")
        );
        assert!(refused("<VTKFile type=\"Collection\"><DataSet file='a' timestep='1'/><DataSet file='b' timestep='1'/></VTKFile>").contains("more than once"));
        assert!(refused("<VTKFile type=\"Collection\"><DataSet file=").contains("XML"));
    }

    #[test]
    fn missing_times_become_indices() {
        let text = "<VTKFile type='Collection'><Collection><DataSet file='a.vtp'/><DataSet file='b.vtp'></DataSet></Collection></VTKFile>";
        assert_eq!(
            parse_series(text.as_bytes()).unwrap(),
            [(0.0, "a.vtp".to_string()), (1.0, "b.vtp".to_string())]
        );
    }
}
