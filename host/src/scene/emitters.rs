//! Objects that glow as lights, and lights that are visible as objects.

use super::attributes::Attributes;
use super::light_form::{LightForm, LightShape};
use super::model::{Color, Diffuse, Light, Material, Object, Scene};
use super::{Normals, Shape, SourceSpan};
use glam::DVec3;
use std::borrow::Cow;

/// The most faces of an object that glows for each of them to be a light.
pub const MOST_FACES: usize = 32;

const BLACK: Color = [0.0; 3];

impl Scene {
    /// Returns the scene with a light for each sphere, disc, face of a box and triangle of a mesh that glows. A
    /// material can state that it does not light others; it gets no light. Each light that is visible gets an object.
    /// Two triangles that form a parallelogram are one light. Lights and objects are appended once: a second call
    /// changes nothing.
    ///
    /// ```
    /// # let file = "[material.lamp]\nemission = 5\n\
    /// #     [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'lamp'";
    /// # let imported = gridel_host::scene::read("lamp.toml".as_ref(), file.into(), &Default::default())?;
    /// // Readers of scene files have done it.
    /// assert_eq!(imported.scene.lights.len(), 1);
    /// assert_eq!(*imported.scene.with_emitters(), imported.scene);
    /// # Ok::<(), gridel_host::scene::SceneError>(())
    /// ```
    pub fn with_emitters(&self) -> Cow<'_, Self> {
        let is_visible = |form: &Option<LightForm>| form.is_some_and(|form| form.is_visible);
        let glows = self.materials.iter().any(Material::lights_others);
        if !glows && !self.light_forms.iter().any(is_visible) {
            return Cow::Borrowed(self);
        }
        let mut scene = self.clone();
        scene.light_emitters();
        scene.show_lights();
        Cow::Owned(scene)
    }

    fn light_emitters(&mut self) {
        let mut lit = Vec::new();
        for number in 0..self.objects.len() {
            let object = &self.objects[number];
            let material = &self.materials[object.material];
            if !material.has_lights() {
                continue;
            }
            let color = material.emission;
            let named = (object.name.clone(), object.place.clone());
            let faces = faces(&object.shape);
            if !faces.is_empty() {
                lit.push(number);
            }
            for (position, shape) in faces {
                let form = LightForm {
                    shape,
                    is_surface: true,
                    ..LightForm::default()
                };
                self.add_light(Light::Point { position, color }, form, named.clone());
            }
        }
        self.mark_sampled(&lit);
        for material in &mut self.materials {
            material.lights = false;
        }
    }

    /// Marks the material of objects that have lights; where others without have it, too, a copy of it.
    fn mark_sampled(&mut self, lit: &[usize]) {
        let mut marked = vec![None; self.materials.len()];
        // Objects of each material without lights.
        let mut without = vec![0_i64; self.materials.len()];
        self.all_objects()
            .for_each(|object| without[object.material] += 1);
        lit.iter()
            .for_each(|&number| without[self.objects[number].material] -= 1);
        for &number in lit {
            let material = self.objects[number].material;
            let to = *marked[material].get_or_insert_with(|| {
                if without[material] == 0 {
                    return material;
                }
                self.materials.push(self.materials[material].clone());
                self.materials.len() - 1
            });
            self.materials[to].is_sampled = true;
            self.objects[number].material = to;
        }
    }

    fn add_light(&mut self, light: Light, form: LightForm, (name, place): (String, SourceSpan)) {
        let places = &mut self.places.lights;
        places.resize(self.lights.len(), SourceSpan::default());
        places.push(place);
        self.light_names.resize(self.lights.len(), String::new());
        self.light_forms.resize(self.lights.len(), None);
        self.lights.push(light);
        self.light_names.push(name);
        self.light_forms.push(Some(form));
    }

    fn show_lights(&mut self) {
        for number in 0..self.lights.len() {
            let shown = self.light_object(number);
            if let Some(form) = self.light_forms.get_mut(number).and_then(Option::as_mut) {
                form.is_visible = false;
                form.is_surface |= shown.is_some();
            }
            if let Some((object, material)) = shown {
                self.objects.push(object);
                self.materials.push(Material {
                    lights: false,
                    is_sampled: true,
                    ..material
                });
            }
        }
    }

    /// Returns the object of a light that is visible, and its material, the next one.
    fn light_object(&self, number: usize) -> Option<(Object, Material)> {
        let form = self.light_forms.get(number).copied().flatten();
        let form = form.filter(|form| form.is_visible)?;
        let Light::Point { position, color } = self.lights[number] else {
            return None;
        };
        let shape = visible_shape(position, &form.shape)?;
        let name = match self.light_names.get(number) {
            Some(name) if !name.is_empty() => name.clone(),
            _ => format!("light {number}"),
        };
        let object = Object {
            name: name.clone(),
            material: self.materials.len(),
            shape,
            normals: Normals::default(),
            attributes: Attributes::default(),
            place: self.places.light(number),
        };
        let material = Material {
            place: self.places.light(number),
            name,
            diffuse: Diffuse::Plain(BLACK),
            emission: color,
            ..Material::default()
        };
        Some((object, material))
    }

    /// Returns a scene whose visible lights are objects that glow, and light others as such; `None` without such lights.
    pub(super) fn with_light_objects(&self) -> Option<Self> {
        let mut scene: Option<Self> = None;
        for number in 0..self.lights.len() {
            if let Some((object, material)) = scene.as_ref().unwrap_or(self).light_object(number) {
                let scene = scene.get_or_insert_with(|| self.clone());
                scene.objects.push(object);
                scene.materials.push(material);
            }
        }
        scene
    }

    /// Returns the object with the surface of a light.
    pub(crate) fn object_of_light(&self, number: usize) -> Option<usize> {
        let form = self.light_forms.get(number).copied().flatten()?;
        let Light::Point { position, .. } = *self.lights.get(number)? else {
            return None;
        };
        let shape = visible_shape(position, &form.shape).filter(|_| form.is_surface)?;
        let mut objects = self.objects.iter();
        objects.position(|it| it.shape == shape && self.materials[it.material].is_sampled)
    }

    /// Replaces a light. The object that shows it moves with it, and changes its radiance.
    ///
    /// # Errors
    /// If the light is one of several faces of an object, which cannot change alone: the cause.
    ///
    /// # Panics
    /// If there is no such light.
    ///
    /// ```
    /// # let file = "[[light]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nradiance = 1\nvisible = true";
    /// # let imported = gridel_host::scene::read("lamp.toml".as_ref(), file.into(), &Default::default())?;
    /// use glam::DVec3;
    /// use gridel_host::scene::{Light, Shape};
    ///
    /// let mut scene = imported.scene;
    /// let (position, color) = (DVec3::Y, [2.0; 3]);
    /// scene.replace_light(0, Light::Point { position, color })?;
    /// assert!(matches!(&scene.objects[0].shape, Shape::Sphere(it) if it.center == position));
    /// assert_eq!(scene.materials[scene.objects[0].material].emission, color);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn replace_light(&mut self, number: usize, to: Light) -> Result<(), String> {
        let form = self.light_forms.get(number).copied().flatten();
        let form = form.filter(|form| form.is_surface && self.lights[number] != to);
        let object = self.object_of_light(number);
        let before = std::mem::replace(&mut self.lights[number], to);
        let Some(form) = form else {
            return Ok(());
        };
        let (Some(object), Light::Point { color: old, .. }, Light::Point { position, color }) =
            (object, before, to)
        else {
            self.lights[number] = before;
            return Err(format!(
                "light {number} is a face of an object that glows, and cannot change without it"
            ));
        };
        if let Some(shape) = visible_shape(position, &form.shape) {
            self.objects[object].shape = shape;
        }
        let material = self.objects[object].material;
        if old != color && self.materials[material].emission == old {
            let users = self.all_objects().filter(|it| it.material == material);
            if users.count() > 1 {
                self.objects[object].material = self.materials.len();
                self.materials.push(self.materials[material].clone());
            }
            self.materials[self.objects[object].material].emission = color;
        }
        Ok(())
    }

    /// Objects that glow and do not light others, though they should: those of parts, and those with shapes that no
    /// light has, with too many faces, or with alpha.
    pub fn emitters_without_light(&self) -> impl Iterator<Item = &Object> {
        let lights = |object: &&Object| self.materials[object.material].lights_others();
        let own = self.objects.iter();
        let own = own.filter(|object| {
            let has_lights = self.materials[object.material].has_lights();
            !has_lights || faces(&object.shape).is_empty()
        });
        let in_parts = self.parts.iter().flat_map(|part| &part.objects);
        own.chain(in_parts).filter(lights)
    }
}

impl Material {
    /// Returns true if lights are to replace its objects. Lights are neither cut out nor blended as objects are.
    fn lights_others(&self) -> bool {
        self.lights && self.emission != BLACK
    }

    fn has_lights(&self) -> bool {
        self.lights_others() && self.alpha.is_none()
    }
}

/// The positions and shapes of the lights of an object; none for one that is no light.
fn faces(shape: &Shape) -> Vec<(DVec3, LightShape)> {
    match shape {
        Shape::Sphere(sphere) => {
            let radius = sphere.radius;
            vec![(sphere.center, LightShape::Sphere { radius })]
        }
        Shape::Disc(disc) => {
            let (normal, radius) = (disc.normal, disc.radius);
            vec![(disc.center, LightShape::Disc { normal, radius })]
        }
        Shape::Box(cuboid) => {
            let (low, high) = (cuboid.min, cuboid.max);
            let side = high - low;
            let mut faces = Vec::new();
            for axis in 0..3 {
                let [first, second] = [(axis + 1) % 3, (axis + 2) % 3].map(|it| {
                    let mut edge = DVec3::ZERO;
                    edge[it] = side[it];
                    edge
                });
                let mut above = low;
                above[axis] = high[axis];
                // A flat box has four sides without area.
                if first.cross(second) == DVec3::ZERO {
                    continue;
                }
                for (corner, edges) in [(low, [second, first]), (above, [first, second])] {
                    faces.push((corner, LightShape::Rectangle { edges }));
                }
            }
            faces
        }
        Shape::Mesh {
            vertices,
            triangles,
        } if triangles.len() <= MOST_FACES => of_mesh(vertices, triangles),
        _ => Vec::new(),
    }
}

fn of_mesh(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Vec<(DVec3, LightShape)> {
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| vertices[corner as usize]);
    let mut faces = Vec::new();
    let mut rest = triangles.iter().map(corners).peekable();
    while let Some(face) = rest.next() {
        let other = rest.peek().and_then(|next| parallelogram(face, *next));
        if let Some(face) = other {
            rest.next();
            faces.push(face);
            continue;
        }
        let [a, b, c] = face;
        let edges = [b - a, c - a];
        if edges[0].cross(edges[1]) != DVec3::ZERO {
            faces.push((a, LightShape::Triangle { edges }));
        }
    }
    faces
}

/// The parallelogram of two triangles with a common edge.
fn parallelogram(first: [DVec3; 3], second: [DVec3; 3]) -> Option<(DVec3, LightShape)> {
    // The corner of the first that the second lacks, and the other way round.
    let lone = (0..3).find(|&it| !second.contains(&first[it]))?;
    let [a, b, c] = [first[lone], first[(lone + 1) % 3], first[(lone + 2) % 3]];
    let far = second.into_iter().find(|it| !first.contains(it))?;
    let shares = second.contains(&b) && second.contains(&c);
    let edges = [b - a, c - a];
    let across = edges[0].cross(edges[1]);
    let own = (second[1] - second[0]).cross(second[2] - second[0]);
    let size = edges[0].abs().max(edges[1].abs()).max_element();
    let is_fourth = (far - (b + edges[1])).abs().max_element() <= 1e-9 * size;
    let is_one = shares && is_fourth && across != DVec3::ZERO && across.dot(own) > 0.0;
    is_one.then_some((a, LightShape::Rectangle { edges }))
}

/// Returns the visible shape of a light with an area.
fn visible_shape(position: DVec3, shape: &LightShape) -> Option<Shape> {
    let mesh = |vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>| Shape::Mesh {
        vertices,
        triangles,
    };
    Some(match *shape {
        LightShape::Point | LightShape::Facet { .. } => return None,
        LightShape::Sphere { radius } => Shape::Sphere(crate::shape::Sphere {
            center: position,
            radius,
        }),
        LightShape::Disc { normal, radius } => Shape::Disc(crate::shape::Disc {
            center: position,
            normal,
            radius,
        }),
        LightShape::Rectangle { edges: [a, b] } => mesh(
            vec![position, position + a, position + a + b, position + b],
            vec![[0, 1, 2], [0, 2, 3]],
        ),
        LightShape::Triangle { edges: [a, b] } => {
            mesh(vec![position, position + a, position + b], vec![[0, 1, 2]])
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::read;

    fn scene(text: &str) -> Scene {
        let imported = read("lamp.toml".as_ref(), text.into(), &Default::default());
        imported.unwrap_or_else(|error| panic!("{error}")).scene
    }

    /// The area of a light, and the sum of the directions to which it shines.
    fn area(scene: &Scene, number: usize) -> (f64, DVec3) {
        let form = scene.light_forms[number].unwrap();
        assert!(form.is_surface && !form.is_visible);
        match form.shape {
            LightShape::Rectangle { edges } => {
                let across = edges[0].cross(edges[1]);
                (across.length(), across)
            }
            LightShape::Triangle { edges } => {
                let across = 0.5 * edges[0].cross(edges[1]);
                (across.length(), across)
            }
            _ => panic!("no flat light"),
        }
    }

    #[test]
    fn objects_with_alpha_glow_and_are_no_lights() {
        let folder = tempfile::tempdir().unwrap();
        let png = crate::scene::image::tests::png_of(1, 1, &[[255, 255, 255, 0]]);
        std::fs::write(folder.path().join("none.png"), png).unwrap();
        let text = "[material.lamp]\nemission = 4\ntexture = 'none.png'\nalpha = 'cutout'\n\
                    [[object]]\nkind = 'mesh'\nvertices = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [[0,1,2]]\n\
                    coordinates = [[0,0],[1,0],[0,1]]\nmaterial = 'lamp'";
        let path = folder.path().join("lamp.toml");
        std::fs::write(&path, text).unwrap();
        let imported = crate::scene::load_with(&path, &Default::default()).unwrap();
        assert_eq!(imported.scene.lights, []);
        assert!(imported.warnings[0].contains("lamp.toml:5: object "));
        assert!(imported.warnings[0].contains("does not light other objects"));
    }

    #[test]
    fn boxes_shine_outwards_from_six_faces() {
        let scene = scene(
            "[material.lamp]\nemission = [4, 3, 2]\n\
             [[object]]\nkind = 'box'\nmin = [0, 0, 0]\nmax = [1, 2, 3]\nmaterial = 'lamp'",
        );
        assert_eq!(scene.lights.len(), 6);
        let areas = (0..6).map(|number| area(&scene, number));
        let (sum, closed) = areas.fold((0.0, DVec3::ZERO), |(sum, all), (area, across)| {
            (sum + area, all + across)
        });
        assert_eq!((sum, closed), (22.0, DVec3::ZERO));
        let middle = DVec3::new(0.5, 1.0, 1.5);
        for number in 0..6 {
            let Light::Point { position, color } = scene.lights[number] else {
                panic!("no light with a position");
            };
            assert_eq!(color, [4.0, 3.0, 2.0]);
            assert!(area(&scene, number).1.dot(position - middle) > 0.0);
        }
    }

    #[test]
    fn flat_boxes_shine_from_two_faces() {
        let scene = scene(
            "[material.lamp]\nemission = 4\n\
             [[object]]\nkind = 'box'\nmin = [0, 1, 0]\nmax = [2, 1, 3]\nmaterial = 'lamp'",
        );
        assert_eq!(scene.lights.len(), 2);
        for number in 0..2 {
            assert_eq!(area(&scene, number).0, 6.0);
        }
    }

    #[test]
    fn objects_that_show_lights_move_and_change_with_them() {
        let mut scene = scene(
            "[[light]]\nkind = 'sphere'\ncenter = [0, 5, 0]\nradius = 1\nradiance = 3\nvisible = true",
        );
        let (position, color) = (DVec3::new(1.0, 2.0, 3.0), [4.0; 3]);
        let to = Light::Point { position, color };
        scene.replace_light(0, to).unwrap();
        assert_eq!(scene.lights, [to]);
        assert_eq!(scene.objects.len(), 1);
        let lamp = &scene.objects[0];
        assert_eq!(lamp.shape.bounds(), [position - 1.0, position + 1.0]);
        assert_eq!(scene.materials[lamp.material].emission, color);
    }

    #[test]
    fn faces_of_objects_that_glow_do_not_change_alone() {
        let mut scene = scene(
            "[material.lamp]\nemission = 4\n\
             [[object]]\nkind = 'box'\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = 'lamp'",
        );
        let before = scene.clone();
        let (position, color) = (DVec3::ONE, [4.0; 3]);
        let error = scene.replace_light(2, Light::Point { position, color });
        assert!(error.unwrap_err().contains("light 2"));
        assert_eq!(scene, before);
    }

    #[test]
    fn meshes_shine_from_parallelograms_and_triangles() {
        let scene = scene(
            "[material.lamp]\nemission = 4\n\
             [[object]]\nkind = 'mesh'\nvertices = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [9, 9, 9]]\n\
             faces = [[0, 1, 2], [0, 2, 3], [0, 1, 4]]\nmaterial = 'lamp'",
        );
        assert_eq!(scene.lights.len(), 2);
        assert_eq!(area(&scene, 0), (2.0, DVec3::new(0.0, 0.0, 2.0)));
        assert!(matches!(
            scene.light_forms[1].unwrap().shape,
            LightShape::Triangle { .. }
        ));
    }

    #[test]
    fn visible_lights_are_objects_that_light_once() {
        let scene = scene(
            "[[light]]\nkind = 'rectangle'\ncorner = [0, 5, 0]\nedges = [[1, 0, 0], [0, 0, 1]]\nradiance = 3\n\
             visible = true\nname = 'lamp'\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1",
        );
        assert_eq!((scene.lights.len(), scene.objects.len()), (1, 2));
        let lamp = &scene.objects[1];
        assert_eq!(lamp.name, "lamp");
        assert_eq!(scene.materials[lamp.material].emission, [3.0; 3]);
        assert_eq!(*scene.with_emitters(), scene);
    }

    #[test]
    fn materials_may_glow_without_lighting_others() {
        let scene = scene(
            "[material.lamp]\nemission = 4\nlights = false\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'lamp'",
        );
        assert_eq!(scene.lights.len(), 0);
    }
}
