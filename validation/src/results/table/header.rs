//! The line of titles: what separates columns, and which column is where.

use std::path::Path;

use super::column::{Column, Content};
use super::error::TableError;
use super::remark::Remark;
use crate::nearest::did_you_mean;

/// Where the columns asked for stand.
pub(super) struct Header {
    /// Line, from 1.
    pub(super) line: u64,
    /// Titles as written.
    pub(super) titles: Vec<String>,
    /// Of every column asked for, its place and unit.
    pub(super) places: Vec<Option<Place>>,
    /// Numbers of further columns in the file, from 0, and their titles in lower case with words joined by `_`.
    pub(super) further: Vec<(usize, String)>,
}

/// Where a column stands, and in which unit.
#[derive(Clone)]
pub(super) struct Place {
    /// Number of the column in the file, from 0.
    pub(super) index: usize,
    /// Unit that the title ends in.
    pub(super) unit: &'static str,
    /// By what its numbers are multiplied.
    pub(super) factor: f64,
}

/// What separates the columns of a line of titles. `;` leaves the numbers of a single column their decimal commas.
pub(in crate::results) fn separator(titles: &str) -> u8 {
    let mut quoted = false;
    let mut found = b';';
    for byte in titles.bytes() {
        match byte {
            b'"' => quoted = !quoted,
            b'\t' | b';' if !quoted => return byte,
            b',' if !quoted => found = b',',
            _ => {}
        }
    }
    found
}

/// `Frequency [kHz]` as `frequency_khz`.
fn plain(title: &str) -> String {
    let lower = title.to_lowercase().replace(['μ', 'µ'], "u").replace('°', "deg");
    let words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("_")
}

/// The unit with which a title is this column; `None` if it is another.
fn unit_of(column: &Column, title: &str) -> Option<(&'static str, f64)> {
    let Content::Number(quantity) = column.content else {
        return column.stems().any(|stem| stem == title).then_some(("", 1.0));
    };
    let units = quantity.units();
    let fits = |(unit, _): &&(&'static str, f64)| {
        column.stems().any(|stem| match unit.is_empty() {
            true => title == stem,
            false => title.strip_prefix(stem).and_then(|end| end.strip_prefix('_')) == Some(unit),
        })
    };
    units.iter().find(fits).copied()
}

impl Header {
    /// Finds the columns among the titles.
    ///
    /// # Errors
    /// [`TableError`] if one is there twice, or one that is required is not there.
    pub(super) fn read(
        path: &Path,
        line: u64,
        titles: Vec<String>,
        columns: &[Column],
        is_further: fn(&str) -> bool,
    ) -> Result<Self, TableError> {
        let named: Vec<String> = titles.iter().map(|title| plain(title)).collect();
        let mut places = Vec::with_capacity(columns.len());
        for column in columns {
            let found = named.iter().enumerate().filter_map(|(index, title)| {
                unit_of(column, title).map(|(unit, factor)| Place { index, unit, factor })
            });
            let found: Vec<Place> = found.collect();
            if let [first, second, ..] = found.as_slice() {
                return Err(TableError::Twice {
                    path: path.to_owned(),
                    line,
                    first: titles[first.index].clone(),
                    second: titles[second.index].clone(),
                    column: column.name.into(),
                });
            }
            if found.is_empty() && column.required {
                let remedy = absent(column, &titles, &named);
                return Err(TableError::Absent {
                    path: path.to_owned(),
                    line,
                    column: column.name,
                    remedy,
                });
            }
            places.push(found.into_iter().next());
        }
        let mut further: Vec<(usize, String)> = Vec::new();
        for (index, name) in named.into_iter().enumerate().filter(|(_, name)| is_further(name)) {
            if let Some((other, _)) = further.iter().find(|(_, known)| *known == name) {
                let (first, second) = (titles[*other].clone(), titles[index].clone());
                return Err(TableError::Twice {
                    path: path.to_owned(),
                    line,
                    first,
                    second,
                    column: name.into(),
                });
            }
            further.push((index, name));
        }
        Ok(Self { line, titles, places, further })
    }

    /// What was converted, and what is kept aside.
    pub(super) fn remarks(&self, path: &Path, columns: &[Column]) -> Vec<Remark> {
        let remark = |columns: Vec<String>, text: String| Remark {
            path: path.to_owned(),
            line: self.line,
            columns,
            text,
        };
        let mut remarks = Vec::new();
        for (column, place) in columns.iter().zip(&self.places) {
            if let Some(Place { index, factor, .. }) = place
                && *factor != 1.0
            {
                let text = format!("read as `{}`, numbers times {}", column.name, shown(*factor));
                remarks.push(remark(vec![self.titles[*index].clone()], text));
            }
        }
        let is_read = |index: usize| self.places.iter().flatten().any(|place| place.index == index);
        let is_further = |index: usize| self.further.iter().any(|(further, _)| *further == index);
        let extra: Vec<String> = (0..self.titles.len())
            .filter(|index| !is_read(*index) && !is_further(*index))
            .filter(|index| !self.titles[*index].is_empty())
            .map(|index| self.titles[index].clone())
            .collect();
        if !extra.is_empty() {
            let absent = columns.iter().zip(&self.places).filter(|(_, place)| place.is_none());
            let names: Vec<&str> = absent.map(|(column, _)| column.name).collect();
            let near = extra.iter().find_map(|title| {
                let hint = did_you_mean(&plain(title), names.iter().copied());
                (!hint.is_empty()).then_some(hint)
            });
            let text = "kept aside, asked for by no check".to_owned() + &near.unwrap_or_default();
            remarks.push(remark(extra, text));
        }
        remarks
    }
}

/// A factor with up to seven digits.
fn shown(factor: f64) -> String {
    let rounded = format!("{factor:.6e}").parse().unwrap_or(factor);
    format!("{rounded}")
}

/// What to do about a column that is not there.
fn absent(column: &Column, titles: &[String], named: &[String]) -> String {
    let names = match column.content {
        Content::Number(quantity) => {
            let with_unit = |stem: &str| {
                let units = quantity.units();
                let name = |unit: &str| format!("{stem}_{unit}").trim_end_matches('_').to_owned();
                units.iter().map(|(unit, _)| name(unit)).collect::<Vec<_>>()
            };
            column.stems().flat_map(with_unit).collect::<Vec<_>>()
        }
        _ => vec![column.name.to_owned()],
    };
    let is_number = |title: &String| title.parse::<f64>().is_ok();
    if titles.iter().any(is_number) {
        return format!("the first line must be titles, such as `{}`", column.name);
    }
    let near = named.iter().find_map(|title| {
        let hint = did_you_mean(title, names.iter().map(String::as_str));
        (!hint.is_empty()).then(|| format!("`{title}` is not known{hint} "))
    });
    format!("{}allowed are {}", near.unwrap_or_default(), names.join(", "))
}
