// Positions alone: for depth maps and wireframes.
#include "common/surface.glsl"
layout(binding = 17) uniform usamplerBuffer corners;  // render vertex, welded vertex; three a triangle
uniform mat4 to_clip;
uniform float pull;  // toward the eye, in clip depth: lines lie on top of their triangles
void main() {
    gl_Position = to_clip * vec4(position(texelFetch(corners, gl_VertexID).y), 1.0);
    gl_Position.z -= pull * gl_Position.w;
}
