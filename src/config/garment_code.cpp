#include "config/garment_code.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/suggest.h"

namespace plisse::config {
namespace {

using glm::dvec2;
using glm::dvec3;
using Json = nlohmann::ordered_json;

// An edge of a panel as a curve from its first to its second endpoint.
struct Edge {
  sizing::Polyline curve;
  double length = 0;
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const sizing::Fabric& fabric) : file_(file), fabric_(fabric) {}

  sizing::Garment run(const Json& root) {
    const Json& pattern = member(root, "pattern", "");
    const Json& panels = member(pattern, "panels", "pattern.");
    if (const auto properties = root.find("properties");
        properties != root.end() && properties->is_object()) {
      const double units = properties->value("units_in_meter", 100.0);
      if (units > 0 && std::isfinite(units))
        metres_ = 1 / units;
      else
        problem("properties.units_in_meter", "must be above 0");
      absolute_ = properties->value("curvature_coords", std::string("relative")) == "absolute";
    }
    if (!panels.is_object() || panels.empty()) problem("pattern.panels", "has no panels");
    report();
    for (const auto& [name, panel] : panels.items()) read_panel(name, panel);
    report();
    if (const auto stitches = pattern.find("stitches"); stitches != pattern.end())
      for (std::size_t s = 0; s < stitches->size(); ++s) read_stitch((*stitches)[s], s);
    report();
    return std::move(garment_);
  }

 private:
  void problem(const std::string& place, const std::string& text) {
    problems_ += fmt::format("{}{}: {}: {}", problems_.empty() ? "" : "\n", file_.string(), place, text);
  }
  void report() const {
    if (!problems_.empty()) throw Error(ExitCode::bad_input, problems_);
  }
  const Json& member(const Json& of, const std::string& name, const std::string& place) {
    static const Json none;
    if (of.is_object())
      if (const auto found = of.find(name); found != of.end()) return *found;
    problem(place + name, "is missing");
    report();
    return none;
  }

  // An array of so many finite numbers.
  bool numbers(const Json& of, std::size_t count, double* values) const {
    if (!of.is_array() || of.size() != count) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (!of[i].is_number()) return false;
      values[i] = of[i].get<double>();
      if (!std::isfinite(values[i])) return false;
    }
    return true;
  }
  bool point(const Json& of, dvec2& value) const { return numbers(of, 2, &value.x); }

  void read_panel(const std::string& name, const Json& source) {
    const std::string place = "pattern.panels." + name;
    sizing::Panel panel;
    panel.name = name;
    panel.fabric = fabric_;
    if (name.empty() || name.find_first_of("/\\\n") != std::string::npos || name.front() == '.')
      problem(place, "the name names files: no empty text, no slashes, no dot in front");
    std::vector<dvec2> vertices;
    const Json& list = member(source, "vertices", place + ".");
    for (std::size_t v = 0; v < list.size(); ++v) {
      dvec2& vertex = vertices.emplace_back(0);
      if (!point(list[v], vertex)) problem(fmt::format("{}.vertices[{}]", place, v), "is no point [x, y]");
    }
    const Json& edges = member(source, "edges", place + ".");
    std::vector<Edge> made;
    std::size_t first = 0, last = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const std::string at = fmt::format("{}.edges[{}]", place, e);
      const Json& ends = member(edges[e], "endpoints", at + ".");
      const auto end = [&](std::size_t i) {
        return ends.is_array() && ends.size() == 2 && ends[i].is_number_unsigned()
                   ? ends[i].get<std::size_t>()
                   : vertices.size();
      };
      const std::size_t from = end(0), to = end(1);
      if (from >= vertices.size() || to >= vertices.size()) {
        problem(at + ".endpoints",
                fmt::format("must be two of the {} vertices, counted from 0", vertices.size()));
        continue;
      }
      if (e == 0) first = from;
      if (e > 0 && from != last)
        problem(at, "does not begin where the edge before it ends: edges go round the panel");
      last = to;
      read_edge(edges[e], at, vertices[from], vertices[to], made);
    }
    if (edges.size() < 2 || last != first) problem(place + ".edges", "do not close the panel's outline");
    panel.outline.closed = true;
    for (const Edge& edge : made)
      panel.outline.points.insert(panel.outline.points.end(), edge.curve.points.begin(),
                                  edge.curve.points.end() - 1);
    panel.outline = without_repeats(std::move(panel.outline));

    sizing::Placement placement;
    dvec3 turn(0);
    if (const auto given = source.find("translation"); given != source.end()) {
      if (!numbers(*given, 3, &placement.translation.x)) problem(place + ".translation", "is no [x, y, z]");
      placement.translation *= metres_;
    }
    if (const auto given = source.find("rotation"); given != source.end()) {
      if (!numbers(*given, 3, &turn.x)) problem(place + ".rotation", "is no [x, y, z] in degrees");
      placement.rotation = sizing::turned_by(turn);
    }
    garment_.panels.push_back(std::move(panel));
    garment_.placements.push_back(placement);
    edges_.push_back(std::move(made));
  }

  // As SVG path data: a line, Béziers with one or two control points, or an arc of a circle.
  void read_edge(const Json& source, const std::string& at, const dvec2& from, const dvec2& to,
                 std::vector<Edge>& made) {
    std::string path = fmt::format("M {} {} ", from.x, from.y);
    const auto curvature = source.find("curvature");
    const auto control = [&](const Json& given) {
      dvec2 p(0);
      if (!point(given, p)) problem(at + ".curvature", "has a control point that is no [x, y]");
      // Relative: the edge is (1, 0), what lies to its left is up.
      const dvec2 along = to - from, left(-along.y, along.x);
      if (!absolute_) p = from + p.x * along + p.y * left;
      return fmt::format("{} {} ", p.x, p.y);
    };
    if (curvature == source.end() || curvature->is_null()) {
      path += "L ";
    } else if (curvature->is_array()) {
      path += "Q " + control(*curvature);
    } else {
      const std::string type =
          curvature->is_object() ? curvature->value("type", std::string()) : std::string();
      const Json params = curvature->is_object() ? curvature->value("params", Json::array()) : Json::array();
      if (type == "quadratic" && params.size() == 1) {
        path += "Q " + control(params[0]);
      } else if (type == "cubic" && params.size() == 2) {
        path += "C " + control(params[0]) + control(params[1]);
      } else if (type == "circle" && params.size() == 3 && params[0].is_number() &&
                 params[0].get<double>() > 0) {
        const auto flag = [](const Json& value) {
          return value.is_boolean() ? value.get<bool>() : value.is_number() && value.get<double>() != 0;
        };
        path += fmt::format("A {0} {0} 0 {1:d} {2:d} ", params[0].get<double>(), flag(params[1]),
                            flag(params[2]));
      } else {
        problem(at + ".curvature",
                "must be a control point, or a type (quadratic, cubic, circle) with its 1, 2 or 3 params");
      }
    }
    path += fmt::format("{} {}", to.x, to.y);
    Edge& edge = made.emplace_back();
    edge.curve = {{from, to}, false};
    if (problems_.empty()) edge.curve = sizing::parse_path(path).at(0);
    for (dvec2& p : edge.curve.points) p *= metres_;
    edge.length = edge.curve.length();
    if (!(edge.length > 0)) problem(at, "has no length");
  }

  void read_stitch(const Json& source, std::size_t number) {
    const std::string at = fmt::format("pattern.stitches[{}]", number);
    sizing::Seam seam;
    seam.name = fmt::format("stitch{}", number);
    if (!source.is_array() || source.size() < 2) return problem(at, "must be two edges of panels");
    dvec3 ends[2][2];
    for (const std::size_t i : {0U, 1U}) {
      const std::string place = fmt::format("{}[{}]", at, i);
      const Json& side = source[i];
      const std::string name = side.is_object() ? side.value("panel", std::string()) : std::string();
      std::size_t p = 0;
      while (p < garment_.panels.size() && garment_.panels[p].name != name) ++p;
      if (p == garment_.panels.size()) {
        std::vector<std::string> names;
        for (const sizing::Panel& panel : garment_.panels) names.push_back(panel.name);
        return problem(place + ".panel",
                       fmt::format("there is no panel '{}'{}", name, did_you_mean(name, names)));
      }
      const auto edge = side.find("edge");
      if (edge == side.end() || !edge->is_number_unsigned() || edge->get<std::size_t>() >= edges_[p].size())
        return problem(
            place + ".edge",
            fmt::format("must be one of the {} edges of panel '{}', counted from 0", edges_[p].size(), name));
      const Edge& chosen = edges_[p][edge->get<std::size_t>()];
      sizing::SeamSide& to = i == 0 ? seam.a : seam.b;
      to = {p, chosen.curve.points.front(), chosen.curve.points.back(),
            2 * chosen.length > garment_.panels[p].outline.length()};
      for (const std::size_t end : {0U, 1U})
        ends[i][end] = garment_.placements[p].rotation * dvec3(end == 0 ? to.from : to.to, 0) +
                       garment_.placements[p].translation;
    }
    const double same = glm::distance(ends[0][0], ends[1][0]) + glm::distance(ends[0][1], ends[1][1]);
    const double crossed = glm::distance(ends[0][0], ends[1][1]) + glm::distance(ends[0][1], ends[1][0]);
    // Neighbours that go round alike run against each other along the seam.
    if (crossed <= same) std::swap(seam.b.from, seam.b.to);
    garment_.seams.push_back(std::move(seam));
  }

  const std::filesystem::path& file_;
  const sizing::Fabric& fabric_;
  sizing::Garment garment_;
  std::vector<std::vector<Edge>> edges_;  // by panel
  double metres_ = 0.01;
  bool absolute_ = false;
  std::string problems_;
};

}  // namespace

sizing::Garment parse_garment_code(std::string_view text, const std::filesystem::path& file,
                                   const sizing::Fabric& fabric) {
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::exception& error) {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", file.string(), error.what()));
  }
  try {
    return Reader(file, fabric).run(root);
  } catch (const Json::exception& error) {  // a value of another type than its name promises
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace plisse::config
