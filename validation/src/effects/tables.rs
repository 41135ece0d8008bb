//! The tables of effects as Markdown.

use std::fmt;

use super::Effects;
use super::variant::Base;

/// Pairs closer than this are printed as one frequency, percent.
const LEAST_SPLIT: f64 = 0.005;

impl Effects {
    fn head(&self, f: &mut fmt::Formatter<'_>, first: &str) -> fmt::Result {
        let mut seen: Vec<&str> = Vec::new();
        write!(f, "| {first} |")?;
        for name in &self.mode_type {
            seen.push(name);
            let place = seen.iter().filter(|s| *s == name).count();
            write!(f, " {name} {place} |")?;
        }
        writeln!(f)?;
        writeln!(f, "|---|{}", "---:|".repeat(self.mode_type.len()))
    }

    fn row(f: &mut fmt::Formatter<'_>, name: &str, cells: Vec<String>) -> fmt::Result {
        writeln!(f, "| {name} | {} |", cells.join(" | "))
    }

    fn models(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.head(f, "Hz")?;
        let whole = |list: &[f64]| list.iter().map(|x| format!("{x:.0}")).collect();
        let tenths = |list: &[f64]| list.iter().map(|x| format!("{x:.1}")).collect();
        let off = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(a, b)| signed(100.0 * (a / b - 1.0))).collect()
        };
        Self::row(f, "printed: lumped", whole(&self.printed_lumped_hz))?;
        Self::row(f, "lumped, as published", tenths(&self.published_hz))?;
        Self::row(f, "lumped, parameters from FE", tenths(&self.lumped_from_fe_hz))?;
        Self::row(f, "FE/contact, linearised", tenths(&self.fe_contact_hz))?;
        Self::row(f, "printed: FE/contact", whole(&self.printed_fe_contact_hz))?;
        let printed = off(&self.printed_fe_contact_hz, &self.printed_lumped_hz);
        Self::row(f, "printed FE/contact against printed lumped, %", printed)?;
        let ours = off(&self.fe_contact_hz, &self.published_hz);
        Self::row(f, "our FE/contact against lumped as published, %", ours)?;
        let paper = off(&self.fe_contact_hz, &self.printed_fe_contact_hz);
        Self::row(f, "our FE/contact against the printed, %", paper)
    }

    fn steps(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.head(f, "step, %")?;
        for pair in self.path.windows(2) {
            let (before, after) = (&pair[0].frequency_hz, &pair[1].frequency_hz);
            let moved = before.iter().zip(after).map(|(b, a)| signed(100.0 * (a / b - 1.0)));
            let kind = if pair[1].is_parameter { "parameter" } else { "model" };
            Self::row(f, &format!("{}: {}", kind, pair[1].change), moved.collect())?;
        }
        let left: Vec<String> = self.remainders_percent().into_iter().map(signed).collect();
        Self::row(f, "parameters one by one less all together", left)
    }

    fn changes(&self, f: &mut fmt::Formatter<'_>, base: Base) -> fmt::Result {
        let (first, name, splits) = match base {
            Base::FeContact => {
                ("against FE/contact, %", "(split of pairs, %)", &self.split_percent[1])
            }
            Base::LumpedFromFe => (
                "against lumped, parameters from FE, %",
                "(split of pairs, %)",
                &self.split_percent[0],
            ),
        };
        self.head(f, first)?;
        Self::row(f, name, splits.iter().map(|s| bracket(*s)).collect())?;
        for (variant, effects) in self.variants.iter().filter(|(v, _)| v.base() == base) {
            let cells = match effects {
                Some(list) => list
                    .iter()
                    .map(|e| format!("{} {}", signed(e.percent), bracket(e.split_percent)))
                    .map(|cell| cell.trim_end().to_owned())
                    .collect(),
                None => vec!["not run".to_owned(); self.mode_type.len()],
            };
            Self::row(f, &variant.name(), cells)?;
        }
        Ok(())
    }
}

fn signed(percent: f64) -> String {
    // Avoids -0.00.
    let text = format!("{percent:+.2}");
    if text.trim_start_matches(['+', '-']) == "0.00" { "0.00".into() } else { text }
}

fn bracket(split: f64) -> String {
    if split < LEAST_SPLIT { String::new() } else { format!("({split:.2})") }
}

impl fmt::Display for Effects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (number, planets) = (self.table.number(), self.table.planets());
        writeln!(f, "### Table {number}, {planets} planets\n")?;
        self.models(f)?;
        writeln!(f)?;
        self.steps(f)?;
        for base in [Base::FeContact, Base::LumpedFromFe] {
            writeln!(f)?;
            self.changes(f, base)?;
        }
        Ok(())
    }
}
