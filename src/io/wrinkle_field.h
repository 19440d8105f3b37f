// Solved wrinkle fields from files: amplitude and phase over a base surface (Chen et al., Fine Wrinkling on
// Coarsely Meshed Thin Shells, 2021): height a cos φ. Two forms are read:
//
//  - a PLY of our own: `vertex` with x, y, z and amplitude; `face` with the lists vertex_indices and phase
//  (one value a
//    corner, radians; corners of one vertex differ by multiples of 2π); `edge` with vertex1, vertex2 and
//    omega is written for other programs, and passed over where it is read;
//  - the authors' text files: NAME_amplitude_REST.txt with NAME_phi_REST.txt and NAME_dphi_REST.txt beside
//  it, one number
//    a line, over an OBJ of the base surface. Amplitudes and phases are a vertex each; dphi is an edge each,
//    edges being (smaller, larger) vertex pairs in lexicographic order, dphi = φ[larger] − φ[smaller]. The
//    phases are of one branch, so a corner's phase is its vertex's and the multiple of 2π that brings it
//    nearest to what dphi asks for.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plisse::io {

struct WrinkleField {
  std::vector<glm::dvec3> positions;  // of the base surface, in the file's unit and with its up axis
  std::vector<double> amplitude;      // one a vertex, ≥ 0, in the same unit
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<double, 3>> phase;  // one a corner, radians
};

// `mesh`: the OBJ that text files belong to; not looked at for a PLY. Throws Error(bad_input): a file or
// element that is missing, wrong counts, an amplitude below 0, values that are not finite, corners of one
// vertex whose phases do not differ by multiples of 2π where the amplitude is not 0.
WrinkleField read_wrinkle_field(const std::filesystem::path& path, const std::filesystem::path& mesh);

// Throws Error(bad_input), which begins with `name`: an amplitude below 0, values that are not finite, or
// corners of one vertex whose phases do not differ by multiples of 2π where the amplitude is not 0.
void check_field(const WrinkleField& field, const std::string& name);

// One number a line. Throws Error(bad_input) where there are not `wanted` of them (`of_what`: of the base
// surface), or one is no finite number.
std::vector<double> read_numbers(const std::filesystem::path& path, std::size_t wanted,
                                 std::string_view of_what);

// The PLY form. `edge` gets omega = the difference of phases. Throws Error(no_output).
void write_wrinkle_field(const std::filesystem::path& path, const WrinkleField& field,
                         const std::vector<std::string>& comments = {});

// The authors' texts: `amplitude` as its name says, phi and dphi beside it. `phase`: one a vertex;
// `one_form`: one an edge, radians. Throws Error(bad_input) where 'amplitude' is not in the name,
// Error(no_output).
void write_wrinkle_texts(const std::filesystem::path& amplitude, const std::vector<double>& amplitudes,
                         const std::vector<double>& phase, const std::vector<double>& one_form);

}  // namespace plisse::io
