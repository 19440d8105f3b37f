// Solutions of earlier runs, by a hash of everything that they depend on: one file each, in a folder of the
// user. The program itself is part of the hash, so a new version does not use solutions of an old one. The
// processor is not: dense blocks have the same bytes with and without AVX2 (shell/dense.h), and the last bits
// of the C library's functions, which may depend on it, only give another solution that has converged as
// well.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/hash.h"

namespace plisse::cloth {

// The results that a run took from the cache.
struct Reuse {
  int answers = 0;
  double saved_s = 0;  // the time of their solves, less the time to look them up
};

class SolvedCache {
 public:
  // Empty: the cache is off.
  explicit SolvedCache(std::filesystem::path folder = {},
                       std::uintmax_t most_bytes = std::uintmax_t{1} << 30);

  // $PLISSE_CACHE ("none": off), $XDG_CACHE_HOME/plisse, or .cache/plisse in $HOME: the first that is an
  // absolute path; empty where none is.
  static std::filesystem::path user_folder();

  bool on() const { return !folder_.empty(); }
  // The begin of a hash, with the program and the kind of solution; everything else that the solution depends
  // on is added by the caller.
  static Hash question(const std::string& kind);
  // Nothing where there is none, or where the file is damaged.
  std::optional<std::vector<std::uint8_t>> find(const Hash& question) const;
  // Written completely or not at all; files not used for the longest time are deleted to make room. A failure
  // to write is ignored.
  void keep(const Hash& question, std::span<const std::uint8_t> answer) const;

 private:
  std::filesystem::path file_of(const Hash& question) const;
  void make_room() const;
  std::filesystem::path folder_;
  mutable std::atomic<std::uintmax_t> fresh_ = most_fresh_;  // bytes since room was made; at first, at once
  static constexpr std::uintmax_t most_fresh_ = std::uintmax_t{64} << 20;
  std::uintmax_t most_bytes_;
};

}  // namespace plisse::cloth
