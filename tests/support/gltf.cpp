#include "support/gltf.h"

#include <cstring>

#include "support/files.h"

namespace plisse::test {
namespace {

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

void append(std::string& bytes, std::uint32_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

// glTF 2.0, "GLB File Format": a header of 12 bytes, then chunks of length, type and content; JSON is first.
std::filesystem::path altered_glb(const std::filesystem::path& source, const std::filesystem::path& target,
                                  const std::function<void(nlohmann::json&)>& alter) {
  const std::string bytes = read_text(source);
  const std::size_t length = number_at(bytes, 12);
  nlohmann::json json = nlohmann::json::parse(bytes.substr(20, length));
  alter(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = bytes.substr(20 + length);
  std::string result = bytes.substr(0, 8);
  append(result, static_cast<std::uint32_t>(20 + text.size() + rest.size()));
  append(result, static_cast<std::uint32_t>(text.size()));
  result += bytes.substr(16, 4) + text + rest;
  write_text(target, result);
  return target;
}

}  // namespace plisse::test
