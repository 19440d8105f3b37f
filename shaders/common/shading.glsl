// Light on cloth, linear in and out. docs/passes.md, "Light".

#ifdef SHADOWS
layout(binding = 2) uniform sampler2DShadow shadow_map;
// The mean of nine comparisons, a texel apart, each bilinear: together they weigh 4×4 texels by (1 − f, 1, 1, f) along each
// axis, f the place between two texels; four gathers fetch those.
float key_shadow(vec3 n) {
    vec3 p = shadow_place + n.x * shadow_steps[0].xyz + n.y * shadow_steps[1].xyz + n.z * shadow_steps[2].xyz;
    float texel = shadow_steps[0].w;
    vec2 place = p.xy / texel - 0.5, corner = floor(place), f = place - corner;
    // A gather where four texels meet takes them as (left, upper), (right, upper), (right, lower), (left, lower).
    vec4 a = textureGather(shadow_map, corner * texel, p.z), b = textureGather(shadow_map, (corner + vec2(2.0, 0.0)) * texel, p.z);
    vec4 c = textureGather(shadow_map, (corner + vec2(0.0, 2.0)) * texel, p.z), d = textureGather(shadow_map, (corner + 2.0) * texel, p.z);
    vec2 low = 1.0 - f;
    vec4 rows = vec4(low.x * a.w + a.z + b.w + f.x * b.z, low.x * a.x + a.y + b.x + f.x * b.y,
                     low.x * c.w + c.z + d.w + f.x * d.z, low.x * c.x + c.y + d.x + f.x * d.y);
    return (low.y * rows.x + rows.y + rows.z + f.y * rows.w) / 9.0;
}
#else
float key_shadow(vec3 n) { return 1.0; }
#endif

vec3 shoulder(vec3 x) {
    vec3 over = max(x - 0.8, 0.0);
    return min(x, 0.8) + 0.2 * over / (0.2 + over);
}

// N: the wrinkled normal, n: the surface's own, both toward the eye; v: to the eye; lost_slope: variance of the slope
// that a pixel is too coarse to show; occlusion: the share of the sky that is visible from a valley.
vec3 shade(vec3 albedo, vec3 N, vec3 n, vec3 v, float lost_slope, float occlusion) {
    float a2 = clamp(lit_from[0].w + lost_slope, 1e-3, 1.0);
    float Nv = dot(N, v), grazing = 1.0 - max(Nv, 0.0);
    vec3 up = vec3(lit_by[0].w, lit_by[1].w, lit_by[2].w);
    vec3 diffuse = ambient_light.rgb * (0.6 + 0.4 * dot(N, up)) * occlusion;
    vec3 shine = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        vec3 L = lit_from[i].xyz;
        float NL = dot(N, L), d = max(0.0, (NL + 0.15) * (1.0 / 1.15)) * smoothstep(-0.15, 0.25, dot(n, L));
        if (i == 0) d *= key_shadow(n);
        vec3 light = lit_by[i].rgb * (d * (i == 0 ? 0.5 + 0.5 * occlusion : occlusion));
        // H is not computed: with s = |L + v| = 2 L·H, N·H = (N·L + N·v)/s; D's denominator is multiplied by s⁴.
        float s2 = max(2.0 + 2.0 * dot(L, v), 1e-6), m = 1.0 - 0.5 * sqrt(s2), m2 = m * m;
        float NH_s = NL + Nv, q = NH_s * NH_s * (a2 - 1.0) + s2;
        diffuse += light;
        shine += light * (a2 * s2 * s2 * (0.04 + 0.96 * m2 * m2 * m) / (pi * q * q * max(s2, 0.4)));
    }
    vec3 fuzz = vec3(ambient_light.a * grazing * grazing * grazing);
    return shoulder((albedo + fuzz) * diffuse + shine);
}
