#include "sizing/obj_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

class Reader {
 public:
  // What stands before the first group belongs to none.
  explicit Reader(std::string_view name) : wanted_(name), within_(name.empty()) {}

  void read(std::string_view text) {
    for (line_ = 1; !text.empty(); ++line_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      read_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!wanted_.empty() && !seen_) {
      std::string names;
      for (const std::string& known : names_) names += (names.empty() ? "" : ", ") + known;
      throw Error(ExitCode::bad_input, fmt::format("has no group or object '{}'; it has {}", wanted_,
                                                   names.empty() ? "none" : names));
    }
  }

  // The edges that count, each once.
  std::vector<Edge> edges() const {
    std::vector<Edge> result;
    if (!lines_.empty()) {
      result.assign(lines_.begin(), lines_.end());
    } else {
      for (const auto& [edge, uses] : sides_)
        if (uses == 1) result.push_back(edge);
    }
    if (result.empty())
      throw Error(ExitCode::bad_input, wanted_.empty()
                                           ? "has neither lines nor faces with a boundary"
                                           : fmt::format("'{}' has neither lines nor faces with a "
                                                         "boundary",
                                                         wanted_));
    return result;
  }

  // The plane's coordinates of those points that the edges use.
  std::map<std::uint32_t, dvec2> flat(const std::vector<Edge>& edges) const {
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const auto& [a, b] : edges)
      for (const std::uint32_t v : {a, b}) {
        low = glm::min(low, points_[v]);
        high = glm::max(high, points_[v]);
      }
    const glm::dvec3 extent = high - low;
    const double size = std::max({extent.x, extent.y, extent.z});
    // Six digits of a file leave 1e-6 of a plane; z first, since a line along an axis lies in two.
    const int across = extent.z <= 1e-5 * size   ? 2
                       : extent.y <= 1e-5 * size ? 1
                       : extent.x <= 1e-5 * size ? 0
                                                 : -1;
    if (across < 0)
      throw Error(ExitCode::bad_input,
                  fmt::format("is not flat: it measures {:g} × {:g} × {:g}, one of which must be 0", extent.x,
                              extent.y, extent.z));
    std::map<std::uint32_t, dvec2> result;
    for (const auto& [a, b] : edges)
      for (const std::uint32_t v : {a, b}) {
        const glm::dvec3& p = points_[v];
        result[v] = across == 2 ? dvec2(p.x, p.y) : across == 1 ? dvec2(p.x, -p.z) : dvec2(-p.z, p.y);
      }
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("line {}: {}", line_, what));
  }

  static std::string_view next(std::string_view& rest) {
    constexpr const char* blanks = " \t\r";
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
    rest.remove_prefix(word.size());
    return word;
  }

  void read_line(std::string_view rest) {
    const std::string_view key = next(rest);
    if (key == "v") {
      glm::dvec3 point{0};
      for (int i = 0; i < 3; ++i) point[i] = number(next(rest));
      points_.push_back(point);
    } else if (key == "o" || key == "g") {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r"), rest.size()));
      const std::size_t last = rest.find_last_not_of(" \t\r");
      const std::string name(rest.substr(0, last == std::string_view::npos ? 0 : last + 1));
      names_.insert(name);
      (key == "o" ? object_ : group_) = name;
      if (key == "o") group_.clear();
      within_ = wanted_.empty() || object_ == wanted_ || group_ == wanted_;
      seen_ |= within_;
    } else if ((key == "l" || key == "f") && within_) {
      read_element(key == "l", rest);
    }
  }

  void read_element(bool is_line, std::string_view rest) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = next(rest); !word.empty() && word.front() != '#'; word = next(rest))
      corners.push_back(index(word.substr(0, word.find('/'))));
    if (corners.size() < (is_line ? 2U : 3U))
      fail(is_line ? "a line needs two points" : "a face needs three corners");
    const std::size_t count = is_line ? corners.size() - 1 : corners.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % corners.size()];
      if (a == b) continue;
      const Edge edge = std::minmax(a, b);
      if (is_line)
        lines_.insert(edge);
      else
        ++sides_[edge];
    }
  }

  double number(std::string_view word) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
      fail(fmt::format("'{}' is no finite number", word));
    return value;
  }

  std::uint32_t index(std::string_view word) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const auto count = static_cast<std::int64_t>(points_.size());
    const std::int64_t resolved = value < 0 ? value + count : value - 1;
    if (word.empty() || error != std::errc{} || end != word.data() + word.size() || resolved < 0 ||
        resolved >= count)
      fail(fmt::format("there is no vertex '{}': the file has {} so far", word, count));
    return static_cast<std::uint32_t>(resolved);
  }

  std::string_view wanted_;
  std::string object_, group_;  // that the lines belong to now
  bool within_, seen_ = false;
  std::size_t line_ = 0;
  std::set<std::string> names_;
  std::vector<glm::dvec3> points_;
  std::set<Edge> lines_;
  std::map<Edge, int> sides_;
};

}  // namespace

std::vector<Polyline> parse_obj_lines(std::string_view text, std::string_view name) {
  Reader reader(name);
  reader.read(text);
  const std::vector<Edge> edges = reader.edges();
  const auto place = reader.flat(edges);
  std::map<std::uint32_t, std::vector<std::uint32_t>> beside;
  for (const auto& [a, b] : edges) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  for (const auto& [v, others] : beside)
    if (others.size() > 2)
      throw Error(ExitCode::bad_input,
                  fmt::format("{} lines meet at vertex {}; a curve has two ends and goes on in between",
                              others.size(), v + 1));
  std::set<std::uint32_t> done;
  std::vector<Polyline> chains;
  const auto follow = [&](std::uint32_t start, bool closed) {
    Polyline& chain = chains.emplace_back();
    chain.closed = closed;
    for (std::uint32_t v = start;;) {
      done.insert(v);
      chain.points.push_back(place.at(v));
      const auto& others = beside.at(v);
      const auto next =
          std::find_if(others.begin(), others.end(), [&](std::uint32_t o) { return !done.contains(o); });
      if (next == others.end()) return;
      v = *next;
    }
  };
  for (const auto& [v, others] : beside)
    if (others.size() == 1 && !done.contains(v)) follow(v, false);
  for (const auto& [v, others] : beside)
    if (!done.contains(v)) follow(v, true);
  std::stable_sort(chains.begin(), chains.end(),
                   [](const Polyline& a, const Polyline& b) { return a.length() > b.length(); });
  return chains;
}

std::vector<Polyline> outline_first(std::vector<Polyline> chains) {
  for (const Polyline& chain : chains)
    if (!chain.closed)
      throw Error(ExitCode::bad_input,
                  fmt::format("a line is open: it begins at ({:g}, {:g}) and ends at ({:g}, {:g}); outlines "
                              "are closed",
                              chain.points.front().x, chain.points.front().y, chain.points.back().x,
                              chain.points.back().y));
  const auto largest =
      std::max_element(chains.begin(), chains.end(), [](const Polyline& a, const Polyline& b) {
        return std::abs(signed_area(a)) < std::abs(signed_area(b));
      });
  if (largest == chains.end()) throw Error(ExitCode::bad_input, "has no line");
  std::rotate(chains.begin(), largest, largest + 1);
  for (std::size_t i = 1; i < chains.size(); ++i)
    if (!contains(chains[0], chains[i].points.front()))
      throw Error(ExitCode::bad_input,
                  fmt::format("has {} closed lines beside one another, the first two near ({:g}, {:g}) and "
                              "({:g}, {:g}); one is wanted, with its holes in it: name a group by 'id'",
                              chains.size(), chains[0].points.front().x, chains[0].points.front().y,
                              chains[i].points.front().x, chains[i].points.front().y));
  return chains;
}

}  // namespace plisse::sizing
