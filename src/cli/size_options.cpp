#include "cli/size_options.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "config/fabric.h"

namespace plisse::cli {
namespace {

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// A positive number or an error that says which part of which option will not do.
template <typename Parse>
double positive(const char* option, const std::string& part, const char* what, std::string_view allowed,
                const Parse& parse) {
  const std::optional<double> value = parse(part);
  if (value && *value > 0 && std::isfinite(*value)) return *value;
  throw Error(ExitCode::bad_input,
              fmt::format("{}: '{}' is no {}; allowed: a number above 0, alone or with {}", option, part,
                          what, allowed));
}
double bending(const char* option, const std::string& part) {
  return positive(option, part, "bending stiffness", sizing::bending_units, sizing::parse_bending);
}
double modulus(const char* option, const std::string& part) {
  return positive(option, part, "Young's modulus", sizing::modulus_units, sizing::parse_modulus);
}
double resolution(const char* option, const std::string& part) {
  return positive(option, part, "length", length_units, parse_length);
}

}  // namespace

sizing::Fabric fabric_option(const std::string& text) {
  try {
    return parse_fabric(text);
  } catch (const Error& error) {
    throw Error(error.code, fmt::format("--fabric: {}", error.what()));
  }
}

sizing::FabricRange range_option(const std::string& text) {
  constexpr const char* option = "--fabric-range";
  if (text.empty()) return {};
  const auto parts = parts_of(text);
  if (parts.size() != 6) {
    throw Error(ExitCode::bad_input, fmt::format("{}: '{}' has {} parts; give Bmin,Bmax,Emin,Emax,rmin,rmax",
                                                 option, text, parts.size()));
  }
  return {bending(option, parts[0]), bending(option, parts[1]),    modulus(option, parts[2]),
          modulus(option, parts[3]), resolution(option, parts[4]), resolution(option, parts[5])};
}

}  // namespace plisse::cli
