// Light on cloth, linear in and out. docs/passes.md, "Light".
#include "common/scene.glsl"

#ifdef SHADOWS
layout(binding = 2) uniform sampler2DShadow shadow_map;
// Nine comparisons, a texel apart, each bilinear.
float key_shadow(vec3 x, vec3 n) {
    vec3 p = (shadow_matrix * vec4(x + 1.5 * shadow_texel.y * n, 1.0)).xyz;
    p.z -= shadow_texel.z;
    float sum = 0.0;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) sum += texture(shadow_map, vec3(p.xy + vec2(i, j) * shadow_texel.x, p.z));
    return sum / 9.0;
}
#else
float key_shadow(vec3 x, vec3 n) { return 1.0; }
#endif

vec3 shoulder(vec3 x) { return mix(x, 0.8 + 0.2 * (1.0 - exp((0.8 - x) / 0.2)), greaterThan(x, vec3(0.8))); }

// N: the wrinkled normal, n: the surface's own, both toward the eye; v: to the eye; lost_slope: variance of the slope
// that a pixel is too coarse to show; occlusion: how much of the sky a valley sees.
vec3 shade(vec3 albedo, vec3 x, vec3 N, vec3 n, vec3 v, float lost_slope, float occlusion) {
    float a2 = clamp(surface.x + lost_slope, 1e-3, 1.0);
    float facing = max(dot(N, v), 0.0);
    float grazing = 1.0 - facing;
    vec3 diffuse = ambient.rgb * (0.6 + 0.4 * dot(N, up.xyz)) * occlusion;
    vec3 shine = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        vec3 L = lights[i].direction.xyz;
        float d = max(0.0, (dot(N, L) + 0.15) * (1.0 / 1.15)) * smoothstep(-0.15, 0.25, dot(n, L));
        if (i == 0) d *= key_shadow(x, n);
        vec3 light = lights[i].colour.rgb * (d * (i == 0 ? 0.5 + 0.5 * occlusion : occlusion));
        vec3 H = normalize(L + v);
        float NH = dot(N, H), LH = dot(L, H), LH2 = LH * LH, m = 1.0 - LH, m2 = m * m;
        float q = NH * NH * (a2 - 1.0) + 1.0;
        diffuse += light;
        shine += light * (a2 / (pi * q * q) * (0.04 + 0.96 * m2 * m2 * m) / (4.0 * max(LH2, 0.1)));
    }
    vec3 fuzz = vec3(ambient.a * grazing * grazing * grazing);
    return shoulder((albedo + fuzz) * diffuse + shine);
}
