// Skin (Loviscach 2006, 4.1): x' = Σ αₖ Mₖ (x + Σ m δ), and the normal of the blended matrix as a fallback where the
// posed triangles give none (frame.comp). docs/passes.md, "Skin".
#include "common/items.glsl"
#include "common/surface.glsl"

struct Influences {
    uvec4 entries[2];  // palette entries, strongest first
    vec4 weights[2];   // sum 1; zero ends the list
};
layout(std430, binding = 4) readonly buffer Bind { vec4 bind_points[]; };
layout(std430, binding = 6) readonly buffer BindNormals { vec4 bind_normals[]; };
layout(std430, binding = 9) readonly buffer InfluenceList { Influences influences[]; };
layout(std430, binding = 11) readonly buffer TargetDeltas { vec4 target_deltas[]; };  // [target · V + v]
layout(std430, binding = 12) readonly buffer TargetWeights { float target_weights[]; };
// Rows of the 3×4 matrices. A uniform block is half again as fast as a storage buffer, but holds only so many.
#ifdef PALETTE_IN_UNIFORMS
layout(std140, binding = 0) uniform Palette { vec4 palette[3 * PALETTE_IN_UNIFORMS]; };
#else
layout(std430, binding = 13) readonly buffer Palette { vec4 palette[]; };
#endif
uniform uint vertex_count;
uniform uint target_count;

void main() {
    uint v = item_index();
    if (v >= vertex_count) return;
    vec3 x = bind_points[v].xyz;
    for (uint t = 0u; t < target_count; ++t) x += target_weights[t] * target_deltas[t * vertex_count + v].xyz;

    vec4 row0 = vec4(0.0), row1 = vec4(0.0), row2 = vec4(0.0);
    for (int i = 0; i < 8; ++i) {
        float weight = influences[v].weights[i >> 2][i & 3];
        if (weight == 0.0) break;
        uint entry = 3u * influences[v].entries[i >> 2][i & 3];
        row0 += weight * palette[entry];
        row1 += weight * palette[entry + 1u];
        row2 += weight * palette[entry + 2u];
    }
    positions[v] = vec4(dot(row0, vec4(x, 1.0)), dot(row1, vec4(x, 1.0)), dot(row2, vec4(x, 1.0)), 1.0);

    // The cofactor matrix is det · inverse transpose; it needs no inverse, so it stays finite where det = 0, and it turns
    // over under a mirror as the triangles do. Its rows are the cross products of the matrix's rows.
    vec3 n = bind_normals[v].xyz;
    vec3 cofactor0 = cross(row1.xyz, row2.xyz), cofactor1 = cross(row2.xyz, row0.xyz), cofactor2 = cross(row0.xyz, row1.xyz);
    vec3 turned = vec3(dot(cofactor0, n), dot(cofactor1, n), dot(cofactor2, n));
    float size = length(turned);
    frames[v].normal = vec4(size > 0.0 ? turned / size : n, 0.0);
}
