//! Finished points of a sweep in a folder.

use experiments::sweep::{Chain, Kept, PointStore, StoreError};

use super::kept_files::KeptFiles;

/// A folder of points.
#[derive(Debug)]
pub(super) struct Points(pub(super) KeptFiles);

impl PointStore for Points {
    fn load(&self, chain: &Chain, index: usize) -> Result<Option<Kept>, StoreError> {
        self.0.load(&chain.name, index)
    }

    fn save(&self, chain: &Chain, index: usize, kept: &Kept) -> Result<(), StoreError> {
        self.0.save(&chain.name, index, kept)
    }
}
