//! The sections of a `.msh` file, version 4.1 (Gmsh reference manual, "MSH file format").

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::str::FromStr;

use super::kind::{Accepted, Kind};
use crate::error::{Error, FileFault};
use crate::text::bounded_line::Lines;
use crate::text::decimal::{excerpt, finite, quoted};

/// The result of reading; the error holds the number of the line and its fault.
type Reason<T> = Result<T, (usize, FileFault)>;

/// A point, and its line in the file.
#[derive(Debug)]
pub(super) struct Point {
    pub(super) values: [f64; 3],
    pub(super) line: usize,
}

/// An element of the file by its tags, with its line.
#[derive(Debug)]
pub(super) struct RawCell {
    pub(super) kind: Kind,
    /// Dimension and tag of its entity.
    entity: (u8, i64),
    pub(super) tag: u64,
    pub(super) nodes: Vec<u64>,
    pub(super) line: usize,
}

/// The parts of a file that are used.
#[derive(Debug, Default)]
pub(super) struct Raw {
    pub(super) coordinates: Vec<Point>,
    /// Place of each node tag in `coordinates`.
    pub(super) places: BTreeMap<u64, usize>,
    pub(super) cells: Vec<RawCell>,
    /// Physical groups of each entity, and the groups' names.
    groups: BTreeMap<(u8, i64), Vec<i64>>,
    names: BTreeMap<(u8, i64), String>,
}

impl Raw {
    /// Whether `cell` is in a physical group.
    pub(super) fn is_in_a_group(&self, cell: &RawCell) -> bool {
        self.groups.get(&cell.entity).is_some_and(|groups| !groups.is_empty())
    }

    /// Names of the physical groups of `cell`, sorted; for a group without a name, its number.
    ///
    /// A cell without a group has one empty name.
    pub(super) fn groups(&self, cell: &RawCell) -> Vec<String> {
        let tags = self.groups.get(&cell.entity).map_or(&[][..], Vec::as_slice);
        let name = |tag: &i64| {
            // A minus sign means that the entity's direction is reversed in its group.
            let key = (cell.entity.0, tag.saturating_abs());
            self.names.get(&key).cloned().unwrap_or_else(|| key.1.to_string())
        };
        let mut names: Vec<String> = tags.iter().map(name).collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            names.push(String::new());
        }
        names
    }
}

/// The file at `path` and its name.
pub(super) fn open(path: &Path) -> Result<(String, File), Error> {
    let name = path.display().to_string();
    match File::open(path) {
        Ok(file) => Ok((name, file)),
        Err(error) => Err(FileFault::Unreadable(error.kind()).of(name, 0)),
    }
}

/// Reads a file whose elements are of the `accepted` kinds.
pub(super) fn read(source: impl Read, accepted: &Accepted) -> Reason<Raw> {
    let mut fields = Words::new(source);
    let mut raw = Raw::default();
    let mut seen = Vec::new();
    while let Some(section) = fields.section()? {
        if seen.contains(&section) {
            return Err(fields.refuse(twice(format!("section ${section}"))));
        }
        match section.as_str() {
            "MeshFormat" => format(&mut fields)?,
            "PhysicalNames" => physical_names(&mut fields, &mut raw)?,
            "Entities" => entities(&mut fields, &mut raw, false)?,
            "PartitionedEntities" => partitioned_entities(&mut fields, &mut raw)?,
            "Nodes" => nodes(&mut fields, &mut raw)?,
            "Elements" => elements(&mut fields, &mut raw, accepted)?,
            _ => {
                fields.pass_over(&section)?;
                continue;
            }
        }
        fields.end(&section)?;
        seen.push(section);
    }
    for needed in ["MeshFormat", "Nodes", "Elements"] {
        if !seen.iter().any(|section| section == needed) {
            return Err((0, FileFault::missing(format!("section ${needed}"))));
        }
    }
    Ok(raw)
}

fn format(fields: &mut Words<impl Read>) -> Reason<()> {
    let version: String = fields.next("version of the format")?;
    let binary: u8 = fields.next("0 for ASCII")?;
    let _: u8 = fields.next("size of a number")?;
    if version != "4.1" || binary != 0 {
        let kind = if binary == 0 { "ASCII" } else { "binary" };
        let found = format!("format {} {kind}", excerpt(&version));
        return Err(fields.refuse(FileFault::format(found, "format 4.1 ASCII")));
    }
    Ok(())
}

fn physical_names(fields: &mut Words<impl Read>, raw: &mut Raw) -> Reason<()> {
    let count: usize = fields.next("number of names")?;
    for _ in 0..count {
        let key = (fields.next("dimension")?, fields.next("tag of a group")?);
        let name = fields.quoted()?;
        if raw.names.insert(key, name).is_some() {
            let what = format!("name of group {} of dimension {}", key.1, key.0);
            return Err(fields.refuse(twice(what)));
        }
    }
    Ok(())
}

/// The parts of a partitioned mesh: separate entities, with the groups of their parents.
fn partitioned_entities(fields: &mut Words<impl Read>, raw: &mut Raw) -> Reason<()> {
    let _: u64 = fields.next("number of partitions")?;
    let ghosts: u64 = fields.next("number of ghost entities")?;
    for _ in 0..ghosts {
        let _: i64 = fields.next("tag of a ghost entity")?;
        let _: i64 = fields.next("partition")?;
    }
    entities(fields, raw, true)
}

fn entities(fields: &mut Words<impl Read>, raw: &mut Raw, partitioned: bool) -> Reason<()> {
    let mut counts = [0_usize; 4];
    for count in &mut counts {
        *count = fields.next("number of entities")?;
    }
    for (dimension, count) in (0_u8..).zip(counts) {
        for _ in 0..count {
            let tag: i64 = fields.next("tag of an entity")?;
            if partitioned {
                let _: u8 = fields.next("dimension of the parent")?;
                let _: i64 = fields.next("tag of the parent")?;
                let partitions: u64 = fields.next("number of partitions")?;
                for _ in 0..partitions {
                    let _: i64 = fields.next("partition")?;
                }
            }
            // A point has its coordinates; other entities have the corners of a box, which may be infinite.
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                let _: f64 = fields.next("coordinate of an entity")?;
            }
            let number: usize = fields.next("number of groups")?;
            let mut groups: Vec<i64> = Vec::new();
            for _ in 0..number {
                groups.push(fields.next("tag of a group")?);
            }
            let before = raw.groups.get(&(dimension, tag));
            let other = before.is_some_and(|before| *before != groups && !groups.is_empty());
            if other && !partitioned {
                let what = format!("group of entity {tag} of dimension {dimension}");
                return Err(fields.refuse(twice(what)));
            }
            if !groups.is_empty() {
                raw.groups.insert((dimension, tag), groups);
            }
            if dimension > 0 {
                let bounds: usize = fields.next("number of bounding entities")?;
                for _ in 0..bounds {
                    let _: i64 = fields.next("tag of a bounding entity")?;
                }
            }
        }
    }
    Ok(())
}

fn nodes(fields: &mut Words<impl Read>, raw: &mut Raw) -> Reason<()> {
    let (blocks, announced) = counts(fields, "number of nodes")?;
    for _ in 0..blocks {
        let dimension: usize = fields.next("dimension of an entity")?;
        let _: i64 = fields.next("tag of an entity")?;
        let parametric: usize = fields.next("0 or 1")?;
        let count: usize = fields.next("number of nodes")?;
        let first = raw.coordinates.len();
        for k in 0..count {
            let tag = fields.next("tag of a node")?;
            if raw.places.insert(tag, first + k).is_some() {
                return Err(fields.refuse(twice(format!("node {tag}"))));
            }
        }
        for _ in 0..count {
            let mut values = [0.0; 3];
            for value in &mut values {
                *value = fields.number()?;
            }
            raw.coordinates.push(Point { values, line: fields.line });
            for _ in 0..if parametric == 0 { 0 } else { dimension.min(3) } {
                fields.number()?;
            }
        }
    }
    fields.agree("nodes", raw.coordinates.len(), announced)
}

/// Numbers of blocks and of entries in them; the smallest and the largest tag follow in the file.
fn counts(fields: &mut Words<impl Read>, what: &'static str) -> Reason<(u64, u64)> {
    let counts = (fields.next("number of blocks")?, fields.next(what)?);
    for tag in ["smallest tag", "largest tag"] {
        let _: u64 = fields.next(tag)?;
    }
    Ok(counts)
}

fn elements(fields: &mut Words<impl Read>, raw: &mut Raw, accepted: &Accepted) -> Reason<()> {
    let (blocks, announced) = counts(fields, "number of elements")?;
    for _ in 0..blocks {
        let entity = (fields.next("dimension of an entity")?, fields.next("tag of an entity")?);
        let number: u32 = fields.next("type of elements")?;
        let count: usize = fields.next("number of elements")?;
        let kind = accepted.kind(number, count).map_err(|reason| fields.refuse(reason))?;
        for _ in 0..count {
            let tag = fields.next("tag of an element")?;
            let mut nodes = Vec::with_capacity(kind.nodes());
            for _ in 0..kind.nodes() {
                nodes.push(fields.next("tag of a node")?);
            }
            raw.cells.push(RawCell { kind, entity, tag, nodes, line: fields.line });
        }
    }
    fields.agree("elements", raw.cells.len(), announced)
}

/// Fault of an item that may be there once.
pub(super) fn twice(item: impl Into<String>) -> FileFault {
    FileFault::value(item, "given twice", "given once")
}

/// The fields of a text in order, with their line numbers.
struct Words<R: Read> {
    source: Lines<R>,
    text: String,
    /// Start of the next field in `text`.
    at: usize,
    /// Number of the line in `text`, from 1.
    line: usize,
}

impl<R: Read> Words<R> {
    fn new(source: R) -> Self {
        Self { source: Lines::new(source), text: String::new(), at: 0, line: 0 }
    }

    fn refuse(&self, reason: FileFault) -> (usize, FileFault) {
        (self.line, reason)
    }

    /// Goes to the next line; `false` at the end.
    fn advance(&mut self) -> Reason<bool> {
        self.line += 1;
        if !self.source.advance()? {
            return Ok(false);
        }
        self.text.clear();
        self.text.push_str(&self.source.text());
        self.at = 0;
        Ok(true)
    }

    /// The next field unchanged; `None` at the end.
    fn field(&mut self) -> Reason<Option<&str>> {
        loop {
            let rest = &self.text[self.at..];
            let begin = self.at + (rest.len() - rest.trim_start().len());
            if begin < self.text.len() {
                let rest = &self.text[begin..];
                let end = begin + rest.find(char::is_whitespace).unwrap_or(rest.len());
                self.at = end;
                return Ok(Some(&self.text[begin..end]));
            }
            if !self.advance()? {
                return Ok(None);
            }
        }
    }

    /// The next field, converted by `parse`.
    fn field_as<T>(&mut self, what: &'static str, parse: impl Fn(&str) -> Option<T>) -> Reason<T> {
        let Some(field) = self.field()? else {
            return Err((self.line, FileFault::missing(what)));
        };
        let (parsed, found) = (parse(field), quoted(field));
        parsed.ok_or_else(|| self.refuse(FileFault::value("field", found, format!("a {what}"))))
    }

    fn next<T: FromStr>(&mut self, what: &'static str) -> Reason<T> {
        self.field_as(what, |field| field.parse().ok())
    }

    fn number(&mut self) -> Reason<f64> {
        self.field_as("finite number", finite)
    }

    /// Error if the number of items differs from the number announced.
    fn agree(&self, what: &'static str, found: usize, announced: u64) -> Reason<()> {
        if u64::try_from(found) == Ok(announced) {
            return Ok(());
        }
        Err(self.refuse(FileFault::count(what, found, format!("{announced}, as announced"))))
    }

    /// Text between quotation marks, on the present line.
    fn quoted(&mut self) -> Reason<String> {
        let mut parts = self.text[self.at..].splitn(3, '"');
        let (before, name, after) = (parts.next(), parts.next(), parts.next());
        match (before, name, after) {
            (Some(before), Some(name), Some(after)) if before.trim().is_empty() => {
                let name = name.to_owned();
                self.at = self.text.len() - after.len();
                Ok(name)
            }
            _ => Err(self.refuse(FileFault::missing("name in quotation marks"))),
        }
    }

    /// Name of the section that begins next; `None` at the end.
    fn section(&mut self) -> Reason<Option<String>> {
        let Some(field) = self.field()? else { return Ok(None) };
        if let Some(name) = field.strip_prefix('$') {
            return Ok(Some(name.to_owned()));
        }
        let found = quoted(field);
        Err(self.refuse(FileFault::value("field", found, "the beginning of a section")))
    }

    /// Reads the end of `section`.
    fn end(&mut self, section: &str) -> Reason<()> {
        let end = self.field()?.map(|field| field.strip_prefix("$End") == Some(section));
        if end == Some(true) {
            return Ok(());
        }
        Err(self.refuse(FileFault::missing(format!("$End{section}"))))
    }

    fn pass_over(&mut self, section: &str) -> Reason<()> {
        while let Some(field) = self.field()? {
            if field.strip_prefix("$End") == Some(section) {
                return Ok(());
            }
        }
        Err(self.refuse(FileFault::missing(format!("$End{section}"))))
    }
}
