//! The bodies of a set with their elastic coordinates: carrier, ring, sun, planets.

use dynamics::Motion;
use gearset::Body;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::body::{Port, RaceMotion, VibratingBody};
use super::frame::Frame;
use super::gear::VibratingGear;
use super::race_motion::race_motion;
use super::teeth::fill_port;
use crate::statics::Races;

/// Degrees of freedom of all bodies together above which gears are computed in parallel.
const LARGE: usize = 10_000;

/// Ports of one gear and the force on each, N.
type Loads = (Vec<Port>, Vec<f64>);

/// All bodies of a set.
#[derive(Debug)]
pub(super) struct FlexibleBodies<'s> {
    pub(super) carrier: Box<dyn VibratingBody>,
    /// Ring, sun, planets.
    pub(super) gears: Vec<VibratingGear<'s>>,
    /// Whether gears are computed in parallel.
    is_large: bool,
    /// Motion of each gear's race at the start of the step, and the load on the race that the
    /// gear's prediction returns, N.
    started: Vec<(RaceMotion, [f64; 3])>,
    /// Ports and forces of each gear.
    pub(super) ports: Vec<Loads>,
}

impl<'s> FlexibleBodies<'s> {
    pub(super) fn new(carrier: Box<dyn VibratingBody>, gears: Vec<VibratingGear<'s>>) -> Self {
        let started = vec![Default::default(); gears.len()];
        let ports = gears.iter().map(|_| Default::default()).collect();
        let mut bodies = Self { carrier, gears, is_large: false, started, ports };
        bodies.is_large = bodies.unknowns() > LARGE;
        bodies
    }

    /// Degrees of freedom beside the races'.
    pub(super) fn unknowns(&self) -> usize {
        self.gears.iter().map(|g| g.vibrating.unknowns()).sum::<usize>() + self.carrier.unknowns()
    }

    /// All bodies in the set's order.
    pub(super) fn all(&self) -> impl Iterator<Item = (Body, &dyn VibratingBody)> {
        let gears = self.gears.iter().map(|gear| gear.vibrating.as_ref());
        Body::all(self.gears.len() - 2).zip(std::iter::once(self.carrier.as_ref()).chain(gears))
    }

    /// Starts the step of all bodies and adds their loads on the races to `load` (n, N). Large
    /// gears are computed in parallel, with bitwise the same result.
    pub(super) fn predict(
        &mut self,
        races: &Races,
        motion: &Motion,
        turned: f64,
        load: &mut DVector<f64>,
    ) {
        let own = self.carrier.predict(&race_motion(races, motion, Body::Carrier), 0.0);
        races.add(Body::Carrier, own, load.as_mut_slice());
        for (k, started) in self.started.iter_mut().enumerate() {
            started.0 = race_motion(races, motion, Body::from_index(k + 1));
        }
        let one = |(gear, (race, load)): (&mut VibratingGear<'_>, &mut (RaceMotion, [f64; 3]))| {
            let angle = gear.angle(turned);
            *load = gear.vibrating.predict(race, angle);
        };
        if self.is_large {
            self.gears.par_iter_mut().zip(&mut self.started).for_each(one);
        } else {
            self.gears.iter_mut().zip(&mut self.started).for_each(one);
        }
        for (k, (_, own)) in self.started.iter().enumerate() {
            races.add(Body::from_index(k + 1), *own, load.as_mut_slice());
        }
    }

    /// Ends the step of the gears with the races at x (n, m) under the forces of a frame's pairs (N).
    pub(super) fn finish_gears(
        &mut self,
        races: &Races,
        x: &DVector<f64>,
        turned: f64,
        frame: &Frame,
        forces: &DVector<f64>,
    ) {
        for ((ports, list), own) in self.ports.iter_mut().zip(&frame.pattern.own) {
            if !ports.is_empty() {
                list.clear();
                list.extend(own.iter().map(|(pair, _)| forces[*pair]));
            }
        }
        let one = |(k, (gear, loads)): (usize, (&mut VibratingGear<'_>, &Loads))| {
            let (ports, forces) = loads;
            if gear.vibrating.unknowns() > 0 {
                let angle = gear.angle(turned);
                let race = races.displaced(x, Body::from_index(k + 1));
                gear.vibrating.finish(race, angle, &ports[..forces.len()], forces);
            }
        };
        if self.is_large {
            self.gears.par_iter_mut().zip(&self.ports).enumerate().for_each(one);
        } else {
            self.gears.iter_mut().zip(&self.ports).enumerate().for_each(one);
        }
    }

    /// Puts the gears to rest under the forces p (N) of a frame's pairs, whose ports are filled.
    pub(super) fn rest_gears(&mut self, frame: &Frame, p: &DVector<f64>) {
        for ((gear, (ports, forces)), own) in
            self.gears.iter_mut().zip(&mut self.ports).zip(&frame.pattern.own)
        {
            if gear.vibrating.unknowns() == 0 {
                continue;
            }
            forces.clear();
            forces.extend(own.iter().map(|(pair, _)| p[*pair]));
            gear.vibrating.rest_under(&ports[..own.len()], forces);
        }
    }

    /// Sets the ports of all gears with elastic states, after `cycles` mesh cycles.
    pub(super) fn fill_ports(&mut self, frame: &Frame, cycles: i64) {
        for ((gear, own), (ports, _)) in
            self.gears.iter().zip(&frame.pattern.own).zip(&mut self.ports)
        {
            if gear.vibrating.unknowns() == 0 {
                continue;
            }
            while ports.len() < own.len() {
                ports.push(Port::default());
            }
            for (port, at) in ports.iter_mut().zip(own) {
                fill_one(port, frame, gear, *at, cycles);
            }
        }
    }

    /// Ports of one gear, its `own` (pair, end) of a frame, after `cycles` mesh cycles.
    pub(super) fn ports_of(
        frame: &Frame,
        gear: &VibratingGear<'_>,
        own: &[(usize, usize)],
        cycles: i64,
    ) -> Vec<Port> {
        let mut ports = vec![Port::default(); own.len()];
        for (port, at) in ports.iter_mut().zip(own) {
            fill_one(port, frame, gear, *at, cycles);
        }
        ports
    }

    /// Static flexibility between pairs that the bodies' elastic states represent, pairs×pairs,
    /// m/N.
    pub(super) fn carried(&self, frame: &Frame, cycles: i64) -> DMatrix<f64> {
        let count = frame.offsets.len();
        let mut carried = DMatrix::zeros(count, count);
        for (gear, own) in self.gears.iter().zip(&frame.pattern.own) {
            if gear.vibrating.unknowns() == 0 {
                continue;
            }
            let ports = Self::ports_of(frame, gear, own, cycles);
            let of_gear = gear.vibrating.carried_flexibility(&ports);
            for (i, (a, _)) in own.iter().enumerate() {
                for (j, (b, _)) in own.iter().enumerate() {
                    carried[(*a, *b)] += of_gear[i * own.len() + j];
                }
            }
        }
        carried
    }
}

fn fill_one(
    port: &mut Port,
    frame: &Frame,
    gear: &VibratingGear<'_>,
    at: (usize, usize),
    cycles: i64,
) {
    let (Some(ends), Some(teeth)) = (&frame.pattern.ends[at.0], &frame.pattern.teeth[at.0]) else {
        return;
    };
    let count = gear.body.mesh.outline.gear().teeth as i64;
    let tooth = teeth[at.1] + gear.teeth_per_cycle() * cycles;
    let tooth = tooth.rem_euclid(count) as usize;
    fill_port(port, (gear.body, &gear.unknown_of), &ends[at.1], tooth);
}
