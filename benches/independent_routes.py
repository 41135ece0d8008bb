"""What can be known of every shipped scene without finite elements, by formulas of gear theory in 50-digit arithmetic.

    python3 -m venv venv && venv/bin/pip install --quiet mpmath
    venv/bin/python benches/independent_routes.py        # writes reference/independent_routes.csv in a few seconds

The formulas are derived here from the geometry of involutes, from Willis' equation and from Lin & Parker (1999); of the
program only the conventions of its pages are used (docs/results.md, docs/physics.md, docs/scene_keys.md). Numbers of a
scene are read as the decimal numbers they are written as. Values have 17 significant digits.

A row is scene, kind, quantity, body, number, value, unit:

geometry   base_pitch, base_radius, operating_pressure_angle, contact_ratio (tip circle to tip circle, transverse),
           backlash (of profile shifts, at the operating pitch circles), mesh_frequency_per_rpm (of the input member),
           hertz_pressure (one tooth pair at the pitch point, plane strain, the torque shared equally),
           direction (+1: pairs run from the start of the path to its end, -1: from its end to its start),
           mesh_phase and gamma (cycles, 0 to 1). A phase counts from where a pair starts the theoretical path of the
           pressing flanks, the sun driving; those of all meshes are less that of planet 0's sun mesh. As they follow
           in time, phases are direction times mesh_phase. gamma is that of a planet's ring mesh less its sun mesh.
any        planet_position; excites: number is the harmonic of the mesh frequency.
lumped     mass and stiffness (upper triangle, body is row and column); frequency and multiplicity (body is the type of
           the mode, number counts distinct frequencies of a type from 1; 0 Hz is rigid-body motion).
torsional  frequency and multiplicity with every centre held: x = y = 0 of central members, zeta = 0, eta = u of the
           carrier; rotational modes move all planets alike, planet modes move them against each other.
"""

import pathlib
import tomllib

import mpmath as mp

mp.mp.dps = 50
ROOT = pathlib.Path(__file__).resolve().parent.parent
MM = mp.mpf(1) / 1000
DEGREE = mp.pi / 180
ZERO = mp.mpf(10) ** -30        # of the largest number beside it: what is smaller is the rounding of an exact zero
SAME = mp.mpf(10) ** -25        # eigenvalues closer than this, relatively, are one that occurs several times
NOT_SHIPPED = [("planet_override",), ("planets", "positions_deg"), ("sun", "torsional_nm_per_rad"),
               ("ring", "torsional_nm_per_rad"), ("carrier", "torsional_nm_per_rad"), ("lumped", "from")]


def involute(angle):
    return mp.tan(angle) - angle


def roll_length(radius, base):
    """Roll length of an involute at a radius; 0 where the radius is inside the base circle."""
    return mp.sqrt(max(radius**2 - base**2, 0))


def part(cycles):
    """The part of a number of cycles beyond whole ones, 0 to 1."""
    found = cycles - mp.floor(cycles)
    return mp.mpf(0) if found < ZERO or 1 - found < ZERO else found


def operating_point(scene):
    """External torque on the sun (N m), mesh frequency (Hz) per rpm of the input member, and direction.

    Willis: Z_s (w_s - w_c) = -Z_r (w_r - w_c). The mesh frequency is Z_s |w_s - w_c|/2 pi. Power and torques are in
    balance, so that T_s : T_r : T_c = Z_s : Z_r : -(Z_s + Z_r). Where the sun's power relative to the carrier is
    negative, the ring drives the meshes, and pairs run the path backwards.
    """
    given, z = scene["operation"], dict(scene["teeth"])
    driven, fixed = given.get("input", "sun"), given.get("fixed", "ring")
    if scene["kind"] == "gear_pair":
        speed = {"sun": mp.mpf(1), "carrier": mp.mpf(0)}
    else:
        z["carrier"] = -(z["sun"] + z["ring"])
        output = ({"sun", "ring", "carrier"} - {fixed, driven}).pop()
        speed = {fixed: mp.mpf(0), driven: mp.mpf(1), output: -mp.mpf(z[driven]) / z[output]}   # sum of z w is 0
    torque, relative = given["torque_nm"] * z["sun"] / z[driven], speed["sun"] - speed["carrier"]
    return torque, z["sun"] * abs(relative) / 60, int(mp.sign(torque * relative * given["speed_rpm"]))


class Gears:
    """Circles, pressure angles, tooth thicknesses and phases of the gears of a scene. Meshes are named sun and ring."""

    def __init__(self, scene):
        g, z = scene["geometry"], scene["teeth"]
        self.a = g["center_distance_mm"] * MM
        self.rack = g.get("rack")
        if self.rack:
            self.pitch = mp.pi * self.rack["module_mm"] * MM * mp.cos(self.rack["pressure_angle_deg"] * DEGREE)
        elif "base_pitch_mm" in g:
            self.pitch = g["base_pitch_mm"] * MM
        else:
            self.pitch = mp.pi * g["planet_base_diameter_mm"] * MM / z["planet"]
        self.meshes = [scene["mesh"].removesuffix("_planet")] if "mesh" in scene else ["sun", "ring"]
        self.base = {body: z[body] * self.pitch / (2 * mp.pi) for body in [*self.meshes, "planet"]}
        # The path lies on a common tangent of the base circles, a sin(alpha) long between its points of contact. The
        # planet's roll length is r_bp tan(alpha) at the pitch point; everywhere the sun's is a sin(alpha) less it and
        # the ring's a sin(alpha) more. Where the sun drives, the sun mesh starts at the planet's tip and ends at the
        # sun's; the planet drives the ring from the ring's tip to its own.
        base = self.base["planet"]
        tip = {body: roll_length(g[body]["tip_diameter_mm"] * MM / 2, self.base[body]) for body in self.base}
        self.angle, self.ratio, self.before_pitch_point = {}, {}, {}
        for mesh in self.meshes:
            sign = 1 if mesh == "sun" else -1
            alpha = self.angle[mesh] = mp.acos((self.base[mesh] + sign * base) / self.a)
            tangent = self.a * mp.sin(alpha)
            if mesh == "sun":
                start, end = min(tip["planet"], tangent), max(tangent - tip["sun"], 0)
            else:
                start, end = max(tip["ring"] - tangent, 0), tip["planet"]
            self.ratio[mesh] = sign * (start - end) / self.pitch
            self.before_pitch_point[mesh] = sign * (start - base * mp.tan(alpha))
        self.thickness(g.get("thickness", {}), z)

    def thickness(self, given, z):
        """Half angle of the planet's teeth on the base circle, and backlash where profile shifts give it.

        An involute tooth of the half angle h on its base circle has the half angle h - inv(alpha) at the pressure angle
        alpha. The ring's space has the shape of an external tooth; its shift is positive away from the centre.
        """
        self.backlash = {}
        if "profile_shift" in given:
            rack = self.rack["pressure_angle_deg"] * DEGREE
            shift = {body: given["profile_shift"].get(body, 0) for body in self.base}
            half = {body: (mp.pi / 2 + 2 * x * mp.tan(rack)) / z[body] + involute(rack) for body, x in shift.items()}
            self.half_planet = half["planet"]
            for mesh, alpha in self.angle.items():
                own, planet = (2 * (half[b] - involute(alpha)) * self.base[b] / mp.cos(alpha) for b in [mesh, "planet"])
                self.backlash[mesh] = self.pitch / mp.cos(alpha) - own - planet if mesh == "sun" else own - planet
        elif "sun" in self.meshes:
            alpha = self.angle["sun"]
            backlash = given["sun_planet_backlash_mm"] * MM
            planet = given["planet_share"] * (self.pitch / mp.cos(alpha) - backlash)
            self.half_planet = planet * mp.cos(alpha) / (2 * self.base["planet"]) + involute(alpha)

    def gamma(self, z_planet):
        """Phase of a planet's ring mesh less that of its sun mesh, in cycles, 0 to 1.

        The sun turns counter-clockwise and drives a planet at angle 0 clockwise; angles are about the centre of the
        planet. A tooth at the angle v, of half angles h_s and h_r at the operating pitch circles, is pushed by the sun
        on its flank at v + h_s, and its other flank at v - h_r pushes the ring. Pairs are at pitch points when v + h_s
        = pi and v - h_r = 0. In cycles, Z_p/2 pi of -v, the ring mesh is thus past its pitch point by Z_p (h_s + h_r -
        pi)/2 pi more than the sun mesh. Either is past the start of its path by the way from there to the pitch
        point more. The mirror image has the same gamma.
        """
        half = sum(self.half_planet - involute(alpha) for alpha in self.angle.values())
        between = (self.before_pitch_point["ring"] - self.before_pitch_point["sun"]) / self.pitch
        return part(z_planet * (half - mp.pi) / (2 * mp.pi) + between)


def geometry_rows(scene):
    z, gears = scene["teeth"], Gears(scene)
    yield "base_pitch", "", "", gears.pitch, "m"
    yield from (("base_radius", body, "", radius, "m") for body, radius in gears.base.items())
    yield from (("operating_pressure_angle", f"{mesh}_mesh", "", angle, "rad") for mesh, angle in gears.angle.items())
    yield from (("contact_ratio", f"{mesh}_mesh", "", ratio, "") for mesh, ratio in gears.ratio.items())
    yield from (("backlash", f"{mesh}_mesh", "", backlash, "m") for mesh, backlash in gears.backlash.items())
    torque, per_rpm, direction = operating_point(scene) if "operation" in scene else (None, None, None)
    if torque:
        yield "mesh_frequency_per_rpm", scene["operation"].get("input", "sun"), "", per_rpm, "Hz/rpm"
        yield "direction", "", "", direction, ""
    planets = [0]
    if scene["kind"] == "planetary":
        # A counter-clockwise sun meets planet n later than planet 0 by the angle psi_n: the phase is -Z_s psi_n/2 pi.
        # The ring, then clockwise relative to the carrier, meets it earlier: Z_r psi_n/2 pi. Under a clockwise torque
        # on the sun the other flanks press, whose phases are those of the mirrored set.
        planets, gamma = turns_of_planets(scene), gears.gamma(z["planet"])
        pressing = -1 if torque and torque < 0 else 1
        yield "gamma", "", "", gamma, "cycles"
        for n, turn in enumerate(planets):
            yield "mesh_phase", f"sun_mesh_{n}", "", part(-pressing * z["sun"] * turn), "cycles"
        for n, turn in enumerate(planets):
            yield "mesh_phase", f"ring_mesh_{n}", "", part(gamma + pressing * z["ring"] * turn), "cycles"
    if torque:
        # Hertz: p = sqrt(F E*/(pi b R)) with E* = E/(2 (1 - nu^2)) of two equal materials. The flanks' radii of
        # curvature are their roll lengths; the planet passes its force on: both meshes carry T_s/(N r_bs).
        material = {"young_modulus_pa": mp.mpf(206e9), "poisson_ratio": mp.mpf("0.3"), **scene.get("material", {})}
        modulus = material["young_modulus_pa"] / (2 * (1 - material["poisson_ratio"] ** 2))
        force = abs(torque) / (len(planets) * gears.base["sun"]) / (scene["geometry"]["face_width_mm"] * MM)
        for mesh, angle in gears.angle.items():
            own = 1 / gears.base[mesh] if mesh == "sun" else -1 / gears.base[mesh]
            curvature = (1 / gears.base["planet"] + own) / mp.tan(angle)
            yield "hertz_pressure", f"{mesh}_mesh", "", mp.sqrt(force * modulus * curvature / mp.pi), "Pa"


def turns_of_planets(scene):
    """Places of the planets, in turns."""
    planets = scene["planets"]
    steps = scene["teeth"]["sun"] + scene["teeth"]["ring"] if "position_steps" in planets else planets["count"]
    return [mp.mpf(step) / steps for step in planets.get("position_steps", range(planets["count"]))]


def excited(angles, sun_teeth, harmonic):
    """Types of modes that a harmonic of the mesh frequency can excite, of equal planets.

    The forces of harmonic l in the meshes of planet n are those of planet 0 times f_n = e^(-i l Z_s psi_n). Rotational
    modes move all planets alike and take up sum f_n. Translational ones move them as cos and sin psi_n and take up
    sum f_n e^(i psi_n) and sum f_n e^(-i psi_n), either of which is enough. Planet modes take up what of f_n no
    combination of 1, cos psi_n and sin psi_n can make. A sum that is not exactly zero excites, however small it is.
    """
    forces = [mp.expj(-harmonic * sun_teeth * angle) for angle in angles]
    rest = list(forces)
    for vector in orthonormal([[mp.mpf(1)] * len(angles), [mp.cos(x) for x in angles], [mp.sin(x) for x in angles]]):
        amount = mp.fsum(b * f for b, f in zip(vector, forces))
        rest = [r - amount * b for r, b in zip(rest, vector)]
    translation = [mp.fsum(f * mp.expj(s * angle) for f, angle in zip(forces, angles)) for s in (1, -1)]
    strengths = {"rotational": [mp.fsum(forces)], "translational": translation, "planet": rest}
    return "+".join(mode for mode, sums in strengths.items() if any(abs(x) > ZERO for x in sums)) or "none"


def lumped_model(scene, angles):
    """Names of the coordinates that can move, and mass (a diagonal) and stiffness of a planetary set."""
    lumped, pin = scene["lumped"], scene["planet"]
    gears = Gears(scene) if "geometry" in scene else None
    names = [f"{body}_{axis}" for body in ["carrier", "ring", "sun"] for axis in "xyu"]
    names += [f"planet_{n}_{axis}" for n in range(len(angles)) for axis in ["zeta", "eta", "u"]]
    place = {name: k for k, name in enumerate(names)}

    def over_r2(body, inertia):
        """I/r^2, of the carrier with the centre distance."""
        if body in lumped.get("radius_mm", {}):
            return inertia / (lumped["radius_mm"][body] * MM) ** 2
        return inertia / (gears.a if body == "carrier" else gears.base[body]) ** 2

    def inertia_of(body):
        if "inertia_over_r2_kg" in lumped:
            return lumped["inertia_over_r2_kg"][body]
        return over_r2(body, lumped["inertia_kg_m2"][body]) if body in lumped["inertia_kg_m2"] else None

    def pressure_angle(mesh):
        given = lumped.get("pressure_angle_deg")
        return given[f"{mesh}_planet"] * DEGREE if given else gears.angle[mesh]

    stiffness = mp.zeros(len(names))

    def spring(k, terms):
        """A spring whose deflection is a sum of coordinates times factors."""
        for first, b in terms:
            for second, c in terms:
                stiffness[place[first], place[second]] += k * b * c

    mass, held = {}, set()
    for body in ["carrier", "ring", "sun"]:
        support, m = scene.get(body, {}), lumped["mass_kg"].get(body)       # None where it cannot move
        held |= {f"{body}_{axis}" for axis in {"rotation_held": "u", "held": "xyu"}.get(support.get("motion"), "")}
        mass |= {f"{body}_x": m, f"{body}_y": m, f"{body}_u": inertia_of(body)}
        for axis in "xy":
            spring(support.get("bearing_n_per_m", 0), [(f"{body}_{axis}", 1)])
        spring(support.get("torsional_n_per_m", 0), [(f"{body}_u", 1)])
    m, turning = lumped["mass_kg"]["planet"] + pin.get("added_mass_kg", 0), inertia_of("planet")
    if "added_inertia_kg_m2" in pin:
        turning += over_r2("planet", pin["added_inertia_kg_m2"])
    for n, psi in enumerate(angles):
        zeta, eta, u = (f"planet_{n}_{axis}" for axis in ["zeta", "eta", "u"])
        mass |= {zeta: m, eta: m, u: turning}
        out, along = (mp.cos(psi), mp.sin(psi)), (-mp.sin(psi), mp.cos(psi))

        def moving(body, radial, tangential):
            """Terms of a central member's displacement along a direction given at planet n."""
            return [(f"{body}_{axis}", radial * out[i] + tangential * along[i]) for i, axis in enumerate("xy")]

        # The counter-clockwise sun pushes the planet along (sin, cos) of its pressure angle, outwards and tangentially,
        # and turns it clockwise; the planet pushes the ring along (sin, -cos). Approach: pushing less pushed body.
        s, c = mp.sin(pressure_angle("sun")), mp.cos(pressure_angle("sun"))
        spring(lumped["mesh_n_per_m"]["sun_planet"],
               moving("sun", s, c) + [("sun_u", 1), (zeta, -s), (eta, -c), (u, 1)])
        s, c = mp.sin(pressure_angle("ring")), mp.cos(pressure_angle("ring"))
        spring(lumped["mesh_n_per_m"]["ring_planet"],
               moving("ring", -s, c) + [("ring_u", 1), (zeta, s), (eta, -c), (u, -1)])
        spring(pin["bearing_n_per_m"], moving("carrier", 1, 0) + [(zeta, -1)])
        spring(pin["bearing_n_per_m"], moving("carrier", 0, 1) + [("carrier_u", 1), (eta, -1)])
    free = [name for name in names if name not in held]
    kept = mp.matrix([[stiffness[place[a], place[b]] for b in free] for a in free])
    return free, [mass[name] for name in free], kept


def orthonormal(vectors, against=()):
    """An orthonormal basis of the part of the vectors beyond an orthonormal basis."""
    basis = list(against)
    for vector in vectors:
        for b in basis + basis:         # twice, for the digits that the first time cancels
            amount = mp.fsum(x * y for x, y in zip(b, vector))
            vector = [x - amount * y for x, y in zip(vector, b)]
        length = mp.sqrt(mp.fsum(x * x for x in vector))
        if length > ZERO:
            basis.append([x / length for x in vector])
    return basis[len(against):]


def subspaces(names, angles):
    """Orthonormal bases of the rotational, translational and planet modes in coordinates scaled by the root of M."""
    def central(axes):
        return [[mp.mpf(name == one) for name in names] for one in names if one[:6] != "planet" and one[-1] in axes]

    def following(wave):
        amplitudes = {f"planet_{n}": wave(angle) for n, angle in enumerate(angles)}
        return [[mp.mpf(amplitudes.get(name.removesuffix(axis), 0)) for name in names]
                for axis in ["_zeta", "_eta", "_u"]]

    rotational = orthonormal(central("u") + following(lambda angle: 1))
    translational = orthonormal(central("xy") + following(mp.cos) + following(mp.sin))
    planet = orthonormal(mp.eye(len(names)).tolist(), rotational + translational)
    return {"rotational": rotational, "translational": translational, "planet": planet}


def frequencies(mass, stiffness, bases):
    """Rows of every distinct natural frequency of subspaces, which must not act on each other."""
    size = len(mass)
    scaled = mp.matrix([[stiffness[i, j] / mp.sqrt(mass[i] * mass[j]) for j in range(size)] for i in range(size)])
    largest = mp.norm(scaled, mp.inf)
    columns = mp.matrix([vector for basis in bases.values() for vector in basis]).T
    whole = columns.T * scaled * columns
    first = 0
    for kind, basis in bases.items():
        last = first + len(basis)
        coupling = [whole[i, j] for i in range(first, last) for j in range(size) if not first <= j < last]
        assert all(abs(x) < largest * ZERO for x in coupling)
        groups = []
        for square in sorted(mp.eigsy(whole[first:last, first:last], eigvals_only=True)) if basis else []:
            square = mp.mpf(0) if abs(square) < largest * ZERO else square
            if groups and square - groups[-1][0] <= SAME * square:
                groups[-1].append(square)
            else:
                groups.append([square])
        for number, group in enumerate(groups, 1):
            yield "frequency", kind, number, mp.sqrt(group[0]) / (2 * mp.pi), "Hz"
            yield "multiplicity", kind, number, len(group), ""
        first = last


def lumped_rows(scene, angles):
    """(kind, row) of the lumped model and of its torsional limit."""
    names, mass, stiffness = lumped_model(scene, angles)
    yield from (("lumped", ("mass", f"{name} {name}", "", m, "kg")) for name, m in zip(names, mass))
    for i, row in enumerate(names):
        for j in range(i, len(names)):
            if abs(stiffness[i, j]) > mp.norm(stiffness, mp.inf) * ZERO:
                yield "lumped", ("stiffness", f"{row} {names[j]}", "", stiffness[i, j], "N/m")
    # Types are a theorem for equal planets if sum e^(i psi_n) = 0, of rotations alone for equal planets at any places.
    balanced = abs(mp.fsum(mp.expj(x) for x in angles)) < ZERO
    bases = subspaces(names, angles) if balanced else {"": mp.eye(len(names)).tolist()}
    yield from (("lumped", row) for row in frequencies(mass, stiffness, bases))
    turning = [name for name in names if name.endswith("_u")]
    follow = mp.matrix([[mp.mpf(name == u or (name.endswith("_eta") and u == "carrier_u")) for u in turning]
                        for name in names])
    moved = [mp.fsum(m * follow[i, j] ** 2 for i, m in enumerate(mass)) for j in range(len(turning))]
    alike = subspaces(turning, angles)["rotational"]
    bases = {"rotational": alike, "planet": orthonormal(mp.eye(len(turning)).tolist(), alike)}
    yield from (("torsional", row) for row in frequencies(moved, follow.T * stiffness * follow, bases))


def rows(scene):
    """(kind, row) of everything that is known of a scene."""
    assert not any(key[0] in scene and (len(key) == 1 or key[1] in scene[key[0]]) for key in NOT_SHIPPED)
    if "geometry" in scene:
        yield from (("geometry", row) for row in geometry_rows(scene))
    if scene["kind"] == "planetary":
        angles = [2 * mp.pi * turn for turn in turns_of_planets(scene)]
        yield from (("any", ("planet_position", f"planet_{n}", "", x, "rad")) for n, x in enumerate(angles))
        for harmonic in range(1, 11) if "teeth" in scene else []:
            yield "any", ("excites", "", harmonic, excited(angles, scene["teeth"]["sun"], harmonic), "")
        if "lumped" in scene:
            yield from lumped_rows(scene, angles)


def main():
    lines = ["scene,kind,quantity,body,number,value,unit"]
    for path in sorted((ROOT / "data/scenes").glob("*.toml")):
        scene = tomllib.loads(path.read_text(encoding="utf-8"), parse_float=mp.mpf)
        for kind, (quantity, body, number, value, unit) in rows(scene):
            value = mp.nstr(value, 17) if isinstance(value, mp.mpf) else value
            lines.append(f"{path.stem},{kind},{quantity},{body},{number},{value},{unit}")
    (ROOT / "reference/independent_routes.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
