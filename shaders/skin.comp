// Skin (Loviscach 2006, 4.1): x' = Σ αₖ Mₖ (x + Σ m δ), and the normal of the blended matrix as a fallback where the
// posed triangles give none (frame.comp). docs/passes.md, "Skin".
#include "common/items.glsl"
#include "common/surface.glsl"

layout(binding = 17) uniform samplerBuffer bind_places;     // point, normal of a vertex, one after the other
layout(binding = 18) uniform usamplerBuffer influences;     // of a vertex: eight palette entries, strongest first, then
                                                            // eight weights as bits; sum 1, zero ends the list
layout(binding = 19) uniform samplerBuffer target_deltas;   // [target · V + v]
layout(binding = 20) uniform samplerBuffer palette;         // rows of the 3×4 matrices
layout(std430, binding = 0) writeonly buffer Positions { vec4 positions_out[]; };
layout(std430, binding = 1) writeonly buffer Frames { vec4 frames_out[]; };
layout(std430, binding = 2) readonly buffer TargetWeights { float target_weights[]; };
uniform uint vertex_count;
uniform uint target_count;

void main() {
    uint v = item_index();
    if (v >= vertex_count) return;
    vec3 x = texelFetch(bind_places, 2 * int(v)).xyz;
    for (uint t = 0u; t < target_count; ++t) x += target_weights[t] * texelFetch(target_deltas, int(t * vertex_count + v)).xyz;

    vec4 row0 = vec4(0.0), row1 = vec4(0.0), row2 = vec4(0.0);
    for (int half_list = 0; half_list < 2; ++half_list) {
        uvec4 entries = texelFetch(influences, 4 * int(v) + half_list);
        vec4 weights = uintBitsToFloat(texelFetch(influences, 4 * int(v) + 2 + half_list));
        if (weights.x == 0.0) break;
        for (int i = 0; i < 4; ++i) {
            int entry = 3 * int(entries[i]);
            row0 += weights[i] * texelFetch(palette, entry);
            row1 += weights[i] * texelFetch(palette, entry + 1);
            row2 += weights[i] * texelFetch(palette, entry + 2);
        }
    }
    positions_out[v] = vec4(dot(row0, vec4(x, 1.0)), dot(row1, vec4(x, 1.0)), dot(row2, vec4(x, 1.0)), 1.0);

    // The cofactor matrix is det · inverse transpose; it needs no inverse, so it stays finite where det = 0, and it turns
    // over under a mirror as the triangles do. Its rows are the cross products of the matrix's rows.
    vec3 n = texelFetch(bind_places, 2 * int(v) + 1).xyz;
    vec3 cofactor0 = cross(row1.xyz, row2.xyz), cofactor1 = cross(row2.xyz, row0.xyz), cofactor2 = cross(row0.xyz, row1.xyz);
    vec3 turned = vec3(dot(cofactor0, n), dot(cofactor1, n), dot(cofactor2, n));
    float size = length(turned);
    frames_out[2u * v] = vec4(size > 0.0 ? turned / size : n, 0.0);
}
