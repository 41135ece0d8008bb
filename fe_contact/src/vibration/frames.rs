//! The frames of a mesh cycle that were built so far.

use super::frame::Frame;

/// Frames by step in the cycle.
#[derive(Debug)]
pub(super) struct Frames {
    plain: Vec<Option<Box<Frame>>>,
    with_backside: Vec<Option<Box<Frame>>>,
    /// By step in the cycle: whether backside flanks took part when it was last visited.
    pub(super) touched_backside: Vec<bool>,
}

impl Frames {
    /// No frames yet, for a cycle of `count` steps.
    pub(super) fn new(count: usize) -> Self {
        let none = || (0..count).map(|_| None).collect();
        Self { plain: none(), with_backside: none(), touched_backside: vec![false; count] }
    }

    fn list(&mut self, with_backside: bool) -> &mut Vec<Option<Box<Frame>>> {
        if with_backside { &mut self.with_backside } else { &mut self.plain }
    }

    /// Takes a frame out, to be put back.
    pub(super) fn take(&mut self, step_in_cycle: usize, with_backside: bool) -> Option<Box<Frame>> {
        self.list(with_backside)[step_in_cycle].take()
    }

    pub(super) fn put_back(
        &mut self,
        step_in_cycle: usize,
        frame: Box<Frame>,
        with_backside: bool,
    ) {
        self.list(with_backside)[step_in_cycle] = Some(frame);
    }

    /// The frame of a step without backside flanks.
    pub(super) fn at(&self, step_in_cycle: usize) -> Option<&Frame> {
        self.plain[step_in_cycle].as_deref()
    }

    /// The frame of the last step that ended at `step_in_cycle`.
    pub(super) fn current(&self, step_in_cycle: usize) -> Option<&Frame> {
        let list =
            if self.touched_backside[step_in_cycle] { &self.with_backside } else { &self.plain };
        list[step_in_cycle].as_deref()
    }

    /// Memory, bytes.
    pub(super) fn bytes(&self) -> usize {
        self.plain.iter().chain(&self.with_backside).flatten().map(|frame| frame.bytes()).sum()
    }
}
