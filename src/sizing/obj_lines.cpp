#include "sizing/obj_lines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "io/obj.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

// The edges that count, each once: lines, or else the boundary of the faces.
std::vector<Edge> edges_of(const io::ObjFile& obj, std::string_view name) {
  std::set<std::string_view> names;
  std::set<Edge> lines;
  std::map<Edge, int> sides;
  bool found = name.empty();
  for (std::size_t r = 0; r < obj.runs.size(); ++r) {
    const io::ObjFile::Run& run = obj.runs[r];
    const bool last = r + 1 == obj.runs.size();
    const std::size_t line_end = last ? obj.lines.size() : obj.runs[r + 1].first_line,
                      triangle_end = last ? obj.triangles.size() : obj.runs[r + 1].first_triangle;
    names.insert(run.object);
    names.insert(run.name);
    if (!name.empty() && run.object != name && run.name != name) continue;
    found = true;
    for (std::size_t l = run.first_line; l < line_end; ++l)
      if (const auto& [a, b] = obj.lines[l]; a != b) lines.insert(std::minmax(a, b));
    for (std::size_t t = run.first_triangle; t < triangle_end; ++t) {
      const auto corner = [&](std::size_t c) { return obj.triangles[t][c % 3].position; };
      // A polygon that names a corner twice gives triangles without area, whose sides are not boundary edges.
      if (corner(0) == corner(1) || corner(1) == corner(2) || corner(2) == corner(0)) continue;
      for (std::size_t c = 0; c < 3; ++c) ++sides[std::minmax<std::uint32_t>(corner(c), corner(c + 1))];
    }
  }
  names.erase("");
  if (!found)
    throw Error(ExitCode::bad_input,
                fmt::format("{}: has no group or object '{}'; it has {}", obj.path.string(), name,
                            names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
  std::vector<Edge> edges(lines.begin(), lines.end());
  if (edges.empty())
    for (const auto& [edge, uses] : sides)
      if (uses == 1) edges.push_back(edge);
  if (edges.empty())
    throw Error(ExitCode::bad_input,
                fmt::format("{}: {}has neither lines nor faces with a boundary", obj.path.string(),
                            name.empty() ? "" : fmt::format("'{}' ", name)));
  return edges;
}

// The plane's coordinates of those points that the edges use.
std::map<std::uint32_t, dvec2> flat(const io::ObjFile& obj, const std::vector<Edge>& edges) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const auto& [a, b] : edges)
    for (const std::uint32_t v : {a, b}) {
      low = glm::min(low, obj.positions[v]);
      high = glm::max(high, obj.positions[v]);
    }
  const glm::dvec3 extent = high - low;
  const double size = std::max({extent.x, extent.y, extent.z});
  // Six digits in a file give an error of 1e-6; z is tested first, since a line along an axis is in two
  // planes.
  const int across = extent.z <= 1e-5 * size   ? 2
                     : extent.y <= 1e-5 * size ? 1
                     : extent.x <= 1e-5 * size ? 0
                                               : -1;
  if (across < 0)
    throw Error(ExitCode::bad_input,
                fmt::format("{}: is not flat: it measures {:g} × {:g} × {:g}, one of which must be 0",
                            obj.path.string(), extent.x, extent.y, extent.z));
  std::map<std::uint32_t, dvec2> result;
  for (const auto& [a, b] : edges)
    for (const std::uint32_t v : {a, b}) {
      const glm::dvec3& p = obj.positions[v];
      result[v] = across == 2 ? dvec2(p.x, p.y) : across == 1 ? dvec2(p.x, -p.z) : dvec2(-p.z, p.y);
    }
  return result;
}

}  // namespace

std::vector<Polyline> read_obj_lines(const std::filesystem::path& path, std::string_view name) {
  const io::ObjFile obj = io::read_obj(path, {.lines = true});
  const std::vector<Edge> edges = edges_of(obj, name);
  const auto place = flat(obj, edges);
  std::map<std::uint32_t, std::vector<std::uint32_t>> beside;
  for (const auto& [a, b] : edges) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  for (const auto& [v, others] : beside)
    if (others.size() > 2)
      throw Error(ExitCode::bad_input,
                  fmt::format("{}: {} lines meet at vertex {}; a curve has two ends and goes on in between",
                              path.string(), others.size(), v + 1));
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

std::vector<Polyline> read_obj_outline(const std::filesystem::path& path, std::string_view name) {
  std::vector<Polyline> chains = read_obj_lines(path, name);
  for (const Polyline& chain : chains)
    if (!chain.closed)
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: a line is open: it begins at ({:g}, {:g}) and ends at ({:g}, {:g}); outlines "
                      "are closed",
                      path.string(), chain.points.front().x, chain.points.front().y, chain.points.back().x,
                      chain.points.back().y));
  const auto largest =
      std::max_element(chains.begin(), chains.end(), [](const Polyline& a, const Polyline& b) {
        return std::abs(signed_area(a)) < std::abs(signed_area(b));
      });
  std::rotate(chains.begin(), largest, largest + 1);
  for (std::size_t i = 1; i < chains.size(); ++i)
    if (!contains(chains[0], chains[i].points.front()))
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: has {} closed lines beside one another, the first two near ({:g}, {:g}) and "
                      "({:g}, {:g}); one is wanted, with its holes in it: name a group by 'id'",
                      path.string(), chains.size(), chains[0].points.front().x, chains[0].points.front().y,
                      chains[i].points.front().x, chains[i].points.front().y));
  return chains;
}

}  // namespace plisse::sizing
