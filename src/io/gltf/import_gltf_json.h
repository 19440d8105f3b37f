// Values of a glTF's JSON with their place in it: a value of the wrong type, out of range or missing gives an
// error such as "cloth.gltf: meshes[0].primitives[1].indices: is 7, of 5 accessors".
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace plisse::io {

class GltfValue {
 public:
  GltfValue(const std::filesystem::path& file, const nlohmann::json* json, std::string where);

  explicit operator bool() const { return json_ != nullptr; }  // whether it is there
  [[noreturn]] void fail(const std::string& what) const;       // throws Error(bad_input)

  // Objects. A missing object has no members.
  GltfValue operator[](const std::string& key) const;
  std::vector<std::pair<std::string, GltfValue>> members() const;
  // Arrays. A missing one is empty.
  std::size_t size() const;
  GltfValue at(std::size_t index) const;

  // Plain values; without a fallback they must exist.
  std::string text(const std::string& fallback) const;
  bool truth(bool fallback) const;
  double number() const;  // finite
  double number(double fallback) const { return *this ? number() : fallback; }
  std::uint64_t count() const;  // a whole number from 0 to 2^53
  std::uint64_t count(std::uint64_t fallback) const { return *this ? count() : fallback; }
  // An index into `list`, which is there.
  std::size_t index(const GltfValue& list) const;
  int index_or_none(const GltfValue& list) const { return *this ? static_cast<int>(index(list)) : -1; }
  // `size` finite numbers, or the fallback.
  std::vector<double> numbers(std::size_t size, const std::vector<double>& fallback) const;

 private:
  const std::filesystem::path* file_;
  const nlohmann::json* json_;
  std::string where_;
};

}  // namespace plisse::io
