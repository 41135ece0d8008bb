//! Contact cells and contact solvers at their borders, on two cylinders with Hertz's closed form.

use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, Lemke, Problem, kkt_residual};
use fe_contact::contact::cylinders::Cylinders;
use fe_contact::contact::half_plane::HalfPlane;
use fe_contact::contact::hertz::Hertz;
use fe_contact::{Elastic, FeError};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use scene::PlaneState;

use super::map::{Drawn, Map, MapError, MapOf, StabilityMap, fine_from, logarithms};

pub(super) const MAP: Map = Map {
    name: "contact-cells",
    about: "Contact cells, definiteness of the flexibility matrix and contact solvers on Hertz's problem",
    meaning: "with fewer contact cells in the loaded half-width than this pressures are those of the grid; solvers are \
         held against one another where they could cycle or lose accuracy",
    of: MapOf::Nothing(map),
};

const STEEL: Elastic =
    Elastic { young: 207e9, poisson: 0.3, density: 7800.0, plane: PlaneState::Strain };

/// Relative radius of the flanks, m, and line load, N/m: those of a loaded mesh of module 3 mm.
const RADIUS: f64 = 8e-3;
const LINE_LOAD: f64 = 4e5;

/// Half the grid over the half-width of the patch.
const REACH: f64 = 2.0;

/// Cells of the grid.
const CELLS: [usize; 9] = [6, 8, 12, 16, 24, 40, 80, 160, 320];

/// Cells of the grid of the degenerate problems and of the comparison of solvers.
const COMPARED: usize = 80;

/// Problems with as many cells that just touch without force as cells that press.
const DEGENERATE: usize = 40;

fn map() -> Result<StabilityMap, MapError> {
    let system = "two steel cylinders pressed together, half-planes with Hertz's closed form";
    let mut map = StabilityMap::of(&MAP, system, "log₁₀ of cells in the loaded half-width");
    accuracy(&mut map)?;
    definiteness(&mut map);
    solvers(&mut map)?;
    Ok(map)
}

/// Peak pressure and approach against Hertz.
fn accuracy(map: &mut StabilityMap) -> Result<(), MapError> {
    let hertz = Hertz::new(LINE_LOAD, RADIUS, &STEEL);
    let depth = 5.0 * hertz.half_width;
    let mut errors = [Vec::new(), Vec::new()];
    for cells in CELLS {
        let pressed = press(cells, &ActiveSet)?;
        let peak = pressed.pressures().into_iter().fold(0.0, f64::max);
        let compression = 0.5 * pressed.approach(&STEEL, depth);
        let per_half_width = cells as f64 / (2.0 * REACH);
        let off = [
            100.0 * (peak / hertz.peak_pressure - 1.0).abs(),
            100.0 * (compression / hertz.compression(depth, &STEEL) - 1.0).abs(),
        ];
        errors.iter_mut().zip(off).for_each(|(list, off)| list.push((per_half_width, off)));
    }
    for (k, what) in ["peak pressure", "compression down to five half-widths"].iter().enumerate() {
        for wanted in [1.0, 0.1] {
            let quantity = format!("fewest cells in the half-width: {what} within {wanted} %");
            map.measure("cells of equal width", quantity, fine_from(&errors[k], wanted));
        }
        let panel = "log₁₀ of the error against Hertz, %";
        map.draw(Drawn::Measured, panel, what, logarithms(errors[k].iter().copied(), 1e-6));
    }
    Ok(())
}

fn press(cells: usize, solver: &dyn ComplementaritySolver) -> Result<Cylinders, MapError> {
    let reach = REACH * Hertz::new(LINE_LOAD, RADIUS, &STEEL).half_width;
    Cylinders::press(&STEEL, RADIUS, LINE_LOAD, (reach, cells), solver)
        .map_err(|cause| MapError::Fe(FeError::Contact { phase: 0.0, cause }))
}

/// Compliance of the surface relative to a depth of five half-widths, m/N per metre of width.
fn compliance(cells: usize) -> DMatrix<f64> {
    let half_width = Hertz::new(LINE_LOAD, RADIUS, &STEEL).half_width;
    let width = 2.0 * REACH * half_width / cells as f64;
    let half = HalfPlane::new(&STEEL);
    DMatrix::from_fn(cells, cells, |i, j| {
        let x = (i as f64 - j as f64) * width;
        2.0 * half.strip_above_depth(x, 5.0 * half_width, 0.5 * width) / width
    })
}

/// Least over largest eigenvalue of the flexibility matrix. The kernel of the half-plane falls as the inverse of the
/// wave number, so that the ratio falls as the inverse of the number of cells.
fn definiteness(map: &mut StabilityMap) {
    let ratio = |cells: usize| {
        let eigen = SymmetricEigen::new(compliance(cells)).eigenvalues;
        eigen.min() / eigen.max()
    };
    let ratios: Vec<(f64, f64)> =
        CELLS.iter().map(|cells| (*cells as f64 / (2.0 * REACH), ratio(*cells))).collect();
    if let [.., (m, coarse), (n, fine)] = ratios[..] {
        let order = (coarse / fine).ln() / (n / m).ln();
        let of = "flexibility matrix of the half-plane";
        let quantity = "order at which least over largest eigenvalue falls with the cells";
        map.compare(of, quantity, order, Some(1.0));
        let quantity = "cells in the half-width at which rounding would cost definiteness";
        let lost = n * (fine / f64::EPSILON).powf(1.0 / order);
        map.measure(of, quantity, lost);
    }
    let panel = "log₁₀ of least over largest eigenvalue";
    map.draw(Drawn::Measured, panel, "flexibility matrix", logarithms(ratios, 0.0));
}

/// Forces of each solver beside those of the active set, and what degenerate problems cost.
fn solvers(map: &mut StabilityMap) -> Result<(), MapError> {
    let truth = press(COMPARED, &ActiveSet)?.forces;
    let largest = truth.iter().fold(0.0f64, |a, p| a.max(*p));
    #[cfg(feature = "interior_point")]
    let interior = fe_contact::complementarity::InteriorPoint;
    let others: Vec<&dyn ComplementaritySolver> = vec![
        &Lemke,
        #[cfg(feature = "interior_point")]
        &interior,
    ];
    for solver in &others {
        let forces = press(COMPARED, *solver)?.forces;
        let off = truth.iter().zip(&forces).fold(0.0f64, |a, (p, q)| a.max((p - q).abs()));
        let quantity = "largest difference from the active set's forces, of the largest force";
        map.compare(solver.name(), quantity, off / largest, Some(0.0));
    }
    let matrix = compliance(COMPARED);
    let all = [&ActiveSet as &dyn ComplementaritySolver].into_iter().chain(others);
    for solver in all {
        let (mut most, mut worst) = (0usize, 0.0f64);
        for k in 0..DEGENERATE {
            let (gaps, forces) = degenerate(&matrix, k);
            let problem = Problem { compliance: &matrix, gaps: &gaps };
            let found = solver
                .solve(&problem, None)
                .map_err(|cause| MapError::Fe(FeError::Contact { phase: 0.0, cause }))?;
            most = most.max(found.iterations);
            worst = worst.max(kkt_residual(&problem, &found.forces));
            let scale = forces.iter().fold(0.0f64, |a, p| a.max(*p));
            for (p, q) in forces.iter().zip(&found.forces) {
                worst = worst.max((p - q).abs() / scale);
            }
        }
        let of = format!("{}, {DEGENERATE} degenerate problems of {COMPARED} cells", solver.name());
        map.measure(&of, "most iterations", most as f64);
        map.compare(of, "largest error of a force or of its conditions", worst, Some(0.0));
    }
    Ok(())
}

/// Gaps for which known forces are the solution, every second loaded cell just touching without a force: pivoting rules
/// cannot tell which of these are in contact.
fn degenerate(compliance: &DMatrix<f64>, seed: usize) -> (Vec<f64>, Vec<f64>) {
    let n = compliance.nrows();
    let touches = |i: usize| (i + seed).is_multiple_of(2) || (i * (seed + 3)) % 7 < 3;
    let is_pressed = |i: usize| (i * (2 * seed + 1) + seed) % 4 < 2;
    let force = |i: usize| {
        if is_pressed(i) { 1.0 + ((i * 37 + seed * 11) % 101) as f64 / 50.0 } else { 0.0 }
    };
    let forces: Vec<f64> = (0..n).map(force).collect();
    let closed = compliance * DVector::from_column_slice(&forces);
    let scale = closed.amax();
    // w = C p + g: 0 where pressed, and where the flanks just touch.
    let gap = |i: usize| {
        let open = if forces[i] > 0.0 || touches(i) { 0.0 } else { 0.3 * scale };
        open - closed[i]
    };
    ((0..n).map(gap).collect(), forces)
}
