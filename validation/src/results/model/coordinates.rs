//! The coordinates in which an author writes, and those of the lumped model that results are held against.
//!
//! ```text
//! p = S q                      q: free coordinates of the lumped model (docs/results.md); p: the author's
//! M = Sᵀ M' S,  K = Sᵀ K' S    of matrices M', K' on p; rows of S are 0 where p is held
//! w = f u                      of a rotation: f = σ for arcs u = r_b θ, f = σ/cos α for arcs on the pitch radius
//!                              r_b/cos α, f = σ/r_b for angles; r_b of the carrier is the centre distance and its
//!                              α is 0; σ = −1 where clockwise rotations are positive
//! x = ζ cos ψ − η sin ψ,  y = ζ sin ψ + η cos ψ    of a planet's translations along x and y
//! ```

use gearset::{Axis, Body, Facing, Member};
use lumped::nalgebra::DMatrix;
use lumped::{LumpedError, LumpedModel};
use scene::{Freedom, Scene};

use crate::model_kind::ModelKind;
use crate::results::manifest::{Convention, PlanetTranslations, Radius, RotationCoordinate};
use crate::results::rows::{VectorAxis, VectorEntry};

/// Part of the largest coordinate of a vector below which a held one counts as 0.
const NIL: f64 = 1e-6;

/// The lumped model that results on a scene are held against.
pub(in crate::results) struct ReferenceModel {
    /// The scene, with the members held that the results hold.
    pub(in crate::results) scene: Scene,
    /// Its model; of rotations alone for torsional results.
    pub(in crate::results) model: LumpedModel,
    is_torsional: bool,
}

/// Why coordinates cannot be converted.
#[derive(Debug, thiserror::Error)]
pub(in crate::results) enum CoordinateFault {
    /// Angles of a body whose radius is not known.
    #[error("`rotation = \"angle\"` needs the radius of the {}, which the scene does not have", .0.kind_name())]
    NoRadius(Body),
    /// A matrix of another size.
    #[error("{rows} rows: allowed is {allowed}")]
    Rows {
        /// Rows of the matrix.
        rows: usize,
        /// Sizes that are allowed.
        allowed: String,
    },
    /// A coordinate that a vector needs.
    #[error("the vector has no `{0}`")]
    Missing(String),
    /// A coordinate that is held or of a planet that the set does not have.
    #[error("`{title}` of the vector is {value}, and the scene has no such coordinate or holds it")]
    Held {
        /// Title of the column.
        title: String,
        /// The number.
        value: f64,
    },
}

/// The scene with further members held.
fn holding(scene: &Scene, held: &[Member]) -> Scene {
    let mut scene = scene.clone();
    for member in held {
        let support = match member {
            Member::Sun => &mut scene.supports.sun,
            Member::Ring => &mut scene.supports.ring,
            Member::Carrier => &mut scene.supports.carrier,
        };
        support.motion = Freedom::Held;
    }
    scene
}

impl ReferenceModel {
    /// Of a scene, for results of a kind in which further members are held.
    pub(in crate::results) fn new(
        scene: &Scene,
        held: &[Member],
        kind: ModelKind,
    ) -> Result<Self, LumpedError> {
        let scene = holding(scene, held);
        let is_torsional = kind == ModelKind::Torsional;
        let whole = LumpedModel::from_scene(&scene)?;
        let model = if is_torsional { whole.torsional() } else { whole };
        Ok(Self { scene, model, is_torsional })
    }

    /// Bodies and axes of the author's coordinates of a matrix with so many rows: the free coordinates, or all.
    pub(in crate::results) fn listed(
        &self,
        id: &str,
        convention: &Convention,
        rows: usize,
    ) -> Result<Vec<(Body, Axis)>, CoordinateFault> {
        let coordinates = &self.model.coordinates;
        let mut all: Vec<(Body, Axis)> = Vec::new();
        for name in &convention.order {
            for body in Body::all(self.model.psi.len()) {
                let group = if body.kind() == 3 { "planets" } else { body.kind_name() };
                if group == name {
                    let axes = if self.is_torsional { &Axis::ALL[2..] } else { &Axis::ALL[..] };
                    all.extend(axes.iter().map(|axis| (body, *axis)));
                }
            }
        }
        let is_free = |(body, axis): &(Body, Axis)| coordinates.of(*body, *axis).is_some();
        let free: Vec<(Body, Axis)> = all.iter().copied().filter(is_free).collect();
        if rows == free.len() {
            return Ok(free);
        }
        if rows == all.len() {
            return Ok(all);
        }
        let mut allowed = format!("{} for `{id}`", free.len());
        if all.len() != free.len() {
            allowed += &format!(", {} with its held coordinates", all.len());
        }
        let members = [
            (Body::Ring, Member::Ring),
            (Body::Carrier, Member::Carrier),
            (Body::Sun, Member::Sun),
        ];
        let moving = members.into_iter().find(|(body, _)| free.iter().any(|(b, _)| b == body));
        if let Some((body, member)) = moving {
            let fewer = free.iter().filter(|(b, _)| *b != body).count();
            let name = member.name();
            allowed += &format!(
                ", or {fewer} with the {name} held (`held = [\"{name}\"]` in results.toml)"
            );
        }
        Err(CoordinateFault::Rows { rows, allowed })
    }

    /// S of p = S q, where p are the `listed` coordinates.
    fn transformation(
        &self,
        convention: &Convention,
        listed: &[(Body, Axis)],
    ) -> Result<DMatrix<f64>, CoordinateFault> {
        let coordinates = &self.model.coordinates;
        let mut s = DMatrix::zeros(listed.len(), coordinates.count());
        for (row, &(body, axis)) in listed.iter().enumerate() {
            let mut set = |axis, value| {
                if let Some(column) = coordinates.of(body, axis) {
                    s[(row, column)] = value;
                }
            };
            match (axis, body, convention.planets) {
                (Axis::Rotation, ..) => set(axis, self.rotation_factor(convention, body)?),
                (_, Body::Planet(n), PlanetTranslations::XY) => {
                    let (sin, cos) = self.model.psi[n].sin_cos();
                    let [radial, tangential] =
                        if axis == Axis::First { [cos, -sin] } else { [sin, cos] };
                    set(Axis::First, radial);
                    set(Axis::Second, tangential);
                }
                _ => set(axis, 1.0),
            }
        }
        Ok(s)
    }

    /// A matrix Sᵀ A S on the free coordinates of the lumped model.
    pub(in crate::results) fn converted(
        &self,
        id: &str,
        convention: &Convention,
        matrix: &DMatrix<f64>,
    ) -> Result<DMatrix<f64>, CoordinateFault> {
        let s = self.transformation(convention, &self.listed(id, convention, matrix.nrows())?)?;
        Ok(s.transpose() * matrix * s)
    }

    /// f of w = f u.
    fn rotation_factor(&self, convention: &Convention, body: Body) -> Result<f64, CoordinateFault> {
        let lumped = self.scene.lumped.as_ref();
        let sense = if convention.sense == Facing::Clockwise { -1.0 } else { 1.0 };
        let angle = lumped.map_or(0.0, |lumped| match body {
            Body::Carrier => 0.0,
            Body::Ring => lumped.pressure_angle_rad.ring_planet,
            Body::Sun | Body::Planet(_) => lumped.pressure_angle_rad.sun_planet,
        });
        match (convention.rotation, convention.radius) {
            (RotationCoordinate::Arc, Radius::Base) => Ok(sense),
            (RotationCoordinate::Arc, Radius::Pitch) => Ok(sense / angle.cos()),
            (RotationCoordinate::Angle, _) => {
                let radius = lumped.and_then(|lumped| lumped.radius_m.of(body));
                radius.map(|radius| sense / radius).ok_or(CoordinateFault::NoRadius(body))
            }
        }
    }

    /// Displacements q of the free coordinates from a vector as its columns name it, the largest of size 1.
    pub(in crate::results) fn shape(
        &self,
        convention: &Convention,
        entries: &[VectorEntry],
    ) -> Result<Vec<f64>, CoordinateFault> {
        use VectorAxis::{Radial, Rotation, Tangential, X, Y};
        let find = |body: Body, axis: VectorAxis| {
            entries.iter().find(|e| e.body == body && e.axis == axis).map(|entry| entry.value)
        };
        let value = |body: Body, axis: VectorAxis| {
            find(body, axis).ok_or_else(|| CoordinateFault::Missing(axis.title(body)))
        };
        let coordinate = |&(body, axis): &(Body, Axis)| match (body, axis) {
            (_, Axis::Rotation) => {
                Ok(value(body, Rotation)? / self.rotation_factor(convention, body)?)
            }
            (Body::Planet(n), _) if find(body, X).is_some() || find(body, Y).is_some() => {
                let (sin, cos) = self.model.psi[n].sin_cos();
                let [x, y] = [value(body, X)?, value(body, Y)?];
                Ok(if axis == Axis::First { x * cos + y * sin } else { y * cos - x * sin })
            }
            (Body::Planet(_), Axis::First) => value(body, Radial),
            (Body::Planet(_), _) => value(body, Tangential),
            (_, Axis::First) => value(body, X),
            (_, Axis::Second) => value(body, Y),
        };
        let coordinates = &self.model.coordinates;
        let shape = coordinates.free().iter().map(coordinate).collect::<Result<Vec<f64>, _>>()?;
        let largest = entries.iter().map(|entry| entry.value.abs()).fold(0.0, f64::max);
        let is_held = |entry: &&VectorEntry| {
            let axis = match entry.axis {
                X | Radial => Axis::First,
                Y | Tangential => Axis::Second,
                Rotation => Axis::Rotation,
            };
            // Translations follow from the rotations of torsional results.
            let is_asked = axis == Axis::Rotation || !self.is_torsional;
            is_asked
                && coordinates.of(entry.body, axis).is_none()
                && entry.value.abs() > NIL * largest
        };
        match entries.iter().find(is_held) {
            Some(entry) => {
                let (title, value) = (entry.axis.title(entry.body), entry.value);
                Err(CoordinateFault::Held { title, value })
            }
            None => {
                let size = shape.iter().map(|q| q.abs()).fold(0.0, f64::max);
                Ok(shape.iter().map(|q| if size > 0.0 { q / size } else { 0.0 }).collect())
            }
        }
    }
}
