// Displacement, points: each point of a finer surface, computed in one of the triangles that were split, moved along the
// normal by the height field, with the normal of the moved surface there, and the visible share of the sky. Points
// that triangles share come once for each; displacement_mean.comp takes them together. docs/passes.md, "Displacement"
// (v2 of Chen et al. 2021 with FIELD).
#include "common/items.glsl"
#include "common/surface.glsl"

layout(binding = 17) uniform usamplerBuffer corners;         // render vertex, welded vertex; three a triangle
layout(binding = 18) uniform samplerBuffer render_vertices;  // rest normal as components of (t, b, n), …
layout(binding = 19) uniform usamplerBuffer points;          // triangle; segments toward its second and third corner, and in all
#ifdef FIELD
layout(binding = 20) uniform samplerBuffer field;            // a corner each: its turns at the three corners, amplitude
#endif
layout(std430, binding = 0) writeonly buffer Places { vec4 places_out[]; };    // X; height
layout(std430, binding = 1) writeonly buffer Normals { vec4 normals_out[]; };  // N; amplitude
layout(std430, binding = 2) writeonly buffer Skies { vec2 skies_out[]; };      // from in front, from behind
uniform uint point_count;
uniform float cavity;

vec3 along, gradient_beta, gradient_gamma;
#define CORNERS
#include "common/waves.glsl"

const float steepest = 0.05;  // the plane of a triangle against the interpolated normal: beyond 87° eq. 7 is all there is

vec3 safe_divide(vec3 p, float q) { return q > 0.0 ? p / q : vec3(0.0); }

float sky(float amplitude, float height, float steep) {
    if (!(amplitude > 0.0)) return 1.0;
    float depth = clamp(0.5 - 0.5 * height / amplitude, 0.0, 1.0);
    return max(0.0, 1.0 - cavity * depth * (1.0 - inversesqrt(1.0 + steep * steep)));
}

vec3 perpendicular(vec3 n) {
    vec3 a = abs(n);
    vec3 axis = a.x <= a.y && a.x <= a.z ? vec3(1.0, 0.0, 0.0) : a.y <= a.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    return normalize(cross(n, axis));
}

void main() {
    uint item = item_index();
    if (item >= point_count) return;
    uvec2 point = texelFetch(points, int(item)).xy;
    int first = 3 * int(point.x);
    vec2 steps = vec2(point.y & 1023u, point.y >> 10u & 1023u);
    float segments = float(point.y >> 20u);
    vec3 b = vec3(segments - steps.x - steps.y, steps) / segments;

    vec3 p[3], directions[3], wavenumbers[3], n = vec3(0.0), h, start;
    for (int i = 0; i < 3; ++i) {
        uvec2 ids = texelFetch(corners, first + i).xy;
        uint id = ids.y;
        p[i] = position(id);
        vec3 t = frame_tangent(id), own = texelFetch(render_vertices, 2 * int(ids.x)).xyz;
        directions[i] = frame_normal(id);
        vec3 side = cross(directions[i], t);
        n += b[i] * (own.x * t + own.y * side + own.z * directions[i]);
        vec4 its = wave(id);
        wavenumbers[i] = its.x * t + its.y * side;
        h[i] = its.xy == vec2(0.0) ? 0.0 : its.z;
        start[i] = phase(id).x * (0.5 / pi) + dot(state(id).xy, constant(id).zw);
    }
    float n_length = length(n);
    n = n_length > 0.0 ? n / n_length : vec3(0.0);  // opposite normals have no mean
    vec3 ab = p[1] - p[0], ac = p[2] - p[0], bc = p[2] - p[1], area = cross(ab, ac);
    float square = dot(area, area);
    gradient_beta = safe_divide(cross(ac, area), square);
    gradient_gamma = safe_divide(cross(area, ab), square);
    along = vec3(safe_divide(vec3(dot(-ab, bc)), dot(bc, bc)).x, safe_divide(vec3(dot(bc, ac)), dot(ac, ac)).x,
                 safe_divide(vec3(dot(ac, ab)), dot(ab, ab)).x);

    // From each corner to the point, without what they have in common.
    vec3 from_a = b.y * ab + b.z * ac;
    vec3 turns = start + vec3(dot(wavenumbers[0], from_a), dot(wavenumbers[1], from_a - ab), dot(wavenumbers[2], from_a - ac));
    vec3 shape, climb;
    shapes(turns, vec3(1.0), vec3(1.0), shape, climb);
    Weights at = weights_at(b);
    vec3 steep = at.w * climb * (2.0 * pi) * h;
    float height = dot(at.w, h * shape);
    vec3 gradient = steep.x * wavenumbers[0] + steep.y * wavenumbers[1] + steep.z * wavenumbers[2] +
                    blend_gradient(at, b, h * shape);
#ifdef FINE_WAVES
    float amplitude = (COARSE_SHARE + FINE_SHARE) * dot(at.w, h);
#else
    float amplitude = dot(at.w, h);
#endif
    vec3 squares = vec3(dot(wavenumbers[0], wavenumbers[0]), dot(wavenumbers[1], wavenumbers[1]),
                        dot(wavenumbers[2], wavenumbers[2]));
#ifdef FIELD
    squares *= vec3(greaterThan(h, vec3(0.0)));  // beside a field waves without height count for nothing
#endif
    float largest = sqrt(max(squares.x, max(squares.y, squares.z)));

    vec3 sliding = vec3(0.0), slide_direction = vec3(0.0), slide_climb = vec3(0.0);  // Δ; its derivative as an outer product
#ifdef FIELD
    vec3 field_turns, field_amplitude, slopes[3];
    for (int i = 0; i < 3; ++i) {
        vec4 its = texelFetch(field, first + i);
        field_turns[i] = dot(b, its.xyz);
        field_amplitude[i] = its.w;
        slopes[i] = (its.y - its.x) * gradient_beta + (its.z - its.x) * gradient_gamma;
        largest = max(largest, length(slopes[i]));
    }
    float A = dot(b, field_amplitude), theta = dot(at.w, field_turns);
    if (A > 0.0) {
        vec3 slope = at.w.x * slopes[0] + at.w.y * slopes[1] + at.w.z * slopes[2] + blend_gradient(at, b, field_turns);
        vec3 swell = linear_gradient(field_amplitude);
        float angle = 2.0 * pi * (theta - floor(theta + 0.5)), c = cos(angle), s = sin(angle);
        height += A * c;
        amplitude += A;
        gradient += c * swell - 2.0 * pi * A * s * slope;
        float sin2 = 2.0 * s * c, cos2 = c * c - s * s;
        slide_direction = 2.0 * pi * slope;
        float share = min(0.125, 0.5 / max(A * A * dot(slide_direction, slide_direction), 1e-9));  // against folding over
        sliding = share * A * A * sin2 * slide_direction;
        slide_climb = 2.0 * share * A * (sin2 * swell + A * cos2 * slide_direction);
    }
#endif

    vec3 mean = b.x * directions[0] + b.y * directions[1] + b.z * directions[2];
    float len = length(mean);
    vec3 d = len > 0.0 ? mean / len : vec3(0.0);
    vec3 N = normalize(n - gradient);  // eq. 7
    vec3 plane = square > 0.0 ? area * inversesqrt(square) : vec3(0.0);
    float upright = dot(n, plane);
    if (abs(upright) >= steepest && len > 0.0) {
        vec3 t1 = perpendicular(n), t2 = cross(n, t1), moved[2];
        for (int i = 0; i < 2; ++i) {
            vec3 t = i == 0 ? t1 : t2;
            vec3 e = t - dot(t, plane) / upright * n;  // in the triangle's plane, above t
            float beta = dot(gradient_beta, e), gamma = dot(gradient_gamma, e);
            vec3 turning = beta * (directions[1] - directions[0]) + gamma * (directions[2] - directions[0]);
            vec3 bend = (turning - dot(d, turning) * d) / len;  // ∂d/∂e
            vec3 slide = slide_direction * dot(slide_climb, e);
            moved[i] = t + slide - dot(n, slide) * n + dot(gradient, e) * n + height * (bend - dot(n, bend) * n);
        }
        vec3 normal = cross(moved[0], moved[1]);
        if (dot(normal, n) > 0.0) N = normalize(normal);
    }
    if (!(dot(N, N) > 0.5 && dot(N, N) < 2.0)) N = vec3(0.0);  // not a number either: the other triangles decide
    places_out[item] = vec4(p[0] + from_a + sliding + height * d, height);
    normals_out[item] = vec4(N, amplitude);
    float groove = 2.0 * pi * amplitude * largest;
    skies_out[item] = vec2(sky(amplitude, height, groove), sky(amplitude, -height, groove));
}
