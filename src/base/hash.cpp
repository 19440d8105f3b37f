#include "base/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <bit>
#include <new>

#include "base/atomic_file.h"

namespace plisse {
namespace {

XXH3_state_s* new_state() {
  XXH3_state_s* state = XXH3_createState();
  if (state == nullptr) throw std::bad_alloc();
  return state;
}

}  // namespace

void Hash::Free::operator()(XXH3_state_s* state) const {
  XXH3_freeState(state);
}

Hash::Hash() : state_(new_state()) {
  XXH3_128bits_reset(state_.get());
}
Hash::Hash(const Hash& other) : state_(new_state()) {
  XXH3_copyState(state_.get(), other.state_.get());
}
Hash& Hash::operator=(const Hash& other) {
  if (this != &other) XXH3_copyState(state_.get(), other.state_.get());
  return *this;
}
Hash::~Hash() = default;

Hash& Hash::add_bytes(std::span<const std::uint8_t> bytes) {
  XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
  return *this;
}

Hash& Hash::add(std::string_view text) {
  add_integer(static_cast<std::int64_t>(text.size()));
  return add_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

Hash& Hash::add_file(const std::filesystem::path& path) {
  const auto bytes = read_whole_file(path);
  add_integer(static_cast<std::int64_t>(bytes.size()));
  return add_bytes(bytes);
}

// Byte by byte from the low end, so that the text is the same on every machine.
static void add_tagged(Hash& hash, std::uint8_t tag, std::uint64_t bits) {
  std::uint8_t bytes[9] = {tag};
  for (int i = 0; i < 8; ++i) bytes[1 + i] = static_cast<std::uint8_t>(bits >> (8 * i));
  hash.add_bytes(bytes);
}

Hash& Hash::add_double(double value) {
  add_tagged(*this, 'd', std::bit_cast<std::uint64_t>(value));
  return *this;
}

Hash& Hash::add_integer(std::int64_t value) {
  add_tagged(*this, 'i', static_cast<std::uint64_t>(value));
  return *this;
}

std::string Hash::hex() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_.get()));
  std::string text;
  for (const unsigned char byte : canonical.digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace plisse
