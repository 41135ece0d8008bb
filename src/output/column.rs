//! Columns of a table: what each holds of a row, its name in files, and its heading in text.

use serde::Serialize;

/// What a table holds of a row in one column.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Cell {
    Words(String),
    Number(f64),
    Count(i64),
    Flag(bool),
    Nothing,
}

impl Cell {
    /// The same, with an apostrophe before words that begin as a formula of a spreadsheet does and are no numbers.
    pub(super) fn no_formula(self) -> Self {
        match self {
            Self::Words(text)
                if text.starts_with(['=', '+', '-', '@', '\t', '\r'])
                    && !text.split_whitespace().all(|part| part.parse::<f64>().is_ok()) =>
            {
                Self::Words(format!("'{text}"))
            }
            other => other,
        }
    }
}

/// Kind of the cells of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Words,
    Number,
    Count,
    Flag,
}

/// What a column can be made of.
pub(crate) trait Value {
    const KIND: Kind;
    fn cell(self) -> Cell;
}

macro_rules! values {
    ($($type:ty => $kind:ident, $value:ident $cell:expr;)*) => {
        $(impl Value for $type {
            const KIND: Kind = Kind::$kind;
            fn cell(self) -> Cell {
                let $value = self;
                Cell::$kind($cell)
            }
        })*
    };
}

values! {
    f64 => Number, x x;
    i64 => Count, n n;
    u32 => Count, n n.into();
    usize => Count, n n as i64;
    bool => Flag, is is;
    String => Words, text text;
    &String => Words, text text.clone();
    &str => Words, text text.to_owned();
}

impl<V: Value> Value for Option<V> {
    const KIND: Kind = V::KIND;
    fn cell(self) -> Cell {
        self.map_or(Cell::Nothing, V::cell)
    }
}

/// How text shows a cell; `–` stands for nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Notation {
    /// As it is: whole numbers, words.
    Plain,
    /// So many decimals.
    Fixed(usize),
    /// So many decimals, with a sign.
    Signed(usize),
    /// So many decimals before a power of ten.
    Power(usize),
    /// Three decimals; `–` where they would show 0.
    Share,
    /// Six digits; powers of ten where a number is very small or large.
    Digits,
}

impl Notation {
    pub(crate) fn number(self, x: f64) -> String {
        match self {
            Self::Plain => x.to_string(),
            Self::Fixed(decimals) => format!("{x:.decimals$}"),
            Self::Signed(decimals) => format!("{x:+.decimals$}"),
            Self::Power(decimals) => format!("{x:.decimals$e}"),
            Self::Share if x < 5e-4 => "–".into(),
            Self::Share => format!("{x:.3}"),
            Self::Digits => match x.abs() {
                0.0 => "0".into(),
                size if !(1e-3..1e6).contains(&size) => format!("{x:.4e}"),
                size => {
                    let before = size.log10().floor().max(0.0) as usize;
                    format!("{x:.*}", 5usize.saturating_sub(before))
                }
            },
        }
    }

    /// A cell; `factor` on numbers.
    fn cell(self, cell: &Cell, factor: f64) -> String {
        match cell {
            Cell::Words(text) => text.clone(),
            Cell::Number(x) => self.number(factor * x),
            Cell::Count(n) => n.to_string(),
            Cell::Flag(is) => if *is { "yes" } else { "no" }.into(),
            Cell::Nothing => "–".into(),
        }
    }
}

/// One column of rows `R`.
pub(super) struct Column<'t, R> {
    /// In files; `None` for a column of text alone.
    pub(super) name: Option<&'static str>,
    /// What it is, with its unit, as legends say it; empty where the heading says all.
    pub(super) meaning: &'static str,
    pub(super) kind: Kind,
    pub(super) cell: Box<dyn Fn(&R) -> Cell + 't>,
    pub(super) shown: Option<Shown<'t, R>>,
}

/// How a column stands in text.
pub(super) struct Shown<'t, R> {
    pub(super) heading: String,
    pub(super) is_right: bool,
    /// Whether it is repeated where a table is too wide for one block.
    pub(super) is_key: bool,
    pub(super) look: Look<'t, R>,
}

pub(super) enum Look<'t, R> {
    /// The cell, a number times a factor.
    Cell(f64, Notation),
    Words(Box<dyn Fn(&R) -> String + 't>),
}

impl<'t, R> Column<'t, R> {
    /// What text shows of a row.
    pub(super) fn words(&self, shown: &Shown<'t, R>, row: &R) -> String {
        match &shown.look {
            Look::Cell(factor, notation) => notation.cell(&(self.cell)(row), *factor),
            Look::Words(words) => words(row),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Text that a spreadsheet would compute is text; numbers stay what they are.
    #[test]
    fn formulas_are_text_and_numbers_are_numbers() {
        for formula in ["=1+1", "+cmd|'/C calc'!A0", "-2+3+cmd", "@SUM(A1)", "\t=1", "-"] {
            let expected = Cell::Words(format!("'{formula}"));
            assert_eq!(Cell::Words(formula.into()).no_formula(), expected);
        }
        for text in ["-0.5", "-0.5 +3e-4", "a set = b", "", "–", "(-1)"] {
            assert_eq!(Cell::Words(text.into()).no_formula(), Cell::Words(text.into()));
        }
        for cell in [Cell::Number(-1.5), Cell::Count(-2), Cell::Flag(true), Cell::Nothing] {
            assert_eq!(cell.clone().no_formula(), cell);
        }
    }
}
