//! Keys of what no model here has, by the names in use, and what can be done instead.

use std::collections::BTreeMap;

/// A subject that no model here has.
struct Subject {
    /// Words of a key, between underscores, of which one is enough.
    words: &'static [&'static str],
    /// What is assumed instead.
    why: &'static str,
    /// What can be done.
    instead: &'static str,
}

const SUBJECTS: [Subject; 19] = [
    Subject {
        words: &["helix", "helical", "beta", "overlap", "spiral", "normal"],
        why: "teeth are straight: sections along the axis are alike",
        instead: "the transverse section of helical teeth: m_t = m_n/cos β, tan α_t = tan α_n/cos β, shifts x_t = x_n cos β; the overlap \
                  of their ends is left out",
    },
    Subject {
        words: &["friction", "mu", "traction", "efficiency", "stribeck"],
        why: "tooth contact is without friction",
        instead: "nothing; what friction takes from vibrations goes into [damping]",
    },
    Subject {
        words: &[
            "stage", "stages", "stage1", "stage2", "stage3", "gearbox", "hss", "lss", "parallel",
        ],
        why: "a scene is one set, or one mesh",
        instead: "one scene a stage; what is behind a member is its inertia in [lumped] and its shaft its torsional_nm_per_rad, both \
                  times the square of the ratio from the shaft to the member",
    },
    Subject {
        words: &[
            "compound", "stepped", "double", "idler", "planet2", "planet1", "planets2", "ring2",
            "sun2", "meshed",
        ],
        why: "every planet has one gear, which meshes with sun and ring",
        instead: "one gear pair (kind = \"gear_pair\") for each mesh of a stepped planet",
    },
    Subject {
        words: &["play", "looseness", "endplay"],
        why: "bearings are linear springs",
        instead: "the stiffness of the bearing at its load as bearing_n_per_m; play between teeth is [geometry.thickness]",
    },
    Subject {
        words: &["clearance", "clearances"],
        why: "bearings are linear springs, and teeth have backlash",
        instead: "the stiffness of a bearing at its load; backlash in [geometry.thickness]; tip clearance by dedendum − addendum of \
                  geometry.rack",
    },
    Subject {
        words: &["temperature", "temp", "thermal", "expansion", "celsius"],
        why: "nothing has a temperature",
        instead: "the geometry and the backlash at the temperature of operation",
    },
    Subject {
        words: &["oil", "lubricant", "lubrication", "viscosity", "ehl", "film", "churning"],
        why: "flanks touch dry",
        instead: "nothing; what the oil takes from vibrations goes into [damping]",
    },
    Subject {
        words: &["damping", "damper", "dashpot", "viscous", "zeta", "rayleigh"],
        why: "damping is proportional, C = αM + βK, and of bearings in proportion to their stiffness",
        instead: "[damping] with mass_proportional_per_s = α, stiffness_proportional_s = β, bearing_s = c/k; a ratio ζ at ω is \
                  α/2ω + βω/2",
    },
    Subject {
        words: &[
            "crowning",
            "crown",
            "lead",
            "misalignment",
            "tilt",
            "wobble",
            "skew",
            "axial",
            "thrust",
        ],
        why: "motion and contact are plane: loads are even over the face width",
        instead: "the part of the face width that carries as face_width_mm",
    },
    Subject {
        words: &[
            "error",
            "errors",
            "eccentricity",
            "runout",
            "unbalance",
            "imbalance",
            "deviation",
            "tolerance",
        ],
        why: "gears and places of planets are exact",
        instead: "positions of planets (planets.position_steps), tip_relief of a gear, bearings of single planets in [[planet_override]]",
    },
    Subject {
        words: &[
            "crack", "cracked", "pitting", "pit", "spall", "wear", "worn", "fault", "defect",
            "damage",
        ],
        why: "all teeth of a gear are alike",
        instead: "a softer mesh of one planet in the lumped model: sun_planet_n_per_m or ring_planet_n_per_m of [[planet_override]]",
    },
    Subject {
        words: &[
            "amplitude",
            "amplitudes",
            "harmonic",
            "harmonics",
            "fourier",
            "variation",
            "phase",
            "phases",
            "phasing",
            "contact_ratio",
            "contact_ratios",
        ],
        why: "a mesh stiffness given here has one value: how it varies over the mesh cycle is computed",
        instead: "[geometry], from which `sweep`, `branches` and `stability parametric` compute it; in a program a stiffness of any \
                  course, by ParametricSet of `lumped` or pair_law of `gearset`",
    },
    Subject {
        words: &["output"],
        why: "two members are named: one drives, one stands still or is held by its support",
        instead: "input and fixed of [operation], from which the third follows",
    },
    Subject {
        words: &["rim_thickness", "backup_ratio", "rim_ratio"],
        why: "a rim lies between two circles that are given",
        instead: "bore_diameter_mm of sun and planet, rim_diameter_mm of the ring",
    },
    Subject { words: &["gravity", "weight"], why: "no weight acts", instead: "nothing" },
    Subject {
        words: &[
            "radial",
            "tangential",
            "anisotropic",
            "orthotropic",
            "kxx",
            "kyy",
            "kxy",
            "bearing_x",
            "bearing_y",
        ],
        why: "a bearing is equally stiff in all directions",
        instead: "bearing_n_per_m with the smaller and with the larger stiffness: the n-th natural frequency lies between those of the \
                  two scenes, for every n",
    },
    Subject {
        words: &["diametral", "dp", "pd"],
        why: "pitches are metric",
        instead: "module_mm = 25.4/DP in geometry.rack",
    },
    Subject {
        words: &["hardness", "yield", "strength", "fatigue", "life", "safety"],
        why: "materials are elastic without limit",
        instead: "nothing; `static` prints the peak pressures that a rating needs",
    },
];

/// Why a key is out of scope, and what can be done instead, if it names such a subject; `numbers`: those of its table.
pub(crate) fn out_of_scope(
    key: &str,
    numbers: &BTreeMap<&str, f64>,
) -> Option<(&'static str, String)> {
    let name = key.to_ascii_lowercase();
    let has = |word: &&str| match word.contains('_') {
        true => name.contains(*word),
        false => name.split(['_', '-']).any(|part| part == *word),
    };
    if is_of_speed(&name) {
        let instead =
            "the stiffness at the speed of interest, one scene or `branches --over` for each";
        return Some(("a stiffness has one value at all speeds", instead.to_owned()));
    }
    // N s/m and N m s/rad are units of damping.
    let is_damping =
        name.contains("n_s_per_m") || name.contains("nm_s_per_rad") || name.contains("ns_per_m");
    let damping = |subject: &&Subject| is_damping && subject.words.contains(&"damping");
    let subject = SUBJECTS
        .iter()
        .find(damping)
        .or_else(|| SUBJECTS.iter().find(|subject| subject.words.iter().any(has)))?;
    let transverse = subject.words.contains(&"helix").then(|| transverse(key, numbers)).flatten();
    Some((subject.why, transverse.unwrap_or_else(|| subject.instead.to_owned())))
}

/// A stiffness over speed.
fn is_of_speed(name: &str) -> bool {
    let is = |word: &str| name.split('_').any(|part| part == word);
    (is("bearing") || is("stiffness")) && (is("speed") || is("speeds") || is("rpm"))
}

/// Module and angle in the transverse section, where the normal ones and the helix angle are known (ISO 21771):
/// m_t = m_n/cos β, tan α_t = tan α_n/cos β.
fn transverse(key: &str, numbers: &BTreeMap<&str, f64>) -> Option<String> {
    let value = *numbers.get(key).filter(|_| !key.contains("normal"))?;
    let beta = if key.ends_with("_rad") { value } else { value.to_radians() };
    let module = numbers.get("module_mm")? / beta.cos();
    let normal = numbers.get("pressure_angle_deg").unwrap_or(&20.0).to_radians();
    let angle = (normal.tan() / beta.cos()).atan().to_degrees();
    let is_angle = beta != 0.0 && beta.abs() < 1.0 && module.is_finite() && angle.is_finite();
    is_angle.then(|| {
        format!(
            "the transverse section instead, module_mm = {module:.6}, pressure_angle_deg = {angle:.6}, if these are normal ones; shifts \
             times {:.6}; the overlap of helical teeth is left out",
            beta.cos()
        )
    })
}
