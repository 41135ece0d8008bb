//! A table, read whole.

use std::path::{Path, PathBuf};

use csv::{Position, StringRecord, Trim};
use scene::read_text;

use super::cell::Cell;
use super::column::{Column, Content};
use super::error::TableError;
use super::header::{Header, Place, separator};
use super::number::{count, number};
use super::remark::Remark;
use super::unit::Dimension;
use crate::nearest::did_you_mean;

/// Rows of a file, their cells in the order of the columns asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The file.
    pub path: PathBuf,
    /// Rows in the order of the file, at least one.
    pub rows: Vec<Row>,
    /// What was read in another way than it is written.
    pub remarks: Vec<Remark>,
    /// Titles of further columns of numbers, in lower case with words joined by `_`.
    pub further: Vec<String>,
    columns: Vec<Column>,
    titles: Vec<String>,
    units: Vec<Option<Dimension>>,
}

/// One row.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Line of the file, from 1.
    pub line: u64,
    /// Cells in the order of the columns asked for.
    pub cells: Vec<Cell>,
    /// Numbers of the further columns; `None` where a cell is empty.
    pub further: Vec<Option<f64>>,
}

impl Table {
    /// Reads a file of at most `most_bytes`.
    ///
    /// # Errors
    /// [`TableError`] with the first fault: file, line, column and what is allowed.
    pub fn read(path: &Path, columns: &[Column], most_bytes: u64) -> Result<Self, TableError> {
        Self::read_with(path, columns, |_| false, most_bytes)
    }

    /// The same with every column of numbers whose title, in lower case with words joined by `_`, `is_further`.
    ///
    /// # Errors
    /// As [`Table::read`].
    pub fn read_with(
        path: &Path,
        columns: &[Column],
        is_further: fn(&str) -> bool,
        most_bytes: u64,
    ) -> Result<Self, TableError> {
        let text = read_text(path, most_bytes)
            .map_err(|source| TableError::Unreadable { path: path.to_owned(), source })?;
        Self::parsed(path, &text, columns, is_further)
    }

    /// The same of a text; `path` is named in messages.
    ///
    /// # Errors
    /// As [`Table::read`].
    pub fn parse(path: &Path, text: &str, columns: &[Column]) -> Result<Self, TableError> {
        Self::parsed(path, text, columns, |_| false)
    }

    fn parsed(
        path: &Path,
        text: &str,
        columns: &[Column],
        is_further: fn(&str) -> bool,
    ) -> Result<Self, TableError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let required = columns.iter().filter(|column| column.required);
        let titles = required.map(|column| column.name).collect::<Vec<_>>().join(",");
        let empty = || TableError::Empty { path: path.to_owned(), titles: titles.clone() };
        let is_title = |line: &&str| !is_skipped(line) && !line.to_lowercase().starts_with("sep=");
        let separator = separator(text.lines().find(is_title).ok_or_else(empty)?);
        let mut records = csv::ReaderBuilder::new()
            .delimiter(separator)
            .flexible(true)
            .has_headers(false)
            .comment(Some(b'#'))
            .trim(Trim::All)
            .from_reader(text.as_bytes());
        let mut header: Option<Header> = None;
        let mut rows = Vec::new();
        let mut remarks = Vec::new();
        for record in records.records() {
            let record = record.map_err(|source| TableError::Csv {
                path: path.to_owned(),
                line: source.position().map_or(0, Position::line),
                source,
            })?;
            let line = line_of(text, record.position());
            let is_mark = record.get(0).is_some_and(|cell| cell.to_lowercase().starts_with("sep="));
            match &header {
                _ if record.iter().all(str::is_empty) || (header.is_none() && is_mark) => {}
                None => {
                    let titles = record.iter().map(str::to_owned).collect();
                    let found = Header::read(path, line, titles, columns, is_further)?;
                    remarks.extend(found.remarks(path, columns));
                    header = Some(found);
                }
                Some(header) => {
                    let place = Reading { path, line, header, columns, comma: separator != b',' };
                    rows.push(place.row(record, &mut remarks)?);
                }
            }
        }
        let header = header.ok_or_else(empty)?;
        if rows.is_empty() {
            return Err(empty());
        }
        let title = |(column, place): (&Column, &Option<Place>)| match place {
            Some(place) => header.titles[place.index].clone(),
            None => column.name.to_owned(),
        };
        let unit = |place: &Option<Place>| place.as_ref().and_then(|p| Dimension::of_unit(p.unit));
        Ok(Self {
            path: path.to_owned(),
            rows,
            remarks,
            further: header.further.iter().map(|(_, title)| title.clone()).collect(),
            columns: columns.to_vec(),
            titles: columns.iter().zip(&header.places).map(title).collect(),
            units: header.places.iter().map(unit).collect(),
        })
    }

    /// The text of a cell; `None` if it is empty or no text.
    pub fn text<'r>(&self, row: &'r Row, column: &str) -> Option<&'r str> {
        match self.cell(row, column)? {
            Cell::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The number of a cell in the unit of its column; `None` if it is empty or no number.
    pub fn number(&self, row: &Row, column: &str) -> Option<f64> {
        match self.cell(row, column)? {
            Cell::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The whole number of a cell; `None` if it is empty or none.
    pub fn count(&self, row: &Row, column: &str) -> Option<usize> {
        match self.cell(row, column)? {
            Cell::Count(count) => Some(*count),
            _ => None,
        }
    }

    /// What the unit in the title of a column measures; `None` if its title has none.
    pub fn dimension(&self, column: &str) -> Option<Dimension> {
        self.units[self.index(column)?]
    }

    /// A cell that its column allows and the reader of the table does not.
    pub fn refusal(&self, row: &Row, column: &str, value: &str, allowed: &str) -> TableError {
        let title = self.index(column).map_or(column, |i| self.titles[i].as_str());
        TableError::value(&self.path, row.line, title, value, allowed)
    }

    fn index(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|known| known.name == column)
    }

    fn cell<'r>(&self, row: &'r Row, column: &str) -> Option<&'r Cell> {
        row.cells.get(self.index(column)?)
    }
}

/// Whether a line is blank or a comment.
fn is_skipped(line: &str) -> bool {
    line.starts_with('#') || line.trim_matches([' ', ';', ',', '\t']).is_empty()
}

/// Line of a record, from 1. The position that the reader gives is where it went on, before blank lines and comments.
fn line_of(text: &str, position: Option<&Position>) -> u64 {
    let Some(position) = position else { return 0 };
    let rest = text.get(position.byte() as usize..).unwrap_or("");
    let skipped = rest.lines().take_while(|line| line.is_empty() || line.starts_with('#'));
    position.line() + skipped.count() as u64
}

/// A row that is being read.
struct Reading<'t> {
    path: &'t Path,
    line: u64,
    header: &'t Header,
    columns: &'t [Column],
    /// Whether numbers may have a decimal comma.
    comma: bool,
}

impl Reading<'_> {
    fn row(&self, record: StringRecord, remarks: &mut Vec<Remark>) -> Result<Row, TableError> {
        let cells = self.whole(record, remarks)?;
        let cell_count = self.columns.len();
        let mut row =
            Row { line: self.line, cells: Vec::with_capacity(cell_count), further: Vec::new() };
        for (column, place) in self.columns.iter().zip(&self.header.places) {
            row.cells.push(match place {
                Some(place) => {
                    let text = cells.get(place.index).map_or("", String::as_str);
                    self.cell(column, place, text, remarks)?
                }
                None => Cell::Empty,
            });
        }
        for (index, _) in &self.header.further {
            let text = cells.get(*index).map_or("", String::as_str);
            let title = &self.header.titles[*index];
            row.further.push(match text.is_empty() {
                true => None,
                false => Some(self.number(title, text, remarks)?),
            });
        }
        Ok(row)
    }

    /// The cells, with an unquoted title that contains separators put together again.
    fn whole(
        &self,
        record: StringRecord,
        remarks: &mut Vec<Remark>,
    ) -> Result<Vec<String>, TableError> {
        let mut cells: Vec<String> = record.iter().map(str::to_owned).collect();
        let titles = &self.header.titles;
        while cells.len() > titles.len() && cells.last().is_some_and(String::is_empty) {
            cells.pop();
        }
        let excess = cells.len().saturating_sub(titles.len());
        if excess == 0 {
            return Ok(cells);
        }
        let is_title = |(column, _): &(&Column, &Option<Place>)| column.content == Content::Title;
        let title = self.columns.iter().zip(&self.header.places).find(is_title);
        // A title goes on after its comma with a letter, a decimal comma with a digit.
        let starts_a_word = |cell: &String| cell.starts_with(|c: char| c.is_alphabetic());
        match title.and_then(|(_, place)| place.as_ref()).map(|place| place.index) {
            Some(at) if cells[at + 1..=at + excess].iter().all(starts_a_word) => {
                let joined = cells.drain(at..=at + excess).collect::<Vec<_>>().join(", ");
                cells.insert(at, joined);
                self.once(
                    remarks,
                    &titles[at],
                    "titles with commas and without quotes put together",
                );
                Ok(cells)
            }
            _ => Err(TableError::TooLong {
                path: self.path.to_owned(),
                line: self.line,
                cells: cells.len(),
                titles: titles.len(),
                last: titles.last().cloned().unwrap_or_default(),
                remedy: "put texts with separators into quotes; with decimal commas separate columns by `;`",
            }),
        }
    }

    fn cell(
        &self,
        column: &Column,
        place: &Place,
        text: &str,
        remarks: &mut Vec<Remark>,
    ) -> Result<Cell, TableError> {
        let title = &self.header.titles[place.index];
        let refuse = |allowed: &str| TableError::value(self.path, self.line, title, text, allowed);
        match column.content {
            _ if text.is_empty() && !column.required => Ok(Cell::Empty),
            Content::Text | Content::Title if text.is_empty() => Err(refuse("a text")),
            Content::Text | Content::Title => Ok(Cell::Text(text.to_owned())),
            Content::Choice(words) => {
                let word = words.iter().find(|word| word.eq_ignore_ascii_case(text));
                let word = word.ok_or_else(|| {
                    let hint = did_you_mean(text, words.iter().copied());
                    refuse(&format!("{}{hint}", words.join(", ")))
                })?;
                Ok(Cell::Text((*word).to_owned()))
            }
            Content::Count(least, most) => {
                let count = count(text, self.comma).filter(|n| (least..=most).contains(n));
                let allowed = || refuse(&format!("a whole number from {least} to {most}"));
                Ok(Cell::Count(count.ok_or_else(allowed)?))
            }
            Content::Number(_) => {
                let number = self.number(title, text, remarks)?;
                let number = number * place.factor;
                if !number.is_finite() {
                    return Err(refuse("a finite number, also in the unit of the column"));
                }
                Ok(Cell::Number(number))
            }
        }
    }

    /// The number of a cell in the unit that it is written in.
    fn number(
        &self,
        title: &str,
        text: &str,
        remarks: &mut Vec<Remark>,
    ) -> Result<f64, TableError> {
        let (number, has_comma) = number(text, self.comma).ok_or_else(|| {
            let allowed = match text.contains(',') {
                true => "a finite number, with one decimal comma only where columns are separated by `;` or tabs",
                false => "a finite number",
            };
            TableError::value(self.path, self.line, title, text, allowed)
        })?;
        if has_comma {
            self.once(remarks, title, "decimal commas read");
        }
        Ok(number)
    }

    /// A remark, at the first row that gives occasion to it.
    fn once(&self, remarks: &mut Vec<Remark>, column: &str, text: &str) {
        let is_said = |remark: &Remark| remark.columns == [column] && remark.text == text;
        if !remarks.iter().any(is_said) {
            remarks.push(Remark {
                path: self.path.to_owned(),
                line: self.line,
                columns: vec![column.to_owned()],
                text: text.to_owned(),
            });
        }
    }
}
