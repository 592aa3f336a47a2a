// tinybvh's layouts for CPUs as C functions.

#define TINYBVH_IMPLEMENTATION
#include "tiny_bvh.h"

namespace {

struct Query {
	float origin[3], direction[3];
};

template <class Layout> void* build( const float* corners, uint32_t triangles )
{
	auto* layout = new Layout();
	layout->Build( (const tinybvh::bvhvec4*)corners, triangles );
	return layout;
}

template <class Layout> void trace( const void* layout, const Query* queries, size_t count, bool any, float* answers )
{
	const auto& bvh = *(const Layout*)layout;
	for (size_t i = 0; i < count; i++)
	{
		const auto& q = queries[i];
		tinybvh::Ray ray( tinybvh::bvhvec3( q.origin[0], q.origin[1], q.origin[2] ),
			tinybvh::bvhvec3( q.direction[0], q.direction[1], q.direction[2] ) );
		if (any) answers[i] = bvh.IsOccluded( ray ) ? 0.0f : INFINITY;
		else
		{
			bvh.Intersect( ray );
			answers[i] = ray.hit.t < BVH_FAR ? ray.hit.t : INFINITY;
		}
	}
}

}

extern "C" {

void* tinybvh4_build( const float* corners, uint32_t triangles ) { return build<tinybvh::BVH4_CPU>( corners, triangles ); }
void* tinybvh8_build( const float* corners, uint32_t triangles ) { return build<tinybvh::BVH8_CPU>( corners, triangles ); }
size_t tinybvh4_bytes( const void* layout ) { return ((const tinybvh::BVH4_CPU*)layout)->usedBlocks * size_t( 64 ); }
size_t tinybvh8_bytes( const void* layout ) { return ((const tinybvh::BVH8_CPU*)layout)->usedBlocks * size_t( 64 ); }
void tinybvh4_trace( const void* layout, const Query* queries, size_t count, bool any, float* answers )
{
	trace<tinybvh::BVH4_CPU>( layout, queries, count, any, answers );
}
void tinybvh8_trace( const void* layout, const Query* queries, size_t count, bool any, float* answers )
{
	trace<tinybvh::BVH8_CPU>( layout, queries, count, any, answers );
}

}
