// Lengths as people write them.
#pragma once

#include <optional>
#include <string_view>

namespace plisse {

inline constexpr std::string_view length_units = "mm, cm, m, in or ft";

// "12 mm", "3cm", "1.5 m", "2 in", "1 ft", or a bare number of metres → metres. Empty where the text is not a
// length; inf and nan pass, for the caller's range check to name.
std::optional<double> parse_length(std::string_view text);

// A decimal number that takes up all of the text but for spaces around it; a leading + is fine.
std::optional<double> parse_number(std::string_view text);

}  // namespace plisse
