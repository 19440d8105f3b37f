#include "shell/material.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/error.h"

namespace plisse::shell {

void check(const Material& material) {
  std::string problems;
  const auto demand = [&](bool holds, const char* name, double value, const char* allowed) {
    if (holds && std::isfinite(value)) return;
    problems +=
        fmt::format("{}the {} is {}; allowed: {}", problems.empty() ? "" : "; ", name, value, allowed);
  };
  demand(material.young > 0, "Young's modulus", material.young, "more than 0 Pa");
  demand(material.poisson >= 0 && material.poisson <= 0.5, "Poisson ratio", material.poisson, "0 to 0.5");
  demand(material.thickness > 0, "thickness", material.thickness, "more than 0 m");
  demand(material.density >= 0, "density", material.density, "0 kg/m³ or more");
  if (!problems.empty()) throw Error(ExitCode::bad_input, problems);
}

}  // namespace plisse::shell
