//! Values of sections by their names, each within its range.

use super::super::reader::within;
use super::super::run;
use super::contents::{Disk, FUKUI_KANEKO, Gas, SHAPES, Shape, Shock};
use super::layout::{self, Value};
use crate::fault::{Fault, Faults};

/// Mode of a pulse given by a table.
const TABLE: usize = 5;

/// Values that are noted but not imported may be any number.
pub(super) const ANY: (f64, f64) = (-1e9, 1e9);

/// Names of the gas, as in `run.dat`.
const GAS: [(&str, &str, (f64, f64)); 3] = [
    ("p0", "Pa", run::PRESSURE_PA),
    ("al", "m", run::MEAN_FREE_PATH_M),
    ("vis", "Pa s", run::VISCOSITY_PA_S),
];

/// Values of sections, and the faults found.
pub(super) struct Values<'a> {
    pub(super) file: &'a str,
    pub(super) faults: Faults,
}

impl Values<'_> {
    /// The value of a name that its section is known to have.
    pub(super) fn of(
        &mut self,
        section: &[Value<'_>],
        name: &str,
        unit: &str,
        range: (f64, f64),
    ) -> f64 {
        let found = section.iter().find(|value| value.name == name);
        found.map_or(0.0, |value| self.at(value, name, unit, range))
    }

    pub(super) fn at(
        &mut self,
        value: &Value<'_>,
        what: &str,
        unit: &str,
        range: (f64, f64),
    ) -> f64 {
        within(self.file, &value.word, what, unit, range, &mut self.faults)
    }

    /// The whole number of a name; the least one beside a fault.
    pub(super) fn count(
        &mut self,
        section: &[Value<'_>],
        name: &str,
        (least, most): (usize, usize),
    ) -> usize {
        let Some(value) = section.iter().find(|value| value.name == name) else {
            return least;
        };
        let found = value.word.count();
        found
            .filter(|n| (least..=most).contains(n))
            .unwrap_or_else(|| {
                let fault = Fault::of("E174", self.file, "not a count");
                let fault = fault
                    .at(value.word.place())
                    .what(name)
                    .value(value.word.text);
                self.faults
                    .push(fault.allowed(format!("a whole number from {least} to {most}")));
                least
            })
    }

    /// 0 for none, or a length.
    pub(super) fn arm(&mut self, section: &[Value<'_>]) -> f64 {
        let found = section.iter().find(|value| value.name == "xact");
        found.map_or(0.0, |value| match value.word.real() {
            Ok(0.0) => 0.0,
            _ => self.at(value, "xact", "m", (5e-3, 0.2)),
        })
    }

    pub(super) fn gas(&mut self, section: &[Value<'_>]) -> Option<Gas> {
        let found = GAS.map(|(name, ..)| section.iter().find(|value| value.name == name));
        let [Some(_), Some(_), Some(_)] = found else {
            return None;
        };
        let [pressure_pa, mean_free_path_m, viscosity_pa_s] =
            GAS.map(|(name, unit, range)| self.of(section, name, unit, range));
        Some(Gas {
            pressure_pa,
            mean_free_path_m,
            viscosity_pa_s,
        })
    }

    /// The model of the flow; only one is known.
    pub(super) fn flow(&mut self, section: &[Value<'_>]) {
        let Some(value) = section.iter().find(|value| value.name == "iqpo") else {
            return;
        };
        let fault = match value.word.count() {
            Some(FUKUI_KANEKO) => return,
            Some(_) => Fault::of("E175", self.file, "no slip model that is known here"),
            None => Fault::of("E174", self.file, "not a count"),
        };
        self.faults.push(
            fault
                .at(value.word.place())
                .what("iqpo")
                .value(value.word.text)
                .allowed(format!("{FUKUI_KANEKO} for Fukui-Kaneko"))
                .hint("import it with that; gas.model of the study takes others"),
        );
    }

    /// Mode, start, width, magnitude, time constant.
    pub(super) fn shock(&mut self, section: &[Value<'_>], line: usize) -> Option<Shock> {
        const ORDER: &str = "mode, start, width, magnitude, time constant";
        let mode = match section.first().map(|value| (value, value.word.count())) {
            Some((_, Some(0))) => return None,
            Some((_, Some(mode))) if mode <= TABLE => mode,
            other => {
                let fault = Fault::of("E175", self.file, "no such mode of the shock");
                let fault = fault.line(line).what("mode of the shock");
                let fault = match other {
                    Some((value, _)) => fault.at(value.word.place()).value(value.word.text),
                    None => fault.value("nothing"),
                };
                let modes = "0 none, 1 half-sine, 2 square, 3 sine, 4 decaying sine, 5 table";
                self.faults.push(fault.allowed(modes));
                return None;
            }
        };
        let Some((_, shape)) = SHAPES.into_iter().find(|(number, _)| *number == mode) else {
            let fault = Fault::of("E176", self.file, "a pulse given by a table is not read");
            self.faults.push(
                fault
                    .at(section[0].word.place())
                    .what("mode of the shock")
                    .value(mode.to_string())
                    .allowed("0 to 4")
                    .hint("import it with mode 0, and give the study the table: pulse.table"),
            );
            return None;
        };
        let [_, start, width, magnitude, time_constant] = section else {
            let fault = Fault::of(
                "E175",
                self.file,
                "another number of values than the shock has",
            );
            self.faults.push(
                fault
                    .at(section[0].word.place())
                    .what("shock")
                    .value(format!("{} values", section.len()))
                    .allowed(ORDER),
            );
            return None;
        };
        let range = match shape {
            Shape::DecayingSine => (1e-6, 10.0),
            _ => (0.0, 10.0),
        };
        Some(Shock {
            shape,
            start_s: self.at(start, "start of the shock", "s", (0.0, 1.0)),
            width_s: self.at(width, "width of the shock", "s", (1e-6, 0.5)),
            magnitude_g: self.at(magnitude, "magnitude of the shock", "G", (-1e5, 1e5)),
            time_constant_s: self.at(time_constant, "time constant of the shock", "s", range),
        })
    }

    /// The material by name; by order the values before it and at the end.
    pub(super) fn disk(&mut self, section: &[Value<'_>], line: usize) -> Disk {
        let material = section.iter().position(|value| value.name == "e");
        let before = &section[..material.unwrap_or(0)];
        let mut disk = Disk {
            radii_m: [0.0; 2],
            thickness_m: 0.0,
            youngs_modulus_pa: self.of(section, "e", "Pa", (1e9, 1e12)),
            poisson: self.of(section, "nu", "", (0.0, 0.499)),
            density_kg_per_m3: self.of(section, "rho", "kg/m3", (500.0, 20_000.0)),
            alpha_per_s: 0.0,
            beta_s: 0.0,
        };
        let [.., inner, outer, thickness] = before else {
            let fault = Fault::of("E175", self.file, "values are missing before E");
            self.faults.push(
                fault
                    .line(line)
                    .what("disk")
                    .value(format!("{} values", before.len()))
                    .allowed("inner radius, outer radius, thickness before E, nu, rho"),
            );
            return disk;
        };
        let radius = (1e-3, 0.2);
        disk.radii_m = [
            self.at(inner, "inner radius of the disk", "m", radius),
            self.at(outer, "outer radius of the disk", "m", radius),
        ];
        disk.thickness_m = self.at(thickness, "thickness of the disk", "m", (5e-5, 5e-3));
        if self.faults.is_empty() && disk.radii_m[0] >= disk.radii_m[1] {
            let fault = Fault::of(
                "E175",
                self.file,
                "the inner radius is not inside the outer one",
            );
            self.faults.push(
                fault
                    .at(inner.word.place())
                    .what("inner radius of the disk")
                    .value(inner.word.text)
                    .allowed(format!("less than {}", outer.word.text)),
            );
        }
        // A section that ends with a value known by name has no damping.
        let [.., alpha, beta] = section else {
            return disk;
        };
        let known = layout::SECTIONS[layout::DISK].1;
        if [alpha, beta]
            .iter()
            .any(|value| known.contains(&value.name.as_str()))
        {
            let fault = Fault::of(
                "E175",
                self.file,
                "values are missing at the end of the section",
            );
            self.faults.push(
                fault
                    .at(beta.word.place())
                    .what("Rayleigh damping of the disk")
                    .value(beta.name.as_str())
                    .allowed(
                        "its shares of mass, 1/s, and of stiffness, s, as the last two values",
                    ),
            );
            return disk;
        }
        disk.alpha_per_s = self.at(alpha, "Rayleigh damping of the disk", "1/s", (0.0, 1e5));
        disk.beta_s = self.at(beta, "Rayleigh damping of the disk", "s", (0.0, 1e-3));
        disk
    }
}
