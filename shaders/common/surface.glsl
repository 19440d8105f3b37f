// The buffers of the welded surface, the same bindings in every pass (passes/surface_buffers.h).
// Row v of a list is items[offsets[v]] … items[offsets[v + 1] - 1].
struct Frame {
    vec4 normal;   // n', unit
    vec4 tangent;  // t', unit
};
struct Constant {
    vec4 modifiers;  // W; mask; phase noise in radians; unused
};
layout(std430, binding = 0) buffer Positions { vec4 positions[]; };            // x'
layout(std430, binding = 1) buffer Frames { Frame frames[]; };
layout(std430, binding = 2) readonly buffer Offsets { uint offsets[]; };
layout(std430, binding = 3) readonly buffer Neighbours { uint neighbours[]; };
layout(std430, binding = 5) readonly buffer Constants { Constant constants[]; };
layout(std430, binding = 7) buffer Waves { vec4 waves[]; };                    // κ in (t', b'), h, w
layout(std430, binding = 8) buffer WorldWaves { vec4 world_waves[]; };         // κ in the world, w
layout(std430, binding = 10) buffer Phases { vec2 phases[]; };                 // φ, status
const float idle = 0.0, set = 1.0, fresh = 2.0;
#include "common/constants.glsl"
