// One triangle over the whole picture, with the ray through each pixel.
uniform mat4 from_clip;
out vec3 near_point;
out vec3 far_point;
void main() {
    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(p, 1.0, 1.0);
    vec4 a = from_clip * vec4(p, -1.0, 1.0), b = from_clip * vec4(p, 1.0, 1.0);
    near_point = a.xyz / a.w;
    far_point = b.xyz / b.w;
}
