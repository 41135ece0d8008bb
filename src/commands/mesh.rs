//! `mesh SCENE`.

use std::io::Write;
use std::path::Path;

use fe_contact::body::{CarrierBody, GearBody};
use fe_contact::export::{Drawn, vtu};
use fe_contact::fe_mesh::Side;
use fe_contact::statics::Bodies;
use scene::{LumpedInput, Scene, SceneKind, Verb};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::MeshVerb;
use crate::error::{Result, fe_refused};
#[cfg(feature = "charts")]
use crate::folder::writable;
use crate::folder::{folder, save};
use crate::inputs::{Working, bodies, needs, read_scene};
use crate::output::{self, Notation, Report, Table};

/// `mesh --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct MeshOutput {
    bodies: Vec<BodyOutput>,
    #[serde(skip)]
    title: String,
}

/// One body.
#[derive(Debug, Serialize, JsonSchema)]
struct BodyOutput {
    /// sun, planet, ring or carrier.
    body: String,
    elements: usize,
    /// Number of free nodal displacements.
    degrees_of_freedom: usize,
    mass_kg: f64,
    /// Polar moment of inertia about the body's centre.
    polar_inertia_kg_m2: f64,
    /// The scene's lumped values, if it has them.
    lumped_mass_kg: Option<f64>,
    lumped_inertia_kg_m2: Option<f64>,
    /// Only for gears.
    #[serde(skip_serializing_if = "Option::is_none")]
    teeth: Option<TeethOutput>,
    /// Only for the carrier: mean displacement of a pin seat along a unit force on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    seat_flexibility_m_per_n: Option<f64>,
}

/// Mesh and flexibility of a gear's teeth.
#[derive(Debug, Serialize, JsonSchema)]
struct TeethOutput {
    flank_elements: u32,
    /// Largest distance from the Hermite flank to the involute.
    flank_error_um: f64,
    least_corner_angle_deg: f64,
    largest_corner_angle_deg: f64,
    largest_aspect_ratio: f64,
    /// Least ratio of the smallest to the largest det J within one element.
    least_jacobian_ratio: f64,
    /// Normal displacement at matching depth below mid-flank under a unit normal force there.
    flexibility_m_per_n: f64,
    /// Displacement of the same point of the neighbouring tooth, over `flexibility_m_per_n`.
    neighbour_share: f64,
}

pub(crate) fn run(arguments: &MeshVerb, out: &mut dyn Write, err: &mut dyn Write) -> Result<()> {
    let path = &arguments.scene;
    let scene = read_scene(path, err)?;
    needs::require(path, &scene, Verb::Mesh, |_| false)?;
    needs::warn(&scene, Some(Verb::Mesh), None, err)?;
    #[cfg(feature = "charts")]
    writable(arguments.svg.as_deref())?;
    folder("--vtu", arguments.vtu.as_deref())?;
    let working = Working::new("meshing and factorising the bodies");
    let bodies = bodies(path, &scene, arguments.large)?;
    let carrier = carrier(&scene, &bodies).transpose().map_err(fe_refused(path))?;
    drop(working);
    let saved: Result<()> = Ok(());
    #[cfg(feature = "charts")]
    let saved = arguments.svg.as_ref().map_or(saved, |file| {
        save(file, &crate::figures::meshes(&scene, &bodies, carrier.as_ref()).svg())
    });
    let gears = [bodies.sun.as_ref(), Some(&bodies.planet), bodies.ring.as_ref()];
    let gears: Vec<&GearBody> = gears.into_iter().flatten().collect();
    let saved = saved.and(match &arguments.vtu {
        Some(folder) => write_vtu(&gears, carrier.as_ref(), folder),
        None => Ok(()),
    });
    let mut list: Vec<BodyOutput> =
        gears.iter().map(|body| gear(body, &bodies, scene.lumped.as_ref())).collect();
    if let Some(body) = &carrier {
        let lumped = scene.lumped.as_ref();
        list.push(BodyOutput {
            body: "carrier".into(),
            elements: body.mesh.elements.len(),
            degrees_of_freedom: body.unknowns,
            mass_kg: body.mass,
            polar_inertia_kg_m2: body.inertia,
            lumped_mass_kg: lumped.and_then(|l| l.mass_kg.carrier),
            lumped_inertia_kg_m2: lumped.and_then(|l| {
                Some(l.inertia_over_r2_kg.carrier? * bodies.geometry.center_distance.powi(2))
            }),
            teeth: None,
            seat_flexibility_m_per_n: Some(body.mean_seat_flexibility()),
        });
    }
    let result = MeshOutput { bodies: list, title: scene.title.clone() };
    // What was computed is shown also where its files cannot be written.
    saved.and(output::show(arguments.format, &result, out))
}

/// One file for each body.
fn write_vtu(gears: &[&GearBody], carrier: Option<&CarrierBody>, folder: &Path) -> Result<()> {
    for body in gears {
        save(&folder.join(format!("{}.vtu", body.mesh.name)), &vtu(&Drawn::gear(&body.mesh)))?;
    }
    match carrier {
        Some(body) => save(&folder.join("carrier.vtu"), &vtu(&Drawn::carrier(&body.mesh))),
        None => Ok(()),
    }
}

/// The carrier of a whole set whose scene gives its shape.
fn carrier(scene: &Scene, bodies: &Bodies) -> Option<Result<CarrierBody, fe_contact::FeError>> {
    let input = scene.geometry.as_ref()?.carrier.filter(|_| scene.kind == SceneKind::Planetary)?;
    let (a, b) = (bodies.geometry.center_distance, bodies.geometry.face_width);
    Some(CarrierBody::new(&input, a, &scene.planets.psi_rad, &bodies.material, b))
}

fn gear(body: &GearBody, bodies: &Bodies, lumped: Option<&LumpedInput>) -> BodyOutput {
    let name = body.mesh.name;
    let gear = body.mesh.outline.gear();
    let of = |values: &scene::PerBody| match name {
        "sun" => values.sun,
        "ring" => values.ring,
        _ => values.planet,
    };
    let quality = body.mesh.quality();
    let depth = bodies.settings.matching.depth;
    let own = body.mid_flank_flexibility(Side::Ccw, depth, 0);
    BodyOutput {
        body: name.into(),
        elements: body.mesh.elements.len(),
        degrees_of_freedom: body.unknowns,
        mass_kg: body.mass,
        polar_inertia_kg_m2: body.inertia,
        lumped_mass_kg: lumped.and_then(|l| of(&l.mass_kg)),
        lumped_inertia_kg_m2: lumped
            .and_then(|l| Some(of(&l.inertia_over_r2_kg)? * gear.base_radius.powi(2))),
        teeth: Some(TeethOutput {
            flank_elements: bodies.settings.input.flank_elements,
            flank_error_um: body.mesh.flank_error() * 1e6,
            least_corner_angle_deg: quality.least_angle_deg,
            largest_corner_angle_deg: quality.largest_angle_deg,
            largest_aspect_ratio: quality.aspect_ratio,
            least_jacobian_ratio: quality.jacobian_ratio,
            flexibility_m_per_n: own,
            neighbour_share: body.mid_flank_flexibility(Side::Ccw, depth, 1) / own,
        }),
        seat_flexibility_m_per_n: None,
    }
}

fn table<'r>() -> Table<'r, &'r BodyOutput> {
    use Notation::{Fixed, Plain, Power};
    let teeth = |value: fn(&TeethOutput) -> f64| move |b: &&BodyOutput| b.teeth.as_ref().map(value);
    let excess = |given: Option<f64>, meshed: f64| Some(100.0 * (meshed / given? - 1.0));
    Table::<&BodyOutput>::new()
        .column("body", "", |b| &b.body)
        .shown("body", Plain)
        .key()
        .column("elements", "number of finite elements", |b| b.elements)
        .shown("elements", Plain)
        .column("degrees_of_freedom", "number of free nodal displacements", |b| {
            b.degrees_of_freedom
        })
        .shown("free", Plain)
        .column("mass_kg", "of the finite-element mesh, kg", |b| b.mass_kg)
        .shown("mass kg", Fixed(4))
        .column("lumped_mass_kg", "the scene's value in [lumped], kg", |b| b.lumped_mass_kg)
        .shown("lumped kg", Power(4))
        .words("above %", Notation::Signed(1), move |b| excess(b.lumped_mass_kg, b.mass_kg))
        .meaning("by how much the mesh's value is above that in [lumped]")
        .column(
            "polar_inertia_kg_m2",
            "of the finite-element mesh, about the body's centre, kg m²",
            |b| b.polar_inertia_kg_m2,
        )
        .shown("inertia kg m²", Power(4))
        .column("lumped_inertia_kg_m2", "the scene's value in [lumped], kg m²", |b| {
            b.lumped_inertia_kg_m2
        })
        .shown("lumped kg m²", Power(4))
        .words("above %", Notation::Signed(1), move |b| {
            excess(b.lumped_inertia_kg_m2, b.polar_inertia_kg_m2)
        })
        .column(
            "flank_error_um",
            "largest distance of a meshed flank from its involute, µm",
            teeth(|t| t.flank_error_um),
        )
        .shown("flank error µm", Fixed(4))
        .column(
            "least_corner_angle_deg",
            "least corner of an element, °",
            teeth(|t| t.least_corner_angle_deg),
        )
        .shown("angle °", Fixed(0))
        .column(
            "largest_corner_angle_deg",
            "largest corner of an element, °",
            teeth(|t| t.largest_corner_angle_deg),
        )
        .shown("to °", Fixed(0))
        .column(
            "largest_aspect_ratio",
            "largest ratio of two sides of an element",
            teeth(|t| t.largest_aspect_ratio),
        )
        .shown("aspect", Fixed(1))
        .column(
            "least_jacobian_ratio",
            "least ratio of the smallest to the largest Jacobian determinant within one \
             element, 1 without distortion",
            teeth(|t| t.least_jacobian_ratio),
        )
        .shown("det J ratio", Fixed(2))
        .column(
            "flexibility_m_per_n",
            "normal displacement below mid-flank, at the matching depth, under a unit force \
             there; carrier: of a pin seat",
            |b| b.teeth.as_ref().map(|t| t.flexibility_m_per_n).or(b.seat_flexibility_m_per_n),
        )
        .scaled("flexibility µm/kN", 1e9, Fixed(4))
        .column(
            "neighbour_share",
            "displacement of the same point of the next tooth, over that of the loaded one",
            teeth(|t| t.neighbour_share),
        )
        .scaled("neighbour %", 100.0, Fixed(1))
}

impl Report for MeshOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(&self.bodies, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{}", self.title)?;
        table().text(&self.bodies, out)?;
        Ok(table().legend(out)?)
    }
}
