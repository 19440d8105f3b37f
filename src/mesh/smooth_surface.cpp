#include "mesh/smooth_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/error.h"

namespace plisse {
namespace {

using Face = std::array<std::uint32_t, 3>;
constexpr std::uint32_t none = ~std::uint32_t{0};

std::pair<std::uint32_t, std::uint32_t> ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

Face over(Face face) {
  std::swap(face[1], face[2]);
  return face;
}

// Which faces have to be turned over so that neighbours agree.
std::vector<bool> turned_to_one_side(const std::vector<Face>& faces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, bool>>> edges;
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::size_t s = 0; s < 3; ++s) {
      const std::uint32_t a = faces[f][s], b = faces[f][(s + 1) % 3];
      edges[ordered(a, b)].emplace_back(f, a < b);
    }
  std::vector<bool> turned(faces.size(), false), seen(faces.size(), false);
  for (std::uint32_t seed = 0; seed < faces.size(); ++seed) {
    if (seen[seed]) continue;
    std::vector<std::uint32_t> queue{seed};
    seen[seed] = true;
    while (!queue.empty()) {
      const std::uint32_t f = queue.back();
      queue.pop_back();
      for (std::size_t s = 0; s < 3; ++s) {
        const auto& at = edges[ordered(faces[f][s], faces[f][(s + 1) % 3])];
        if (at.size() != 2) continue;
        const auto& [first, first_up] = at[0];
        const auto& [second, second_up] = at[1];
        const std::uint32_t other = first == f ? second : first;
        if (seen[other]) continue;
        seen[other] = true;
        turned[other] = (first_up == second_up) != turned[f];
        queue.push_back(other);
      }
    }
  }
  return turned;
}

// Gives each fan of faces round a vertex a vertex of its own; returns the vertex that each of them was.
std::vector<std::uint32_t> part_fans(std::vector<Face>& faces) {
  // Corners (3 · face + corner) are one vertex where faces share a side at it.
  std::vector<std::uint32_t> same(3 * faces.size());
  for (std::uint32_t c = 0; c < same.size(); ++c) same[c] = c;
  const auto of = [&](std::uint32_t c) {
    while (same[c] != c) c = same[c] = same[same[c]];
    return c;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::uint32_t, 2>>
      sides;  // corners at both ends
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::uint32_t s = 0; s < 3; ++s) {
      std::uint32_t a = 3 * f + s, b = 3 * f + (s + 1) % 3;
      if (faces[f][s] > faces[f][(s + 1) % 3]) std::swap(a, b);
      const auto [entry, fresh] =
          sides.try_emplace(ordered(faces[f][s], faces[f][(s + 1) % 3]), std::array{a, b});
      if (fresh) continue;
      same[of(a)] = of(entry->second[0]);
      same[of(b)] = of(entry->second[1]);
    }
  std::vector<std::uint32_t> number(same.size(), none), was;
  for (std::uint32_t c = 0; c < same.size(); ++c) {
    std::uint32_t& own = number[of(c)];
    std::uint32_t& corner = faces[c / 3][c % 3];
    if (own == none) {
      own = static_cast<std::uint32_t>(was.size());
      was.push_back(corner);
    }
    corner = own;
  }
  return was;
}

// Corners of the outline that turn by more than 60 degrees.
void add_sharp_corners(const std::vector<Face>& faces, const std::vector<glm::dvec3>& rest,
                       std::vector<bool>& sharp) {
  std::vector<double> angle(rest.size(), 0);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const Face& f : faces)
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::dvec3 a = rest[f[(c + 1) % 3]] - rest[f[c]], b = rest[f[(c + 2) % 3]] - rest[f[c]];
      angle[f[c]] += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      ++count[ordered(f[c], f[(c + 1) % 3])];
    }
  for (const auto& [edge, faces_at] : count) {
    if (faces_at != 1) continue;
    for (const std::uint32_t v : {edge.first, edge.second})
      if (std::abs(angle[v] - std::numbers::pi) > std::numbers::pi / 3) sharp[v] = true;
  }
}

using Weights = std::array<int, 3>;  // of a face's corners, in parts of the whole
// A multiple of 3, so that the middle of a triangle has weights as well.
int whole_of(int levels) {
  return 3 << levels;
}

// Of the corners of each face of the last level: the coarse face, and where they are on it.
std::vector<std::array<Weights, 3>> places_on_roots(const LoopSubdivision& loop,
                                                    std::vector<std::uint32_t>& root) {
  const int whole = whole_of(static_cast<int>(loop.levels.size()) - 1);
  std::vector<std::array<Weights, 3>> at(loop.levels.front().faces.size(),
                                         {{{whole, 0, 0}, {0, whole, 0}, {0, 0, whole}}});
  root.resize(at.size());
  for (std::uint32_t f = 0; f < root.size(); ++f) root[f] = f;
  for (std::size_t l = 1; l < loop.levels.size(); ++l) {
    const LoopLevel& level = loop.levels[l];
    std::vector<std::array<Weights, 3>> next;
    std::vector<std::uint32_t> next_root;
    for (std::size_t f = 0; f < level.faces.size(); ++f) {
      const auto& parent = at[level.parent[f]];
      auto& own = next.emplace_back();
      next_root.push_back(root[level.parent[f]]);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t place = level.place[f][c];
        for (std::size_t k = 0; k < 3; ++k)
          own[c][k] = place < 3 ? parent[place][k] : (parent[place - 3][k] + parent[(place - 2) % 3][k]) / 2;
      }
    }
    at = std::move(next);
    root = std::move(next_root);
  }
  return at;
}

}  // namespace

std::vector<bool> deforming(const SolvedClip& sheets, const std::vector<glm::dvec3>& rest) {
  std::vector<std::uint32_t> shell(sheets.welded.size());
  for (std::uint32_t v = 0; v < shell.size(); ++v) shell[v] = v;
  const auto of = [&](std::uint32_t v) {
    while (shell[v] != v) v = shell[v] = shell[shell[v]];
    return v;
  };
  for (const Face& f : sheets.faces)
    for (const std::uint32_t v : {f[1], f[2]}) shell[of(v)] = of(f[0]);

  std::vector<bool> deforms(shell.size(), false);
  for (const SolvedClip::Frame& frame : sheets.frames) {
    if (frame.base.empty()) continue;
    const auto each_edge = [&](const auto& work) {
      for (const Face& f : sheets.faces)
        for (std::size_t s = 0; s < 3; ++s) {
          const std::uint32_t a = f[s], b = f[(s + 1) % 3];
          work(of(a), glm::distance(rest[sheets.welded[a]], rest[sheets.welded[b]]),
               glm::distance(frame.base[a], frame.base[b]));
        }
    };
    std::vector<double> before(shell.size(), 0), now(shell.size(), 0);
    each_edge([&](std::uint32_t s, double at_rest, double here) {
      before[s] += at_rest;
      now[s] += here;
    });
    // Models have the digits of single precision, 6e-8 of what is farthest from the origin, at both ends of
    // an edge, at rest and here.
    double farthest = 0;
    for (const glm::dvec3& x : frame.base) farthest = std::max(farthest, glm::length(x));
    for (const std::uint32_t v : sheets.welded) farthest = std::max(farthest, glm::length(rest[v]));
    each_edge([&](std::uint32_t s, double at_rest, double here) {
      const double scale = before[s] > 0 ? now[s] / before[s] : 1;
      if (std::abs(here - scale * at_rest) > 1e-6 * farthest * std::max(scale, 1.0)) deforms[s] = true;
    });
  }
  std::vector<bool> result;
  for (const Face& f : sheets.faces) result.push_back(deforms[of(f[0])]);
  return result;
}

std::vector<bool> smooth_at_rest(const SolvedClip& sheets, const Surface& surface) {
  const double least = std::cos(std::numbers::pi / 6);
  const std::vector<bool> turned = turned_to_one_side(sheets.faces);
  std::vector<bool> hard(sheets.welded.size(), false);
  std::map<std::pair<std::uint32_t, std::uint32_t>, glm::dvec3> normals;  // of the first face at an edge
  std::vector<glm::dvec3> shown(hard.size(), glm::dvec3(0));              // of the first face at a vertex
  for (std::size_t f = 0; f < sheets.faces.size(); ++f) {
    const Face& face = sheets.faces[f];
    const auto at = [&](std::size_t c) { return surface.rest[sheets.welded[face[c]]]; };
    const glm::dvec3 area = glm::cross(at(1) - at(0), at(2) - at(0)) * (turned[f] ? -1.0 : 1.0);
    const glm::dvec3 normal = glm::length(area) > 0 ? glm::normalize(area) : glm::dvec3(0);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [entry, fresh] = normals.try_emplace(ordered(face[c], face[(c + 1) % 3]), normal);
      if (!fresh && glm::dot(entry->second, normal) < least) hard[face[c]] = hard[face[(c + 1) % 3]] = true;
      const glm::dvec3 own = surface.render_vertices[surface.triangles[3 * sheets.triangle[f] + c]].normal;
      if (shown[face[c]] == glm::dvec3(0)) shown[face[c]] = own;
      if (glm::dot(shown[face[c]], own) < least) hard[face[c]] = true;
    }
  }
  std::vector<bool> result;
  for (const Face& f : sheets.faces) result.push_back(!hard[f[0]] && !hard[f[1]] && !hard[f[2]]);
  return result;
}

// Numbers the vertices of the fine surface, and makes its triangles.
class SmoothSurface::Builder {
 public:
  Builder(const Surface& coarse, SmoothSurface& smooth, int whole)
      : coarse_(coarse), fine_(smooth.fine_), smooth_(smooth), whole_(whole) {
    fine_.render_vertices = coarse.render_vertices;
  }

  std::uint32_t render_of(std::size_t triangle, std::size_t corner) const {
    return coarse_.triangles[3 * triangle + corner];
  }
  std::uint32_t welded_of(std::size_t triangle, std::size_t corner) const {
    return coarse_.render_vertices[render_of(triangle, corner)].welded;
  }

  // The point of a triangle, weights by its corners; `inside`: a number of its own where it is not on an
  // edge.
  std::uint32_t welded_at(std::size_t triangle, const Weights& weights, std::uint64_t inside) {
    std::size_t corners[3], count = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (weights[k] > 0) corners[count++] = k;
    if (count == 1) return welded_of(triangle, corners[0]);
    std::array<std::uint64_t, 3> key{none, none, inside};
    if (count == 2) {
      std::size_t a = corners[0], b = corners[1];
      if (welded_of(triangle, a) > welded_of(triangle, b)) std::swap(a, b);
      key = {welded_of(triangle, a), welded_of(triangle, b), static_cast<std::uint64_t>(weights[b])};
    }
    const auto [entry, fresh] =
        welded_.try_emplace(key, static_cast<std::uint32_t>(coarse_.vertex_count() + smooth_.from_.size()));
    if (fresh) {
      From from;
      for (std::size_t k = 0; k < 3; ++k) {
        from.vertex[k] = welded_of(triangle, k);
        from.weight[k] = static_cast<double>(weights[k]) / whole_;
      }
      smooth_.from_.push_back(from);
    }
    return entry->second;
  }

  std::uint32_t render_at(std::size_t triangle, const Weights& weights, std::uint32_t welded) {
    std::size_t corners[3], count = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (weights[k] > 0) corners[count++] = k;
    if (count == 1) return render_of(triangle, corners[0]);
    std::array<std::uint32_t, 3> key{none, none, welded};  // inside it is this triangle's alone
    if (count == 2) {
      const auto [a, b] = ordered(render_of(triangle, corners[0]), render_of(triangle, corners[1]));
      key = {a, b, welded};
    }
    const auto [entry, fresh] =
        render_.try_emplace(key, static_cast<std::uint32_t>(fine_.render_vertices.size()));
    if (fresh) {
      RenderVertex vertex;
      vertex.welded = welded;
      vertex.normal = vertex.colour = glm::vec4(0);
      for (std::size_t k = 0; k < 3; ++k) {
        const RenderVertex& corner = coarse_.render_vertices[render_of(triangle, k)];
        const float weight = static_cast<float>(weights[k]) / static_cast<float>(whole_);
        vertex.uv += weight * corner.uv;
        vertex.normal_uv += weight * corner.normal_uv;
        vertex.colour += weight * corner.colour;
        vertex.normal += weight * corner.normal;
      }
      if (glm::length(vertex.normal) > 0) vertex.normal = glm::normalize(vertex.normal);
      fine_.render_vertices.push_back(vertex);
    }
    return entry->second;
  }

  // The points on an edge from its first end to its second, without the ends; none where it was not split.
  std::vector<Weights> on_side(std::size_t triangle, std::size_t side) const {
    const std::size_t a = side, b = (side + 1) % 3;
    const auto [low, high] = ordered(welded_of(triangle, a), welded_of(triangle, b));
    std::vector<Weights> points;
    for (int i = 1; i < whole_; ++i) {
      if (!welded_.contains({low, high, static_cast<std::uint64_t>(i)})) continue;
      Weights weights{};
      weights[b] = i;
      weights[a] = whole_ - i;
      points.push_back(weights);
    }
    return points;
  }

 private:
  const Surface& coarse_;
  Surface& fine_;
  SmoothSurface& smooth_;
  const int whole_;
  std::map<std::array<std::uint64_t, 3>, std::uint32_t> welded_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> render_;
};

SmoothSurface::SmoothSurface(const Surface& coarse, const SolvedClip& sheets, int levels,
                             const std::vector<bool>& chosen)
    : sheet_faces_(sheets.faces) {
  std::vector<Face> faces;  // as the surface has them, then as Loop needs them
  for (std::uint32_t f = 0; f < sheets.faces.size(); ++f) {
    if (!chosen.empty() && !chosen[f]) continue;
    chosen_.push_back(f);
    faces.push_back(sheets.faces[f]);
  }
  own_ = part_fans(faces);
  for (const std::uint32_t v : own_) welded_.push_back(sheets.welded[v]);
  turned_ = turned_to_one_side(faces);
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (turned_[f]) faces[f] = over(faces[f]);
  const int whole = whole_of(levels);
  std::vector<std::uint32_t> sheet_of(coarse.triangle_count(), none);  // of a triangle: its face
  for (std::uint32_t f = 0; f < faces.size(); ++f) sheet_of[sheets.triangle[chosen_[f]]] = f;
  std::vector<std::uint32_t> flat_of(coarse.triangle_count(), none);  // the face that is not smooth
  for (std::uint32_t f = 0; f < sheets.faces.size(); ++f)
    if (sheet_of[sheets.triangle[f]] == none) flat_of[sheets.triangle[f]] = f;
  std::vector<bool> shared(coarse.vertex_count(), false);
  const auto welded_corner = [&](std::size_t t, std::size_t c) {
    return coarse.render_vertices[coarse.triangles[3 * t + c]].welded;
  };
  for (std::size_t t = 0; t < coarse.triangle_count(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      if (sheet_of[t] == none) shared[welded_corner(t, c)] = true;

  std::vector<glm::dvec3> rest;
  std::vector<bool> stays;
  for (const std::uint32_t v : welded_) {
    rest.push_back(coarse.rest[v]);
    stays.push_back(shared[v]);
  }
  add_sharp_corners(faces, rest, stays);
  std::vector<std::uint32_t> sharp;
  for (std::uint32_t v = 0; v < stays.size(); ++v)
    if (stays[v]) sharp.push_back(v);
  loop_ = subdivide_loop(faces, static_cast<std::uint32_t>(welded_.size()), levels, sharp);

  const std::vector<std::array<Weights, 3>> at = places_on_roots(loop_, root_);
  const LoopLevel& last = loop_.levels.back();
  std::vector<std::vector<std::uint32_t>> of_root(faces.size());  // its small faces
  for (std::uint32_t f = 0; f < root_.size(); ++f) of_root[root_[f]].push_back(f);

  Builder builder(coarse, *this, whole);
  fine_welded_.assign(last.vertex_count, none);
  fine_faces_.resize(last.faces.size());
  fine_triangle_.resize(last.faces.size());
  std::vector<std::array<std::uint32_t, 3>> fine_corners(last.faces.size());  // render vertices
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const std::size_t triangle = sheets.triangle[chosen_[f]];
    for (const std::uint32_t small : of_root[f]) {
      Face own = last.faces[small];
      std::array<Weights, 3> weights = at[small];
      if (turned_[f]) {
        own = over(own);
        std::swap(weights[1], weights[2]);
        for (Weights& w : weights) std::swap(w[1], w[2]);
      }
      fine_faces_[small] = own;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t welded = builder.welded_at(triangle, weights[c], own[c]);
        fine_welded_[own[c]] = welded;
        fine_corners[small][c] = builder.render_at(triangle, weights[c], welded);
      }
    }
  }

  // The triangles, part by part in their order; those beside a sheet get the points of its edges.
  for (const Part& part : coarse.parts) {
    Part own = part;
    own.first_triangle = static_cast<std::uint32_t>(fine_.triangle_count());
    for (std::size_t t = part.first_triangle; t < std::size_t{part.first_triangle} + part.triangle_count;
         ++t) {
      if (sheet_of[t] != none) {
        for (const std::uint32_t small : of_root[sheet_of[t]]) {
          fine_triangle_[small] = static_cast<std::uint32_t>(fine_.triangle_count());
          fine_.triangles.insert(fine_.triangles.end(), fine_corners[small].begin(),
                                 fine_corners[small].end());
        }
        continue;
      }
      struct Point {
        std::uint32_t vertex;  // render vertex
        Weights weights;
      };
      std::vector<Point> outline;
      for (std::size_t s = 0; s < 3; ++s) {
        Weights corner{};
        corner[s] = whole;
        outline.push_back({builder.render_of(t, s), corner});
        for (const Weights& weights : builder.on_side(t, s))
          outline.push_back({builder.render_at(t, weights, builder.welded_at(t, weights, 0)), weights});
      }
      const auto add = [&](const Point& a, const Point& b, const Point& c) {
        Flat flat{static_cast<std::uint32_t>(fine_.triangle_count()), flat_of[t], {}};
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t i = 0; i < 3; ++i)
            flat.weights[k][i] = static_cast<double>((k == 0 ? a : k == 1 ? b : c).weights[i]) / whole;
        if (flat.face != none) flat_.push_back(flat);
        for (const std::uint32_t v : {a.vertex, b.vertex, c.vertex}) fine_.triangles.push_back(v);
      };
      if (outline.size() == 3) {
        add(outline[0], outline[1], outline[2]);
        continue;
      }
      const Weights middle{whole / 3, whole / 3, whole / 3};  // and a fan round it
      const std::uint32_t welded = builder.welded_at(t, middle, (std::uint64_t{1} << 32U) + t);
      const Point centre{builder.render_at(t, middle, welded), middle};
      for (std::size_t k = 0; k < outline.size(); ++k)
        add(centre, outline[k], outline[(k + 1) % outline.size()]);
    }
    own.triangle_count = static_cast<std::uint32_t>(fine_.triangle_count()) - own.first_triangle;
    fine_.parts.push_back(std::move(own));
  }
  fine_.rest = places(coarse.rest);
  fine_.bind = fine_.rest;
  fine_.bind_normal = spread(coarse.bind_normal);
  for (glm::dvec3& normal : fine_.bind_normal)
    normal = glm::length(normal) > 1e-6 ? glm::normalize(normal) : glm::dvec3(0, 1, 0);
  fine_.influences.resize(fine_.rest.size());
  for (PaletteInfluences& of_vertex : fine_.influences) of_vertex.weight[0] = 1;
  build_adjacency(fine_);
  // The sheets' normals are those of the smooth surface, but where other triangles share them.
  const RestFrames frames = rest_frames(fine_);
  for (const auto& corners : fine_corners)
    for (const std::uint32_t r : corners) {
      RenderVertex& vertex = fine_.render_vertices[r];
      if (vertex.welded >= shared.size() || !shared[vertex.welded])
        vertex.normal = glm::vec3(frames.normal[vertex.welded]);
    }
}

std::vector<glm::dvec3> SmoothSurface::limit_of(const std::vector<glm::dvec3>& base) const {
  std::vector<glm::dvec3> x = base;
  for (std::size_t l = 1; l < loop_.levels.size(); ++l) x = applied(loop_.levels[l].masks, x);
  return applied(loop_.limit, x);
}

std::vector<glm::dvec3> SmoothSurface::places(const std::vector<glm::dvec3>& coarse,
                                              const std::vector<glm::dvec3>& base) const {
  std::vector<glm::dvec3> own;
  for (std::size_t v = 0; v < own_.size(); ++v)
    own.push_back(base.empty() ? coarse[welded_[v]] : base[own_[v]]);
  const std::vector<glm::dvec3> limit = limit_of(own);
  // Sheets that only touch are drawn at the mean of their vertices.
  std::vector<glm::dvec3> result = spread(coarse), sum(result.size(), glm::dvec3(0));
  std::vector<int> count(result.size(), 0);
  for (std::size_t v = 0; v < limit.size(); ++v) {
    const std::uint32_t w = fine_welded_[v];
    if (w == none) continue;
    sum[w] += limit[v];
    ++count[w];
  }
  for (std::size_t w = 0; w < result.size(); ++w)
    if (count[w] > 0) result[w] = sum[w] / static_cast<double>(count[w]);
  return result;
}

// Their corners are vertices of their own: nothing is smooth across their sides.
void SmoothSurface::add_flat(const SolvedClip::Frame& frame, Refined& result) const {
  SolvedClip::Frame& fine = result.clip.frames.front();
  for (const Flat& flat : flat_) {
    const Face& face = sheet_faces_[flat.face];
    const auto& phase = frame.phase[flat.face];
    const glm::dvec3 t = frame.base[face[1]] - frame.base[face[0]],
                     u = frame.base[face[2]] - frame.base[face[0]];
    const glm::dvec3 slope =
        span(t, u) ? gradient(t, u, {phase[0], {phase[1] - phase[0], phase[2] - phase[0]}}) : glm::dvec3(0);
    Face& corners = result.clip.faces.emplace_back();
    auto& phases = fine.phase.emplace_back();
    result.clip.triangle.push_back(flat.triangle);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::array<double, 3>& w = flat.weights[c];
      corners[c] = static_cast<std::uint32_t>(fine.base.size());
      fine.base.push_back(w[0] * frame.base[face[0]] + w[1] * frame.base[face[1]] +
                          w[2] * frame.base[face[2]]);
      fine.amplitude.push_back(w[0] * frame.amplitude[face[0]] + w[1] * frame.amplitude[face[1]] +
                               w[2] * frame.amplitude[face[2]]);
      phases[c] = w[0] * phase[0] + w[1] * phase[1] + w[2] * phase[2];
      result.gradient.push_back(slope);
      const std::uint32_t r = fine_.triangles[3 * std::size_t{flat.triangle} + c];
      result.clip.welded.push_back(fine_.render_vertices[r].welded);
    }
  }
}

SmoothSurface::Refined SmoothSurface::refined(const SolvedClip::Frame& frame) const {
  Refined result;
  SolvedClip& clip = result.clip;
  clip.faces = fine_faces_;
  clip.triangle = fine_triangle_;
  clip.welded = fine_welded_;
  for (std::uint32_t& w : clip.welded)
    if (w == none) w = 0;  // of a vertex that no face has
  SolvedClip::Frame& fine = clip.frames.emplace_back();
  std::vector<glm::dvec3> x;
  for (const std::uint32_t v : own_) x.push_back(frame.base[v]);
  fine.base = limit_of(x);
  if (frame.amplitude.empty()) return result;

  std::vector<double> amplitude;
  for (const std::uint32_t v : own_) amplitude.push_back(frame.amplitude[v]);
  const LoopLevel& first = loop_.levels.front();
  std::vector<bool> waves;
  std::vector<std::array<double, 3>> phases;
  for (std::size_t f = 0; f < first.faces.size(); ++f) {
    const Face& t = first.faces[f];
    waves.push_back(amplitude[t[0]] > 0 || amplitude[t[1]] > 0 || amplitude[t[2]] > 0);
    auto phase = frame.phase[chosen_[f]];
    if (turned_[f]) std::swap(phase[1], phase[2]);
    phases.push_back(phase);
  }
  CornerField phase(first, std::move(phases), waves, 2 * std::numbers::pi, amplitude);
  for (std::size_t l = 1; l < loop_.levels.size(); ++l) {
    const LoopLevel &before = loop_.levels[l - 1], &now = loop_.levels[l];
    phase = phase.refined(before, now, x);
    x = applied(now.masks, x);
    amplitude = applied(now.masks, amplitude);
    shut(amplitude, now, phase);
  }
  amplitude = applied(loop_.limit, amplitude);
  shut(amplitude, loop_.levels.back(), phase);
  fine.amplitude = std::move(amplitude);
  const auto limits = phase.limits(loop_, x);
  const std::vector<glm::dvec3> first_tangent = applied(loop_.tangents[0], x),
                                second_tangent = applied(loop_.tangents[1], x);
  result.gradient.assign(fine.base.size(), glm::dvec3(0));
  std::vector<bool> done(fine.base.size(), false);
  for (std::size_t f = 0; f < limits.size(); ++f) {
    std::array<double, 3> own{limits[f][0].value, limits[f][1].value, limits[f][2].value};
    if (turned_[root_[f]]) std::swap(own[1], own[2]);
    fine.phase.push_back(own);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = loop_.levels.back().faces[f][c];
      if (done[v] || !phase.known()[f] || !(fine.amplitude[v] > 0)) continue;
      done[v] = true;
      if (span(first_tangent[v], second_tangent[v]))
        result.gradient[v] = gradient(first_tangent[v], second_tangent[v], limits[f][c]);
    }
  }
  add_flat(frame, result);
  return result;
}

}  // namespace plisse
