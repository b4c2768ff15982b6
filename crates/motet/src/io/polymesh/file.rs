//! Parses one file of a mesh: its header, then words and lists, as text or binary.

use crate::base::{Csr, Error, Point, Result, VertexId};
use crate::io::text::{parse_float, parse_int, quoted};

/// A file and a position in it.
pub(super) struct File<'a> {
    bytes: &'a [u8],
    at: usize,
    is_binary: bool,
    label_bytes: usize,
    scalar_bytes: usize,
    /// The declared class of the content.
    pub(super) class: String,
}

impl<'a> File<'a> {
    /// Opens a file and reads its header.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self> {
        let mut file =
            Self { bytes, at: 0, is_binary: false, label_bytes: 4, scalar_bytes: 8, class: String::new() };
        if file.word()? != b"FoamFile" {
            return Err(file.error("is not an OpenFOAM file: expected `FoamFile` at the start"));
        }
        file.expect(b"{")?;
        loop {
            let key = file.word()?.to_vec();
            if key == b"}" {
                return Ok(file);
            }
            let value = file.word()?.to_vec();
            let text = String::from_utf8_lossy(&value).trim_matches('"').to_owned();
            match key.as_slice() {
                b"format" => file.is_binary = text == "binary",
                b"class" => file.class = text,
                b"arch" => file.arch(&text)?,
                _ => {}
            }
            while file.word()? != b";" {}
        }
    }

    /// Parses the sizes of numbers, such as `LSB;label=32;scalar=64`.
    fn arch(&mut self, text: &str) -> Result<()> {
        for part in text.split(';') {
            let bits = |of: &str| part.strip_prefix(of).and_then(|bits| bits.parse::<usize>().ok());
            if part == "MSB" {
                return Err(self
                    .error("big-endian binary numbers are not supported")
                    .remedy("convert it to text with foamFormatConvert"));
            }
            if let Some(bits) = bits("label=") {
                self.label_bytes = bits / 8;
            }
            if let Some(bits) = bits("scalar=") {
                self.scalar_bytes = bits / 8;
            }
        }
        match (self.label_bytes, self.scalar_bytes) {
            (4 | 8, 4 | 8) => Ok(()),
            _ => Err(self.error("expected numbers of 32 or 64 bits")),
        }
    }

    /// Skips blanks and comments.
    fn skip_blanks(&mut self) {
        loop {
            let rest = &self.bytes[self.at..];
            let blank = rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
            let rest = &rest[blank..];
            self.at += blank;
            let end: &[u8] = match rest {
                [b'/', b'/', ..] => b"\n",
                [b'/', b'*', ..] => b"*/",
                _ => return,
            };
            let found = rest.windows(end.len()).skip(2).position(|w| w == end).map(|i| i + 2 + end.len());
            self.at += found.unwrap_or(rest.len());
        }
    }

    /// The next word, punctuation character or quoted text; empty at the end.
    fn next(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let is_sign = |b: u8| matches!(b, b'(' | b')' | b'{' | b'}' | b'[' | b']' | b';');
        let n = match rest.first() {
            None => 0,
            Some(b'"') => 1 + rest[1..].iter().position(|&b| b == b'"').map_or(rest.len() - 1, |i| i + 1),
            Some(&b) if is_sign(b) => 1,
            Some(_) => rest.iter().position(|&b| b.is_ascii_whitespace() || is_sign(b)).unwrap_or(rest.len()),
        };
        self.at += n;
        &rest[..n]
    }

    /// The next word; an error at the end of the file.
    pub(super) fn word(&mut self) -> Result<&'a [u8]> {
        match self.next() {
            [] => {
                Err(self.error("unexpected end of the file").remedy("the file is truncated: get a new copy"))
            }
            word => Ok(word),
        }
    }

    /// The next word, without consuming it; empty at the end.
    pub(super) fn peek(&mut self) -> &'a [u8] {
        let at = self.at;
        let word = self.next();
        self.at = at;
        word
    }

    pub(super) fn expect(&mut self, sign: &[u8]) -> Result<()> {
        let word = self.word()?;
        match word == sign {
            true => Ok(()),
            false => Err(self.error(format!("expected {}, found {}", quoted(sign), quoted(word)))),
        }
    }

    /// Skips the rest of an entry up to its semicolon, or up to the closing brace of a group.
    pub(super) fn skip_entry(&mut self) -> Result<()> {
        let mut depth = 0usize;
        loop {
            match self.word()? {
                b";" if depth == 0 => return Ok(()),
                b"{" | b"(" | b"[" => depth += 1,
                b"}" if depth == 1 => return Ok(()),
                b"}" | b")" | b"]" => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
    }

    pub(super) fn int(&mut self) -> Result<i64> {
        let word = self.word()?;
        parse_int(word).ok_or_else(|| self.error(format!("expected a whole number, found {}", quoted(word))))
    }

    fn float(&mut self) -> Result<f64> {
        let word = self.word()?;
        parse_float(word).ok_or_else(|| self.error(format!("expected a number, found {}", quoted(word))))
    }

    /// Reads a non-negative integer.
    pub(super) fn count(&mut self) -> Result<usize> {
        let n = self.int()?;
        usize::try_from(n).map_err(|_| self.error(format!("expected a count, found {n}")))
    }

    /// Reads a number of entries of at least `bytes_each` bytes each, and checks it against the remaining
    /// bytes.
    fn checked_count(&mut self, bytes_each: usize) -> Result<usize> {
        let n = self.count()?;
        // A list that repeats one value (`n{value}`) takes no space per entry.
        let room = (self.bytes.len() - self.at) / bytes_each + 1;
        if n > room && self.peek() != b"{" {
            return Err(self
                .error(format!("{n} entries declared, but the rest of the file can hold at most {room}"))
                .remedy("the file is truncated or damaged: get a new copy"));
        }
        if n > VertexId::MAX_COUNT {
            return Err(self.error(format!("{n} entries are more than a mesh can hold")));
        }
        Ok(n)
    }

    /// Reads a list of labels.
    pub(super) fn labels(&mut self) -> Result<Vec<i64>> {
        let size = if self.is_binary { self.label_bytes } else { 2 };
        let n = self.checked_count(size)?;
        if let Some(one) = self.uniform(Self::int)? {
            return Ok(vec![one; n]);
        }
        if self.is_binary {
            let raw = self.raw(n, self.label_bytes)?;
            return Ok(match self.label_bytes {
                4 => raw.as_chunks::<4>().0.iter().map(|&b| i64::from(i32::from_le_bytes(b))).collect(),
                _ => raw.as_chunks::<8>().0.iter().map(|&b| i64::from_le_bytes(b)).collect(),
            });
        }
        self.between_brackets(n, Self::int)
    }

    /// Reads a list of points.
    pub(super) fn points(&mut self) -> Result<Vec<Point>> {
        let size = if self.is_binary { 3 * self.scalar_bytes } else { 8 };
        let n = self.checked_count(size)?;
        if self.is_binary {
            let raw = self.raw(3 * n, self.scalar_bytes)?;
            let flat: Vec<f64> = match self.scalar_bytes {
                4 => raw.as_chunks::<4>().0.iter().map(|&b| f64::from(f32::from_le_bytes(b))).collect(),
                _ => raw.as_chunks::<8>().0.iter().map(|&b| f64::from_le_bytes(b)).collect(),
            };
            return Ok(flat.as_chunks::<3>().0.to_vec());
        }
        self.between_brackets(n, |file| {
            file.expect(b"(")?;
            let point = [file.float()?, file.float()?, file.float()?];
            file.expect(b")").map(|()| point)
        })
    }

    /// Reads a list of faces, each a list of points.
    pub(super) fn faces(&mut self) -> Result<Csr<u32>> {
        if self.class == "faceCompactList" {
            let (offsets, points) = (self.labels()?, self.labels()?);
            let narrow = |list: Vec<i64>| list.into_iter().map(u32::try_from).collect::<Result<Vec<_>, _>>();
            let (offsets, points) = (narrow(offsets), narrow(points));
            let lists = offsets.ok().zip(points.ok()).and_then(|(offsets, points)| Csr::new(offsets, points));
            return lists
                .ok_or_else(|| self.error("face offsets do not ascend, or a point number is negative"));
        }
        if self.is_binary {
            return Err(self
                .error("binary face lists of this old type are not supported")
                .remedy("convert it with foamFormatConvert"));
        }
        let n = self.checked_count(4)?;
        let mut faces = Csr::default();
        self.expect(b"(")?;
        for _ in 0..n {
            let points = self.labels()?;
            let points: Result<Vec<u32>, _> = points.into_iter().map(u32::try_from).collect();
            faces.push(points.map_err(|_| self.error("a face has a negative point number"))?);
        }
        self.expect(b")")?;
        Ok(faces)
    }

    /// Reads the single value of a list in braces; `None` if the list is of another form.
    fn uniform(&mut self, read: impl Fn(&mut Self) -> Result<i64>) -> Result<Option<i64>> {
        if self.peek() != b"{" {
            return Ok(None);
        }
        self.expect(b"{")?;
        let one = read(self)?;
        self.expect(b"}").map(|()| Some(one))
    }

    fn between_brackets<T>(&mut self, n: usize, read: impl Fn(&mut Self) -> Result<T>) -> Result<Vec<T>> {
        self.expect(b"(")?;
        let all = (0..n).map(|_| read(self)).collect::<Result<Vec<T>>>()?;
        self.expect(b")").map(|()| all)
    }

    /// Reads the bytes of a binary list.
    fn raw(&mut self, n: usize, size: usize) -> Result<&'a [u8]> {
        if n == 0 {
            if self.peek() == b"(" {
                self.expect(b"(")?;
                self.expect(b")")?;
            }
            return Ok(&[]);
        }
        self.expect(b"(")?;
        let bytes = self.bytes[self.at..].get(..n * size);
        let bytes = bytes.ok_or_else(|| {
            self.error("the file ends inside a list").remedy("the file is truncated: get a new copy")
        })?;
        self.at += bytes.len();
        self.expect(b")").map(|()| bytes)
    }

    /// An error at the current position.
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        let place = if self.is_binary {
            format!("byte {}", self.at)
        } else {
            format!("line {}", 1 + self.bytes[..self.at].iter().filter(|&&b| b == b'\n').count())
        };
        Error::input(what).at(place)
    }
}
