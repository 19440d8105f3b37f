// What is the same for every pixel of a frame (passes/render.cpp writes it).
struct Light {
    vec4 direction;  // toward the light, unit
    vec4 colour;     // linear, intensity included
};
layout(std140, binding = 1) uniform Scene {
    mat4 view_projection;
    mat4 shadow_matrix;    // world → the key light's depth map, 0…1
    vec4 eye;
    vec4 up;
    Light lights[3];       // key, fill, rim
    vec4 ambient;          // colour A; sheen
    vec4 surface;          // roughness⁴, cavity, parallax, mean of f'² over ½
    vec4 shadow_texel;     // 1/size of the map; the size of a texel in the world; depth offset; unused
};
