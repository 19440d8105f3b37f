// Folders and files for tests that write some.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace plisse::test {

// A fresh folder, gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& path);  // "" where it cannot be read
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, std::string_view text);

// Names of what a folder holds, sorted; hidden ones included.
std::vector<std::string> names_in(const std::filesystem::path& folder);

// Files of the project, the finished program, and the data beside the project (which may be absent). The
// paths are known to one source file alone, so that a compiler cache serves every checkout.
std::filesystem::path source_file(const std::string& name);
std::string program_path();
std::filesystem::path asset(const std::string& name);
std::filesystem::path shared_data(const std::string& name);

}  // namespace plisse::test
