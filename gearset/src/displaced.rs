//! A mesh of displaced gears: exact kinematics of two involutes at displacements of any size, with first and
//! second derivatives.
//!
//! The relative position of two rigid involute gears enters their contact through three quantities only: δ, σ
//! and a' ([`Mesh::displaced`]).
//!
//! δ is the approach along the actual line of action (the overlap of all pairs on the path). σ = s₁ − δ/2 is
//! the driver's roll length after each gear is turned back by half of δ, so that the flanks just touch. a'
//! determines the ends of the path. All quantities are in the mesh frame of [`Mesh`] (nominal line of centres
//! along x), with displacements (x, y, θ) of driver, then driven gear.

use crate::gear::Flank;
use crate::mesh::{Mesh, NoMesh};
use crate::mesh_kind::{MeshKind, MeshMember};

/// Displacements (x, y, m; θ, rad) of driver and driven in the nominal mesh frame.
pub type Displacements = [f64; 6];

/// Where the flanks of one pair may touch: on the path, or with the tip corner of one member on the
/// other's flank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PairLocation {
    /// On the path: flank on flank.
    Path,
    /// Beyond it: the tip corner of this member on the other's flank.
    Corner(MeshMember),
}

/// A mesh at displaced places of its gears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplacedMesh {
    /// Which mesh.
    pub kind: MeshKind,
    /// a', m.
    pub center_distance: f64,
    /// λ: direction of the planet from the central gear, less the nominal one, rad.
    pub line_of_centres: f64,
    /// α', rad.
    pub pressure_angle: f64,
    /// δ, positive into each other, m.
    pub approach: f64,
    /// s₁ of pair 0, m.
    pub driver_roll_length: f64,
    /// s₂ of pair 0, m.
    pub driven_roll_length: f64,
    base_radii: [f64; 2],
    base_pitch: f64,
    tip_roll_lengths: [f64; 2],
}

/// First derivatives with respect to the six displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshGradients {
    /// ∂δ, m/m and m/rad.
    pub approach: [f64; 6],
    /// ∂σ.
    pub roll_length: [f64; 6],
    /// ∂a'.
    pub center_distance: [f64; 6],
}

/// Second derivatives with respect to the six displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshHessians {
    /// ∂²δ, 1/m.
    pub approach: [[f64; 6]; 6],
    /// ∂²σ, 1/m.
    pub roll_length: [[f64; 6]; 6],
    /// ∂²a', 1/m.
    pub center_distance: [[f64; 6]; 6],
}

/// Derivatives of δ, s₁ or a' with respect to a' and λ; the centres enter only through these two.
#[derive(Clone, Copy)]
struct OfCentres {
    by_distance: f64,
    by_direction: f64,
    by_distance_twice: f64,
}

impl Mesh {
    /// The same gears at another centre distance a' (m), with the path, pressure angle and contact ratio that
    /// belong to it.
    ///
    /// # Errors
    /// If the base circles leave no operating angle at a'.
    pub fn at_center_distance(&self, center_distance: f64) -> Result<Self, NoMesh> {
        let (driver, driven) = (self.gear(MeshMember::Driver), self.gear(MeshMember::Driven));
        match self.kind {
            MeshKind::SunPlanet => Self::sun_planet(driver, driven, center_distance),
            MeshKind::RingPlanet => Self::ring_planet(driven, driver, center_distance),
        }
    }

    /// The mesh with its gears displaced from where their flanks just touch at `phase` (cycles).
    ///
    /// `[eq:displaced-mesh]` With D = c_planet − c_central, its length a' and direction λ, the sum (external) or
    /// difference (internal) R of the base radii, and the roll lengths s₁, s₂ of driver and driven gear, each from
    /// its own tangent point:
    /// ```text
    /// cos α' = R/a',   L = a' sin α' = √(a'² − R²),   σ = s₁ − δ/2;
    /// external: tangent points at λ − α' and λ + π − α',  δ = s₁ + s₂ − L;
    /// internal: tangent points at λ + α' on both gears,  δ = s₁ − s₂ + L.
    /// ```
    /// Source: derived here.
    /// Checked by: `gearset/tests/displaced.rs::clearances_are_those_of_displaced_polylines`.
    ///
    /// # Errors
    /// If the base circles leave no operating angle at the displaced centre distance.
    pub fn displaced(&self, phase: f64, x: &Displacements) -> Result<DisplacedMesh, NoMesh> {
        let roll_length = self.path_start + phase * self.base_pitch;
        let (driver, driven) = (self.gear(MeshMember::Driver), self.gear(MeshMember::Driven));
        let (r1, r2) = (driver.base_radius, driven.base_radius);
        // From the central gear to the planet.
        let (dx, dy, radii) = match self.kind {
            MeshKind::SunPlanet => (x[3] - x[0], x[4] - x[1], r1 + r2),
            MeshKind::RingPlanet => (x[0] - x[3], x[1] - x[4], r2 - r1),
        };
        let a = (self.center_distance + dx).hypot(dy);
        let line_of_centres = dy.atan2(self.center_distance + dx);
        let none = || NoMesh { kind: self.kind, least: radii };
        if a.is_nan() || a <= radii {
            return Err(none());
        }
        let reach = ((a - radii) * (a + radii)).sqrt();
        let pressure_angle = (reach / radii).atan();
        let opened = pressure_angle - self.pressure_angle;
        let mate = self.driven_roll_length(roll_length);
        let (driver_roll_length, driven_roll_length, approach) = match self.kind {
            MeshKind::SunPlanet => {
                let s1 = roll_length + r1 * (x[2] - line_of_centres + opened);
                let s2 = mate + r2 * (x[5] - line_of_centres + opened);
                (s1, s2, s1 + s2 - reach)
            }
            MeshKind::RingPlanet => {
                let s1 = roll_length + r1 * (line_of_centres + opened - x[2]);
                let s2 = mate + r2 * (line_of_centres + opened - x[5]);
                (s1, s2, s1 - s2 + reach)
            }
        };
        Ok(DisplacedMesh {
            kind: self.kind,
            center_distance: a,
            line_of_centres,
            pressure_angle,
            approach,
            driver_roll_length,
            driven_roll_length,
            base_radii: [r1, r2],
            base_pitch: self.base_pitch,
            tip_roll_lengths: [driver.tip_roll_length(), driven.tip_roll_length()],
        })
    }
}

impl DisplacedMesh {
    /// The same gears rolled on by `cycles` mesh cycles at unchanged approach.
    pub fn turned_by(&self, cycles: f64) -> Self {
        let along = cycles * self.base_pitch;
        let mate = match self.kind {
            MeshKind::SunPlanet => -along,
            MeshKind::RingPlanet => along,
        };
        Self {
            driver_roll_length: self.driver_roll_length + along,
            driven_roll_length: self.driven_roll_length + mate,
            ..*self
        }
    }

    /// L = a' sin α', m.
    fn reach(&self) -> f64 {
        self.center_distance * self.pressure_angle.sin()
    }

    /// R, m.
    fn radii(&self) -> f64 {
        let [r1, r2] = self.base_radii;
        match self.kind {
            MeshKind::SunPlanet => r1 + r2,
            MeshKind::RingPlanet => r2 - r1,
        }
    }

    /// σ: roll length of the driver once each gear is turned back by half the approach, m.
    pub fn touching_roll_length(&self) -> f64 {
        self.driver_roll_length - 0.5 * self.approach
    }

    /// Driver's roll lengths at the actual ends of the path, m.
    pub fn path(&self) -> [f64; 2] {
        let [own, mate] = self.tip_roll_lengths;
        match self.kind {
            MeshKind::SunPlanet => [self.reach() - mate, own],
            MeshKind::RingPlanet => [mate - self.reach(), own],
        }
    }

    /// Phase: where pair 0 stands on the actual path, in cycles from its start.
    pub fn phase(&self) -> f64 {
        (self.touching_roll_length() - self.path()[0]) / self.base_pitch
    }

    /// Distances of the driver's tip corner of pair `index` beyond the end of the path, and of the driven
    /// gear's beyond the start, m; negative inside. Each is measured in roll length of the corner's own gear.
    pub fn beyond(&self, index: i64) -> [f64; 2] {
        let along = index as f64 * self.base_pitch;
        let end = self.driver_roll_length + along - self.tip_roll_lengths[0];
        let start = match self.kind {
            MeshKind::SunPlanet => self.driven_roll_length - along - self.tip_roll_lengths[1],
            // The ring's tip is at its shortest roll length.
            MeshKind::RingPlanet => self.tip_roll_lengths[1] - self.driven_roll_length - along,
        };
        [end, start]
    }

    /// Where pair `index` may touch.
    pub fn location(&self, index: i64) -> PairLocation {
        match self.beyond(index) {
            [end, _] if end > 0.0 => PairLocation::Corner(MeshMember::Driver),
            [_, start] if start > 0.0 => PairLocation::Corner(MeshMember::Driven),
            _ => PairLocation::Path,
        }
    }

    /// Driver's and driven flank of pair `index` as they stand, in the frame with the central gear's
    /// centre at the origin and the planet's at (a', 0).
    pub fn flanks<'m>(&self, mesh: &'m Mesh, index: i64) -> (Flank<'m>, Flank<'m>) {
        use crate::gear::Facing;
        let along = index as f64 * self.base_pitch;
        let alpha = self.pressure_angle;
        let planet = [self.center_distance, 0.0];
        let [r1, r2] = self.base_radii;
        let (driver, driven) = (mesh.gear(MeshMember::Driver), mesh.gear(MeshMember::Driven));
        let s1 = self.driver_roll_length + along;
        match self.kind {
            MeshKind::SunPlanet => {
                let s2 = self.driven_roll_length - along;
                let origin = std::f64::consts::PI - alpha + s2 / r2;
                let facing = Facing::CounterClockwise;
                (
                    Flank { gear: driver, centre: [0.0; 2], origin_angle: s1 / r1 - alpha, facing },
                    Flank { gear: driven, centre: planet, origin_angle: origin, facing },
                )
            }
            MeshKind::RingPlanet => {
                let s2 = self.driven_roll_length + along;
                let facing = Facing::Clockwise;
                (
                    Flank { gear: driver, centre: planet, origin_angle: alpha - s1 / r1, facing },
                    Flank { gear: driven, centre: [0.0; 2], origin_angle: alpha - s2 / r2, facing },
                )
            }
        }
    }

    /// Clearance of pair `index` as it stands, without relief, m: −δ on the path, at a corner the gap
    /// from the mating flank to the corner along that flank's base tangent. `None` if the corner is inside
    /// the mate's base circle.
    pub fn clearance(&self, mesh: &Mesh, index: i64) -> Option<f64> {
        let (driver, driven) = self.flanks(mesh, index);
        match self.location(index) {
            PairLocation::Path => Some(-self.approach),
            PairLocation::Corner(MeshMember::Driver) => {
                driven.gap_to(driver.point(driver.gear.tip_roll_length()))
            }
            PairLocation::Corner(MeshMember::Driven) => {
                driver.gap_to(driven.point(driven.gear.tip_roll_length()))
            }
        }
    }

    /// Derivatives of a' and λ with respect to D, in the nominal mesh frame.
    fn along_and_across(&self) -> ([f64; 2], [f64; 2]) {
        let (sin, cos) = self.line_of_centres.sin_cos();
        ([cos, sin], [-sin / self.center_distance, cos / self.center_distance])
    }

    /// Signs with which the centres of driver and driven gear enter D.
    fn senses(&self) -> [f64; 2] {
        match self.kind {
            MeshKind::SunPlanet => [-1.0, 1.0],
            MeshKind::RingPlanet => [1.0, -1.0],
        }
    }

    /// Derivatives of δ and s₁ with respect to a' and λ.
    ///
    /// `[eq:displaced-mesh-derivatives]` ∂α'/∂a' = R/(a' L), ∂²α'/∂a'² = −R (2a'² − R²)/(a'² L³), in δ = … − R λ + R
    /// α' − L (external) and δ = … − R (λ + α') + L (internal).
    /// Source: derived here.
    /// Checked by: `gearset/tests/displaced.rs::derivatives_are_difference_quotients`.
    fn of_centres(&self) -> [OfCentres; 2] {
        let (radii, reach, a) = (self.radii(), self.reach(), self.center_distance);
        let [r1, _] = self.base_radii;
        let opening = radii / (a * reach);
        let bending = -radii * (2.0 * a * a - radii * radii) / (a * a * reach.powi(3));
        match self.kind {
            // δ = … − R λ + R α' − L
            MeshKind::SunPlanet => [
                OfCentres {
                    by_distance: -reach / a,
                    by_direction: -radii,
                    by_distance_twice: -radii * opening / a,
                },
                OfCentres {
                    by_distance: r1 * opening,
                    by_direction: -r1,
                    by_distance_twice: r1 * bending,
                },
            ],
            // δ = … − R (λ + α') + L
            MeshKind::RingPlanet => [
                OfCentres {
                    by_distance: reach / a,
                    by_direction: -radii,
                    by_distance_twice: radii * opening / a,
                },
                OfCentres {
                    by_distance: r1 * opening,
                    by_direction: r1,
                    by_distance_twice: r1 * bending,
                },
            ],
        }
    }

    /// ∂δ/∂θ and ∂s₁/∂θ of driver and driven.
    fn turning(&self) -> [[f64; 2]; 2] {
        let [r1, r2] = self.base_radii;
        match self.kind {
            MeshKind::SunPlanet => [[r1, r2], [r1, 0.0]],
            MeshKind::RingPlanet => [[-r1, r2], [-r1, 0.0]],
        }
    }

    /// First derivatives.
    pub fn gradients(&self) -> MeshGradients {
        let (along, across) = self.along_and_across();
        let senses = self.senses();
        let of = |part: OfCentres, turning: [f64; 2]| {
            let mut g = [0.0; 6];
            for (member, sense) in senses.into_iter().enumerate() {
                for k in 0..2 {
                    g[3 * member + k] =
                        sense * (part.by_distance * along[k] + part.by_direction * across[k]);
                }
                g[3 * member + 2] = turning[member];
            }
            g
        };
        let [approach, driver] = self.of_centres();
        let [of_approach, of_driver] = self.turning();
        let (approach, driver) = (of(approach, of_approach), of(driver, of_driver));
        let distance = OfCentres { by_distance: 1.0, by_direction: 0.0, by_distance_twice: 0.0 };
        MeshGradients {
            approach,
            roll_length: std::array::from_fn(|i| driver[i] - 0.5 * approach[i]),
            center_distance: of(distance, [0.0; 2]),
        }
    }

    /// Second derivatives; those with respect to rotations are zero.
    pub fn hessians(&self) -> MeshHessians {
        let (along, across) = self.along_and_across();
        let a = self.center_distance;
        let senses = self.senses();
        let of = |part: OfCentres| {
            let mut h = [[0.0; 6]; 6];
            for i in 0..6 {
                for j in 0..6 {
                    let (p, q) = (i % 3, j % 3);
                    if p == 2 || q == 2 {
                        continue;
                    }
                    // ∂²a' = a' ∂λ ∂λ,  ∂²λ = −(∂a' ∂λ + ∂λ ∂a')/a'
                    let distance = a * across[p] * across[q];
                    let direction = -(along[p] * across[q] + across[p] * along[q]) / a;
                    h[i][j] = senses[i / 3]
                        * senses[j / 3]
                        * (part.by_distance * distance
                            + part.by_direction * direction
                            + part.by_distance_twice * along[p] * along[q]);
                }
            }
            h
        };
        let [approach, driver] = self.of_centres();
        let (approach, driver) = (of(approach), of(driver));
        let roll_length =
            std::array::from_fn(|i| std::array::from_fn(|j| driver[i][j] - 0.5 * approach[i][j]));
        let distance = OfCentres { by_distance: 1.0, by_direction: 0.0, by_distance_twice: 0.0 };
        MeshHessians { approach, roll_length, center_distance: of(distance) }
    }
}
