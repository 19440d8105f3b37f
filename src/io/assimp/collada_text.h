// The text of a COLLADA file as assimp 5.2.5 can read it: what assimp would read wrongly is written in
// another way that means the same.
#pragma once

#include <filesystem>
#include <string>

namespace plisse::io {

// - Lists of numbers without blanks before the first one, which assimp takes for the end of some lists.
// - Animation curves (COLLADA 1.4.1, "Curve Interpolation") of BEZIER, HERMITE and STEP keys with so many
// LINEAR
//   keys that straight lines between them are right to 1e-6 of a curve's largest value; assimp knows only
//   those. A step is a rise that ends 0.1 ms before its key. Other interpolations give one warning and stay
//   as they are.
// Throws Error(bad_input) where the file cannot be read.
std::string collada_text(const std::filesystem::path& path);

}  // namespace plisse::io
