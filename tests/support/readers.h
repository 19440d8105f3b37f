// Every kind of file that people bring, given as bytes to the reader that takes it in this very process. Only
// an Error may come of any bytes whatever: seeded mutants (tests/io/mutants_test.cpp) and libFuzzer
// (tests/fuzz) try the same functions.
#pragma once

#include <filesystem>
#include <string_view>

namespace plisse::test {

// `folder` takes the file, for readers that take paths. Each throws Error where the bytes are refused.

// A model of plisse's own readers, known by its beginning: GLB, glTF, PLY, or else OBJ.
void read_as_model(std::string_view bytes, const std::filesystem::path& folder);
// MDD or PC2 (known by its beginning) over a triangle.
void read_as_point_cache(std::string_view bytes, const std::filesystem::path& folder);
// Scene, paint and panel files; refused where all three refuse.
void read_as_scene(std::string_view bytes, const std::filesystem::path& folder);
// A wrinkle field: PLY, or else the authors' amplitudes, phases and differences over a square of two
// triangles, one after the other with a line "#" between.
void read_as_field(std::string_view bytes, const std::filesystem::path& folder);
// Not a file: the corners of a polygon for cut_polygon, three bytes each. Throws std::logic_error where its
// triangles are not as many as a polygon has, or name corners that do not exist.
void read_as_polygon(std::string_view bytes, const std::filesystem::path& folder);

}  // namespace plisse::test
