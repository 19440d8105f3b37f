// Files are read and written completely or not at all: a file under its final name is always complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plisse {

// Writes a temporary file in the same folder and renames it, so that a crash, a full disk or a second process
// never leaves an incomplete file under `path`. Makes missing folders; keeps a symbolic link and writes to
// its target; writes to a device or pipe directly (renaming over /dev/null would replace it). Throws
// Error(no_output) with path and reason; then no new file is left.
void write_whole_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_whole_file(const std::filesystem::path& path, std::string_view text);

// The same in pieces, for data too large for memory: the file gets its name in `commit`; without it no file
// is left. All throw Error(no_output).
class WholeFile {
 public:
  explicit WholeFile(const std::filesystem::path& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  void append(std::span<const std::uint8_t> bytes);
  void commit();

 private:
  std::filesystem::path path_, target_, temporary_;  // temporary_ is empty for devices and once committed
  int file_ = -1;
};

// For a run that writes only at its end: throws early the errors of write_whole_file that can be found by
// making a temporary file. Makes missing folders.
void check_writable(const std::filesystem::path& path);

// Throws Error(bad_input) with path and reason (missing, a folder, not readable).
std::vector<std::uint8_t> read_whole_file(const std::filesystem::path& path);
std::string read_whole_text(const std::filesystem::path& path);

}  // namespace plisse
