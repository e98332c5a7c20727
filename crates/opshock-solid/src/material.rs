//! Isotropic linear elastic materials, by name or by value.
//!
//! Moduli are those of the data sheets at 23 °C and slow loading. Polymers are stiffer at shock rates by 5 to 20 %, and
//! moulded fibre grades are not isotropic. A study that depends on the modulus should give its own.

/// An isotropic linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m³.
    pub density_kg_per_m3: f64,
}

/// A material with its name and the source of its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedMaterial {
    /// Name in study files.
    pub name: &'static str,
    /// The numbers.
    pub material: Material,
    /// Where they come from.
    pub source: &'static str,
}

/// Errors of a material.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value:e} is outside its range ({allowed})")]
pub struct MaterialError {
    /// Name of the field.
    pub name: &'static str,
    /// Value found.
    pub value: f64,
    /// Allowed range in words.
    pub allowed: &'static str,
}

const fn named(
    name: &'static str,
    youngs_modulus_gpa: f64,
    poisson: f64,
    density_kg_per_m3: f64,
    source: &'static str,
) -> NamedMaterial {
    NamedMaterial {
        name,
        material: Material {
            youngs_modulus_pa: youngs_modulus_gpa * 1e9,
            poisson,
            density_kg_per_m3,
        },
        source,
    }
}

/// Materials known by name. The polymers are those that ramps are moulded from (US patent 6 903 902 names acetal,
/// polyetherimide, polyphenylene sulfide; liquid crystal polymer is used as well). Poisson's ratios of the polymers are
/// usual values, not from the sheets.
///
/// `source` names what each number was compared with. "not seen" marks a sheet that was not available; its numbers were
/// only checked against the range given.
pub const MATERIALS: &[NamedMaterial] = &[
    named(
        "POM",
        2.85,
        0.37,
        1410.0,
        "acetal copolymer: Ticona Hostaform C 9021, sheet of 2008-06-03: 2850 MPa (ISO 527), creep \
         modulus 2500 MPa after 1 h; 1410 kg/m3 in the sheets of C 9021 XAP and C 27021 (2750 to \
         2900 MPa); Encyclopedia of Physical Science and Technology (2001), polymer volume, p. 459: \
         2.9 GPa, 1410 kg/m3",
    ),
    named(
        "LCP",
        15.0,
        0.40,
        1620.0,
        "30 % glass, Ticona Vectra A130 (sheet not seen); makeitfrom.com has 11 to 24 GPa along the \
         flow and 1400 to 1600 kg/m3 for grades of LCP, Wikipedia (Liquid-crystal polymer) 8.5 to 17.2 GPa \
         and 1380 to 1950 kg/m3",
    ),
    named(
        "PEEK",
        4.0,
        0.40,
        1300.0,
        "unfilled, Victrex 450G (sheet not seen); makeitfrom.com has 4.0 GPa and 1300 kg/m3 as the \
         lowest of its grades, others (Wikipedia, Polyether ether ketone) 3.6 GPa and 1320 kg/m3",
    ),
    named(
        "PEI",
        3.2,
        0.36,
        1270.0,
        "unfilled, SABIC Ultem 1000 (sheet not seen); Sastri (2014) has 1270 kg/m3, Beall \
         (plasticstoday.com, 2010) a flexural modulus of 480 000 psi, 3.3 GPa, Engineers Edge (Typical \
         engineering properties of plastics materials) a tensile one of 430 000 psi, 2.96 GPa, and 1270 \
         kg/m3",
    ),
    named(
        "PPS",
        14.7,
        0.35,
        1650.0,
        "40 % glass, Ticona Fortron 1140L4 sheet: 14 700 MPa (ISO 527), 1650 kg/m3 (ISO 1183)",
    ),
    named(
        "aluminium",
        68.9,
        0.33,
        2700.0,
        "alloy 6061-T6, Aluminum Association's typical values: 68.9 GPa, 2.70 g/cm3; Poisson's \
         ratio estimated from similar alloys",
    ),
    named(
        "steel",
        193.0,
        0.29,
        8000.0,
        "stainless AISI 304, MatWeb sheet: 193 to 200 GPa, 0.29, 8.00 g/cm3",
    ),
];

impl Material {
    /// The material of that name, in upper or lower case.
    pub fn by_name(name: &str) -> Option<Self> {
        let same = |known: &&NamedMaterial| known.name.eq_ignore_ascii_case(name);
        MATERIALS.iter().find(same).map(|known| known.material)
    }

    /// Lamé's λ and μ, Pa.
    pub fn lame_pa(&self) -> [f64; 2] {
        let (e, nu) = (self.youngs_modulus_pa, self.poisson);
        [
            e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            e / (2.0 * (1.0 + nu)),
        ]
    }

    /// Checks ranges.
    ///
    /// # Errors
    /// The first value out of its range.
    pub fn validate(&self) -> Result<(), MaterialError> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        for (name, value, ok, allowed) in [
            (
                "youngs_modulus",
                self.youngs_modulus_pa,
                positive(self.youngs_modulus_pa),
                "finite and above 0",
            ),
            (
                "poisson",
                self.poisson,
                self.poisson > -1.0 && self.poisson < 0.5,
                "above -1 and below 0.5",
            ),
            (
                "density",
                self.density_kg_per_m3,
                positive(self.density_kg_per_m3),
                "finite and above 0",
            ),
        ] {
            if !ok {
                return Err(MaterialError {
                    name,
                    value,
                    allowed,
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_named_material_is_valid_and_found_in_either_case() {
        for known in MATERIALS {
            known.material.validate().unwrap();
            let lower = known.name.to_lowercase();
            assert_eq!(Material::by_name(&lower), Some(known.material));
        }
        assert_eq!(Material::by_name("cheese"), None);
    }

    #[test]
    fn lame_constants_of_a_known_case() {
        // E = 10, ν = 1/4: λ = μ = 4.
        let material = Material {
            youngs_modulus_pa: 10.0,
            poisson: 0.25,
            density_kg_per_m3: 1.0,
        };
        for constant in material.lame_pa() {
            assert!((constant - 4.0).abs() < 1e-14);
        }
    }
}
