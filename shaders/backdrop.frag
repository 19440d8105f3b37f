// A studio's backdrop: a floor that runs into the wall without a seam, the shadows on it from the ground map.
in vec3 near_point;
in vec3 far_point;
uniform vec4 background;       // linear; alpha
uniform vec2 picture_size;
uniform vec4 floor_plane;      // up, height
uniform vec4 map_origin;       // corner of the ground map on the floor; side length
uniform vec3 map_across;
uniform vec3 map_along;
layout(binding = 3) uniform sampler2D ground_map;  // how much of the key light and of the sky is taken away
layout(location = 0) out vec4 colour;
void main() {
    vec2 centred = gl_FragCoord.xy / picture_size - 0.5;
    vec3 c = background.rgb * (1.06 - 0.45 * dot(centred, centred));
    vec3 ray = far_point - near_point;
    float down = dot(floor_plane.xyz, ray), above = dot(floor_plane.xyz, near_point) - floor_plane.w;
    if (down < 0.0 && above > 0.0) {
        vec3 hit = near_point - ray * (above / down) - map_origin.xyz;
        vec2 place = vec2(dot(hit, map_across), dot(hit, map_along)) / map_origin.w;
        vec2 rim = smoothstep(vec2(0.0), vec2(0.15), place) * smoothstep(vec2(0.0), vec2(0.15), 1.0 - place);
        vec2 taken = texture(ground_map, place).rg * (rim.x * rim.y);
        c *= (1.0 - 0.5 * taken.x) * (1.0 - 0.55 * taken.y);
    }
    // Half a step of noise keeps eight bits from showing the gradient as bands (interleaved gradient noise, Jimenez 2014).
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    colour = vec4(c * (1.0 + noise * (3.0 / 255.0)), background.a);
}
