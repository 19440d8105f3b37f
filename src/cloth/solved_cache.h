// Answers that were found before, by a hash of all that they depend on: values in a file each, in a folder of
// the user's. The program itself is part of the hash, so a new version finds nothing of an old one's. The
// processor is not: dense blocks have the same bytes with AVX2 and without (shell/dense.h), and what else
// depends on it, the last bits of the C library's functions, makes another answer that balances as well.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/hash.h"

namespace plisse::cloth {

class SolvedCache {
 public:
  // Empty: off; nothing is found, nothing kept.
  explicit SolvedCache(std::filesystem::path folder = {},
                       std::uintmax_t most_bytes = std::uintmax_t{1} << 30);

  // $PLISSE_CACHE ("none": off), $XDG_CACHE_HOME/plisse, or .cache/plisse in $HOME: the first that is an
  // absolute path; empty where none is.
  static std::filesystem::path user_folder();

  bool on() const { return !folder_.empty(); }
  // A hash to add what an answer depends on to; begins with the program and with what kind of answer it is.
  static Hash question(const std::string& kind);
  // Nothing where there is none, or where the file is not whole.
  std::optional<std::vector<std::uint8_t>> find(const Hash& question) const;
  // Written whole or not at all; what was used longest ago makes room. That it cannot be written is no
  // failure.
  void keep(const Hash& question, std::span<const std::uint8_t> answer) const;

 private:
  std::filesystem::path file_of(const Hash& question) const;
  void make_room() const;
  std::filesystem::path folder_;
  std::uintmax_t most_bytes_;
};

}  // namespace plisse::cloth
