// A 128-bit fingerprint (XXH3) of settings and input files: it names a frame's content for --skip-existing
// and keys state files. Not for secrets.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

struct XXH3_state_s;

namespace plisse {

// Each value is hashed with its type and, for texts, its length: ("ab", "c") differs from ("a", "bc"), 1
// from 1.0. A copy can be continued independently, so that the values that all frames share are hashed once.
class Hash {
 public:
  Hash();
  Hash(const Hash& other);
  Hash& operator=(const Hash& other);
  ~Hash();

  Hash& add(std::string_view text);
  template <typename Value>
  requires std::is_arithmetic_v<Value> || std::is_enum_v<Value> Hash& add(Value value) {
    if constexpr (std::is_floating_point_v<Value>) {
      return add_double(static_cast<double>(value));
    } else {
      return add_integer(static_cast<std::int64_t>(value));
    }
  }
  // The bytes alone, without kind or length.
  Hash& add_bytes(std::span<const std::uint8_t> bytes);
  // Length and content of a file, not its name or time. Throws Error(bad_input) where it cannot be read.
  Hash& add_file(const std::filesystem::path& path);

  // 32 hexadecimal digits of all so far, as `xxhsum -H2` writes them.
  std::string hex() const;

 private:
  Hash& add_double(double value);  // its bits: −0 and 0 differ
  Hash& add_integer(std::int64_t value);

  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

}  // namespace plisse
