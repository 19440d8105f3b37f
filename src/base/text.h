// Text for people: lines that fit, columns that stand below each other.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace plisse {

// Letters of a UTF-8 text, not its bytes.
std::size_t letters(std::string_view text);

// Spaces after the text up to `width` letters; longer texts stay as they are.
std::string padded(std::string text, std::size_t width);

// Lines of at most `width` letters, broken at spaces; a longer word has its own line.
std::string wrapped(std::string_view text, std::size_t width);

// ASCII letters only: for endings of files.
std::string lower_case(std::string text);

}  // namespace plisse
