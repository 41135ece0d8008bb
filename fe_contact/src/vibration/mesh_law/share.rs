//! The part of a mesh's flexibility that stiffness-proportional damping acts on.

use std::borrow::Cow;

use gearset::CurveKey;
use nalgebra::DMatrix;

use super::super::teeth::tooth_points;
use super::build::{Approaches, Found};
use crate::contact::MeshTable;
use crate::error::FeError;
use crate::statics::{PLANETS, Placed, RING, SUN, StaticSet};

/// Share of the elastic bodies in the flexibility of a mesh under a force: with pair forces p = S a that
/// a unit of deflection adds, and F the bodies' flexibility between the pairs,
///
/// ```text
/// s = pᵀ F p / pᵀ a
/// ```
///
/// that is, the elastic energy in the bodies over all of it. The half-plane's part has no damping.
pub(super) fn damped_share(
    statics: &StaticSet<'_>,
    key: &CurveKey,
    table: &MeshTable,
    along: &Approaches,
    found: &Found,
) -> Result<f64, FeError> {
    let (total, tangent) = (found.stiffness, &found.tangent);
    let arms = &along.arms;
    let count = arms.len();
    let p: Vec<f64> =
        (0..count).map(|k| (0..count).map(|l| tangent[(k, l)] * arms[l]).sum()).collect();
    let flexibility = elastic(statics, key, table)?;
    let mut bodies = 0.0;
    for (k, p_k) in p.iter().enumerate() {
        for (l, p_l) in p.iter().enumerate() {
            bodies += p_k * flexibility[(k, l)] * p_l;
        }
    }
    Ok(if total > 0.0 { (bodies / total).clamp(0.0, 1.0) } else { 0.0 })
}

/// Static FE flexibility between the pairs of a mesh, the loads spread over the matching depth, m/N.
fn elastic(
    statics: &StaticSet<'_>,
    key: &CurveKey,
    table: &MeshTable,
) -> Result<DMatrix<f64>, FeError> {
    let count = table.pairs.len();
    let placed = Placed {
        kind: key.kind,
        planet: 0,
        phase: key.phase,
        table: Cow::Borrowed(table),
        rows: Vec::new(),
        offsets: Vec::new(),
    };
    let ends = tooth_points(statics.bodies, &statics.races, &placed)?;
    let mut flexibility = DMatrix::zeros(count, count);
    for member in 0..2 {
        let body = match ends.first().map(|e| e[member].body) {
            Some(SUN) => statics.bodies.sun.as_ref(),
            Some(RING) => statics.bodies.ring.as_ref(),
            Some(PLANETS..) => Some(&statics.bodies.planet),
            _ => None,
        };
        let Some(body) = body else { continue };
        let pitch = body.mesh.outline.gear().pitch_angle();
        for (k, of) in ends.iter().enumerate() {
            for (l, on) in ends.iter().enumerate() {
                let (on, of) = (&on[member], &of[member]);
                let offset = ((of.axis - on.axis) / pitch).round() as i64;
                flexibility[(k, l)] += body.surface_flexibility(
                    (&on.load, on.direction),
                    offset,
                    (&of.load, of.direction),
                );
            }
        }
    }
    Ok(flexibility)
}
