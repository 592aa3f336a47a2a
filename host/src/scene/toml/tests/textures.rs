//! Colors of vertices, texture coordinates and textures.

use super::*;
use crate::scene::image::tests::png_of;
use crate::scene::{Material, Wrap};
use glam::DVec2;

const SQUARE: &str = "[[object]]\nkind = 'mesh'\nmaterial = 'm'\n\
    vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]\nfaces = [[0, 1, 2, 3]]\n";

/// Reads a scene in a folder with an image of two by one pixels.
fn beside_image(text: &str) -> Result<Imported, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let pixels = [[255, 0, 0, 255], [0, 0, 255, 9]];
    std::fs::write(folder.path().join("two.png"), png_of(2, 1, &pixels)).unwrap();
    load_in(folder.path(), text)
}

fn material(keys: &str) -> Material {
    let text = format!("[material.m]\n{keys}\n{SQUARE}");
    let imported = beside_image(&text);
    let imported = imported.unwrap_or_else(|error| panic!("{error}; {}", error.remedy));
    imported.scene.materials[0].clone()
}

fn rejected(keys: &str) -> String {
    let error = beside_image(&format!("[material.m]\n{keys}\n{SQUARE}")).unwrap_err();
    assert!(!error.remedy.is_empty());
    error.to_string()
}

#[test]
fn colors_and_coordinates_belong_to_vertices() {
    let colors = "colors = ['#ff0000', 0.5, [0, 1, 0.25], 1]\n";
    let coordinates = "coordinates = [[0, 1], [2, 1], [2, -1.5], [0, 0]]\n";
    let scene = scene(&format!("[material.m]\n{SQUARE}{colors}{coordinates}"));
    let attributes = &scene.objects[0].attributes;
    let expected = [[1.0, 0.0, 0.0], [0.5; 3], [0.0, 1.0, 0.25], [1.0; 3]];
    assert_eq!(attributes.colors, expected);
    assert_eq!(attributes.coordinates[2], DVec2::new(2.0, -1.5));
    let Shape::Mesh { triangles, .. } = &scene.objects[0].shape else {
        panic!("a mesh");
    };
    assert_eq!(attributes.triangles, *triangles);
    for (keys, expected) in [
        ("colors = [0, 1]\n", "there are 2 colors and 4 vertices"),
        ("colors = [0, 1, 2, 0]\n", "at most 1"),
        (
            "coordinates = [[0, 0]]\n",
            "there are 1 texture coordinates and 4 vertices",
        ),
        ("coordinates = [[0, 0, 0], 1, 1, 1]\n", "two numbers"),
    ] {
        let error = rejection(&format!("[material.m]\n{SQUARE}{keys}")).to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert!(
        rejection("[[object]]\nkind = 'sphere'\ncolors = []")
            .to_string()
            .contains("colors")
    );
}

#[test]
fn mirrored_meshes_keep_colors_and_coordinates_at_their_corners() {
    let keys = "colors = [0, 0.25, 0.5, 1]\ncoordinates = [[0, 0], [1, 0], [1, 1], [0, 1]]\n\
        scale = [-1, 1, 1]\n";
    let scene = scene(&format!("[material.m]\n{SQUARE}{keys}"));
    let object = &scene.objects[0];
    let Shape::Mesh {
        vertices,
        triangles,
    } = &object.shape
    else {
        panic!("a mesh");
    };
    let attributes = &object.attributes;
    for (corners, named) in triangles.iter().zip(&attributes.triangles) {
        for (corner, coordinate) in corners.iter().zip(named) {
            let place = vertices[*corner as usize];
            let found = attributes.coordinates[*coordinate as usize];
            assert_eq!(found, DVec2::new(-place.x, place.y));
        }
    }
    assert_eq!(attributes.colors[1], [0.25; 3]);
}

#[test]
fn textures_have_options() {
    let plain = material("texture = 'two.png'").texture.unwrap();
    assert_eq!(plain.image.size(), [2, 1]);
    assert_eq!((plain.wrap, plain.bilinear), ([Wrap::Repeat; 2], true));
    let all = "texture = { file = 'two.png', filter = 'nearest', wrap = 'mirror', scale = [2, 3], \
        rotation = 90, offset = [0.5, 0.25] }";
    let texture = material(all).texture.unwrap();
    assert_eq!((texture.wrap, texture.bilinear), ([Wrap::Mirror; 2], false));
    let found = texture.transform.transform_point2(DVec2::new(1.0, 1.0));
    assert!((found - DVec2::new(3.5, -1.75)).length() < 1e-12, "{found}");
    let clamped = material("texture = { file = 'two.png', wrap = 'clamp', scale = 4 }");
    let texture = clamped.texture.unwrap();
    assert_eq!(texture.wrap, [Wrap::Clamp; 2]);
    assert_eq!(
        texture.transform.transform_point2(DVec2::ONE),
        DVec2::splat(4.0)
    );
}

#[test]
fn normal_maps_lie_as_the_texture_does() {
    let map = |keys: &str| material(keys).normal_map.unwrap();
    let plain = map("normal_map = 'two.png'");
    assert_eq!((plain.scale, plain.texture.bilinear), (1.0, true));
    let turned = "texture = { file = 'two.png', rotation = 30 }\nnormal_map = 'two.png'";
    assert_eq!(
        map(turned).texture.transform,
        material(turned).texture.unwrap().transform
    );
    let own =
        map("normal_map = { file = 'two.png', scale = 2, filter = 'nearest' }\nnormal_scale = 0.5");
    assert_eq!((own.scale, own.texture.bilinear), (0.5, false));
    let found = own.texture.transform.transform_point2(DVec2::ONE);
    assert_eq!(found, DVec2::splat(2.0));
    for (keys, expected) in [
        ("normal_scale = 1", "needs `normal_map`"),
        ("normal_map = 'two.png'\nnormal_scale = -1", "0 to 16"),
        ("normal_map = 'none.png'", "none.png"),
        (
            "texture = 'two.png'\nnormal_map = { file = 'two.png', scale = 2 }",
            "does not lie as the texture does",
        ),
    ] {
        let error = rejected(keys);
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn textures_that_cannot_be_read_are_rejected_with_their_place() {
    for (keys, expected) in [
        ("texture = 'none.png'", "none.png"),
        ("texture = '../two.png'", "outside of the scene's folder"),
        ("texture = 'scene.toml'", "is neither PNG nor JPEG"),
        ("texture = ''", "texture"),
        ("texture = { filter = 'nearest' }", "file"),
        ("texture = { file = 'two.png', filter = 'cubic' }", "cubic"),
        ("texture = { file = 'two.png', wrap = 'border' }", "border"),
        ("texture = { file = 'two.png', unknown = 1 }", "unknown"),
        ("texture = { file = 'two.png', offset = 1 }", "two numbers"),
    ] {
        let error = rejected(keys);
        assert!(error.contains("scene.toml:2"), "{error}");
        assert!(error.contains(expected), "{error}");
    }
}
