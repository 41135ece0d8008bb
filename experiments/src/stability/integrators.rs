//! Spectral radius, period error and numerical damping of every scheme over ω Δt.

use dynamics::benchmark_subjects::{Amplification, Scheme, amplification, closed_form};

use super::map::{Map, MapError, MapOf, StabilityMap};

pub(super) const MAP: Map = Map {
    name: "integrators",
    about: "Spectral radius, period error and numerical damping of time-stepping schemes over ω Δt",
    meaning: "what one time step does to an oscillation: above a spectral radius of 1 it grows without cause, and below 1 it \
         is damped without cause",
    of: MapOf::Nothing(map),
};

/// ω Δt from 10^−1.5 to 10^1.5.
const POINTS: i32 = 90;

/// ω Δt at which schemes are compared in the table: 63 and 6 steps in a period, and beyond what is resolved.
const TABLED: [f64; 3] = [0.1, 1.0, 10.0];

type Quantity = (&'static str, fn(&Amplification) -> Option<f64>);

const QUANTITIES: [Quantity; 3] = [
    ("spectral radius", |a| Some(a.spectral_radius)),
    ("period error", |a| a.period_error),
    ("numerical damping ratio", |a| a.damping_ratio),
];

fn map() -> Result<StabilityMap, MapError> {
    let mut map = StabilityMap::of(&MAP, "one undamped oscillator", "log₁₀ ω Δt");
    for scheme in Scheme::ALL {
        for (name, of) in QUANTITIES {
            let both = |omega_h: f64| -> Result<[Option<f64>; 2], MapError> {
                let measured = amplification(&scheme, omega_h, 0.0)?;
                Ok([of(&measured), of(&closed_form(&scheme, omega_h, 0.0))])
            };
            let mut curves = [Vec::new(), Vec::new()];
            for k in 0..=POINTS {
                let omega_h = 10f64.powf(-1.5 + 3.0 * f64::from(k) / f64::from(POINTS));
                for (curve, value) in curves.iter_mut().zip(both(omega_h)?) {
                    // Beyond its limit the explicit scheme leaves the figure.
                    let value = value.filter(|y| y.abs() < 2.0);
                    curve.extend(value.map(|y| (omega_h.log10(), y)));
                }
            }
            let [measured, theory] = curves;
            map.draw_beside(name, &scheme.label(), measured, theory);
            for omega_h in TABLED {
                let tiny = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
                let [measured, theory] = both(omega_h)?.map(|x| x.map(tiny));
                let quantity = format!("{name} at ω Δt = {omega_h}");
                map.compare(scheme.label(), quantity, measured, theory);
            }
        }
    }
    Ok(map)
}
