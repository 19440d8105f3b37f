// COLLADA 1.4.1, "accessor": item i of an accessor begins at number offset + i·stride of its array; the array
// states how many numbers it holds. assimp checks indices against the accessor but not the accessor against
// the array.
#include "io/assimp/collada_arrays.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"

namespace plisse::io {
namespace {

// The value of an attribute within a tag, without quotes; "" where it has none of that name.
std::string_view attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    const bool whole = at > 0 && std::string_view(" \t\r\n").find(tag[at - 1]) != std::string_view::npos;
    if (!whole || tag.substr(end, 1) != "=" || end + 1 >= tag.size()) continue;
    const char quote = tag[end + 1];
    const std::size_t close = tag.find(quote, end + 2);
    if ((quote != '"' && quote != '\'') || close == std::string_view::npos) continue;
    return tag.substr(end + 2, close - end - 2);
  }
  return {};
}

std::optional<std::uint64_t> number(std::string_view text, std::optional<std::uint64_t> absent) {
  if (text.empty()) return absent;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return std::nullopt;
  return value;
}

// Calls visit with the inside of every tag of this name.
template <typename Visit>
void for_each_tag(std::string_view text, std::string_view name, const Visit& visit) {
  const std::string opening = fmt::format("<{}", name);
  for (std::size_t at = text.find(opening); at != std::string_view::npos; at = text.find(opening, at + 1)) {
    const std::size_t end = text.find('>', at);
    if (end == std::string_view::npos) return;
    visit(text.substr(at + opening.size(), end - at - opening.size()));
  }
}

}  // namespace

void check_collada_arrays(const std::filesystem::path& path) {
  const std::string file = read_whole_text(path);
  const std::string_view text = file;
  std::map<std::string_view, std::uint64_t> sizes;
  for (const std::string_view kind : {"float_array", "Name_array", "IDREF_array"})
    for_each_tag(text, kind, [&](std::string_view tag) {
      sizes[attribute(tag, "id")] = number(attribute(tag, "count"), 0).value_or(0);
    });
  for_each_tag(text, "accessor", [&](std::string_view tag) {
    const std::string_view source = attribute(tag, "source");
    const auto array = sizes.find(source.substr(source.starts_with('#') ? 1 : 0));
    if (array == sizes.end()) return;  // assimp says so itself
    const auto count = number(attribute(tag, "count"), 0), stride = number(attribute(tag, "stride"), 1),
               offset = number(attribute(tag, "offset"), 0);
    const bool inside = count && stride && offset && *offset <= array->second &&
                        (*count == 0 || *stride <= (array->second - *offset) / *count);
    if (!inside)
      throw Error(
          ExitCode::bad_input,
          fmt::format(
              "{}: an accessor wants {} items of {} numbers from '{}', which holds {}; export it anew",
              path.string(), attribute(tag, "count"), attribute(tag, "stride"), array->first, array->second));
  });
}

}  // namespace plisse::io
