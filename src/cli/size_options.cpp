#include "cli/size_options.h"

#include <fmt/format.h>

#include "base/error.h"
#include "config/fabric.h"

namespace plisse::cli {
namespace {

// What is wrong with a text is told with the option that it was given to.
template <typename Parse>
auto given_to(const char* option, const std::string& text, const Parse& parse) {
  try {
    return parse(text);
  } catch (const Error& error) {
    throw Error(error.code, fmt::format("{}: {}", option, error.what()));
  }
}

}  // namespace

sizing::Fabric fabric_option(const std::string& text) {
  return given_to("--fabric", text, config::parse_fabric);
}

sizing::FabricRange range_option(const std::string& text) {
  return text.empty() ? sizing::FabricRange{} : given_to("--fabric-range", text, config::parse_fabric_range);
}

}  // namespace plisse::cli
