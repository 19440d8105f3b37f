// Models of the project with something changed, for tests that need a model of that kind.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

namespace plisse::test {

// Writes a GLB whose binary part is that of `source` and whose JSON is changed by `alter`; returns `target`.
std::filesystem::path altered_glb(const std::filesystem::path& source, const std::filesystem::path& target,
                                  const std::function<void(nlohmann::json&)>& alter);

}  // namespace plisse::test
