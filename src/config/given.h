// A value as a file or the command line has it, and what reading it takes: the parts that kinds of values are
// made of. Each throws Problem where the value is something else.
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "config/kinds.h"

namespace plisse::config {

class FileReader;  // config/file_reader.h

struct Given {
  const toml::node& node;
  std::filesystem::path folder = {};  // relative paths start here; empty: the working directory
  double metres = 1;                  // of a length that is a number
  FileReader* reader = nullptr;       // reads the tables that a value is made of; none on the command line

  Given part(const toml::node& inner) const { return {inner, folder, metres, reader}; }
};

double number_of(const Given& given);
double length_of(const Given& given);  // metres; not yet known to be finite
std::int64_t whole_of(const Given& given);
std::string text_of(const Given& given);
// The number itself; Problem where it is not finite or out of range.
double within(double value, const Range& range);
// The array; `count` items, or at least one where that is 0.
const toml::array& array_of(const Given& given, std::string_view wanted, std::size_t count = 0);
glm::dvec3 point_of(const Given& given);   // three lengths
glm::dvec3 vector_of(const Given& given);  // three numbers

}  // namespace plisse::config
