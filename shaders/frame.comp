// The posed tangent frames (t', b', n'): n' from the posed triangles, t' toward the neighbour that the rest pose chose.
// Part of the skin pass; docs/passes.md, "Skin".
#include "common/items.glsl"
#include "common/surface.glsl"

layout(binding = 17) uniform usamplerBuffer corner_offsets;
layout(binding = 18) uniform usamplerBuffer corners;             // the triangle is (v, x, y)
layout(binding = 19) uniform usamplerBuffer tangent_neighbours;
layout(std430, binding = 1) writeonly buffer Frames { vec4 frames_out[]; };
uniform uint vertex_count;

void main() {
    uint v = item_index();
    if (v >= vertex_count) return;
    vec3 x = position(v);
    vec3 area = vec3(0.0);
    float size = 0.0;
    int end = int(texelFetch(corner_offsets, int(v) + 1).x);
    for (int i = int(texelFetch(corner_offsets, int(v)).x); i < end; ++i) {
        uvec4 corner = texelFetch(corners, i);
        vec3 p = position(corner.x) - x, q = position(corner.y) - x;
        area += cross(p, q);
        size += sqrt(dot(p, p) * dot(q, q));
    }
    float magnitude = length(area);
    vec3 n = magnitude > 1e-6 * size ? area / magnitude : frame_normal(v);

    vec3 e = position(texelFetch(tangent_neighbours, int(v)).x) - x;
    vec3 t = e - dot(e, n) * n;
    if (dot(t, t) <= 1e-12 * dot(e, e)) {  // also where there is no neighbour: e = 0
        vec3 m = abs(n);
        vec3 axis = m.x <= m.y && m.x <= m.z ? vec3(1, 0, 0) : m.y <= m.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
        t = axis - dot(axis, n) * n;
    }
    frames_out[2u * v] = vec4(n, 0.0);
    frames_out[2u * v + 1u] = vec4(normalize(t), 0.0);
}
