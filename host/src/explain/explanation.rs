//! The rays of a pixel as a tree, and what each adds to it.

use super::walk::Walk;
use crate::trace::Frame;
use gridel_core::format::record::Material;
use gridel_core::observe::event::{QueryHit, Source};
use gridel_core::{Effects, Event, RayKind, Scene};
use serde::{Serialize, Serializer};

/// An explanation of a pixel or of a ray of the caller's own. Colors are linear, 1 being display white.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Explanation {
    /// The pixel, counted from the picture's upper left corner; `None` for a ray of the caller's own.
    pub pixel: Option<[u16; 2]>,
    /// The picture's columns and rows; `None` for a ray of the caller's own.
    pub picture: Option<[u16; 2]>,
    /// Number format.
    pub format: &'static str,
    /// Structure.
    pub accel: &'static str,
    /// All samples of the pixel. Those after the first that were asked for have no rays.
    pub samples: Vec<Sample>,
    /// The pixel's linear color; 65535 is white. As JSON a ratio, like other colors.
    #[serde(serialize_with = "as_ratios")]
    pub linear: [u16; 3],
    /// The pixel's color in sRGB, as displays take it.
    pub srgb: [u8; 3],
}

impl Explanation {
    /// Returns the pixel's linear color, 1 being display white.
    pub fn color(&self) -> [f64; 3] {
        ratios(&self.linear)
    }

    /// Returns the number of samples whose rays are listed.
    pub fn listed_samples(&self) -> usize {
        let is_listed = |sample: &&Sample| !sample.rays.is_empty();
        self.samples.iter().filter(is_listed).count()
    }

    /// Returns the mean of the samples, which is the pixel's color before it is tone mapped or encoded for display.
    pub fn mean(&self) -> [f64; 3] {
        let count = self.samples.len().max(1) as f64;
        let channel = |k: usize| self.samples.iter().map(|it| it.radiance[k]).sum::<f64>() / count;
        [channel(0), channel(1), channel(2)]
    }
}

fn ratios(linear: &[u16; 3]) -> [f64; 3] {
    linear.map(|channel| f64::from(channel) / f64::from(u16::MAX))
}

fn as_ratios<S: Serializer>(linear: &[u16; 3], serializer: S) -> Result<S::Ok, S::Error> {
    ratios(linear).serialize(serializer)
}

/// A ray from the camera, with all that it causes.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Sample {
    /// The place in pixels from the picture's upper left corner; `None` for a ray of the caller's own.
    pub place: Option<[f64; 2]>,
    /// In the order in which they were traced; the first is the one from the camera.
    pub rays: Vec<Ray>,
    /// The sum of what the rays add, each channel limited to 0 to 1; to 4 or 16 where effects need it.
    pub radiance: [f64; 3],
}

/// A ray of the tree.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Ray {
    pub kind: &'static str,
    /// The ray that caused it, by its place among the sample's rays.
    pub parent: Option<usize>,
    pub depth: u8,
    /// The factor of its radiance.
    pub weight: [f64; 3],
    /// `None` where its direction vanished, so that it was not traced.
    pub walk: Option<Walk>,
    pub hit: Option<Hit>,
    /// The weight after absorption on the way.
    pub absorbed: Option<[f64; 3]>,
    /// The smooth normal that the surface is shaded with.
    pub smooth: Option<[f64; 3]>,
    /// The normal of a normal map that the surface is shaded with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_map: Option<Mapped>,
    /// The color of the vertices that weights the diffuse color: linear ratios.
    pub vertex_color: Option<[f64; 3]>,
    /// The texture that weights the diffuse color.
    pub texture: Option<Textured>,
    /// The media with a priority on the near side and on the far side, by the numbers of their materials; `None` for
    /// the surroundings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub media: Option<[Option<u32>; 2]>,
    /// The part of the surface that is present, where the alpha of a texture says so.
    pub alpha: Option<f64>,
    pub lights: Vec<Lighting>,
    /// The point of the lens from which a ray of the camera starts, in scene units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_lens: Option<[f64; 3]>,
    /// True if the surface sends out light that its lights have already brought.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_emitted_by_light: bool,
    /// Reflected ambient light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ambient: Option<[f64; 3]>,
    /// The radiance that the surface sends out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emitted: Option<[f64; 3]>,
    /// The radiance that it adds to the sample, its weight included.
    pub added: [f64; 3],
    /// True if that is the background.
    pub background: bool,
    /// The texel of the environment that it brings, column and row, and whether it brings the sun.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<([u32; 2], bool)>,
    /// The normal of the facet that is drawn at a rough surface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facet: Option<[f64; 3]>,
    /// The part that glass reflects.
    pub reflected: Option<f64>,
    /// Rays that it would cause if they could change anything.
    pub dropped: Vec<Weighted>,
    /// True if the ray depth ended it at a mirror or at glass.
    pub too_deep: bool,
    /// A bound of the weights of the rays that exceed the depth.
    pub cut: [f64; 3],
    /// Rays that it causes, by their places.
    pub children: Vec<usize>,
}

/// A texture at a hit.
#[derive(Clone, Debug, Serialize)]
pub struct Textured {
    /// The coordinates of the texture lookup, u to the right and v down.
    pub coordinates: [f64; 2],
    /// Number of times that the image is halved for the lookup; a fraction lies between two of its levels.
    pub level: f64,
    /// The nearest texel of the finer level, counted from the upper left one, or the upper left one of the four that
    /// are mixed.
    pub texel: [u32; 2],
    /// Linear ratios.
    pub color: [f64; 3],
}

/// A normal map at a hit.
#[derive(Clone, Debug, Serialize)]
pub struct Mapped {
    /// The nearest texel, counted from the upper left one, or the upper left one of the four that are mixed.
    pub texel: [u32; 2],
    /// The normal, of length 1, on the side from which the ray came.
    pub normal: [f64; 3],
}

/// A ray that was not cast.
#[derive(Clone, Debug, Serialize)]
pub struct Weighted {
    pub kind: &'static str,
    pub weight: [f64; 3],
}

/// A hit, in scene units.
#[derive(Clone, Debug, Serialize)]
pub struct Hit {
    /// The distance from the ray's origin, along it.
    pub distance: f64,
    /// `origin + distance * direction` lies within this of the point.
    pub distance_error: f64,
    pub point: [f64; 3],
    pub normal: [f64; 3],
    /// True if the ray came from the side to which the normal points.
    pub front: bool,
    pub object: u32,
    pub primitive: u32,
    /// The instance in scene-file order; `None` for the scene's own objects.
    pub instance: Option<u32>,
    /// The surface lies within this distance of the point.
    pub error: f64,
}

/// A light at a hit.
#[derive(Clone, Debug, Serialize)]
pub struct Lighting {
    pub light: u32,
    /// Cosine of the angle between the surface's normal and the light.
    pub cosine: f64,
    /// The way to the light, surface of glass by surface of glass.
    pub shadow: Vec<Walk>,
    /// The part of the light that is left behind each.
    pub filtered: Vec<[f64; 3]>,
    /// The part that remains after the glass around the light; `None` where no glass is there that absorbs.
    pub absorbed: Option<[f64; 3]>,
    /// The point of an area from which this sample sees light, in scene units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_area: Option<[f64; 3]>,
    /// The direction from which this sample sees the environment, or the sun in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_environment: Option<[f64; 3]>,
    /// The radiance that arrives of a light that falls off, after shadows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arriving: Option<[f64; 3]>,
    /// The radiance that the light adds to the surface, without the ray's weight.
    pub radiance: [f64; 3],
    pub outcome: LightOutcome,
}

/// The outcome of a light at a surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "outcome", rename_all = "kebab-case")]
pub enum LightOutcome {
    /// It shines on the surface.
    Lit,
    /// The surface is turned away from it.
    Behind,
    /// The smooth normal faces it, and the triangle does not.
    BehindTriangle,
    /// The surface lies outside of a spot, or behind an area.
    Outside,
    /// Another object blocks it.
    Blocked {
        kind: &'static str,
        primitive: u32,
        object: u32,
        instance: Option<u32>,
    },
    /// Glass in between leaves too little of it.
    Faded,
    /// The material reflects none of it.
    Unreflected,
    /// Too little of it arrives from so far, or the material reflects none of it.
    Faint,
    /// It lies where the ray to it would start, so there is no direction to it.
    Here,
    /// Its color is black.
    Off,
}

/// The name of a kind of ray.
pub(super) fn kind_name(kind: RayKind) -> &'static str {
    match kind {
        RayKind::Primary => "primary",
        RayKind::Shadow => "shadow",
        RayKind::Reflected => "reflected",
        RayKind::Refracted => "refracted",
        RayKind::Diffuse => "diffuse",
        RayKind::Glossy => "glossy",
        RayKind::Polished => "polished",
    }
}

impl Ray {
    /// A bound of what the rays from the surface weigh that was hit.
    fn most_sent(&self, scene: &Scene<'_>) -> [f64; 3] {
        let material = self.hit.as_ref().and_then(|hit| scene.material(hit.object));
        let Some(material) = material else {
            return [0.0; 3];
        };
        let weight = self.absorbed.unwrap_or(self.weight);
        let is_indirect = scene.effects().contains(Effects::INDIRECT);
        [0, 1, 2].map(|channel| {
            // 30 fraction bits.
            let ratio = |of: [i32; 3]| f64::from(of[channel]) / f64::powi(2.0, 30);
            let diffuse = if is_indirect {
                ratio(material.diffuse)
            } else {
                0.0
            };
            let sent = match material.maps & Material::MAPS_ALPHA {
                0 => ratio(material.mirror) + ratio(material.transmit) + diffuse,
                _ => 1.0,
            };
            weight[channel] * sent.min(1.0)
        })
    }

    pub(super) fn record(
        &mut self,
        scene: &Scene<'_>,
        frame: &Frame,
        begin: impl FnOnce(&Event) -> Option<Walk>,
        event: &Event,
        light: &mut bool,
    ) {
        if let Some(lighting) = self.lights.last_mut()
            && lighting.record(frame, event)
        {
            return;
        }
        match *event {
            Event::Query { .. } => {
                let walk = begin(event);
                match self.lights.last_mut().filter(|_| *light) {
                    Some(lighting) => lighting.shadow.extend(walk),
                    None => self.walk = walk,
                }
            }
            Event::Nearest(met) if !*light => {
                let walk = self.walk.as_ref();
                self.hit = met
                    .zip(walk)
                    .map(|(met, walk)| Hit::of(scene, frame, walk, &met));
            }
            Event::Light { number, cosine } => {
                *light = true;
                self.lights
                    .push(Lighting::new(number, cosine, LightOutcome::Lit));
            }
            Event::Lit { number, radiance } => {
                *light = false;
                self.record_lit(scene, number, radiance);
            }
            Event::Absorbed { weight } => match self.lights.last_mut().filter(|_| *light) {
                Some(lighting) => lighting.absorbed = Some(weight),
                None => self.absorbed = Some(weight),
            },
            Event::Smooth { normal } => self.smooth = Some(normal),
            Event::NormalMapped { texel, normal } => {
                self.normal_map = Some(Mapped { texel, normal });
            }
            Event::Boundary { media } => self.media = Some(media),
            Event::Alpha { alpha } => self.alpha = Some(alpha),
            Event::VertexColor { color } => self.vertex_color = Some(color),
            Event::Textured {
                coordinates,
                level,
                texel,
                color,
            } => {
                self.texture = Some(Textured {
                    coordinates,
                    level,
                    texel,
                    color,
                });
            }
            Event::Ambient { radiance } => self.ambient = Some(radiance),
            Event::Emitted { radiance } => self.emitted = Some(radiance),
            Event::EmittedByLight => self.is_emitted_by_light = true,
            Event::Lens { point } => self.from_lens = Some(frame.place(point).to_array()),
            Event::Environment { texel, sun } => self.environment = Some((texel, sun)),
            Event::Added { source, radiance } => {
                self.added = radiance;
                self.background = source == Source::Background;
            }
            Event::Facet { normal } => self.facet = Some(normal),
            Event::Split { reflected } => self.reflected = Some(reflected),
            Event::Dropped { kind, weight } => self.dropped.push(Weighted {
                kind: kind_name(kind),
                weight,
            }),
            Event::TooDeep => {
                self.too_deep = true;
                self.cut = self.most_sent(scene);
            }
            _ => {
                let shadow = self.lights.last_mut().and_then(|l| l.shadow.last_mut());
                let walk = if *light { shadow } else { self.walk.as_mut() };
                if let Some(walk) = walk {
                    walk.record(scene, event);
                }
            }
        }
    }

    /// Records the radiance that a light adds to the surface.
    fn record_lit(&mut self, scene: &Scene<'_>, number: u32, radiance: [f64; 3]) {
        match self.lights.last_mut().filter(|it| it.light == number) {
            Some(lighting) => {
                lighting.radiance = radiance;
                lighting.outcome = lighting.outcome();
            }
            // The light had no event before.
            None => {
                let light = scene.lights().get(number as usize);
                let outcome = match light.is_some_and(|it| { it.color } == [0; 3]) {
                    true => LightOutcome::Off,
                    false => LightOutcome::Here,
                };
                self.lights.push(Lighting::new(number, 0.0, outcome));
            }
        }
    }
}

impl Hit {
    fn of(scene: &Scene<'_>, frame: &Frame, walk: &Walk, met: &QueryHit) -> Self {
        let instance = met
            .instance
            .and_then(|it| scene.instances().get(it as usize));
        let (distance, error) = (walk.distance(met.t), frame.length(met.error));
        Self {
            distance,
            distance_error: error + walk.rounding(distance, met.point),
            point: walk.place(frame, distance, met.point),
            normal: met.normal,
            front: met.front,
            object: met.object,
            primitive: met.primitive,
            instance: instance.map(|instance| instance.number),
            error,
        }
    }
}

impl Lighting {
    fn new(light: u32, cosine: f64, outcome: LightOutcome) -> Self {
        Self {
            light,
            cosine,
            shadow: Vec::new(),
            filtered: Vec::new(),
            absorbed: None,
            from_area: None,
            from_environment: None,
            arriving: None,
            radiance: [0.0; 3],
            outcome,
        }
    }

    /// Records an event that is the light's alone, and returns whether it is one.
    fn record(&mut self, frame: &Frame, event: &Event) -> bool {
        match *event {
            Event::Filtered { left } => self.filtered.push(left),
            Event::BehindTriangle => self.outcome = LightOutcome::BehindTriangle,
            Event::FromArea { point } => self.from_area = Some(frame.place(point).to_array()),
            Event::FromEnvironment { direction, .. } => self.from_environment = Some(direction),
            Event::Outside => self.outcome = LightOutcome::Outside,
            Event::Fallen { arriving } => self.arriving = Some(arriving),
            _ => return false,
        }
        true
    }

    fn outcome(&self) -> LightOutcome {
        if self.radiance != [0.0; 3] {
            return LightOutcome::Lit;
        }
        if self.cosine <= 0.0 {
            return LightOutcome::Behind;
        }
        if let LightOutcome::BehindTriangle | LightOutcome::Outside = self.outcome {
            return self.outcome.clone();
        }
        let Some(last) = self.shadow.last() else {
            return match self.arriving {
                Some(_) => LightOutcome::Faint,
                None => LightOutcome::Unreflected,
            };
        };
        // Glass that was met let the rest through, or too little of it.
        match last.met() {
            Some(_) if self.filtered.len() == self.shadow.len() => LightOutcome::Faded,
            Some(met) => LightOutcome::Blocked {
                kind: met.kind,
                primitive: met.primitive,
                object: met.object,
                instance: met.instance,
            },
            None if self.arriving.is_some() => LightOutcome::Faint,
            None => LightOutcome::Unreflected,
        }
    }
}
