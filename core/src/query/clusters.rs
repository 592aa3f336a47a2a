//! The search among the primitives of a cluster.

use crate::accel::Number;
use crate::accel::cull::Culling;
use crate::format::cluster::{LANES, Pack, Strip};
use crate::format::{Kind, Leaf};
use crate::geometry::{Packs, PrimitiveId, Strips, pack, sphere};
use crate::number::Format;
use crate::observe::count::Observer;
use crate::query::collect::Collect;
use crate::query::search::Search;
use crate::simd::{Portable, Simd, SimdLevel, with_simd};

impl<N: Number, K: Culling<N>, F: Collect<N>> Search<'_, '_, N, K, F> {
    /// Tests the primitives of a cluster, or, if `ANY` hit is enough, of a pack only until one is hit.
    #[inline(always)]
    pub(super) fn cluster<C: Observer, const ANY: bool>(&mut self, leaf: Leaf, count: &mut C) {
        let clusters = self.scene.geometry.shapes.clusters();
        match (leaf.kind, clusters.strips, clusters.packs) {
            (Kind::Triangle, Strips::S16(strips), _) => self.strip(strips, leaf.first, count),
            (Kind::Triangle, Strips::S24(strips), _) => self.strip(strips, leaf.first, count),
            (_, _, Packs::P16(packs)) => {
                self.pack::<_, _, ANY>(packs.get(leaf.first as usize), leaf.first, count)
            }
            (_, _, Packs::P24(packs)) => {
                self.pack::<_, _, ANY>(packs.get(leaf.first).as_ref(), leaf.first, count)
            }
        }
    }

    /// Reports the primitives of a cluster that lanes rejected.
    #[inline(always)]
    fn observe_missed<C: Observer>(
        &self,
        missed: u32,
        id: impl Fn(u32) -> PrimitiveId,
        count: &mut C,
    ) {
        if C::ENABLED {
            for lane in (0..8).filter(|&lane| missed >> lane & 1 != 0) {
                self.observe(id(lane), None, count);
            }
        }
    }

    /// Tests the triangles of a strip.
    #[inline(always)]
    fn strip<S: Strip, C: Observer>(&mut self, strips: &[S], number: u32, count: &mut C) {
        let Some(strip) = strips.get(number as usize) else {
            return;
        };
        count.primitives(strip.members().count());
        let mut met = self.strip_met(strip);
        let missed = strip.members().lanes() & !met;
        let id = |place| PrimitiveId::in_cluster(Kind::Triangle, number, place);
        self.observe_missed(missed, id, count);
        while met != 0 {
            let place = met.trailing_zeros();
            met &= met - 1;
            self.triangle_in_strip(strip, id(place), count);
        }
    }

    /// The places of a strip whose triangles the ray hits.
    #[inline(always)]
    fn strip_met<S: Strip>(&self, strip: &S) -> u32 {
        let Some(ray) = self.strip_ray.get() else {
            return 0;
        };
        match self.scene.geometry.simd() {
            SimdLevel::Portable => ray.hit_lanes(Portable, strip),
            SimdLevel::Avx2(avx2) => avx2.call(
                #[inline(always)]
                |avx2, ray, strip, (), (), ()| ray.hit_lanes(avx2, strip),
                (ray, strip, (), (), ()),
            ),
        }
    }

    /// Processes a triangle of a strip that the line of the ray hits.
    #[inline(never)]
    fn triangle_in_strip<S: Strip, C: Observer>(
        &mut self,
        strip: &S,
        place: PrimitiveId,
        count: &mut C,
    ) {
        if let Some(lane) = place.lane()
            && let Some(corners) = strip.triangle(lane)
        {
            self.triangle(corners, place, count);
        }
    }

    /// Tests the spheres of a pack.
    #[inline(always)]
    fn pack<P: Pack, C: Observer, const ANY: bool>(
        &mut self,
        pack: Option<&P>,
        number: u32,
        count: &mut C,
    ) {
        let Some(pack) = pack else { return };
        let place = |lane| PrimitiveId::in_cluster(Kind::Sphere, number, lane);
        count.primitives(pack.lanes().count_ones());
        if N::FORMAT != Format::F32 {
            for lane in 0..LANES as u32 {
                self.sphere_in_pack(pack, lane, place(lane), count);
            }
            return;
        }
        let met = with_simd!(self.scene.geometry.simd(), |simd| simd.call(
            #[inline(always)]
            |simd, ray, recip_norm2, pack, (), ()| pack::hit_lanes(simd, ray, recip_norm2, pack),
            (self.ray, self.recip_norm2, pack, (), ()),
        ));
        let missed = pack.lanes() & !met.lanes;
        self.observe_missed(missed, place, count);
        let mut lanes = met.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros();
            lanes &= lanes - 1;
            let crossing = met.crossing(self.ray, self.recip_norm2, lane as usize);
            self.consider(crossing, place(lane));
            self.observe(place(lane), Some(&crossing), count);
            // Lanes have tested the others, too, so observers get all of them.
            if ANY && !C::ENABLED && self.found.is_any() {
                return;
            }
        }
    }

    /// Tests a sphere of a pack, in formats without lanes.
    #[inline(never)]
    fn sphere_in_pack<P: Pack, C: Observer>(
        &mut self,
        pack: &P,
        lane: u32,
        place: PrimitiveId,
        count: &mut C,
    ) {
        let Some((center, radius)) = pack.sphere(lane) else {
            return;
        };
        let crossing = sphere::cross(self.ray, self.recip_norm2, center, radius);
        if let Some(crossing) = crossing {
            self.consider(crossing, place);
        }
        self.observe(place, crossing.as_ref(), count);
    }
}
