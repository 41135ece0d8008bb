//! The schemes by name and parameter.

use super::bathe::Bathe;
use super::central_difference::{CentralDifference, highest_frequency};
use super::contact_stabilised::ContactStabilised;
use super::error::IntegratorError;
use super::generalized_alpha::{GeneralizedAlpha, Weights};
use super::integrator::Integrator;
use super::moreau_jean::MoreauJean;
use super::system::VibratingSystem;

/// A scheme with its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// Newmark's method with γ = ½, β = ¼.
    AverageAcceleration,
    /// HHT-α.
    Hht {
        /// α, −⅓ to 0.
        alpha: f64,
    },
    /// Chung & Hulbert's generalised-α.
    GeneralizedAlpha {
        /// Spectral radius ρ_∞ at infinite frequency, 0 to 1.
        rho_infinity: f64,
    },
    /// Bathe's composite scheme.
    Bathe,
    /// Newmark's method with projected predictor and implicit contact forces.
    ContactStabilised,
    /// Impulses on velocities.
    MoreauJean {
        /// θ, ½ to 1.
        theta: f64,
        /// Restitution e of Newton's impact law, 0 to 1.
        restitution: f64,
    },
    /// Explicit central difference.
    CentralDifference,
}

impl Scheme {
    /// One of each kind, with the parameters that its authors recommend or, where they recommend none, usual ones.
    pub const ALL: [Self; 7] = [
        Self::AverageAcceleration,
        Self::Hht { alpha: -0.1 },
        Self::GeneralizedAlpha { rho_infinity: 0.8 },
        Self::Bathe,
        Self::ContactStabilised,
        Self::MoreauJean { theta: 0.5, restitution: 1.0 },
        Self::CentralDifference,
    ];

    /// Name with parameters.
    pub fn label(&self) -> String {
        match self {
            Self::AverageAcceleration => "average acceleration".into(),
            Self::Hht { alpha } => format!("HHT-α, α = {alpha}"),
            Self::GeneralizedAlpha { rho_infinity } => {
                format!("generalised-α, ρ∞ = {rho_infinity}")
            }
            Self::Bathe => "Bathe composite".into(),
            Self::ContactStabilised => "contact-stabilised Newmark".into(),
            Self::MoreauJean { theta, restitution } => {
                format!("Moreau–Jean, θ = {theta}, e = {restitution}")
            }
            Self::CentralDifference => "central difference".into(),
        }
    }

    /// What to know before this scheme is used on a system with obstacles; `None` if it cannot gain energy at them.
    ///
    /// Proofs exist for contact-stabilised Newmark (Deuflhard, Krause & Ertel 2008) and for Moreau–Jean with θ ≥ ½
    /// (Acary 2016); the others gain energy on the bouncing bar.
    pub fn caution(&self, system: &VibratingSystem) -> Option<String> {
        let is_sound = matches!(self, Self::ContactStabilised | Self::MoreauJean { .. });
        (!is_sound && !system.clearance.is_empty()).then(|| {
            format!(
                "{} may gain energy where contact with a rigid obstacle opens, at any step: take Moreau–Jean with θ = 1/2, which \
                 keeps it, or contact-stabilised Newmark, which loses some",
                self.label()
            )
        })
    }

    /// Made ready for a system and a step of h seconds.
    ///
    /// # Errors
    /// If step or parameters are out of range, a matrix of the scheme is not positive definite, or the step of an
    /// explicit scheme is beyond its limit.
    pub fn prepare(
        &self,
        system: &VibratingSystem,
        h: f64,
    ) -> Result<Box<dyn Integrator>, IntegratorError> {
        self.check()?;
        match *self {
            Self::CentralDifference => Ok(Box::new(CentralDifference::new(system, h)?)),
            _ => self.prepare_at_any_step(system, h),
        }
    }

    /// The same without the limit of the explicit scheme, to show what happens beyond it.
    ///
    /// # Errors
    /// As [`Scheme::prepare`], but for the limit.
    pub fn prepare_at_any_step(
        &self,
        system: &VibratingSystem,
        h: f64,
    ) -> Result<Box<dyn Integrator>, IntegratorError> {
        self.check()?;
        let family = |name, weights| GeneralizedAlpha::new(name, weights, system, h);
        Ok(match *self {
            Self::AverageAcceleration => {
                Box::new(family("average acceleration", Weights::average_acceleration())?)
            }
            Self::Hht { alpha } => Box::new(family("HHT-α", Weights::hht(alpha))?),
            Self::GeneralizedAlpha { rho_infinity } => {
                Box::new(family("generalised-α", Weights::chung_hulbert(rho_infinity))?)
            }
            Self::Bathe => Box::new(Bathe::new(system, h)?),
            Self::ContactStabilised => Box::new(ContactStabilised::new(system, h)?),
            Self::MoreauJean { theta, restitution } => {
                Box::new(MoreauJean::new(theta, restitution, system, h)?)
            }
            Self::CentralDifference => Box::new(CentralDifference::unguarded(system, h)?),
        })
    }

    fn check(&self) -> Result<(), IntegratorError> {
        let within = |scheme, parameter, value: f64, range: [f64; 2], allowed| match value
            >= range[0]
            && value <= range[1]
        {
            true => Ok(()),
            false => Err(IntegratorError::Parameter { scheme, parameter, value, allowed }),
        };
        match *self {
            Self::Hht { alpha } => within("HHT-α", "α", alpha, [-1.0 / 3.0, 0.0], "−1/3 to 0"),
            Self::GeneralizedAlpha { rho_infinity } => {
                within("generalised-α", "ρ∞", rho_infinity, [0.0, 1.0], "0 to 1")
            }
            Self::MoreauJean { theta, restitution } => {
                within("Moreau–Jean", "θ", theta, [0.5, 1.0], "1/2 to 1")?;
                within("Moreau–Jean", "e", restitution, [0.0, 1.0], "0 to 1")
            }
            _ => Ok(()),
        }
    }
}

impl VibratingSystem {
    /// Highest natural frequency ω_max without damping and obstacles, rad/s: explicit steps are stable up to 2/ω_max.
    ///
    /// # Errors
    /// If the mass matrix is not positive definite or eigenvalues are not found.
    pub fn highest_frequency(&self) -> Result<f64, IntegratorError> {
        highest_frequency(self)
    }
}
