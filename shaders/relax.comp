// Relax (Loviscach 2006, 5.2, eq. 6): aligns the phases of neighbouring waves. Five programs from one file, by define:
//   DESCENT  one round of gradient descent for every set vertex
//   SPREAD   one round in which fresh vertices take the phase that their set neighbours suggest
//   ROTORS   prepares smoothing: the turn between the phases of two neighbours, once per list entry
//   SMOOTH   one round of complex smoothing of the fresh vertices (Knöppel et al. 2015, connection Laplacian)
//   FINISH   writes the smoothed phases back
// docs/passes.md, "Relax".
#include "common/items.glsl"
#include "common/surface.glsl"

layout(std430, binding = 11) buffer PhasesOut { vec2 phases_out[]; };
layout(std430, binding = 12) buffer Numbers { vec2 numbers[]; };          // z
layout(std430, binding = 13) buffer NumbersOut { vec2 numbers_out[]; };
layout(std430, binding = 4) buffer Rotors { vec4 rotors[]; };             // cos, sin, sgn, whether the neighbour counts
layout(std430, binding = 9) buffer Counter { uint fresh_count; };
uniform uint vertex_count;
uniform float step_size;  // ε/2π², in turns per turn

float wrap_turns(float x) { return x - ceil(x - 0.5); }  // to (−½, ½]

// What the phase of vertex v (turns) would be for its wave to meet that of its neighbour halfway; `turn` is the part
// that does not depend on the neighbour's phase, `sgn` its factor.
void meeting(vec3 x, vec3 wavenumber, uint n, out float sgn, out float turn) {
    vec3 other = world_waves[n].xyz;
    vec3 half_way = 0.5 * (positions[n].xyz - x);
    sgn = dot(other, wavenumber) < 0.0 ? -1.0 : 1.0;
    turn = -sgn * dot(other, half_way) - dot(wavenumber, half_way);
}

void main() {
    uint v = item_index();
    if (v >= vertex_count) return;

#if defined(DESCENT)
    vec2 own = phases[v];
    phases_out[v] = own;
    uint count = offsets[v + 1u] - offsets[v];
    if (own.y != set || count == 0u) return;
    vec3 x = positions[v].xyz, wavenumber = world_waves[v].xyz;
    float turns = own.x * (0.5 / pi), sum = 0.0;
    for (uint i = offsets[v]; i < offsets[v + 1u]; ++i) {
        uint n = neighbours[i];
        vec2 phase = phases[n];
        float weight = phase.y == set ? world_waves[n].w : 0.0;
        float sgn, turn;
        meeting(x, wavenumber, n, sgn, turn);
        sum += weight * wrap_turns(sgn * phase.x * (0.5 / pi) + turn - turns);
    }
    turns = wrap_turns(turns + step_size * sum / float(count));
    phases_out[v].x = turns * (2.0 * pi);

#elif defined(SPREAD)
    vec2 own = phases[v];
    phases_out[v] = own;
    if (own.y != fresh) return;
    vec3 x = positions[v].xyz, wavenumber = world_waves[v].xyz;
    vec2 sum = vec2(0.0);
    bool any_set = false;
    for (uint i = offsets[v]; i < offsets[v + 1u]; ++i) {
        uint n = neighbours[i];
        vec2 phase = phases[n];
        if (phase.y != set) continue;
        any_set = true;
        float sgn, turn;
        meeting(x, wavenumber, n, sgn, turn);
        float angle = 2.0 * pi * wrap_turns(sgn * phase.x * (0.5 / pi) + turn);
        sum += vec2(cos(angle), sin(angle));
    }
    if (!any_set) return;
    atomicAdd(fresh_count, 0xffffffffu);  // one fewer
    phases_out[v] = vec2(dot(sum, sum) > 0.0 ? atan(sum.y, sum.x) : own.x, set);

#elif defined(ROTORS)
    vec2 own = phases[v];
    numbers[v] = numbers_out[v] = vec2(cos(own.x), sin(own.x));
    vec3 x = positions[v].xyz, wavenumber = world_waves[v].xyz;
    for (uint i = offsets[v]; i < offsets[v + 1u]; ++i) {
        uint n = neighbours[i];
        float sgn, turn;
        meeting(x, wavenumber, n, sgn, turn);
        float angle = 2.0 * pi * wrap_turns(turn);
        rotors[i] = vec4(cos(angle), sin(angle), sgn, phases[n].y != idle ? 1.0 : 0.0);
    }

#elif defined(SMOOTH)
    if (phases[v].y != fresh) return;
    vec2 sum = vec2(0.0);
    float count = 0.0;
    for (uint i = offsets[v]; i < offsets[v + 1u]; ++i) {
        vec4 rotor = rotors[i];
        vec2 z = numbers[neighbours[i]];
        z.y *= rotor.z;
        sum += rotor.w * vec2(z.x * rotor.x - z.y * rotor.y, z.x * rotor.y + z.y * rotor.x);
        count += rotor.w;
    }
    vec2 z = numbers[v];
    numbers_out[v] = count > 0.0 ? 0.5 * z + 0.5 / count * sum : z;

#elif defined(FINISH)
    if (phases[v].y != fresh) return;
    vec2 z = numbers[v];
    if (dot(z, z) >= 1e-24) phases[v].x = atan(z.y, z.x);
    phases[v].y = set;
#endif
}
