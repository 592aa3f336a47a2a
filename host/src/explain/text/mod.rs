//! Explanations as text for people.

mod walk;
mod words;

use super::explanation::{Explanation, Hit, LightOutcome, Lighting, Ray, Sample, kind_name};
use super::walk::Walk;
use crate::compile::Names;
use crate::table::{counted, printable, significant};
use gridel_core::RayKind;
use std::fmt::{self, Display, Formatter};
use words::{bound, color, counted_were, peak, precise, vector};

/// An explanation as text.
pub struct Shown<'s> {
    pub explanation: &'s Explanation,
    pub names: &'s Names,
    /// True if the walks of all rays through the structure are shown, and not only the first one's.
    pub all_walks: bool,
}

impl Display for Shown<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Explanation {
            pixel,
            picture,
            format,
            accel,
            samples,
            linear: _,
            srgb,
        } = self.explanation;
        let [r, g, b] = srgb;
        match pixel.zip(*picture) {
            Some(([x, y], [width, height])) => write!(f, "Pixel {x},{y} of {width} x {height}")?,
            None => write!(f, "The ray")?,
        }
        // Sixteen bits hold no more digits.
        let shown = self.explanation.color();
        let [red, green, blue] = shown;
        writeln!(
            f,
            " is #{r:02x}{g:02x}{b:02x}: linear {red:.4} {green:.4} {blue:.4}, in {format} through \
             {accel}."
        )?;
        let mean = self.explanation.mean();
        if mean.iter().zip(shown).any(|(a, b)| (a - b).abs() > 1e-3) {
            let mean = color(mean);
            writeln!(
                f,
                "It shows the mean of the samples, {mean}, limited to display white or tone mapped."
            )?;
        }
        let (listed, all) = (self.explanation.listed_samples(), samples.len());
        if listed < all {
            let given = match pixel {
                Some([x, y]) => format!(" --pixel {x},{y} --samples {all}"),
                None => String::new(),
            };
            writeln!(
                f,
                "Only the first {listed} of {all} samples are explained. `gridel explain{given}` explains all."
            )?;
        }
        for sentence in self.sentences() {
            writeln!(f, "{sentence}")?;
        }
        for (number, sample) in samples.iter().take(listed).enumerate() {
            write!(f, "\nSample {} of {}", number + 1, samples.len())?;
            if let Some([x, y]) = sample.place {
                write!(f, " at {x:.3}, {y:.3}")?;
            }
            writeln!(f, ": {}", color(sample.radiance))?;
            self.ray(f, sample, 0)?;
        }
        for (number, sample) in samples.iter().enumerate() {
            for (place, ray) in sample.rays.iter().enumerate() {
                if let Some(walk) = ray.walk.as_ref().filter(|_| place == 0 || self.all_walks) {
                    writeln!(f, "\nTraversal of ray {place} of sample {}", number + 1)?;
                    self.walk(f, walk)?;
                }
                for lighting in ray.lights.iter().filter(|_| self.all_walks) {
                    for walk in &lighting.shadow {
                        let light = self.light(lighting.light);
                        let sample = number + 1;
                        writeln!(
                            f,
                            "\nTraversal of the shadow ray from ray {place} of sample {sample} to {light}"
                        )?;
                        self.walk(f, walk)?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Shown<'_> {
    fn object(&self, number: u32) -> String {
        match self.names.object(number) {
            Some(name) => format!("{} (object {number})", printable(name)),
            None => format!("object {number}"),
        }
    }

    /// The instance that something is part of, as words that follow it.
    fn of_instance(&self, number: Option<u32>) -> String {
        match number.map(|number| self.instance(number)) {
            Some(instance) => format!(" in {instance}"),
            None => String::new(),
        }
    }

    fn instance(&self, number: u32) -> String {
        match self.names.instance(number) {
            Some(name) => format!("{} (instance {number})", printable(name)),
            None => format!("instance {number}"),
        }
    }

    fn material(&self, object: u32) -> String {
        match self.names.material_of(object) {
            Some(name) => format!(" of {}", printable(name)),
            None => String::new(),
        }
    }

    fn medium(&self, material: Option<u32>) -> String {
        let Some(number) = material else {
            return String::from("the surroundings");
        };
        match self.names.material(number) {
            Some(name) => format!("{} (material {number})", printable(name)),
            None => format!("material {number}"),
        }
    }

    fn light(&self, number: u32) -> String {
        match self.names.light(number) {
            Some(name) => format!("{} (light {number})", printable(name)),
            None => format!("light {number}"),
        }
    }

    /// Returns the sentences that most likely answer the question.
    fn sentences(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        let rays = || {
            self.explanation
                .samples
                .iter()
                .flat_map(|sample| &sample.rays)
        };
        let primary = || {
            self.explanation
                .samples
                .iter()
                .filter_map(|s| s.rays.first())
        };
        let background = primary().filter(|ray| ray.background).count();
        if background > 0 {
            let all = primary().count();
            sentences.push(if background == all {
                String::from("The ray hits nothing: this is the background.")
            } else {
                format!("{background} of {all} samples hit nothing and show the background.")
            });
        }
        let is_dark = |ray: &&Ray| {
            // What a surface does not reflect need not reach it, and what glows is not dark.
            let counts = |light: &Lighting| {
                matches!(light.outcome, LightOutcome::Lit | LightOutcome::Unreflected)
            };
            let glows = ray.emitted.is_some() || ray.is_emitted_by_light;
            let is_considered = ray.hit.is_some() && !ray.lights.is_empty();
            is_considered && !glows && !ray.lights.iter().any(counts)
        };
        if let Some(unlit) = primary().find(is_dark) {
            let reasons: Vec<_> = unlit.lights.iter().map(|l| self.outcome(l)).collect();
            let reasons = reasons.join("; ");
            let [dark, all] = [primary().filter(is_dark).count(), primary().count()];
            sentences.push(match dark == all {
                true => format!("No light reaches the first hit: {reasons}."),
                false => {
                    format!("In {dark} of {all} samples no light reaches the first hit: {reasons}.")
                }
            });
        }
        let is_met = |ray: &&Ray| ray.hit.is_some();
        let of_ambient = |ray: &Ray| ray.ambient.is_some() && ray.lights.is_empty();
        let others = |ray: &Ray| {
            let bounces = [RayKind::Diffuse, RayKind::Glossy, RayKind::Polished].map(kind_name);
            ray.emitted.is_some() || ray.environment.is_some() || bounces.contains(&ray.kind)
        };
        let all_ambient = rays().filter(is_met).all(of_ambient);
        if all_ambient && rays().any(|ray| ray.hit.is_some()) && !rays().any(others) {
            sentences.push(String::from("The scene has only ambient light."));
        }
        let count = self.explanation.listed_samples() as f64;
        let too_deep: Vec<f64> = rays()
            .filter(|ray| ray.too_deep)
            .map(|ray| peak(ray.cut))
            .collect();
        if !too_deep.is_empty() {
            let lost: f64 = too_deep.iter().sum::<f64>() / count;
            sentences.push(format!(
                "{} stopped at the ray depth; black replaces up to {} of white. Raise it with \
                 `--depth`.",
                counted_were(too_deep.len(), "ray"),
                significant(lost)
            ));
        }
        let dropped: Vec<f64> = rays()
            .flat_map(|ray| &ray.dropped)
            .map(|dropped| peak(dropped.weight))
            .filter(|&weight| weight > 0.0)
            .collect();
        if !dropped.is_empty() {
            let lost: f64 = dropped.iter().sum::<f64>() / count;
            sentences.push(format!(
                "{} not traced, because the weight is below the scene's cutoff: {} of white in all.",
                counted_were(dropped.len(), "ray"),
                significant(lost)
            ));
        }
        sentences
    }

    /// A ray of the tree, and those that it causes.
    fn ray(&self, f: &mut Formatter<'_>, sample: &Sample, place: usize) -> fmt::Result {
        let Some(ray) = sample.rays.get(place) else {
            return Ok(());
        };
        let indent = "  ".repeat(usize::from(ray.depth) + 1);
        write!(f, "{indent}ray {place}, {}", ray.kind)?;
        if ray.parent.is_some() {
            write!(f, ", weighs {}", color(ray.weight))?;
        }
        writeln!(f, ": adds {}", color(ray.added))?;
        if let Some(walk) = &ray.walk {
            writeln!(
                f,
                "{indent}  from {} along {}: {} visited, {} culled, {} tested",
                vector(walk.origin, |x| x.to_string()),
                vector(walk.direction, |x| x.to_string()),
                counted(walk.opened, "node"),
                walk.culled,
                counted(walk.candidates, "primitive"),
            )?;
        }
        if let Some(point) = ray.from_lens {
            let point = vector(point, significant);
            writeln!(f, "{indent}  the lens lets it through at {point}")?;
        }
        match &ray.hit {
            Some(hit) => self.hit(f, &indent, ray, hit)?,
            None if ray.environment.is_some() => {
                let (texel, sun) = ray.environment.unwrap_or_default();
                let sun = if sun { " and the sun" } else { "" };
                let [column, row] = texel;
                writeln!(
                    f,
                    "{indent}  hits nothing: the environment at texel {column}, {row}{sun}"
                )?;
            }
            None if ray.background => writeln!(f, "{indent}  hits nothing: the background")?,
            None => writeln!(f, "{indent}  is not traced: it has no direction")?,
        }
        ray.children
            .iter()
            .try_for_each(|&child| self.ray(f, sample, child))
    }

    fn hit(&self, f: &mut Formatter<'_>, indent: &str, ray: &Ray, hit: &Hit) -> fmt::Result {
        let kind = ray.walk.as_ref().and_then(Walk::met).map_or("", |c| c.kind);
        writeln!(
            f,
            "{indent}  hits the {} of {kind} {}, which is {}{}{}, at distance {} within {}",
            if hit.front { "front" } else { "back" },
            hit.primitive,
            self.object(hit.object),
            self.material(hit.object),
            self.of_instance(hit.instance),
            precise(hit.distance, hit.distance_error),
            bound(hit.distance_error)
        )?;
        writeln!(
            f,
            "{indent}  at {}, which is within {} of the surface, normal {}",
            vector(hit.point, |x| precise(x, hit.distance_error)),
            bound(hit.error),
            vector(hit.normal, significant)
        )?;
        surface(f, indent, ray)?;
        self.passage(f, indent, ray)?;
        self.radiance(f, indent, ray)?;
        bounces(f, indent, ray)
    }

    /// Writes what the ray passes and loses on its way.
    fn passage(&self, f: &mut Formatter<'_>, indent: &str, ray: &Ray) -> fmt::Result {
        if let Some([from, to]) = ray.media {
            let near = self.medium(from);
            match from == to {
                true => writeln!(f, "{indent}  within {near}: the ray goes straight on")?,
                false => writeln!(f, "{indent}  between {near} and {}", self.medium(to))?,
            }
        }
        if let Some(alpha) = ray.alpha {
            let alpha = significant(alpha);
            writeln!(
                f,
                "{indent}  its alpha is {alpha}; the rest of the ray goes straight on"
            )?;
        }
        if let Some(weight) = ray.absorbed {
            writeln!(
                f,
                "{indent}  absorption in the glass reduces its weight to {}",
                color(weight)
            )?;
        }
        Ok(())
    }

    /// The light that comes from the surface itself, and by rays to lights.
    fn radiance(&self, f: &mut Formatter<'_>, indent: &str, ray: &Ray) -> fmt::Result {
        if ray.is_emitted_by_light {
            writeln!(
                f,
                "{indent}  glows; its light has come by rays to lights already"
            )?;
        }
        if let Some(radiance) = ray.emitted {
            writeln!(f, "{indent}  glows with {}", color(radiance))?;
        }
        if let Some(radiance) = ray.ambient {
            writeln!(f, "{indent}  reflects ambient light: {}", color(radiance))?;
        }
        for lighting in &ray.lights {
            writeln!(f, "{indent}  {}", self.outcome(lighting))?;
        }
        Ok(())
    }

    /// Returns what happens to a light, as a clause.
    fn outcome(&self, lighting: &Lighting) -> String {
        let light = self.light(lighting.light);
        let cosine = significant(lighting.cosine);
        let glass = match lighting.filtered.last() {
            Some(left) => format!(
                ", through {} of glass that transmit {}",
                counted(lighting.filtered.len(), "surface"),
                color(*left)
            ),
            None => String::new(),
        };
        let around = match lighting.absorbed {
            Some(left) => format!(", of which the glass around it leaves {}", color(left)),
            None => String::new(),
        };
        let glass = glass + &around;
        let from = match lighting.from_area {
            Some(point) => format!(", from its point {},", vector(point, significant)),
            None => match lighting.from_environment {
                Some(direction) => format!(
                    ", from the direction {} of the environment,",
                    vector(direction, significant)
                ),
                None => String::new(),
            },
        };
        let arriving = match lighting.arriving {
            Some(arriving) => format!(", and falls off to {}", color(arriving)),
            None => String::new(),
        };
        match lighting.outcome {
            LightOutcome::Lit => format!(
                "{light}{from} reaches it with cosine {cosine}{glass}{arriving}: {}",
                color(lighting.radiance)
            ),
            LightOutcome::Outside => format!("{light}{from} does not shine in this direction"),
            LightOutcome::Faint => format!("{light}{from} adds nothing that shows from so far"),
            LightOutcome::Behind => format!("{light} is behind the surface (cosine {cosine})"),
            LightOutcome::BehindTriangle => {
                format!("{light} is behind the triangle (cosine {cosine} with the smooth normal)")
            }
            LightOutcome::Blocked {
                kind,
                primitive,
                object,
                instance,
            } => format!(
                "{light}{from} is blocked by {kind} {primitive}, which is {}{}{}{glass}",
                self.object(object),
                self.material(object),
                self.of_instance(instance)
            ),
            LightOutcome::Faded => format!("{light} is absorbed{glass}"),
            LightOutcome::Here => {
                format!("{light} adds nothing: it is at this point, or this is its own surface")
            }
            LightOutcome::Off => format!("{light} is turned off: its color is black"),
            LightOutcome::Unreflected => {
                format!("{light} adds nothing, because the material reflects none of its light")
            }
        }
    }
}

/// Writes what the surface's maps and vertices define at the hit.
fn surface(f: &mut Formatter<'_>, indent: &str, ray: &Ray) -> fmt::Result {
    if let Some(normal) = ray.smooth {
        writeln!(
            f,
            "{indent}  shaded with the smooth normal {}",
            vector(normal, significant)
        )?;
    }
    if let Some(map) = &ray.normal_map {
        let [x, y] = map.texel;
        writeln!(
            f,
            "{indent}  shaded with the normal {} of the normal map, texel {x},{y}",
            vector(map.normal, significant)
        )?;
    }
    if let Some(weight) = ray.vertex_color {
        writeln!(
            f,
            "{indent}  its vertices weight the diffuse color by {}",
            color(weight)
        )?;
    }
    if let Some(texture) = &ray.texture {
        let [u, v] = texture.coordinates.map(significant);
        let [x, y] = texture.texel;
        let level = match texture.level {
            0.0 => String::new(),
            level => format!(" of level {}", significant(level)),
        };
        writeln!(
            f,
            "{indent}  the texture at {u} {v}, texel {x},{y}{level}, weights the diffuse color by {}",
            color(texture.color)
        )?;
    }
    Ok(())
}

/// The rays that go on from a surface, and those that are not traced.
fn bounces(f: &mut Formatter<'_>, indent: &str, ray: &Ray) -> fmt::Result {
    if let Some(normal) = ray.facet {
        writeln!(
            f,
            "{indent}  rough: rays leave by the facet with the normal {}",
            vector(normal, significant)
        )?;
    }
    if let Some(reflected) = ray.reflected {
        writeln!(
            f,
            "{indent}  the glass reflects {} and transmits the rest",
            significant(reflected)
        )?;
    }
    for dropped in ray.dropped.iter().filter(|d| peak(d.weight) > 0.0) {
        writeln!(
            f,
            "{indent}  a {} ray of weight {} is not traced",
            dropped.kind,
            color(dropped.weight)
        )?;
    }
    if ray.too_deep {
        writeln!(
            f,
            "{indent}  the reflected and refracted rays exceed the ray depth"
        )?;
    }
    Ok(())
}
