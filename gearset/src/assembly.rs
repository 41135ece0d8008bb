//! Angular positions at which planets can be assembled, and clearances between neighbouring planets.

use std::f64::consts::TAU;

/// `[eq:assembly]` Assembly step 2π/(Z_s + Z_r), rad: planets fit only where (Z_s + Z_r) ψ_n/2π is an integer.
///
/// Source: closed form.
/// Checked by: `scene/tests/scene_faults.rs::degrees_that_can_be_assembled_become_exact_steps`.
pub fn assembly_step_rad(sun_teeth: u32, ring_teeth: u32) -> f64 {
    TAU / (f64::from(sun_teeth) + f64::from(ring_teeth))
}

/// The nearest position that can be assembled: `(steps, distance in steps)`.
pub fn nearest_steps(psi_rad: f64, sun_teeth: u32, ring_teeth: u32) -> (i64, f64) {
    let exact = psi_rad / assembly_step_rad(sun_teeth, ring_teeth);
    let steps = exact.round();
    (steps as i64, exact - steps)
}

/// `[eq:planet-clearance]` Clearance between the tip circles of every pair of neighbouring planets, m: 2 a
/// sin(Δψ/2) − 2 r_a, as `(planet, next planet, clearance)`, in angular order.
///
/// Source: closed form.
/// Checked by: `scene/tests/scene_faults.rs::each_kind_of_fault_names_its_key_and_says_why`.
pub fn planet_clearances(
    psi_rad: &[f64],
    center_distance: f64,
    tip_radius: f64,
) -> Vec<(usize, usize, f64)> {
    let mut order: Vec<usize> = (0..psi_rad.len()).collect();
    let turn = |n: usize| psi_rad[n].rem_euclid(TAU);
    order.sort_by(|&p, &q| turn(p).total_cmp(&turn(q)));
    let clearance = |p: usize, q: usize| {
        let half_angle = 0.5 * (psi_rad[p] - psi_rad[q]);
        2.0 * center_distance * half_angle.sin().abs() - 2.0 * tip_radius
    };
    match order.len() {
        0 | 1 => Vec::new(),
        n => (0..n)
            .map(|i| (order[i], order[(i + 1) % n]))
            .take(if n == 2 { 1 } else { n })
            .map(|(p, q)| (p, q, clearance(p, q)))
            .collect(),
    }
}
