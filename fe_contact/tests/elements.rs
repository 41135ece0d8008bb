//! Patch tests, rigid motions, orders of convergence, bending.

use fe_contact::Elastic;
use fe_contact::body::Triplets;
use fe_contact::element::{Edge, Shape, matrices};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use scene::{ElementFamily, PlaneState};

const FAMILIES: [ElementFamily; 3] =
    [ElementFamily::Linear, ElementFamily::Incompatible, ElementFamily::Quadratic];

fn material(plane: PlaneState) -> Elastic {
    Elastic { young: 1e7, poisson: 0.25, density: 2.0, plane }
}

/// A structured grid over a mapping of the unit square; the bottom row may have Hermite edges.
struct Grid {
    points: Vec<[f64; 2]>,
    is_derivative: Vec<bool>,
    /// On the boundary of the square.
    is_edge: Vec<bool>,
    elements: Vec<(Shape, Vec<usize>)>,
    incompatible: bool,
    /// Position in the square of each node, for picking ends.
    at: Vec<[f64; 2]>,
}

impl Grid {
    /// nx × ny elements; `bottom` is dP/ds of the bottom side over s ∈ [0, 1] if its edges are to
    /// be Hermite.
    fn new(
        map: impl Fn(f64, f64) -> [f64; 2],
        (nx, ny): (usize, usize),
        family: ElementFamily,
        bottom: Option<&dyn Fn(f64) -> [f64; 2]>,
    ) -> Self {
        let quadratic = family == ElementFamily::Quadratic;
        let mut grid = Self {
            points: Vec::new(),
            is_derivative: Vec::new(),
            is_edge: Vec::new(),
            elements: Vec::new(),
            incompatible: family == ElementFamily::Incompatible,
            at: Vec::new(),
        };
        let mut ids = std::collections::HashMap::new();
        for i in 0..=2 * nx {
            for j in 0..=2 * ny {
                let corner = i % 2 == 0 && j % 2 == 0;
                let middle = quadratic && (i % 2 == 0 || j % 2 == 0);
                let hermite_middle = bottom.is_some() && j == 0 && i % 2 == 1;
                if !(corner || middle) || hermite_middle {
                    continue;
                }
                let (u, v) = (i as f64 / (2 * nx) as f64, j as f64 / (2 * ny) as f64);
                let id = grid.add(map(u, v), false, [u, v]);
                ids.insert((i, j), id);
                let edge = i == 0 || j == 0 || i == 2 * nx || j == 2 * ny;
                grid.is_edge.push(edge);
            }
        }
        let slopes: Vec<usize> = match bottom {
            Some(slope) => (0..=nx)
                .map(|i| {
                    let u = i as f64 / nx as f64;
                    grid.is_edge.push(true);
                    grid.add(slope(u), true, [u, 0.0])
                })
                .collect(),
            None => Vec::new(),
        };
        let side = if quadratic { Edge::Quadratic } else { Edge::Linear };
        for i in 0..nx {
            for j in 0..ny {
                let (a, b) = (2 * i, 2 * j);
                let mut nodes =
                    vec![ids[&(a, b)], ids[&(a + 2, b)], ids[&(a + 2, b + 2)], ids[&(a, b + 2)]];
                let mut shape = Shape { edges: [side; 4], half_lengths: [0.0; 4] };
                if bottom.is_some() && j == 0 {
                    shape.edges[0] = Edge::Hermite;
                    shape.half_lengths[0] = 0.5 / nx as f64;
                    nodes.extend([slopes[i], slopes[i + 1]]);
                } else if quadratic {
                    nodes.push(ids[&(a + 1, b)]);
                }
                if quadratic {
                    nodes.extend([ids[&(a + 2, b + 1)], ids[&(a + 1, b + 2)], ids[&(a, b + 1)]]);
                }
                grid.elements.push((shape, nodes));
            }
        }
        grid
    }

    fn add(&mut self, point: [f64; 2], is_derivative: bool, at: [f64; 2]) -> usize {
        self.points.push(point);
        self.is_derivative.push(is_derivative);
        self.at.push(at);
        self.points.len() - 1
    }

    /// Displacements with `given` prescribed and `load` elsewhere.
    fn solve(
        &self,
        m: &Elastic,
        given: impl Fn(usize) -> Option<[f64; 2]>,
        load: impl Fn(usize) -> [f64; 2],
    ) -> Vec<[f64; 2]> {
        let mut u: Vec<[f64; 2]> = vec![[0.0; 2]; self.points.len()];
        let mut number = vec![None; self.points.len()];
        let mut next = 0;
        for node in 0..self.points.len() {
            match given(node) {
                Some(value) => u[node] = value,
                None => {
                    number[node] = Some(next);
                    next += 2;
                }
            }
        }
        let mut right = vec![0.0; next];
        for (node, first) in number.iter().enumerate() {
            if let Some(first) = first {
                let f = load(node);
                right[*first] += f[0];
                right[first + 1] += f[1];
            }
        }
        let mut triplets = Triplets::default();
        for (shape, nodes) in &self.elements {
            let points: Vec<_> = nodes.iter().map(|n| self.points[*n]).collect();
            let k = matrices(shape, &points, m, 1.0, self.incompatible).unwrap().stiffness;
            for (a, &p) in nodes.iter().enumerate() {
                let Some(row) = number[p] else { continue };
                for (b, &q) in nodes.iter().enumerate() {
                    for r in 0..2 {
                        for c in 0..2 {
                            let value = k[(2 * a + r, 2 * b + c)];
                            match number[q] {
                                Some(column) => triplets.add(row + r, column + c, value),
                                None => right[row + r] -= value * u[q][c],
                            }
                        }
                    }
                }
            }
        }
        triplets.matrix(next, "test").unwrap().factorise("test").unwrap().solve_one(&mut right);
        for (node, first) in number.iter().enumerate() {
            if let Some(first) = first {
                u[node] = [right[*first], right[first + 1]];
            }
        }
        u
    }

    /// Root mean square of u − exact over points of all elements.
    fn error(&self, u: &[[f64; 2]], exact: impl Fn([f64; 2]) -> [f64; 2]) -> f64 {
        let (mut sum, mut count) = (0.0, 0);
        for (shape, nodes) in &self.elements {
            for xi in [-0.77, 0.0, 0.77] {
                for eta in [-0.77, 0.0, 0.77] {
                    let v = shape.at(xi, eta);
                    let (mut at, mut found) = ([0.0; 2], [0.0; 2]);
                    for (i, n) in nodes.iter().enumerate() {
                        for k in 0..2 {
                            at[k] += v.n[i] * self.points[*n][k];
                            found[k] += v.n[i] * u[*n][k];
                        }
                    }
                    let e = exact(at);
                    sum += (found[0] - e[0]).powi(2) + (found[1] - e[1]).powi(2);
                    count += 1;
                }
            }
        }
        (sum / f64::from(count)).sqrt()
    }
}

/// A bent, skewed patch whose bottom is a circular arc.
fn bent(u: f64, v: f64) -> [f64; 2] {
    let angle = 0.7 * u + 0.1 * u * v;
    let r = 2.0 + 0.8 * v + 0.1 * v * u * u;
    [r * angle.sin(), r * angle.cos()]
}

fn bent_slope(u: f64) -> [f64; 2] {
    [2.0 * 0.7 * (0.7 * u).cos(), -2.0 * 0.7 * (0.7 * u).sin()]
}

#[test]
fn patch_test() {
    // Any constant strain and rotation.
    let gradient = [[1.1e-3, -0.4e-3], [0.7e-3, 0.5e-3]];
    let linear = |p: [f64; 2]| {
        [
            2e-3 + gradient[0][0] * p[0] + gradient[0][1] * p[1],
            -1e-3 + gradient[1][0] * p[0] + gradient[1][1] * p[1],
        ]
    };
    for plane in [PlaneState::Strain, PlaneState::Stress] {
        for family in FAMILIES {
            for hermite in [false, true] {
                let slope: Option<&dyn Fn(f64) -> [f64; 2]> =
                    if hermite { Some(&bent_slope) } else { None };
                let grid = Grid::new(bent, (3, 3), family, slope);
                let value = |n: usize| {
                    let u = linear(grid.points[n]);
                    // Derivative nodes have the field's gradient times dP/ds, without the constant
                    // part.
                    let zero = linear([0.0; 2]);
                    if grid.is_derivative[n] { [u[0] - zero[0], u[1] - zero[1]] } else { u }
                };
                let given = |n: usize| grid.is_edge[n].then(|| value(n));
                let u = grid.solve(&material(plane), given, |_| [0.0; 2]);
                for (n, found) in u.iter().enumerate() {
                    let e = value(n);
                    let off = (found[0] - e[0]).abs().max((found[1] - e[1]).abs());
                    assert!(off < 1e-14, "{family:?} {hermite} {plane:?}: {off:e}");
                }
            }
        }
    }
}

#[test]
fn three_rigid_motions_and_no_other_free_one() {
    for family in FAMILIES {
        for hermite in [false, true] {
            let slope: Option<&dyn Fn(f64) -> [f64; 2]> =
                if hermite { Some(&bent_slope) } else { None };
            let grid = Grid::new(bent, (1, 1), family, slope);
            let (shape, nodes) = &grid.elements[0];
            let points: Vec<_> = nodes.iter().map(|n| grid.points[*n]).collect();
            let m = material(PlaneState::Strain);
            let k = matrices(shape, &points, &m, 1.0, grid.incompatible).unwrap();
            let eigen = SymmetricEigen::new(k.stiffness.clone());
            let largest = eigen.eigenvalues.amax();
            let free = eigen.eigenvalues.iter().filter(|l| l.abs() < 1e-10 * largest).count();
            assert_eq!(free, 3, "{family:?} {hermite}");
            // Rotation about the origin turns positions and derivatives alike.
            let turn =
                DVector::from_iterator(2 * nodes.len(), points.iter().flat_map(|[x, y]| [-y, *x]));
            assert!((&k.stiffness * &turn).amax() < 1e-9 * largest);
            // With ω = `turn`, ωᵀMω is the polar inertia ρ ∫ r² dA of the element.
            let shift = DVector::from_iterator(
                2 * nodes.len(),
                nodes.iter().flat_map(|n| [f64::from(u8::from(!grid.is_derivative[*n])), 0.0]),
            );
            let (mass, inertia) = (shift.dot(&(&k.mass * &shift)), turn.dot(&(&k.mass * &turn)));
            if family == ElementFamily::Quadratic && hermite {
                // Area and polar moment of the mapped patch by a fine grid of polygons. Elements
                // with straight sides only approximate them, and are not compared.
                let (mut area, mut polar) = (0.0, 0.0);
                let n = 400;
                for i in 0..n {
                    for j in 0..n {
                        let c =
                            [0, 1].map(|d| bent((i + d) as f64 / n as f64, j as f64 / n as f64));
                        let d = [0, 1]
                            .map(|d| bent((i + d) as f64 / n as f64, (j + 1) as f64 / n as f64));
                        let (p, q) = (
                            [d[1][0] - c[0][0], d[1][1] - c[0][1]],
                            [d[0][0] - c[1][0], d[0][1] - c[1][1]],
                        );
                        let cell = 0.5 * (p[0] * q[1] - p[1] * q[0]).abs();
                        let mid = [0, 1].map(|k| 0.25 * (c[0][k] + c[1][k] + d[0][k] + d[1][k]));
                        area += cell;
                        polar += cell * (mid[0] * mid[0] + mid[1] * mid[1]);
                    }
                }
                assert!((mass / (2.0 * area) - 1.0).abs() < 2e-3, "{mass} {area}");
                assert!((inertia / (2.0 * polar) - 1.0).abs() < 4e-3, "{inertia} {polar}");
            }
        }
    }
}

/// Displacements of a plane-strain field without body force: Kolosov–Muskhelishvili with
/// φ = z³ and ψ = 1/(z − c), c outside the body. 2μ u = κ φ − z φ̄' − ψ̄.
fn smooth(m: &Elastic, p: [f64; 2]) -> [f64; 2] {
    let (e, nu) = m.plane_strain_equivalent();
    let (mu, kappa) = (0.5 * e / (1.0 + nu), 3.0 - 4.0 * nu);
    let multiply =
        |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let conjugate = |a: [f64; 2]| [a[0], -a[1]];
    let (square, s) = (multiply(p, p), 1e4);
    let phi = multiply(square, p).map(|x| s * x);
    let slope = square.map(|x| 3.0 * s * x);
    let d = [p[0] - 0.5, p[1] + 1.0];
    let norm = d[0] * d[0] + d[1] * d[1];
    let psi = [s * d[0] / norm, -s * d[1] / norm];
    let middle = multiply(p, conjugate(slope));
    let back = conjugate(psi);
    [0, 1].map(|k| (kappa * phi[k] - middle[k] - back[k]) / (2.0 * mu))
}

#[test]
fn orders_of_convergence_on_a_manufactured_solution() {
    let m = material(PlaneState::Strain);
    for (family, hermite, order) in [
        (ElementFamily::Linear, false, 2.0),
        (ElementFamily::Linear, true, 2.0),
        (ElementFamily::Incompatible, false, 2.0),
        (ElementFamily::Quadratic, false, 3.0),
        (ElementFamily::Quadratic, true, 3.0),
    ] {
        let slope: Option<&dyn Fn(f64) -> [f64; 2]> =
            if hermite { Some(&bent_slope) } else { None };
        let errors = [8usize, 16, 32].map(|n| {
            let grid = Grid::new(bent, (n, n), family, slope);
            // dP/ds of the field along the bottom, by differences of the exact field.
            let value = |node: usize| {
                if !grid.is_derivative[node] {
                    return smooth(&m, grid.points[node]);
                }
                let u = grid.at[node][0];
                let d = 1e-5;
                let (a, b) = (smooth(&m, bent(u + d, 0.0)), smooth(&m, bent(u - d, 0.0)));
                [0, 1].map(|k| (a[k] - b[k]) / (2.0 * d))
            };
            let given = |node: usize| grid.is_edge[node].then(|| value(node));
            let u = grid.solve(&m, given, |_| [0.0; 2]);
            grid.error(&u, |p| smooth(&m, p))
        });
        let rates = [0, 1].map(|i: usize| (errors[i] / errors[i + 1]).log2());
        println!("{family:?} hermite {hermite}: {errors:?} {rates:?}");
        assert!((rates[1] - order).abs() < 0.15, "{family:?} {hermite} {rates:?}");
    }
}

/// MacNeal & Harder's curved beam (Finite Elem. Anal. Des. 1 (1985) 3–20): a quarter ring of radii
/// 4.12 and 4.32, thickness 0.1, unit shear at the end. Timoshenko & Goodier §33 gives the end
/// displacement π (a² + b²) P/(t E [(a² − b²) + (a² + b²) ln(b/a)]) along the load.
fn curved_beam(family: ElementFamily, n: usize, hermite: bool) -> f64 {
    let m = Elastic { young: 1e7 * 0.1, ..material(PlaneState::Stress) };
    let (a, b) = (4.12, 4.32);
    let right_angle = std::f64::consts::FRAC_PI_2;
    let ring = |u: f64, v: f64| {
        let (r, angle) = (a + (b - a) * v, right_angle * u);
        [r * angle.sin(), r * angle.cos()]
    };
    let slope = |u: f64| {
        let angle = right_angle * u;
        [a * right_angle * angle.cos(), -a * right_angle * angle.sin()]
    };
    let slope: Option<&dyn Fn(f64) -> [f64; 2]> = if hermite { Some(&slope) } else { None };
    let grid = Grid::new(ring, (n, 1), family, slope);
    // Clamped at u = 0, radial (x) force at u = 1, parabolic in effect: shared as 1/6, 4/6, 1/6.
    let given =
        |node: usize| (grid.at[node][0] == 0.0 && !grid.is_derivative[node]).then_some([0.0; 2]);
    let quadratic = family == ElementFamily::Quadratic;
    let load = |node: usize| {
        let at = grid.at[node];
        if at[0] < 1.0 || grid.is_derivative[node] {
            return [0.0; 2];
        }
        let share = match (quadratic, at[1]) {
            (true, 0.5) => 4.0 / 6.0,
            (true, _) => 1.0 / 6.0,
            (false, _) => 0.5,
        };
        [share, 0.0]
    };
    let u = grid.solve(&m, given, load);
    let end: Vec<f64> = (0..u.len())
        .filter(|n| grid.at[*n][0] == 1.0 && !grid.is_derivative[*n])
        .map(|n| u[n][0])
        .collect();
    let found = end.iter().sum::<f64>() / end.len() as f64;
    let (a2, b2): (f64, f64) = (a * a, b * b);
    let exact =
        std::f64::consts::PI * (a2 + b2) / (1e7 * 0.1 * ((a2 - b2) + (a2 + b2) * (b / a).ln()));
    found / exact
}

#[test]
fn the_plain_quadrilateral_locks_in_bending_and_the_others_do_not() {
    // Six elements as in the source: the four-node element finds less than a tenth.
    let linear = curved_beam(ElementFamily::Linear, 6, false);
    let better = curved_beam(ElementFamily::Incompatible, 6, false);
    let best = curved_beam(ElementFamily::Quadratic, 6, false);
    println!("six elements: linear {linear:.3}, incompatible {better:.3}, quadratic {best:.3}");
    let expected = [(linear, 0.072), (better, 0.875), (best, 0.869)];
    assert!(expected.iter().all(|(found, stated)| (found - stated).abs() < 0.001));
    for (family, hermite) in [
        (ElementFamily::Incompatible, false),
        (ElementFamily::Quadratic, false),
        (ElementFamily::Quadratic, true),
    ] {
        let found = curved_beam(family, 24, hermite);
        println!("24 elements: {family:?} hermite {hermite} {found:.4}");
        assert!((found - 1.0).abs() < 0.02, "{family:?} {found}");
    }
}

#[test]
fn an_element_inside_out_is_an_error() {
    let points = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    let m = material(PlaneState::Strain);
    assert!(matrices(&Shape::LINEAR, &points, &m, 1.0, false).is_err());
    let sound: DMatrix<f64> =
        matrices(&Shape::LINEAR, &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &m, 1.0, true)
            .unwrap()
            .stiffness;
    assert!((&sound - sound.transpose()).amax() < 1e-6 * sound.amax());
}
