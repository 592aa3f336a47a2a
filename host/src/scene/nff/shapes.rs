//! The objects of an NFF file.

use super::Importer;
use super::reader::{Line, Lines};
use crate::scene::polygon;
use crate::scene::size::Size;
use crate::scene::{Attributes, CauseAndRemedy, Material, Normals, Object, SceneError, Shape};
use crate::shape::{Cone, Sphere};
use crate::table::shortened;
use glam::DVec3;

impl<'a> Importer<'a> {
    pub(super) fn sphere(&mut self, line: &Line<'a>) -> Result<(), SceneError> {
        let [x, y, z, radius] =
            line.numbers::<4>(self.source, &mut self.warnings, 1, "s x y z radius")?;
        if radius == 0.0 {
            return Err(self.source.error_at(
                line.text,
                "the radius of a sphere is 0",
                "write a radius above 0",
            ));
        }
        self.add(
            "sphere",
            line,
            Shape::Sphere(Sphere {
                center: DVec3::new(x, y, z),
                radius: radius.abs(),
            }),
        )
    }

    pub(super) fn cone(
        &mut self,
        line: &Line<'a>,
        lines: &mut Lines<'a>,
    ) -> Result<(), SceneError> {
        // The text of the format shows three lines; the programs of the databases write one.
        let [bx, by, bz, base_radius, ax, ay, az, apex_radius] = if line.words.len() > 1 {
            line.numbers::<8>(
                self.source,
                &mut self.warnings,
                1,
                "c x y z radius x y z radius",
            )?
        } else {
            let mut numbers = [0.0; 8];
            for (end, name) in numbers.chunks_exact_mut(4).zip(["base", "apex"]) {
                let given = lines.next().ok_or_else(|| {
                    self.source.error_at(
                        line.text,
                        format!("the file ends before the {name} of this cone"),
                        "write two lines `x y z radius` after `c`",
                    )
                })?;
                end.copy_from_slice(&given.numbers::<4>(
                    self.source,
                    &mut self.warnings,
                    0,
                    "x y z radius",
                )?);
            }
            numbers
        };
        let (base, apex) = (DVec3::new(bx, by, bz), DVec3::new(ax, ay, az));
        let fault = if base == apex {
            Some((
                "the base and the apex of a cone are the same point",
                "move them apart",
            ))
        } else if base_radius == 0.0 && apex_radius == 0.0 {
            Some((
                "both radii of a cone are 0",
                "write at least one radius above 0",
            ))
        } else if base_radius * apex_radius < 0.0 {
            Some((
                "one radius of a cone is negative and one is not",
                "give both radii the same sign",
            ))
        } else {
            None
        };
        if let Some((cause, remedy)) = fault {
            return Err(self.source.error_at(line.text, cause, remedy));
        }
        let (base_radius, apex_radius) = (base_radius.abs(), apex_radius.abs());
        self.add(
            "cone",
            line,
            Shape::Cone(Cone {
                base,
                base_radius,
                apex,
                apex_radius,
            }),
        )
    }

    /// Reads `p` (three numbers per vertex) and `pp` (six).
    pub(super) fn polygon(
        &mut self,
        line: &Line<'a>,
        lines: &mut Lines<'a>,
        numbers: usize,
    ) -> Result<(), SceneError> {
        let count = line.word(1);
        let count: usize = count.parse().map_err(|_| {
            self.source.error_at(
                if count.is_empty() { line.text } else { count },
                format!(
                    "the vertex count of a polygon is {count:?}",
                    count = shortened(count)
                ),
                "write a whole number from 3 up",
            )
        })?;
        if count < 3 {
            let cause = format!("a polygon of {count} vertices has no surface");
            return Err(self
                .source
                .error_at(line.text, cause, "give it at least 3 vertices"));
        }
        let (vertices, normals) = self.corners(line, lines, count, numbers)?;
        let (triangles, crosses) =
            polygon::cut("polygon", &vertices).map_err(|CauseAndRemedy { cause, remedy }| {
                self.source.error_at(line.text, cause, remedy)
            })?;
        if let Some(sentence) = crosses {
            self.warnings.add(self.source, line.number, sentence);
        }
        if numbers == 6 && normals.len() < vertices.len() {
            let sentence = "a vertex of `pp` has no normal; its polygon is shaded flat";
            self.warnings.add(self.source, line.number, sentence);
        }
        let normals = match normals.len() == vertices.len() {
            true => Normals::given(normals, triangles.clone(), (&vertices, &triangles)),
            false => Normals::default(),
        };
        let shape = Shape::Mesh {
            vertices,
            triangles,
        };
        self.add("polygon", line, shape)?;
        if let Some(object) = self.scene.objects.last_mut() {
            object.normals = normals;
        }
        Ok(())
    }

    /// Reads the vertices of a polygon, and the normals of those that have one.
    fn corners(
        &mut self,
        line: &Line<'a>,
        lines: &mut Lines<'a>,
        count: usize,
        numbers: usize,
    ) -> Result<(Vec<DVec3>, Vec<DVec3>), SceneError> {
        // Nothing is reserved for the count before its lines are there: it may be a lie.
        let (mut vertices, mut normals) = (Vec::new(), Vec::new());
        while vertices.len() < count {
            let Some(given) = lines.next() else {
                return Err(self.source.error_at(
                    line.text,
                    format!(
                        "the file ends after {} of the {count} vertices of this polygon",
                        vertices.len()
                    ),
                    "add the missing vertices or correct the count",
                ));
            };
            if given.numbers_from(0) == 0 {
                return Err(self.source.error_at(
                    given.text,
                    format!(
                        "{:?} stands where vertex {} of {count} is due",
                        shortened(given.word(0)),
                        vertices.len() + 1
                    ),
                    "add the missing vertices or correct the count",
                ));
            }
            let [x, y, z] = if numbers == 6 && given.numbers_from(0) >= 6 {
                let [x, y, z, nx, ny, nz] =
                    given.numbers::<6>(self.source, &mut self.warnings, 0, "x y z nx ny nz")?;
                if [nx, ny, nz] == [0.0; 3] {
                    let sentence = "a normal is 0 0 0; its polygon is shaded flat";
                    self.warnings.add(self.source, given.number, sentence);
                }
                normals.push(DVec3::new(nx, ny, nz));
                [x, y, z]
            } else {
                given.numbers::<3>(self.source, &mut self.warnings, 0, "x y z")?
            };
            vertices.push(DVec3::new(x, y, z));
            self.reject_excess(
                &given,
                Size {
                    objects: 1,
                    names: 0,
                    triangles: vertices.len() as u64,
                },
            )?;
        }
        Ok((vertices, normals))
    }

    /// Rejects an object of this size if it no longer fits into memory.
    fn reject_excess(&self, line: &Line<'a>, size: Size) -> Result<(), SceneError> {
        let Some(excess) = self.size.plus(size).excess() else {
            return Ok(());
        };
        let cause = format!("up to this object the file takes {excess}");
        let remedy = "leave objects out, or use larger ones";
        Err(self.source.error_at(line.text, cause, remedy))
    }

    fn add(&mut self, kind: &str, line: &Line<'a>, shape: Shape) -> Result<(), SceneError> {
        let material = self.material.unwrap_or_else(|| {
            self.warnings.add(
                self.source,
                line.number,
                "an object before the first `f` line has the default material",
            );
            self.scene.materials.push(Material::default());
            self.scene.materials.len() - 1
        });
        self.material = Some(material);
        let count = match shape {
            Shape::Sphere(Sphere { .. }) => &mut self.counts[0],
            Shape::Cone(Cone { .. }) => &mut self.counts[1],
            _ => &mut self.counts[2],
        };
        *count += 1;
        let name = format!("{kind} {count}");
        let attributes = Attributes::default();
        let size = Size::of(&shape, name.len(), &attributes);
        self.reject_excess(line, size)?;
        self.size = self.size.plus(size);
        self.scene.objects.push(Object {
            name,
            material,
            shape,
            place: self.source.place(line.number),
            normals: Normals::default(),
            attributes,
        });
        Ok(())
    }
}
