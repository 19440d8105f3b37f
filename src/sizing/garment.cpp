#include "sizing/garment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/error.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;
using glm::dvec3;

// One side of a seam as pieces of its panel's outline, in the direction of the seam.
struct Stretch {
  std::vector<std::size_t> lines;  // of the domain
  bool backward = false;           // against the outline's own direction
  std::vector<double> ends;        // of the pieces: length from the seam's beginning, m
  double length() const { return ends.back(); }
};

double panel_length(const Domain& domain, const Polyline& shape) {
  double length = 0;
  for (std::size_t i = 0; i < shape.segment_count(); ++i)
    length += glm::length(domain.to_panel * (shape.end(i) - shape.start(i)));
  return length;
}

// The points of a stretch, panel coordinates.
Polyline curve_of(const Domain& domain, const Stretch& stretch) {
  Polyline curve;
  for (const std::size_t line : stretch.lines) {
    std::vector<dvec2> points = domain.lines[line].shape.points;
    if (stretch.backward) std::reverse(points.begin(), points.end());
    for (const dvec2& point : points) curve.points.push_back(domain.to_panel * point);
  }
  return without_repeats(std::move(curve));
}

dvec2 point_at(const Polyline& curve, double length) {
  for (std::size_t i = 0; i < curve.segment_count(); ++i) {
    const double piece = glm::distance(curve.start(i), curve.end(i));
    if (length <= piece) return curve.start(i) + (curve.end(i) - curve.start(i)) * (length / piece);
    length -= piece;
  }
  return curve.points.back();
}

std::vector<double> turned(std::vector<double> shares) {
  std::reverse(shares.begin(), shares.end());
  for (double& share : shares) share = 1 - share;
  return shares;
}

class Sewing {
 public:
  Sewing(const Garment& garment, const SizingOptions& options) : garment_(garment), options_(options) {
    result_.made = garment.panels;
  }

  SizedGarment run() {
    mark_ends();
    align();
    mesh();
    sew();
    place();
    return std::move(result_);
  }

 private:
  void problem(const std::string& text) { problems_ += (problems_.empty() ? "" : "\n") + text; }
  void report() const {
    if (!problems_.empty()) throw Error(ExitCode::bad_input, problems_);
  }
  std::string name_of(const Seam& seam) const { return fmt::format("seam '{}'", seam.name); }

  void mark_ends() {
    for (const Seam& seam : garment_.seams)
      for (const SeamSide* side : {&seam.a, &seam.b}) {
        auto& marks = result_.made[side->panel].marks;
        marks.push_back(side->from);
        marks.push_back(side->to);
      }
  }

  // Every panel's domain, and the pieces of the seams on it.
  void prepare_all() {
    domains_.clear();
    for (const Panel& panel : result_.made) {
      try {
        domains_.push_back(prepare(panel, options_));
      } catch (const Error& error) {
        problem(error.what());
      }
    }
    report();
    stretches_.clear();
    for (const Seam& seam : garment_.seams) {
      stretches_.push_back({stretch_of(seam, seam.a), stretch_of(seam, seam.b)});
      auto& [a, b] = stretches_.back();
      if (a.lines.empty() || b.lines.empty()) continue;
      if (seam.a.panel == seam.b.panel &&
          std::find_first_of(a.lines.begin(), a.lines.end(), b.lines.begin(), b.lines.end()) != a.lines.end())
        problem(name_of(seam) + " sews a stretch of outline to itself");
    }
    report();
  }

  Stretch stretch_of(const Seam& seam, const SeamSide& side) {
    const Domain& domain = domains_[side.panel];
    std::vector<std::size_t> outline;
    for (std::size_t l = 0; l < domain.boundary_lines; ++l)
      if (domain.lines[l].curve == 0) outline.push_back(l);
    const auto nearest = [&](const dvec2& point) {
      std::size_t best = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const double distance =
            glm::distance(domain.to_panel * domain.lines[outline[i]].shape.points.front(), point);
        if (distance < least) {
          least = distance;
          best = i;
        }
      }
      return best;
    };
    const std::size_t from = nearest(side.from), to = nearest(side.to), count = outline.size();
    if (from == to) {
      problem(fmt::format("{}: begins and ends at one point of panel '{}'", name_of(seam),
                          garment_.panels[side.panel].name));
      return {};
    }
    const auto walk = [&](std::size_t begin, std::size_t end, bool backward) {
      Stretch stretch;
      stretch.backward = backward;
      for (std::size_t i = begin; i != end; i = (i + 1) % count) stretch.lines.push_back(outline[i]);
      if (backward) std::reverse(stretch.lines.begin(), stretch.lines.end());
      double length = 0;
      for (const std::size_t line : stretch.lines)
        stretch.ends.push_back(length += panel_length(domain, domain.lines[line].shape));
      return stretch;
    };
    Stretch along = walk(from, to, false), against = walk(to, from, true);
    return (along.length() <= against.length()) != side.long_way ? along : against;
  }

  // Corners and features cut the sides of a seam into pieces; each side also gets the cuts of the other,
  // until all agree. Seams may form a chain through all panels, so this may take as many rounds as there are
  // panels.
  void align() {
    prepare_all();
    add_stitches();
    for (std::size_t round = 0;; ++round) {
      prepare_all();
      bool changed = false;
      for (std::size_t s = 0; s < garment_.seams.size(); ++s) {
        const Seam& seam = garment_.seams[s];
        const auto& [a, b] = stretches_[s];
        changed |= cut_as(seam.a, a, seam.b, b);
        changed |= cut_as(seam.b, b, seam.a, a);
      }
      if (!changed) break;
      if (round > 2 * garment_.panels.size() + 4)
        throw Error(ExitCode::bad_input,
                    "the seams cut each other's sides over and over; sew shorter stretches");
    }
  }

  // Marks on `other` for every cut of `one` that it lacks.
  bool cut_as(const SeamSide& one_side, const Stretch& one, const SeamSide& other_side,
              const Stretch& other) {
    const double close =
        0.3 * std::min(domains_[one_side.panel].size, domains_[other_side.panel].size) / other.length();
    bool changed = false;
    for (std::size_t k = 0; k + 1 < one.ends.size(); ++k) {
      const double share = one.ends[k] / one.length();
      if (std::any_of(other.ends.begin(), other.ends.end() - 1,
                      [&](double end) { return std::abs(end / other.length() - share) <= close; }))
        continue;
      result_.made[other_side.panel].marks.push_back(
          point_at(curve_of(domains_[other_side.panel], other), share * other.length()));
      changed = true;
    }
    return changed;
  }

  void add_stitches() {
    for (std::size_t s = 0; s < garment_.seams.size(); ++s) {
      const Seam& seam = garment_.seams[s];
      const auto& [a, b] = stretches_[s];
      const bool a_is_longer = a.length() > b.length();
      const Stretch &longer = a_is_longer ? a : b, &shorter = a_is_longer ? b : a;
      if (longer.length() <= 1.001 * shorter.length()) continue;
      const std::size_t panel = a_is_longer ? seam.a.panel : seam.b.panel;
      Feature stitch;
      stitch.name = seam.name;
      stitch.rule = Feature::Rule::stitch;
      stitch.line = curve_of(domains_[panel], longer);
      stitch.other_length = shorter.length();
      stitch.cause.poisson_ratio = result_.made[panel].fabric.poisson_ratio;
      result_.made[panel].features.push_back(std::move(stitch));
    }
  }

  void mesh() {
    for (const Panel& panel : result_.made) result_.panels.push_back(size_panel(panel, options_));
    refine_coarser_sides();
    std::vector<Divisions> divisions(result_.panels.size());
    each_piece([&](const Piece& piece) {
      const auto by_a = wanted(piece, 0), by_b = wanted(piece, 1);
      const auto& shares = by_a.size() >= by_b.size() ? by_a : by_b;
      for (const std::size_t i : {0U, 1U}) {
        const std::size_t panel = piece.side[i]->panel;
        if (!divisions[panel].try_emplace(piece.line[i], piece.backward[i] ? turned(shares) : shares).second)
          problem(fmt::format("{} overlaps another seam on panel '{}'", name_of(*piece.seam),
                              garment_.panels[panel].name));
      }
    });
    report();
    for (std::size_t p = 0; p < result_.panels.size(); ++p)
      mesh_sized(*result_.panels[p], options_, divisions[p]);
  }

  // Between two corners of a seam: a line of each side.
  struct Piece {
    const Seam* seam;
    std::array<const SeamSide*, 2> side;
    std::array<std::size_t, 2> line;
    std::array<bool, 2> backward;
  };
  template <typename Action>
  void each_piece(const Action& action) const {
    for (std::size_t s = 0; s < garment_.seams.size(); ++s) {
      const Seam& seam = garment_.seams[s];
      const auto& [a, b] = stretches_[s];
      if (a.lines.size() != b.lines.size())
        throw Error(ExitCode::bad_input,
                    fmt::format("{}: corners of its two sides are too close to one another to be told apart",
                                name_of(seam)));
      for (std::size_t k = 0; k < a.lines.size(); ++k)
        action(Piece{&seam, {&seam.a, &seam.b}, {a.lines[k], b.lines[k]}, {a.backward, b.backward}});
    }
  }

  // The division of a piece by one side alone, in the seam's direction.
  std::vector<double> wanted(const Piece& piece, std::size_t i) const {
    const SizedPanel& sized = *result_.panels[piece.side[i]->panel];
    auto shares = line_division(sized.domain, *sized.map, piece.line[i]);
    return piece.backward[i] ? turned(std::move(shares)) : shares;
  }

  // On the side that gets more vertices than it needs, the sizes around the seam are reduced smoothly.
  void refine_coarser_sides() {
    std::vector<std::map<std::size_t, double>> sizes(result_.panels.size());
    each_piece([&](const Piece& piece) {
      const std::size_t count[] = {wanted(piece, 0).size(), wanted(piece, 1).size()};
      if (count[0] == count[1]) return;
      const std::size_t coarse = count[0] < count[1] ? 0 : 1, panel = piece.side[coarse]->panel;
      const double length = result_.panels[panel]->domain.lines[piece.line[coarse]].shape.length();
      sizes[panel][piece.line[coarse]] = length / static_cast<double>(count[1 - coarse] + 1);
    });
    for (std::size_t p = 0; p < sizes.size(); ++p)
      if (!sizes[p].empty()) result_.panels[p] = size_panel(result_.made[p], options_, sizes[p]);
  }

  // A panel's vertices along a stretch, in the seam's direction.
  std::vector<std::uint32_t> chain(const Seam& seam, const SeamSide& side, const Stretch& stretch) const {
    const PanelMesh& mesh = result_.panels[side.panel]->mesh;
    std::vector<std::uint32_t> all;
    for (const std::size_t line : stretch.lines) {
      std::vector<std::uint32_t> vertices = mesh.lines[line];
      if (vertices.empty())
        throw Error(ExitCode::bad_input, fmt::format("{}: panel '{}' is too small there to be meshed",
                                                     name_of(seam), garment_.panels[side.panel].name));
      if (stretch.backward) std::reverse(vertices.begin(), vertices.end());
      all.insert(all.end(), vertices.begin() + (all.empty() ? 0 : 1), vertices.end());
    }
    return all;
  }

  void sew() {
    // Where two panels both have an edge across a corner of a seam, sewing would join four triangles at that
    // edge: it is split in all panels but one. The new triangles may need the same again.
    for (int round = 0; round < 8; ++round) {
      unite();
      if (!split_shared_chords()) break;
    }
    unite();
    for (std::size_t p = 0; p < result_.panels.size(); ++p)
      for (const auto& triangle : result_.panels[p]->mesh.triangles) {
        const auto [a, b, c] = sewn(p, triangle);
        if (a == b || b == c || c == a)
          throw Error(
              ExitCode::bad_input,
              fmt::format("panel '{}': its seams close a triangle; it is too narrow for its resolution there",
                          garment_.panels[p].name));
      }
  }

  std::array<std::uint32_t, 3> sewn(std::size_t panel, const std::array<std::uint32_t, 3>& triangle) const {
    const std::uint32_t first = result_.first[panel];
    return {result_.sewn[first + triangle[0]], result_.sewn[first + triangle[1]],
            result_.sewn[first + triangle[2]]};
  }

  void unite() {
    result_.first.clear();
    std::uint32_t count = 0;
    for (const auto& panel : result_.panels) {
      result_.first.push_back(count);
      count += static_cast<std::uint32_t>(panel->mesh.vertices.size());
    }
    std::vector<std::uint32_t> parent(count);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t v) {
      while (parent[v] != v) v = parent[v] = parent[parent[v]];
      return v;
    };
    std::vector<std::vector<std::uint32_t>> chains;
    result_.joins.clear();
    for (std::size_t s = 0; s < garment_.seams.size(); ++s) {
      const Seam& seam = garment_.seams[s];
      const auto a = chain(seam, seam.a, stretches_[s].first), b = chain(seam, seam.b, stretches_[s].second);
      const std::uint32_t first_a = result_.first[seam.a.panel], first_b = result_.first[seam.b.panel];
      SizedGarment::Join& join = result_.joins.emplace_back();
      join.name = seam.name;
      join.length_a = stretches_[s].first.length();
      join.length_b = stretches_[s].second.length();
      join.edges = a.size() - 1;
      for (std::size_t k = 0; k < a.size(); ++k) {
        join.gap = std::max(join.gap, glm::distance(placed(seam.a.panel, a[k]), placed(seam.b.panel, b[k])));
        const std::uint32_t one = root(first_a + a[k]), other = root(first_b + b[k]);
        parent[std::max(one, other)] = std::min(one, other);
      }
      chains.push_back(a);
    }
    result_.sewn.assign(count, 0);
    result_.vertices = 0;
    for (std::uint32_t v = 0; v < count; ++v)  // a root is the least of its vertices
      result_.sewn[v] = root(v) == v ? static_cast<std::uint32_t>(result_.vertices++) : result_.sewn[root(v)];
    result_.seam_edges.assign(garment_.seams.size(), {});
    for (std::size_t s = 0; s < chains.size(); ++s) {
      const std::uint32_t first = result_.first[garment_.seams[s].a.panel];
      for (std::size_t k = 0; k + 1 < chains[s].size(); ++k)
        result_.seam_edges[s].push_back(
            {result_.sewn[first + chains[s][k]], result_.sewn[first + chains[s][k + 1]]});
    }
  }

  bool split_shared_chords() {
    struct Use {
      std::size_t panel;
      std::uint32_t a, b;  // of the panel
      int triangles;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Use>> uses;
    for (std::size_t p = 0; p < result_.panels.size(); ++p)
      for (const auto& triangle : result_.panels[p]->mesh.triangles) {
        const auto joined = sewn(p, triangle);
        for (std::size_t i = 0; i < 3; ++i) {
          const std::size_t j = (i + 1) % 3;
          const std::uint32_t a = std::min(triangle[i], triangle[j]), b = std::max(triangle[i], triangle[j]);
          auto& list = uses[std::minmax(joined[i], joined[j])];
          const auto same = std::find_if(list.begin(), list.end(), [&](const Use& use) {
            return use.panel == p && use.a == a && use.b == b;
          });
          same == list.end() ? list.push_back({p, a, b, 1}) : void(++same->triangles);
        }
      }
    bool any = false;
    std::vector<std::set<std::pair<std::uint32_t, std::uint32_t>>> chords(result_.panels.size());
    for (const auto& [edge, list] : uses) {
      const int all = std::accumulate(list.begin(), list.end(), 0,
                                      [](int sum, const Use& use) { return sum + use.triangles; });
      if (all <= 2) continue;
      int kept = all;
      for (const Use& use : list) {
        if (use.triangles != 2 || kept <= 2) continue;
        chords[use.panel].insert({use.a, use.b});
        kept -= 2;
        any = true;
      }
    }
    for (std::size_t p = 0; p < chords.size(); ++p)
      for (const auto& [a, b] : chords[p]) split(result_.panels[p]->mesh, a, b);
    return any;
  }

  // A vertex in the middle of an edge that two triangles share.
  static void split(PanelMesh& mesh, std::uint32_t a, std::uint32_t b) {
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2.0);
    mesh.sizes.push_back((mesh.sizes[a] + mesh.sizes[b]) / 2);
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
      auto& triangle = mesh.triangles[t];
      const auto at_a = std::find(triangle.begin(), triangle.end(), a),
                 at_b = std::find(triangle.begin(), triangle.end(), b);
      if (at_a == triangle.end() || at_b == triangle.end()) continue;
      auto half = triangle;
      half[static_cast<std::size_t>(at_a - triangle.begin())] = middle;
      *at_b = middle;
      mesh.triangles.push_back(half);
    }
  }

  dvec3 placed(std::size_t panel, std::uint32_t vertex) const {
    const dvec3 flat(result_.panels[panel]->mesh.vertices[vertex], 0);
    if (garment_.placements.empty()) return flat;
    return garment_.placements[panel].rotation * flat + garment_.placements[panel].translation;
  }

  void place() {
    std::vector<double> shares(result_.vertices, 0);
    result_.positions.assign(result_.vertices, dvec3(0));
    for (std::size_t p = 0; p < result_.panels.size(); ++p)
      for (std::uint32_t v = 0; v < result_.panels[p]->mesh.vertices.size(); ++v) {
        const std::uint32_t joined = result_.sewn[result_.first[p] + v];
        result_.positions[joined] += placed(p, v);
        shares[joined] += 1;
      }
    for (std::size_t v = 0; v < result_.vertices; ++v) result_.positions[v] /= shares[v];
  }

  const Garment& garment_;
  const SizingOptions& options_;
  SizedGarment result_;
  std::vector<Domain> domains_;
  std::vector<std::pair<Stretch, Stretch>> stretches_;
  std::string problems_;
};

}  // namespace

glm::dmat3 turned_by(const dvec3& degrees) {
  glm::dmat4 turn(1);
  for (int axis = 2; axis >= 0; --axis) {
    dvec3 around(0);
    around[axis] = 1;
    turn = glm::rotate(turn, glm::radians(degrees[axis]), around);
  }
  return glm::dmat3(turn);
}

SizedGarment mesh_garment(const Garment& garment, const SizingOptions& options) {
  return Sewing(garment, options).run();
}

}  // namespace plisse::sizing
