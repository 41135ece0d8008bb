//! Why a mesh does not close: the sign of the ring's shift, a number of teeth, the centre distance or the shifts. What
//! follows from such a slip (roots, fillets, tips, contact ratios) is not reported beside it.

use gearset::{GeometryInput, MeshKind, ShiftedMesh, Teeth, ThicknessInput, WrittenRounding};

use crate::read::document::Document;
use crate::read::geometry::GeometryRead;
use crate::warnings::{LARGE_BACKLASH, Warning, sign_warning, signed_mm};

/// Shift sum beyond which no set is built: real ones are within ±1.5.
const MOST_SHIFT_SUM: f64 = 2.0;
/// Difference of shift sums from which a mesh is far from closing, and within which it is near.
const FAR: f64 = 0.3;
const NEAR: f64 = 0.1;
/// Backlash over the module with which faults of a mesh are those of its distance.
const GAPING: f64 = 0.3;

/// A key that explains the faults of meshes.
pub(crate) struct Cause {
    pub(crate) key: &'static str,
    pub(crate) allowed: String,
    pub(crate) why: String,
    /// Whether it explains faults of the sun mesh, and of the ring mesh.
    pub(crate) meshes: [bool; 2],
}

/// The meshes of one rack with their shifts.
pub(crate) struct Closing<'a> {
    input: &'a GeometryInput,
    teeth: Teeth,
    written: WrittenRounding,
    /// Whether the shifts of the file have the sign of ISO 21771.
    is_iso: bool,
    /// Whether the distance is written in the file.
    is_distance_given: bool,
}

const KINDS: [MeshKind; 2] = [MeshKind::SunPlanet, MeshKind::RingPlanet];

impl<'a> Closing<'a> {
    pub(crate) fn new(
        document: &Document<'_>,
        input: &'a GeometryInput,
        teeth: &Teeth,
        read: &GeometryRead,
    ) -> Self {
        Self {
            input,
            teeth: *teeth,
            written: read.written,
            is_iso: read.is_iso_sign,
            is_distance_given: document.has("geometry.center_distance_mm"),
        }
    }

    fn mesh(&self, kind: MeshKind, teeth: &Teeth) -> Option<ShiftedMesh> {
        let input = self.input;
        let known = input.rack.filter(|rack| rack.module_m.is_finite());
        ShiftedMesh::new(kind, teeth, known?, input.center_distance_m, &input.thickness)
    }

    /// The shift of the ring, positive outwards, where shifts are given.
    fn ring_shift(&self) -> Option<f64> {
        match self.input.thickness {
            ThicknessInput::ProfileShift { ring, .. } => Some(ring),
            ThicknessInput::Backlash { .. } => None,
        }
    }

    /// Backlash of the ring mesh with the shifts as they are and with the other sign of the ring's, and the largest
    /// change of either by rounding, m; `None` without a ring's shift.
    fn with_other_sign(&self) -> Option<[f64; 3]> {
        let ring = self.ring_shift().filter(|x| *x != 0.0)?;
        let mesh = self.mesh(MeshKind::RingPlanet, &self.teeth)?;
        let other = mesh.with_shift_sum(mesh.shift_sum - 2.0 * ring);
        Some([mesh.backlash()?, other.backlash()?, mesh.rounding(&self.written)])
    }

    /// Whether the other sign of the ring's shift leaves a usual backlash and this one does not: none within the
    /// rounding of the shifts, or 0 to 0.15 modules.
    fn is_sign_slip(&self) -> Option<[f64; 2]> {
        let [this, other, rounding] = self.with_other_sign()?;
        let mesh = self.mesh(MeshKind::RingPlanet, &self.teeth)?;
        let of_shifts = WrittenRounding { shifts: self.written.shifts, ..Default::default() };
        let shift_rounding = mesh.rounding(&of_shifts);
        let is_usual = |j: f64| j >= -rounding && j <= LARGE_BACKLASH * mesh.rack.module_m;
        let closes_instead = other.abs() <= rounding
            && this.abs() > shift_rounding.max(other.abs())
            && (this - other).abs() > shift_rounding;
        (closes_instead || is_usual(other) && !is_usual(this)).then_some([this, other])
    }

    /// What to write where the sign of the ring's shift is the slip.
    fn sign_advice(&self) -> &'static str {
        match self.is_iso {
            true => "likely the shift is positive outwards: leave `ring_sign` out",
            false => {
                "likely the shift has the sign of ISO 21771, positive where teeth are thicker: add ring_sign = \"iso_21771\""
            }
        }
    }

    /// The remark of a valid set whose ring shift likely has the other sign, where only the digits written show it:
    /// large backlash is warned of from the scene alone.
    pub(crate) fn sign_warning(&self, document: &Document<'_>) -> Option<Warning> {
        let module = self.input.rack?.module_m;
        let [this, other] =
            self.is_sign_slip().filter(|[this, _]| *this <= LARGE_BACKLASH * module)?;
        Some(sign_warning(document.written(RING_SHIFT), this, other, module))
    }

    /// What explains faults of meshes; `is_faulty` says of sun and ring mesh whether they have some.
    pub(crate) fn causes(&self, is_faulty: [bool; 2]) -> Vec<Cause> {
        let slip = self.is_sign_slip();
        if slip.is_none() {
            let teeth = self.wrong_teeth().filter(|cause| is_within(cause.meshes, is_faulty));
            if let Some(cause) = teeth.or_else(|| self.wrong_distance()) {
                return vec![cause];
            }
        }
        let mut causes = Vec::new();
        for (i, kind) in KINDS.into_iter().enumerate().filter(|(i, _)| is_faulty[*i]) {
            let cause = match slip.filter(|_| kind == MeshKind::RingPlanet) {
                Some([this, other]) => Some(Cause {
                    key: RING_SHIFT,
                    allowed: format!(
                        "the other sign, which leaves backlash {} mm",
                        signed_mm(other)
                    ),
                    why: format!(
                        "the ring_planet mesh has backlash {} mm; {}",
                        signed_mm(this),
                        self.sign_advice()
                    ),
                    meshes: [false, true],
                }),
                None => self.not_closed(i, kind),
            };
            causes.extend(cause);
        }
        causes
    }

    /// Shifts, or a distance, that leave less backlash than none or far too much.
    fn not_closed(&self, i: usize, kind: MeshKind) -> Option<Cause> {
        self.ring_shift()?;
        let mesh = self.mesh(kind, &self.teeth)?;
        let (left, module) = (mesh.backlash()?, mesh.rack.module_m);
        let jams = left < -mesh.rounding(&self.written) - 1e-9;
        if !jams && left < GAPING * module {
            return None;
        }
        let sum =
            if kind == MeshKind::SunPlanet { "x_sun + x_planet" } else { "x_ring − x_planet" };
        let minus = |x: f64| format!("{x:.4}").replace('-', "−");
        let distance = mesh
            .closing_distance()
            .map_or(String::new(), |a| format!("; these shifts leave none at {:.3} mm", 1e3 * a));
        let other = match (kind, self.with_other_sign()) {
            (MeshKind::RingPlanet, Some([_, other, _])) if jams && other > 0.0 => {
                format!(
                    "; with the other sign of the ring's shift it would be {} mm",
                    signed_mm(other)
                )
            }
            _ => String::new(),
        };
        let effect = if jams { "it jams" } else { "teeth hardly reach each other" };
        Some(Cause {
            key: if jams || !self.is_distance_given {
                "geometry.thickness.profile_shift"
            } else {
                DISTANCE
            },
            allowed: format!(
                "{sum} = {} or {} at {:.3} mm, where {} leaves no backlash{distance}",
                minus(mesh.closing_shift_sum()?),
                if kind == MeshKind::SunPlanet { "less" } else { "more" },
                1e3 * mesh.center_distance,
                minus(mesh.closing_shift_sum()?)
            ),
            why: format!(
                "{sum} = {} leaves the {} mesh backlash {} mm: {effect}{other}",
                minus(mesh.shift_sum),
                kind.name(),
                signed_mm(left)
            ),
            meshes: [i == 0, i == 1],
        })
    }

    /// How far the shift sums of both meshes are from closing with these teeth.
    fn misfits(&self, teeth: &Teeth) -> Option<[f64; 2]> {
        let misfit = |kind| {
            let mesh = self.mesh(kind, teeth)?;
            Some((mesh.closing_shift_sum()? - mesh.shift_sum).abs())
        };
        Some([misfit(KINDS[0])?, misfit(KINDS[1])?])
    }

    /// A number of teeth that Z_r = Z_s + 2 Z_p puts right: with it both meshes close, without it one is far from it.
    pub(crate) fn wrong_teeth(&self) -> Option<Cause> {
        let Teeth { sun: Some(sun), planet, ring: Some(ring) } = self.teeth else { return None };
        let given = self.misfits(&self.teeth).unwrap_or([f64::INFINITY; 2]);
        if sun + 2 * planet == ring || given.into_iter().fold(0.0, f64::max) < FAR {
            return None;
        }
        let odd = ring.checked_sub(sun).filter(|twice| twice % 2 == 0);
        let candidates = [
            ("teeth.ring", Some(sun + 2 * planet), ring),
            ("teeth.planet", odd.map(|twice| twice / 2), planet),
            ("teeth.sun", ring.checked_sub(2 * planet), sun),
        ];
        candidates.into_iter().find_map(|(key, count, wrong)| {
            let count = count.filter(|count| *count >= 5)?;
            let mut teeth = self.teeth;
            match key {
                "teeth.ring" => teeth.ring = Some(count),
                "teeth.planet" => teeth.planet = count,
                _ => teeth.sun = Some(count),
            }
            let misfits = self.misfits(&teeth)?;
            (misfits.into_iter().fold(0.0, f64::max) < NEAR).then(|| Cause {
                key,
                allowed: format!("{count}, as in Z_r = Z_s + 2 Z_p, or a centre distance and shifts that close both meshes"),
                why: format!(
                    "with {count} teeth both meshes close at {:.3} mm with the shifts of this set, with {wrong} they do not: roots, fillets and tips cannot fit",
                    1e3 * self.input.center_distance_m
                ),
                meshes: [key != "teeth.ring", true],
            })
        })
    }

    /// A distance that no shifts reach.
    pub(crate) fn wrong_distance(&self) -> Option<Cause> {
        if !self.is_distance_given {
            return None;
        }
        let mesh = KINDS.into_iter().find_map(|kind| self.mesh(kind, &self.teeth))?;
        // Below the base circles no shift is enough either.
        let sum = mesh.closing_shift_sum().unwrap_or(f64::NEG_INFINITY);
        if sum.abs() <= MOST_SHIFT_SUM {
            return None;
        }
        let reference = 1e3 * mesh.reference_distance();
        let closing = match mesh.closing_distance() {
            Some(a) if mesh.shift_sum != 0.0 => format!(", with these shifts {:.3} mm", 1e3 * a),
            _ => String::new(),
        };
        let teeth = if mesh.kind == MeshKind::SunPlanet { "Z_s + Z_p" } else { "Z_r − Z_p" };
        let why = match sum.is_finite() {
            true => {
                format!("shifts of {sum:.2} modules in sum would be needed, far beyond any gears")
            }
            false => "the base circles would overlap".to_owned(),
        };
        Some(Cause {
            key: DISTANCE,
            allowed: format!("near m ({teeth})/2 = {reference:.3} mm{closing}"),
            why: format!(
                "{why}: teeth cannot reach each other as they should, whatever their tips and roots"
            ),
            meshes: [true, true],
        })
    }
}

const RING_SHIFT: &str = "geometry.thickness.profile_shift.ring";
const DISTANCE: &str = "geometry.center_distance_mm";

fn is_within(meshes: [bool; 2], faulty: [bool; 2]) -> bool {
    meshes.into_iter().zip(faulty).any(|(explains, is)| explains && is)
}
