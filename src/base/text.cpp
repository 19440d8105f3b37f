#include "base/text.h"

#include <cstdint>

namespace plisse {
namespace {
constexpr std::string_view blanks = " \t\r\f";
}

std::size_t letters(std::string_view text) {
  // Bytes 10xxxxxx continue a letter.
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(std::string text, std::size_t width) {
  const std::size_t count = letters(text);
  if (count < width) text.append(width - count, ' ');
  return text;
}

std::string wrapped(std::string_view text, std::size_t width) {
  std::string lines;
  std::size_t column = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find(' ', start), text.size());
    const std::string_view word = text.substr(start, end - start);
    const std::size_t size = letters(word);
    if (column > 0 && column + 1 + size > width) {
      lines += '\n';
      column = 0;
    } else if (column > 0) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += size;
    start = end + 1;
  }
  return lines;
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::string utf8_of_file(std::string bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  const auto byte = [&](std::size_t at) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at]));
  };
  if (bytes.size() < 2) return bytes;
  const bool little = (byte(0) == 0xFF && byte(1) == 0xFE) || (byte(0) != 0 && byte(1) == 0);
  const bool big = (byte(0) == 0xFE && byte(1) == 0xFF) || (byte(0) == 0 && byte(1) != 0);
  if (!little && !big) return bytes;
  const auto unit = [&](std::size_t at) {
    return little ? byte(at) | byte(at + 1) << 8U : byte(at) << 8U | byte(at + 1);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = unit(0) == 0xFEFF ? 2 : 0; at + 1 < bytes.size(); at += 2) {
    std::uint32_t letter = unit(at);
    if (letter >= 0xD800 && letter < 0xE000) {
      const std::uint32_t second = letter < 0xDC00 && at + 3 < bytes.size() ? unit(at + 2) : 0;
      if (second >= 0xDC00 && second < 0xE000) {
        letter = 0x10000 + ((letter - 0xD800) << 10U) + (second - 0xDC00);
        at += 2;
      } else {
        letter = 0xFFFD;
      }
    }
    const auto put = [&](std::uint32_t value) { text += static_cast<char>(value); };
    if (letter < 0x80) {
      put(letter);
    } else if (letter < 0x800) {
      put(0xC0 | letter >> 6U);
      put(0x80 | (letter & 0x3FU));
    } else if (letter < 0x10000) {
      put(0xE0 | letter >> 12U);
      put(0x80 | (letter >> 6U & 0x3FU));
      put(0x80 | (letter & 0x3FU));
    } else {
      put(0xF0 | letter >> 18U);
      put(0x80 | (letter >> 12U & 0x3FU));
      put(0x80 | (letter >> 6U & 0x3FU));
      put(0x80 | (letter & 0x3FU));
    }
  }
  return text;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

std::string_view next_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (auto word = next_word(text); !word.empty(); word = next_word(text)) words.push_back(word);
  return words;
}

}  // namespace plisse
