#include "gpu/shader_source.h"

#include <fmt/format.h>

#include <fstream>
#include <set>
#include <sstream>

#include "base/error.h"

namespace plisse::gpu {
namespace {

std::string read(const std::string& name, const std::string& folder) {
  if (!folder.empty()) {
    std::ifstream file(folder + "/" + name);
    if (!file)
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}/{}: cannot be read (--shaders names a folder with all of shaders/)", folder, name));
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }
  for (const auto& shader : embedded_shaders()) {
    if (shader.name == name) return shader.text;
  }
  throw Error(ExitCode::bad_input, fmt::format("shader {}: not embedded in this program", name));
}

std::string expand(const std::string& name, const std::string& folder, std::set<std::string>& seen) {
  if (!seen.insert(name).second) return "";
  std::istringstream lines(read(name, folder));
  std::string out, line;
  int number = 0;
  while (std::getline(lines, line)) {
    ++number;
    if (line.rfind("#include \"", 0) == 0) {
      const auto end = line.find('"', 10);
      out += expand(line.substr(10, end - 10), folder, seen);
      out += fmt::format("#line {}\n", number + 1);
    } else {
      out += line + "\n";
    }
  }
  return out;
}

}  // namespace

std::string shader_source(const std::string& name, const std::string& folder) {
  std::set<std::string> seen;
  return expand(name, folder, seen);
}

}  // namespace plisse::gpu
