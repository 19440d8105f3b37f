// Render, pixels (Loviscach 2006, 6): the height field of the three waves bends the normal (eq. 7, 8) and shifts the
// texture (eq. 10, 11). docs/passes.md, "Render". By define: PLAIN, the same surface without waves; DISPLACED, with PLAIN,
// one whose waves are geometry; SINUSOID, whose profile needs no table; FIELD, a solved wrinkle field besides; ALPHA, for
// materials that are masked or blended (a discard, though never taken, costs 8 %); TEXTURED, NORMAL_MAP and VERTEX_COLOURS, for
// those that have them; FADED, where every wave is shorter than two pixels; FIELD_ALONE, with FIELD, where no other wave has a
// height.
#include "common/constants.glsl"

#if defined(TEXTURED) || defined(NORMAL_MAP)
#define PARALLAX
#endif
#define INTERFACE in
#define FLAT flat in
#include "common/render_io.glsl"
#include "common/shading.glsl"

#ifdef TEXTURED
layout(binding = 0) uniform sampler2D base_colour_map;
#endif
#ifdef NORMAL_MAP
layout(binding = 5) uniform sampler2D normal_map;
#endif
#ifdef ALPHA
uniform float alpha_cutoff;   // below it nothing is drawn
uniform bool has_alpha;
#endif
layout(location = 0) out vec4 colour;
#ifdef AOV
uniform int aov;              // one of AOV_…, which src/passes/aov.cpp lists
uniform float object;
uniform vec3 view_forward;
#endif

#ifndef PLAIN
#include "common/waves.glsl"

struct Wrinkle {
    float height;
    vec3 gradient;
    float amplitude;   // Σ w h fade
    float lost_slope;  // Σ w ½(2πh|κ|)² m (1 − fade²)
};

#ifdef FIELD
// The carried field: amplitude and phase are blended before the cosine is taken, so that any number of waves fits into a
// triangle. The amplitude is linear: blended weights, flat at every corner, would make steps of it.
void add_field(inout Wrinkle result, Weights at, vec3 b) {
    vec2 turns_per_pixel = vec2(dot(at.w, dFdx(field_tau)), dot(at.w, dFdy(field_tau)));
    float fade = 1.0 - smoothstep(0.25, 0.5, length(turns_per_pixel));
    float amplitude = dot(b, field_amplitude), turns = dot(at.w, field_tau);
    vec3 slope = at.w.x * field_slope_a + at.w.y * field_slope_b + at.w.z * field_slope_c +
                 blend_gradient(at, b, field_tau);
    float phase = 2.0 * pi * (turns - floor(turns + 0.5)), steep = 2.0 * pi * amplitude;
    result.height += fade * amplitude * cos(phase);
    result.gradient += fade * (cos(phase) * linear_gradient(field_amplitude) - steep * sin(phase) * slope);
    result.amplitude += fade * amplitude;
    result.lost_slope += 0.5 * steep * steep * dot(slope, slope) * (1.0 - fade * fade);
}
#endif

#ifdef FADED
// Waves that are too short for the normal: the variance of their slopes, for the roughness.
Wrinkle wrinkle_at(vec3 b) {
#ifdef FINE_WAVES
    vec3 lost = vec3(COARSE_SHARE * COARSE_SHARE + FINE_SHARE * FINE_SHARE * FINE_WAVES * FINE_WAVES);
#else
    vec3 lost = vec3(1.0);
#endif
    return Wrinkle(0.0, vec3(0.0), 0.0, dot(weights_at(b).w, steepness.xyz * lost));
}
#elif defined(FIELD_ALONE)
Wrinkle wrinkle_at(vec3 b) {
    Wrinkle result = Wrinkle(0.0, vec3(0.0), 0.0, 0.0);
    add_field(result, weights_at(b), b);
    return result;
}
#else
Wrinkle wrinkle_at(vec3 b) {
    vec3 dx = dFdx(tau), dy = dFdy(tau);
    vec3 turns_per_pixel = sqrt(dx * dx + dy * dy);
    vec3 fade = 1.0 - smoothstep(0.25, 0.5, turns_per_pixel);
    vec3 h = heights.xyz * fade, lost = 1.0 - fade * fade, fine_fade = vec3(0.0), shape, climb;
#ifdef FINE_WAVES
    fine_fade = 1.0 - smoothstep(0.25, 0.5, FINE_WAVES * turns_per_pixel);
    h = COARSE_SHARE * h + FINE_SHARE * heights.xyz * fine_fade;
    lost = COARSE_SHARE * COARSE_SHARE * lost +
           FINE_SHARE * FINE_SHARE * FINE_WAVES * FINE_WAVES * (1.0 - fine_fade * fine_fade);
#endif
    shapes(tau, fade, fine_fade, shape, climb);
    vec3 H = heights.xyz * shape;

    Weights weights_here = weights_at(b);
    vec3 w = weights_here.w;
    vec3 ws = w * climb;
    Wrinkle result;
    result.height = dot(w, H);
    result.gradient = ws.x * climb_a + ws.y * climb_b + ws.z * climb_c;
#ifdef FULL_GRADIENT
    result.gradient += blend_gradient(weights_here, b, H);
#endif
    result.amplitude = dot(w, h);
    result.lost_slope = dot(w, steepness.xyz * lost);
#ifdef FIELD
    add_field(result, weights_here, b);
#endif
    return result;
}
#endif
#endif

#ifdef NORMAL_MAP
// The unit direction in which a coordinate with gradient g grows along the surface.
vec3 growth(vec3 g, vec3 n) {
    vec3 along_surface = g - dot(g, n) * n;
    return along_surface * inversesqrt(max(dot(along_surface, along_surface), 1e-30));
}
#endif

#ifdef AOV
// Mean curvature at x, whose unit normal is N, from their differences between pixels: half the trace of I⁻¹ II for the
// map from the picture to the surface. Positive where the surface bulges toward the side that N points to.
float mean_curvature(vec3 x, vec3 N) {
    vec3 x_u = dFdx(x), x_v = dFdy(x), N_u = dFdx(N), N_v = dFdy(N);
    float E = dot(x_u, x_u), F = dot(x_u, x_v), G = dot(x_v, x_v);
    float e = dot(N_u, x_u), f = 0.5 * (dot(N_u, x_v) + dot(N_v, x_u)), g = dot(N_v, x_v);
    return 0.5 * (e * G - 2.0 * f * F + g * E) / max(E * G - F * F, 1e-30);
}
#endif

float texture_level(vec2 across, vec2 down) {
    return 0.5 * log2(max(max(dot(across, across), dot(down, down)), 1e-12));
}

void main() {
    vec3 v = normalize(to_eye);
    float side = dot(plane, to_eye) < 0.0 ? -1.0 : 1.0;
    vec3 n = normalize(normal), ns = side * n, N = ns;
    float lost_slope = 0.0, occlusion = 1.0;
#ifdef DISPLACED
    occlusion = side > 0.0 ? relief_here.z : relief_here.w;
#endif
#ifdef TEXTURED
    vec2 at = uv;
    float level = texture_level(dFdx(uv) * texels, dFdy(uv) * texels);
#endif
#ifdef NORMAL_MAP
    float normal_level = texture_level(dFdx(normal_uv) * relief.xy, dFdy(normal_uv) * relief.xy);
    vec3 gradient = vec3(0.0);
    vec2 normal_at = normal_uv;
#endif
#ifndef PLAIN
    vec3 b = vec3(1.0 - weights.x - weights.y, weights);
    Wrinkle wrinkle = Wrinkle(0.0, vec3(0.0), 0.0, 0.0);
#ifdef FIELD
    if (heights.x + heights.y + heights.z + field_amplitude.x + field_amplitude.y + field_amplitude.z > 0.0) {
#else
    if (heights.x + heights.y + heights.z > 0.0) {
#endif
        wrinkle = wrinkle_at(b);
        N = side * normalize(n - wrinkle.gradient);
        lost_slope = wrinkle.lost_slope;
        float height = side * wrinkle.height;
        if (wrinkle.amplitude > 0.0) {
            float steep = wrinkle.amplitude * steepness.w;
            float depth = clamp(0.5 - 0.5 * height / wrinkle.amplitude, 0.0, 1.0);
            occlusion = max(0.0, 1.0 - lit_from[1].w * depth * (1.0 - inversesqrt(1.0 + steep * steep)));
        }
#ifdef PARALLAX
        float c = dot(v, ns);
        vec3 shift = (v - c * ns) * (c / (c * c + 0.1) * height * lit_from[2].w * smoothstep(0.0, 0.2, c));
        shift *= min(1.0, heights.w * inversesqrt(max(dot(shift, shift), 1e-30)));
#endif
#ifdef TEXTURED
        at += vec2(dot(gradient_u, shift), dot(gradient_v, shift));
#endif
#ifdef NORMAL_MAP
        gradient = wrinkle.gradient;
        normal_at += vec2(dot(gradient_normal_u, shift), dot(gradient_normal_v, shift));
#endif
    }
#endif
#ifdef NORMAL_MAP
    vec3 m = 2.0 * textureLod(normal_map, normal_at, normal_level).xyz - 1.0;
    m = vec3(relief.z * m.xy, max(m.z, 0.05));
    N = side * normalize(m.z * (n - gradient) + m.x * growth(gradient_normal_u, n) + m.y * growth(gradient_normal_v, n));
#endif
    vec4 albedo = base;
#ifdef TEXTURED
    albedo *= textureLod(base_colour_map, at, level);
#endif
#ifdef VERTEX_COLOURS
    albedo *= tint;
#endif
    float alpha = 1.0;
#ifdef ALPHA
    if (albedo.a < alpha_cutoff) discard;
    if (has_alpha) alpha = albedo.a;
#endif
#ifdef AOV
    colour = vec4(0.0, 0.0, 0.0, 1.0);
    if (aov == AOV_NORMAL) colour.rgb = N;
    if (aov == AOV_DEPTH) colour.rgb = vec3(-dot(to_eye, view_forward));
    if (aov == AOV_OBJECT) colour.rgb = vec3(object);
    vec3 drawn = -to_eye;
#ifndef PLAIN
    drawn += wrinkle.height * n;
#endif
    float curvature = mean_curvature(drawn, N);
    if (aov == AOV_CURVATURE) colour.rgb = vec3(curvature);
#ifdef DISPLACED
    if (aov == AOV_HEIGHT) colour.rgb = vec3(relief_here.x);
    if (aov == AOV_AMPLITUDE) colour.rgb = vec3(relief_here.y);
#endif
#ifndef PLAIN
    if (aov == AOV_HEIGHT) colour.rgb = vec3(wrinkle.height);
    if (aov == AOV_AMPLITUDE) colour.rgb = vec3(wrinkle.amplitude);
    // Phase and direction are those of the wave with the largest weight here.
    float most = max(b.x, max(b.y, b.z));
    bool first = b.x == most, second = !first && b.y == most;
    float own = first ? tau.x : second ? tau.y : tau.z;
    vec3 wavenumber = first ? wavenumber_a : second ? wavenumber_b : wavenumber_c;
    if (aov == AOV_PHASE) colour.rgb = vec3(2.0 * pi * (own - ceil(own - 0.5)));
    if (aov == AOV_DIRECTION && dot(wavenumber, wavenumber) > 0.0) colour.rgb = normalize(wavenumber);
    if (aov == AOV_TENSION) colour.rgb = vec3(tension);
#endif
#else
    colour = vec4(shade(albedo.rgb, N, ns, v, lost_slope, occlusion) * alpha, alpha);
#endif
}
