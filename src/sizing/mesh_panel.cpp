// D. Zhang et al., SIGGRAPH 2025, 4.3: sizing map → Poisson-disk samples → constrained Delaunay
// triangulation; then the samples move to the centroids of the triangles around them (L. Chen, "Mesh
// smoothing schemes based on optimal Delaunay triangulations", 2004), and triangles that are still too flat
// get their circumcentres (L. Chew 1993).

#include "sizing/mesh_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/clock.h"
#include "base/error.h"
#include "sizing/delaunay.h"
#include "sizing/sample.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;

constexpr double wanted_angle = 27 * std::numbers::pi / 180;  // two degrees above the promised angle
constexpr double sharp_meeting = std::numbers::pi / 3;

// Position on Hilbert's curve (1891), which visits the cells of a 2^16 grid so that consecutive cells are
// adjacent; so each insertion starts near the last one.
std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t place = 0;
  for (std::uint32_t s = 1U << 15; s > 0; s >>= 1) {
    const std::uint32_t right = (x & s) ? 1 : 0, up = (y & s) ? 1 : 0;
    place += s * s * ((3 * right) ^ up);
    if (up == 0) {
      if (right == 1) {
        x = (1U << 16) - 1 - x;
        y = (1U << 16) - 1 - y;
      }
      std::swap(x, y);
    }
  }
  return place;
}

double angle_at(const dvec2& apex, const dvec2& a, const dvec2& b) {
  const dvec2 u = a - apex, v = b - apex;
  return std::abs(std::atan2(u.x * v.y - u.y * v.x, glm::dot(u, v)));
}

class Mesher {
 public:
  Mesher(const Domain& domain, const SizeMap& map) : domain_(domain), map_(map) {
    centre_ = (domain.low + domain.high) / 2.0;
    const dvec2 extent = domain.high - domain.low;
    // A margin of a hundredth, for lines that extend beyond the outline before they are cut.
    scale_ = 0.98 * Triangulation::limit / (0.5 * std::max(extent.x, extent.y));
  }

  void triangulate(const Samples& samples) {
    std::vector<GridPoint> places;
    for (const dvec2& point : samples.points) places.push_back(to_grid(point));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      const auto cell = [](std::int32_t x) {
        return static_cast<std::uint32_t>((x + Triangulation::limit) >> 10);
      };
      order.emplace_back(hilbert(cell(places[i].x), cell(places[i].y)), i);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t>& vertex = vertex_of_sample_;
    vertex.resize(places.size());
    for (const auto& [key, i] : order) vertex[i] = mesh_.insert(places[i]);
    for (std::size_t l = 0; l < samples.lines.size(); ++l) {
      const auto& line = samples.lines[l];
      for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        if (vertex[line[k]] != vertex[line[k + 1]])
          mesh_.constrain(vertex[line[k]], vertex[line[k + 1]], static_cast<std::uint16_t>(l + 1));
      }
    }
    mesh_.mark_inside(static_cast<std::uint16_t>(domain_.boundary_lines));
    free_.assign(mesh_.points().size(), 0);
    for (std::size_t i = samples.on_lines; i < vertex.size(); ++i) mark_free(vertex[i]);
    for (std::size_t i = 0; i < samples.on_lines; ++i) free_[vertex[i]] = 0;
    settle_roles();
  }

  // Moves free vertices to the mean of the centroids round them, weighted so that a mesh of the wanted sizes
  // is a fixed point: area over size⁴ (Q. Du, D. Wang 2003 derive the exponent d + 2).
  void smooth(int rounds) {
    for (int round = 0; round < rounds; ++round) {
      const auto& points = mesh_.points();
      std::vector<double> weights(points.size(), 0);
      std::vector<dvec2> sums(points.size(), dvec2(0)), at(points.size());
      std::vector<double> density(points.size());
      for (std::size_t v = Triangulation::frame_vertices; v < points.size(); ++v) {
        at[v] = from_grid(points[v]);
        density[v] = std::pow(map_.size(at[v]), -4);
      }
      for (const auto& triangle : mesh_.triangles()) {
        if (!triangle.inside) continue;
        const auto [a, b, c] = triangle.vertex;
        const double area = static_cast<double>(orientation(points[a], points[b], points[c]));
        const double weight = area * (density[a] + density[b] + density[c]);
        const dvec2 centroid = (at[a] + at[b] + at[c]) / 3.0;
        for (const std::uint32_t v : triangle.vertex) {
          weights[v] += weight;
          sums[v] += weight * centroid;
        }
      }
      for (std::uint32_t v = Triangulation::frame_vertices; v < points.size(); ++v) {
        if (v < free_.size() && free_[v] && weights[v] > 0) mesh_.move(v, to_grid(sums[v] / weights[v]));
      }
      mesh_.legalise();
    }
  }

  // Inserts a vertex for each triangle that is too flat; returns their number.
  std::size_t refine() {
    settle_roles();
    std::size_t inserted = 0;
    const std::size_t count = mesh_.triangles().size();
    std::vector<dvec2> fresh;
    for (std::uint32_t t = 0; t < count; ++t) {
      if (!mesh_.triangles()[t].inside || exempt(t) || least_angle(t) >= wanted_angle) continue;
      const auto [a, b, c] = corners(t);
      const double size = map_.size((a + b + c) / 3.0);
      const dvec2 ab = b - a, ac = c - a;
      const double turn = 2 * (ab.x * ac.y - ab.y * ac.x);
      const dvec2 centre = a + dvec2(ac.y * glm::dot(ab, ab) - ab.y * glm::dot(ac, ac),
                                     ab.x * glm::dot(ac, ac) - ac.x * glm::dot(ab, ab)) /
                                   turn;
      if (!std::isfinite(centre.x) || !domain_.inside(centre)) continue;
      // Not near another one of this round, and not where its edges would be too short.
      if (std::any_of(fresh.end() - static_cast<std::ptrdiff_t>(std::min<std::size_t>(fresh.size(), 64)),
                      fresh.end(),
                      [&](const dvec2& other) { return glm::distance(other, centre) < 0.5 * size; }))
        continue;
      const std::uint32_t holder = mesh_.locate(to_grid(centre), t);
      if (!mesh_.triangles()[holder].inside) continue;
      const auto around = corners(holder);
      if (std::any_of(around.begin(), around.end(),
                      [&](const dvec2& corner) { return glm::distance(corner, centre) < 0.45 * size; }))
        continue;
      mark_free(mesh_.insert(to_grid(centre)));
      fresh.push_back(centre);
      ++inserted;
    }
    return inserted;
  }

  void describe(SizedPanel& result, const Samples& samples);

 private:
  GridPoint to_grid(const dvec2& working) const {
    const dvec2 at =
        glm::clamp((working - centre_) * scale_, dvec2(-Triangulation::limit), dvec2(Triangulation::limit));
    return {static_cast<std::int32_t>(std::lround(at.x)), static_cast<std::int32_t>(std::lround(at.y))};
  }
  dvec2 from_grid(GridPoint point) const { return centre_ + dvec2(point.x, point.y) / scale_; }
  std::array<dvec2, 3> corners(std::uint32_t t) const {
    const auto& v = mesh_.triangles()[t].vertex;
    return {from_grid(mesh_.points()[v[0]]), from_grid(mesh_.points()[v[1]]),
            from_grid(mesh_.points()[v[2]])};
  }
  double least_angle(std::uint32_t t) const {
    const auto [a, b, c] = corners(t);
    return std::min({angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)});
  }

  void mark_free(std::uint32_t vertex) {
    if (free_.size() <= vertex) free_.resize(vertex + 1, 0);
    free_[vertex] = 1;
  }

  // Which vertices lie on lines, which of them on the lines of a fold, and where lines meet under 60°.
  void settle_roles() {
    free_.resize(mesh_.points().size(), 0);
    on_fold_.assign(free_.size(), 0);
    sharp_.assign(free_.size(), 0);
    std::vector<std::vector<std::uint32_t>> spokes(free_.size());
    for (const auto& triangle : mesh_.triangles()) {
      if (!triangle.inside) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (triangle.tag[i] == Triangulation::free_edge) continue;
        const Domain::Line& line = domain_.lines[triangle.tag[i] - 1U];
        const std::uint32_t a = triangle.vertex[(i + 1) % 3], b = triangle.vertex[(i + 2) % 3];
        for (const auto& [v, other] : {std::pair(a, b), std::pair(b, a)}) {
          free_[v] = 0;
          if (line.fold >= 0) on_fold_[v] |= static_cast<std::uint8_t>(1 << (line.fold_side + 1));
          auto& ends = spokes[v];
          if (std::find(ends.begin(), ends.end(), other) == ends.end()) ends.push_back(other);
        }
      }
    }
    for (std::uint32_t v = 0; v < spokes.size(); ++v) {
      for (std::size_t i = 0; i < spokes[v].size(); ++i) {
        for (std::size_t j = i + 1; j < spokes[v].size(); ++j) {
          const double angle = angle_at(from_grid(mesh_.points()[v]), from_grid(mesh_.points()[spokes[v][i]]),
                                        from_grid(mesh_.points()[spokes[v][j]]));
          if (angle < sharp_meeting) sharp_[v] = 1;
        }
      }
    }
  }

  // Triangles whose angles the mesher cannot choose.
  bool exempt(std::uint32_t t) const {
    const auto& vertex = mesh_.triangles()[t].vertex;
    std::array<std::uint8_t, 3> folds{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (vertex[i] >= sharp_.size()) return false;
      if (sharp_[vertex[i]]) return true;
      folds[i] = on_fold_[vertex[i]];
    }
    // Corners on two different lines of a fold.
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint8_t one = folds[i], other = folds[(i + 1) % 3];
      if (one && other && (one & other) == 0) return true;
    }
    return false;
  }

  const Domain& domain_;
  const SizeMap& map_;
  dvec2 centre_{0};
  double scale_ = 1;
  Triangulation mesh_;
  std::vector<std::uint8_t> free_, on_fold_, sharp_;
  std::vector<std::uint32_t> vertex_of_sample_;
};

void Mesher::describe(SizedPanel& result, const Samples& samples) {
  settle_roles();
  PanelMesh& mesh = result.mesh;
  MeshQuality& quality = result.quality;
  std::vector<std::uint32_t> index(mesh_.points().size(), Triangulation::none);
  std::vector<dvec2> working;
  quality.least_angle = 180;
  std::size_t edges = 0, within = 0;
  double lengths = 0;
  std::vector<double> found(domain_.lines.size(), 0);
  for (std::uint32_t t = 0; t < mesh_.triangles().size(); ++t) {
    const auto& triangle = mesh_.triangles()[t];
    if (!triangle.inside) continue;
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& v = index[triangle.vertex[i]];
      if (v == Triangulation::none) {
        v = static_cast<std::uint32_t>(mesh.vertices.size());
        working.push_back(from_grid(mesh_.points()[triangle.vertex[i]]));
        const dvec2 r = map_.resolution(working.back());
        mesh.vertices.push_back(domain_.to_panel * working.back());
        mesh.sizes.push_back(std::sqrt(r.x * r.y));
      }
      corner[i] = v;
    }
    mesh.triangles.push_back(corner);
    if (exempt(t)) {
      ++quality.exempt;
    } else {
      quality.least_angle = std::min(quality.least_angle, least_angle(t) * 180 / std::numbers::pi);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t other = triangle.neighbour[i];
      if (mesh_.triangles()[other].inside && other < t) continue;  // counted from its other side
      const std::uint32_t a = corner[(i + 1) % 3], b = corner[(i + 2) % 3];
      const bool across_fold = [&] {
        const std::uint8_t one = on_fold_[triangle.vertex[(i + 1) % 3]],
                           two = on_fold_[triangle.vertex[(i + 2) % 3]];
        return one && two && (one & two) == 0;
      }();
      if (!across_fold) {  // its length is half a millimetre by design
        const dvec2 middle = (working[a] + working[b]) / 2.0, edge = mesh.vertices[b] - mesh.vertices[a];
        const double length = std::sqrt(glm::dot(edge, map_.metric(middle) * edge));
        ++edges;
        lengths += length;
        within += length >= 0.5 && length <= 2;
      }
      if (triangle.tag[i] != Triangulation::free_edge) {
        mesh.line_edges.push_back({a, b, triangle.tag[i] - 1U});
        found[triangle.tag[i] - 1U] += glm::distance(working[a], working[b]);
      }
    }
  }
  for (const auto& line : samples.lines) {
    auto& vertices = mesh.lines.emplace_back();
    for (const std::uint32_t sample : line) vertices.push_back(index[vertex_of_sample_[sample]]);
    if (std::find(vertices.begin(), vertices.end(), Triangulation::none) != vertices.end()) vertices.clear();
  }
  quality.edges_within = static_cast<double>(within) / static_cast<double>(std::max<std::size_t>(edges, 1));
  quality.mean_edge = lengths / static_cast<double>(std::max<std::size_t>(edges, 1));
  quality.length_ratio = edge_length_ratio(mesh);
  quality.expected_vertices = expected_vertices(domain_, map_, samples);
  for (std::size_t l = 0; l < found.size(); ++l) {
    double asked = 0;
    for (std::size_t k = 0; k + 1 < samples.lines[l].size(); ++k)
      asked += glm::distance(samples.points[samples.lines[l][k]], samples.points[samples.lines[l][k + 1]]);
    // Each vertex is rounded to the grid: by half a unit in each coordinate.
    if (asked - found[l] > 2.0 / scale_ * static_cast<double>(samples.lines[l].size()))
      quality.lost += asked - found[l];
  }
}

}  // namespace

double edge_length_ratio(const PanelMesh& mesh) {
  double xx = 0, xy = 0, yy = 0;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const dvec2 edge = mesh.vertices[triangle[(i + 1) % 3]] - mesh.vertices[triangle[i]];
      xx += edge.x * edge.x;
      xy += edge.x * edge.y;
      yy += edge.y * edge.y;
    }
  }
  const double mean = (xx + yy) / 2, apart = std::hypot((xx - yy) / 2, xy);
  return std::sqrt((mean + apart) / std::max(mean - apart, 1e-300));
}

std::unique_ptr<SizedPanel> size_panel(const Panel& panel, const SizingOptions& options,
                                       const std::map<std::size_t, double>& seam_sizes) {
  auto result = std::make_unique<SizedPanel>();
  const double start = wall_seconds();
  result->domain = prepare(panel, options);
  for (const auto& [line, size] : seam_sizes) result->domain.lines[line].seam_size = size;
  result->sources = sources_of(panel, options);
  result->map = std::make_unique<SizeMap>(panel, result->domain, result->sources, options);
  result->seconds.map = wall_seconds() - start;
  return result;
}

void mesh_sized(SizedPanel& sized, const SizingOptions& options, const Divisions& divisions) {
  double start = wall_seconds();
  const auto lap = [&] {
    const double seconds = wall_seconds() - start;
    start = wall_seconds();
    return seconds;
  };
  Samples samples = sample_lines(sized.domain, *sized.map, divisions);
  sample_interior(sized.domain, *sized.map, options.seed, samples);
  sized.seconds.sample = lap();

  Mesher mesher(sized.domain, *sized.map);
  mesher.triangulate(samples);
  sized.seconds.triangulate = lap();

  mesher.smooth(8);
  for (int round = 0; round < 6 && mesher.refine() > 0; ++round) mesher.smooth(2);
  mesher.describe(sized, samples);
  sized.seconds.improve = lap();
}

std::unique_ptr<SizedPanel> mesh_panel(const Panel& panel, const SizingOptions& options) {
  auto result = size_panel(panel, options);
  mesh_sized(*result, options, {});
  return result;
}

}  // namespace plisse::sizing
