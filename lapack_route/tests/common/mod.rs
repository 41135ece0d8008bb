//! Scenes: the published ones, and random ones from a fixed seed.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use gearset::PlanetPositions;
use scene::{Freedom, PerBody, PerMesh, PlanetOverride, Scene, Support, Torsional};

/// A file of the project.
pub fn project_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

/// A scene of the project's `scenes/` folder.
pub fn scene(name: &str) -> Scene {
    Scene::from_file(&project_file(&format!("scenes/{name}.toml"))).unwrap()
}

/// Pseudo-random numbers from a seed, the same on every machine: SplitMix64 (Steele, Lea & Flood 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in the logarithm.
    fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    fn mass(&mut self) -> f64 {
        self.log_between(0.05, 20.0)
    }

    fn stiffness(&mut self) -> f64 {
        self.log_between(1e6, 1e9)
    }

    fn masses(&mut self) -> PerBody {
        PerBody {
            carrier: Some(self.mass()),
            ring: Some(self.mass()),
            sun: Some(self.mass()),
            planet: Some(self.mass()),
        }
    }

    fn support(&mut self) -> Support {
        let motion = match self.below(4) {
            0 => Freedom::RotationHeld,
            1 => Freedom::Held,
            _ => Freedom::Free,
        };
        // Some members have no bearing, some no torsional support.
        let bearing = if self.one_in(4) { 0.0 } else { self.stiffness() };
        let torsional = if self.one_in(2) { 0.0 } else { self.stiffness() };
        Support { motion, bearing_n_per_m: bearing, torsional: Torsional::PerLength(torsional) }
    }

    /// Planet 0 at zero, the others at random but distinct positions.
    fn positions(&mut self) -> PlanetPositions {
        let count = 1 + self.below(12) as usize;
        if self.one_in(3) {
            return PlanetPositions::equally_spaced(count);
        }
        // Each in a sector of its own, so that no two coincide.
        let sector = TAU / count as f64;
        let off = |random: &mut Self, n: usize| match n {
            0 => 0.0,
            _ => sector * random.between(-0.4, 0.4),
        };
        let psi_rad = (0..count).map(|n| n as f64 * sector + off(self, n)).collect();
        PlanetPositions { psi_rad, steps: None }
    }

    fn planet_override(&mut self, planet: usize) -> PlanetOverride {
        let mut maybe = |value: fn(&mut Self) -> f64| {
            let value = value(self);
            self.one_in(2).then_some(value)
        };
        PlanetOverride {
            planet,
            mass_kg: maybe(Self::mass),
            inertia_over_r2_kg: maybe(Self::mass),
            bearing_n_per_m: maybe(Self::stiffness),
            sun_mesh_n_per_m: maybe(Self::stiffness),
            ring_mesh_n_per_m: maybe(Self::stiffness),
        }
    }

    /// A parameter-only set with everything the lumped model reads drawn at random.
    pub fn scene(&mut self, base: &Scene) -> Scene {
        let mut scene = base.clone();
        scene.planets = self.positions();
        scene.supports.carrier = self.support();
        scene.supports.ring = self.support();
        scene.supports.sun = self.support();
        scene.supports.planet_bearing_n_per_m = self.stiffness();
        let lumped = scene.lumped.as_mut().unwrap();
        lumped.mass_kg = self.masses();
        lumped.inertia_over_r2_kg = self.masses();
        lumped.mesh_n_per_m =
            PerMesh { sun_planet: self.stiffness(), ring_planet: self.stiffness() };
        let angle = |random: &mut Self| random.between(10.0, 35.0).to_radians();
        lumped.pressure_angle_rad = PerMesh { sun_planet: angle(self), ring_planet: angle(self) };
        for planet in 0..scene.planets.count() {
            if self.one_in(4) {
                scene.overrides.push(self.planet_override(planet));
            }
        }
        scene
    }
}
