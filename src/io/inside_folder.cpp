// Names that stay in their folder (see inside_folder.h).
#include "io/inside_folder.h"

#include <algorithm>
#include <cctype>

namespace plisse::io {

std::string percent_decoded(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto hex = [&](std::size_t at) { return std::isxdigit(static_cast<unsigned char>(text[at])) != 0; };
    if (text[i] == '%' && i + 2 < text.size() && hex(i + 1) && hex(i + 2)) {
      result += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

std::filesystem::path inside_folder(const std::filesystem::path& folder, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (name.find('\0') != std::string::npos) return {};  // the system would read it only so far
  const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) return {};
  const fs::path file = fs::weakly_canonical(root / name, error);
  if (error) return {};
  const auto [end, rest] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  return end == root.end() ? folder / name : fs::path{};
}

}  // namespace plisse::io
