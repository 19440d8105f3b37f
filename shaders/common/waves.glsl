// The three waves of a triangle at one of its points: profile, weights of the blend and their gradients (docs/passes.md,
// "Render"). Who includes this has `along` (c_A, c_B, c_C: where the opposite corner projects onto an edge) and the gradients of
// β and γ in the triangle's plane, `gradient_beta` and `gradient_gamma`. By define: LINEAR_BLEND, SINUSOID, FINE_WAVES;
// CORNERS, where corners themselves are asked for.
layout(binding = 1) uniform sampler1D profile;  // f, f' over one period

// f and f' of three waves at their phases, turns.
void look_up(vec3 turns, out vec3 f, out vec3 slope) {
#ifdef SINUSOID
    // cos and −sin of 2πx within half a turn, as polynomials of Chebyshev interpolation, good to 1e-6.
    vec3 x = turns - floor(turns + 0.5), u = x * x;
    f = 0.9999992 + u * (-19.7389782 + u * (64.9285878 + u * (-85.2708436 + u * (58.7869408 - u * 21.0654294))));
    slope = -x * (6.2831849 + u * (-41.3415883 + u * (81.5999136 + u * (-76.6141403 + u * (41.3413654 - u * 12.4688186)))));
#else
    vec3 place = turns + 0.5 / float(textureSize(profile, 0));  // entry i is f at i/N turns, and texels are found by their middles
    vec2 a = textureLod(profile, place.x, 0.0).rg, b = textureLod(profile, place.y, 0.0).rg, c = textureLod(profile, place.z, 0.0).rg;
    f = vec3(a.x, b.x, c.x);
    slope = vec3(a.y, b.y, c.y);
#endif
}

// H_j/h_j and the climb that D_j = 2π h_j climb_j κ_j has, of waves that fade and their finer ones (FINE_WAVES).
void shapes(vec3 turns, vec3 fade, vec3 fine_fade, out vec3 shape, out vec3 climb) {
    look_up(turns, shape, climb);
    shape *= fade;
    climb *= fade;
#ifdef FINE_WAVES
    vec3 f, slope;
    look_up(FINE_WAVES * turns, f, slope);
    shape = COARSE_SHARE * shape + FINE_SHARE * fine_fade * f;
    climb = COARSE_SHARE * climb + FINE_SHARE * FINE_WAVES * fine_fade * slope;
#endif
}

float rise(float s, out float slope) {  // S and S'
    s = clamp(s, 0.0, 1.0);
    slope = 6.0 * s * (1.0 - s);
    return s * s * (3.0 - 2.0 * s);
}

// The weights of the three waves, and what their gradients are made of.
struct Weights {
    vec3 w;
#ifndef LINEAR_BLEND
    vec3 edge, product, s, slope;  // e_AB, e_BC, e_CA over E; αβ, βγ, γα; S and S' along each edge
    float scale;
#endif
};

Weights weights_at(vec3 b) {
    Weights at;
#ifdef LINEAR_BLEND
    at.w = b;
#else
    at.s.x = rise(b.y + b.z * along.z, at.slope.x);
    at.s.y = rise(b.z + b.x * along.x, at.slope.y);
    at.s.z = rise(b.x + b.y * along.y, at.slope.z);
    at.product = b * b.yzx;
    vec3 edge = at.product * at.product;
    at.scale = 1.0 / (edge.x + edge.y + edge.z + 1e-20);
    at.edge = edge * at.scale;
    at.w = vec3(at.edge.x * (1.0 - at.s.x) + at.edge.z * at.s.z, at.edge.y * (1.0 - at.s.y) + at.edge.x * at.s.x,
                at.edge.z * (1.0 - at.s.z) + at.edge.y * at.s.y);
#ifdef CORNERS
    if (max(b.x, max(b.y, b.z)) == 1.0) at.w = b;  // what they tend to where no edge has a share
#endif
#endif
    return at;
}

// Of values that are linear in the triangle.
vec3 linear_gradient(vec3 corners) {
    return (corners.y - corners.x) * gradient_beta + (corners.z - corners.x) * gradient_gamma;
}

// Σ H_j ∇w_j.
vec3 blend_gradient(Weights at, vec3 b, vec3 H) {
#ifdef LINEAR_BLEND
    vec3 change = H;  // ∂(Σ w H)/∂(α, β, γ)
#else
    float blend = dot(at.w, H);
    // Of Σ e D/E: the edges' own blends D against the whole, and the motion along each edge.
    vec3 D = vec3(mix(H.x, H.y, at.s.x), mix(H.y, H.z, at.s.y), mix(H.z, H.x, at.s.z)) - blend;
    vec3 twice = 2.0 * at.scale * at.product * D;
    vec3 motion = at.edge * vec3(at.slope.x * (H.y - H.x), at.slope.y * (H.z - H.y), at.slope.z * (H.x - H.z));
    vec3 change = vec3(twice.x * b.y + twice.z * b.z + motion.y * along.x + motion.z,
                       twice.x * b.x + twice.y * b.z + motion.x + motion.z * along.y,
                       twice.y * b.y + twice.z * b.x + motion.x * along.z + motion.y);
#endif
    return (change.y - change.x) * gradient_beta + (change.z - change.x) * gradient_gamma;
}
