// Builds glTF files for tests, byte for byte known: accessors and views over one buffer inside the JSON.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

namespace plisse::test {

std::string base64(const std::vector<std::uint8_t>& bytes);

class GltfBuffer {
 public:
  // Component types by their C++ type.
  template <typename Number>
  static constexpr int component();

  // The index of a view of these bytes, aligned to four; `extra` is more JSON of it, with its leading comma.
  template <typename Number>
  int view(const std::vector<Number>& values, const std::string& extra = "") {
    std::vector<std::uint8_t> bytes(values.size() * sizeof(Number));
    if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return add_view(bytes, extra);
  }
  // A view with nothing in buffer 0, described by `json` alone.
  int bare_view(const std::string& json);
  int accessor(const std::string& json);  // as it stands

  // An accessor of its own view. `extra`: more JSON of the accessor.
  template <typename Number>
  int array(const std::string& type, const std::vector<Number>& values, const std::string& extra = "") {
    return accessor_of(view(values), component<Number>(), type, values.size() / width(type), extra);
  }
  int accessor_of(int view, int component, const std::string& type, std::size_t count,
                  const std::string& extra = "");

  // "accessors": …, "bufferViews": …, "buffers": …; without the braces around.
  std::string json() const;

 private:
  static std::size_t width(const std::string& type);
  int add_view(const std::vector<std::uint8_t>& bytes, const std::string& extra);
  std::vector<std::uint8_t> bytes_;
  std::string accessors_, views_;
  int accessor_count_ = 0, view_count_ = 0;
};

template <>
constexpr int GltfBuffer::component<std::int8_t>() {
  return 5120;
}
template <>
constexpr int GltfBuffer::component<std::uint8_t>() {
  return 5121;
}
template <>
constexpr int GltfBuffer::component<std::int16_t>() {
  return 5122;
}
template <>
constexpr int GltfBuffer::component<std::uint16_t>() {
  return 5123;
}
template <>
constexpr int GltfBuffer::component<std::uint32_t>() {
  return 5125;
}
template <>
constexpr int GltfBuffer::component<float>() {
  return 5126;
}

}  // namespace plisse::test
