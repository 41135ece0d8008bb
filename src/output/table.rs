//! One table for every output: text, CSV and Parquet from one list of columns.

use std::io::Write;

use comfy_table::{CellAlignment, LineStyle, TableStyle};

use super::column::{Cell, Column, Kind, Look, Notation, Shown, Value};
use super::wrapped::WIDTH;
use crate::error::Result;

/// A rule under the header, one at the end, nothing else.
const RULED: TableStyle = TableStyle::new()
    .header_separator(LineStyle::none().fill('─').junction('─'))
    .bottom_border(LineStyle::none().fill('─').junction('─'));

/// Characters between the contents of two cells.
const PADDING: usize = 2;

/// A table of rows `R`, column by column: `.column(…)` or `.words(…)` adds one, what follows is said of it.
pub(crate) struct Table<'t, R> {
    columns: Vec<Column<'t, R>>,
}

/// How a table is laid out.
impl<'t, R> Table<'t, R> {
    pub(crate) fn new() -> Self {
        Self { columns: Vec::new() }
    }

    /// A column of files, by its name; `meaning`: what it is, with its unit, where the name does not say it.
    pub(crate) fn column<V: Value>(
        mut self,
        name: &'static str,
        meaning: &'static str,
        value: impl Fn(&R) -> V + 't,
    ) -> Self {
        let cell = Box::new(move |row: &R| value(row).cell());
        self.columns.push(Column { name: Some(name), meaning, kind: V::KIND, cell, shown: None });
        self
    }

    /// A column of text alone.
    pub(crate) fn words<V: Value>(
        self,
        heading: impl Into<String>,
        notation: Notation,
        value: impl Fn(&R) -> V + 't,
    ) -> Self {
        self.column("", "", value).last(|column| column.name = None).shown(heading, notation)
    }

    /// What the column is, as the legend says it.
    pub(crate) fn meaning(self, meaning: &'static str) -> Self {
        self.last(|column| column.meaning = meaning)
    }

    /// The column stands in text too, below a heading.
    pub(crate) fn shown(self, heading: impl Into<String>, notation: Notation) -> Self {
        self.scaled(heading, 1.0, notation)
    }

    /// The same if this table has anything to show there.
    pub(crate) fn shown_if(self, is_shown: bool, heading: &str, notation: Notation) -> Self {
        if is_shown { self.shown(heading, notation) } else { self }
    }

    /// The column stands in text too, its numbers multiplied by a factor.
    pub(crate) fn scaled(
        self,
        heading: impl Into<String>,
        factor: f64,
        notation: Notation,
    ) -> Self {
        self.headed(heading.into(), Look::Cell(factor, notation))
    }

    /// The column stands in text too, in words made of the row.
    pub(crate) fn shown_as(
        self,
        heading: impl Into<String>,
        words: impl Fn(&R) -> String + 't,
    ) -> Self {
        self.headed(heading.into(), Look::Words(Box::new(words)))
    }

    /// Text aligns the column right, where it is not of numbers.
    pub(crate) fn right(self) -> Self {
        self.last(|column| column.shown.iter_mut().for_each(|shown| shown.is_right = true))
    }

    /// Text repeats the column where the table is too wide for one block.
    pub(crate) fn key(self) -> Self {
        self.last(|column| column.shown.iter_mut().for_each(|shown| shown.is_key = true))
    }

    fn headed(self, heading: String, look: Look<'t, R>) -> Self {
        self.last(|column| {
            let is_right = matches!(column.kind, Kind::Number | Kind::Count);
            column.shown = Some(Shown { heading, is_right, is_key: false, look });
        })
    }

    fn last(mut self, change: impl FnOnce(&mut Column<'t, R>)) -> Self {
        if let Some(column) = self.columns.last_mut() {
            change(column);
        }
        self
    }
}

/// How it is written.
impl<'t, R> Table<'t, R> {
    /// Writes rows for people: in one block, or in several of at most [`WIDTH`] characters.
    pub(crate) fn text(
        &self,
        rows: impl IntoIterator<Item = R>,
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        let shown = || self.columns.iter().filter_map(|c| Some((c, c.shown.as_ref()?)));
        let rows = rows.into_iter().map(|row| shown().map(|(c, s)| c.words(s, &row)).collect());
        let rows: Vec<Vec<String>> = rows.collect();
        let heads: Vec<_> = shown().map(|(_, shown)| shown).collect();
        let width = |i: usize| {
            let cells = rows.iter().map(|row| row[i].as_str()).chain([heads[i].heading.as_str()]);
            PADDING + cells.map(|text| text.chars().count()).max().unwrap_or(0)
        };
        let (keys, others): (Vec<usize>, Vec<usize>) =
            (0..heads.len()).partition(|i| heads[*i].is_key);
        let of_keys: usize = keys.iter().map(|i| width(*i)).sum();
        let mut blocks: Vec<Vec<usize>> = vec![keys.clone()];
        let mut used = of_keys;
        for i in others {
            if used + width(i) > WIDTH && used > of_keys {
                blocks.push(keys.clone());
                used = of_keys;
            }
            used += width(i);
            if let Some(block) = blocks.last_mut() {
                block.push(i);
            }
        }
        for block in &mut blocks {
            // Keys stand where they are declared.
            block.sort_unstable();
            let mut table = comfy_table::Table::new();
            table.load_style(RULED).set_header(block.iter().map(|i| &heads[*i].heading));
            for (column, i) in table.column_iter_mut().zip(block.iter()) {
                column.set_padding((0, 1));
                if heads[*i].is_right {
                    column.set_cell_alignment(CellAlignment::Right);
                }
            }
            table.add_rows(rows.iter().map(|row| block.iter().map(|i| &row[*i])));
            writeln!(out, "{table}")?;
        }
        Ok(())
    }

    /// Writes below a table for people what its columns are.
    pub(crate) fn legend(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let shown = self.columns.iter().filter_map(|c| Some((c.meaning, c.shown.as_ref()?)));
        let mut said = shown.filter(|(meaning, _)| !meaning.is_empty());
        said.try_for_each(|(meaning, shown)| writeln!(out, "{}: {meaning}", shown.heading))
    }

    /// Writes rows as CSV: numbers in the shortest form that reads as the same number, text that a spreadsheet
    /// would take for a formula behind an apostrophe.
    pub(crate) fn csv(&self, rows: impl IntoIterator<Item = R>, out: &mut dyn Write) -> Result<()> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_record(self.named().map(|(name, _)| name))?;
        for row in rows {
            let cell = |(_, column): (_, &Column<'t, R>)| (column.cell)(&row).no_formula();
            let cells: Vec<Cell> = self.named().map(cell).collect();
            writer.serialize(cells)?;
        }
        Ok(writer.flush()?)
    }

    /// Name and meaning of every column of files.
    pub(crate) fn list(&self) -> Vec<(&'static str, &'static str)> {
        self.named().map(|(name, column)| (name, column.meaning)).collect()
    }

    /// Columns that stand in files.
    pub(super) fn named(&self) -> impl Iterator<Item = (&'static str, &Column<'t, R>)> {
        self.columns.iter().filter_map(|column| Some((column.name?, column)))
    }
}
