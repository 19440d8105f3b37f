// Relax (Loviscach 2006, 5.2, eq. 6): aligns the phases of neighbouring waves. Six programs from one file, by define:
//   DESCENT  one round of gradient descent for every set vertex
//   SPREAD   one round in which fresh vertices take the phase that their set neighbours suggest
//   ROTORS   prepares smoothing: the turn between the phases of two neighbours, once per list entry
//   SMOOTH   one round of complex smoothing of the fresh vertices (Knöppel et al. 2015, connection Laplacian)
//   FINISH   writes the smoothed phases back
//   LEAD     moves phases toward those of another moment, by which a loop closes
// docs/passes.md, "Relax".
#include "common/items.glsl"
#include "common/surface.glsl"

#if defined(DESCENT) || defined(SPREAD) || defined(FINISH) || defined(LEAD)
layout(std430, binding = 0) writeonly buffer PhasesOut { vec2 phases_out[]; };
#endif
#if defined(SPREAD) || defined(LEAD)
layout(std430, binding = 1) buffer Counter { uint fresh_count; };
#elif defined(ROTORS)
layout(std430, binding = 1) writeonly buffer Numbers { vec2 numbers_out[]; };
layout(std430, binding = 2) writeonly buffer OtherNumbers { vec2 other_numbers_out[]; };
layout(std430, binding = 3) writeonly buffer Rotors { vec4 rotors_out[]; };
#elif defined(SMOOTH)
layout(std430, binding = 1) writeonly buffer Numbers { vec2 numbers_out[]; };
#endif
layout(binding = 17) uniform samplerBuffer numbers;  // z
layout(binding = 18) uniform samplerBuffer rotors;   // cos, sin, sgn, whether the neighbour counts
uniform uint vertex_count;
uniform float step_size;  // ε/2π², in turns per turn
#if defined(LEAD)
layout(binding = 19) uniform samplerBuffer led_phases;  // φ, status of the other moment
layout(binding = 20) uniform samplerBuffer led_states;  // its k
uniform float fraction;   // of the difference
uniform bool fresh_ones;  // they begin with the other moment's phase, and are set; else set ones are moved
#endif

float wrap_turns(float x) { return x - ceil(x - 0.5); }  // to (−½, ½]

// The phase of vertex v (turns) with which its wave agrees with its neighbour's at the midpoint; `turn` is the part
// that does not depend on the neighbour's phase, `sgn` its factor.
void meeting(vec3 x, vec3 wavenumber, uint n, vec3 other, out float sgn, out float turn) {
    vec3 half_way = 0.5 * (position(n) - x);
    sgn = dot(other, wavenumber) < 0.0 ? -1.0 : 1.0;
    turn = -sgn * dot(other, half_way) - dot(wavenumber, half_way);
}

void main() {
    uint v = item_index();
    if (v >= vertex_count) return;

#if defined(DESCENT)
    vec2 own = phase(v);
    phases_out[v] = own;
    uint begin = offset(v), end = offset(v + 1u), count = end - begin;
    if (own.y != set || count == 0u) return;
    vec3 x = position(v), wavenumber = world_wave(v).xyz;
    float turns = own.x * (0.5 / pi), sum = 0.0;
    for (uint i = begin; i < end; ++i) {
        uint n = neighbour(i);
        vec2 its = phase(n);
        vec4 other = world_wave(n);
        float weight = its.y == set ? other.w : 0.0;
        float sgn, turn;
        meeting(x, wavenumber, n, other.xyz, sgn, turn);
        sum += weight * wrap_turns(sgn * its.x * (0.5 / pi) + turn - turns);
    }
    turns = wrap_turns(turns + step_size * sum / float(count));
    phases_out[v].x = turns * (2.0 * pi);

#elif defined(LEAD)
    vec2 own = phase(v), aim = texelFetch(led_phases, int(v)).xy;
    phases_out[v] = own;
    if (own.y != (fresh_ones ? fresh : set) || aim.y != set) return;
    // With the opposite direction, the phase of the same wave has the opposite sign.
    float sgn = dot(state(v).xy, texelFetch(led_states, int(v)).xy) < 0.0 ? -1.0 : 1.0;
    float turns = own.x * (0.5 / pi);
    turns += fraction * wrap_turns(sgn * aim.x * (0.5 / pi) - turns);
    phases_out[v] = vec2(2.0 * pi * wrap_turns(turns), set);
    if (fresh_ones) atomicAdd(fresh_count, 0xffffffffu);  // one fewer

#elif defined(SPREAD)
    vec2 own = phase(v);
    phases_out[v] = own;
    if (own.y != fresh) return;
    vec3 x = position(v), wavenumber = world_wave(v).xyz;
    vec2 sum = vec2(0.0);
    bool any_set = false;
    uint end = offset(v + 1u);
    for (uint i = offset(v); i < end; ++i) {
        uint n = neighbour(i);
        vec2 its = phase(n);
        if (its.y != set) continue;
        any_set = true;
        float sgn, turn;
        meeting(x, wavenumber, n, world_wave(n).xyz, sgn, turn);
        float angle = 2.0 * pi * wrap_turns(sgn * its.x * (0.5 / pi) + turn);
        sum += vec2(cos(angle), sin(angle));
    }
    if (!any_set) return;
    atomicAdd(fresh_count, 0xffffffffu);  // one fewer
    phases_out[v] = vec2(dot(sum, sum) > 0.0 ? atan(sum.y, sum.x) : own.x, set);

#elif defined(ROTORS)
    vec2 own = phase(v);
    numbers_out[v] = other_numbers_out[v] = vec2(cos(own.x), sin(own.x));
    vec3 x = position(v), wavenumber = world_wave(v).xyz;
    uint end = offset(v + 1u);
    for (uint i = offset(v); i < end; ++i) {
        uint n = neighbour(i);
        float sgn, turn;
        meeting(x, wavenumber, n, world_wave(n).xyz, sgn, turn);
        float angle = 2.0 * pi * wrap_turns(turn);
        rotors_out[i] = vec4(cos(angle), sin(angle), sgn, phase(n).y != idle ? 1.0 : 0.0);
    }

#elif defined(SMOOTH)
    if (phase(v).y != fresh) return;
    vec2 sum = vec2(0.0);
    float count = 0.0;
    uint end = offset(v + 1u);
    for (uint i = offset(v); i < end; ++i) {
        vec4 rotor = texelFetch(rotors, int(i));
        vec2 z = texelFetch(numbers, int(neighbour(i))).xy;
        z.y *= rotor.z;
        sum += rotor.w * vec2(z.x * rotor.x - z.y * rotor.y, z.x * rotor.y + z.y * rotor.x);
        count += rotor.w;
    }
    vec2 z = texelFetch(numbers, int(v)).xy;
    numbers_out[v] = count > 0.0 ? 0.5 * z + 0.5 / count * sum : z;

#elif defined(FINISH)
    if (phase(v).y != fresh) return;
    vec2 z = texelFetch(numbers, int(v)).xy;
    if (dot(z, z) >= 1e-24) phases_out[v].x = atan(z.y, z.x);
    phases_out[v].y = set;
#endif
}
