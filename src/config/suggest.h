// "Did you mean …?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plisse::config {

// The candidate nearest to `word` by edit distance (insert, delete, replace, swap neighbours; case is free),
// if it is near enough to be what was meant: at most a third of the letters differ. Empty otherwise; the
// first on ties.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// " (did you mean 'nearest'?)", or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace plisse::config
