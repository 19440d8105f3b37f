// Render, vertices (Loviscach 2006, 6): every triangle on its own, its three corners pulled by index, so that each pixel
// knows the three waves it lies between. docs/passes.md, "Render".
#include "common/surface.glsl"
#include "common/scene.glsl"

layout(binding = 17) uniform usamplerBuffer corners;          // render vertex, welded vertex; three a triangle
layout(binding = 18) uniform samplerBuffer render_vertices;   // rest normal as components of (t, b, n), u; v, the normal map's uv

uniform vec4 base_colour;     // linear
uniform vec2 texture_size;    // texels
#ifdef ALPHA
uniform float wanted_side;    // 1: only triangles seen from in front, −1: from behind, 0: all
#endif
#ifdef NORMAL_MAP
uniform vec3 normal_map_size;  // texels; scale
#endif
#ifdef VERTEX_COLOURS
layout(binding = 19) uniform samplerBuffer render_colours;
#endif
#ifdef FIELD
layout(binding = 20) uniform samplerBuffer field;             // a corner each: its turns at the three corners, amplitude
#endif

#ifdef DISPLACED
layout(binding = 20) uniform samplerBuffer reliefs;           // of a welded vertex: height, amplitude, sky in front, behind
#endif

invariant gl_Position;  // parts that share vertices may be drawn by different programs

#define INTERFACE out
#define FLAT flat out
#include "common/render_io.glsl"

vec3 safe_divide(vec3 p, float q) { return q > 0.0 ? p / q : vec3(0.0); }

void main() {
    uint first = 3u * uint(gl_VertexID / 3), corner = uint(gl_VertexID % 3);
    uint id[3];
    vec3 p[3], n[3], t[3], facing = vec3(0.0);
    vec2 uvs[3], normal_uvs[3];
    for (uint i = 0u; i < 3u; ++i) {
        uvec2 ids = texelFetch(corners, int(first + i)).xy;
        id[i] = ids.y;
        p[i] = position(id[i]);
        t[i] = frame_tangent(id[i]);
        n[i] = frame_normal(id[i]);
        vec4 own = texelFetch(render_vertices, 2 * int(ids.x));
        vec4 more = texelFetch(render_vertices, 2 * int(ids.x) + 1);
        uvs[i] = vec2(own.w, more.x);
        normal_uvs[i] = more.yz;
#ifdef VERTEX_COLOURS
        if (i == corner) tint = texelFetch(render_colours, int(ids.x));
#endif
        vec3 c = own.xyz, posed_normal = c.x * t[i] + c.y * cross(n[i], t[i]) + c.z * n[i];
        facing += posed_normal;
        if (i == corner) normal = posed_normal;
    }
    vec3 x = p[corner];
    to_eye = eye.xyz - x;
    uv = uvs[corner];
    gl_Position = view_projection * vec4(x, 1.0);
    for (int i = 0; i < 3; ++i) {
        lit_from[i] = vec4(lights[i].direction.xyz, surface[i]);
        lit_by[i] = vec4(lights[i].colour.rgb, up[i]);
    }
    ambient_light = ambient;
    base = base_colour;
    texels = texture_size;
#ifdef SHADOWS
    shadow_place = (shadow_matrix * vec4(x, 1.0)).xyz - vec3(0.0, 0.0, shadow_texel.z);
    for (int i = 0; i < 3; ++i) shadow_steps[i] = vec4(1.5 * shadow_texel.y * shadow_matrix[i].xyz, shadow_texel.x);
#endif
#ifdef AOV
#ifndef DISPLACED
    tension = state(id[corner]).z;
#endif
#endif
#ifdef DISPLACED
    relief_here = texelFetch(reliefs, int(id[corner]));
#endif

    vec3 b = p[1] - p[0], c = p[2] - p[0], area = cross(b, c);
    plane = dot(area, facing) < 0.0 ? -area : area;
#ifdef ALPHA
    if (wanted_side * (dot(plane, eye.xyz - p[0]) < 0.0 ? -1.0 : 1.0) < 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // out of view
#endif
    float square = dot(area, area);
    vec3 slope_beta = safe_divide(cross(c, area), square), slope_gamma = safe_divide(cross(area, b), square);
#ifdef NORMAL_MAP
    normal_uv = normal_uvs[corner];
    relief = normal_map_size;
    vec2 second = normal_uvs[1] - normal_uvs[0], third = normal_uvs[2] - normal_uvs[0];
    gradient_normal_u = second.x * slope_beta + third.x * slope_gamma;
    gradient_normal_v = second.y * slope_beta + third.y * slope_gamma;
#endif
#ifndef PLAIN
    weights = vec2(corner == 1u, corner == 2u);
    vec3 h = vec3(0.0);
#ifdef FIELD_ALONE
    float largest = 0.0;
    steepness = vec4(0.0);
#else
    vec3 wavenumbers[3];
    for (uint i = 0u; i < 3u; ++i) {
        vec4 its = wave(id[i]);
        wavenumbers[i] = its.x * t[i] + its.y * cross(n[i], t[i]);
        h[i] = its.xy == vec2(0.0) ? 0.0 : its.z;  // a wave without a direction is not drawn
        // Wrapped before it is rounded, and the distance kept local: large phases would lose their fraction.
        tau[i] = dot(wavenumbers[i], x - p[i]) + phase(id[i]).x * (0.5 / pi) +
                 dot(state(id[i]).xy, constant(id[i]).zw);
    }
    vec3 squares = vec3(dot(wavenumbers[0], wavenumbers[0]), dot(wavenumbers[1], wavenumbers[1]),
                        dot(wavenumbers[2], wavenumbers[2]));
#ifdef FIELD
    squares *= vec3(greaterThan(h, vec3(0.0)));  // beside a field waves without height count for nothing
#endif
    float largest = sqrt(max(squares.x, max(squares.y, squares.z)));
    vec3 climbs = (2.0 * pi) * h;
    climb_a = climbs.x * wavenumbers[0];
    climb_b = climbs.y * wavenumbers[1];
    climb_c = climbs.z * wavenumbers[2];
    steepness = vec4(0.5 * surface.w * climbs * climbs * squares, 2.0 * pi * largest);
#endif
    heights = vec4(h, 0.25 / largest);
#ifdef AOV
    wavenumber_a = wavenumbers[0];
    wavenumber_b = wavenumbers[1];
    wavenumber_c = wavenumbers[2];
#endif
    gradient_beta = slope_beta;
    gradient_gamma = slope_gamma;
#ifdef FIELD
    vec3 field_slopes[3];
    for (int i = 0; i < 3; ++i) {
        vec4 its = texelFetch(field, int(first) + i);
        field_tau[i] = its[corner];
        field_amplitude[i] = its.w;
        field_slopes[i] = (its.y - its.x) * gradient_beta + (its.z - its.x) * gradient_gamma;
        largest = max(largest, length(field_slopes[i]));
    }
    field_slope_a = field_slopes[0];
    field_slope_b = field_slopes[1];
    field_slope_c = field_slopes[2];
    heights.w = 0.25 / largest;
    steepness.w = 2.0 * pi * largest;
#endif
    vec3 d = p[2] - p[1];
    along = vec3(safe_divide(vec3(dot(-b, d)), dot(d, d)).x, safe_divide(vec3(dot(-d, -c)), dot(c, c)).x,
                 safe_divide(vec3(dot(c, b)), dot(b, b)).x);
    gradient_u = (uvs[1].x - uvs[0].x) * gradient_beta + (uvs[2].x - uvs[0].x) * gradient_gamma;
    gradient_v = (uvs[1].y - uvs[0].y) * gradient_beta + (uvs[2].y - uvs[0].y) * gradient_gamma;
#endif
}
