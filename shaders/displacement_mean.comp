// Displacement, vertices: the mean of the results of the triangles around a vertex. By define: PLACES, a position's place and
// relief; NORMALS, a vertex's normal, which those across a hard edge do not share. docs/passes.md, "Displacement".
#include "common/items.glsl"

layout(binding = 17) uniform usamplerBuffer offsets;  // entry i of row v of the list lies at offset(v) ≤ i < offset(v + 1)
layout(binding = 18) uniform usamplerBuffer points;   // the points that are one vertex
layout(binding = 19) uniform samplerBuffer places;    // X; height
layout(binding = 20) uniform samplerBuffer normals;   // N; amplitude
#ifdef PLACES
layout(binding = 21) uniform samplerBuffer skies;
layout(binding = 22) uniform samplerBuffer rest;      // x' of the welded vertices: for those of no triangle
layout(std430, binding = 0) writeonly buffer Positions { vec4 positions_out[]; };
layout(std430, binding = 1) writeonly buffer Reliefs { vec4 reliefs_out[]; };
layout(std430, binding = 2) buffer Counter { uint not_finite; };
#else
layout(binding = 21) uniform usamplerBuffer shared_normals;  // which row a vertex takes
layout(std430, binding = 0) buffer RenderVertices { vec4 render_vertices[]; };  // two each, the first's w is u
#endif
uniform uint count;

void main() {
    uint v = item_index();
    if (v >= count) return;
#ifdef PLACES
    uint row = v;
#else
    uint row = texelFetch(shared_normals, int(v)).x;
#endif
    uint begin = texelFetch(offsets, int(row)).x, end = texelFetch(offsets, int(row) + 1).x;
    vec4 place = vec4(0.0), normal = vec4(0.0);
#ifdef PLACES
    vec2 sky = vec2(0.0);
#endif
    for (uint i = begin; i < end; ++i) {
        int point = int(texelFetch(points, int(i)).x);
        normal += texelFetch(normals, point);
#ifdef PLACES
        place += texelFetch(places, point);
        sky += texelFetch(skies, point).xy;
#endif
    }
#ifdef PLACES
    float share = 1.0 / float(max(end - begin, 1u));
    positions_out[v] = begin < end ? vec4(share * place.xyz, 1.0) : vec4(texelFetch(rest, int(v)).xyz, 1.0);
    reliefs_out[v] = begin < end ? share * vec4(place.w, normal.w, sky) : vec4(0.0, 0.0, 1.0, 1.0);
    vec4 all = place + vec4(0.0, 0.0, 0.0, normal.w);
    if (any(isnan(all)) || any(isinf(all))) atomicAdd(not_finite, 1u);
#else
    float len = length(normal.xyz);
    render_vertices[2u * v].xyz = len > 0.0 && !isinf(len) ? normal.xyz / len : vec3(0.0, 1.0, 0.0);
#endif
}
