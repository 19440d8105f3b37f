// From render.vert to render.frag. Flat: one value a triangle, so that no fragment fetches from a buffer.
INTERFACE Varyings {
    vec3 x;          // position
    vec3 normal;
    vec2 uv;
#ifndef PLAIN
    vec3 tau;        // the three waves' phases here, turns; linear over the triangle
    vec2 weights;    // barycentric β, γ
#endif
#ifdef AOV
    float tension;   // 1 − r
#endif
};
#ifndef PLAIN
FLAT vec3 wavenumber_a;
FLAT vec3 wavenumber_b;
FLAT vec3 wavenumber_c;
FLAT vec4 heights;           // h_A, h_B, h_C, max |κ|
FLAT vec3 gradient_beta;     // ∇β, ∇γ in the triangle's plane; ∇α is minus their sum
FLAT vec3 gradient_gamma;
FLAT vec3 along;             // c_A, c_B, c_C: where the opposite corner projects onto an edge
FLAT vec3 gradient_u;
FLAT vec3 gradient_v;
#endif
FLAT vec3 plane;             // the triangle's normal, any length, on the side of its vertices' normals
