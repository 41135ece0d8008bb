//! Terms of the rotating carrier frame in time: free bodies against closed forms, a loaded set against the
//! gyroscopic modes of its linearisation.

use std::f64::consts::TAU;

use dynamics::gyroscopic_modes;
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{
    Loading, MeshLawSet, MeshLawSettings, NominalRotation, VibratingSet, mesh_law,
};
use gearset::{Axis, Body, Facing, MeshKind, PathDirection};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use scene::{Fidelity, Scene};

type C = nalgebra::Complex<f64>;

/// Masses of bodies (kg), their z and v at the start (m, m/s), and z at the end of each step.
type Vibration = (Vec<f64>, Vec<C>, Vec<C>, Vec<Vec<C>>);

fn scene(name: &str) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    // A coarse FE mesh suffices: no statement tested here depends on it.
    scene.fe_contact.flank_elements = 8;
    scene.dynamics.fidelity = Fidelity::QuasiStatic;
    scene
}

/// The scene without any damping.
fn undamped(mut scene: Scene) -> Scene {
    scene.damping.mass_proportional_per_s = 0.0;
    scene.damping.stiffness_proportional_s = 0.0;
    scene.damping.bearing_s = 0.0;
    scene
}

const FREQUENCY: f64 = 20_000.0;
const STEPS: usize = 28;
/// Step of a turning set, s.
const STEP: f64 = 1.0 / (FREQUENCY * STEPS as f64);

/// An unloaded turning set at rest.
fn unloaded<'b>(scene: &Scene, bodies: &'b Bodies) -> VibratingSet<'b> {
    let rotation = NominalRotation::Turning {
        mesh_frequency: FREQUENCY,
        steps_per_cycle: STEPS,
        direction: PathDirection::Forward,
    };
    let (none, loading) = (Imperfections::default(), Loading { torque_nm: 0.0, mesh_force: 8e3 });
    let made = VibratingSet::new(scene, bodies, Facing::CounterClockwise, none, rotation, loading);
    let mut set = made.unwrap();
    set.rest(0.0).unwrap();
    set
}

/// Moves coordinates by distances (m) in 40 steps: a pulse of one step, F h = m v, starts them and another stops them.
fn shift(set: &mut VibratingSet<'_>, by: &[(usize, f64)]) {
    for sign in [1.0, -1.0] {
        for &(at, distance) in by {
            let speed = sign * distance / (40.0 * STEP);
            set.external[at] = set.masses()[at] * speed / STEP;
        }
        set.step().unwrap();
        set.external.fill(0.0);
        if sign > 0.0 {
            (0..39).for_each(|_| set.step().unwrap());
        }
    }
}

/// Bodies that touch nothing but their bearings, in a frame turning at Ω, with z = x + iy for each:
///
/// ```text
/// M (z̈ + 2iΩ ż − Ω² z) + K z = 0,   so w = z e^{iΩt} obeys M ẅ + K w = 0 as in space,
/// z = Σ φ_j (A_j e^{s₁t} + B_j e^{s₂t}),   s = i(−Ω ± ω_j),   K φ_j = ω_j² M φ_j
/// ```
///
/// Each plane of vibration stands still in space. Newmark's average acceleration is the trapezoidal rule and
/// multiplies each term by (1 + sh/2)/(1 − sh/2) a step.
struct FreeBodies {
    /// ω_j, rad/s.
    omega: Vec<f64>,
    /// M-orthonormal shapes, one a column.
    shapes: DMatrix<f64>,
    mass: Vec<f64>,
}

impl FreeBodies {
    fn new(mass: Vec<f64>, stiffness: &DMatrix<f64>) -> Self {
        let n = mass.len();
        let scaled = DMatrix::from_fn(n, n, |i, j| stiffness[(i, j)] / (mass[i] * mass[j]).sqrt());
        let found = SymmetricEigen::new(scaled);
        let shapes = DMatrix::from_fn(n, n, |i, j| found.eigenvectors[(i, j)] / mass[i].sqrt());
        Self { omega: found.eigenvalues.iter().map(|x| x.sqrt()).collect(), shapes, mass }
    }

    /// z of every body at the end of each of `count` steps from z and v in a frame turning at `speed` (rad/s).
    fn path(&self, z: &[C], v: &[C], speed: f64, count: usize) -> Vec<Vec<C>> {
        let i = C::i();
        let modal = |x: &[C], j: usize| -> C {
            (0..x.len()).map(|k| x[k] * (self.mass[k] * self.shapes[(k, j)])).sum()
        };
        let mut terms: Vec<[(C, C); 2]> = (0..self.omega.len())
            .map(|j| {
                let s = [1.0, -1.0].map(|sign| i * (sign * self.omega[j] - speed));
                // A + B = z, s₁A + s₂B = v
                let (z, v) = (modal(z, j), modal(v, j));
                let a = (v - s[1] * z) / (s[0] - s[1]);
                let factor = |s: C| (1.0 + s * 0.5 * STEP) / (1.0 - s * 0.5 * STEP);
                [(a, factor(s[0])), (z - a, factor(s[1]))]
            })
            .collect();
        (0..count)
            .map(|_| {
                terms.iter_mut().flatten().for_each(|(term, factor)| *term *= *factor);
                let of = |body: usize| {
                    let of_mode =
                        |(j, t): (usize, &[(C, C); 2])| (t[0].0 + t[1].0) * self.shapes[(body, j)];
                    terms.iter().enumerate().map(of_mode).sum()
                };
                (0..z.len()).map(of).collect()
            })
            .collect()
    }
}

/// In an unloaded set whose sun and planets are turned into the middle of their backlash nothing touches: the
/// sun vibrates on its bearing, the planets on theirs with the carrier, which is made rigid, on its own. With
/// the ring held the carrier turns at Ω = 2π f_m/Z_r.
#[test]
fn free_bodies_vibrate_in_planes_that_stand_still_in_space() {
    const COUNT: usize = 600;
    let mut scene = undamped(scene("oh58_3p"));
    scene.geometry.as_mut().unwrap().carrier.as_mut().unwrap().is_rigid = true;
    let bodies = Bodies::new(&scene).unwrap();
    let psi = scene.planets.psi_rad.clone();
    let planets = psi.len();
    let backlash = |kind| bodies.geometry.normal_backlash(kind).unwrap();
    let (of_sun, of_ring) = (backlash(MeshKind::SunPlanet), backlash(MeshKind::RingPlanet));
    // Bodies of the closed form: sun, carrier, planets.
    let moving = [Body::Sun, Body::Carrier].into_iter();
    let moving: Vec<Body> = moving.chain((0..planets).map(Body::Planet)).collect();
    let run = |gyroscopic: bool| -> Vibration {
        let mut scene = scene.clone();
        scene.dynamics.gyroscopic = gyroscopic;
        let mut set = unloaded(&scene, &bodies);
        let at = |set: &VibratingSet<'_>, body, axis| set.races().of(body, axis).unwrap();
        // Counter-clockwise turns of sun and planet open the sun meshes' front flanks by −(u_s + u_p), those of
        // the ring meshes by u_p.
        let mut turns = vec![(at(&set, Body::Sun, Axis::Rotation), -0.5 * (of_sun + of_ring))];
        turns.extend(
            (0..planets).map(|n| (at(&set, Body::Planet(n), Axis::Rotation), 0.5 * of_ring)),
        );
        shift(&mut set, &turns);
        // Lateral pulses of one step: 10 µm for each body alone.
        for (body, axis) in [
            (Body::Sun, Axis::First),
            (Body::Carrier, Axis::Second),
            (Body::Planet(1), Axis::First),
        ] {
            let at = at(&set, body, axis);
            let m = set.masses()[at];
            set.external[at] = 10e-6 * (scene.supports.sun.bearing_n_per_m * m).sqrt() / STEP;
        }
        set.step().unwrap();
        set.external.fill(0.0);
        // The force of a pulse acts on both steps beside its end.
        set.step().unwrap();
        let here = |set: &VibratingSet<'_>| -> (Vec<C>, Vec<C>) {
            let of = |body: &Body| {
                let [x, y] = Axis::TRANSLATIONS.map(|axis| set.races().of(*body, axis).unwrap());
                let turned = match body {
                    Body::Planet(n) => C::from_polar(1.0, psi[*n]),
                    _ => C::from(1.0),
                };
                let m = set.motion();
                (turned * C::new(m.x[x], m.x[y]), turned * C::new(m.v[x], m.v[y]))
            };
            moving.iter().map(of).unzip()
        };
        let mass = moving.iter().map(|body| set.masses()[at(&set, *body, Axis::First)]).collect();
        let (z, v) = here(&set);
        let mut forces = Vec::new();
        let path = (0..COUNT)
            .map(|_| {
                set.step().unwrap();
                set.mesh_forces(&mut forces);
                assert!(forces.iter().all(|p| p.abs() < 1e-6), "nothing may touch: {forces:?}");
                here(&set).0
            })
            .collect();
        (mass, z, v, path)
    };
    let bearing = scene.supports.planet_bearing_n_per_m;
    let stiffness = DMatrix::from_fn(2 + planets, 2 + planets, |i, j| match (i, j) {
        (0, 0) => scene.supports.sun.bearing_n_per_m,
        (1, 1) => scene.supports.carrier.bearing_n_per_m + planets as f64 * bearing,
        (i, j) if i == j => bearing,
        (1, 2..) | (2.., 1) => -bearing,
        _ => 0.0,
    });
    let carrier = TAU * FREQUENCY / 99.0;
    // The planes turn by more than a radian.
    assert!(COUNT as f64 * STEP * carrier > 1.0);
    let apart = |(mass, z, v, path): &Vibration, speed: f64| {
        let expected = FreeBodies::new(mass.clone(), &stiffness).path(z, v, speed, path.len());
        let of = |body: usize| {
            let size = path.iter().map(|z| z[body].norm()).fold(0.0f64, f64::max);
            let pairs = path.iter().zip(&expected);
            pairs.map(|(a, b)| (a[body] - b[body]).norm()).fold(0.0f64, f64::max) / size
        };
        (0..2 + planets).map(of).collect::<Vec<f64>>()
    };
    let (turning, still) = (run(true), run(false));
    let right = apart(&turning, carrier);
    println!("{right:?}");
    assert!(right.iter().all(|off| *off < 1e-9), "{right:?}");
    // The opposite sense, and no terms at all, are far off in every body.
    for speed in [-carrier, 0.0] {
        let wrong = apart(&turning, speed);
        assert!(wrong.iter().all(|off| *off > 0.3), "{speed}: {wrong:?}");
    }
    let right = apart(&still, 0.0);
    assert!(right.iter().all(|off| *off < 1e-9), "{right:?}");
}

/// A loaded set linearised about its equilibrium: masses (kg), stiffness (N/m) averaged over a mesh cycle, and the
/// two coordinates of each translation.
struct Linearised {
    mass: Vec<f64>,
    stiffness: DMatrix<f64>,
    translations: Vec<[usize; 2]>,
}

/// Torque on the sun, N·m.
const TORQUE: f64 = 2500.0;

impl Linearised {
    fn mean(scene: &Scene, bodies: &Bodies) -> Self {
        const POSITIONS: usize = 10;
        let planets = scene.planets.count();
        let mesh_force =
            TORQUE / planets as f64 / bodies.geometry.sun.as_ref().unwrap().base_radius;
        let at = |k: usize| {
            let position = k as f64 / POSITIONS as f64;
            let rotation = NominalRotation::Standing { position, step: 1e-5 };
            let loading = Loading { torque_nm: TORQUE, mesh_force };
            let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
            let made = VibratingSet::new(scene, bodies, sense, none, rotation, loading);
            let mut set = made.unwrap();
            set.rest(TORQUE).unwrap();
            set
        };
        let sets: Vec<VibratingSet<'_>> = (0..POSITIONS).map(at).collect();
        let sum: DMatrix<f64> = sets.iter().map(|set| set.linearised().unwrap().stiffness()).sum();
        let races = sets[0].races();
        let of = |body| Some([races.of(body, Axis::First)?, races.of(body, Axis::Second)?]);
        Self {
            mass: sets[0].masses().to_vec(),
            stiffness: sum / POSITIONS as f64,
            translations: Body::all(planets).filter_map(of).collect(),
        }
    }

    /// Frequency (Hz) and shape of the lowest mode in which the carrier whirls forward (counter-clockwise) or
    /// backward, in a frame turning at `speed` (rad/s); at 0 the two halves are one pair of planes.
    fn whirl(&self, forward: bool, speed: f64) -> (f64, Vec<C>) {
        let n = self.mass.len();
        let (mut g, mut k) = (DMatrix::zeros(n, n), self.stiffness.clone());
        for &[x, y] in &self.translations {
            // m (ẍ − 2Ωẏ − Ω²x) = F_x, m (ÿ + 2Ωẋ − Ω²y) = F_y
            let m = self.mass[x];
            g[(x, y)] = -2.0 * m * speed;
            g[(y, x)] = 2.0 * m * speed;
            k[(x, x)] -= m * speed * speed;
            k[(y, y)] -= m * speed * speed;
        }
        let modes = gyroscopic_modes(&self.mass, &g, &k).unwrap();
        let [x, y] = self.translations[0];
        let shapes = modes.iter().map(|mode| {
            (mode.omega / TAU, mode.vector.iter().map(|v| C::new(v.0, v.1)).collect::<Vec<C>>())
        });
        let mut fitting = shapes.filter(|(_, q)| {
            let [ahead, back] = circles(q[x], q[y]).map(|z| z.norm());
            let (own, other) = if forward { (ahead, back) } else { (back, ahead) };
            // Modes that do not move the carrier have neither.
            own + other > 1e-3 && (speed == 0.0 || own > 10.0 * other)
        });
        fitting.next().unwrap()
    }

    /// Where the harmonic h of the mesh frequency meets that mode: f = f_mode(Ω), Ω = ±2π f/(h Z_r), Hz; and the shape
    /// there.
    fn peak(&self, forward: bool, harmonic: usize, sign: f64) -> (f64, Vec<C>) {
        let mut found = self.whirl(forward, 0.0);
        for _ in 0..6 {
            found = self.whirl(forward, sign * TAU * found.0 / (harmonic as f64 * 88.0));
        }
        found
    }
}

/// x = Re(X e^{iωt}) and y = Re(Y e^{iωt}) as circles: x + iy = z₊ e^{iωt} + z₋ e^{−iωt}.
fn circles(x: C, y: C) -> [C; 2] {
    let i = C::i();
    [0.5 * (x + i * y), 0.5 * (x.conj() + i * y.conj())]
}

/// Least squares of a complex system.
fn solved(rows: &[Vec<C>], right: &[C]) -> DVector<C> {
    let a = DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j]);
    a.svd(true, true).solve(&DVector::from_column_slice(right), 1e-14).unwrap()
}

/// The pole f₀ of answers z (f₀ − f) = a + b f over frequency.
fn pole(frequencies: &[f64], answers: &[C]) -> C {
    let rows: Vec<Vec<C>> = frequencies
        .iter()
        .zip(answers)
        .map(|(f, z)| vec![*z, C::from(-1.0), C::from(-*f)])
        .collect();
    let right: Vec<C> = frequencies.iter().zip(answers).map(|(f, z)| z * *f).collect();
    solved(&rows, &right)[0]
}

/// a + b f₀ of answers whose pole f₀ is known: the part of the mode in them.
fn residue(frequencies: &[f64], answers: &[C], pole: C) -> C {
    let rows: Vec<Vec<C>> = frequencies.iter().map(|f| vec![C::from(1.0), C::from(*f)]).collect();
    let right: Vec<C> = frequencies.iter().zip(answers).map(|(f, z)| z * (pole - *f)).collect();
    let found = solved(&rows, &right);
    found[0] + found[1] * pole
}

/// How alike two shapes are, 0 to 1.
fn likeness(a: &[C], b: &[C]) -> f64 {
    let dot: C = a.iter().zip(b).map(|(a, b)| a.conj() * b).sum();
    let square = |a: &[C]| a.iter().map(|z| z.norm_sqr()).sum::<f64>();
    dot.norm_sqr() / (square(a) * square(b))
}

/// Peaks of a loaded, turning set are where harmonics of the mesh meet its gyroscopic modes.
///
/// With five equally spaced planets and 42 sun teeth planet n is 2n/5 of a mesh cycle ahead, so that harmonic 2 turns
/// backward (2·42 = −1 mod 5) through the carrier frame and harmonic 3 forward (+1), and each can excite one half of a
/// translational pair only. In a frame turning at Ω > 0 the forward half is lower and the backward half higher than
/// both are without gyroscopic terms.
///
/// Frequencies are compared with and without the terms, so that what the linearisation leaves out (stiffness that
/// varies with the mesh, curves of mesh force that are not straight) matters only where it changes the shift: 2 %.
#[test]
fn peaks_of_a_turning_set_are_those_of_its_gyroscopic_modes() {
    const STEPS: usize = 70;
    let mut scene = scene("five_planets");
    let bodies = Bodies::new(&scene).unwrap();
    let linear = Linearised::mean(&scene, &bodies);
    let (sense, settings) = (Facing::CounterClockwise, MeshLawSettings::at(TORQUE));
    let law = mesh_law(&scene, &bodies, sense, STEPS, &settings).unwrap();
    // Complex amplitudes of one harmonic, by coordinate.
    let answer = |scene: &Scene, frequency: f64, harmonic: usize| -> Vec<C> {
        let mesh = frequency / harmonic as f64;
        let made = MeshLawSet::new(scene, &bodies, sense, mesh, TORQUE, law.clone());
        let mut set = made.unwrap();
        set.rest(TORQUE).unwrap();
        // 2 % damping: e^{−29} of the start is left after 120 cycles at harmonic 2.
        (0..120 * STEPS).for_each(|_| set.step().unwrap());
        let mut sum = vec![C::from(0.0); set.races().count];
        for i in 0..STEPS {
            set.step().unwrap();
            let turned =
                C::from_polar(2.0 / STEPS as f64, -TAU * (i * harmonic) as f64 / STEPS as f64);
            sum.iter_mut().zip(&set.motion().x).for_each(|(sum, x)| *sum += turned * *x);
        }
        sum
    };
    let free = linear.whirl(true, 0.0).0;
    let frequencies: Vec<f64> = (-3..=3).map(|k| free * (1.0 + 0.006 * f64::from(k))).collect();
    let [x, y] = linear.translations[0];
    for (harmonic, forward) in [(2, false), (3, true)] {
        let [still, turning] = [false, true].map(|gyroscopic| {
            scene.dynamics.gyroscopic = gyroscopic;
            let answers: Vec<Vec<C>> =
                frequencies.iter().map(|f| answer(&scene, *f, harmonic)).collect();
            // Each central member whirls in the one sense only.
            for q in &answers {
                for &[x, y] in &linear.translations[..2] {
                    let [ahead, back] = circles(q[x], q[y]).map(|z| z.norm());
                    let (own, other) = if forward { (ahead, back) } else { (back, ahead) };
                    assert!(own > 1e-7 && other < 1e-9 * own, "{harmonic}: {own:e} {other:e}");
                }
            }
            let of = |j: usize| answers.iter().map(|q| q[j]).collect::<Vec<C>>();
            let found = pole(&frequencies, &of(x));
            let also = pole(&frequencies, &of(y));
            assert!((found - also).norm() < 1e-6 * found.norm());
            let shape: Vec<C> =
                (0..answers[0].len()).map(|j| residue(&frequencies, &of(j), found)).collect();
            (found.re, shape)
        });
        let (expected, shape) = linear.peak(forward, harmonic, 1.0);
        let at_rest = linear.peak(forward, harmonic, 0.0).0;
        // The trapezoidal rule answers at ω as the equations do at 2/h tan(ωh/2).
        let half = 0.5 * TAU * harmonic as f64 / STEPS as f64;
        let [still, turning] = [still, turning].map(|(f, shape)| (f * half.tan() / half, shape));
        let (found, size) = (turning.0 / still.0 - 1.0, expected / at_rest - 1.0);
        let alike = likeness(&turning.1, &shape);
        println!(
            "harmonic {harmonic}: {:.2} and {:.2} Hz, linearised {at_rest:.2} and {expected:.2}; shift {:.3} %, {:.3} %; \
             shapes {alike:.5}",
            still.0,
            turning.0,
            100.0 * found,
            100.0 * size
        );
        assert!((still.0 / at_rest - 1.0).abs() < 2e-3);
        assert_eq!(size < 0.0, forward);
        assert!((found / size - 1.0).abs() < 0.02, "harmonic {harmonic}: {found:e} {size:e}");
        assert!(alike > 0.999, "harmonic {harmonic}: {alike}");
        // The other half of the pair, and the gyroscopic matrix with the other sign, do not fit.
        assert!(likeness(&turning.1, &linear.peak(!forward, harmonic, 1.0).1) < 1e-6);
        let reversed = linear.peak(forward, harmonic, -1.0).0 / at_rest - 1.0;
        assert!(
            (found / reversed - 1.0).abs() > 1.5,
            "harmonic {harmonic}: {found:e} {reversed:e}"
        );
    }
}
