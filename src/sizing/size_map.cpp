// The sizing map: distances inside the panel by propagating the nearest source from node to node (P.-E.
// Danielsson's vector propagation, 1980, in the order of E. Dijkstra's shortest paths), where straight lines
// must not cross the outline; gradation by J. Alauzet's and P.-O. Persson's |∇h| ≤ g ("Mesh size functions
// for implicit geometries", 2006).

#include "sizing/size_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace plisse::sizing {
namespace {

using glm::dvec2;

constexpr std::array<std::array<int, 2>, 8> around = {
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

constexpr std::size_t most_nodes = std::size_t{1} << 22;

// Cheapest first.
struct Step {
  float cost = 0;
  std::uint32_t node = 0;
  bool operator<(const Step& other) const { return cost > other.cost; }
};

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// Whether the segments cross in their interiors; touching does not count.
bool cuts(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& d) {
  const auto sides = [](const dvec2& p, const dvec2& q, const dvec2& r, const dvec2& s) {
    const double tiny = 1e-12 * (glm::dot(q - p, q - p) + glm::dot(s - r, s - r));
    const double one = cross(q - p, r - p), other = cross(q - p, s - p);
    return (one > tiny && other < -tiny) || (one < -tiny && other > tiny);
  };
  return sides(a, b, c, d) && sides(c, d, a, b);
}

bool convex(const Polyline& line) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const dvec2 before = line.end(i) - line.start(i);
    const std::size_t j = (i + 1) % line.points.size();
    const double turn = cross(before, line.end(j) - line.start(j));
    left |= turn > 0;
    right |= turn < 0;
  }
  return !(left && right);
}

}  // namespace

SizeMap::SizeMap(const Panel& panel, const Domain& domain, const std::vector<Source>& sources,
                 const SizingOptions& options)
    : domain_(domain), options_(options) {
  const double angle = glm::radians(panel.grain);
  fabric_axes_ = glm::transpose(
      glm::dmat2(dvec2(std::sin(angle), -std::cos(angle)), dvec2(std::cos(angle), std::sin(angle))));
  line_sizes_.assign(domain.lines.size(), domain.size);
  for (std::size_t i = 0; i < domain.lines.size(); ++i) {
    for (const Source& source : sources) {
      const auto& features = domain.lines[i].features;
      if (source.forward || std::find(features.begin(), features.end(), source.feature) == features.end())
        continue;
      line_sizes_[i] = std::min(line_sizes_[i], working_size(source.weft.source, source.warp.source));
    }
    if (domain.lines[i].seam_size > 0) line_sizes_[i] = std::min(line_sizes_[i], domain.lines[i].seam_size);
  }

  const std::vector<Cap> caps = shape_caps();
  lay_grid(sources, caps);
  mark_inside();
  obstacles_ = domain.boundary.size() > 1 || !convex(domain.boundary[0]);
  if (obstacles_ && !sources.empty()) measure_clearance();

  weft_.assign(inside_.size(), static_cast<float>(domain.resolution.x));
  warp_.assign(inside_.size(), static_cast<float>(domain.resolution.y));
  size_.assign(inside_.size(), static_cast<float>(domain.size));
  // Sources with the same transition share one distance field.
  std::vector<std::uint8_t> done(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (done[i]) continue;
    std::vector<const Source*> alike;
    for (std::size_t j = i; j < sources.size(); ++j) {
      const bool same = j == i || (!sources[i].forward && !sources[j].forward &&
                                   sources[j].weft == sources[i].weft && sources[j].warp == sources[i].warp);
      if (!same || done[j]) continue;
      done[j] = 1;
      alike.push_back(&sources[j]);
    }
    spread(alike);
  }
  for (std::size_t i = 0; i < size_.size(); ++i)
    size_[i] = std::min(size_[i], static_cast<float>(working_size(weft_[i], warp_[i])));

  for (const Cap& cap : caps) {
    const int column = static_cast<int>((cap.at.x - origin_.x) / step_),
              row = static_cast<int>((cap.at.y - origin_.y) / step_);
    for (int y = row; y <= row + 1; ++y) {
      for (int x = column; x <= column + 1; ++x) {
        float& size = size_[index(x, y)];
        size = std::min(size,
                        static_cast<float>(cap.size + options.gradation * glm::distance(node(x, y), cap.at)));
      }
    }
  }
  limit_gradation();
  extend_outside();
}

// Isotropic in working coordinates, with the area that follows from both directions.
double SizeMap::working_size(double weft, double warp) const {
  return std::sqrt(weft * warp * domain_.resolution.x / domain_.resolution.y);
}

// Where two lines are closer than the size, a curve is tighter, or a line shorter, the mesh must be as fine
// as that, but never finer than a quarter of the floor: smaller details are represented by single edges.
std::vector<SizeMap::Cap> SizeMap::shape_caps() const {
  std::vector<Cap> caps;
  const double least = options_.floor / 4;
  const auto add = [&](const dvec2& at, double size) {
    if (size < domain_.size) caps.push_back({at, std::max(size, least)});
  };
  struct Piece {
    dvec2 a, b;
    std::uint32_t line;
    double along;  // arc length from the line's start
  };
  std::vector<Piece> pieces;
  for (std::size_t l = 0; l < domain_.lines.size(); ++l) {
    const Polyline& shape = domain_.lines[l].shape;
    double along = 0;
    for (std::size_t i = 0; i < shape.segment_count(); ++i) {
      pieces.push_back({shape.start(i), shape.end(i), static_cast<std::uint32_t>(l), along});
      along += glm::distance(shape.start(i), shape.end(i));
    }
  }
  // Boxes with the side of the size: relevant gaps are between neighbouring boxes.
  const double box = domain_.size;
  const int boxes_x = std::clamp(static_cast<int>((domain_.high.x - domain_.low.x) / box) + 1, 1, 4096),
            boxes_y = std::clamp(static_cast<int>((domain_.high.y - domain_.low.y) / box) + 1, 1, 4096);
  const dvec2 scale(boxes_x / std::max(domain_.high.x - domain_.low.x, 1e-300),
                    boxes_y / std::max(domain_.high.y - domain_.low.y, 1e-300));
  const auto box_of = [&](double x, double low, double per, int count) {
    return std::clamp(static_cast<int>((x - low) * per), 0, count - 1);
  };
  std::vector<std::vector<std::uint32_t>> held(static_cast<std::size_t>(boxes_x) *
                                               static_cast<std::size_t>(boxes_y));
  for (std::uint32_t k = 0; k < pieces.size(); ++k) {
    const dvec2 low = glm::min(pieces[k].a, pieces[k].b), high = glm::max(pieces[k].a, pieces[k].b);
    for (int y = box_of(low.y, domain_.low.y, scale.y, boxes_y);
         y <= box_of(high.y, domain_.low.y, scale.y, boxes_y); ++y) {
      for (int x = box_of(low.x, domain_.low.x, scale.x, boxes_x);
           x <= box_of(high.x, domain_.low.x, scale.x, boxes_x); ++x)
        held[static_cast<std::size_t>(y * boxes_x + x)].push_back(k);
    }
  }
  const auto meet = [&](const Polyline& one, const Polyline& other) {
    if (one.closed || other.closed) return false;
    for (const dvec2& a : {one.points.front(), one.points.back()}) {
      for (const dvec2& b : {other.points.front(), other.points.back()}) {
        if (a == b) return true;
      }
    }
    return false;
  };

  // Pieces of the outline that share an end with one of the lines beside a fold: these half millimetres are
  // not gaps.
  std::vector<std::uint8_t> beside_fold(domain_.lines.size());
  for (std::size_t l = 0; l < beside_fold.size(); ++l) {
    beside_fold[l] = std::any_of(domain_.lines.begin(), domain_.lines.end(), [&](const Domain::Line& other) {
      return other.fold_side != 0 && meet(domain_.lines[l].shape, other.shape);
    });
  }
  for (std::size_t l = 0; l < domain_.lines.size(); ++l) {
    const Domain::Line& line = domain_.lines[l];
    const double length = line.shape.length();
    if (line.fold_side != 0) continue;
    if (line.seam_size > 0) {
      for (std::size_t i = 0; i < line.shape.segment_count(); ++i) {
        const dvec2 a = line.shape.start(i), way = line.shape.end(i) - a;
        const int steps =
            std::clamp(static_cast<int>(std::ceil(glm::length(way) / line.seam_size)), 1, 1 << 20);
        for (int k = 0; k <= steps; ++k) add(a + way * (static_cast<double>(k) / steps), line.seam_size);
      }
    }
    if (!line.shape.closed && length < domain_.size && !beside_fold[l]) {
      add(line.shape.points.front(), length);
      add(line.shape.points.back(), length);
    }
    double along = 0;
    for (std::size_t i = 0; i < line.shape.segment_count(); ++i) {
      const dvec2 a = line.shape.start(i), b = line.shape.end(i);
      const double piece = glm::distance(a, b);
      // Tight curves: eight edges in a circle, 2 sin(π/8) radii each.
      if (line.shape.closed || i + 1 < line.shape.segment_count()) {
        const dvec2 c = line.shape.end((i + 1) % line.shape.segment_count());
        const double turn = std::abs(std::atan2(cross(b - a, c - b), glm::dot(b - a, c - b)));
        if (turn > 1e-3) add(b, 0.765 * (piece + glm::distance(b, c)) / (2 * turn));
      }
      const int samples = std::max(1, static_cast<int>(std::ceil(piece / (0.5 * domain_.size))));
      for (int k = 0; k < samples; ++k) {
        const double share = (k + 0.5) / samples, here = along + share * piece;
        const dvec2 p = a + (b - a) * share;
        double gap = domain_.size;
        dvec2 across = p;
        const int column = box_of(p.x, domain_.low.x, scale.x, boxes_x),
                  row = box_of(p.y, domain_.low.y, scale.y, boxes_y);
        for (int y = std::max(0, row - 1); y <= std::min(boxes_y - 1, row + 1); ++y) {
          for (int x = std::max(0, column - 1); x <= std::min(boxes_x - 1, column + 1); ++x) {
            for (const std::uint32_t other : held[static_cast<std::size_t>(y * boxes_x + x)]) {
              const Piece& o = pieces[other];
              const Domain::Line& its = domain_.lines[o.line];
              const dvec2 q = nearest_on_segment(p, o.a, o.b);
              const double distance = glm::distance(p, q);
              if (distance >= gap) continue;
              if (its.fold_side != 0 || (line.fold >= 0 && (its.fold == line.fold || beside_fold[o.line])) ||
                  (its.fold >= 0 && beside_fold[l]) || (beside_fold[l] && beside_fold[o.line]))
                continue;
              if (o.line == l) {
                // A near point of the same line is a gap only if it is much nearer than along the line.
                double way = std::abs(o.along + glm::distance(o.a, q) - here);
                if (line.shape.closed) way = std::min(way, length - way);
                if (way < 3 * distance || way <= piece) continue;
              } else if (meet(line.shape, its.shape)) {
                continue;
              }
              gap = distance;
              across = q;
            }
          }
        }
        if (gap < domain_.size && domain_.inside((p + across) / 2.0)) add(p, gap);
      }
      along += piece;
    }
  }
  return caps;
}

void SizeMap::lay_grid(const std::vector<Source>& sources, const std::vector<Cap>& caps) {
  least_ = domain_.size;
  for (const Source& source : sources)
    least_ = std::min(least_, working_size(source.weft.source, source.warp.source));
  for (const Cap& cap : caps) least_ = std::min(least_, cap.size);
  const dvec2 extent = domain_.high - domain_.low;
  // Half of the finest size, with at most 2²² nodes and a margin of two nodes on all sides.
  step_ = std::max({least_ / 2, std::sqrt(extent.x * extent.y / static_cast<double>(most_nodes)),
                    std::max(extent.x, extent.y) / 65536});
  origin_ = domain_.low - 2 * step_;
  columns_ = static_cast<int>(extent.x / step_) + 6;
  rows_ = static_cast<int>(extent.y / step_) + 6;
}

void SizeMap::mark_inside() {
  inside_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(rows_));
  for (const Polyline& line : domain_.boundary) {
    for (std::size_t i = 0; i < line.segment_count(); ++i) {
      dvec2 a = line.start(i), b = line.end(i);
      if (a.y > b.y) std::swap(a, b);
      const int first = std::max(0, static_cast<int>(std::ceil((a.y - origin_.y) / step_)));
      for (int row = first; row < rows_ && origin_.y + row * step_ < b.y; ++row) {
        const double y = origin_.y + row * step_;
        if (y >= a.y)
          crossings[static_cast<std::size_t>(row)].push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
      }
    }
  }
  for (int row = 0; row < rows_; ++row) {
    auto& xs = crossings[static_cast<std::size_t>(row)];
    std::sort(xs.begin(), xs.end());
    for (std::size_t k = 0; k + 1 < xs.size(); k += 2) {
      const int first = std::max(0, static_cast<int>(std::ceil((xs[k] - origin_.x) / step_)));
      for (int column = first; column < columns_ && origin_.x + column * step_ < xs[k + 1]; ++column)
        inside_[index(column, row)] = 1;
    }
  }
}

// Distance of each node from the outline, and the pieces of it within a cell.
void SizeMap::measure_clearance() {
  for (const Polyline& line : domain_.boundary) {
    for (std::size_t i = 0; i < line.segment_count(); ++i) {
      // Split into pieces of a few cells, so that their boxes are small.
      const int count =
          std::max(1, static_cast<int>(glm::distance(line.start(i), line.end(i)) / (6 * step_)));
      for (int k = 0; k < count; ++k) {
        const dvec2 way = line.end(i) - line.start(i);
        walls_.emplace_back(line.start(i) + way * (static_cast<double>(k) / count),
                            k + 1 == count ? line.end(i) : line.start(i) + way * ((k + 1.0) / count));
      }
    }
  }
  near_walls_.assign(inside_.size(), {});
  clearance_.assign(inside_.size(), std::numeric_limits<float>::max());
  std::vector<std::uint32_t> nearest(inside_.size());
  std::priority_queue<Step> queue;
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    const auto& [a, b] = walls_[w];
    const dvec2 low = (glm::min(a, b) - origin_) / step_ - 2.0,
                high = (glm::max(a, b) - origin_) / step_ + 2.0;
    for (int y = std::max(0, static_cast<int>(low.y)); y <= std::min(rows_ - 1, static_cast<int>(high.y));
         ++y) {
      for (int x = std::max(0, static_cast<int>(low.x));
           x <= std::min(columns_ - 1, static_cast<int>(high.x)); ++x) {
        const auto distance = static_cast<float>(distance_to_segment(node(x, y), a, b));
        const std::size_t i = index(x, y);
        if (distance < 2 * step_) near_walls_[i].push_back(w);
        if (distance < clearance_[i]) {
          clearance_[i] = distance;
          nearest[i] = w;
          queue.push({distance, static_cast<std::uint32_t>(i)});
        }
      }
    }
  }
  while (!queue.empty()) {
    const Step step = queue.top();
    queue.pop();
    if (step.cost > clearance_[step.node]) continue;
    const int column = static_cast<int>(step.node % static_cast<std::uint32_t>(columns_)),
              row = static_cast<int>(step.node / static_cast<std::uint32_t>(columns_));
    for (const auto& [dx, dy] : around) {
      const int x = column + dx, y = row + dy;
      if (x < 0 || y < 0 || x >= columns_ || y >= rows_) continue;
      const std::size_t i = index(x, y);
      const auto& [a, b] = walls_[nearest[step.node]];
      const auto distance = static_cast<float>(distance_to_segment(node(x, y), a, b));
      if (distance >= clearance_[i]) continue;
      clearance_[i] = distance;
      nearest[i] = nearest[step.node];
      queue.push({distance, static_cast<std::uint32_t>(i)});
    }
  }
}

// Whether the straight line between two points of the panel is inside it; its ends may be on the outline.
bool SizeMap::visible(dvec2 from, const dvec2& to) const {
  if (!obstacles_) return true;
  const double length = glm::distance(from, to);
  if (length == 0) return true;
  const dvec2 along = (to - from) / length;
  for (double way = 0; way < length;) {
    const dvec2 p = from + along * way;
    const int x = std::clamp(static_cast<int>(std::lround((p.x - origin_.x) / step_)), 0, columns_ - 1),
              y = std::clamp(static_cast<int>(std::lround((p.y - origin_.y) / step_)), 0, rows_ - 1);
    const std::size_t i = index(x, y);
    const double free = clearance_[i] - glm::distance(p, node(x, y));
    if (free > 0.5 * step_) {
      way += free;
      continue;
    }
    const double next = std::min(length, way + 0.75 * step_);
    for (const std::uint32_t w : near_walls_[i]) {
      if (cuts(from, to, walls_[w].first, walls_[w].second) &&
          distance_to_segment(from + along * way, walls_[w].first, walls_[w].second) < 2 * step_) {
        // Tests for a crossing here. A contact at the ends means that they are on the outline.
        if (const auto at = crossing(from, to, walls_[w].first, walls_[w].second);
            at && at->first * length > 1e-6 * step_ && (1 - at->first) * length > 1e-6 * step_)
          return false;
      }
    }
    way = next;
  }
  return true;
}

void SizeMap::spread(const std::vector<const Source*>& alike) {
  const Source& one = *alike.front();
  const double own = working_size(one.weft.source, one.warp.source);
  const double reach = std::max(one.weft.reach(domain_.resolution.x), one.warp.reach(domain_.resolution.y));
  // The origin of a node's distance: a piece of the source or a bend of the path, in panel coordinates.
  struct Root {
    dvec2 a, b;
    double offset;
  };
  std::vector<Root> roots;
  std::vector<float> distance(inside_.size(), std::numeric_limits<float>::max());
  std::vector<std::uint32_t> root_of(inside_.size());
  std::priority_queue<Step> queue;
  const auto panel_of = [&](int x, int y) { return domain_.to_panel * node(x, y); };
  const auto settle = [&](int x, int y, std::uint32_t root, double value) {
    const std::size_t i = index(x, y);
    if (value > reach || static_cast<float>(value) >= distance[i]) return;
    distance[i] = static_cast<float>(value);
    root_of[i] = root;
    queue.push({distance[i], static_cast<std::uint32_t>(i)});
  };
  const auto affected = [&](int x, int y) {
    return inside_[index(x, y)] &&
           (!one.forward || glm::dot(panel_of(x, y) - one.lines[0].points[0], *one.forward) >= 0);
  };

  for (const Source* source : alike) {
    for (const Polyline& line : source->lines) {
      const std::size_t count = std::max<std::size_t>(line.segment_count(), 1);
      for (std::size_t s = 0; s < count; ++s) {
        const dvec2 a = line.points[s], b = line.points.size() == 1 ? a : line.end(s);
        roots.push_back({a, b, 0});
        const auto root = static_cast<std::uint32_t>(roots.size() - 1);
        const dvec2 wa = domain_.to_working * a, wb = domain_.to_working * b;
        const int pieces = std::max(1, static_cast<int>(glm::distance(wa, wb) / (6 * step_)));
        for (int k = 0; k < pieces; ++k) {
          const dvec2 from = wa + (wb - wa) * (static_cast<double>(k) / pieces),
                      to = wa + (wb - wa) * ((k + 1.0) / pieces);
          const dvec2 low = (glm::min(from, to) - origin_) / step_ - 2.0,
                      high = (glm::max(from, to) - origin_) / step_ + 2.0;
          for (int y = std::max(0, static_cast<int>(low.y));
               y <= std::min(rows_ - 1, static_cast<int>(high.y)); ++y) {
            for (int x = std::max(0, static_cast<int>(low.x));
                 x <= std::min(columns_ - 1, static_cast<int>(high.x)); ++x) {
              if (!affected(x, y)) continue;
              const dvec2 p = panel_of(x, y), q = nearest_on_segment(p, a, b);
              if (!visible(domain_.to_working * q, node(x, y))) continue;
              // Near the source a transition may be too steep for a mesh.
              float& size = size_[index(x, y)];
              size = std::min(size, static_cast<float>(own + options_.gradation *
                                                                 distance_to_segment(node(x, y), wa, wb)));
              settle(x, y, root, glm::distance(p, q));
            }
          }
        }
      }
      if (!source->filled) continue;
      for (int y = 0; y < rows_; ++y) {
        for (int x = 0; x < columns_; ++x) {
          if (!inside_[index(x, y)] || !contains(line, panel_of(x, y))) continue;
          roots.push_back({panel_of(x, y), panel_of(x, y), 0});
          settle(x, y, static_cast<std::uint32_t>(roots.size() - 1), 0);
          distance[index(x, y)] = 0;
        }
      }
    }
  }

  while (!queue.empty()) {
    const Step step = queue.top();
    queue.pop();
    if (step.cost > distance[step.node]) continue;
    const int column = static_cast<int>(step.node % static_cast<std::uint32_t>(columns_)),
              row = static_cast<int>(step.node / static_cast<std::uint32_t>(columns_));
    for (const auto& [dx, dy] : around) {
      const int x = column + dx, y = row + dy;
      if (x < 0 || y < 0 || x >= columns_ || y >= rows_ || !affected(x, y)) continue;
      const dvec2 p = panel_of(x, y);
      const Root root = roots[root_of[step.node]];
      const dvec2 q = nearest_on_segment(p, root.a, root.b);
      const double straight = root.offset + glm::distance(p, q);
      if (straight >= distance[index(x, y)]) continue;
      if (visible(domain_.to_working * q, node(x, y))) {
        settle(x, y, root_of[step.node], straight);
      } else if (visible(node(column, row), node(x, y))) {
        const dvec2 here = panel_of(column, row);  // the path bends at the previous node
        roots.push_back({here, here, distance[step.node]});
        settle(x, y, static_cast<std::uint32_t>(roots.size() - 1),
               distance[step.node] + glm::distance(here, p));
      }
    }
  }
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (distance[i] > reach) continue;
    weft_[i] = std::min(weft_[i], static_cast<float>(one.weft.at(distance[i])));
    warp_[i] = std::min(warp_[i], static_cast<float>(one.warp.at(distance[i])));
  }
}

void SizeMap::limit_gradation() {
  const auto straight = static_cast<float>(options_.gradation * step_), diagonal = straight * 1.41421356F;
  std::priority_queue<Step> queue;
  const auto relax = [&](std::uint32_t from) {
    const int column = static_cast<int>(from % static_cast<std::uint32_t>(columns_)),
              row = static_cast<int>(from / static_cast<std::uint32_t>(columns_));
    if (column == 0 || row == 0 || column + 1 == columns_ || row + 1 == rows_) return;
    for (std::size_t k = 0; k < around.size(); ++k) {
      const std::size_t i = index(column + around[k][0], row + around[k][1]);
      const float allowed = size_[from] + (k < 4 ? straight : diagonal);
      if (size_[i] <= allowed) continue;
      size_[i] = allowed;
      if (inside_[i]) queue.push({allowed, static_cast<std::uint32_t>(i)});
    }
  };
  for (std::uint32_t i = 0; i < size_.size(); ++i) {
    if (size_[i] < domain_.size) relax(i);
  }
  while (!queue.empty()) {
    const Step step = queue.top();
    queue.pop();
    if (step.cost <= size_[step.node]) relax(step.node);
  }
}

// Two rings of nodes around the panel take the mean of their neighbours, so that points near the outline
// interpolate values from inside.
void SizeMap::extend_outside() {
  std::vector<std::uint8_t> known = inside_;
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<std::uint8_t> before = known;
    for (int row = 1; row + 1 < rows_; ++row) {
      for (int column = 1; column + 1 < columns_; ++column) {
        const std::size_t i = index(column, row);
        if (before[i]) continue;
        float size = 0, weft = 0, warp = 0, count = 0;
        for (const auto& [dx, dy] : around) {
          const std::size_t j = index(column + dx, row + dy);
          if (!before[j]) continue;
          size += size_[j];
          weft += weft_[j];
          warp += warp_[j];
          ++count;
        }
        if (count == 0) continue;
        size_[i] = std::min(size_[i], size / count);
        weft_[i] = weft / count;
        warp_[i] = warp / count;
        known[i] = 1;
      }
    }
  }
}

float SizeMap::bilinear(const std::vector<float>& values, const dvec2& working) const {
  const dvec2 at = (working - origin_) / step_;
  const int x = std::clamp(static_cast<int>(at.x), 0, columns_ - 2),
            y = std::clamp(static_cast<int>(at.y), 0, rows_ - 2);
  const auto u = static_cast<float>(std::clamp(at.x - x, 0.0, 1.0)),
             v = static_cast<float>(std::clamp(at.y - y, 0.0, 1.0));
  const std::size_t i = index(x, y), j = i + static_cast<std::size_t>(columns_);
  return (1 - v) * ((1 - u) * values[i] + u * values[i + 1]) + v * ((1 - u) * values[j] + u * values[j + 1]);
}

double SizeMap::size(const dvec2& working) const {
  return bilinear(size_, working);
}

dvec2 SizeMap::resolution(const dvec2& working) const {
  const dvec2 asked(bilinear(weft_, working), bilinear(warp_, working));
  return asked * (size(working) / working_size(asked.x, asked.y));
}

glm::dmat2 SizeMap::metric(const dvec2& working) const {
  const dvec2 r = resolution(working);
  const glm::dmat2 scaled = glm::dmat2(1 / r.x, 0, 0, 1 / r.y) * fabric_axes_;
  return glm::transpose(scaled) * scaled;
}

}  // namespace plisse::sizing
