// The ground map, two programs by define: CAST reads from the depth maps what is between a point of the floor and the key
// light (x) and how close the surface is above it (y); BLUR blurs along one axis, with separate widths for x and y.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rg16f) uniform restrict writeonly image2D result;
uniform int size;
uniform ivec4 area;   // what can differ from zero: first column and row, and those after the last
#if defined(CAST)
layout(binding = 2) uniform sampler2DShadow shadow_map;
layout(binding = 4) uniform sampler2D height_map;  // lowest surface above the floor, 1 = none
uniform mat4 shadow_matrix;
uniform mat4 height_matrix;
uniform vec4 map_origin;
uniform vec3 map_across;
uniform vec3 map_along;
uniform float heights_per_reach;   // full range of the height map over the reach of contact
void main() {
    ivec2 at = area.xy + ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.z || at.y >= area.w) return;
    vec2 place = (vec2(at) + 0.5) / float(size) * map_origin.w;
    vec3 x = map_origin.xyz + place.x * map_across + place.y * map_along;
    vec3 p = (shadow_matrix * vec4(x, 1.0)).xyz, q = (height_matrix * vec4(x, 1.0)).xyz;
    float lit = any(lessThan(p.xy, vec2(0.0))) || any(greaterThan(p.xy, vec2(1.0))) ? 1.0 : textureLod(shadow_map, vec3(p.xy, min(p.z, 1.0) - 1e-3), 0.0);
    bool covered = all(greaterThan(q.xy, vec2(0.0))) && all(lessThan(q.xy, vec2(1.0)));
    float height = covered ? textureLod(height_map, q.xy, 0.0).r : 1.0;
    imageStore(result, at, vec4(1.0 - lit, height < 1.0 ? exp(-height * heights_per_reach) : 0.0, 0.0, 0.0));
}
#else
layout(binding = 3) uniform sampler2D source;
uniform ivec2 axis;
uniform vec2 widths;   // standard deviations in texels
void main() {
    ivec2 at = area.xy + ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.z || at.y >= area.w) return;
    vec2 sum = vec2(0.0), total = vec2(0.0);
    int reach = int(ceil(2.5 * max(widths.x, widths.y)));
    for (int i = -reach; i <= reach; ++i) {
        vec2 weight = exp(-0.5 * float(i * i) / (widths * widths));
        sum += weight * texelFetch(source, clamp(at + i * axis, ivec2(0), ivec2(size - 1)), 0).rg;
        total += weight;
    }
    imageStore(result, at, vec4(sum / total, 0.0, 0.0));
}
#endif
