// One triangle over the whole picture, with the ray through each pixel: all that is linear along it, so that a pixel reads
// no uniforms.
uniform mat4 from_clip;
uniform vec4 background;       // linear; alpha
uniform vec2 picture_size;
uniform vec4 floor_plane;      // up, height
uniform vec4 map_origin;       // corner of the ground map on the floor; side length
uniform vec3 map_across;
uniform vec3 map_along;
flat out vec4 backdrop_colour;
flat out vec2 pixel;           // its size in pictures
out vec3 near_place;           // the ray's ends: place in the ground map, height above the floor
out vec3 far_place;
vec3 in_map(vec3 x) {
    vec3 from = x - map_origin.xyz;
    return vec3(vec2(dot(from, map_across), dot(from, map_along)) / map_origin.w, dot(floor_plane.xyz, x) - floor_plane.w);
}
void main() {
    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(p, 1.0, 1.0);
    vec4 a = from_clip * vec4(p, -1.0, 1.0), b = from_clip * vec4(p, 1.0, 1.0);
    near_place = in_map(a.xyz / a.w);
    far_place = in_map(b.xyz / b.w);
    pixel = 1.0 / picture_size;
    backdrop_colour = background;
}
