#include "base/units.h"

#include <array>
#include <charconv>
#include <system_error>

namespace plisse {
namespace {

// A unit is numerator/denominator metres, both whole: "9 mm" then rounds once and equals 0.009 bit for bit.
// By the international yard and pound agreement of 1959 an inch is 25.4 mm exactly.
struct Unit {
  std::string_view name;
  double numerator, denominator;
};
constexpr std::array<Unit, 5> units = {
    {{"mm", 1, 1000}, {"cm", 1, 100}, {"m", 1, 1}, {"in", 254, 10000}, {"ft", 3048, 10000}}};

void trim_left(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
}

void trim_right(std::string_view& text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
}

// Takes a number off the front of `text`.
std::optional<double> take_number(std::string_view& text) {
  trim_left(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  trim_right(text);
  const auto value = take_number(text);
  return text.empty() ? value : std::nullopt;
}

std::optional<double> parse_length(std::string_view text) {
  trim_right(text);
  const auto value = take_number(text);
  if (!value || text.empty()) return value;
  trim_left(text);
  for (const Unit& unit : units) {
    if (text == unit.name) return *value * unit.numerator / unit.denominator;
  }
  return std::nullopt;
}

}  // namespace plisse
