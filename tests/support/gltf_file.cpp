#include "support/gltf_file.h"

#include <fmt/format.h>

namespace plisse::test {

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : letters[group >> (18 - 6 * k) & 63U];
  }
  return text;
}

std::size_t GltfBuffer::width(const std::string& type) {
  return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type.back() - '0');
}

int GltfBuffer::add_view(const std::vector<std::uint8_t>& bytes, const std::string& extra) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  const std::string json =
      fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", bytes_.size(), bytes.size(), extra);
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return bare_view(json);
}

int GltfBuffer::bare_view(const std::string& json) {
  views_ += (view_count_ > 0 ? "," : "") + json;
  return view_count_++;
}

int GltfBuffer::accessor(const std::string& json) {
  accessors_ += (accessor_count_ > 0 ? "," : "") + json;
  return accessor_count_++;
}

int GltfBuffer::accessor_of(int view, int component, const std::string& type, std::size_t count,
                            const std::string& extra) {
  return accessor(fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})", view,
                              component, count, type, extra));
}

std::string GltfBuffer::json() const {
  return fmt::format(R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{},"uri":)"
                     R"("data:application/octet-stream;base64,{}"}}])",
                     accessors_, views_, bytes_.size(), base64(bytes_));
}

}  // namespace plisse::test
