//! Molecules as PDB.

use crate::scene::{Scene, Shape};
use crate::shape::Sphere;
use std::fmt::Write;

/// The highest serial number that its five columns hold.
const MOST_ATOMS: usize = 99_999;

/// The reason why a scene does not fit into a PDB file.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum PdbError {
    #[error("the scene has no spheres, so there are no atoms to write")]
    NoAtoms,
    #[error("the scene has {0} atoms, but a PDB file numbers at most {MOST_ATOMS}")]
    TooManyAtoms(usize),
    #[error("a coordinate of {name} is {value}, but a PDB file holds -999.999 to 9999.999")]
    TooFar { name: String, value: f64 },
}

/// Writes the spheres of a scene as atoms, to a thousandth of an angstrom. The names of their
/// materials are their elements, as in scenes of molecules and in the samples. Other shapes, such
/// as the sticks of bonds, are left out.
///
/// # Errors
/// If there are no spheres, or the fixed columns of the format do not hold what there is.
pub fn pdb(scene: &Scene) -> Result<String, PdbError> {
    let atoms: Vec<_> = scene
        .objects
        .iter()
        .filter_map(|object| match object.shape {
            Shape::Sphere(Sphere { center, .. }) => Some((object, center)),
            _ => None,
        })
        .collect();
    match atoms.len() {
        0 => return Err(PdbError::NoAtoms),
        count if count > MOST_ATOMS => return Err(PdbError::TooManyAtoms(count)),
        _ => {}
    }
    let mut text = String::from("REMARK   Computed by Gridel from bond lengths.\n");
    for (&(object, center), serial) in atoms.iter().zip(1..) {
        let mut position = String::new();
        for value in center.to_array() {
            let field = format!("{value:8.3}");
            if field.len() > 8 {
                return Err(PdbError::TooFar {
                    name: object.name.clone(),
                    value,
                });
            }
            position += &field;
        }
        let symbol = scene.materials[object.material].name.to_ascii_uppercase();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "HETATM{serial:>5} {symbol:>2}   UNK A   1    {position}  1.00  0.00          {symbol:>2}"
        );
    }
    text.push_str("END\n");
    Ok(text)
}
