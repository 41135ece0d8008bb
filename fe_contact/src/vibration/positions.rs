//! Frames of a set, built at the first visit of a position.

use std::sync::Arc;

use super::frame::{Frame, FrameInputs};
use super::frame_pattern::FramePattern;
use super::rotation::NominalRotation;
use super::set::VibratingSet;
use crate::error::FeError;

impl VibratingSet<'_> {
    /// The frame of the current step, built if it does not exist yet.
    pub(super) fn take_frame(&mut self, with_backside: bool) -> Result<Box<Frame>, FeError> {
        let k = self.clock.step_in_cycle;
        if let Some(mut frame) = self.frames.take(k, with_backside) {
            if self.statics.has_tooth_errors() {
                self.renew_offsets(&mut frame);
            }
            return Ok(frame);
        }
        let position = self.clock.position(k);
        let turned = match self.clock.rotation {
            NominalRotation::Standing { .. } => 0.0,
            NominalRotation::Turning { .. } => position,
        };
        let make = || self.pattern(k, with_backside, turned);
        let pattern = Arc::clone(&self.patterns).at(k, with_backside, make)?;
        let front = self.statics.reference().meshes.len();
        let mut places: Vec<usize> =
            (0..front).map(|m| self.statics.place_of(&self.contact.tables, m, position)).collect();
        places.extend(pattern.backside.iter().map(|table| self.contact.add(Arc::clone(table))));
        let inputs = FrameInputs {
            statics: &self.statics,
            gears: &self.bodies.gears,
            lag_end: self.pairs.lag.end,
        };
        let mut frame = Box::new(Frame::new(&inputs, pattern, &places, turned)?);
        if self.statics.has_tooth_errors() {
            self.renew_offsets(&mut frame);
        }
        Ok(frame)
    }

    /// The pattern of a step without backside flanks.
    pub(super) fn shared_pattern(&self, k: usize) -> Result<Arc<FramePattern>, FeError> {
        let turned = self.clock.position(k);
        Arc::clone(&self.patterns).at(k, false, || self.pattern(k, false, turned))
    }

    /// The pattern of a step.
    fn pattern(&self, k: usize, with_backside: bool, turned: f64) -> Result<FramePattern, FeError> {
        let position = self.clock.position(k);
        let mut placed = self.statics.place(position, &self.contact.tables);
        let front = placed.len();
        if let Some(leaning) = self.contact.leaning.get(k) {
            leaning.apply(&self.statics, &mut placed);
        }
        if with_backside {
            placed.extend(self.statics.place_backside(position, &self.contact.tables.settings)?);
        }
        FramePattern::new(&self.statics, &self.bodies.gears, placed, front, turned)
    }

    /// Sets the gap offsets to those of the teeth that are in mesh now.
    fn renew_offsets(&self, frame: &mut Frame) {
        let turned = match self.clock.rotation {
            NominalRotation::Standing { .. } => self.clock.position(0),
            NominalRotation::Turning { .. } => self.clock.turned(),
        };
        for (which, mesh) in frame.meshes.iter().enumerate().take(self.pairs.memory.len()) {
            let table = &self.contact.tables.list[mesh.table];
            let own = mesh.first..mesh.first + mesh.count;
            let (offsets, perfect) = (&mut frame.offsets[own.clone()], &frame.pattern.perfect[own]);
            self.statics.write_errors(which, table, turned, offsets);
            offsets.iter_mut().zip(perfect).for_each(|(offset, perfect)| *offset += perfect);
        }
    }
}

#[cfg(test)]
mod tests {
    use gearset::{Facing, PathDirection};
    use scene::Scene;

    use super::super::prepared::Loading;
    use super::*;
    use crate::statics::{Bodies, Imperfections};

    /// A pair keeps its teeth from step to step, also when its number grows by one and when a cycle
    /// ends, and these teeth are where the turning gears have them.
    #[test]
    fn pairs_keep_their_teeth() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 8;
        let bodies = Bodies::new(&scene).unwrap();
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let rotation = NominalRotation::Turning {
            mesh_frequency: 500.0,
            steps_per_cycle: 28,
            direction: PathDirection::Forward,
        };
        let loading = Loading { torque_nm: 1130.0, mesh_force: 8000.0 };
        let mut set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
        set.rest(1130.0).unwrap();
        // (mesh, pair, phase, teeth in the bodies' own numbers) of all pairs at the present step.
        let seen = |set: &VibratingSet<'_>| {
            let frame = set.frames.current(set.clock.step_in_cycle).unwrap();
            let mut list = Vec::new();
            for (m, mesh) in frame.meshes.iter().enumerate() {
                let phase = set.statics.phase(m, set.clock.position(set.clock.step_in_cycle));
                let table = &set.contact.tables.list[mesh.table];
                for (k, pair) in table.pairs.iter().map(|p| p.index).enumerate() {
                    let at = mesh.first + k;
                    let (ends, teeth) = (frame.pattern.ends[at].as_ref(), frame.pattern.teeth[at]);
                    let teeth: Vec<i64> = ends
                        .unwrap()
                        .iter()
                        .zip(teeth.unwrap())
                        .map(|(end, tooth)| {
                            let gear = &set.bodies.gears[end.body.index() - 1];
                            let count = gear.body.mesh.outline.gear().teeth as i64;
                            // The tooth's axis must be a whole number of pitches from that of tooth
                            // 0.
                            let turned = set.clock.position(set.clock.step_in_cycle);
                            let pitch = gear.body.mesh.outline.gear().pitch_angle();
                            let exact = (end.axis - gear.angle(turned)) / pitch;
                            // Under load a planet is between the positions in which its two meshes
                            // just touch, half of their approaches from either: up to 20 µm at its
                            // base radius of 46 mm.
                            let apart = (exact - exact.round()).abs() * pitch;
                            assert!(apart < 20e-6 / 45.6e-3, "{exact}");
                            (tooth + gear.teeth_per_cycle() * set.clock.cycles).rem_euclid(count)
                        })
                        .collect();
                    list.push((m, pair, phase, teeth));
                }
            }
            list
        };
        let mut before = seen(&set);
        let mut kept = 0;
        for _ in 0..70 {
            set.step().unwrap();
            let now = seen(&set);
            for (mesh, pair, phase, teeth) in &now {
                let same = before.iter().find(|(m, p, earlier, _)| {
                    m == mesh && *p + i64::from(phase < earlier) == *pair
                });
                // Some pairs have just become candidates for contact and were none before.
                if let Some((_, _, _, earlier)) = same {
                    assert_eq!(earlier, teeth, "mesh {mesh}, pair {pair}, phase {phase}");
                    kept += 1;
                }
            }
            before = now;
        }
        assert!(kept > 70 * 8);
    }

    /// Contact maps that are replaced by others cost time, not accuracy. With three planets the
    /// meshes of a kind are in phase and share a table. The pin of one planet is displaced by so
    /// little that they still do, but they need different maps in the same step.
    #[test]
    fn few_maps_march_as_many_do() {
        for (name, most) in [("oh58_4p", 1), ("oh58_3p", 2)] {
            let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/");
            let mut scene = Scene::from_file(format!("{root}{name}.toml").as_ref()).unwrap();
            scene.fe_contact.flank_elements = 8;
            let bodies = Bodies::new(&scene).unwrap();
            let rotation = NominalRotation::Turning {
                mesh_frequency: 570.0,
                steps_per_cycle: 28,
                direction: PathDirection::Forward,
            };
            let march = |most: usize| {
                let displaced = Imperfections {
                    displaced_planets: vec![(0, 0.0, 12e-6)],
                    ..Imperfections::default()
                };
                let sense = Facing::CounterClockwise;
                let loading = Loading { torque_nm: 1130.0, mesh_force: 12000.0 };
                let mut set =
                    VibratingSet::new(&scene, &bodies, sense, displaced, rotation, loading)
                        .unwrap();
                set.contact.maps.iter_mut().for_each(|maps| maps.keep(most));
                set.rest(1130.0).unwrap();
                for _ in 0..6 * 28 {
                    set.step().unwrap();
                }
                (set.motion().x.clone(), set.contact_counts()[0])
            };
            let ((many, solved), (few, again)) = (march(64), march(most));
            assert!(again > solved, "{name}: nothing gave way: {again}, {solved} problems");
            let largest = many.iter().fold(0.0f64, |a, x| a.max(x.abs()));
            for (a, b) in many.iter().zip(&few) {
                assert!((a - b).abs() < 1e-9 * largest, "{name}: {a} {b}");
            }
        }
    }
}
