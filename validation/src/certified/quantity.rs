//! Names of quantities.

/// A quantity of the data set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// As tables write it.
    pub name: &'static str,
    /// Unit; empty of numbers.
    pub unit: &'static str,
    /// Smallest and largest value that it can have.
    pub range: [f64; 2],
    /// What it is.
    pub meaning: &'static str,
}

const fn quantity(
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
    meaning: &'static str,
) -> Quantity {
    Quantity { name, unit, range, meaning }
}

const POSITIVE: [f64; 2] = [0.0, f64::MAX];
const ANY: [f64; 2] = [f64::MIN, f64::MAX];

/// All of them.
pub const QUANTITIES: [Quantity; 35] = [
    quantity("base_radius", "m", POSITIVE, "base radius of a gear"),
    quantity("base_pitch", "m", POSITIVE, "distance of teeth along the line of action"),
    quantity(
        "operating_pressure_angle",
        "rad",
        [0.0, 1.58],
        "angle of the line of action to the pitch tangent",
    ),
    quantity("contact_ratio", "", POSITIVE, "length of the path of contact over the base pitch"),
    quantity("backlash", "m", ANY, "circumferential play of a mesh at its pitch circle"),
    quantity(
        "mesh_frequency_per_rpm",
        "Hz/rpm",
        POSITIVE,
        "mesh frequency at 1 rpm of the driven member",
    ),
    quantity(
        "direction",
        "",
        [-1.0, 1.0],
        "1 if tooth pairs run along the path from its start with the sun driving, −1 if back",
    ),
    quantity("gamma", "cycles", [0.0, 1.0], "γ: phase of a planet's ring mesh after its sun mesh"),
    quantity(
        "mesh_phase",
        "cycles",
        [0.0, 1.0],
        "place of a mesh on its path, where planet 0's sun mesh stands at 0",
    ),
    quantity("planet_position", "rad", ANY, "ψ_n: angle of a planet"),
    quantity(
        "hertz_pressure",
        "Pa",
        POSITIVE,
        "pressure of cylinders at the pitch point, one pair under an equal share of the torque",
    ),
    quantity("excites", "", [0.0, 1.0], "1 if a harmonic can excite modes of a kind, 0 if not"),
    quantity("frequency", "Hz", POSITIVE, "natural frequency; modes of a type count upwards"),
    quantity("multiplicity", "", [1.0, 1000.0], "number of modes of that type and frequency"),
    quantity("mass", "kg", ANY, "entry of the mass matrix"),
    quantity("stiffness", "N/m", ANY, "entry of the stiffness matrix"),
    quantity("displacement", "m", ANY, "displacement at rest under load, from the unloaded place"),
    quantity(
        "transmission_error",
        "m",
        ANY,
        "r_b θ of the loaded sun at rest: its mean (harmonic 0) and amplitudes",
    ),
    quantity(
        "rotation",
        "rad",
        ANY,
        "rotation at rest under load; of the sun the loaded transmission error",
    ),
    quantity("mesh_force", "N", ANY, "force of a mesh along its line of action"),
    quantity(
        "mesh_stiffness",
        "N/m",
        POSITIVE,
        "force of one mesh over the approach of its gears along the line of action",
    ),
    quantity("load_share", "", [0.0, 2.0], "force of a planet's mesh over the mean of all planets"),
    quantity("peak_pressure", "Pa", POSITIVE, "largest contact pressure of a mesh"),
    quantity(
        "amplitude",
        "",
        POSITIVE,
        "amplitude of a harmonic in a steady state; m, rad or N by its coordinate",
    ),
    quantity(
        "peak_amplitude",
        "",
        POSITIVE,
        "amplitude at the top of a resonance; m, rad or N by its coordinate",
    ),
    quantity("peak_speed", "rpm", POSITIVE, "speed of the driven member at the top of a resonance"),
    quantity(
        "peak_growth",
        "",
        POSITIVE,
        "peak_amplitude over that at 565 N m on the sun; the number is that of the mode within its type",
    ),
    quantity(
        "static_growth",
        "",
        POSITIVE,
        "amplitude of a harmonic of the sun at rest over that at 565 N m on the sun",
    ),
    quantity(
        "multiplier",
        "",
        [0.0, 100.0],
        "size of the largest Floquet multiplier of a steady state over a mesh cycle: below 1 it attracts",
    ),
    quantity(
        "longest_step",
        "s",
        POSITIVE,
        "longest stable time step of the explicit central difference, without damping",
    ),
    quantity(
        "lower_border",
        "Hz",
        POSITIVE,
        "mesh frequency where parametric instability of a pair of modes begins: mesh stiffness is a rectangular wave of \
         2 % of its mean, half its peak-to-peak, without damping",
    ),
    quantity("upper_border", "Hz", POSITIVE, "mesh frequency where that instability ends"),
    quantity(
        "contact_loss_damping_factor",
        "",
        POSITIVE,
        "factor on all damping of a scene below which teeth part at its strongest resonance",
    ),
    quantity(
        "several_motions_damping_factor",
        "",
        POSITIVE,
        "factor below which several motions are stable at one speed",
    ),
    quantity(
        "backside_contact_damping_factor",
        "",
        POSITIVE,
        "factor below which backside flanks touch",
    ),
];

impl Quantity {
    /// The quantity of that name.
    pub fn named(name: &str) -> Option<&'static Self> {
        QUANTITIES.iter().find(|quantity| quantity.name == name)
    }
}
