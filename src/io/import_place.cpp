// Up axes and units (see import_place.h).
#include "io/import_place.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"

namespace plisse::io {

glm::dmat4 upright(const std::string& up) {
  // Columns: where the file's x, y and z axes go.
  if (up == "y") return glm::dmat4{1};
  if (up == "z") return {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}};
  if (up == "x") return {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  throw Error(ExitCode::bad_input, fmt::format("up axis '{}': expected x, y or z", up));
}

glm::dmat4 file_to_world(const std::string& up, double metres_per_unit) {
  if (!(metres_per_unit > 0) || !std::isfinite(metres_per_unit))
    throw Error(ExitCode::bad_input,
                fmt::format("unit of {} metres: expected a positive number", metres_per_unit));
  return glm::scale(glm::dmat4{1}, glm::dvec3{metres_per_unit}) * upright(up);
}

}  // namespace plisse::io
