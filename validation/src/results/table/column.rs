//! What a column is called and may hold.

use super::unit::Quantity;

/// A column that a reader asks a table for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Name with the unit, as documentation calls it: `frequency_hz`.
    pub name: &'static str,
    /// Other names of the quantity, without a unit: `omega`.
    pub aliases: &'static [&'static str],
    /// What its cells may hold.
    pub content: Content,
    /// Whether the table and every row must have it.
    pub required: bool,
}

/// What cells of a column may hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Content {
    /// Any text.
    Text,
    /// The text of the one column whose cells may contain separators without being quoted.
    Title,
    /// One of these words, in any case.
    Choice(&'static [&'static str]),
    /// A whole number from the first to the second, both allowed.
    Count(usize, usize),
    /// A finite number, with the unit that the title ends in.
    Number(Quantity),
}

impl Column {
    /// A column that must be there.
    pub const fn required(name: &'static str, content: Content) -> Self {
        Self { name, aliases: &[], content, required: true }
    }

    /// A column that may be absent, as may its cells.
    pub const fn optional(name: &'static str, content: Content) -> Self {
        Self { name, aliases: &[], content, required: false }
    }

    /// The same with other names of the quantity.
    pub const fn or_called(self, aliases: &'static [&'static str]) -> Self {
        Self { aliases, ..self }
    }

    /// Names of the quantity without its unit: of the column, then the aliases.
    pub(super) fn stems(&self) -> impl Iterator<Item = &'static str> {
        let stem = match self.content {
            Content::Number(quantity) => quantity.stem(self.name),
            _ => self.name,
        };
        std::iter::once(stem).chain(self.aliases.iter().copied())
    }
}
