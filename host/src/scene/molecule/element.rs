//! The elements: radii and colors of their atoms.

use crate::scene::Color;
use crate::scene::text::{Source, Warnings};
use crate::srgb::linear_of_srgb;
use crate::table::shortened;

/// A chemical element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Element(u8);

impl Element {
    /// No element of the table: a dummy atom or an unreadable symbol.
    pub(crate) const UNKNOWN: Self = Self(0);
    pub(crate) const HYDROGEN: Self = Self(1);
    pub(crate) const CARBON: Self = Self(6);

    /// Finds an element by its symbol in upper or lower case, which a charge may follow, as in
    /// `Fe3+`. Deuterium (`D`) and tritium (`T`) are hydrogen.
    pub(crate) fn from_symbol(symbol: &str) -> Option<Self> {
        let letters = symbol.trim_end_matches(|c: char| c.is_ascii_digit() || c == '+' || c == '-');
        if letters.eq_ignore_ascii_case("D") || letters.eq_ignore_ascii_case("T") {
            return Some(Self::HYDROGEN);
        }
        let known = |&(symbol, ..): &(&str, f64, f64, u32)| symbol.eq_ignore_ascii_case(letters);
        let index = ELEMENTS.iter().skip(1).position(known)? + 1;
        u8::try_from(index).ok().map(Self)
    }

    /// Finds an element by its atomic number.
    pub(crate) fn from_number(number: u8) -> Option<Self> {
        (1..ELEMENTS.len())
            .contains(&number.into())
            .then_some(Self(number))
    }

    /// Returns the element that was found, or the unknown one with a warning. `of` and `name` say whose it is.
    pub(in crate::scene) fn or_unknown(
        found: Option<Self>,
        [of, name]: [&str; 2],
        (source, line): (&Source, usize),
        warnings: &mut Warnings,
    ) -> Self {
        found.unwrap_or_else(|| {
            let name = shortened(name);
            let sentence = format!("the element {of}{name:?} is unknown; it is drawn in pink");
            warnings.add(source, line, sentence);
            Self::UNKNOWN
        })
    }

    /// The symbol, such as `Fe`; `X` for unknown elements.
    pub(crate) fn symbol(self) -> &'static str {
        ELEMENTS[usize::from(self.0)].0
    }

    /// The van der Waals radius in angstroms.
    pub(crate) fn van_der_waals(self) -> f64 {
        ELEMENTS[usize::from(self.0)].1
    }

    /// The covalent radius in angstroms, by which bonds are found. `None` for elements that are
    /// treated as ions (the alkali and alkaline earth metals), whose neighbors are not bonded.
    pub(crate) fn covalent(self) -> Option<f64> {
        let is_ion = matches!(
            self.0,
            3 | 4 | 11 | 12 | 19 | 20 | 37 | 38 | 55 | 56 | 87 | 88
        );
        (self != Self::UNKNOWN && !is_ion).then_some(ELEMENTS[usize::from(self.0)].2)
    }

    /// The conventional color.
    pub(crate) fn color(self) -> Color {
        let rgb = ELEMENTS[usize::from(self.0)].3;
        [rgb >> 16, rgb >> 8, rgb].map(|channel| linear_of_srgb(f64::from(channel & 0xFF) / 255.0))
    }
}

/// Symbol, van der Waals radius, covalent radius (both in angstroms), color (sRGB), by atomic
/// number.
///
/// * Van der Waals radii of the main groups: A. Bondi, *J. Phys. Chem.* 68 (1964) 441, as
///   completed by M. Mantina et al., *J. Phys. Chem. A* 113 (2009) 5806, with their 1.10 for
///   hydrogen. All others: S. Alvarez, *Dalton Trans.* 42 (2013) 8617.
/// * Covalent radii: B. Cordero et al., *Dalton Trans.* (2008) 2832; of carbon the sp3 value, of
///   Mn, Fe and Co the low-spin value.
/// * Colors: those of the molecule viewer Jmol, which extend the colors of Corey, Pauling and
///   Koltun's models to all elements. The unknown element is deep pink, with the radius of carbon.
///
/// Beyond the last element of a source, its last value is repeated (van der Waals from Fm, covalent
/// from Bk). Pm has the van der Waals radius of Pr.
#[rustfmt::skip]
const ELEMENTS: [(&str, f64, f64, u32); 110] = [
    ("X", 1.70, 0.76, 0xFF1493),
    ("H", 1.10, 0.31, 0xFFFFFF),
    ("He", 1.40, 0.28, 0xD9FFFF),
    ("Li", 1.81, 1.28, 0xCC80FF),
    ("Be", 1.53, 0.96, 0xC2FF00),
    ("B", 1.92, 0.84, 0xFFB5B5),
    ("C", 1.70, 0.76, 0x909090),
    ("N", 1.55, 0.71, 0x3050F8),
    ("O", 1.52, 0.66, 0xFF0D0D),
    ("F", 1.47, 0.57, 0x90E050),
    ("Ne", 1.54, 0.58, 0xB3E3F5),
    ("Na", 2.27, 1.66, 0xAB5CF2),
    ("Mg", 1.73, 1.41, 0x8AFF00),
    ("Al", 1.84, 1.21, 0xBFA6A6),
    ("Si", 2.10, 1.11, 0xF0C8A0),
    ("P", 1.80, 1.07, 0xFF8000),
    ("S", 1.80, 1.05, 0xFFFF30),
    ("Cl", 1.75, 1.02, 0x1FF01F),
    ("Ar", 1.88, 1.06, 0x80D1E3),
    ("K", 2.75, 2.03, 0x8F40D4),
    ("Ca", 2.31, 1.76, 0x3DFF00),
    ("Sc", 2.58, 1.70, 0xE6E6E6),
    ("Ti", 2.46, 1.60, 0xBFC2C7),
    ("V", 2.42, 1.53, 0xA6A6AB),
    ("Cr", 2.45, 1.39, 0x8A99C7),
    ("Mn", 2.45, 1.39, 0x9C7AC7),
    ("Fe", 2.44, 1.32, 0xE06633),
    ("Co", 2.40, 1.26, 0xF090A0),
    ("Ni", 2.40, 1.24, 0x50D050),
    ("Cu", 2.38, 1.32, 0xC88033),
    ("Zn", 2.39, 1.22, 0x7D80B0),
    ("Ga", 1.87, 1.22, 0xC28F8F),
    ("Ge", 2.11, 1.20, 0x668F8F),
    ("As", 1.85, 1.19, 0xBD80E3),
    ("Se", 1.90, 1.20, 0xFFA100),
    ("Br", 1.83, 1.20, 0xA62929),
    ("Kr", 2.02, 1.16, 0x5CB8D1),
    ("Rb", 3.03, 2.20, 0x702EB0),
    ("Sr", 2.49, 1.95, 0x00FF00),
    ("Y", 2.75, 1.90, 0x94FFFF),
    ("Zr", 2.52, 1.75, 0x94E0E0),
    ("Nb", 2.56, 1.64, 0x73C2C9),
    ("Mo", 2.45, 1.54, 0x54B5B5),
    ("Tc", 2.44, 1.47, 0x3B9E9E),
    ("Ru", 2.46, 1.46, 0x248F8F),
    ("Rh", 2.44, 1.42, 0x0A7D8C),
    ("Pd", 2.15, 1.39, 0x006985),
    ("Ag", 2.53, 1.45, 0xC0C0C0),
    ("Cd", 2.49, 1.44, 0xFFD98F),
    ("In", 1.93, 1.42, 0xA67573),
    ("Sn", 2.17, 1.39, 0x668080),
    ("Sb", 2.06, 1.39, 0x9E63B5),
    ("Te", 2.06, 1.38, 0xD47A00),
    ("I", 1.98, 1.39, 0x940094),
    ("Xe", 2.16, 1.40, 0x429EB0),
    ("Cs", 3.43, 2.44, 0x57178F),
    ("Ba", 2.68, 2.15, 0x00C900),
    ("La", 2.98, 2.07, 0x70D4FF),
    ("Ce", 2.88, 2.04, 0xFFFFC7),
    ("Pr", 2.92, 2.03, 0xD9FFC7),
    ("Nd", 2.95, 2.01, 0xC7FFC7),
    ("Pm", 2.92, 1.99, 0xA3FFC7),
    ("Sm", 2.90, 1.98, 0x8FFFC7),
    ("Eu", 2.87, 1.98, 0x61FFC7),
    ("Gd", 2.83, 1.96, 0x45FFC7),
    ("Tb", 2.79, 1.94, 0x30FFC7),
    ("Dy", 2.87, 1.92, 0x1FFFC7),
    ("Ho", 2.81, 1.92, 0x00FF9C),
    ("Er", 2.83, 1.89, 0x00E675),
    ("Tm", 2.79, 1.90, 0x00D452),
    ("Yb", 2.80, 1.87, 0x00BF38),
    ("Lu", 2.74, 1.87, 0x00AB24),
    ("Hf", 2.63, 1.75, 0x4DC2FF),
    ("Ta", 2.53, 1.70, 0x4DA6FF),
    ("W", 2.57, 1.62, 0x2194D6),
    ("Re", 2.49, 1.51, 0x267DAB),
    ("Os", 2.48, 1.44, 0x266696),
    ("Ir", 2.41, 1.41, 0x175487),
    ("Pt", 2.29, 1.36, 0xD0D0E0),
    ("Au", 2.32, 1.36, 0xFFD123),
    ("Hg", 2.45, 1.32, 0xB8B8D0),
    ("Tl", 1.96, 1.45, 0xA6544D),
    ("Pb", 2.02, 1.46, 0x575961),
    ("Bi", 2.07, 1.48, 0x9E4FB5),
    ("Po", 1.97, 1.40, 0xAB5C00),
    ("At", 2.02, 1.50, 0x754F45),
    ("Rn", 2.20, 1.50, 0x428296),
    ("Fr", 3.48, 2.60, 0x420066),
    ("Ra", 2.83, 2.21, 0x007D00),
    ("Ac", 2.80, 2.15, 0x70ABFA),
    ("Th", 2.93, 2.06, 0x00BAFF),
    ("Pa", 2.88, 2.00, 0x00A1FF),
    ("U", 2.71, 1.96, 0x008FFF),
    ("Np", 2.82, 1.90, 0x0080FF),
    ("Pu", 2.81, 1.87, 0x006BFF),
    ("Am", 2.83, 1.80, 0x545CF2),
    ("Cm", 3.05, 1.69, 0x785CE3),
    ("Bk", 3.40, 1.69, 0x8A4FE3),
    ("Cf", 3.05, 1.69, 0xA136D4),
    ("Es", 2.70, 1.69, 0xB31FD4),
    ("Fm", 2.70, 1.69, 0xB31FBA),
    ("Md", 2.70, 1.69, 0xB30DA6),
    ("No", 2.70, 1.69, 0xBD0D87),
    ("Lr", 2.70, 1.69, 0xC70066),
    ("Rf", 2.70, 1.69, 0xCC0059),
    ("Db", 2.70, 1.69, 0xD1004F),
    ("Sg", 2.70, 1.69, 0xD90045),
    ("Bh", 2.70, 1.69, 0xE00038),
    ("Hs", 2.70, 1.69, 0xE6002E),
    ("Mt", 2.70, 1.69, 0xEB0026),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_order_of_atomic_numbers() {
        for (symbol, number) in [
            ("H", 1),
            ("C", 6),
            ("Ca", 20),
            ("Fe", 26),
            ("Xe", 54),
            ("Au", 79),
            ("U", 92),
            ("Mt", 109),
        ] {
            assert_eq!(
                Element::from_symbol(symbol),
                Some(Element(number)),
                "{symbol}"
            );
        }
    }

    #[test]
    fn atomic_numbers_end_with_the_table() {
        assert_eq!(Element::from_number(1), Some(Element::HYDROGEN));
        assert_eq!(Element::from_number(109).map(Element::symbol), Some("Mt"));
        for nothing in [0, 110, 255] {
            assert_eq!(Element::from_number(nothing), None);
        }
    }

    #[test]
    fn symbols_are_read_in_any_case_and_with_charges() {
        assert_eq!(
            Element::from_symbol("FE3+").map(Element::symbol),
            Some("Fe")
        );
        assert_eq!(
            Element::from_symbol("cl1-").map(Element::symbol),
            Some("Cl")
        );
        assert_eq!(Element::from_symbol("D"), Some(Element::HYDROGEN));
        for nothing in ["", "X", "A", "12", "C?", "\u{fffd}"] {
            assert_eq!(Element::from_symbol(nothing), None, "{nothing}");
        }
    }

    #[test]
    fn colors_are_linear() {
        assert_eq!(Element::HYDROGEN.color(), [1.0; 3]);
        assert!((Element::CARBON.color()[0] - 0.2789).abs() < 1e-4);
    }
}
