// From render.vert to render.frag. Flat: one value a triangle. What is the same for the whole frame comes this way as well:
// a software renderer takes four times as long to read a uniform as a flat input, and a pixel reads forty of them.
INTERFACE Varyings {
    vec3 to_eye;        // from the point to the eye
    vec3 normal;
    vec2 uv;
#ifndef PLAIN
#ifndef FIELD_ALONE
    vec3 tau;           // the three waves' phases here, turns; linear over the triangle
#endif
    vec2 weights;       // barycentric β, γ
#ifdef FIELD
    vec3 field_tau;     // the carried field's three phases here, turns; linear over the triangle
#endif
#endif
#ifdef DISPLACED
    vec4 relief_here;   // height; amplitude; how much of the sky is seen here from in front and from behind
#endif
#ifdef NORMAL_MAP
    vec2 normal_uv;
#endif
#ifdef VERTEX_COLOURS
    vec4 tint;          // linear
#endif
#ifdef SHADOWS
    vec3 shadow_place;  // in the key light's depth map, nearer by the depth offset
#endif
#ifdef AOV
    float tension;      // 1 − r
#endif
};
#ifndef PLAIN
#ifndef FIELD_ALONE
FLAT vec3 climb_a;            // 2π h_j κ_j: the steepest gradient of each wave
FLAT vec3 climb_b;
FLAT vec3 climb_c;
#endif
FLAT vec4 heights;            // h_A, h_B, h_C; λ/4, λ = 1/max |κ|
FLAT vec4 steepness;          // ½ m (2π h_j |κ_j|)²; 2π max |κ|
FLAT vec3 gradient_beta;      // ∇β, ∇γ in the triangle's plane; ∇α is minus their sum
FLAT vec3 gradient_gamma;
FLAT vec3 along;              // c_A, c_B, c_C: where the opposite corner projects onto an edge
#ifdef FIELD
FLAT vec3 field_amplitude;    // of the three corners
FLAT vec3 field_slope_a;      // the gradients of its three phases, turns per length
FLAT vec3 field_slope_b;
FLAT vec3 field_slope_c;
#endif
FLAT vec3 gradient_u;
FLAT vec3 gradient_v;
#ifdef AOV
FLAT vec3 wavenumber_a;
FLAT vec3 wavenumber_b;
FLAT vec3 wavenumber_c;
#endif
#endif
FLAT vec3 plane;              // the triangle's normal, any length, on the side of its vertices' normals
FLAT vec4 lit_from[3];        // direction toward each light; roughness⁴, cavity, parallax
FLAT vec4 lit_by[3];          // its colour; the components of up
FLAT vec4 ambient_light;      // colour A; sheen
FLAT vec4 base;               // the material's colour
FLAT vec2 texels;             // size of its texture
#ifdef NORMAL_MAP
FLAT vec3 gradient_normal_u;  // of the normal map's coordinates
FLAT vec3 gradient_normal_v;
FLAT vec3 relief;             // size of the normal map; its scale
#endif
#ifdef SHADOWS
FLAT vec4 shadow_steps[3];    // where 1.5 texels along x, y, z lead to in the map; the size of a texel in it
#endif
