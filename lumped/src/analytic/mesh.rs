//! Tangent stiffness of a mesh at one phase under its mean force, in closed form: tooth pairs with gaps share the
//! force.
//!
//! C_ii ([`Near`]): both teeth (`tooth.rs`); C_ij of neighbouring pairs: a fixed share of √(C_ii C_jj). h: what two
//! half-planes yield between the flanks and the depths d of both axes, with the relative radius R of the flanks. The
//! gap of a pair beyond an end of the path grows with the square of the distance ([`Mesh::corner_gap_curvature`]);
//! tip relief adds to it.
//!
//! As the set rolls on by σ, gaps and flexibilities change ([`mesh_tangent`]). The slope s_a over the centre distance,
//! where the driver's roll length stays and the driven gear's changes by 1/sin α, is found alike.

use std::f64::consts::PI;

use gearset::{Mesh, MeshKind, MeshMember};
use nalgebra::{Cholesky, Const, Matrix4, Vector4};

use super::plane::Plane;
use super::tooth::Tooth;

/// C_ij of neighbouring pairs over √(C_ii C_jj): a rim that yields under one tooth carries its neighbour with it.
/// Fitted to FE/contact (`docs/closed_forms.md`).
const NEIGHBOUR: f64 = 0.12;

/// A pair that is off its mate by less than this part of the approach may touch, and one that carries less than that of
/// the force may not. On the drawn sets 1 to 249 at twelve positions FE/contact has it the other way in 16 of 92 meshes
/// with a pair that is off by less, and in none of 177 with one that is off by up to three times as much; in 30 of 92
/// with a pair that carries less, and in 4 of 173 with one that carries up to three times as much.
const NEAR: [f64; 2] = [0.06, 0.02];

/// Part of a cycle to either side over which a slope is taken.
const STEP: f64 = 0.01;

/// Least part of the force for which the half-width of contact of a pair is taken.
const LEAST_SHARE: f64 = 0.02;

/// Most times that half-widths of contact are taken from the forces found before.
const SHARED: usize = 12;

type Factored = Cholesky<f64, Const<4>>;

/// Most pairs that are looked at.
const MOST: usize = 4;

/// Stiffness of one mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeshTangent {
    /// k, N/m.
    pub(super) stiffness: f64,
    /// ln of the factor on k if a pair that nearly touches does, or one that hardly carries does not; 0 if there is
    /// none.
    pub(super) hand_over: f64,
    /// s and s_a, m/m: slopes of the approach under a constant force over the driver's roll length and over the centre
    /// distance.
    pub(super) slopes: [f64; 2],
    /// c, N/m: stiffness against rolling on with an approach that follows that slope.
    pub(super) rolling: f64,
}

/// One pair near the path.
#[derive(Debug, Clone, Copy, Default)]
struct Pair {
    gap: f64,
    /// Flexibility of both teeth, m/N.
    teeth: f64,
    /// ln(4 d₁ d₂/a²) − ν/(1 − ν) at f = 1 N.
    near: f64,
    /// Driver's roll length on the common line, m.
    along: f64,
    /// Approach that is assumed for its place beyond an end of the path, m.
    approach: f64,
    /// g'' of a corner, 1/m.
    curvature: f64,
}

/// Slopes of a pair's gap (m/m), of the flexibility of its teeth (1/N) and of `near` (1/m) over the driver's roll
/// length.
#[derive(Debug, Clone, Copy)]
struct Rolled {
    gap: f64,
    teeth: f64,
    near: f64,
}

impl Pair {
    /// The pair where the driver's roll length on the common line is `along` and the flanks approach by `approach`;
    /// `None` where a tooth is none that the closed forms hold for.
    fn at(mesh: &Mesh, along: f64, approach: f64, plane: &Plane) -> Option<Self> {
        let (driver, driven) = (mesh.gear(MeshMember::Driver), mesh.gear(MeshMember::Driven));
        let (gap, curvature, s) = gap(mesh, along, approach);
        let (mate, relative) = (mesh.driven_roll_length(s), relative_radius(mesh, s));
        let [a, b] = [Tooth::at(driver, s, plane)?, Tooth::at(driven, mate, plane)?];
        // a² = 8 f R/(π E' b)
        let squared = 8.0 * relative / (PI * plane.modulus * plane.width);
        let poisson = plane.poisson / (1.0 - plane.poisson);
        let near = (4.0 * a.depth * b.depth / squared).ln() - poisson;
        Some(Self { gap, teeth: a.flexibility + b.flexibility, near, along, approach, curvature })
    }

    /// Slopes over the driver's roll length.
    fn rolled(&self, mesh: &Mesh, plane: &Plane) -> Option<Rolled> {
        let step = STEP * mesh.base_pitch;
        let ends = [self.along + step, self.along - step];
        let [after, before] = ends.map(|along| Self::at(mesh, along, self.approach, plane));
        let (after, before) = (after?, before?);
        let over = |x: f64| 0.5 * x / step;
        Some(Rolled {
            gap: over(after.gap - before.gap),
            teeth: over(after.teeth - before.teeth),
            near: over(after.near - before.near),
        })
    }
}

/// Relative radius of curvature of the flanks that touch at the driver's roll length s, m.
fn relative_radius(mesh: &Mesh, s: f64) -> f64 {
    let mate = mesh.driven_roll_length(s);
    match mesh.kind {
        MeshKind::SunPlanet => s * mate / (s + mate),
        MeshKind::RingPlanet => s * mate / (mate - s),
    }
}

/// Gap of a pair (m), its second derivative at a corner (1/m), and the driver's roll length where it touches (m), of
/// flanks that approach by `approach` (m): each gear is half of that further on its own path, towards a corner at
/// either end.
///
/// Relief is the less, the farther from the tip. With its slope d along the flank, flanks of relative radius R whose
/// contact would lie X beyond a corner are nearest at x towards the root:
///
/// `[eq:relieved-gap]` g(x) = g(0) + ((X + x)² − X²)/(2 R) − d x is least at x = R d − X > 0, where g = g(0) − ½ R
/// (d − X/R)².
/// Source: derived here.
/// Checked by: `lumped/src/analytic/mesh.rs::the_gap_of_relieved_flanks_is_the_least_along_them`.
fn gap(mesh: &Mesh, along: f64, approach: f64) -> (f64, f64, f64) {
    // The driven gear's tip enters, the driver's leaves.
    let beyond = [
        (MeshMember::Driven, mesh.path_start - along + 0.5 * approach),
        (MeshMember::Driver, along + 0.5 * approach - mesh.path_end),
    ];
    let corner = beyond.into_iter().find(|(_, e)| *e > 0.0);
    let curvature = corner.map_or(0.0, |(member, _)| mesh.corner_gap_curvature(member));
    let s = along.clamp(mesh.path_start, mesh.path_end);
    let e = corner.map_or(0.0, |(_, e)| e);
    let ends = [(MeshMember::Driver, s), (MeshMember::Driven, mesh.driven_roll_length(s))];
    let (mut relief, mut slope, mut farther) = (0.0, 0.0f64, 0.0);
    for (member, s) in ends {
        let gear = mesh.gear(member);
        let [own, of_roll_length] = gear.relief_and_slope_at(s);
        // Along the flank one unit of roll length is s/r_b.
        let length = s / gear.base_radius;
        relief += own;
        if of_roll_length.abs() / length > slope {
            (slope, farther) = (of_roll_length.abs() / length, e * length);
        }
    }
    let radius = relative_radius(mesh, s);
    let tilt = (slope - farther / radius).max(0.0);
    let nearest = relief - (0.5 * radius * tilt * tilt).min(relief);
    (0.5 * curvature * e * e + nearest, curvature, s)
}

/// The tangent stiffness of a mesh at a phase (cycles) under a force (N); `None` where a tooth is none that the closed
/// forms hold for, or more than four pairs are near.
///
/// `[eq:rolling-stiffness]` k = 1ᵀK 1, −k s = −1ᵀK g', c + k s² = g'ᵀK g' − Σ f_i g_i'': second derivatives of the
/// pairs' energy ½ (δ − g)ᵀ K (δ − g) with respect to δ, to δ and σ, and to σ, with K = (C + diag h')⁻¹,
/// g' = ∂(g_i + C_ii f_i)/∂σ and g'' of the corners.
/// Source: derived here.
/// Checked by: `lumped/src/analytic/mesh.rs::forces_of_a_pressed_mesh_have_one_energy`,
/// `validation/tests/closed_forms.rs::closed_forms_hold_on_shipped_sets`.
pub(super) fn mesh_tangent(
    mesh: &Mesh,
    phase: f64,
    force: f64,
    plane: &Plane,
) -> Option<MeshTangent> {
    let near = Near::new(pairs_near(mesh, phase, force, plane)?, force, plane);
    let shared = near.shared()?;
    let stiffness = near.stiffness(&shared.touching, &shared.forces)?;
    let (mut slopes, mut apart) = (Vector4::zeros(), Vector4::zeros());
    let mut corners = 0.0;
    let step = STEP * mesh.base_pitch;
    let moved = |by: f64| mesh.at_center_distance(mesh.center_distance + by).ok();
    let (farther, closer) = (moved(step)?, moved(-step)?);
    for (i, pair) in near.pairs.iter().enumerate().filter(|(i, _)| shared.touching[*i]) {
        let rolled = pair.rolled(mesh, plane)?;
        slopes[i] = rolled.gap + shared.forces[i] * rolled.teeth;
        corners += shared.forces[i] * pair.curvature;
        let of = |mesh: &Mesh| Pair::at(mesh, pair.along, pair.approach, plane);
        let (after, before) = (of(&farther)?, of(&closer)?);
        let change = after.gap - before.gap + shared.forces[i] * (after.teeth - before.teeth);
        apart[i] = 0.5 * change / step;
    }
    let tangent = near.tangent(&shared.touching, &shared.forces)?;
    let pressed = tangent.solve(&slopes);
    let slope = pressed.sum() / stiffness;
    let over_distance = tangent.solve(&apart).sum() / stiffness;
    let rolling = slopes.dot(&pressed) - corners - stiffness * slope * slope;
    let hand_over = near.hand_over(&shared, stiffness)?;
    Some(MeshTangent { stiffness, hand_over, slopes: [slope, over_distance], rolling })
}

/// Which pairs touch.
type Touching = [bool; MOST];

/// Forces of pairs of which none is pulled: those that are, are left out one by one, the most pulled first. 0 where
/// none is left.
fn pressing(
    touching: &mut Touching,
    mut forces: impl FnMut(&Touching) -> Option<Vector4<f64>>,
) -> Option<Vector4<f64>> {
    loop {
        let found = forces(touching)?;
        let own = (0..MOST).filter(|i| touching[*i]);
        match own.min_by(|a, b| found[*a].total_cmp(&found[*b])) {
            Some(least) if found[least] < 0.0 => touching[least] = false,
            _ => return Some(found),
        }
    }
}

/// The pairs near the path, and the force they share.
///
/// `[eq:pairs-share-a-force]` Tooth pairs i with gaps g_i share the force F of a mesh:
/// ```text
/// δ − g_i = Σ_j C_ij f_j + h_i(f_i),   f_i ≥ 0,   Σ f_i = F,   k = 1ᵀ (C + diag h_i')⁻¹ 1 over the pairs that touch,
/// h_i = 2 f/(π E' b) [ln(2 d₁/a) + ln(2 d₂/a) − ν/(1 − ν)],   a = √(8 f R/(π E' b)).
/// ```
/// Source: h: Weber & Banaschek (1953), Johnson, Contact Mechanics (1985), eq. 5.57; the rest derived here.
/// Checked by: `validation/tests/closed_forms.rs::closed_forms_hold_on_shipped_sets`,
/// `lumped/tests/analytic.rs::a_renumbered_set_has_the_same_frequencies`,
/// `lumped/src/analytic/mesh.rs::forces_of_a_pressed_mesh_have_one_energy`.
struct Near {
    pairs: Vec<Pair>,
    /// C, m/N; 1 on the diagonal where there is no pair.
    teeth: Matrix4<f64>,
    /// 2/(π E' b), m/N.
    line: f64,
    force: f64,
}

/// How they share it.
struct Shared {
    touching: Touching,
    /// N.
    forces: Vector4<f64>,
    /// m.
    approach: f64,
}

impl Near {
    fn new(pairs: Vec<Pair>, force: f64, plane: &Plane) -> Self {
        let mut teeth = Matrix4::identity();
        for (i, pair) in pairs.iter().enumerate() {
            teeth[(i, i)] = pair.teeth;
            if i > 0 {
                let across = NEIGHBOUR * (pair.teeth * pairs[i - 1].teeth).sqrt();
                (teeth[(i, i - 1)], teeth[(i - 1, i)]) = (across, across);
            }
        }
        Self { pairs, teeth, line: 2.0 / (PI * plane.modulus * plane.width), force }
    }

    /// C + diag(h/f − less) of the pairs that touch, factored; the others have rows of the identity.
    fn factored(&self, touching: &Touching, forces: &Vector4<f64>, less: f64) -> Option<Factored> {
        let mut c = Matrix4::identity();
        let count = self.pairs.len();
        for i in (0..count).filter(|i| touching[*i]) {
            for j in (0..count).filter(|j| touching[*j]) {
                c[(i, j)] = self.teeth[(i, j)];
            }
            let own = forces[i].max(LEAST_SHARE * self.force);
            c[(i, i)] += self.line * (self.pairs[i].near - own.ln()) - less;
        }
        c.cholesky()
    }

    /// C + diag h': with a ∝ √f on both flanks, h' = h/f − 2/(π E' b).
    fn tangent(&self, touching: &Touching, forces: &Vector4<f64>) -> Option<Factored> {
        self.factored(touching, forces, self.line)
    }

    /// 1ᵀ (C + diag h')⁻¹ 1, N/m.
    fn stiffness(&self, touching: &Touching, forces: &Vector4<f64>) -> Option<f64> {
        let ones = Vector4::from_fn(|i, _| f64::from(u8::from(touching[i])));
        Some(self.tangent(touching, forces)?.solve(&ones).sum())
    }

    /// The half-widths of contact are those of the forces found before.
    fn shared(&self) -> Option<Shared> {
        let count = self.pairs.len();
        let mut forces = Vector4::repeat(self.force / count as f64);
        let (mut touching, mut approach): (Touching, f64) = ([false; MOST], 0.0);
        for _ in 0..6 {
            touching = std::array::from_fn(|i| i < count);
            let next = pressing(&mut touching, |touching| {
                let c = self.factored(touching, &forces, 0.0)?;
                let of = |i: usize, value: f64| if touching[i] { value } else { 0.0 };
                let k = c.solve(&Vector4::from_fn(|i, _| of(i, 1.0)));
                let gaps = |i: usize| self.pairs.get(i).map_or(0.0, |pair| of(i, pair.gap));
                let own = c.solve(&Vector4::from_fn(|i, _| gaps(i)));
                // Σ f = 1ᵀ K (δ − g) = F
                approach = (self.force + own.sum()) / k.sum();
                Some(k * approach - own)
            })?;
            let change = (next - forces).amax();
            forces = next;
            if change < 1e-4 * self.force {
                break;
            }
        }
        Some(Shared { touching, forces, approach })
    }

    /// Forces (N) and tangent stiffness (N/m) under an approach (m): f = K (δ − g), as for a given force.
    fn pressed(&self, approach: f64) -> Option<(Vector4<f64>, f64)> {
        let count = self.pairs.len();
        let mut forces = Vector4::repeat(self.force / count as f64);
        let mut touching: Touching = [false; MOST];
        for _ in 0..SHARED {
            touching = std::array::from_fn(|i| i < count && self.pairs[i].gap < approach);
            let next = pressing(&mut touching, |touching| {
                let c = self.factored(touching, &forces, 0.0)?;
                let open = |i: usize| if touching[i] { approach - self.pairs[i].gap } else { 0.0 };
                Some(c.solve(&Vector4::from_fn(|i, _| open(i))))
            })?;
            let change = (next - forces).amax();
            forces = next;
            if change < 1e-9 * self.force {
                break;
            }
        }
        let stiffness = self.stiffness(&touching, &forces)?;
        Some((forces, stiffness))
    }

    /// The largest change of ln k by a pair that nearly touches, or hardly carries.
    fn hand_over(&self, shared: &Shared, stiffness: f64) -> Option<f64> {
        let Shared { touching, forces, approach } = shared;
        let [off, hardly] = NEAR;
        let mut largest: f64 = 0.0;
        for (i, pair) in self.pairs.iter().enumerate() {
            let is_near = match touching[i] {
                true => {
                    let alone = touching.iter().filter(|t| **t).count() == 1;
                    forces[i] < hardly * self.force && !alone
                }
                false => {
                    let carried: f64 =
                        (0..self.pairs.len()).map(|j| self.teeth[(i, j)] * forces[j]).sum();
                    pair.gap + carried - approach < off * approach
                }
            };
            if is_near {
                let mut other = *touching;
                other[i] = !other[i];
                let change = (self.stiffness(&other, forces)? / stiffness).ln();
                largest = if change.abs() > largest.abs() { change } else { largest };
            }
        }
        Some(largest)
    }
}

/// A mesh at one phase, which any approach may press.
pub(super) struct PressedMesh {
    near: Near,
    rolled: Vec<Rolled>,
}

impl PressedMesh {
    /// A mesh at a phase (cycles) whose corners are placed as under a mean force (N); `None` as [`mesh_tangent`].
    pub(super) fn new(mesh: &Mesh, phase: f64, force: f64, plane: &Plane) -> Option<Self> {
        let near = Near::new(pairs_near(mesh, phase, force, plane)?, force, plane);
        let rolled =
            near.pairs.iter().map(|pair| pair.rolled(mesh, plane)).collect::<Option<_>>()?;
        Some(Self { near, rolled })
    }

    /// Where the gears approach by δ (m): the force F (N), its derivative k (N/m), and R (N) against rolling on at that
    /// approach.
    ///
    /// `[eq:force-against-rolling]` R = −∂Ψ/∂σ = Σ f_i g_i' + ½ Σ f_i C_ij' f_j + ½ Σ f_i² c_i', c = 2/(π E' b) [ln(4
    /// d₁ d₂/a²) − ν/(1 − ν)].
    /// Source: derived here.
    /// Checked by: `lumped/src/analytic/mesh.rs::forces_of_a_pressed_mesh_have_one_energy`.
    pub(super) fn forces_at(&self, approach: f64) -> Option<[f64; 3]> {
        let Near { pairs, teeth, line, .. } = &self.near;
        let (forces, stiffness) = self.near.pressed(approach)?;
        let own = self.rolled.iter().zip(pairs).map(|(r, p)| (r, r.teeth / p.teeth));
        let own: Vec<(&Rolled, f64)> = own.collect();
        let mut rolling = 0.0;
        for (i, (rolled, growth)) in own.iter().enumerate() {
            rolling += forces[i] * (rolled.gap + 0.5 * forces[i] * line * rolled.near);
            // C_ij' = ½ C_ij (C_ii'/C_ii + C_jj'/C_jj)
            for (j, (_, other)) in own.iter().enumerate() {
                rolling += 0.25 * forces[i] * forces[j] * teeth[(i, j)] * (growth + other);
            }
        }
        Some([forces.sum(), stiffness, rolling])
    }

    /// Approach under the mean force, m.
    pub(super) fn mean_approach(&self) -> Option<f64> {
        Some(self.near.shared()?.approach)
    }
}

/// Pairs whose gap is less than twice what a single pair yields.
fn pairs_near(mesh: &Mesh, phase: f64, force: f64, plane: &Plane) -> Option<Vec<Pair>> {
    // One pair yields by about 13 F/(E' b) (ISO 6336-1).
    let single = 13.0 * force / (plane.modulus * plane.width);
    let approach = single / (0.75 * mesh.contact_ratio + 0.25);
    let mut pairs = Vec::with_capacity(MOST);
    for i in -1..=mesh.contact_ratio.ceil() as i32 {
        let along = mesh.path_start + (phase.rem_euclid(1.0) + f64::from(i)) * mesh.base_pitch;
        if gap(mesh, along, approach).0 < 2.0 * single {
            pairs.push(Pair::at(mesh, along, approach, plane)?);
        }
    }
    (1..=MOST).contains(&pairs.len()).then_some(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    use scene::{Scene, SceneKind, template};

    /// R is what the energy ∫ F dδ loses as the mesh rolls on, and k the slope of F, on either mesh wherever it stands.
    #[test]
    fn forces_of_a_pressed_mesh_have_one_energy() {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let geometry = scene.tooth_geometry().unwrap();
        let plane = Plane::new(&scene, geometry.face_width);
        let (force, step) = (8000.0, 1e-4);
        let mut checked = 0;
        for mesh in [geometry.sun_planet.unwrap(), geometry.ring_planet.unwrap()] {
            for phase in [0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95] {
                let at = |phase: f64| PressedMesh::new(&mesh, phase, force, &plane).unwrap();
                let [before, own, after] = [-step, 0.0, step].map(|moved| at(phase + moved));
                let approach = own.mean_approach().unwrap();
                let energy = |mesh: &PressedMesh| {
                    let part = approach / 2000.0;
                    let middle = |i: u32| mesh.forces_at((f64::from(i) + 0.5) * part).unwrap()[0];
                    (0..2000).map(middle).sum::<f64>() * part
                };
                let [total, stiffness, rolling] = own.forces_at(approach).unwrap();
                assert!((total / force - 1.0).abs() < 1e-3, "{total}");
                let of = |more: f64| own.forces_at(approach + more).unwrap()[0];
                let slope = (of(1e-9) - of(-1e-9)) / 2e-9;
                // The half-width of a pair that carries next to nothing is that of a larger force.
                let (forces, _) = own.near.pressed(approach).unwrap();
                let is_slight = |f: &&f64| **f > 0.0 && **f < LEAST_SHARE * force;
                let part = if forces.iter().any(|f| is_slight(&f)) { 1e-2 } else { 1e-4 };
                assert!((stiffness / slope - 1.0).abs() < part, "{stiffness:e} {slope:e}");
                let lost = (energy(&before) - energy(&after)) / (2.0 * step * mesh.base_pitch);
                assert!((rolling - lost).abs() < 2e-5 * force, "{phase}: {rolling} {lost}");
                checked += usize::from(rolling.abs() > 2e-4 * force);
                assert_eq!(own.forces_at(-1e-6).unwrap(), [0.0; 3]);
            }
        }
        assert!(checked > 4, "{checked} with a slope to speak of");
    }

    /// The gap of flanks with tip relief is the least one along them: searched for point by point, with the arc s
    /// ds/r_b of an involute, at both ends of the path of either mesh and a little beyond. At the tips of ring meshes
    /// it is a good part below that where flanks without relief touch.
    #[test]
    fn the_gap_of_relieved_flanks_is_the_least_along_them() {
        let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let plain = scene.tooth_geometry().unwrap();
        let relieved = |gear: &gearset::Gear| gearset::TipRelief {
            start_radius_m: gear.tip_radius - 0.2 * (gear.tip_radius - gear.root_radius),
            amount_m: 12e-6,
            shape: gearset::ReliefShape::Linear,
        };
        let input = scene.geometry.as_mut().unwrap();
        input.planet.tip_relief = Some(relieved(&plain.planet));
        let (sun, ring) = (plain.sun.as_ref().unwrap(), plain.ring.as_ref().unwrap());
        input.sun.as_mut().unwrap().tip_relief = Some(relieved(sun));
        input.ring.as_mut().unwrap().tip_relief = Some(relieved(ring));
        let geometry = scene.tooth_geometry().unwrap();
        let mut largest = [0.0f64; 2];
        for mesh in [geometry.sun_planet.unwrap(), geometry.ring_planet.unwrap()] {
            for (member, end) in [(MeshMember::Driven, -1.0), (MeshMember::Driver, 1.0)] {
                for beyond in [-0.1, -0.05, 0.0, 0.02] {
                    let e = beyond * mesh.base_pitch;
                    let along = if end > 0.0 { mesh.path_end + e } else { mesh.path_start - e };
                    let (found, curvature, s) = gap(&mesh, along, 0.0);
                    let gear = mesh.gear(member);
                    let own = if end > 0.0 { s } else { mesh.driven_roll_length(s) };
                    let (e, radius) = (e.max(0.0), relative_radius(&mesh, s));
                    let away = e * own / gear.base_radius;
                    // Towards the root the roll length falls on an external gear and grows on an internal one.
                    let sense = match gear.side {
                        gearset::ToothSide::External => -1.0,
                        gearset::ToothSide::Internal => 1.0,
                    };
                    let at = |x: f64| {
                        let there = (own * own + sense * 2.0 * gear.base_radius * x).sqrt();
                        gear.relief_at(there) + ((away + x).powi(2) - away * away) / (2.0 * radius)
                    };
                    let least = (0..2000).map(|i| at(f64::from(i) * 1e-6)).fold(f64::MAX, f64::min);
                    let expected = 0.5 * curvature * e * e + least;
                    let less = gear.relief_at(own) - least;
                    let kind = usize::from(mesh.kind == MeshKind::RingPlanet);
                    largest[kind] = largest[kind].max(less / gear.relief_at(own));
                    assert!(
                        (found - expected).abs() < 0.05 * less + 1e-9,
                        "{:?} {member:?} {beyond}: {found:e} {expected:e} {less:e}",
                        mesh.kind
                    );
                }
            }
        }
        println!("least gap below that at the point of contact by up to {largest:.3?} of it");
        assert!(largest[1] > 0.1 && largest[1] > largest[0], "{largest:?}");
    }
}
