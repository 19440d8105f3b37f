// Files read and written whole or not at all: what stands under a final name is always complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plisse {

// Writes beside the final name and renames, so that neither a crash, a full disk nor a second process leaves
// half a file under `path`. Makes missing folders; keeps a symbolic link and writes where it points; a device
// or pipe is written straight through (renaming over /dev/null would replace it). Throws Error(no_output)
// with path and reason, and then nothing new is left behind.
void write_whole_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_whole_file(const std::filesystem::path& path, std::string_view text);

// The same piece by piece, for what is too large to be held at once: stands under its name from `commit` on,
// and leaves nothing behind without it. All throw Error(no_output).
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

// For a run that writes only at its end: throws what write_whole_file would throw, where that shows by making
// a file beside the final name. Makes missing folders.
void check_writable(const std::filesystem::path& path);

// Throws Error(bad_input) with path and reason (missing, a folder, not readable).
std::vector<std::uint8_t> read_whole_file(const std::filesystem::path& path);
std::string read_whole_text(const std::filesystem::path& path);

}  // namespace plisse
