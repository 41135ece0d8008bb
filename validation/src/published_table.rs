//! Tables 2 and 3 of the paper: which set each is about.

use serde::Serialize;

use crate::catalogue::PublishedScene;
use crate::reference::{ModeTable, Reference};

/// A table of natural frequencies in Parker, Agashe & Vijayakar (2000).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Table {
    /// Three planets.
    Two,
    /// Four planets.
    Three,
}

impl Table {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Two, Self::Three];

    /// Number in the paper.
    pub fn number(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }

    /// Number of planets in words.
    pub fn planets(self) -> &'static str {
        match self {
            Self::Two => "three",
            Self::Three => "four",
        }
    }

    /// Its scene with consistent geometry.
    pub fn consistent(self) -> PublishedScene {
        match self {
            Self::Two => PublishedScene::Oh58ThreePlanets,
            Self::Three => PublishedScene::Oh58FourPlanets,
        }
    }

    /// The table of a set of so many planets.
    pub(crate) fn of_planets(count: usize) -> Self {
        if count == 3 { Self::Two } else { Self::Three }
    }

    /// Its lumped scene as published.
    pub fn as_published(self) -> PublishedScene {
        match self {
            Self::Two => PublishedScene::Oh58ThreePlanetsAsPublished,
            Self::Three => PublishedScene::Oh58FourPlanetsAsPublished,
        }
    }

    /// What is printed.
    pub fn printed(self, reference: &Reference) -> &ModeTable {
        match self {
            Self::Two => &reference.parker.table2,
            Self::Three => &reference.parker.table3,
        }
    }
}
