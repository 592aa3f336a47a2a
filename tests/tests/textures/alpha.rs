//! Alpha of textures.

use super::*;

/// A square of this alpha everywhere, under no light, before a wall that is as white as its ambient light.
pub(super) fn before_a_wall(pixel: [u8; 4], alpha: Alpha) -> scene::Scene {
    let mut scene = textured(Wrap::Repeat, true);
    let image = Image::new("one", 1, 1, vec![pixel]).expect("a pixel");
    scene.materials[0].texture = Some(Texture::of(image.into()));
    scene.materials[0].alpha = Some(alpha);
    let wall = Shape::Disc(Disc {
        center: DVec3::NEG_Z,
        normal: DVec3::Z,
        radius: 40.0,
    });
    let mut wall = scenes::of([wall]);
    wall.objects[0].material = 1;
    scene.objects.extend(wall.objects);
    scene.materials.push(Material {
        diffuse: Diffuse::Plain([0.5, 0.25, 1.0]),
        ..Material::default()
    });
    scene
}

fn ambient(scene: &scene::Scene, format: Format) -> [f32; 3] {
    let blob = blob_of(scene);
    let scene = blob.scene().expect("valid");
    let job = Job::whole(format, Structure::DualSplit, settings(&scene));
    let picture = render_linear(&scene, &job, &|| ()).expect("a picture");
    // Not on the edge between both triangles.
    picture.pixels[35 * 90 + 50]
}

#[test]
fn alpha_blends_with_what_is_behind() {
    for format in Format::ALL {
        for (alpha, factor) in [(255, 1.0), (128, 1.0), (128, 0.5), (0, 1.0), (255, 0.0)] {
            let scene = before_a_wall([255, 255, 0, alpha], Alpha::Blend(factor));
            let there = f64::from(alpha) / 255.0 * factor;
            let expected = [[1.0, 0.5], [1.0, 0.25], [0.0, 1.0]]
                .map(|[front, back]| front * there + back * (1.0 - there));
            assert_near(ambient(&scene, format), expected, 0.003, format.name());
        }
    }
}

#[test]
fn textures_are_cut_out_where_alpha_is_below_the_cutoff() {
    for format in Format::ALL {
        for (alpha, cutoff, is_there) in [
            (127, 0.5, false),
            (128, 0.5, true),
            (255, 1.0, true),
            (254, 1.0, false),
            (1, 0.002, true),
            (0, 0.002, false),
        ] {
            let scene = before_a_wall([255, 255, 0, alpha], Alpha::CutOut(cutoff));
            let expected = if is_there {
                [1.0, 1.0, 0.0]
            } else {
                [0.5, 0.25, 1.0]
            };
            let what = format!("{alpha} {cutoff} {}", format.name());
            assert_near(ambient(&scene, format), expected, 0.001, &what);
        }
    }
}

#[test]
fn light_shines_through_what_is_cut_out() {
    for format in Format::ALL {
        for (alpha, lit) in [
            (Alpha::CutOut(0.5), 1.0),
            (Alpha::Blend(1.0), 155.0 / 255.0),
        ] {
            let mut scene = before_a_wall([255, 255, 0, 100], alpha);
            scene.ambient = [0.0; 3];
            scene.lights = vec![Light::Directional {
                direction: DVec3::new(1.0, 0.0, -1.0),
                color: [1.0; 3],
            }];
            // The light comes through the square from the left, and falls on the wall next to it.
            let blob = blob_of(&scene);
            let view = blob.scene().expect("valid");
            let job = Job::whole(format, Structure::DualSplit, settings(&view));
            let picture = render_linear(&view, &job, &|| ()).expect("a picture");
            let found = picture.pixels[35 * 90 + 86];
            let expected = [0.5, 0.25, 1.0].map(|it| it * lit * 0.5_f64.sqrt());
            assert_near(found, expected, 0.004, format.name());
        }
    }
}

/// A color that is not visible does not show where visible and invisible texels are mixed.
#[test]
fn edges_of_alpha_have_the_color_of_what_is_visible() {
    let mut scene = before_a_wall([255; 4], Alpha::Blend(1.0));
    let pixels = (0..64).map(|it| match it % 8 < 4 {
        true => [255, 255, 0, 255],
        false => [0, 0, 0, 0],
    });
    let image = Image::new("half", 8, 8, pixels.collect()).expect("as many pixels");
    scene.materials[0].texture = Some(Texture::of(image.into()));
    // A wall of the same color: nothing else can be seen.
    scene.materials[1].diffuse = Diffuse::Plain([1.0, 1.0, 0.0]);
    let blob = blob_of(&scene);
    let view = blob.scene().expect("valid");
    for format in Format::ALL {
        let job = Job::whole(format, Structure::DualSplit, settings(&view));
        let picture = render_linear(&view, &job, &|| ()).expect("a picture");
        for found in picture.pixels {
            assert_near(found, [1.0, 1.0, 0.0], 0.001, format.name());
        }
    }
}

#[test]
fn surfaces_that_alpha_hides_cast_no_shadow_rays() {
    let mut scene = before_a_wall([255, 255, 0, 0], Alpha::CutOut(0.5));
    scene.objects.truncate(1);
    let light = Light::Directional {
        direction: DVec3::NEG_Z,
        color: [1.0; 3],
    };
    scene.lights = vec![light; 3];
    let shadow_rays = |scene: &scene::Scene, format: Format| {
        let blob = blob_of(scene);
        let view = blob.scene().expect("valid");
        let job = Job {
            count: true,
            ..Job::whole(format, Structure::DualSplit, settings(&view))
        };
        let picture = render(&view, &job, &|| ()).expect("a picture");
        picture.counters.expect("counted").shadow
    };
    for format in Format::ALL {
        assert_eq!(shadow_rays(&scene, format), 0);
        let mut visible = scene.clone();
        visible.materials[0].alpha = None;
        let all = shadow_rays(&visible, format);
        assert!(all > 0);
        // One of three lights is turned off.
        visible.lights[1] = Light::Directional {
            direction: DVec3::NEG_Z,
            color: [0.0; 3],
        };
        assert_eq!(shadow_rays(&visible, format), all / 3 * 2);
    }
}

#[test]
fn albedo_is_the_color_of_what_alpha_hides() {
    for (alpha, of) in [(128, Alpha::Blend(1.0)), (127, Alpha::CutOut(0.5))] {
        let blob = blob_of(&before_a_wall([255, 255, 0, alpha], of));
        let scene = blob.scene().expect("valid");
        for format in Format::ALL {
            let found = albedo(&scene, format)[35 * 90 + 50];
            assert_near(found, [1.0, 1.0, 0.0], 0.001, format.name());
        }
    }
}
