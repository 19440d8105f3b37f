// Damaged copies of a file, always the same for a seed: bytes flipped, counts blown up, pieces cut out,
// doubled, moved.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

namespace plisse::test {

inline std::string mutant_of(const std::string& original, std::uint32_t seed) {
  // mt19937 is the same everywhere; the library's distributions are not, so numbers are taken by remainder.
  std::mt19937 random(seed);
  const auto below = [&](std::size_t bound) { return bound == 0 ? 0 : random() % bound; };
  std::string text = original;
  for (std::size_t hits = 1 + below(4); hits > 0 && !text.empty(); --hits) {
    const std::size_t at = below(text.size()), length = std::min(1 + below(64), text.size() - at);
    switch (below(8)) {
      case 0:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        text[at] = "\0\xFF\x7F\x80 \n-9"[below(8)];
        break;
      case 2: {  // a count or an index gone wild
        constexpr std::uint32_t wild[] = {0xFFFFFFFF, 0x7FFFFFFF, 0x80000000,
                                          0x10000000, 1000000,    0x7F800000};
        const std::uint32_t value = wild[below(6)];
        if (text.size() - at >= sizeof value) std::memcpy(&text[at], &value, sizeof value);
        break;
      }
      case 3: {  // the same in words
        constexpr const char* wild[] = {"4294967295",           "-1", "1e999", "nan",
                                        "99999999999999999999", "\"", "}",     "0"};
        text.replace(at, std::min(length, std::size_t{4}), wild[below(8)]);
        break;
      }
      case 4:
        text.erase(at, length);
        break;
      case 5:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 6:
        text.resize(at);
        break;
      default:
        std::swap_ranges(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(length, at)),
                         text.begin() + static_cast<std::ptrdiff_t>(at));
        break;
    }
  }
  return text;
}

}  // namespace plisse::test
