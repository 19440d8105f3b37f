// Plain textured Phong: only for comparison with the wave shader in the benchmark.
#include "common/constants.glsl"
#include "common/scene.glsl"
#define INTERFACE in
#define FLAT flat in
#include "common/render_io.glsl"
layout(binding = 0) uniform sampler2D base_colour_map;
uniform vec4 base_colour;
uniform vec2 texture_size;
layout(location = 0) out vec4 colour;
void main() {
    vec3 v = normalize(to_eye), n = normalize(normal);
    if (dot(n, v) < 0.0) n = -n;
    vec4 albedo = base_colour;
    if (texture_size.x > 0.0) albedo *= texture(base_colour_map, uv);
    vec3 L = lights[0].direction.xyz;
    float diffuse = max(dot(n, L), 0.0), shine = pow(max(dot(reflect(-L, n), v), 0.0), 16.0);
    colour = vec4(albedo.rgb * (ambient.rgb + lights[0].colour.rgb * diffuse) + 0.1 * lights[0].colour.rgb * shine, 1.0);
}
