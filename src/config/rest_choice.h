// The rest shape that [model] rest asks for, where it is that of the texture coordinates.
#pragma once

#include <optional>
#include <string_view>

namespace plisse::config {

struct UvRestChoice {
  std::optional<double> metres;  // of a unit of uv, > 0; none: from the model
};

// "uv" or "uv:LENGTH"; none: another rest shape. Throws Error(bad_input) where the length is none from a
// micrometre to a kilometre.
std::optional<UvRestChoice> uv_rest_choice(std::string_view rest);

}  // namespace plisse::config
