//! Writes elements and arrays of a VTK XML file.

use std::borrow::Cow;
use std::ops::Range;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::base::{Csr, Point, Result, VertexId};
use crate::io::format::{Compression, Encoding, WriteOptions};
use crate::io::output::{Output, drain, write_all};
use crate::io::scalar::{native_bytes, write_lines, write_text};
use crate::io::vtkxml::codec::{Compressor, vtk_name};
use crate::mesh::{Field, Values};

/// Bytes that are compressed together, as many as in the files that VTK writes.
const BLOCK: usize = 32 << 10;
/// Bytes that a thread encodes at a time, whole groups of three.
const BASE64_PART: usize = 3 << 16;
/// Placeholder for an offset, which is only known when the array is written.
const OFFSET_BLANKS: &str = "                      ";

/// The values of an array for writing.
pub(super) enum Data<'a> {
    Values(&'a Values),
    Points(&'a [Point]),
    /// Ids, or indices in a list, written as Int64.
    Ids(&'a [u32]),
    Int64(Vec<i64>),
    Bytes(&'a [u8]),
}

impl Data<'_> {
    fn type_name(&self) -> &'static str {
        match self {
            Self::Points(_) => "Float64",
            Self::Ids(_) | Self::Int64(_) => "Int64",
            Self::Bytes(_) => "UInt8",
            Self::Values(values) => match values {
                Values::I8(_) => "Int8",
                Values::U8(_) => "UInt8",
                Values::I16(_) => "Int16",
                Values::U16(_) => "UInt16",
                Values::I32(_) => "Int32",
                Values::U32(_) => "UInt32",
                Values::I64(_) => "Int64",
                Values::U64(_) => "UInt64",
                Values::F32(_) => "Float32",
                Values::F64(_) => "Float64",
                Values::Text(_) => "String",
            },
        }
    }

    /// The bytes as stored in the file.
    fn stored(&self) -> Stored<'_> {
        match self {
            Self::Values(values) => Stored::Plain(native_bytes(values)),
            Self::Points(points) => Stored::Plain(Cow::Borrowed(bytemuck::cast_slice(points))),
            Self::Int64(values) => Stored::Plain(Cow::Borrowed(bytemuck::cast_slice(values))),
            Self::Bytes(bytes) => Stored::Plain(Cow::Borrowed(bytes)),
            Self::Ids(ids) => Stored::Wide(ids),
        }
    }
}

/// The bytes of an array.
enum Stored<'d> {
    Plain(Cow<'d, [u8]>),
    /// Ids, which are widened while they are written.
    Wide(&'d [u32]),
}

impl Stored<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Plain(bytes) => bytes.len(),
            Self::Wide(ids) => ids.len() * 8,
        }
    }

    /// The bytes of a range, whose ends are whole numbers of ids; `wide` is memory for widened ids.
    fn range<'s>(&'s self, range: Range<usize>, wide: &'s mut Vec<i64>) -> &'s [u8] {
        match self {
            Self::Plain(bytes) => &bytes[range],
            Self::Wide(ids) => {
                wide.clear();
                wide.extend(ids[range.start / 8..range.end / 8].iter().map(|&id| i64::from(id)));
                bytemuck::cast_slice(wide)
            }
        }
    }

    /// Writes the header and the bytes; returns the size of the header in bytes.
    fn write(&self, compression: Compression, output: &mut Output<'_>) -> Result<usize> {
        if compression != Compression::None {
            return self.write_compressed(compression, output);
        }
        write_all(output, &(self.len() as u64).to_ne_bytes())?;
        match self {
            // As few calls as possible, and no copies: these would take as long as writing.
            Self::Plain(bytes) => write_all(output, bytes)?,
            Self::Wide(_) => {
                self.blocks(output, |wide: &mut Vec<i64>, range, out| {
                    out.extend_from_slice(self.range(range, wide));
                    Ok(())
                })?;
            }
        }
        Ok(8)
    }

    fn write_compressed(&self, compression: Compression, output: &mut Output<'_>) -> Result<usize> {
        let n_blocks = self.len().div_ceil(BLOCK);
        let mut header: Vec<u64> = vec![0; 3 + n_blocks];
        header[..3].copy_from_slice(&[n_blocks as u64, BLOCK as u64, (self.len() % BLOCK) as u64]);
        let header_at = output.len();
        write_all(output, bytemuck::cast_slice(&header))?;
        let sizes = self.blocks(output, |tools: &mut Tools, range, out| {
            let compressor = tools.compressor.get_or_insert_with(|| Compressor::new(compression));
            compressor.compress(self.range(range, &mut tools.wide), out)?;
            Ok(out.len() as u64)
        })?;
        header[3..].copy_from_slice(&sizes);
        output.replace(header_at, bytemuck::cast_slice(&header))?;
        Ok(size_of_val(header.as_slice()))
    }

    /// Writes what `make` appends for each block; returns what it returned.
    fn blocks<S: Default + Send, T: Send>(
        &self,
        output: &mut Output<'_>,
        make: impl Fn(&mut S, Range<usize>, &mut Vec<u8>) -> Result<T> + Sync + Send,
    ) -> Result<Vec<T>> {
        let n = self.len();
        output.parts(n.div_ceil(BLOCK), |state, i, out| make(state, i * BLOCK..n.min((i + 1) * BLOCK), out))
    }
}

/// What a thread reuses from block to block.
#[derive(Default)]
struct Tools {
    compressor: Option<Compressor>,
    wide: Vec<i64>,
}

/// A file being written.
pub(super) struct Writer<'a, 'o> {
    output: &'a mut Output<'o>,
    /// Elements that are not yet written to the output.
    out: Vec<u8>,
    depth: usize,
    encoding: Encoding,
    compression: Compression,
    /// Arrays for the appended part: the position of their offset, and their data.
    appended: Vec<(u64, Data<'a>)>,
    /// What could not be written unchanged.
    pub(super) lost: Vec<String>,
}

impl<'a, 'o> Writer<'a, 'o> {
    /// Starts a file with data of `kind`.
    pub(super) fn new(kind: &str, options: &WriteOptions, output: &'a mut Output<'o>) -> Self {
        let ascii = options.encoding == Encoding::Ascii;
        let compression = if ascii { Compression::None } else { options.compression };
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        let compressor =
            vtk_name(compression).map(|name| format!(" compressor=\"{name}\"")).unwrap_or_default();
        let mut writer = Self {
            output,
            out: b"<?xml version=\"1.0\"?>\n".to_vec(),
            depth: 0,
            encoding: options.encoding,
            compression,
            appended: Vec::new(),
            lost: Vec::new(),
        };
        writer.open(&format!(
            "VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\"{compressor}"
        ));
        writer.open(kind);
        writer
    }

    /// Opens an element; `tag` is its name with any attributes.
    pub(super) fn open(&mut self, tag: &str) {
        self.line(&format!("<{tag}>"));
        self.depth += 1;
    }

    pub(super) fn close(&mut self, name: &str) {
        self.depth -= 1;
        self.line(&format!("</{name}>"));
    }

    fn line(&mut self, text: &str) {
        self.out.extend(std::iter::repeat_n(b' ', 2 * self.depth));
        self.out.extend(text.as_bytes());
        self.out.push(b'\n');
    }

    /// Writes an element with an array for each field; `rows` states whether to include the number of rows.
    pub(super) fn fields(&mut self, name: &str, fields: &[&'a Field], rows: bool) -> Result<()> {
        self.open(name);
        for field in fields {
            let n_rows = rows.then(|| field.n_rows());
            self.array(&field.name, field.components, n_rows, Data::Values(&field.values))?;
        }
        self.close(name);
        Ok(())
    }

    /// Writes an array.
    pub(super) fn array(
        &mut self,
        name: &str,
        components: usize,
        rows: Option<usize>,
        data: Data<'a>,
    ) -> Result<()> {
        let tag = if data.type_name() == "String" { "Array" } else { "DataArray" };
        let mut attributes = format!("{tag} type=\"{}\" Name=\"{}\"", data.type_name(), self.escaped(name));
        if components != 1 {
            attributes += &format!(" NumberOfComponents=\"{components}\"");
        }
        if let Some(rows) = rows {
            attributes += &format!(" NumberOfTuples=\"{rows}\"");
        }
        self.note_zero_bytes(name, &data);
        match self.encoding {
            Encoding::Binary => {
                let start = format!("<{attributes} format=\"appended\" offset=\"");
                let offset_at = self.output.len() + (self.out.len() + 2 * self.depth + start.len()) as u64;
                self.line(&format!("{start}{OFFSET_BLANKS}/>"));
                self.appended.push((offset_at, data));
                return Ok(());
            }
            Encoding::Ascii => {
                self.open(&format!("{attributes} format=\"ascii\""));
                drain(&mut self.out, self.output)?;
                write_ascii(self.output, &data)?;
            }
            Encoding::Base64 => {
                self.open(&format!("{attributes} format=\"binary\""));
                self.base64(&data)?;
            }
        }
        self.close(tag);
        Ok(())
    }

    fn base64(&mut self, data: &Data<'_>) -> Result<()> {
        let mut raw = Vec::new();
        let threads = self.output.threads();
        let header = data.stored().write(self.compression, &mut Output::to_memory(&mut raw, threads))?;
        // VTK decodes the header of compressed data separately, so it needs its own padding.
        let header = if self.compression == Compression::None { 0 } else { header };
        encode(&raw[..header], &mut self.out);
        drain(&mut self.out, self.output)?;
        let parts: Vec<&[u8]> = raw[header..].chunks(BASE64_PART).collect();
        self.output.parts(parts.len(), |(), i, out| {
            encode(parts[i], out);
            Ok(())
        })?;
        self.out.push(b'\n');
        Ok(())
    }

    /// Closes all elements and adds the appended arrays; returns what could not be written unchanged.
    pub(super) fn finish(mut self, kind: &str) -> Result<Vec<String>> {
        self.close(kind);
        let arrays = std::mem::take(&mut self.appended);
        if !arrays.is_empty() {
            self.line("<AppendedData encoding=\"raw\">");
            self.out.push(b'_');
            drain(&mut self.out, self.output)?;
            let start = self.output.len();
            for (offset_at, data) in arrays {
                let offset = format!("{}\"", self.output.len() - start);
                self.output.replace(offset_at, offset.as_bytes())?;
                data.stored().write(self.compression, self.output)?;
            }
            self.out.push(b'\n');
            self.line("</AppendedData>");
        }
        self.close("VTKFile");
        drain(&mut self.out, self.output)?;
        Ok(self.lost)
    }

    fn escaped(&mut self, text: &str) -> String {
        escape_attribute(text, &mut self.lost)
    }

    fn note_zero_bytes(&mut self, name: &str, data: &Data<'_>) {
        if matches!(data, Data::Values(Values::Text(texts)) if texts.iter().any(|t| t.contains('\0'))) {
            self.lost
                .push(format!("texts of the array {name} contain zero bytes, which end a text in VTK files"));
        }
    }
}

/// Appends bytes in base64.
fn encode(bytes: &[u8], out: &mut Vec<u8>) {
    let start = out.len();
    out.resize(start + bytes.len().div_ceil(3) * 4, 0);
    STANDARD.encode_slice(bytes, &mut out[start..]).expect("the room is that of the encoded bytes");
}

/// Writes an array as text; texts become the numbers of their bytes.
fn write_ascii(output: &mut Output<'_>, data: &Data<'_>) -> Result<()> {
    match data {
        Data::Values(values @ Values::Text(_)) => write_lines(output, &native_bytes(values)),
        Data::Values(values) => write_text(output, values),
        Data::Points(points) => write_lines(output, points.as_flattened()),
        Data::Ids(ids) => write_lines(output, ids),
        Data::Int64(values) => write_lines(output, values),
        Data::Bytes(bytes) => write_lines(output, bytes),
    }
}

/// Concatenated ids as plain numbers.
pub(super) fn plain(ids: &[VertexId]) -> &[u32] {
    bytemuck::cast_slice(ids)
}

/// The end of each list.
pub(super) fn ends(lists: &Csr<VertexId>) -> &[u32] {
    &lists.offsets()[1..]
}

/// Escapes `text` for the value of an attribute.
pub(in crate::io) fn escape_attribute(text: &str, lost: &mut Vec<String>) -> String {
    let breaks = ['\t', '\n', '\r'];
    let illegal = |c: char| (c.is_control() && !breaks.contains(&c)) || matches!(c, '\u{fffe}' | '\u{ffff}');
    let mut legal = Cow::Borrowed(text);
    if text.contains(illegal) {
        legal = Cow::Owned(text.replace(illegal, "?"));
        lost.push(format!(
            "the name {text:?} has characters that XML does not allow: they are replaced by question marks"
        ));
    }
    let escaped = quick_xml::escape::escape(&*legal);
    escaped.replace('\t', "&#9;").replace('\n', "&#10;").replace('\r', "&#13;")
}
