#include "cloth/cloth_of_surface.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "base/eigen_glm.h"
#include "base/error.h"

namespace plisse::cloth {
namespace {

using shell::Face;

bool has_area(const std::vector<glm::dvec3>& rest, const Face& face) {
  const glm::dvec3 a = rest[face[1]] - rest[face[0]], b = rest[face[2]] - rest[face[0]], c = b - a;
  const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  constexpr double flattest = 1e-6;  // height over the longest side, of the digits of single precision
  return glm::length(glm::cross(a, b)) > flattest * longest;
}

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

// A side of a face, from its smaller vertex to its larger or back.
struct Side {
  std::uint32_t low, high, face;
  bool forward;
  bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
};

// Two faces that go on into each other across an edge.
struct Joint {
  std::uint32_t first, second;
  std::array<std::uint32_t, 2> vertex;
  bool against;  // both run along the edge in the same direction, so one of them is turned over
};

class Sheets {
 public:
  Sheets(const std::vector<glm::dvec3>& rest, std::vector<Face>& faces) : rest_(rest), faces_(faces) {
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      const Face& t = faces[f];
      normals_.push_back(glm::normalize(glm::cross(rest[t[1]] - rest[t[0]], rest[t[2]] - rest[t[0]])));
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t from = t[c], to = t[(c + 1) % 3];
        sides_.push_back({std::min(from, to), std::max(from, to), f, from < to});
      }
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
      while (end < sides_.size() && sides_[end].same_edge(sides_[begin])) ++end;
      join(begin, end);
    }
  }

  std::size_t cut() const { return cut_; }

  // Turns faces so that neighbours agree; where none can (a Möbius band), the sheet is cut.
  std::vector<bool> orient() {
    std::vector<std::vector<std::uint32_t>> at(faces_.size());
    for (std::uint32_t j = 0; j < joints_.size(); ++j) {
      at[joints_[j].first].push_back(j);
      at[joints_[j].second].push_back(j);
    }
    std::vector<bool> turned(faces_.size(), false), known(faces_.size(), false);
    for (std::uint32_t seed = 0; seed < faces_.size(); ++seed) {
      if (known[seed]) continue;
      known[seed] = true;
      std::vector<std::uint32_t> open{seed};
      for (std::size_t next = 0; next < open.size(); ++next) {
        const std::uint32_t f = open[next];
        for (const std::uint32_t j : at[f]) {
          const std::uint32_t g = joints_[j].first == f ? joints_[j].second : joints_[j].first;
          if (known[g]) continue;
          known[g] = true;
          turned[g] = turned[f] != joints_[j].against;
          open.push_back(g);
        }
      }
    }
    const auto torn = [&](const Joint& joint) {
      return (turned[joint.first] != turned[joint.second]) != joint.against;
    };
    cut_ += static_cast<std::size_t>(std::count_if(joints_.begin(), joints_.end(), torn));
    std::erase_if(joints_, torn);
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (turned[f]) std::swap(faces_[f][1], faces_[f][2]);
    return turned;
  }

  // A number for each corner: corners at a vertex are one where their faces are joined across its edges.
  std::vector<std::uint32_t> fans() const {
    std::vector<std::uint32_t> parent(3 * faces_.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t c) {
      while (parent[c] != c) c = parent[c] = parent[parent[c]];
      return c;
    };
    for (const Joint& joint : joints_)
      for (const std::uint32_t v : joint.vertex) {
        const std::uint32_t a = root(corner(joint.first, v)), b = root(corner(joint.second, v));
        parent[std::max(a, b)] = std::min(a, b);
      }
    std::vector<std::uint32_t> result;
    for (std::uint32_t c = 0; c < parent.size(); ++c) result.push_back(root(c));
    return result;
  }

 private:
  std::uint32_t corner(std::uint32_t f, std::uint32_t v) const {
    const Face& t = faces_[f];
    return 3 * f + static_cast<std::uint32_t>(std::find(t.begin(), t.end(), v) - t.begin());
  }

  // The faces of one edge, two by two: first those that run along it in opposite directions, the nearest
  // normals first.
  void join(std::size_t begin, std::size_t end) {
    constexpr std::size_t most = 64;  // a fan of more is no cloth, and pairs are many
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = begin; i < end && end - begin <= most; ++i)
      for (std::size_t j = i + 1; j < end; ++j) {
        const std::uint32_t f = sides_[i].face, g = sides_[j].face;
        if (f == g || sorted(faces_[f]) == sorted(faces_[g])) continue;
        const bool against = sides_[i].forward == sides_[j].forward;
        const double agreement = glm::dot(normals_[f], normals_[g]);
        pairs.emplace_back(against ? 4 + agreement : -agreement, i, j);
      }
    std::sort(pairs.begin(), pairs.end());
    std::set<std::size_t> taken;
    for (const auto& [order, i, j] : pairs) {
      if (taken.contains(i) || taken.contains(j)) continue;
      taken.insert({i, j});
      joints_.push_back({sides_[i].face,
                         sides_[j].face,
                         {sides_[i].low, sides_[i].high},
                         sides_[i].forward == sides_[j].forward});
    }
    if (end - begin > 2 && taken.size() < end - begin) ++cut_;
  }

  const std::vector<glm::dvec3>& rest_;
  std::vector<Face>& faces_;
  std::vector<glm::dvec3> normals_;
  std::vector<Side> sides_;
  std::vector<Joint> joints_;
  std::size_t cut_ = 0;
};

}  // namespace

shell::Positions Cloth::places(const std::vector<glm::dvec3>& of_surface) const {
  shell::Positions result(3, static_cast<Eigen::Index>(welded.size()));
  for (std::size_t v = 0; v < welded.size(); ++v)
    result.col(static_cast<Eigen::Index>(v)) = to_eigen(of_surface[welded[v]]);
  return result;
}

Cloth cloth_of(const Surface& surface) {
  Cloth cloth;
  std::vector<bool> others(surface.vertex_count(), false);
  for (const Part& part : surface.parts) {
    for (std::uint32_t c = 3 * part.first_triangle; c < 3 * (part.first_triangle + part.triangle_count); ++c)
      if (!part.wrinkles) others[surface.render_vertices[surface.triangles[c]].welded] = true;
    if (!part.wrinkles) continue;
    for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      Face face;
      for (std::size_t c = 0; c < 3; ++c)
        face[c] = surface.render_vertices[surface.triangles[3 * t + c]].welded;
      if (!has_area(surface.rest, face)) {
        ++cloth.without_area;
        continue;
      }
      cloth.faces.push_back(face);
      cloth.triangle.push_back(t);
    }
  }
  if (cloth.faces.empty())
    throw Error(ExitCode::bad_input, "no triangle is selected that has an area: nothing can wrinkle");
  Sheets sheets(surface.rest, cloth.faces);
  cloth.turned = sheets.orient();
  const std::vector<std::uint32_t> fan = sheets.fans();
  cloth.cut = sheets.cut();
  std::vector<std::uint32_t> number(fan.size(), shell::none);  // of each fan, by its first corner
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (std::size_t f = 0; f < cloth.faces.size(); ++f) {
    Face& face = cloth.faces[f];
    Face own;
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint32_t& known = number[fan[3 * f + c]];
      if (known == shell::none) {
        known = static_cast<std::uint32_t>(cloth.welded.size());
        cloth.welded.push_back(face[c]);
      }
      own[c] = known;
    }
    // Fans that meet at both ends of a cut edge make it one of several faces again: such a face is parted.
    const auto side = [&](std::size_t c) { return std::pair(own[c], own[(c + 1) % 3]); };
    if (sides.contains(side(0)) || sides.contains(side(1)) || sides.contains(side(2))) {
      for (std::size_t c = 0; c < 3; ++c) {
        own[c] = static_cast<std::uint32_t>(cloth.welded.size());
        cloth.welded.push_back(face[c]);
      }
      ++cloth.cut;
    }
    for (std::size_t c = 0; c < 3; ++c) sides.insert(side(c));
    face = own;
  }
  for (const std::uint32_t v : cloth.welded) cloth.shared.push_back(others[v]);
  return cloth;
}

}  // namespace plisse::cloth
