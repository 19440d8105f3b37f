#include "cloth/solved_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"

namespace plisse::cloth {
namespace {

namespace fs = std::filesystem;

constexpr char magic[8] = {'p', 'l', 'i', 's', 's', 'e', 'c', '1'};
constexpr const char* extension = ".solved";

struct Header {
  char magic[8];
  char key[32];    // the hash
  char check[32];  // checksum of the solution
};

std::string check_of(std::span<const std::uint8_t> bytes) {
  return Hash().add_bytes(bytes).hex();
}

// Hash of the program file, which changes with every change of a solver.
const std::string& program_hash() {
  static const std::string hash = [] {
    try {
      return Hash().add_file("/proc/self/exe").hex();
    } catch (const Error& unreadable) {
      log::info(unreadable.what());
      return std::string();
    }
  }();
  return hash;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

SolvedCache::SolvedCache(fs::path folder, std::uintmax_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

fs::path SolvedCache::user_folder() {
  const fs::path own = variable("PLISSE_CACHE"), caches = variable("XDG_CACHE_HOME"), home = variable("HOME");
  if (own == "none") return {};
  if (own.is_absolute()) return own;
  if (caches.is_absolute()) return caches / "plisse";
  return home.is_absolute() ? home / ".cache" / "plisse" : fs::path();
}

Hash SolvedCache::question(const std::string& kind) {
  Hash hash;
  hash.add(program_hash()).add(kind);
  return hash;
}

fs::path SolvedCache::file_of(const Hash& question) const {
  return folder_ / (question.hex() + extension);
}

std::optional<std::vector<std::uint8_t>> SolvedCache::find(const Hash& question) const {
  if (!on()) return std::nullopt;
  const fs::path file = file_of(question);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  try {
    bytes = read_whole_file(file);
  } catch (const Error& unreadable) {
    log::info(unreadable.what());
    return std::nullopt;
  }
  Header header{};
  if (bytes.size() >= sizeof header) std::memcpy(&header, bytes.data(), sizeof header);
  bytes.erase(bytes.begin(),
              bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), sizeof header)));
  if (std::memcmp(header.magic, magic, sizeof magic) != 0 || std::string(header.key, 32) != question.hex() ||
      std::string(header.check, 32) != check_of(bytes)) {
    log::info(fmt::format("{}: not whole; solved again", file.string()));
    return std::nullopt;
  }
  fs::last_write_time(file, fs::file_time_type::clock::now(), error);  // it was used
  return bytes;
}

void SolvedCache::keep(const Hash& question, std::span<const std::uint8_t> answer) const {
  if (!on()) return;
  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  std::memcpy(header.key, question.hex().data(), 32);
  std::memcpy(header.check, check_of(answer).data(), 32);
  std::vector<std::uint8_t> bytes(sizeof header);
  std::memcpy(bytes.data(), &header, sizeof header);
  bytes.insert(bytes.end(), answer.begin(), answer.end());
  try {
    write_whole_file(file_of(question), bytes);
  } catch (const Error& error) {
    log::warn_once("solved cache", fmt::format("solved answers are not kept: {}", error.what()));
    return;
  }
  // Looking through the folder for each would make long clips slow.
  if ((fresh_ += bytes.size()) < std::min(most_fresh_, most_bytes_ / 16)) return;
  fresh_ = 0;
  make_room();
}

void SolvedCache::make_room() const {
  struct Entry {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code error;
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() != extension) continue;
    std::error_code gone;  // another process may delete it, too
    const std::uintmax_t bytes = it->file_size(gone);
    const auto used = gone ? fs::file_time_type() : it->last_write_time(gone);
    if (gone) continue;
    entries.push_back({it->path(), used, bytes});
    total += bytes;
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (total <= most_bytes_) break;
    if (fs::remove(entry.path, error)) total -= entry.bytes;
  }
}

}  // namespace plisse::cloth
