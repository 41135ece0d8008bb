//! From a scene to the text of its file, in the units of the keys.

use gearset::{GearInput, PlanetPositions, ThicknessInput, Thinning, assembly};
use serde::Serialize;
use toml::{Table, Value};

use crate::choices::{AutoQuantity, Fidelity};
use crate::keys::KEYS;
use crate::read::lumped::{pressure_angles, radii};
use crate::scene::*;

impl Scene {
    /// The scene as a file: every value that can be given is given. Reading it makes an equal scene; a length or an
    /// angle that no number of millimetres or degrees gives to the last bit becomes its neighbour.
    pub fn to_toml(&self) -> String {
        let mut file = File(Table::new());
        file.set("format", 1);
        file.word("kind", self.kind);
        if let Some(pair) = self.pair {
            file.word("mesh", pair);
        }
        file.set("title", self.title.clone());
        if let Some(source) = &self.source {
            file.set("source", source.clone());
        }
        if self.kind == SceneKind::Planetary {
            self.write_planets(&mut file);
        }
        if let Some(teeth) = &self.teeth {
            let gears = [("sun", teeth.sun), ("planet", Some(teeth.planet)), ("ring", teeth.ring)];
            for (gear, count) in gears {
                if let Some(count) = count {
                    file.set(&format!("teeth.{gear}"), count);
                }
            }
        }
        self.write_geometry(&mut file);
        file.number("material.young_modulus_pa", self.material.young_modulus_pa);
        file.number("material.poisson_ratio", self.material.poisson_ratio);
        file.number("material.density_kg_per_m3", self.material.density_kg_per_m3);
        self.write_supports(&mut file);
        self.write_lumped(&mut file);
        let damping = &self.damping;
        file.number("damping.mass_proportional_per_s", damping.mass_proportional_per_s);
        file.number("damping.stiffness_proportional_s", damping.stiffness_proportional_s);
        file.number("damping.bearing_s", damping.bearing_s);
        if let Some(operation) = &self.operation {
            if self.kind == SceneKind::Planetary {
                file.word("operation.fixed", operation.fixed);
            }
            file.word("operation.input", operation.input);
            file.number("operation.speed_rpm", operation.speed_rpm);
            file.number("operation.torque_nm", operation.torque_nm);
        }
        self.write_choices(&mut file);
        file.0.to_string()
    }

    fn write_planets(&self, file: &mut File) {
        let PlanetPositions { psi_rad, steps } = &self.planets;
        file.set("planets.count", psi_rad.len() as i64);
        if *psi_rad == PlanetPositions::equally_spaced(psi_rad.len()).psi_rad {
            return;
        }
        let of_steps = self.teeth.and_then(|teeth| teeth.sun_ring()).zip(steps.as_ref());
        let of_steps = of_steps.filter(|((z_s, z_r), steps)| {
            let step = assembly::assembly_step_rad(*z_s, *z_r);
            steps.iter().map(|&k| k as f64 * step).eq(psi_rad.iter().copied())
        });
        match of_steps {
            Some((_, steps)) => file.set("planets.position_steps", steps.clone()),
            None => {
                let degrees = psi_rad.iter().map(|&psi| file.in_unit("planets.positions_deg", psi));
                file.set("planets.positions_deg", degrees.collect::<Vec<_>>());
            }
        }
    }

    fn write_geometry(&self, file: &mut File) {
        let Some(geometry) = &self.geometry else { return };
        file.number("geometry.center_distance_mm", geometry.center_distance_m);
        file.number("geometry.face_width_mm", geometry.face_width_m);
        match geometry.rack {
            Some(rack) => {
                file.number("geometry.rack.module_mm", rack.module_m);
                file.number("geometry.rack.pressure_angle_deg", rack.pressure_angle_rad);
            }
            None => file.number("geometry.base_pitch_mm", geometry.base_pitch_m),
        }
        let gears: [(&str, Option<&GearInput>, &str); 3] = [
            ("sun", geometry.sun.as_ref(), "bore"),
            ("planet", Some(&geometry.planet), "bore"),
            ("ring", geometry.ring.as_ref(), "rim"),
        ];
        for (name, gear, body) in gears {
            let Some(gear) = gear else { continue };
            let at = |key: &str| format!("geometry.{name}.{key}");
            file.number(&at("tip_diameter_mm"), 2.0 * gear.tip_radius_m);
            file.number(&at("root_diameter_mm"), 2.0 * gear.root_radius_m);
            let body_diameter = gear.body_radius_m.map(|r| 2.0 * r);
            file.optional(&at(&format!("{body}_diameter_mm")), body_diameter);
            file.number(&at("fillet_radius_mm"), gear.fillet_radius_m);
            if let Some(relief) = gear.tip_relief {
                file.number(&at("tip_relief.start_diameter_mm"), 2.0 * relief.start_radius_m);
                file.number(&at("tip_relief.amount_um"), relief.amount_m);
                file.word(&at("tip_relief.shape"), relief.shape);
            }
        }
        if let Some(carrier) = &geometry.carrier {
            file.number("geometry.carrier.bore_diameter_mm", 2.0 * carrier.bore_radius_m);
            file.number("geometry.carrier.outer_diameter_mm", 2.0 * carrier.outer_radius_m);
            file.number("geometry.carrier.pin_seat_diameter_mm", 2.0 * carrier.pin_seat_radius_m);
            file.set("geometry.carrier.body", if carrier.is_rigid { "rigid" } else { "flexible" });
        }
        match geometry.thickness {
            ThicknessInput::Backlash {
                sun_planet_m: sun_planet,
                ring_planet_m: ring_planet,
                planet_share,
            } => {
                file.number("geometry.thickness.sun_planet_backlash_mm", sun_planet);
                file.number("geometry.thickness.ring_planet_backlash_mm", ring_planet);
                file.number("geometry.thickness.planet_share", planet_share);
            }
            ThicknessInput::ProfileShift { sun, planet, ring, thinning } => {
                let gears = [
                    ("sun", sun, thinning.sun_m),
                    ("planet", planet, thinning.planet_m),
                    ("ring", ring, thinning.ring_m),
                ];
                for (gear, shift, thinner) in gears {
                    file.number(&format!("geometry.thickness.profile_shift.{gear}"), shift);
                    if thinning != Thinning::default() {
                        file.number(&format!("geometry.thickness.thinning_mm.{gear}"), thinner);
                    }
                }
            }
        }
    }

    fn write_supports(&self, file: &mut File) {
        let s = &self.supports;
        let Some(pair) = &s.pair else {
            for (member, support) in [("sun", &s.sun), ("ring", &s.ring), ("carrier", &s.carrier)] {
                file.support(member, support, support.motion);
            }
            file.number("planet.bearing_n_per_m", s.planet_bearing_n_per_m);
            file.number("planet.added_mass_kg", s.planet_added.mass_kg);
            file.number("planet.added_inertia_kg_m2", s.planet_added.inertia_kg_m2);
            return;
        };
        if self.pair == Some(gearset::MeshKind::RingPlanet) {
            return;
        }
        let gears =
            [("sun", s.sun, pair.sun_inertia), ("planet", pair.planet, pair.planet_inertia)];
        for (gear, support, inertia) in gears {
            // A gear without a bearing stiffness has its centre held.
            let motion = match support.motion {
                Freedom::CentreHeld => Freedom::Free,
                motion => motion,
            };
            file.support(gear, &support, motion);
            file.optional(&format!("{gear}.mass_kg"), inertia.mass_kg);
            file.optional(&format!("{gear}.inertia_kg_m2"), inertia.inertia_kg_m2);
        }
    }

    fn write_lumped(&self, file: &mut File) {
        let Some(lumped) = &self.lumped else { return };
        let is_set = self.kind == SceneKind::Planetary;
        let geometry = self.tooth_geometry().ok();
        let derived = geometry.as_ref().map(radii).unwrap_or_default().by_name();
        for (table, values) in [
            ("mass_kg", lumped.mass_kg),
            ("inertia_over_r2_kg", lumped.inertia_over_r2_kg),
            ("radius_mm", lumped.radius_m),
        ] {
            for entry in values.by_name() {
                // What follows from the geometry is not repeated.
                if table != "radius_mm" || !derived.contains(&entry) {
                    file.optional(&format!("lumped.{table}.{}", entry.0), entry.1);
                }
            }
        }
        let angles = geometry.and_then(|g| pressure_angles(&g, !is_set));
        let mut tables = vec![("mesh_n_per_m", lumped.mesh_n_per_m)];
        if angles != Some(lumped.pressure_angle_rad) {
            tables.push(("pressure_angle_deg", lumped.pressure_angle_rad));
        }
        for (table, values) in tables {
            file.number(&format!("lumped.{table}.sun_planet"), values.sun_planet);
            if is_set {
                file.number(&format!("lumped.{table}.ring_planet"), values.ring_planet);
            }
        }
        let overrides = self.overrides.iter().map(|planet| {
            let mut file = File(Table::new());
            file.set("planet", planet.planet as i64);
            let values = [
                ("mass_kg", planet.mass_kg),
                ("inertia_over_r2_kg", planet.inertia_over_r2_kg),
                ("bearing_n_per_m", planet.bearing_n_per_m),
                ("sun_planet_n_per_m", planet.sun_mesh_n_per_m),
                ("ring_planet_n_per_m", planet.ring_mesh_n_per_m),
            ];
            values.into_iter().for_each(|(key, value)| file.optional(key, value));
            file.0
        });
        let overrides: Vec<_> = overrides.collect();
        if !overrides.is_empty() {
            file.set("planet_override", overrides);
        }
    }

    fn write_choices(&self, file: &mut File) {
        let fe = &self.fe_contact;
        file.word("fe_contact.plane", fe.plane);
        file.word("fe_contact.element", fe.element);
        file.set("fe_contact.flank_elements", fe.flank_elements);
        file.word("fe_contact.flank_layer", fe.flank_layer);
        file.set("fe_contact.contact_cells", fe.contact_cells);
        file.word("fe_contact.cell_layout", fe.cell_layout);
        file.word("fe_contact.cell_layout_at_rest", fe.cell_layout_at_rest);
        file.optional("fe_contact.matching_depth_mm", fe.matching_depth_m);
        file.optional("fe_contact.matching_depth_elements", fe.matching_depth_elements);
        file.set("fe_contact.matching_points", fe.matching_points);
        if let Some(positions) = fe.mean_positions {
            file.set("fe_contact.mean_positions", positions);
        }
        file.number("fe_contact.flexibility_factor.sun_planet", fe.flexibility_factor.sun_planet);
        file.number("fe_contact.flexibility_factor.ring_planet", fe.flexibility_factor.ring_planet);
        let dynamics = &self.dynamics;
        let name = match dynamics.fidelity {
            _ if dynamics.auto.is_some() => "auto",
            Fidelity::MeshLaw => "mesh_law",
            Fidelity::QuasiStatic => "quasi_static",
            Fidelity::Modal(_) => "modal",
            Fidelity::Full => "full",
        };
        file.set("dynamics.fidelity", name);
        if let Fidelity::Modal(modes) = dynamics.fidelity {
            file.set("dynamics.modes", modes);
        }
        file.set("dynamics.gyroscopic", if dynamics.gyroscopic { "on" } else { "off" });
        file.word("dynamics.kinematics", dynamics.kinematics);
        let quantity = dynamics.auto.map(|auto| auto.quantity);
        if !matches!(quantity, Some(AutoQuantity::Amplitude { .. })) {
            file.set("dynamics.steps_per_cycle", dynamics.steps_per_cycle);
        }
        let Some(auto) = dynamics.auto else { return };
        file.set("dynamics.quantity", auto.quantity.names().0);
        file.number("dynamics.tolerance_percent", auto.tolerance_percent);
        match auto.quantity {
            AutoQuantity::NaturalFrequency { mode_type, number } => {
                file.word("dynamics.mode_type", mode_type);
                file.set("dynamics.mode_number", number);
            }
            AutoQuantity::Amplitude { response } => file.word("dynamics.response", response),
            AutoQuantity::TransmissionError | AutoQuantity::MeanTransmissionError => {}
        }
    }
}

/// A scene file that is being written.
struct File(Table);

impl File {
    /// Puts a value under a dotted path.
    fn set(&mut self, path: &str, value: impl Into<Value>) {
        let (tables, name) = path.rsplit_once('.').unwrap_or(("", path));
        let mut table = &mut self.0;
        for step in tables.split('.').filter(|step| !step.is_empty()) {
            let below = table.entry(step).or_insert_with(|| Table::new().into());
            let Some(below) = below.as_table_mut() else { return };
            table = below;
        }
        table.insert(name.to_owned(), value.into());
    }

    /// A choice by its name.
    fn word(&mut self, path: &str, choice: impl Serialize) {
        if let Ok(word) = Value::try_from(choice) {
            self.set(path, word);
        }
    }

    /// A number, given in SI units.
    fn number(&mut self, path: &str, si: f64) {
        let value = self.in_unit(path, si);
        self.set(path, value);
    }

    /// A number that may be left out, given in SI units.
    fn optional(&mut self, path: &str, si: Option<f64>) {
        if let Some(si) = si {
            self.number(path, si);
        }
    }

    /// The number with the fewest digits that the reader takes for this one in SI units.
    fn in_unit(&self, path: &str, si: f64) -> f64 {
        let Some(key) = KEYS.iter().find(|key| key.path == path) else { return si };
        let near = si / key.to_si(1.0);
        let short = (0..17).filter_map(|digits| format!("{near:.digits$e}").parse().ok());
        let neighbours = [near.next_down(), near.next_up()];
        short.chain(neighbours).find(|x| key.to_si(*x) == si).unwrap_or(near)
    }

    fn support(&mut self, member: &str, support: &Support, motion: Freedom) {
        self.word(&format!("{member}.motion"), motion);
        if support.motion.translates() || support.bearing_n_per_m != 0.0 {
            self.number(&format!("{member}.bearing_n_per_m"), support.bearing_n_per_m);
        }
        let (key, k) = match support.torsional {
            Torsional::PerLength(k) => ("torsional_n_per_m", k),
            Torsional::PerAngle(k) => ("torsional_nm_per_rad", k),
        };
        if k != 0.0 {
            self.number(&format!("{member}.{key}"), k);
        }
    }
}
