//! Shooting and Floquet multipliers of coupled systems against closed forms, determinants and marching.

use dynamics::{
    AverageAcceleration, CarriedChange, Coupled, CoupledDerivative, CoupledError, Coupling,
    CouplingForce, LinearPart, MapDerivative, PassedSteps, PeriodMap, ShootingSettings,
    multipliers, shoot,
};
use nalgebra::DMatrix;

const STEPS: usize = 60;

/// One spring for each coupling: linear, of stiffness k (1 + a cos 2π s/S), or with a gap of half-width g.
#[derive(Clone)]
struct Springs {
    stiffness: f64,
    variation: f64,
    gap: f64,
}

impl CouplingForce for Springs {
    fn answer(&self, _: usize, step_in_cycle: usize, deflection: f64) -> (f64, f64) {
        let angle = std::f64::consts::TAU * step_in_cycle as f64 / STEPS as f64;
        let k = self.stiffness * (1.0 + self.variation * angle.cos());
        let beyond = deflection.abs() - self.gap;
        if beyond > 0.0 { (k * beyond * deflection.signum(), k) } else { (0.0, 0.0) }
    }
}

/// A chain of two masses on springs, driven by a steady force and one that varies with the cycle.
fn chain(law: Springs, damping: f64, lag: f64, period: f64) -> Coupled<Springs> {
    let linear = LinearPart {
        mass: vec![1.0, 0.7],
        damping: DMatrix::from_row_slice(2, 2, &[2.0 * damping, -damping, -damping, damping]),
        stiffness: DMatrix::from_row_slice(2, 2, &[900.0, -500.0, -500.0, 600.0]),
    };
    let coupling = |row: [f64; 2]| Coupling { row: row.to_vec(), offset: 0.0, lag };
    let couplings = [coupling([1.0, 0.0]), coupling([-0.4, 1.0])];
    let rule = AverageAcceleration::new(period / STEPS as f64).unwrap();
    let mut system = Coupled::new(&linear, &couplings, &[], law, rule, STEPS).unwrap();
    system.set_external(&[0.3, 0.0]).unwrap();
    for step in 0..STEPS {
        let angle = std::f64::consts::TAU * step as f64 / STEPS as f64;
        system.add_in_cycle(step, &[0.15 * angle.cos(), 0.03 * (2.0 * angle).sin()]).unwrap();
    }
    system.rest().unwrap();
    system
}

/// Cycles of a system, with their records.
struct Cycles {
    system: Coupled<Springs>,
    /// Displacements at every step of the last two cycles.
    records: [Vec<Vec<f64>>; 2],
    follows: [bool; 2],
    /// States of the last cycle.
    passed: PassedSteps,
    /// Factor on one entry of the derivative.
    spoilt: f64,
    /// Factor on all of it where a rough one is asked for, and how many were.
    rough: f64,
    rough_ones: usize,
    /// Periods marched, and the one of which a step in the middle fails.
    marched: usize,
    failing: Option<usize>,
    scale: f64,
}

impl Cycles {
    fn new(system: Coupled<Springs>) -> Self {
        let records = [Vec::new(), Vec::new()];
        let passed = PassedSteps::default();
        let (spoilt, rough, scale) = (1.0, 1.0, 1.0);
        Self {
            system,
            records,
            follows: [false; 2],
            passed,
            spoilt,
            rough,
            rough_ones: 0,
            marched: 0,
            failing: None,
            scale,
        }
    }

    /// Largest change of the last cycle from the one before it; infinite unless the one followed the other.
    fn change(&self) -> f64 {
        if !self.follows[0] {
            return f64::INFINITY;
        }
        let [now, before] = &self.records;
        let each = now.iter().flatten().zip(before.iter().flatten());
        each.fold(0.0f64, |a, (x, y)| a.max((x - y).abs())) / self.scale
    }

    /// Carried along with the steps.
    fn carried(&mut self, steps: usize) -> MapDerivative {
        let mut derivative: CoupledDerivative = self.system.start_derivative();
        for _ in 0..steps {
            self.system.step().unwrap();
            self.system.carry_derivative(&mut derivative);
        }
        self.system.map_derivative(&derivative, 30.0)
    }
}

impl PeriodMap for Cycles {
    type Error = CoupledError;

    fn coordinates(&mut self) -> Vec<f64> {
        self.system.coordinates()
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), CoupledError> {
        self.follows[1] = false;
        self.system.set_coordinates(y)
    }

    fn advance(&mut self) -> Result<(), CoupledError> {
        self.follows = [self.follows[1], true];
        self.passed.clear();
        self.system.keep_step(&mut self.passed);
        let mut record = Vec::new();
        self.marched += 1;
        for step in 0..STEPS {
            if self.failing == Some(self.marched) && step == STEPS / 3 {
                let (time_s, value) = (self.system.time(), f64::NAN);
                return Err(CoupledError::Diverged { time_s, coordinate: 0, value });
            }
            self.system.step()?;
            self.system.keep_step(&mut self.passed);
            record.push(self.system.displacements());
        }
        self.records = [record, std::mem::take(&mut self.records[0])];
        Ok(())
    }

    fn derivative(&mut self) -> Result<MapDerivative, CoupledError> {
        let mut own =
            self.system.derivative_of::<f64>(&self.passed, 30.0).expect("a cycle was marched");
        own.columns[(0, 0)] *= self.spoilt;
        Ok(own)
    }

    fn rough_derivative(&mut self) -> Result<MapDerivative, CoupledError> {
        self.rough_ones += 1;
        let mut own = self.derivative()?;
        own.columns *= self.rough;
        Ok(own)
    }

    fn relative(&self, deviation: &[f64]) -> f64 {
        let x = self.system.displacements_of(deviation);
        x.iter().fold(0.0f64, |a, x| a.max(x.abs())) / self.scale
    }

    fn derivative_and_change(
        &mut self,
        residual: &[f64],
    ) -> Result<(MapDerivative, f64), CoupledError> {
        let (system, mut largest) = (&self.system, 0.0f64);
        let hear = &mut |x: &[f64]| {
            let x = system.displacements_of(x);
            largest = x.iter().fold(largest, |a, x| a.max(x.abs()));
        };
        let change = CarriedChange { start: residual, hear };
        let own = system.derivative_with(&self.passed, 30.0, change).expect("a cycle was marched");
        Ok((own, largest / self.scale))
    }
}

const SETTINGS: ShootingSettings =
    ShootingSettings { tolerance: 1e-10, settling: 0, most_periods: 60 };

/// Newmark's rule turns e^{sT} into ((1 + sh/2)/(1 − sh/2))^S for each root s of the linear system; a lag τ of a
/// spring k is a dashpot τ k.
#[test]
fn multipliers_of_a_linear_system_are_those_of_the_rule() {
    let (period, lag, damping) = (0.31, 2e-4, 0.6);
    let law = Springs { stiffness: 800.0, variation: 0.0, gap: 0.0 };
    let mut cycles = Cycles::new(chain(law, damping, lag, period));
    let found = multipliers(&cycles.carried(STEPS)).unwrap();
    // M ẍ + (C + τ Kc) ẋ + (K + Kc) x = 0 in first-order form, roots by the companion matrix.
    let rows = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, -0.4, 1.0]);
    let kc = rows.transpose() * &rows * 800.0;
    let k = DMatrix::from_row_slice(2, 2, &[900.0, -500.0, -500.0, 600.0]) + &kc;
    let c = DMatrix::from_row_slice(2, 2, &[2.0 * damping, -damping, -damping, damping]) + kc * lag;
    let mass = [1.0, 0.7];
    let a = DMatrix::from_fn(4, 4, |i, j| match (i, j) {
        (0 | 1, _) => f64::from(u8::from(j == i + 2)),
        (_, 0 | 1) => -k[(i - 2, j)] / mass[i - 2],
        _ => -c[(i - 2, j - 2)] / mass[i - 2],
    });
    let h = period / STEPS as f64;
    let mut expected: Vec<_> = a
        .complex_eigenvalues()
        .iter()
        .map(|s| {
            let half = *s * (0.5 * h);
            ((nalgebra::Complex::new(1.0, 0.0) + half) / (nalgebra::Complex::new(1.0, 0.0) - half))
                .powu(STEPS as u32)
        })
        .collect();
    expected.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
    assert_eq!(found.len(), 4);
    for (found, expected) in found.iter().zip(&expected) {
        let off = (found.re - expected.re).hypot(found.im.abs() - expected.im.abs());
        assert!(off < 1e-10, "{found:?} {expected}");
    }
}

/// Liouville: the product of the multipliers is that of the determinants of the steps.
#[test]
fn the_product_of_multipliers_is_that_of_the_steps_determinants() {
    let law = Springs { stiffness: 800.0, variation: 0.4, gap: 2e-4 };
    let mut cycles = Cycles::new(chain(law, 0.3, 0.0, 0.42));
    shoot(&mut cycles, &SETTINGS).unwrap();
    let start = cycles.coordinates();
    let whole = multipliers(&cycles.carried(STEPS)).unwrap();
    cycles.set_coordinates(&start).unwrap();
    let mut product = 1.0;
    for _ in 0..STEPS {
        product *= cycles.carried(1).columns.determinant();
    }
    let of_multipliers: f64 = whole.iter().map(|m| m.size()).product();
    assert!((of_multipliers / product.abs() - 1.0).abs() < 1e-9, "{of_multipliers} {product}");
    assert!(product > 0.0 && product < 0.95);
}

/// The derivative over a cycle in 1, 3, 5 and 20 parts, multiplied, is that over the whole cycle.
#[test]
fn multipliers_do_not_depend_on_segments() {
    let law = Springs { stiffness: 800.0, variation: 0.4, gap: 2e-4 };
    let mut cycles = Cycles::new(chain(law, 0.3, 0.0, 0.42));
    shoot(&mut cycles, &SETTINGS).unwrap();
    let start = cycles.coordinates();
    let mut first: Option<Vec<f64>> = None;
    for segments in [1, 3, 5, 20] {
        cycles.set_coordinates(&start).unwrap();
        let mut product = DMatrix::identity(4, 4);
        let mut last = None;
        for _ in 0..segments {
            let part = cycles.carried(STEPS / segments);
            product = &part.columns * product;
            last = Some(part);
        }
        let whole = MapDerivative { columns: product, ..last.unwrap() };
        let sizes: Vec<f64> = multipliers(&whole).unwrap().iter().map(|m| m.size()).collect();
        let first = first.get_or_insert_with(|| sizes.clone());
        assert!(sizes.iter().zip(first).all(|(a, b)| (a - *b).abs() < 1e-10));
    }
}

/// Shooting lands where marching does, in a tenth of the cycles and less at low damping; the derivative with one
/// entry off by 1 % takes longer.
#[test]
fn shooting_lands_where_marching_does() {
    for (damping, gap) in [(0.3, 0.0), (0.03, 0.0), (0.03, 2e-4), (0.3, 4e-4)] {
        let law = Springs { stiffness: 800.0, variation: 0.2, gap };
        let system = chain(law, damping, 1e-4, 0.29);
        let mut marched = Cycles::new(system.clone());
        let mut cycles_marched = 0;
        while marched.change() > SETTINGS.tolerance * 0.01 || cycles_marched < 3 {
            marched.advance().unwrap();
            cycles_marched += 1;
            assert!(cycles_marched < 20_000);
        }
        let mut shot = Cycles::new(system.clone());
        let found = shoot(&mut shot, &SETTINGS).unwrap();
        assert!(found.periods * 10 < cycles_marched, "{} {cycles_marched}", found.periods);
        for (a, b) in shot.system.displacements().iter().zip(marched.system.displacements()) {
            assert!((a - b).abs() < 1e-8, "{damping} {gap}: {a} {b}");
        }
        let largest = multipliers(&found.derivative).unwrap()[0].size();
        assert!(largest < 1.0);
        let mut spoilt = Cycles::new(system);
        spoilt.spoilt = 1.01;
        let with_error = shoot(&mut spoilt, &SETTINGS);
        let periods = with_error.map_or(usize::MAX, |found| found.periods);
        assert!(periods > found.periods, "{periods} {}", found.periods);
    }
}

/// A rough derivative with an error of 1e-4 leads to the solution in the same number of periods, one more at most. One
/// that is wrong is used for one correction only, and exact ones after it.
#[test]
fn corrections_by_rough_derivatives_lead_to_the_solution() {
    let law = Springs { stiffness: 800.0, variation: 0.2, gap: 2e-4 };
    let shot = |rough: f64| {
        let mut cycles = Cycles::new(chain(law.clone(), 0.03, 1e-4, 0.29));
        cycles.rough = rough;
        let found = shoot(&mut cycles, &SETTINGS).unwrap();
        (found.periods, cycles.rough_ones, cycles.system.displacements())
    };
    let (periods, ones, exact) = shot(1.0);
    assert!(ones > 0);
    for (rough, more) in [(1.0001, 1), (0.5, 4), (0.0, 4)] {
        let (taken, ones, x) = shot(rough);
        assert!(taken <= periods + more, "{rough}: {taken}, {periods}");
        assert!(rough > 0.9 || ones == 1, "{rough}: {ones}");
        for (a, b) in x.iter().zip(&exact) {
            assert!((a - b).abs() < 1e-9, "{rough}: {a} {b}");
        }
    }
}

/// A correction from the end of the first period is kept where it contracts. Where it does not, because a derivative is
/// wrong or because it leads to where no step can be taken, shooting goes on from that end as if the period had been
/// marched only to settle.
#[test]
fn periods_are_marched_to_settle_only_where_the_first_correction_is_early() {
    let shot = |gap: f64, settling: usize, rough: f64, failing: Option<usize>| {
        let law = Springs { stiffness: 800.0, variation: 0.2, gap };
        let mut cycles = Cycles::new(chain(law, 0.03, 1e-4, 0.29));
        (cycles.rough, cycles.failing) = (rough, failing);
        let found = shoot(&mut cycles, &ShootingSettings { settling, ..SETTINGS }).unwrap();
        (found.periods, cycles.system.displacements())
    };
    // Linear springs: one correction is enough. By a rough derivative of zero every end is the solution, which the next
    // period shows to be wrong.
    let (at_once, exact) = shot(0.0, 0, 1.0, None);
    assert_eq!(shot(0.0, 1, 1.0, None), (at_once, exact));
    assert_eq!(shot(0.0, 1, 0.0, None).0, at_once + 1);
    for (gap, rough, failing) in [(0.0, 0.5, None), (0.0, 1.0, Some(2)), (2e-4, 1.0, None)] {
        let (_, exact) = shot(gap, 0, 1.0, None);
        let (periods, x) = shot(gap, 1, rough, failing);
        assert!(periods > at_once && periods <= at_once + 6, "{gap} {rough}: {periods}");
        for (a, b) in x.iter().zip(&exact) {
            assert!((a - b).abs() < 1e-9, "{gap} {rough}: {a} {b}");
        }
    }
}

/// One number that a period multiplies by μ, with a derivative off by δ: a correction leaves δ/(1 − μ + δ) of the
/// error. Its periodic solution is 0.
struct Decay {
    y: f64,
    factor: f64,
    off: f64,
}

impl PeriodMap for Decay {
    type Error = std::convert::Infallible;

    fn coordinates(&mut self) -> Vec<f64> {
        vec![self.y]
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), Self::Error> {
        self.y = y[0];
        Ok(())
    }

    fn advance(&mut self) -> Result<(), Self::Error> {
        self.y *= self.factor;
        Ok(())
    }

    fn derivative(&mut self) -> Result<MapDerivative, Self::Error> {
        let columns = DMatrix::from_element(1, 1, self.factor - self.off);
        Ok(MapDerivative { active: vec![0], columns, scales: vec![1.0] })
    }

    fn relative(&self, deviation: &[f64]) -> f64 {
        deviation[0].abs()
    }

    fn derivative_and_change(
        &mut self,
        residual: &[f64],
    ) -> Result<(MapDerivative, f64), Self::Error> {
        Ok((self.derivative()?, self.relative(residual)))
    }
}

/// Shooting ends, as marching does, where a period changes little, with an error of up to ten tolerances: here one
/// correction before the error is within the tolerance.
#[test]
fn shooting_ends_with_the_change_that_is_asked_for() {
    let settings = ShootingSettings { tolerance: 1e-9, settling: 0, most_periods: 60 };
    let factor = 0.98;
    let mut decay = Decay { y: 0.5, factor, off: (1.0 - factor) / 99.0 };
    let found = shoot(&mut decay, &settings).unwrap();
    // Errors of 0.5, 5e-3, 5e-5, 5e-7 and 5e-9, the last of which changes by 1e-10.
    assert_eq!(found.periods, 5, "{found:?}");
    assert!(found.residual <= 0.3e-9 && decay.y > 4e-9 && decay.y < 6e-9, "{found:?} {}", decay.y);
}

/// Where a period takes 1e-4 of an error, the change is within the tolerance at errors 10,000 times as large: it does
/// not suffice.
#[test]
fn where_perturbations_hardly_decay_a_small_change_is_not_enough() {
    let settings = ShootingSettings { tolerance: 1e-9, settling: 0, most_periods: 60 };
    let factor = 1.0 - 1e-4;
    let mut decay = Decay { y: 0.5, factor, off: (1.0 - factor) / 19.0 };
    let found = shoot(&mut decay, &settings).unwrap();
    // Errors fall to a twentieth; at 3.1e-6 the change of a period is 3.1e-10 already.
    assert!(decay.y > 0.0 && decay.y < 1.1e-8, "{found:?} {}", decay.y);
}

/// A period that was left in its middle, after a step that failed, is begun anew by setting the coordinates.
#[test]
fn a_period_begins_where_coordinates_are_set() {
    let law = Springs { stiffness: 800.0, variation: 0.4, gap: 2e-4 };
    let mut cycles = Cycles::new(chain(law, 0.3, 1e-4, 0.42));
    cycles.advance().unwrap();
    let start = cycles.coordinates();
    cycles.advance().unwrap();
    let end = cycles.coordinates();
    cycles.failing = Some(3);
    cycles.advance().unwrap_err();
    cycles.set_coordinates(&start).unwrap();
    cycles.advance().unwrap();
    let again = cycles.coordinates();
    let size = end.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    assert!(end.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-12 * size), "{end:?} {again:?}");
}

/// Columns of the derivative against central differences, with couplings that part during the cycle.
#[test]
fn the_derivative_is_that_of_the_map() {
    let law = Springs { stiffness: 800.0, variation: 0.4, gap: 2e-4 };
    let mut cycles = Cycles::new(chain(law, 0.3, 1e-4, 0.42));
    for _ in 0..5 {
        cycles.advance().unwrap();
    }
    let start = cycles.coordinates();
    let derivative = cycles.carried(STEPS);
    cycles.set_coordinates(&start).unwrap();
    cycles.advance().unwrap();
    assert_eq!(PeriodMap::derivative(&mut cycles).unwrap(), derivative);
    cycles.set_coordinates(&start).unwrap();
    let mut touching = 0;
    for _ in 0..STEPS {
        cycles.system.step().unwrap();
        touching += usize::from(cycles.system.forces()[0] != 0.0);
    }
    assert!(touching > 0 && touching < STEPS, "{touching}");
    for j in 0..4 {
        let ends = [1.0, -1.0].map(|sign| {
            let mut y = start.clone();
            y[j] += sign * 1e-9;
            cycles.set_coordinates(&y).unwrap();
            cycles.advance().unwrap();
            cycles.coordinates()
        });
        for (i, (up, down)) in ends[0].iter().zip(&ends[1]).enumerate() {
            let found = (up - down) / 2e-9;
            let exact = derivative.columns[(i, j)];
            let size = derivative.columns.column(j).amax();
            assert!((found - exact).abs() < 1e-5 * size, "{i} {j} {found} {exact}");
        }
    }
}
