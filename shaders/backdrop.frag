// The backdrop: a floor that passes into the wall without a visible edge, with the shadows of the ground map.
flat in vec4 backdrop_colour;  // linear; alpha
flat in vec2 pixel;            // its size in pictures
in vec3 near_place;            // the ray's ends: place in the ground map, height above the floor
in vec3 far_place;
layout(binding = 3) uniform sampler2D ground_map;  // blocked shares of the key light and of the sky
layout(location = 0) out vec4 colour;
void main() {
    vec2 centred = gl_FragCoord.xy * pixel - 0.5;
    vec3 c = backdrop_colour.rgb * (1.06 - 0.45 * dot(centred, centred));
    vec3 ray = far_place - near_place;
    if (ray.z < 0.0 && near_place.z > 0.0) {
        vec2 place = near_place.xy - ray.xy * (near_place.z / ray.z);
        vec2 rim = smoothstep(vec2(0.0), vec2(0.15), place) * smoothstep(vec2(0.0), vec2(0.15), 1.0 - place);
        vec2 taken = texture(ground_map, place).rg * (rim.x * rim.y);
        c *= (1.0 - 0.5 * taken.x) * (1.0 - 0.55 * taken.y);
    }
    // Half a step of noise prevents visible bands in the gradient (interleaved gradient noise, Jimenez 2014).
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    colour = vec4(c * (1.0 + noise * (3.0 / 255.0)), backdrop_colour.a);
}
