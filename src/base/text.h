// Text for users: wrapped lines and aligned columns. Text of files: its lines and their
// words.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace plisse {

// Letters of a UTF-8 text, not its bytes.
std::size_t letters(std::string_view text);

// Spaces after the text up to `width` letters; longer texts stay as they are.
std::string padded(std::string text, std::size_t width);

// Lines of at most `width` letters, broken at spaces; a longer word has its own line.
std::string wrapped(std::string_view text, std::size_t width);

// ASCII letters only: for endings of files.
std::string lower_case(std::string text);

// The bytes of a text file as UTF-8 without a byte order mark: UTF-16 of either byte order, known by its mark
// or by the zeros beside its first letter, is converted (halves of pairs that stand alone become U+FFFD).
std::string utf8_of_file(std::string bytes);

// Calls visit(line, number) for every line of `text`, without its line feed; numbers count from 1.
template <typename Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    visit(text.substr(0, end), number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// Words are what stands between blanks: space, tab, carriage return and form feed.
std::string_view trimmed(std::string_view text);     // without blanks at its ends
std::string_view next_word(std::string_view& text);  // takes the first word off; empty where there is none
std::vector<std::string_view> words_of(std::string_view text);

}  // namespace plisse
