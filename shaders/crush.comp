// Crush (Loviscach 2006, 4.2 and 5.1): from a vertex and its neighbours before and after, the strength and direction of
// the strongest compression, and from these the wave's height and wavenumber. docs/passes.md, "Crush".
#include "common/items.glsl"
#include "common/surface.glsl"

layout(binding = 17) uniform samplerBuffer rest_rows;  // (S + μE)⁻¹ v_i, then v_i; an entry a neighbour
layout(binding = 18) uniform samplerBuffer biases;     // q: painted wrinkles of the rest pose; φ of a solved field, whether there is one
layout(binding = 19) uniform samplerBuffer carried;    // ĝ, unit: along which a carried field takes up the animation's part
layout(std430, binding = 0) writeonly buffer States { vec4 states_out[]; };
layout(std430, binding = 1) writeonly buffer Waves { vec4 waves_out[]; };
layout(std430, binding = 2) writeonly buffer WorldWaves { vec4 world_waves_out[]; };
layout(std430, binding = 3) writeonly buffer Phases { vec2 phases_out[]; };
layout(std430, binding = 4) buffer Counter { uint fresh_count, all_idle, any_height; };
uniform uint vertex_count;
uniform float dead_zone;
uniform bool always_set;  // relax mode `descent`
uniform bool unstrained;  // M = E: only the bias shortens
uniform bool carries;     // there is a carried field

const float floor_of_r = 0.05;         // r_min
const float isotropy = 0.01;           // below this g a direction is uncertain

void main() {
    uint v = item_index();
    if (v >= vertex_count) return;
    vec4 fixed_here = constant(v);
    vec3 x = position(v), n = frame_normal(v), t = frame_tangent(v), b = cross(n, t);

    // M = (Σ v'⊗v + μE)(S + μE)⁻¹ = E + Σ (v' − v)⊗(S + μE)⁻¹v, its rows in m0 and m1: errors are then in proportion to the
    // deformation, however slender the triangles.
    vec2 m0 = vec2(1.0, 0.0), m1 = vec2(0.0, 1.0);
    uint end = unstrained ? offset(v) : offset(v + 1u);
    for (uint i = offset(v); i < end; ++i) {
        vec3 e = position(neighbour(i)) - x;
        vec4 rest = texelFetch(rest_rows, int(i));
        m0 += (dot(t, e) - rest.z) * rest.xy;
        m1 += (dot(b, e) - rest.w) * rest.xy;
    }
    if (carries) {  // M(E + (1/|Mĝ| − 1) ĝ⊗ĝ): as long along ĝ as at rest
        vec2 along = texelFetch(carried, int(v)).xy, moved = vec2(dot(m0, along), dot(m1, along));
        vec2 more = (1.0 / max(length(moved), floor_of_r) - 1.0) * along;
        m0 += moved.x * more;
        m1 += moved.y * more;
    }
    vec4 bias = texelFetch(biases, int(v));
    vec2 q = bias.xy;  // M(E − q⊗q)
    m0 -= dot(m0, q) * q;
    m1 -= dot(m1, q) * q;
    float determinant = m0.x * m1.y - m0.y * m1.x;
    float sigma1 = 0.5 * (length(vec2(m0.x + m1.y, m1.x - m0.y)) + length(vec2(m0.x - m1.y, m0.y + m1.x)));
    float sigma2 = sigma1 > 0.0 ? abs(determinant) / sigma1 : 0.0;
    float r = sigma2;

    // The directions: v1 of the largest stretch by half angles, v2 of the smallest at right angles to it.
    float P = 0.5 * (m0.x * m0.x + m1.x * m1.x - m0.y * m0.y - m1.y * m1.y);
    float Q = m0.x * m0.y + m1.x * m1.y;
    float R = length(vec2(P, Q));
    vec2 v1 = vec2(1.0, 0.0);
    if (R > 0.0) {
        float half_angle = sqrt(0.5 * (1.0 + abs(P) / R));  // the larger of cos θ and sin θ: no cancellation
        float other = 0.5 * Q / (R * half_angle);
        v1 = P >= 0.0 ? vec2(half_angle, other) : vec2(abs(other), other < 0.0 ? -half_angle : half_angle);
    }
    vec2 v2 = vec2(-v1.y, v1.x);
    float squares = sigma1 * sigma1 + sigma2 * sigma2;
    float g = squares > 0.0 ? (sigma1 - sigma2) * (sigma1 + sigma2) / squares : 0.0;

    // k is set to the new direction the first time, and at a vertex that was idle; later it follows by the certainty of the
    // new direction (docs/contract.md, "State over time", rule 2).
    float status = phase(v).y;
    vec2 before = state(v).xy, k = before, toward = dot(k, v2) < 0.0 ? -v2 : v2;
    bool has_direction = dot(k, k) > 0.0 && (always_set || status != idle);
    if (has_direction) {
        k = normalize(k + min(g / isotropy, 1.0) * (toward - k));
    } else if (g > isotropy) {
        k = toward;
        has_direction = true;
    }

    vec2 u1 = sigma1 > 0.0 ? vec2(dot(m0, v1), dot(m1, v1)) / sigma1 : v1;
    vec2 u2 = determinant < 0.0 ? vec2(u1.y, -u1.x) : vec2(-u1.y, u1.x);
    vec2 direction = u1 * dot(v1, k) / max(sigma1, floor_of_r) + u2 * dot(v2, k) / max(sigma2, floor_of_r);

    float W = fixed_here.x, mask = fixed_here.y, s = 1.0 - r;
    float h_in_W = 0.25 * sqrt(max(s * (1.0 + r), 0.0)) * smoothstep(0.5 * dead_zone, dead_zone, s) * mask;
    if (h_in_W > 0.0) any_height = 1u;
    float weight = clamp((h_in_W - 0.0125) / 0.0625, 0.0, 1.0);
    vec2 wavenumber = direction / W;

    if (always_set) {
        status = set;
    } else {
        bool can_wave = mask > 0.0 && has_direction;
        if (status != idle && !(can_wave && s >= 0.5 * dead_zone)) status = idle;
        else if (status != idle || (can_wave && s > dead_zone)) {
            // A wave that begins within 45 degrees of the field's direction, or turns back there, is the field's; −k counts
            // its phase the other way.
            float along = dot(k, q), was = dot(before, q), limit = 0.5 * dot(q, q);
            if (bias.w > 0.0 && along * along >= limit && (status == idle || was * was < limit)) {
                status = set;
                phases_out[v].x = along < 0.0 ? -bias.z : bias.z;
            } else if (status == idle) {
                status = fresh;
            }
        }
        if (status == fresh) atomicAdd(fresh_count, 1u);
        if (status != idle) all_idle = 0u;
    }

    states_out[v] = vec4(k, s, g);
    waves_out[v] = vec4(wavenumber, h_in_W * W, weight);
    world_waves_out[v] = vec4(wavenumber.x * t + wavenumber.y * b, weight);
    phases_out[v].y = status;
}
