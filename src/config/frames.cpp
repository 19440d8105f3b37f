#include "config/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>

#include "base/error.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// A whole number from 1 on that takes up all of `text`.
std::optional<int> counting_number(std::string_view text) {
  text = trimmed(text);
  int value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size() || value < 1) return std::nullopt;
  return value;
}

FrameRange parse_range(std::string_view part) {
  const auto wrong = [&](std::string_view what) {
    return Error(ExitCode::bad_input, fmt::format("frames '{}': {}", part, what));
  };
  std::string_view range = part;
  FrameRange result;
  if (const auto times = range.find('x'); times != std::string_view::npos) {
    const auto step = counting_number(range.substr(times + 1));
    if (!step) throw wrong("what follows 'x' is no whole number from 1 on");
    result.step = *step;
    range = range.substr(0, times);
  }
  auto separator = range.find("..");
  std::size_t width = 2;
  if (separator == std::string_view::npos) {
    separator = range.find('-');
    width = 1;
  }
  const bool single = separator == std::string_view::npos;
  const auto first = counting_number(range.substr(0, separator));
  const auto last = single ? first : counting_number(range.substr(separator + width));
  if (!first || !last) throw wrong("not a whole number from 1 on");
  if (single && result.step != 1) throw wrong("a step needs a range");
  if (*last < *first) throw wrong("the range ends before it starts");
  result.first = *first;
  result.last = *last;
  return result;
}

// The last part of a pattern, cut at the place of the frame's number.
struct Place {
  std::string before, after;
  int width = 0;  // digits at least
};

// A place for the number that starts at `start`: ####, %d, %04d, {frame} or {frame:04}.
std::optional<Place> place_at(const std::string& name, std::size_t start) {
  std::size_t at = start;
  const auto take = [&](std::string_view token) {
    const bool there = std::string_view(name).substr(at).starts_with(token);
    if (there) at += token.size();
    return there;
  };
  const auto take_width =
      [&] {  // of at most two digits, so that no pattern asks for names no file system takes
        int width = 0;
        for (int digits = 0; digits < 2 && at < name.size() && name[at] >= '0' && name[at] <= '9'; ++digits) {
          width = 10 * width + (name[at++] - '0');
        }
        return width;
      };
  int width = 0;
  if (take("#")) {
    for (width = 1; take("#");) ++width;
  } else if (take("%")) {
    if (take("0")) width = take_width();
    if (!take("d")) return std::nullopt;
  } else if (take("{frame")) {
    if (take(":")) {
      take("0");
      width = take_width();
    }
    if (!take("}")) return std::nullopt;
  } else {
    return std::nullopt;
  }
  return Place{name.substr(0, start), name.substr(at), width};
}

std::optional<Place> find_place(const std::string& name) {
  for (std::size_t start = 0; start < name.size(); ++start) {
    if (const auto place = place_at(name, start)) return place;
  }
  return std::nullopt;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

bool is_png(const std::string& name) {
  return lower(fs::path(name).extension().string()) == ".png";
}

}  // namespace

std::vector<FrameRange> parse_frames(std::string_view selection) {
  std::vector<FrameRange> ranges;
  for (std::size_t start = 0; start <= selection.size();) {
    const std::size_t comma = std::min(selection.find(',', start), selection.size());
    ranges.push_back(parse_range(trimmed(selection.substr(start, comma - start))));
    start = comma + 1;
  }
  return ranges;
}

std::vector<int> select_frames(const std::string& selection, int count) {
  const auto ranges =
      trimmed(selection).empty() ? std::vector<FrameRange>{{1, count, 1}} : parse_frames(selection);
  std::set<int> frames;
  for (const FrameRange& range : ranges) {
    if (range.last > count) {
      throw Error(ExitCode::bad_input,
                  fmt::format("frames '{}': there is no frame {}; this clip has frames 1 to {}", selection,
                              range.last, count));
    }
    for (std::int64_t frame = range.first; frame <= range.last; frame += range.step) {
      frames.insert(static_cast<int>(frame));
    }
  }
  return {frames.begin(), frames.end()};
}

std::string frame_path(const std::string& pattern, int frame) {
  const fs::path path(pattern);
  const std::string name = path.filename().string();
  const auto place = find_place(name);
  if (!place) {
    return is_png(name) ? pattern : (path / fmt::format("frame_{:04}.png", frame)).string();
  }
  std::string file = fmt::format("{}{:0{}}{}", place->before, frame, place->width, place->after);
  if (!fs::path(name).has_extension()) file += ".png";
  return (path.parent_path() / file).string();
}

std::string numbered_path(const std::string& pattern, int frame) {
  const fs::path path(pattern);
  const auto place = find_place(path.filename().string());
  if (!place) return pattern;
  return (path.parent_path() / fmt::format("{}{:0{}}{}", place->before, frame, place->width, place->after))
      .string();
}

bool is_frame_pattern(const std::string& path) {
  return find_place(fs::path(path).filename().string()).has_value();
}

bool names_many_files(const std::filesystem::path& path) {
  std::error_code ignored;
  return is_frame_pattern(path.string()) && !std::filesystem::exists(path, ignored);
}

void check_frame_pattern(const std::string& pattern) {
  const std::string name = fs::path(pattern).filename().string();
  const std::string extension = lower(fs::path(name).extension().string());
  // A folder may have a dot in its name, but not with such an ending.
  static const std::set<std::string> other_pictures{".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".tga",
                                                    ".bmp", ".webp", ".gif", ".mp4", ".webm", ".mov",
                                                    ".mkv", ".avi",  ".ppm", ".hdr"};
  if ((find_place(name) && !extension.empty() && extension != ".png") || other_pictures.count(extension)) {
    throw Error(ExitCode::bad_input,
                fmt::format("'{}': frames are written as PNG; end the name in .png", pattern));
  }
}

void check_frame_paths(const std::string& pattern, std::span<const int> frames) {
  std::set<std::string> paths;
  for (const int frame : frames) {
    const std::string path = frame_path(pattern, frame);
    if (paths.insert(path).second) continue;
    const fs::path name(path);
    const auto better = name.parent_path() / (name.stem().string() + "_####.png");
    throw Error(ExitCode::bad_input,
                fmt::format("'{}' names one file for {} frames; give it a place for the number: '{}'",
                            pattern, frames.size(), better.string()));
  }
}

}  // namespace plisse::config
