// The welded surface in every pass, fetched item by item (gpu/buffer.h says why not from storage buffers);
// passes/surface_buffers.cpp binds it. Entry i of row v of a list lies at offset(v) ≤ i < offset(v + 1).
// A pass declares its own storage buffers for its results; it fetches an item before it writes it.
layout(binding = 8) uniform samplerBuffer positions;      // x'
layout(binding = 9) uniform samplerBuffer frames;         // n', t' of a vertex, one after the other
layout(binding = 10) uniform usamplerBuffer offsets;
layout(binding = 11) uniform usamplerBuffer neighbours;
layout(binding = 12) uniform samplerBuffer constants;     // W; mask; D in (t, b)
layout(binding = 13) uniform samplerBuffer waves;         // κ in (t', b'), h, w
layout(binding = 14) uniform samplerBuffer world_waves;   // κ in the world, w
layout(binding = 15) uniform samplerBuffer phases;        // φ, status
layout(binding = 16) uniform samplerBuffer states;        // k in (t, b); 1 − r; g
// Units 17 to 22 are a pass's own.

vec3 position(uint v) { return texelFetch(positions, int(v)).xyz; }
vec3 frame_normal(uint v) { return texelFetch(frames, 2 * int(v)).xyz; }
vec3 frame_tangent(uint v) { return texelFetch(frames, 2 * int(v) + 1).xyz; }
uint offset(uint v) { return texelFetch(offsets, int(v)).x; }
uint neighbour(uint i) { return texelFetch(neighbours, int(i)).x; }
vec4 constant(uint v) { return texelFetch(constants, int(v)); }
vec4 wave(uint v) { return texelFetch(waves, int(v)); }
vec4 world_wave(uint v) { return texelFetch(world_waves, int(v)); }
vec2 phase(uint v) { return texelFetch(phases, int(v)).xy; }
vec4 state(uint v) { return texelFetch(states, int(v)); }

const float idle = 0.0, set = 1.0, fresh = 2.0;
#include "common/constants.glsl"
