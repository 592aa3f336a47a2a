//! The view, lights, materials, primitives and objects.

use super::{Errors, Forgery, alone, everything};
use gridel_core::Structure;
use gridel_core::format::environment::Environment;
use gridel_core::format::lens::Lens;
use gridel_core::format::light_form::LightForm;
use gridel_core::format::record::{
    Emission, Light, Material, Sphere24, SurfaceMaps, Texture, Vertex24, View,
};
use gridel_core::format::{BlobError, Effects, Field, Reason, SectionKind};
use gridel_core::geometry::cone::Cone;
use gridel_core::geometry::cuboid::Cuboid;
use gridel_core::geometry::disc::Disc;
use gridel_core::geometry::plane::Plane;
use gridel_core::geometry::torus::Torus;

pub(super) fn shading_data() -> Errors {
    let mut errors = everything();
    let far = (1 << 50) + 1;
    let view = "section view";
    let fields: [Forgery<View>; 12] = [
        (Field::Eye, &|it| it.eye[1] = far),
        (Field::Eye, &|it| it.eye[1] = -far),
        (Field::CameraVector, &|it| it.up[2] = i32::MAX),
        (Field::Background, &|it| it.background[0] = -1),
        (Field::AmbientLight, &|it| it.ambient[0] = -1),
        (Field::Cutoff, &|it| it.cutoff = -1),
        (Field::Width, &|it| it.width = 0),
        (Field::Height, &|it| it.height = 0),
        (Field::Samples, &|it| it.samples = 0),
        (Field::Samples, &|it| it.samples = 4097),
        (Field::RayDepth, &|it| it.depth = 33),
        (Field::Encoding, &|it| it.encoding = 4),
    ];
    for (field, forge) in fields {
        errors.field(view, field, |it| it.change(SectionKind::View, 0, forge));
    }
    let lights: [Forgery<Light>; 3] = [
        (Field::Kind, &|it| it.kind = 2),
        (Field::Color, &|it| it.color[2] = -1),
        (Field::PositionOrDirection, &|it| it.vector[0] = far),
    ];
    for (field, forge) in lights {
        errors.field("light 0", field, |it| {
            it.change(SectionKind::Lights, 0, forge)
        });
    }
    errors.reason("light 1", Reason::ZeroDirection, |it| {
        it.change(SectionKind::Lights, 1, |it: &mut Light| it.vector = [0; 3])
    });
    let above = (1 << 30) + 1;
    let materials: [Forgery<Material>; 10] = [
        (Field::Diffuse, &|it| it.diffuse[0] = above),
        (Field::Odd, &|it| it.odd[1] = -1),
        (Field::Highlight, &|it| it.highlight[2] = above),
        (Field::Mirror, &|it| it.mirror[0] = above),
        (Field::Transmittance, &|it| it.transmit[0] = above),
        (Field::InverseIor, &|it| it.inverse_ior = above),
        (Field::Shininess, &|it| it.shininess = 0),
        // The lower 12 bits alone are the exponent.
        (Field::Shininess, &|it| it.shininess = 1025 | 3 << 12),
        (Field::CheckerSize, &|it| it.checker_size = -1),
        (Field::CheckerOrigin, &|it| it.checker_origin[0] = above),
    ];
    for (field, forge) in materials {
        errors.field("material 1", field, |it| {
            it.change(SectionKind::Materials, 1, forge)
        });
    }
    errors.reason("material 0", Reason::MissingEffect, |it| {
        it.header().effects &= !Effects::MIRROR.0
    });
    errors
}

/// Lights with forms.
pub(super) fn light_forms() -> Errors {
    let text = "[[light]]\nkind = 'disc'\ncenter = [0, 9, 0]\nnormal = [0, -1, 0]\nradius = 1\nradiance = 1\n\
                [material.default]\nemission = 0.1\nlights = false\n\
                [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1";
    let imported =
        gridel_host::scene::read("lights.toml".as_ref(), text.into(), &Default::default());
    let mut errors = alone(&imported.expect("a scene").scene, Structure::List, 24);
    let forms: [Forgery<LightForm>; 7] = [
        (Field::Kind, &|it| it.shape = 5),
        (Field::LightReference, &|it| it.reference = -1),
        (Field::LightRange, &|it| it.range = i32::MIN),
        (Field::ConeCosine, &|it| it.cone_cosine = i32::MAX),
        (Field::LightWidth, &|it| it.width = -1),
        (Field::Normal, &|it| it.normal[1] = i32::MIN),
        (Field::LightEdge, &|it| it.edges[1][2] = i32::MAX),
    ];
    for (field, forge) in forms {
        errors.field("form 0 of lights", field, |it| {
            it.change(SectionKind::LightForms, 0, forge)
        });
    }
    errors.field("light 0", Field::LightForm, |it| {
        it.change(SectionKind::Lights, 0, |it: &mut Light| it.kind = 7)
    });
    let emissions: [Forgery<Emission>; 2] = [
        (Field::Emission, &|it| it.radiance[1] = -1),
        (Field::EmissionLights, &|it| it.lights = 2),
    ];
    for (field, forge) in emissions {
        errors.field("emission 0", field, |it| {
            it.change(SectionKind::Emissions, 0, forge)
        });
    }
    errors.reason("section emissions", Reason::MissingEffect, |it| {
        it.header().effects &= !Effects::EMISSION.0
    });
    errors
}

/// A lens, and bounces of diffuse light.
pub(super) fn lens_and_bounces() -> Errors {
    let text = "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\naperture = 1\n[render]\nbounces = 3\n\
                [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1";
    let imported = gridel_host::scene::read("lens.toml".as_ref(), text.into(), &Default::default());
    let mut errors = alone(&imported.expect("a scene").scene, Structure::List, 24);
    let lenses: [Forgery<Lens>; 3] = [
        (Field::LensRadius, &|it| it.radius = 0),
        (Field::Focus, &|it| it.focus = i64::MAX),
        // From its edge no ray may start.
        (Field::Eye, &|it| it.radius = 1 << 50),
    ];
    for (field, forge) in lenses {
        errors.field("section lens", field, |it| {
            it.change(SectionKind::Lens, 0, forge)
        });
    }
    for bounces in [0, 33] {
        errors.field("section indirect", Field::Bounces, |it| {
            it.change(SectionKind::Indirect, 0, |it: &mut u32| *it = bounces)
        });
    }
    for (section, effect) in [
        ("section lens", Effects::DEPTH_OF_FIELD),
        ("section indirect", Effects::INDIRECT),
    ] {
        errors.reason(section, Reason::MissingEffect, |it| {
            it.header().effects &= !effect.0
        });
    }
    errors
}

/// The light around a scene.
pub(super) fn environments() -> Errors {
    let text = "[environment]\nzenith = 1\nhorizon = 0.5\nground = 0.1\nsize = 16\nsun = { direction = [0, -1, 0] }\n\
                [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1";
    let imported = gridel_host::scene::read("sky.toml".as_ref(), text.into(), &Default::default());
    let mut errors = alone(&imported.expect("a scene").scene, Structure::List, 24);
    let section = "section environment";
    let fields: [Forgery<Environment>; 6] = [
        (Field::EnvironmentSize, &|it| it.size_bits = 3),
        (Field::EnvironmentSize, &|it| it.size_bits = 9),
        (Field::SunDirection, &|it| it.sun_direction[1] = i32::MAX),
        (Field::SunSize, &|it| it.sun_radius = -1),
        (Field::SunSize, &|it| it.sun_radius = i32::MAX),
        (Field::SunRadiance, &|it| it.sun_radiance[0] = -1),
    ];
    for (field, forge) in fields {
        errors.field(section, field, |it| {
            it.change(SectionKind::Environment, 0, forge)
        });
    }
    errors.reason(section, Reason::ZeroDirection, |it| {
        it.change(SectionKind::Environment, 0, |it: &mut Environment| {
            it.sun_direction = [0; 3]
        })
    });
    errors.reason(section, Reason::MissingEffect, |it| {
        it.header().effects &= !Effects::ENVIRONMENT.0
    });
    errors.field("texel 7 of environment", Field::Exponent, |it| {
        it.change(SectionKind::EnvironmentTexels, 7, |it: &mut u32| {
            *it = 23 << 27
        })
    });
    for (row, light, reason) in [(0, 1, Reason::FirstNotZero), (3, 0, Reason::LightOrder)] {
        errors.reason(&format!("row {row} of environment"), reason, |it| {
            it.change(SectionKind::EnvironmentRows, row, |it: &mut u32| {
                *it = light
            })
        });
    }
    for (column, light, reason) in [(16, 1, Reason::FirstNotZero), (20, 0, Reason::LightOrder)] {
        errors.reason(&format!("column {column} of environment"), reason, |it| {
            it.change(SectionKind::EnvironmentColumns, column, |it: &mut u16| {
                *it = light
            })
        });
    }
    // The sun is a light of the scene; without a size it does not exist.
    errors.field("light 1", Field::Kind, |it| {
        it.change(SectionKind::Environment, 0, |it: &mut Environment| {
            it.sun_radius = 0
        })
    });
    errors.field("light 0", Field::Kind, |it| {
        it.change(SectionKind::Lights, 0, |it: &mut Light| it.kind = 8)
    });
    for (kind, expected) in [
        (SectionKind::EnvironmentTexels, 256),
        (SectionKind::EnvironmentRows, 16),
        (SectionKind::EnvironmentColumns, 256),
    ] {
        let error = errors.forged(|it| it.drop_first(kind, 1));
        let found = expected - 1;
        assert_eq!(
            error,
            BlobError::Count {
                section: kind,
                found,
                expected
            }
        );
    }
    let error = errors.forged(|it| it.remove(&[SectionKind::Environment]));
    assert!(
        matches!(
            error,
            BlobError::Count {
                found: 256,
                expected: 0,
                ..
            }
        ),
        "{error}"
    );
    errors
}

/// Rough materials.
pub(super) fn rough() -> Errors {
    let text = "[[light]]\nkind = 'disc'\ncenter = [0, 9, 0]\nnormal = [0, -1, 0]\nradius = 1\nradiance = 1\n\
                [material.default]\nmirror = 0.5\nroughness = 0.5\n\
                [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1";
    let imported =
        gridel_host::scene::read("rough.toml".as_ref(), text.into(), &Default::default());
    let mut errors = alone(&imported.expect("a scene").scene, Structure::List, 24);
    for alpha in [-1, 1, (1 << 30) + 1] {
        errors.field("roughness 0", Field::Roughness, |it| {
            it.change(SectionKind::Roughnesses, 0, |it: &mut i32| *it = alpha)
        });
    }
    errors.field("mark 0 of light-forms", Field::ShownForm, |it| {
        it.change(SectionKind::ShownForms, 0, |it: &mut u8| *it = 2)
    });
    errors.reason("section roughnesses", Reason::MissingEffect, |it| {
        it.header().effects &= !Effects::GLOSSY.0
    });
    errors
}

/// Nested dielectrics.
pub(super) fn media() -> Errors {
    let text = "[material.default]\ntransmit = 1\npriority = 1\n[material.other]\ntransmit = 1\npriority = 2\n\
                [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
                [[object]]\nkind = 'sphere'\ncenter = [0, 1, 0]\nradius = 1\nmaterial = 'other'";
    let imported =
        gridel_host::scene::read("media.toml".as_ref(), text.into(), &Default::default());
    let mut errors = alone(&imported.expect("a scene").scene, Structure::List, 24);
    errors.field("medium 1", Field::Material, |it| {
        it.change(SectionKind::Media, 1, |it: &mut u32| *it = 2)
    });
    errors.reason("medium 1", Reason::RepeatedMedium, |it| {
        it.change(SectionKind::Media, 1, |it: &mut u32| *it = 1)
    });
    errors.reason("medium 0", Reason::OpaqueMedium, |it| {
        it.change(SectionKind::Materials, 1, |it: &mut Material| {
            it.transmit = [0; 3]
        });
    });
    errors.reason("section media", Reason::MissingEffect, |it| {
        it.header().effects &= !Effects::NESTED.0
    });
    errors
}

/// Textures, and what leads to them.
pub(super) fn textures() -> Errors {
    let mut errors = everything();
    errors.field("material 0", Field::Maps, |it| {
        it.change(SectionKind::Materials, 0, |it: &mut Material| it.maps = 2)
    });
    errors.reason("material 0", Reason::MissingMaps, |it| {
        it.change(SectionKind::Materials, 0, |it: &mut Material| {
            it.maps = Material::MAPS_TEXTURE
        })
    });
    errors.field("maps 0", Field::TextureNumber, |it| {
        it.change(SectionKind::SurfaceMaps, 0, |it: &mut SurfaceMaps| {
            it.color = 2
        })
    });
    let fields: [Forgery<Texture>; 8] = [
        (Field::TextureWidth, &|it| it.width = 0),
        (Field::TextureWidth, &|it| it.width = 4097),
        (Field::TextureHeight, &|it| it.height = 0),
        (Field::TextureForm, &|it| it.form = 4),
        (Field::TextureFilter, &|it| it.filter = 4),
        (Field::TextureWrap, &|it| it.wrap[1] = 3),
        (Field::FirstTexel, &|it| it.first = 1),
        (Field::FirstTexel, &|it| it.height += 1),
    ];
    for (field, forge) in fields {
        errors.field("texture 0", field, |it| {
            it.change(SectionKind::Textures, 0, forge)
        });
    }
    for effect in [Effects::VERTEX_COLORS, Effects::TEXTURE, Effects::ALPHA] {
        let place = match effect {
            Effects::VERTEX_COLORS => "section vertex-colors",
            _ => "material 2",
        };
        errors.reason(place, Reason::MissingEffect, |it| {
            it.header().effects &= !effect.0
        });
    }
    errors
}

pub(super) fn primitives() -> Errors {
    let mut errors = everything();
    let far = 1 << 24;
    errors.field("vertex 2", Field::Coordinate, |it| {
        it.change(SectionKind::Vertices, 2, |it: &mut Vertex24| it.0[1] = far)
    });
    errors.field("triangle 1", Field::Vertex, |it| {
        it.change(SectionKind::Triangles, 1, |it: &mut [u16; 3]| {
            it[2] = u16::MAX
        })
    });
    errors.field("sphere 0", Field::Radius, |it| {
        it.change(SectionKind::Spheres, 0, |it: &mut Sphere24| {
            it.radius = [0; 3]
        })
    });
    errors.field("sphere 1", Field::LowestCoordinate, |it| {
        it.change(SectionKind::Spheres, 1, |it: &mut Sphere24| {
            it.center[0] = [0, 0, 0x80]
        })
    });
    errors.field("box 0", Field::HighestCoordinate, |it| {
        it.change(SectionKind::Boxes, 0, |it: &mut Cuboid| it.highest[0] = far)
    });
    errors.reason("box 0", Reason::InvertedBox, |it| {
        it.change(SectionKind::Boxes, 0, |it: &mut Cuboid| {
            std::mem::swap(&mut it.lowest[1], &mut it.highest[1])
        })
    });
    let discs: [Forgery<Disc>; 3] = [
        (Field::Center, &|it| it.center[0] = far),
        (Field::Normal, &|it| it.normal[0] = far + 1),
        (Field::Radius, &|it| it.radius = 0),
    ];
    for (field, forge) in discs {
        errors.field("disc 0", field, |it| {
            it.change(SectionKind::Discs, 0, forge)
        });
    }
    errors.reason("disc 0", Reason::ZeroNormal, |it| {
        it.change(SectionKind::Discs, 0, |it: &mut Disc| it.normal = [0; 3])
    });
    errors.reason("disc 0", Reason::OutsideScene, |it| {
        it.change(SectionKind::Discs, 0, |it: &mut Disc| {
            it.bounds.0[0][0] = i16::MIN
        })
    });
    let cones: [Forgery<Cone>; 3] = [
        (Field::BaseCenter, &|it| it.base[0] = far),
        (Field::ApexCenter, &|it| it.apex[0] = far),
        (Field::Radius, &|it| it.base_radius = -1),
    ];
    for (field, forge) in cones {
        errors.field("cone 0", field, |it| {
            it.change(SectionKind::Cones, 0, forge)
        });
    }
    let tori: [Forgery<Torus>; 4] = [
        (Field::Center, &|it| it.center[0] = i32::MAX),
        (Field::Axis, &|it| it.axis[1] = (1 << 24) + 1),
        (Field::Radius, &|it| it.minor_radius = 0),
        (Field::Radius, &|it| it.major_radius = -1),
    ];
    for (field, forge) in tori {
        errors.field("torus 0", field, |it| {
            it.change(SectionKind::Tori, 0, forge)
        });
    }
    errors.reason("torus 0", Reason::ZeroAxis, |it| {
        it.change(SectionKind::Tori, 0, |it: &mut Torus| it.axis = [0; 3])
    });
    let planes: [Forgery<Plane>; 3] = [
        (Field::Point, &|it| it.point[2] = (1 << 25) + 1),
        (Field::Point, &|it| it.point[0] = i32::MIN),
        (Field::Normal, &|it| it.normal[1] = -(1 << 24) - 1),
    ];
    for (field, forge) in planes {
        errors.field("plane 0", field, |it| {
            it.change(SectionKind::Planes, 0, forge)
        });
    }
    errors.reason("plane 0", Reason::ZeroNormal, |it| {
        it.change(SectionKind::Planes, 0, |it: &mut Plane| it.normal = [0; 3])
    });
    errors.reason("cone 0", Reason::ZeroAxis, |it| {
        it.change(SectionKind::Cones, 0, |it: &mut Cone| it.apex = it.base)
    });
    errors.reason("cone 0", Reason::ZeroRadii, |it| {
        it.change(SectionKind::Cones, 0, |it: &mut Cone| {
            (it.base_radius, it.apex_radius) = (0, 0)
        })
    });
    // Wider and higher than any solid in a scene's box.
    errors.reason("cone 0", Reason::OutsideScene, |it| {
        let bounds = it.header().bounds;
        it.change(SectionKind::Cones, 0, |it: &mut Cone| {
            [it.base, it.apex] =
                [0, 1].map(|side: usize| bounds.0.map(|axis| i32::from(axis[side]) << 8));
            it.base_radius = 65_534 << 8;
        })
    });
    errors.reason("cone 0", Reason::OutsideScene, |it| {
        it.change(SectionKind::Cones, 0, |it: &mut Cone| {
            it.bounds.0[2][1] = i16::MAX
        })
    });
    errors.field("object 1", Field::FirstPrimitive, |it| {
        it.set(SectionKind::ObjectFirst, 1, u32::MAX)
    });
    errors.field("object 0", Field::Material, |it| {
        it.set(SectionKind::ObjectMaterial, 0, u32::MAX)
    });
    errors.field("slot 0", Field::Primitive, |it| {
        it.set(SectionKind::Order, 0, u32::MAX)
    });
    let leaves: [Forgery<u32>; 3] = [
        (Field::Kind, &|it| *it |= 7 << 29),
        (Field::Primitives, &|it| *it &= !(31 << 24)),
        (Field::FirstSlot, &|it| *it += 1),
    ];
    for (field, forge) in leaves {
        errors.field("leaf 0", field, |it| {
            it.change(SectionKind::Leaves, 0, forge)
        });
    }
    // The last leaf is the last one of its kind.
    let last = errors.base.records(SectionKind::Leaves) - 1;
    errors.field(&format!("leaf {last}"), Field::EndSlot, |it| {
        it.change(SectionKind::Leaves, last, |it: &mut u32| *it += 1 << 24)
    });
    errors
}
