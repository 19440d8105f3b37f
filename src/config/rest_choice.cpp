#include "config/rest_choice.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"

namespace plisse::config {

std::optional<UvRestChoice> uv_rest_choice(std::string_view rest) {
  constexpr std::string_view word = "uv", mark = "uv:";
  if (rest == word) return UvRestChoice{};
  if (!rest.starts_with(mark)) return std::nullopt;
  const auto metres = parse_length(rest.substr(mark.size()));
  if (!metres || !(*metres >= 1e-6 && *metres <= 1e3))
    throw Error(ExitCode::bad_input,
                fmt::format("'{}' does not say how long a unit of uv is: from 1e-6 m to 1 km, such as "
                            "'uv:1.2m'",
                            rest));
  return UvRestChoice{metres};
}

}  // namespace plisse::config
