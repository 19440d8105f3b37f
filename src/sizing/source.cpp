// D. Zhang et al., SIGGRAPH 2025, 4.2.2 to 4.2.6: from the garment-making technique at a line to its
// resolution and transition.

#include "sizing/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;

bool in_panel(const Panel& panel, const dvec2& point) {
  return contains(panel.outline, point) &&
         std::none_of(panel.holes.begin(), panel.holes.end(),
                      [&](const Polyline& hole) { return contains(hole, point); });
}

Source source_of(int index, const Feature& feature, const Panel& panel, const SizingOptions& options,
                 double ratio) {
  TransitionCause cause = feature.cause;
  cause.compression = 1 - ratio;
  const auto in = [&](const Stiffness& stiffness) {
    const double r =
        shirring_resolution(options.law, stiffness, feature.added_modulus, ratio, feature.exponent);
    return transition(std::max(r, options.floor), stiffness, cause, options.form);
  };
  return {index, in(panel.fabric.weft), in(panel.fabric.warp), {feature.line}, false, {}};
}

// A bend that is sharp for a mesh of this resolution: a corner, or a radius below twice the resolution. One
// per consecutive run.
std::vector<std::size_t> sharp_bends(const Polyline& line, double resolution) {
  std::vector<std::size_t> bends;
  double sharpest = 0;
  std::size_t at = 0;
  const auto flush = [&] {
    if (sharpest > 0) bends.push_back(at);
    sharpest = 0;
  };
  for (std::size_t i = 1; i + 1 < line.points.size(); ++i) {
    const dvec2 before = line.points[i] - line.points[i - 1], after = line.points[i + 1] - line.points[i];
    const double lengths = glm::length(before) * glm::length(after);
    const double turn = std::acos(std::clamp(glm::dot(before, after) / lengths, -1.0, 1.0));
    const double curvature = 2 * turn / (glm::length(before) + glm::length(after));
    const bool sharp = turn > 0.5 || curvature * 2 * resolution > 1;  // 0.5: about 30°
    if (!sharp) flush();
    if (sharp && curvature > sharpest) {
      sharpest = curvature;
      at = i;
    }
  }
  flush();
  return bends;
}

// At the ends the transition extends in the direction of the fold, at sharp bends toward their inner side,
// where cloth is compressed. A fold that ends on the outline has no cloth ahead of it: there it extends
// backward along the fold.
void add_fold(int index, const Feature& feature, const Panel& panel, const SizingOptions& options,
              std::vector<Source>& sources) {
  const dvec2 base = fabric_resolution(panel, options);
  const double share = folding_resolution(feature.angle, 1, 0, options.fold_rule);
  if (share >= 1) return;
  const auto at = [&](const dvec2& point, dvec2 forward) {
    forward = glm::normalize(forward);
    if (!in_panel(panel, point + forward * options.floor)) forward = -forward;
    TransitionCause cause = feature.cause;
    cause.compression = std::min(1 - share, 0.99);  // even a closed fold is not compressed to nothing
    const auto in = [&](const Stiffness& stiffness, double resolution) {
      return transition(folding_resolution(feature.angle, resolution, options.floor, options.fold_rule),
                        stiffness, cause, options.form);
    };
    sources.push_back({index,
                       in(panel.fabric.weft, base.x),
                       in(panel.fabric.warp, base.y),
                       {{{point}, false}},
                       false,
                       forward});
  };
  const auto& p = feature.line.points;
  if (!feature.line.closed) {
    at(p.front(), p[0] - p[1]);
    at(p.back(), p[p.size() - 1] - p[p.size() - 2]);
  }
  for (const std::size_t i : sharp_bends(feature.line, std::min(base.x, base.y)))
    at(p[i], glm::normalize(p[i - 1] - p[i]) + glm::normalize(p[i + 1] - p[i]));
}

}  // namespace

const char* name_of(Feature::Rule rule) {
  switch (rule) {
    case Feature::Rule::shirring:
      return "shirring";
    case Feature::Rule::fold:
      return "fold";
    case Feature::Rule::stitch:
      return "stitch";
    case Feature::Rule::cell:
      return "cell";
    case Feature::Rule::collision:
      return "collision";
  }
  return "";
}

dvec2 fabric_resolution(const Panel& panel, const SizingOptions& options) {
  return {std::max(options.floor, fabric_resolution(options.law, panel.fabric.weft)),
          std::max(options.floor, fabric_resolution(options.law, panel.fabric.warp))};
}

std::vector<Source> sources_of(const Panel& panel, const SizingOptions& options) {
  std::vector<Source> sources;
  for (std::size_t i = 0; i < panel.features.size(); ++i) {
    const Feature& feature = panel.features[i];
    const int index = static_cast<int>(i);
    try {
      switch (feature.rule) {
        case Feature::Rule::fold:
          add_fold(index, feature, panel, options, sources);
          break;
        case Feature::Rule::stitch: {
          const double own = feature.line.length();
          if (own > feature.other_length)
            sources.push_back(
                source_of(index, feature, panel, options, stitching_ratio(own, feature.other_length)));
          break;
        }
        case Feature::Rule::shirring:
        case Feature::Rule::cell:
        case Feature::Rule::collision:
          sources.push_back(source_of(index, feature, panel, options, feature.ratio));
          sources.back().filled = feature.rule == Feature::Rule::collision;
          break;
      }
    } catch (const Error& error) {
      throw Error(error.code, fmt::format("panel '{}', {} '{}': {}", panel.name, name_of(feature.rule),
                                          feature.name, error.what()));
    }
  }
  return sources;
}

}  // namespace plisse::sizing
