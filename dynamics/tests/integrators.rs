//! Integrators against their closed forms, their orders, their limits and their energy with contact.

use dynamics::benchmark_subjects::{
    IntegratorError, Obstacle, Scheme, VibratingSystem, amplification, closed_form,
};
use nalgebra::DMatrix;

/// Each kind, some with several parameters.
fn schemes() -> Vec<Scheme> {
    let mut all = Scheme::ALL.to_vec();
    all.extend([0.0, 0.5, 1.0].map(|rho_infinity| Scheme::GeneralizedAlpha { rho_infinity }));
    all.extend([-1.0 / 3.0, 0.0].map(|alpha| Scheme::Hht { alpha }));
    all.extend([0.7, 1.0].map(|theta| Scheme::MoreauJean { theta, restitution: 0.0 }));
    all
}

/// One step of the code against the characteristic equation. Both are exact, so that roots differ by rounding; at a
/// nearly double root by its square root.
#[test]
fn steps_amplify_as_the_closed_forms_say() {
    let mut compared = 0;
    for scheme in schemes() {
        for k in 0..60 {
            let omega_h = 10f64.powf(-2.0 + 4.0 * f64::from(k) / 59.0);
            for ratio in [0.0, 0.05] {
                let found = amplification(&scheme, omega_h, ratio).unwrap();
                let exact = closed_form(&scheme, omega_h, ratio);
                let name = format!("{} at {omega_h:.3}, ξ = {ratio}", scheme.label());
                let off = found.spectral_radius / exact.spectral_radius - 1.0;
                assert!(off.abs() < 1e-5, "{name}: {found:?} {exact:?}");
                // The smaller the phase of a step, the more rounding weighs in it.
                if let (Some(a), Some(b)) = (found.period_error, exact.period_error) {
                    assert!((a - b).abs() < 1e-5 * (1.0 + b.abs()), "{name}: {found:?} {exact:?}");
                    let (a, b) = (found.damping_ratio.unwrap(), exact.damping_ratio.unwrap());
                    assert!((a - b).abs() < 1e-5, "{name}: {found:?} {exact:?}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 1000, "{compared}");
}

/// Figures of the sources: radius at infinite frequency, and none above 1 for the implicit schemes.
#[test]
fn radii_at_infinite_frequency_are_the_published_ones() {
    let radius = |scheme| amplification(&scheme, 1e5, 0.0).unwrap().spectral_radius;
    for rho_infinity in [0.0, 0.3, 0.8, 1.0] {
        let found = radius(Scheme::GeneralizedAlpha { rho_infinity });
        // A triple root ρ∞: cube root of rounding and of 1/Ω².
        assert!((found - rho_infinity).abs() < 2e-2, "{found} {rho_infinity}");
    }
    // Hilber, Hughes & Taylor: (1 + α)/(1 − α).
    assert!((radius(Scheme::Hht { alpha: -0.3 }) - 0.7 / 1.3).abs() < 2e-2);
    assert!(radius(Scheme::Bathe) < 1e-4);
    for scheme in schemes().into_iter().filter(|s| *s != Scheme::CentralDifference) {
        for k in 0..100 {
            let omega_h = 10f64.powf(-2.0 + 0.06 * f64::from(k));
            let found = amplification(&scheme, omega_h, 0.0).unwrap().spectral_radius;
            assert!(found < 1.0 + 1e-6, "{} at {omega_h}: {found}", scheme.label());
        }
    }
}

/// Free damped vibration of three masses on springs against the fine solution: error falls as Δt², and as Δt for
/// the θ-method with θ = 1.
#[test]
fn schemes_are_of_their_order() {
    let k = DMatrix::from_row_slice(3, 3, &[2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.0]);
    let m = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![1.0, 0.5, 0.3]));
    let system = VibratingSystem::new(m, &k * 0.02, k, vec![0.1, 0.0, -0.2]).unwrap();
    let end = |scheme: &Scheme, steps: usize| {
        let integrator = scheme.prepare(&system, 3.0 / steps as f64).unwrap();
        let mut state = system.start(&[0.3, -0.1, 0.2], &[0.0, 0.5, -0.4]).unwrap();
        (0..steps).for_each(|_| integrator.step(&mut state).unwrap());
        state.x
    };
    let fine = (end(&Scheme::Bathe, 12800) * 4.0 - end(&Scheme::Bathe, 6400)) / 3.0;
    let backward = Scheme::MoreauJean { theta: 1.0, restitution: 0.0 };
    for scheme in Scheme::ALL.into_iter().chain([backward]) {
        let error = |steps| (end(&scheme, steps) - &fine).norm();
        let order = (error(200) / error(400)).log2();
        let wanted = if scheme == backward { 1.0 } else { 2.0 };
        assert!((order - wanted).abs() < 0.05, "{}: {order}", scheme.label());
    }
}

/// Two masses on springs, in contact with a wall under a load: every scheme holds them where statics does.
#[test]
fn a_pressed_set_stays_at_rest() {
    let k = DMatrix::from_row_slice(2, 2, &[3.0, -1.0, -1.0, 2.0]);
    let m = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![1.0, 2.0]));
    let wall = Obstacle { row: vec![1.0, 0.0], clearance: 0.2 };
    let system = VibratingSystem::new(m, DMatrix::zeros(2, 2), k, vec![-2.0, 0.5])
        .unwrap()
        .between(&[wall])
        .unwrap();
    // x₀ = −0.2, x₁ = (0.5 + x₀)/2; force 3x₀ − x₁ + 2.
    let (x0, x1) = (-0.2, 0.15);
    let force = 3.0 * x0 - x1 + 2.0;
    for scheme in Scheme::ALL {
        let integrator = scheme.prepare(&system, 0.05).unwrap();
        let mut state = system.start(&[x0, x1], &[0.0, 0.0]).unwrap();
        state.forces = vec![force];
        // Without the contact force, as central difference has it; with it, as the others do.
        if scheme != Scheme::CentralDifference {
            state.a.fill(0.0);
        }
        (0..200).for_each(|_| integrator.step(&mut state).unwrap());
        let name = scheme.label();
        assert!((state.x[0] - x0).abs() < 1e-12, "{name}: {}", state.x);
        assert!((state.x[1] - x1).abs() < 1e-12, "{name}: {}", state.x);
        assert!((state.forces[0] - force).abs() < 1e-10, "{name}: {:?}", state.forces);
    }
}

/// The limit from both sides, with a highest frequency known in closed form: two masses on three springs, ω² = k/m
/// and 3k/m.
#[test]
fn central_difference_is_refused_beyond_its_limit_only() {
    let k = DMatrix::from_row_slice(2, 2, &[2.0, -1.0, -1.0, 2.0]) * 5e8;
    let m = DMatrix::identity(2, 2) * 0.4;
    let omega_max = (3.0 * 5e8 / 0.4f64).sqrt();
    let system = VibratingSystem::new(m, DMatrix::zeros(2, 2), k, vec![0.0; 2]).unwrap();
    assert!((system.highest_frequency().unwrap() / omega_max - 1.0).abs() < 1e-14);
    let limit = 2.0 / omega_max;
    let largest = |scheme: &dyn Fn(f64) -> Box<dyn dynamics::benchmark_subjects::Integrator>, h| {
        let integrator = scheme(h);
        let mut state = system.start(&[1e-6, -0.9e-6], &[0.0; 2]).unwrap();
        (0..4000).for_each(|_| integrator.step(&mut state).unwrap());
        state.x.amax()
    };
    let guarded = |h| Scheme::CentralDifference.prepare(&system, h).unwrap();
    assert!(largest(&guarded, 0.999 * limit) < 1e-4);
    let free = |h| Scheme::CentralDifference.prepare_at_any_step(&system, h).unwrap();
    assert!(largest(&free, 1.001 * limit) > 1e10);
    let refused = Scheme::CentralDifference.prepare(&system, 1.001 * limit).unwrap_err();
    let IntegratorError::Unstable { product, largest, .. } = &refused else { panic!("{refused}") };
    assert!((product - 2.002).abs() < 1e-9 && (largest / limit - 1.0).abs() < 1e-12);
    let text = refused.to_string();
    assert!(text.contains("Δt·ω_max") && text.contains("implicit"), "{text}");
    // Every implicit scheme takes such a step.
    for scheme in Scheme::ALL.into_iter().filter(|s| *s != Scheme::CentralDifference) {
        assert!(scheme.prepare(&system, 10.0 * limit).is_ok(), "{}", scheme.label());
    }
}

/// Spring-mounted masses thrown at a wall many times: in every step the average acceleration changes the energy by
/// ½ (g₁ λ₀ − g₀ λ₁), Moreau–Jean with θ = ½ by ½ (1 − e) (G v₀)ᵀ p, contact-stabilised Newmark never up.
#[test]
fn contact_changes_the_energy_by_what_theory_says() {
    let k = DMatrix::from_row_slice(2, 2, &[4.0, -4.0, -4.0, 5.0]);
    let wall = Obstacle { row: vec![1.0, 0.0], clearance: 0.1 };
    let system =
        VibratingSystem::new(DMatrix::identity(2, 2), DMatrix::zeros(2, 2), k, vec![0.0; 2])
            .unwrap()
            .between(&[wall])
            .unwrap();
    let jean = |restitution| Scheme::MoreauJean { theta: 0.5, restitution };
    let all = [Scheme::AverageAcceleration, jean(1.0), jean(0.4), Scheme::ContactStabilised];
    for scheme in all {
        let h = 0.07;
        let integrator = scheme.prepare(&system, h).unwrap();
        let mut state = system.start(&[1.0, 1.5], &[0.0, 0.0]).unwrap();
        let size = system.energy(&state);
        let (mut touched, mut parted, mut highest) = (0, 0, 0.0f64);
        for _ in 0..2000 {
            let before = state.clone();
            integrator.step(&mut state).unwrap();
            let change = system.energy(&state) - system.energy(&before);
            let [g0, g1] = [&before, &state].map(|s| system.gaps(&s.x)[0]);
            let name = scheme.label();
            let exact = match scheme {
                Scheme::AverageAcceleration => 0.5 * (g1 * before.forces[0] - g0 * state.forces[0]),
                Scheme::MoreauJean { restitution, .. } => {
                    0.5 * (1.0 - restitution) * before.v[0] * state.forces[0] * h
                }
                _ => change.min(0.0),
            };
            // Rounding of the energy as it is by now.
            let now = size.max(system.energy(&state));
            assert!((change - exact).abs() < 1e-12 * now, "{name}: {change:e} {exact:e} {now}");
            touched += usize::from(state.forces[0] > 0.0);
            parted += usize::from(state.forces[0] == 0.0 && before.forces[0] > 0.0);
            highest = highest.max(system.energy(&state) / size);
        }
        assert!(touched > 20 && parted > 3, "{}: {touched} {parted}", scheme.label());
        let grows = scheme == Scheme::AverageAcceleration;
        assert_eq!(highest > 1.0 + 1e-6, grows, "{}: {highest}", scheme.label());
    }
}

#[test]
fn what_cannot_be_integrated_is_refused_by_name() {
    let one = VibratingSystem::oscillator(1.0, 0.0, 1.0).unwrap();
    for h in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for scheme in Scheme::ALL {
            let refused = scheme.prepare(&one, h);
            assert!(matches!(refused, Err(IntegratorError::Step(_))), "{}", scheme.label());
        }
    }
    let outside = [
        Scheme::Hht { alpha: 0.1 },
        Scheme::Hht { alpha: -0.4 },
        Scheme::GeneralizedAlpha { rho_infinity: 1.1 },
        Scheme::MoreauJean { theta: 0.4, restitution: 0.0 },
        Scheme::MoreauJean { theta: 0.5, restitution: f64::NAN },
    ];
    for scheme in outside {
        let refused = scheme.prepare(&one, 0.1);
        assert!(matches!(refused, Err(IntegratorError::Parameter { .. })), "{}", scheme.label());
    }
    let nothing = VibratingSystem::oscillator(0.0, 0.0, 0.0).unwrap();
    let refused = Scheme::AverageAcceleration.prepare(&nothing, 0.1);
    assert!(matches!(refused, Err(IntegratorError::Indefinite { .. })));
    assert!(VibratingSystem::oscillator(f64::NAN, 0.0, 1.0).is_err());
    let wall = Obstacle { row: vec![1.0, 0.0], clearance: 0.1 };
    assert!(matches!(one.between(&[wall]), Err(IntegratorError::Size { .. })));
}
