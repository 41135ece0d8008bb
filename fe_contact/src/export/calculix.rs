//! One mesh as an input deck for CalculiX, so that forces and pressures can be compared with
//! another program.
//!
//! Deck and simulator share the problem: involutes, phase, gaps and the positions of the races.
//! They share no part of its solution: the deck has eight-node elements throughout, with flank
//! nodes on the involute, and resolves contact by elements a small part of the patch wide
//! (face-to-face penalty), with no half-plane, no matching and no Hermite edges. Races are rigid
//! and prescribed, contact is frictionless, geometry is linear.
//!
//! Units of the deck: mm, N, MPa. Lines `** key = value` and `** pair …` at its head say what it
//! holds; `benches/calculix_pair.py` reads them.

use std::collections::HashMap;
use std::fmt::{self, Write as _};

use gearset::{Gear, Mesh, MeshMember};
use scene::{ElementFamily, PlaneState};

use crate::contact::hertz::Hertz;
use crate::contact::{Location, PairFrame, candidates, members};
use crate::element::Edge;
use crate::error::FeError;
use crate::fe_mesh::{FeGearMesh, Outline, RefinedTooth, Refinement, Side, rotated};
use crate::statics::{Bodies, MeshAtApproach, missing_mesh};

/// How a deck is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeckSettings {
    /// Contact elements per half-width of each pair's patch.
    pub per_half_width: f64,
    /// Elements along the flanks of all other teeth.
    pub flank_elements: usize,
    /// Teeth kept on either side of the loaded ones, `None` for whole gears. Cut faces are free.
    /// With eight teeth the results of OH-58's meshes are within 0.001 % of those of whole gears,
    /// with five those of the ring mesh within 0.03 %.
    pub teeth: Option<usize>,
    /// Penalty stiffness of contact, Pa/m; with 1e17 the flanks overlap by 0.01 µm under 1 GPa.
    pub penalty: f64,
}

impl Default for DeckSettings {
    fn default() -> Self {
        Self { per_half_width: 12.0, flank_elements: 12, teeth: None, penalty: 1e17 }
    }
}

/// The complete deck for a mesh at the phase and approach of `own`, whose pair forces determine the
/// size of the contact elements and nothing else.
///
/// # Errors
/// If a gear cannot be meshed or has tip relief, or in plane stress.
pub fn deck(
    bodies: &Bodies,
    own: &MeshAtApproach,
    settings: &DeckSettings,
) -> Result<String, FeError> {
    if bodies.material.plane == PlaneState::Stress {
        return Err(FeError::Unfit {
            key: "fe_contact.plane".into(),
            value: "stress".into(),
            allowed: "strain".into(),
            why:
                "CalculiX makes bricks of plane elements, and bricks as thick as the face is wide \
                  and narrow as contact asks answer as in plane strain"
                    .into(),
        });
    }
    let (mesh, _) = bodies.joined(own.kind)?;
    let all = candidates(mesh, own.phase, own.approach);
    let largest = own.pairs.iter().map(|p| p.force).fold(0.0, f64::max);
    let mut patches = Vec::new();
    for pair in &own.pairs {
        let frame =
            all.iter().find(|f| f.index == pair.index).ok_or_else(|| missing_mesh(own.kind))?;
        let line_load = pair.force.max(LEAST_SHARE * largest) / bodies.geometry.face_width;
        let half_width = Hertz::new(line_load, frame.radius(), &bodies.material).half_width;
        patches.push(Patch { frame, half_width });
    }
    let part = |member| Part::new(mesh, member, &patches, settings);
    let parts = [part(MeshMember::Driver)?, part(MeshMember::Driven)?];
    let deck = Deck { bodies, mesh, own, settings, patches: &patches, parts: &parts };
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = deck.write(&mut text);
    Ok(text)
}

/// Least force by which the contact elements of a pair are sized, as a fraction of the largest pair
/// force.
const LEAST_SHARE: f64 = 0.05;

/// Half the refined stretch of flank in half-widths of the patch.
const REACH: f64 = 1.6;

/// A pair and the expected half-width of its contact patch, m.
struct Patch<'m> {
    frame: &'m PairFrame<'m>,
    half_width: f64,
}

impl Patch<'_> {
    /// The member whose flank is the dependent (slave) surface: at a corner contact the one whose
    /// flank ends within the patch, otherwise the driven gear.
    fn slave(&self) -> MeshMember {
        match self.frame.location {
            Location::Corner(member) => member,
            Location::Path => MeshMember::Driven,
        }
    }
}

/// One edge of an element, 0 to 3 as in [`crate::element::Shape`].
type ElementEdge = (usize, usize);

/// Nodes, elements and surfaces of one gear.
struct Part {
    name: &'static str,
    /// Centre, m.
    centre: [f64; 2],
    /// Nodes in their place, m.
    points: Vec<[f64; 2]>,
    /// Corners, then middles of the edges 0–1, 1–2, 2–3, 3–0.
    elements: Vec<[usize; 8]>,
    /// Nodes on the race.
    race: Vec<usize>,
    /// Loaded flank of each patch, form circle to tip.
    flanks: Vec<Vec<ElementEdge>>,
}

impl Part {
    fn new(
        mesh: &Mesh,
        member: MeshMember,
        patches: &[Patch<'_>],
        settings: &DeckSettings,
    ) -> Result<Self, FeError> {
        let (name, gear) = (members(mesh.kind)[member as usize], mesh.gear(member));
        if gear.tip_relief.is_some() {
            return Err(FeError::Unfit {
                key: format!("geometry.{name}.tip_relief"),
                value: "given".into(),
                allowed: "none".into(),
                why: "the deck's flanks are pure involutes".into(),
            });
        }
        let teeth: Vec<_> = patches.iter().map(|p| p.frame.tooth(member)).collect();
        // Tooth 0 is that of the first patch.
        let (centre, angle) = teeth.first().map_or(([0.0; 2], 0.0), |t| (t.centre, t.axis));
        let numbers: Vec<usize> = teeth
            .iter()
            .map(|t| ((t.axis - angle) / gear.pitch_angle()).round() as i64)
            .map(|k| k.rem_euclid(i64::from(gear.teeth)) as usize)
            .collect();
        let gear_mesh = refined(name, gear, member, patches, &numbers, settings)?;
        let kept = |tooth: usize| {
            settings.teeth.is_none_or(|reach| {
                let apart =
                    |k: &usize| tooth.abs_diff(*k).min(gear.teeth as usize - tooth.abs_diff(*k));
                numbers.iter().map(apart).any(|d| d <= reach)
            })
        };
        let mut part = Self {
            name,
            centre,
            points: Vec::new(),
            elements: Vec::new(),
            race: Vec::new(),
            flanks: Vec::new(),
        };
        let edges = part.collect(&gear_mesh, angle, kept);
        for (number, tooth) in numbers.iter().zip(&teeth) {
            let stretches = &gear_mesh.sector(*number).flanks[tooth.side.index()];
            part.flanks.push(stretches.iter().map(|s| edges[&(*number, s.element)]).collect());
        }
        Ok(part)
    }

    /// Takes over nodes and elements of the kept teeth; returns the edges on flanks by tooth
    /// and element of its sector.
    fn collect(
        &mut self,
        mesh: &FeGearMesh,
        angle: f64,
        kept: impl Fn(usize) -> bool,
    ) -> HashMap<(usize, usize), ElementEdge> {
        let centre = self.centre;
        let place = |p: [f64; 2], angle: f64| {
            let [x, y] = rotated(p, angle);
            [centre[0] + x, centre[1] + y]
        };
        let mut ids: HashMap<usize, usize> = HashMap::new();
        let mut edges = HashMap::new();
        for e in mesh.elements.iter().filter(|e| kept(e.tooth)) {
            let mut shared = |node: usize| {
                *ids.entry(node).or_insert_with(|| {
                    self.points.push(place(mesh.points[node], angle));
                    if mesh.on_race[node] {
                        self.race.push(self.points.len() - 1);
                    }
                    self.points.len() - 1
                })
            };
            let mut nodes = [0; 8];
            for (slot, node) in nodes.iter_mut().zip(&e.nodes[..4]) {
                *slot = shared(*node);
            }
            let (mut next, mut on_flank) = (4, None);
            for (edge, kind) in e.shape.edges.iter().enumerate() {
                if *kind == Edge::Hermite {
                    on_flank = Some(edge);
                    next += 2;
                } else {
                    nodes[4 + edge] = shared(e.nodes[next]);
                    next += 1;
                }
            }
            if let Some(edge) = on_flank {
                // The middle of a flank's edge belongs to no other element: halfway by arc length.
                for side in [Side::Ccw, Side::Cw] {
                    let mut flank = mesh.sector(e.tooth).flanks[side.index()].iter();
                    let Some(stretch) = flank.find(|s| s.element == e.local) else { continue };
                    let [x, y] = mesh.outline.flank_point(0.5 * (stretch.from + stretch.to));
                    let turned = angle + mesh.tooth_angle(e.tooth);
                    self.points.push(place([x, side.sign() * y], turned));
                    nodes[4 + edge] = self.points.len() - 1;
                    edges.insert((e.tooth, e.local), (self.elements.len(), edge));
                }
            }
            self.elements.push(nodes);
        }
        edges
    }
}

/// The gear with the teeth of all patches refined where they touch.
fn refined(
    name: &'static str,
    gear: &Gear,
    member: MeshMember,
    patches: &[Patch<'_>],
    numbers: &[usize],
    settings: &DeckSettings,
) -> Result<FeGearMesh, FeError> {
    let refine = |patch: &Patch<'_>| {
        let (_, roll_length) = patch.frame.flank_point(member, 0.0);
        let (size, reach) = (patch.half_width / settings.per_half_width, REACH * patch.half_width);
        move |outline: &Outline, r: &mut Refinement| {
            r.resolve(outline, outline.flank_parameter(roll_length), size, reach);
        }
    };
    let fine: Vec<_> = patches.iter().map(refine).collect();
    let teeth =
        numbers.iter().zip(&fine).map(|(k, f)| (*k, f as &dyn Fn(&Outline, &mut Refinement)));
    let teeth: Vec<RefinedTooth<'_>> = teeth.collect();
    FeGearMesh::refined(name, gear, ElementFamily::Quadratic, settings.flank_elements, &teeth)
}

/// Everything that the text of a deck is written from.
struct Deck<'d> {
    bodies: &'d Bodies,
    mesh: &'d Mesh,
    own: &'d MeshAtApproach,
    settings: &'d DeckSettings,
    patches: &'d [Patch<'d>],
    parts: &'d [Part; 2],
}

impl Deck<'_> {
    fn write(&self, t: &mut String) -> fmt::Result {
        self.head(t)?;
        let (mut first_node, mut first_element) = (1, 1);
        for part in self.parts {
            self.part(t, part, first_node, first_element)?;
            first_node += part.points.len();
            first_element += part.elements.len();
        }
        self.contact(t)?;
        self.step(t)
    }

    fn head(&self, t: &mut String) -> fmt::Result {
        let (own, settings) = (self.own, self.settings);
        let driver = self.mesh.gear(MeshMember::Driver);
        let [x, y] = self.parts[0].centre;
        writeln!(t, "** mesh = {}", own.kind.name())?;
        writeln!(t, "** phase = {}", own.phase)?;
        writeln!(t, "** approach_um = {}", own.approach * 1e6)?;
        writeln!(t, "** driver = {}", self.parts[0].name)?;
        writeln!(t, "** driver_centre_mm = {} {}", x * 1e3, y * 1e3)?;
        writeln!(t, "** driver_base_radius_mm = {}", driver.base_radius * 1e3)?;
        writeln!(t, "** face_width_mm = {}", self.bodies.geometry.face_width * 1e3)?;
        writeln!(t, "** elements_per_half_width = {}", settings.per_half_width)?;
        writeln!(t, "** flank_elements = {}", settings.flank_elements)?;
        let teeth = settings.teeth.map_or("all".into(), |reach| reach.to_string());
        writeln!(t, "** teeth_kept_either_side = {teeth}")?;
        for (k, patch) in self.patches.iter().enumerate() {
            let location = match patch.frame.location {
                Location::Path => "path",
                Location::Corner(MeshMember::Driver) => "corner_of_driver",
                Location::Corner(MeshMember::Driven) => "corner_of_driven",
            };
            let (slave, _) = self.surfaces(k);
            let (index, element) = (patch.frame.index, patch.half_width / settings.per_half_width);
            writeln!(
                t,
                "** pair index = {index} slave = {slave} location = {location} element_um = {}",
                element * 1e6
            )?;
        }
        writeln!(t, "*HEADING\n{} mesh at phase {}", own.kind.name(), own.phase)
    }

    fn part(
        &self,
        t: &mut String,
        part: &Part,
        first_node: usize,
        first_element: usize,
    ) -> fmt::Result {
        let name = part.name;
        writeln!(t, "*NODE")?;
        for (i, [x, y]) in part.points.iter().enumerate() {
            // CalculiX reads 20 characters of a number.
            writeln!(t, "{},{:.14},{:.14}", first_node + i, x * 1e3, y * 1e3)?;
        }
        writeln!(t, "*ELEMENT, TYPE=CPE8, ELSET={name}")?;
        for (i, nodes) in part.elements.iter().enumerate() {
            let nodes = nodes.map(|n| (first_node + n).to_string());
            writeln!(t, "{},{}", first_element + i, nodes.join(","))?;
        }
        writeln!(t, "*NSET, NSET=RACE_{name}")?;
        for node in &part.race {
            writeln!(t, "{},", first_node + node)?;
        }
        for (k, flank) in part.flanks.iter().enumerate() {
            writeln!(t, "*SURFACE, NAME={}, TYPE=ELEMENT", surface(name, k))?;
            for (element, edge) in flank {
                writeln!(t, "{},S{}", first_element + element, edge + 1)?;
            }
        }
        Ok(())
    }

    /// Dependent and independent surface of patch `k`.
    fn surfaces(&self, k: usize) -> (String, String) {
        let slave = self.patches[k].slave() as usize;
        (surface(self.parts[slave].name, k), surface(self.parts[1 - slave].name, k))
    }

    fn contact(&self, t: &mut String) -> fmt::Result {
        let material = &self.bodies.material;
        let (young, width) = (material.young * 1e-6, self.bodies.geometry.face_width * 1e3);
        writeln!(t, "*MATERIAL, NAME=STEEL\n*ELASTIC\n{young},{}", material.poisson)?;
        for part in self.parts {
            writeln!(t, "*SOLID SECTION, ELSET={}, MATERIAL=STEEL\n{width}", part.name)?;
        }
        writeln!(t, "*SURFACE INTERACTION, NAME=FLANKS")?;
        writeln!(t, "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")?;
        writeln!(t, "{:e}", self.settings.penalty * 1e-9)?;
        for k in 0..self.patches.len() {
            let (slave, master) = self.surfaces(k);
            writeln!(t, "*CONTACT PAIR, INTERACTION=FLANKS, TYPE=SURFACE TO SURFACE")?;
            writeln!(t, "{slave},{master}")?;
        }
        Ok(())
    }

    fn step(&self, t: &mut String) -> fmt::Result {
        let [driver, driven] = self.parts;
        let r_b = self.mesh.gear(MeshMember::Driver).base_radius;
        // The sense in which the driver approaches.
        let sense = self.patches.first().map_or(0.0, |p| p.frame.approach_row()[2].signum());
        let theta = sense * self.own.approach / r_b;
        writeln!(t, "*BOUNDARY\nRACE_{},1,2", driven.name)?;
        writeln!(t, "*STEP, INC=100\n*STATIC\n1.,1.\n*BOUNDARY")?;
        for node in &driver.race {
            let [x, y] = driver.points[*node];
            let u = [-theta * (y - driver.centre[1]), theta * (x - driver.centre[0])];
            for (i, u) in u.iter().enumerate() {
                writeln!(t, "{},{},{},{:.12e}", node + 1, i + 1, i + 1, u * 1e3)?;
            }
        }
        writeln!(t, "*NODE PRINT, NSET=RACE_{}\nRF", driver.name)?;
        for k in 0..self.patches.len() {
            let (slave, master) = self.surfaces(k);
            writeln!(t, "*CONTACT PRINT, SLAVE={slave}, MASTER={master}\nCF")?;
        }
        writeln!(t, "*CONTACT PRINT\nCSTR\n*END STEP")
    }
}

fn surface(name: &str, patch: usize) -> String {
    format!("FLANK_{name}_{patch}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complementarity::ActiveSet;
    use crate::statics::at_approach;
    use gearset::MeshKind;
    use scene::Scene;
    use std::path::Path;

    fn bodies(name: &str) -> Bodies {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
        let mut scene = Scene::from_file(&path).unwrap();
        scene.fe_contact.flank_elements = 8;
        Bodies::new(&scene).unwrap()
    }

    const SETTINGS: DeckSettings =
        DeckSettings { per_half_width: 12.0, flank_elements: 6, teeth: Some(2), penalty: 1e17 };

    /// Both meshes, mid-path and with a corner: every node of a loaded flank lies on its involute,
    /// flanks run from form circle to tip without a break, elements in contact are as small as asked.
    #[test]
    fn flanks_are_involutes_resolved_where_they_touch() {
        let cases = [
            ("oh58_sun_planet_pair.toml", MeshKind::SunPlanet, 0.7, 20e-6, 1),
            ("oh58_sun_planet_pair.toml", MeshKind::SunPlanet, 0.9, 20e-6, 2),
            ("oh58_ring_planet_pair.toml", MeshKind::RingPlanet, 0.3, 12e-6, 2),
        ];
        for (scene, kind, phase, approach, count) in cases {
            let bodies = bodies(scene);
            let own = at_approach(&bodies, kind, phase, approach, &ActiveSet).unwrap();
            assert_eq!(own.pairs.len(), count);
            let mesh = bodies.geometry.mesh(kind).unwrap();
            let frames = candidates(mesh, phase, approach);
            let half_width = 2e-4;
            let patches: Vec<_> = frames.iter().map(|frame| Patch { frame, half_width }).collect();
            for member in [MeshMember::Driver, MeshMember::Driven] {
                let part = Part::new(mesh, member, &patches, &SETTINGS).unwrap();
                for (frame, flank) in frames.iter().zip(&part.flanks) {
                    check_flank(&part, frame, member, flank, half_width);
                }
            }
        }
    }

    fn check_flank(
        part: &Part,
        frame: &PairFrame<'_>,
        member: MeshMember,
        flank: &[ElementEdge],
        half_width: f64,
    ) {
        let across = |p: [f64; 2]| {
            let t = frame.tangent();
            (p[0] - frame.origin[0]) * t[0] + (p[1] - frame.origin[1]) * t[1]
        };
        let mut last = None;
        for (element, edge) in flank {
            let nodes = &part.elements[*element];
            let (mut from, mut to) = (nodes[*edge], nodes[(*edge + 1) % 4]);
            if *edge == 3 || (*edge != 1 && last == Some(to)) {
                (from, to) = (to, from);
            }
            assert!(last.is_none_or(|l| l == from));
            last = Some(to);
            for node in [from, nodes[4 + edge], to] {
                let p = part.points[node];
                let (q, _) = frame.flank_point(member, across(p));
                assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-13);
            }
            let [a, b] = [from, to].map(|n| across(part.points[n]));
            if a.abs().min(b.abs()) < half_width {
                assert!((a - b).abs() < 1.01 * half_width / SETTINGS.per_half_width);
            }
        }
    }

    /// The driver's race is turned towards the driven gear, as a rigid body.
    #[test]
    fn race_turns_by_the_approach() {
        let bodies = bodies("oh58_ring_planet_pair.toml");
        let own = at_approach(&bodies, MeshKind::RingPlanet, 0.3, 12e-6, &ActiveSet).unwrap();
        let text = deck(&bodies, &own, &SETTINGS).unwrap();
        let (_, step) = text.split_once("*STATIC").unwrap();
        let motion: Vec<f64> = step
            .lines()
            .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()) && line.contains('e'))
            .map(|line| line.rsplit(',').next().unwrap().parse().unwrap())
            .collect();
        let gear = bodies.geometry.planet.clone();
        let expected = 12e-3 / gear.base_radius * gear.body_radius.unwrap();
        assert!(motion.len() > 40);
        for u in motion.chunks(2) {
            assert!((u[0].hypot(u[1]) - expected).abs() < 1e-9 * expected);
        }
    }
}
