// Positions alone: for depth maps and wireframes.
#include "common/surface.glsl"
struct RenderVertex {
    vec4 normal;
    vec2 uv;
    vec2 unused;
};
layout(std430, binding = 4) readonly buffer RenderVertices { RenderVertex render_vertices[]; };
layout(std430, binding = 6) readonly buffer Triangles { uint triangles[]; };
uniform mat4 to_clip;
uniform float pull;  // toward the eye, in clip depth: lines lie on top of their triangles
void main() {
    uint id = floatBitsToUint(render_vertices[triangles[gl_VertexID]].normal.w);
    gl_Position = to_clip * vec4(positions[id].xyz, 1.0);
    gl_Position.z -= pull * gl_Position.w;
}
