//! A surface at a ray's hit: its normal, its color, and the part of it that is present.

use super::bump;
use super::hit::{Hit, Seen};
use super::levels;
use super::log2::Log2;
use super::media::{self, Boundary, Interface};
use super::number::*;
use super::paint;
use super::path::Path;
use super::reason::Reason;
use super::search::{Stop, Tracer};
use super::shade;
use gridel_core::Effects;
use gridel_core::format::record::Material;

impl Tracer<'_, '_> {
    /// Returns the surface of a hit.
    ///
    /// # Errors
    /// If its bounds are too wide.
    pub fn seen<'h, N: Enclosure>(
        &self,
        hit: &'h Hit<N>,
        path: &'h Path<N>,
    ) -> Result<Seen<'h, N>, Stop>
    where
        Self: 'h,
    {
        let scene = self.world.scene;
        let material = scene.material(hit.object).ok_or(Stop)?;
        let boundary = Boundary::at(scene, path.inside, hit.object, hit.front);
        let mut weight = path.weight;
        let medium = media::passed(scene, boundary.as_ref(), path.inside, hit.object, hit.front);
        if let Some(medium) = medium.filter(|it| it.absorption != [0; 3]) {
            let length = hit.t * norm2(path.ray.direction).sqrt();
            weight = times(weight, shade::absorbed(medium, length));
        }
        let direction = self.narrow(unit(path.ray.direction), path.depth, hit)?;
        let mut length = None;
        if self.has(Effects::TEXTURE_LEVELS) {
            length = Some(self.narrow(levels::length(path, hit), path.depth, hit)?);
        }
        let is_leveled = material.maps & Material::MAPS_LEVELS != 0;
        let size = match length.filter(|_| is_leveled) {
            None => None,
            Some(length) => {
                let size = levels::footprint(self.world, (path, hit), length, self.spread);
                self.narrow(size, path.depth, hit)?
            }
        };
        let normal = self.normal(hit, (material, size), direction, path.depth)?;
        let mut diffuse = self.diffuse(hit, material, path.depth);
        if self.has(Effects::VERTEX_COLORS) || self.has(Effects::TEXTURE) {
            let paint = paint::weight(self.world, hit, material, size);
            let paint = self.narrow(paint, path.depth, hit)?;
            if paint.is_open {
                self.note(Reason::Texture, path.depth, hit.primitive, hit.point);
            }
            diffuse = times(diffuse, paint.color);
        }
        let mut passing = [N::zero(); 3];
        if self.has(Effects::ALPHA) {
            let alpha = paint::alpha(self.world, hit, material, size);
            let alpha = self.narrow(alpha, path.depth, hit)?;
            if alpha.is_open {
                self.note(Reason::Texture, path.depth, hit.primitive, hit.point);
            }
            let rest = (N::one() - alpha.part).at_least(N::zero());
            passing = scale(weight, rest);
            weight = scale(weight, alpha.part);
        }
        let is_there = boundary.is_none_or(|it| it.is_there());
        if !is_there {
            (passing, weight) = (weight, [N::zero(); 3]);
        }
        let interface = boundary.and_then(|it| it.interface(scene));
        Ok(Seen {
            path,
            hit,
            material,
            is_there,
            normal,
            direction,
            diffuse,
            weight,
            passing,
            interface: interface.unwrap_or(Interface::of(hit.front, material)),
            beyond: path.inside.beyond(scene, boundary.as_ref(), hit.crossed()),
            length,
        })
    }

    /// The normal with which a surface is shaded, on the side of the ray.
    fn normal<N: Enclosure>(
        &self,
        hit: &Hit<N>,
        (material, size): (&Material, Option<Log2>),
        direction: Three<N>,
        depth: u8,
    ) -> Result<Three<N>, Stop> {
        // A mirror or glass does not show its back.
        let turns = material.is_glass() || material.mirror != [0; 3];
        let turned = |normal| match turns {
            true => self.narrow(shade::turned_to_ray(normal, direction), depth, hit),
            false => Ok(normal),
        };
        let mut normal = hit.facing();
        if self.has(Effects::SMOOTH)
            && let Some(smooth) = self.narrow(shade::smooth_normal(self.world, hit), depth, hit)?
        {
            normal = turned(smooth)?;
        }
        if self.has(Effects::NORMAL_MAP) {
            let bumped = bump::bumped(self.world, hit, (material, size), normal);
            if let Some(bumped) = self.narrow(bumped, depth, hit)? {
                if bumped.is_open {
                    self.note(Reason::Texture, depth, hit.primitive, hit.point);
                }
                normal = turned(bumped.normal)?;
            }
        }
        Ok(normal)
    }

    /// The diffuse color; of both kinds of cells where it is open which one it is.
    fn diffuse<N: Enclosure>(&self, hit: &Hit<N>, material: &Material, depth: u8) -> Three<N> {
        let even = material.diffuse.map(ratio_of);
        if material.checker_size <= 0 {
            return even;
        }
        let odd = material.odd.map(ratio_of);
        match shade::is_odd(hit, material) {
            Some(false) => even,
            Some(true) => odd,
            None => {
                self.note(Reason::Checker, depth, hit.primitive, hit.point);
                hull(even, odd)
            }
        }
    }
}
