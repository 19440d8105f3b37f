// The posed tangent frames (t', b', n'): n' from the posed triangles, t' toward the neighbour that the rest pose chose.
// Part of the skin pass; docs/passes.md, "Skin".
#include "common/items.glsl"
#include "common/surface.glsl"

layout(std430, binding = 4) readonly buffer CornerOffsets { uint corner_offsets[]; };
layout(std430, binding = 6) readonly buffer Corners { uvec2 corners[]; };  // the triangle is (v, x, y)
layout(std430, binding = 9) readonly buffer TangentNeighbours { uint tangent_neighbours[]; };
uniform uint vertex_count;

void main() {
    uint v = item_index();
    if (v >= vertex_count) return;
    vec3 x = positions[v].xyz;
    vec3 area = vec3(0.0);
    float size = 0.0;
    for (uint i = corner_offsets[v]; i < corner_offsets[v + 1u]; ++i) {
        vec3 p = positions[corners[i].x].xyz - x, q = positions[corners[i].y].xyz - x;
        area += cross(p, q);
        size += sqrt(dot(p, p) * dot(q, q));
    }
    float magnitude = length(area);
    vec3 n = magnitude > 1e-6 * size ? area / magnitude : frames[v].normal.xyz;

    vec3 e = positions[tangent_neighbours[v]].xyz - x;
    vec3 t = e - dot(e, n) * n;
    if (dot(t, t) <= 1e-12 * dot(e, e)) {  // also where there is no neighbour: e = 0
        vec3 m = abs(n);
        vec3 axis = m.x <= m.y && m.x <= m.z ? vec3(1, 0, 0) : m.y <= m.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
        t = axis - dot(axis, n) * n;
    }
    frames[v].normal = vec4(n, 0.0);
    frames[v].tangent = vec4(normalize(t), 0.0);
}
