//! Parses the XML of a VTK file into a tree of elements, up to the appended data.
//!
//! Raw appended bytes are not XML, so parsing stops at `<AppendedData>`; the rest is kept as bytes.

use std::borrow::Cow;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::base::{Error, Result};

/// Maximum nesting depth: VTK nests six deep; more is damage, or an attack on the stack.
const MAX_DEPTH: usize = 32;

/// An element with its attributes, its children and its first non-blank piece of text.
#[derive(Debug, Default)]
pub(in crate::io) struct Element<'a> {
    pub(in crate::io) name: String,
    attributes: Vec<(String, String)>,
    pub(in crate::io) children: Vec<Element<'a>>,
    pub(in crate::io) text: &'a [u8],
    /// The line on which the element starts, from 1.
    pub(in crate::io) line: usize,
}

impl<'a> Element<'a> {
    /// The trimmed value of an attribute; `None` if it is absent or empty, as some writers leave it.
    pub(in crate::io) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.trim()).filter(|v| !v.is_empty())
    }

    /// The value of an attribute, with leading and trailing blanks.
    pub(in crate::io) fn raw_attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    /// An attribute that is a count.
    pub(in crate::io) fn count(&self, name: &str) -> Result<Option<usize>> {
        let Some(text) = self.attribute(name) else { return Ok(None) };
        match text.parse::<usize>() {
            Ok(n) => Ok(Some(n)),
            Err(_) => Err(Error::input(format!("{name}=\"{text}\" is not a valid count")).at(self.place())),
        }
    }

    /// A required count.
    pub(in crate::io) fn required_count(&self, name: &str) -> Result<usize> {
        self.count(name)?
            .ok_or_else(|| Error::input(format!("the attribute {name} is missing")).at(self.place()))
    }

    /// The first child with this name.
    pub(in crate::io) fn child(&self, name: &str) -> Option<&Element<'a>> {
        self.children.iter().find(|c| c.name == name)
    }

    /// All children with this name.
    pub(in crate::io) fn children_named<'s>(
        &'s self,
        name: &'s str,
    ) -> impl Iterator<Item = &'s Element<'a>> {
        self.children.iter().filter(move |c| c.name == name)
    }

    /// The line and the name of the element, for messages.
    pub(in crate::io) fn place(&self) -> String {
        match self.attribute("Name") {
            Some(name) => format!("line {}, array {name}", self.line),
            None => format!("line {}, {}", self.line, self.name),
        }
    }
}

/// The content of `<AppendedData>`.
#[derive(Debug)]
pub(in crate::io) struct Appended<'a> {
    pub(in crate::io) base64: bool,
    /// The bytes from the one after the `_` to the end of the file.
    pub(in crate::io) bytes: &'a [u8],
}

/// A parsed VTK file.
#[derive(Debug)]
pub(in crate::io) struct Document<'a> {
    pub(in crate::io) root: Element<'a>,
    pub(in crate::io) appended: Option<Appended<'a>>,
}

impl<'a> Document<'a> {
    pub(in crate::io) fn parse(bytes: &'a [u8]) -> Result<Self> {
        let mut parser =
            Parser { reader: Reader::from_reader(bytes), bytes, counted: 0, line: 1, open: Vec::new() };
        parser.run()
    }
}

struct Parser<'a> {
    reader: Reader<&'a [u8]>,
    bytes: &'a [u8],
    /// Position up to which lines have been counted.
    counted: usize,
    line: usize,
    open: Vec<Element<'a>>,
}

impl<'a> Parser<'a> {
    fn run(&mut self) -> Result<Document<'a>> {
        let mut appended = None;
        loop {
            let start = self.reader.buffer_position() as usize;
            match self.reader.read_event() {
                Err(e) => return Err(self.error(e.to_string())),
                Ok(Event::Eof) => {
                    return Err(self.error("the file ends before all elements are closed".into()));
                }
                Ok(Event::Start(tag)) => {
                    let element = self.element(&tag, start)?;
                    if element.name == "AppendedData" {
                        appended = Some(self.appended(&element)?);
                        break;
                    }
                    if self.open.len() == MAX_DEPTH {
                        return Err(
                            self.error(format!("elements are nested more than {MAX_DEPTH} levels deep"))
                        );
                    }
                    self.open.push(element);
                }
                Ok(Event::Empty(tag)) => {
                    let element = self.element(&tag, start)?;
                    match self.open.last_mut() {
                        Some(parent) => parent.children.push(element),
                        None => return Ok(Document { root: element, appended }),
                    }
                }
                Ok(Event::Text(_)) => {
                    let end = self.reader.buffer_position() as usize;
                    let text = self.bytes.get(start..end).unwrap_or_default().trim_ascii();
                    if let Some(parent) = self.open.last_mut().filter(|p| p.text.is_empty()) {
                        parent.text = text;
                    }
                }
                Ok(Event::CData(_)) => {
                    let end = self.reader.buffer_position() as usize;
                    let text = self.bytes.get(start..end).unwrap_or_default();
                    let text = text.strip_prefix(b"<![CDATA[").and_then(|text| text.strip_suffix(b"]]>"));
                    if let Some(parent) = self.open.last_mut().filter(|p| p.text.is_empty()) {
                        parent.text = text.unwrap_or_default().trim_ascii();
                    }
                }
                Ok(Event::End(_)) => {
                    // The parser has checked that the end tag matches the open element.
                    let Some(element) = self.open.pop() else {
                        return Err(self.error("an end tag without a start tag".into()));
                    };
                    match self.open.last_mut() {
                        Some(parent) => parent.children.push(element),
                        None => return Ok(Document { root: element, appended }),
                    }
                }
                Ok(_) => {}
            }
        }
        let root = std::mem::take(&mut self.open).into_iter().next();
        root.map(|root| Document { root, appended })
            .ok_or_else(|| self.error("AppendedData outside VTKFile".into()))
    }

    fn element(&mut self, tag: &BytesStart<'_>, start: usize) -> Result<Element<'a>> {
        let line = self.line_at(start);
        let name = tag.name().as_ref().to_owned();
        let mut attributes = Vec::new();
        for attribute in tag.attributes() {
            let attribute = attribute.map_err(|e| self.error(format!("in <{name}>: {e}")))?;
            // VTK writes names without escapes, so an ampersand may stand for itself.
            let value =
                quick_xml::escape::unescape(&attribute.value).unwrap_or(Cow::Borrowed(&attribute.value));
            attributes.push((attribute.key.as_ref().to_owned(), value.into_owned()));
        }
        Ok(Element { name, attributes, line, ..Element::default() })
    }

    fn appended(&mut self, element: &Element<'_>) -> Result<Appended<'a>> {
        let base64 = match element.attribute("encoding") {
            Some("base64") | None => true,
            Some("raw") => false,
            Some(other) => {
                return Err(Error::input(format!("expected encoding raw or base64, found {other}"))
                    .at(element.place()));
            }
        };
        let rest = self.bytes.get(self.reader.buffer_position() as usize..).unwrap_or_default();
        match rest.trim_ascii_start().strip_prefix(b"_") {
            Some(bytes) => Ok(Appended { base64, bytes }),
            None => Err(Error::input("expected an underscore before the appended data")
                .at(element.place())
                .remedy("the file is damaged: write it again")),
        }
    }

    fn line_at(&mut self, at: usize) -> usize {
        let at = at.min(self.bytes.len());
        if at > self.counted {
            self.line += self.bytes[self.counted..at].iter().filter(|&&b| b == b'\n').count();
            self.counted = at;
        }
        self.line
    }

    fn error(&mut self, what: String) -> Error {
        let line = self.line_at(self.reader.buffer_position() as usize);
        Error::input(format!("not well-formed XML: {what}"))
            .at(format!("line {line}"))
            .remedy("the file is truncated or damaged: write it again")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_text_and_lines_are_found_up_to_the_appended_data() {
        let text = b"<?xml version=\"1.0\"?>\n<!-- c -->\n<A x='1 &lt; 2'>\n<B/><B>\n 1 2 <C/> 3</B>\n<D> <![CDATA[ <x> ]]></D><AppendedData encoding=\"raw\">\n _\x00<\xff";
        let document = Document::parse(text).unwrap();
        let root = &document.root;
        assert_eq!((root.name.as_str(), root.line, root.attribute("x")), ("A", 3, Some("1 < 2")));
        assert_eq!(root.children_named("B").count(), 2);
        assert_eq!(root.children[1].text, b"1 2");
        assert_eq!(root.children[1].line, 4);
        assert_eq!(root.children[2].text, b"<x>");
        let appended = document.appended.unwrap();
        assert!(!appended.base64);
        assert_eq!(appended.bytes, b"\x00<\xff");
    }

    #[test]
    fn damaged_xml_is_reported_with_its_line() {
        for (text, line) in [("<A>\n<B>\n</A>", 3), ("<A>\n<B x='1", 2), ("", 1), ("no xml", 1)] {
            let error = Document::parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.place(), Some(format!("line {line}").as_str()), "{error}");
        }
        assert!(Document::parse("<A>".repeat(100_000).as_bytes()).is_err());
    }
}
