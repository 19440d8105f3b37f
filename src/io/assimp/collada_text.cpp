#include "io/assimp/collada_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"

namespace plisse::io {
namespace {

constexpr std::string_view blanks = " \t\r\n";

void erase_leading_blanks(std::string& text) {
  std::size_t to = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at++];
    text[to++] = c;
    if (c != '>') continue;
    const std::size_t next = text.find_first_not_of(blanks, at);
    if (next != std::string::npos &&
        std::string_view("+-.0123456789").find(text[next]) != std::string_view::npos)
      at = next;
  }
  text.resize(to);
}

// An element: its opening tag, and what stands in it.
struct Element {
  std::string_view tag, inside;
  std::size_t begin = 0, end = 0;  // in the text, tags included
};

// The next element of this name from `at` on; end 0 where there is none.
Element find_element(std::string_view text, std::string_view name, std::size_t at) {
  const std::string opening = fmt::format("<{}", name), closing = fmt::format("</{}", name);
  for (at = text.find(opening, at); at != std::string_view::npos; at = text.find(opening, at + 1)) {
    const std::size_t after = at + opening.size();
    if (after >= text.size() ||
        (blanks.find(text[after]) == std::string_view::npos && text[after] != '>' && text[after] != '/'))
      continue;
    const std::size_t tag_end = text.find('>', at);
    if (tag_end == std::string_view::npos) return {};
    Element element{text.substr(after, tag_end - after), {}, at, tag_end + 1};
    if (text[tag_end - 1] == '/') return element;
    const std::size_t close = text.find(closing, tag_end);
    const std::size_t end = close == std::string_view::npos ? close : text.find('>', close);
    if (end == std::string_view::npos) return {};
    element.inside = text.substr(tag_end + 1, close - tag_end - 1);
    element.end = end + 1;
    return element;
  }
  return {};
}

template <typename Visit>
void for_each_element(std::string_view text, std::string_view name, const Visit& visit) {
  for (Element one = find_element(text, name, 0); one.end > 0; one = find_element(text, name, one.end))
    visit(one);
}

std::string_view attribute(std::string_view tag, std::string_view name) {
  for (const char quote : {'"', '\''}) {
    const std::string start = fmt::format("{}={}", name, quote);
    for (std::size_t at = tag.find(start); at != std::string_view::npos; at = tag.find(start, at + 1)) {
      if (at > 0 && blanks.find(tag[at - 1]) == std::string_view::npos) continue;
      const std::size_t from = at + start.size();
      return tag.substr(from, tag.find(quote, from) - from);
    }
  }
  return {};
}

std::string_view word_after(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
  rest.remove_prefix(word.size());
  return word;
}

struct Source {
  std::vector<double> numbers;
  std::vector<std::string_view> names;
  std::size_t stride = 1;
  std::string_view parameters;  // the accessor's, as they stand
};

Source read_source(std::string_view inside) {
  Source source;
  if (Element list = find_element(inside, "float_array", 0); list.end > 0)
    for (auto word = word_after(list.inside); !word.empty(); word = word_after(list.inside))
      source.numbers.push_back(parse_number(word).value_or(std::nan("")));
  if (Element list = find_element(inside, "Name_array", 0); list.end > 0)
    for (auto word = word_after(list.inside); !word.empty(); word = word_after(list.inside))
      source.names.push_back(word);
  const Element accessor = find_element(inside, "accessor", 0);
  source.parameters = accessor.inside;
  const double stride = parse_number(attribute(accessor.tag, "stride")).value_or(1);
  source.stride = stride >= 1 && stride <= 64 ? static_cast<std::size_t>(stride) : 1;
  return source;
}

// A curve of several components over time.
class Curve {
 public:
  Curve(const Source& times, const Source& values, const Source* in, const Source* out, const Source& modes)
      : times_(times.numbers), values_(values.numbers), width_(values.stride), modes_(modes.names) {
    const auto fits = [&](const Source* tangents) {
      if (tangents == nullptr) return false;
      per_key_ = tangents->numbers.size() / std::max<std::size_t>(times_.size(), 1);
      return per_key_ == width_ || per_key_ == 2 * width_;
    };
    if (fits(out) && fits(in) && in->numbers.size() == out->numbers.size()) {
      in_ = in->numbers;
      out_ = out->numbers;
    }
    for (const double value : values_) largest_ = std::max(largest_, std::abs(value));
  }

  // Keys that are finite, increase, and have their values.
  bool sound() const {
    const auto finite = [](const std::vector<double>& list) {
      return std::all_of(list.begin(), list.end(), [](double x) { return std::isfinite(x); });
    };
    return times_.size() > 1 && values_.size() == times_.size() * width_ && finite(times_) &&
           finite(values_) && finite(in_) && finite(out_) &&
           std::adjacent_find(times_.begin(), times_.end(), [](double a, double b) { return !(a < b); }) ==
               times_.end();
  }

  std::string_view mode(std::size_t key) const {
    return modes_.empty() ? "LINEAR" : modes_[std::min(key, modes_.size() - 1)];
  }
  bool has_tangents() const { return !in_.empty(); }

  // Times and values of keys between which straight lines do.
  void bake(std::vector<double>& times, std::vector<double>& values) const {
    const auto add = [&](double time, const std::vector<double>& value) {
      times.push_back(time);
      values.insert(values.end(), value.begin(), value.end());
    };
    for (std::size_t i = 0; i < times_.size(); ++i) {
      add(times_[i], key(i));
      if (i + 1 == times_.size()) break;
      const double from = times_[i], to = times_[i + 1];
      if (mode(i) == "STEP") {
        const double lead = std::min(1e-4, 0.1 * (to - from));
        add(to - 2 * lead, key(i));
        add(to - lead, key(i + 1));
      } else if (is_curved(i)) {
        split(i, from, key(i), to, key(i + 1), 0, add);
      }
    }
  }

  bool is_curved(std::size_t i) const {
    return has_tangents() && (mode(i) == "BEZIER" || mode(i) == "HERMITE");
  }

 private:
  std::vector<double> key(std::size_t i) const {
    const auto first = values_.begin() + static_cast<std::ptrdiff_t>(i * width_);
    return {first, first + static_cast<std::ptrdiff_t>(width_)};
  }

  // Component k between the keys i and i + 1. Tangents are points (time, value), or values alone: then time
  // runs evenly. HERMITE's are vectors from the key.
  double at(std::size_t i, std::size_t k, double time) const {
    const double t0 = times_[i], t1 = times_[i + 1];
    const double v0 = values_[i * width_ + k], v1 = values_[(i + 1) * width_ + k];
    const bool points = per_key_ == 2 * width_;
    const std::size_t o = i * per_key_ + (points ? 2 * k : k), n = (i + 1) * per_key_ + (points ? 2 * k : k);
    double x0 = t0 + (t1 - t0) / 3, x1 = t1 - (t1 - t0) / 3;
    double y0 = points ? out_[o + 1] : out_[o], y1 = points ? in_[n + 1] : in_[n];
    const bool hermite = mode(i) == "HERMITE";
    if (points) x0 = hermite ? t0 + out_[o] / 3 : out_[o], x1 = hermite ? t1 - in_[n] / 3 : in_[n];
    if (hermite) y0 = v0 + y0 / 3, y1 = v1 - y1 / 3;
    // Within the keys time only grows along the curve.
    x0 = std::clamp(x0, t0, t1);
    x1 = std::clamp(x1, t0, t1);
    const auto bezier = [](double p, double a, double b, double q, double s) {
      const double r = 1 - s;
      return r * r * r * p + 3 * r * r * s * a + 3 * r * s * s * b + s * s * s * q;
    };
    double low = 0, high = 1;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (bezier(t0, x0, x1, t1, middle) < time ? low : high) = middle;
    }
    return bezier(v0, y0, y1, v1, low);
  }
  std::vector<double> at(std::size_t i, double time) const {
    std::vector<double> value(width_);
    for (std::size_t k = 0; k < width_; ++k) value[k] = at(i, k, time);
    return value;
  }

  template <typename Add>
  void split(std::size_t i, double from, const std::vector<double>& a, double to,
             const std::vector<double>& b, int depth, const Add& add) const {
    constexpr int least = 2, most = 10;  // 4 to 1024 pieces
    const auto straight = [&](double part) {
      const std::vector<double> value = at(i, from + part * (to - from));
      for (std::size_t k = 0; k < width_; ++k)
        if (std::abs(value[k] - (a[k] + part * (b[k] - a[k]))) > 1e-6 * largest_) return false;
      return true;
    };
    if (depth >= most || (depth >= least && straight(0.25) && straight(0.5) && straight(0.75))) return;
    const double middle = 0.5 * (from + to);
    const std::vector<double> value = at(i, middle);
    split(i, from, a, middle, value, depth + 1, add);
    add(middle, value);
    split(i, middle, value, to, b, depth + 1, add);
  }

  std::vector<double> times_, values_, in_, out_;
  std::size_t width_, per_key_ = 0;
  std::vector<std::string_view> modes_;
  double largest_ = 0;
};

std::string source_text(const std::string& id, const std::vector<double>& numbers, std::size_t stride,
                        std::string_view parameters) {
  std::string text =
      fmt::format("<source id=\"{0}\"><float_array id=\"{0}-array\" count=\"{1}\">", id, numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{}{:.9g}", i > 0 ? " " : "", numbers[i]);
  return text + fmt::format(
                    "</float_array><technique_common><accessor source=\"#{}-array\" count=\"{}\" "
                    "stride=\"{}\">{}</accessor></technique_common></source>",
                    id, numbers.size() / stride, stride, parameters);
}

std::string with_straight_curves(const std::filesystem::path& path, const std::string& text) {
  const Element library = find_element(text, "library_animations", 0);
  if (library.end == 0) return text;
  std::map<std::string_view, std::string_view> sources;  // id → inside
  for_each_element(library.inside, "source",
                   [&](const Element& one) { sources[attribute(one.tag, "id")] = one.inside; });
  const std::size_t offset = static_cast<std::size_t>(library.inside.data() - text.data());
  std::string result;
  std::size_t copied = 0, written = 0, made = 0;
  constexpr std::size_t most_numbers = 20'000'000;  // what a damaged file may unfold to
  for_each_element(library.inside, "sampler", [&](const Element& sampler) {
    std::map<std::string_view, Source> inputs;
    for_each_element(sampler.inside, "input", [&](const Element& input) {
      std::string_view id = attribute(input.tag, "source");
      if (id.starts_with('#')) id.remove_prefix(1);
      if (const auto known = sources.find(id); known != sources.end())
        inputs[attribute(input.tag, "semantic")] = read_source(known->second);
    });
    if (!inputs.contains("INPUT") || !inputs.contains("OUTPUT") || !inputs.contains("INTERPOLATION")) return;
    const auto tangents = [&](std::string_view name) {
      return inputs.contains(name) ? &inputs.at(name) : nullptr;
    };
    const Source &times = inputs.at("INPUT"), &values = inputs.at("OUTPUT");
    const Curve curve(times, values, tangents("IN_TANGENT"), tangents("OUT_TANGENT"),
                      inputs.at("INTERPOLATION"));
    if (!curve.sound()) return;
    bool changes = false;
    for (std::size_t i = 0; i + 1 < times.numbers.size(); ++i) {
      const std::string_view mode = curve.mode(i);
      changes |= mode == "STEP" || curve.is_curved(i);
      if (mode != "LINEAR" && mode != "STEP" && !curve.is_curved(i))
        log::warn_once(fmt::format("interpolation {} {}", path.string(), mode),
                       fmt::format("{}: {} keys {}are read as straight lines", path.string(), mode,
                                   mode == "BEZIER" || mode == "HERMITE" ? "without tangents " : ""));
    }
    if (!changes) return;
    std::vector<double> new_times, new_values;
    curve.bake(new_times, new_values);
    written += new_times.size() + new_values.size();
    if (written > most_numbers) {
      log::warn_once(
          "curves " + path.string(),
          fmt::format("{}: too many curves; the last ones are read as straight lines", path.string()));
      return;
    }
    const std::string in = fmt::format("plisse-times-{}", made), out = fmt::format("plisse-values-{}", made);
    ++made;
    result.append(text, copied, offset + sampler.begin - copied);
    result += source_text(in, new_times, 1, times.parameters);
    result += source_text(out, new_values, values.stride, values.parameters);
    result += fmt::format(
        "<sampler id=\"{}\"><input semantic=\"INPUT\" source=\"#{}\"/><input semantic=\"OUTPUT\" "
        "source=\"#{}\"/>"
        "</sampler>",
        attribute(sampler.tag, "id"), in, out);
    copied = offset + sampler.end;
  });
  result.append(text, copied, std::string::npos);
  return result;
}

}  // namespace

std::string collada_text(const std::filesystem::path& path) {
  std::string text = utf8_of_file(read_whole_text(path));
  erase_leading_blanks(text);
  return with_straight_curves(path, text);
}

}  // namespace plisse::io
