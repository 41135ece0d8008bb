//! Flanks of an external gear from the definitions of involute, fillet and tip relief. Lengths in mm.

pub(crate) type Point = [f64; 2];

pub(crate) fn unit(angle: f64) -> Point {
    [angle.cos(), angle.sin()]
}

pub(crate) fn turned(p: Point, angle: f64) -> Point {
    let [c, s] = unit(angle);
    [c * p[0] - s * p[1], s * p[0] + c * p[1]]
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// a + f b.
pub(crate) fn moved(a: Point, f: f64, b: Point) -> Point {
    [a[0] + f * b[0], a[1] + f * b[1]]
}

/// Tip relief that grows in proportion to the roll length from a diameter to the tip circle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearRelief {
    pub(crate) start_diameter: f64,
    /// Material taken off at the tip circle along the line of action.
    pub(crate) amount: f64,
}

/// Two such gears mesh at the centre distance `module · teeth` without profile shift.
#[derive(Debug, Clone)]
pub(crate) struct ExternalGear {
    pub(crate) teeth: u32,
    pub(crate) base: f64,
    pub(crate) tip: f64,
    pub(crate) root: f64,
    pub(crate) bore: f64,
    pub(crate) fillet: f64,
    /// Polar angle, from the tooth's axis, where the involute of the tooth's counter-clockwise flank
    /// leaves the base circle.
    pub(crate) origin: f64,
    pub(crate) relief: Option<LinearRelief>,
}

impl ExternalGear {
    /// Standard teeth, thinned by half the backlash on the pitch circle.
    pub(crate) fn new(
        [teeth, module, pressure_angle, backlash]: [f64; 4],
        [tip, root, bore, fillet]: [f64; 4],
        relief: Option<LinearRelief>,
    ) -> Self {
        let pitch = 0.5 * module * teeth;
        let thickness = 0.5 * (std::f64::consts::PI * module - backlash);
        let involute = pressure_angle.tan() - pressure_angle;
        let (base, origin) = (pitch * pressure_angle.cos(), 0.5 * thickness / pitch + involute);
        Self { teeth: teeth as u32, base, tip, root, bore, fillet, origin, relief }
    }

    pub(crate) fn pitch_angle(&self) -> f64 {
        std::f64::consts::TAU / f64::from(self.teeth)
    }

    /// Length of the string from the base circle to a point of the involute at a radius.
    pub(crate) fn roll_length(&self, radius: f64) -> f64 {
        (radius * radius - self.base * self.base).sqrt()
    }

    pub(crate) fn tip_roll_length(&self) -> f64 {
        self.roll_length(self.tip)
    }

    /// Relief at a roll length and its derivative; a tooth continued beyond its tip goes on alike.
    fn relief(&self, s: f64) -> (f64, f64) {
        let Some(relief) = self.relief else { return (0.0, 0.0) };
        let start = self.roll_length(0.5 * relief.start_diameter);
        let slope = relief.amount / (self.tip_roll_length() - start);
        if s > start { (slope * (s - start), slope) } else { (0.0, 0.0) }
    }

    /// Point of the counter-clockwise flank: the end of a string unwound from the base circle, shortened by the relief,
    /// P = r_b e(φ) + (s − w(s)) e′(φ),  φ = φ₀ − s/r_b.
    pub(crate) fn flank(&self, s: f64) -> Point {
        let [c, d] = unit(self.origin - s / self.base);
        let string = s - self.relief(s).0;
        [self.base * c - string * d, self.base * d + string * c]
    }

    /// Outward unit normal of that flank: dP/ds = (s − w)/r_b e − w′ e′, turned by a right angle.
    pub(crate) fn normal(&self, s: f64) -> Point {
        let [c, d] = unit(self.origin - s / self.base);
        let (w, slope) = self.relief(s);
        let (across, along) = ((s - w) / self.base, slope);
        let n = [-across * d + along * c, across * c + along * d];
        let size = n[0].hypot(n[1]);
        [n[0] / size, n[1] / size]
    }

    /// Arc length from the involute's origin, s²/(2 r_b); relief changes it by parts in a million.
    pub(crate) fn arc(&self, s: f64) -> f64 {
        0.5 * s * s / self.base
    }

    pub(crate) fn roll_length_at_arc(&self, arc: f64) -> f64 {
        (2.0 * self.base * arc).max(0.0).sqrt()
    }

    /// Roll length where the fillet leaves the flank: its centre lies `fillet` beyond the flank on the string and as
    /// far above the root circle.
    pub(crate) fn form_roll_length(&self) -> f64 {
        self.roll_length(self.root + self.fillet) - self.fillet
    }

    /// Point of the fillet's arc: 0 at the flank, 1 at the root circle.
    pub(crate) fn fillet_point(&self, t: f64) -> Point {
        let form = self.form_roll_length();
        let [c, d] = unit(self.origin - form / self.base);
        let centre = moved([self.base * c, self.base * d], form + self.fillet, [-d, c]);
        let from = (-c).atan2(d);
        let to = (-centre[1]).atan2(-centre[0]);
        let swing = (to - from + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
            - std::f64::consts::PI;
        moved(centre, self.fillet, unit(from + t * swing))
    }
}
