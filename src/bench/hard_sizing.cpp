// Hard cases of sizing (Zhang et al. 2025): invalid or extreme stiffnesses and outlines.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "bench/hard.h"
#include "sizing/mesh_panel.h"

namespace plisse::bench {
namespace {

using namespace sizing;

Panel square(double side) {
  Panel panel;
  panel.name = "square";
  panel.fabric.weft = panel.fabric.warp = {1e-6, 3e5};
  panel.outline = {{{0, 0}, {side, 0}, {side, side}, {0, side}}, true};
  return panel;
}

// The whole text of the error, or "" where there is none.
template <typename Action>
std::string refused(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// An error text with this content, of one or a few lines.
Verdict says(const std::string& text, const std::string& word) {
  if (text.empty()) return {false, "no error"};
  return {text.find(word) != std::string::npos, text};
}

Verdict is_sound(const Panel& panel, const SizingOptions& options = {}) {
  const auto sized = mesh_panel(panel, options);
  double area = 0;
  for (const auto& [a, b, c] : sized->mesh.triangles) {
    const glm::dvec2 p = sized->mesh.vertices[a], q = sized->mesh.vertices[b], r = sized->mesh.vertices[c];
    const double twice = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    if (!(twice > 0)) return {false, "a triangle without area, or turned over"};
    area += twice / 2;
  }
  const double wanted = std::abs(signed_area(panel.outline));
  // The mesh fills the outline; points are snapped to a grid of 2^-25 of it.
  return {std::abs(area / wanted - 1) < 1e-5, fmt::format("{} vertices, area {:.7f} of the outline's",
                                                          sized->mesh.vertices.size(), area / wanted)};
}

Verdict no_stiffness() {
  std::string found;
  for (const double y :
       {0.0, -1e-12, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    found = refused([&] { resolution_law().resolution(y); });
    if (found.empty()) return {false, fmt::format("B/E = {} gave a resolution", y)};
  }
  return {true, found};
}

Verdict resolution_grows() {
  double last = 0;
  const ResolutionLaw law = resolution_law();
  for (double y = 1e-30; y < 1e6; y *= 10) {
    const double r = law.resolution(y);
    if (!(std::isfinite(r) && r > 0 && r >= last))
      return {false, fmt::format("r({:g}) = {:g} after {:g}", y, r, last)};
    last = r;
  }
  return {true, fmt::format("up to {:.3g} m at B/E = 1e6 m³", last)};
}

Verdict crossing() {
  Panel panel = square(0.3);
  std::swap(panel.outline.points[1], panel.outline.points[2]);
  return says(refused([&] { mesh_panel(panel, {}); }), "cross");
}

Verdict repeated_points() {
  Panel panel = square(0.3);
  panel.outline.points.insert(panel.outline.points.begin() + 1, 3, panel.outline.points.front());
  return is_sound(panel);
}

Verdict no_length() {
  Panel panel = square(0.3);
  Feature feature;
  feature.name = "dart";
  feature.rule = Feature::Rule::fold;
  feature.angle = 60;
  feature.line = {{{0.1, 0.1}, {0.1, 0.1}}, false};
  panel.features = {feature};
  return says(refused([&] { mesh_panel(panel, {}); }), "dart");
}

Verdict flat_fold() {
  Panel panel = square(0.3);
  Feature feature;
  feature.name = "no fold";
  feature.rule = Feature::Rule::fold;
  feature.angle = 0;
  feature.line = {{{0.05, 0.15}, {0.25, 0.15}}, false};
  panel.features = {feature};
  const std::string error = refused([&] { mesh_panel(panel, {}); });
  return error.empty() ? is_sound(panel) : says(error, "no fold");
}

Verdict outside() {
  Panel panel = square(0.3);
  Feature feature;
  feature.name = "far away";
  feature.rule = Feature::Rule::fold;
  feature.angle = 90;
  feature.line = {{{1, 1}, {2, 1}}, false};
  panel.features = {feature};
  return says(refused([&] { mesh_panel(panel, {}); }), "far away");
}

Verdict tiny_and_huge() {
  // Below the floor of 1 mm nothing is meshed finer; a thousand kilometres would be 1e14 vertices.
  const std::string small = refused([] {
    const Verdict verdict = is_sound(square(1e-6));
    if (!verdict.holds) throw Error(ExitCode::check_failed, "UNSOUND " + verdict.found);
  });
  const std::string large = refused([] { mesh_panel(square(1e6), {}); });
  if (small.starts_with("UNSOUND")) return {false, "1e-6 m: " + small};
  if (large.empty()) return {false, "1e6 m: no error"};
  return {true, fmt::format("1e-6 m: {}; 1e6 m: {}", small.empty() ? "meshed" : small, large)};
}

// r + x^m with m = ln r / ln L_w, printed without units, has a pole at L_w = 1 mm and changes its sign at r =
// 1 mm.
Verdict literal_transition() {
  Panel panel = square(0.05);
  Feature feature;
  feature.name = "shirring";
  feature.rule = Feature::Rule::shirring;
  feature.ratio = 0.02;
  feature.line = {{{0.01, 0.025}, {0.04, 0.025}}, false};
  panel.features = {feature};
  SizingOptions options;
  options.form = Transition::Form::literal;
  return is_sound(panel, options);
}

Verdict one_way_stiff() {
  Panel panel = square(0.3);
  panel.fabric.warp = {1e-3, 3e5};  // against {1e-6, 3e5}: edges of 26 and of 7 mm
  return is_sound(panel);
}

}  // namespace

std::vector<HardCase> hard_sizing() {
  return {{"sizing", "B/E of 0, below 0, NaN, infinite", "an error", false, no_stiffness},
          {"sizing", "B/E from 1e-30 to 1e6", "finite, positive, growing", false, resolution_grows},
          {"sizing", "an outline that crosses itself", "an error that says so", false, crossing},
          {"sizing", "points repeated in the outline", "a mesh that fills it", false, repeated_points},
          {"sizing", "a fold of no length", "an error that names it", false, no_length},
          {"sizing", "a fold of 0 degrees", "a mesh that fills the outline, or an error that names it", false,
           flat_fold},
          {"sizing", "a fold outside of the panel", "an error that names it", false, outside},
          {"sizing", "the printed transition from a line of 0.16 mm", "a mesh that fills the outline", false,
           literal_transition},
          {"sizing", "a fabric 1,000 times as stiff one way", "a mesh that fills the outline", false,
           one_way_stiff},
          {"sizing", "a panel of 1e-6 m and one of 1e6 m", "a sound mesh or an error; no endless run", false,
           tiny_and_huge}};
}

}  // namespace plisse::bench
