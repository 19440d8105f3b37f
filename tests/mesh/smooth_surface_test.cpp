// Smooth surfaces against planes, on which everything is linear, and against what does not depend on the
// mesh: no gaps, whole turns, one side.
#include "mesh/smooth_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "base/error.h"

namespace plisse {
namespace {

using std::numbers::pi;

// cells × cells of a unit square in z = 0, inner vertices moved at random; every third face turned over with
// `mixed`. uv are x and y.
Surface square(int cells, bool mixed = false) {
  Surface surface;
  std::mt19937 random(5);
  const auto shift = [&](int i) {
    return i == 0 || i == cells ? 0.0 : 0.3 * (static_cast<double>(random()) / 4294967295.0 - 0.5) / cells;
  };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double x = static_cast<double>(i) / cells + (j % cells ? shift(i) : 0),
                   y = static_cast<double>(j) / cells + (i % cells ? shift(j) : 0);
      surface.rest.emplace_back(x, y, 0);
      surface.render_vertices.push_back({static_cast<std::uint32_t>(surface.rest.size() - 1), {x, y}});
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto v = static_cast<std::uint32_t>(j * (cells + 1) + i),
                 up = v + static_cast<std::uint32_t>(cells) + 1;
      for (std::array<std::uint32_t, 3> t : {std::array{v, v + 1, up + 1}, std::array{v, up + 1, up}}) {
        if (mixed && surface.triangle_count() % 3 == 0) std::swap(t[1], t[2]);
        surface.triangles.insert(surface.triangles.end(), t.begin(), t.end());
      }
    }
  surface.bind = surface.rest;
  surface.bind_normal.assign(surface.rest.size(), glm::dvec3(0, 0, 1));
  surface.influences.resize(surface.rest.size());
  Part part;
  part.triangle_count = static_cast<std::uint32_t>(surface.triangle_count());
  part.has_uv = true;
  surface.parts.push_back(part);
  build_adjacency(surface);
  return surface;
}

// Those triangles of it that `chosen` takes, vertices as the surface has them.
template <typename Chosen>
SolvedClip sheets_of(const Surface& surface, const Chosen& chosen) {
  SolvedClip sheets;
  for (std::uint32_t v = 0; v < surface.vertex_count(); ++v) sheets.welded.push_back(v);
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    if (!chosen(t)) continue;
    sheets.triangle.push_back(t);
    sheets.faces.push_back(
        {surface.triangles[3 * t], surface.triangles[3 * t + 1], surface.triangles[3 * t + 2]});
  }
  return sheets;
}

double area_of(const Surface& surface, std::size_t t) {
  const auto at = [&](std::size_t c) {
    return surface.rest[surface.render_vertices[surface.triangles[3 * t + c]].welded];
  };
  return 0.5 * glm::cross(at(1) - at(0), at(2) - at(0)).z;
}

// A wave whose phase is linear in the plane keeps its phase, gradient and amplitude wherever it is looked at,
// with a whole number of turns added to each face, and whichever side the faces show.
TEST(SmoothSurface, WavesThatAreLinearStaySo) {
  for (const bool mixed : {false, true}) {
    const Surface surface = square(5, mixed);
    const SolvedClip sheets = sheets_of(surface, [](std::uint32_t) { return true; });
    const SmoothSurface smooth(surface, sheets, 2);
    const auto phase = [](const glm::dvec3& x) { return 9 * x.x + 5 * x.y + 0.3; };
    SolvedClip::Frame frame;
    frame.base = surface.rest;
    for (const glm::dvec3& x : surface.rest) frame.amplitude.push_back(0.01 + 0.002 * x.x);
    std::mt19937 random(3);
    for (const auto& face : sheets.faces) {
      const double turns = 2 * pi * static_cast<double>(random() % 7);
      auto& own = frame.phase.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) own[c] = phase(surface.rest[face[c]]) + turns;
    }
    const SmoothSurface::Refined fine = smooth.refined(frame);
    const SolvedClip::Frame& now = fine.clip.frames.front();
    ASSERT_EQ(fine.clip.faces.size(), 16 * sheets.faces.size());
    for (std::size_t f = 0; f < fine.clip.faces.size(); ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = fine.clip.faces[f][c];
        const glm::dvec3 x = now.base[v];
        EXPECT_NEAR(std::remainder(now.phase[f][c] - phase(x), 2 * pi), 0, 1e-9);
        EXPECT_NEAR(glm::distance(fine.gradient[v], glm::dvec3(9, 5, 0)), 0, 1e-8);
        EXPECT_NEAR(now.amplitude[v], 0.01 + 0.002 * x.x, 1e-12);  // masks reproduce what is linear
        // The surface's triangle has the same corners, and uv as linear as the places within a face.
        const std::uint32_t r = smooth.surface().triangles[3 * fine.clip.triangle[f] + c];
        EXPECT_EQ(smooth.surface().render_vertices[r].welded, fine.clip.welded[v]);
        EXPECT_LT(glm::distance(smooth.surface().rest[fine.clip.welded[v]], x), 1e-12);
      }
    }
    double sum = 0, most = 0;
    for (std::size_t t = 0; t < smooth.surface().triangle_count(); ++t) {
      sum += std::abs(area_of(smooth.surface(), t));
      most += area_of(smooth.surface(), t);
    }
    EXPECT_NEAR(sum, 1, 1e-9);  // nothing folds over
    double signed_before = 0;
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) signed_before += area_of(surface, t);
    EXPECT_NEAR(most, signed_before, mixed ? 0.1 : 1e-9);  // limits shift area between sides a little
  }
}

// Beside triangles that are none of the sheets' there is no gap: each inner edge has two triangles, and the
// plane is covered once.
TEST(SmoothSurface, NoGapsBesideOtherTriangles) {
  const Surface surface = square(6);
  const SolvedClip sheets =
      sheets_of(surface, [](std::uint32_t t) { return t % 12 < 6 && t > 11 && t < 48; });
  const SmoothSurface smooth(surface, sheets, 2);
  const Surface& fine = smooth.surface();
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double sum = 0;
  for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
    sum += area_of(fine, t);
    EXPECT_GT(area_of(fine, t), 0);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto id = [&](std::size_t k) {
        return fine.render_vertices[fine.triangles[3 * t + k % 3]].welded;
      };
      ++edges[std::minmax(id(c), id(c + 1))];
    }
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  for (const auto& [edge, count] : edges) {
    const glm::dvec3 middle = 0.5 * (fine.rest[edge.first] + fine.rest[edge.second]);
    const bool outline = std::min({middle.x, middle.y, 1 - middle.x, 1 - middle.y}) < 1e-12;
    EXPECT_EQ(count, outline ? 1 : 2);
  }
  // In any pose: what is shared stays on the straight edges of the coarse mesh, whatever the sheet does.
  std::vector<glm::dvec3> bent = surface.rest;
  for (glm::dvec3& x : bent) x.z = 0.2 * std::sin(5 * x.x) * std::cos(4 * x.y);
  const std::vector<glm::dvec3> places = smooth.places(bent);
  std::vector<bool> other(fine.vertex_count(), false);
  for (std::size_t t = 0; t < surface.triangle_count(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      if (std::find(sheets.triangle.begin(), sheets.triangle.end(), t) == sheets.triangle.end())
        other[surface.triangles[3 * t + c]] = true;
  double moved = 0;
  for (std::uint32_t v = 0; v < surface.vertex_count(); ++v) {
    if (other[v]) {
      EXPECT_LT(glm::distance(places[v], bent[v]), 1e-12);
    }
    moved = std::max(moved, glm::distance(places[v], bent[v]));
  }
  EXPECT_GT(moved, 1e-3);  // vertices of the sheet alone are on its limit surface
}

// A tube of n edges: Loop's limit surface lies within 6.6/n² of the radius inside it (docs/wrinkle.md), and
// is round: the normals of the fine triangles turn evenly.
TEST(SmoothSurface, ATubeIsRound) {
  constexpr int round = 12, rows = 8;
  Surface surface;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < round; ++i) {
      const double angle = 2 * pi * i / round;
      surface.rest.emplace_back(std::cos(angle), 0.5 * j, std::sin(angle));
      surface.render_vertices.push_back({static_cast<std::uint32_t>(surface.rest.size() - 1)});
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < round; ++i) {
      const std::uint32_t a = j * round + i, b = j * round + (i + 1) % round, c = a + round, d = b + round;
      for (const std::uint32_t v : {a, d, b, a, c, d}) surface.triangles.push_back(v);
    }
  surface.bind = surface.rest;
  surface.bind_normal.assign(surface.rest.size(), glm::dvec3(0, 1, 0));
  Part part;
  part.triangle_count = static_cast<std::uint32_t>(surface.triangle_count());
  surface.parts.push_back(part);
  build_adjacency(surface);
  const SmoothSurface smooth(surface, sheets_of(surface, [](std::uint32_t) { return true; }), 2);
  double least = 2, most = 0;
  for (std::size_t v = 0; v < smooth.surface().vertex_count(); ++v) {
    const glm::dvec3 x = smooth.surface().rest[v];
    if (std::abs(x.y - 2) > 0.6) continue;
    const double radius = std::hypot(x.x, x.z);
    least = std::min(least, radius);
    most = std::max(most, radius);
  }
  EXPECT_NEAR(most, 1 - 6.6 / (round * round), 0.004);
  EXPECT_LT(most - least, 0.002);  // facets of the coarse tube: 1 − cos(π/12) = .034
}

// Of two squares one is bent in the second frame; the other is turned, moved and scaled, and stays as it is
// modelled.
TEST(SmoothSurface, WhatOnlyMovesAsAWholeStaysAsItIs) {
  Surface surface = square(3);
  const auto count = static_cast<std::uint32_t>(surface.vertex_count());
  for (std::uint32_t v = 0; v < count; ++v) {
    surface.rest.push_back(surface.rest[v] + glm::dvec3(2, 0, 0));
    surface.render_vertices.push_back({count + v});
  }
  const std::vector<std::uint32_t> first = surface.triangles;
  for (const std::uint32_t v : first) surface.triangles.push_back(count + v);
  surface.bind = surface.rest;
  surface.bind_normal.assign(surface.rest.size(), glm::dvec3(0, 0, 1));
  surface.parts[0].triangle_count *= 2;
  build_adjacency(surface);
  SolvedClip sheets = sheets_of(surface, [](std::uint32_t) { return true; });
  sheets.frames.resize(2);
  sheets.frames[0].base = surface.rest;
  for (std::uint32_t v = 0; v < 2 * count; ++v) {
    const glm::dvec3 x = surface.rest[v];
    const glm::dvec3 bent(x.x, x.y, 0.1 * x.x * x.x), whole(3 - 1.5 * x.y, 1.5 * x.x, 4);
    // As files have it.
    sheets.frames[1].base.emplace_back(glm::vec3(v < count ? bent : whole));
  }
  const std::vector<bool> chosen = deforming(sheets, surface.rest);
  for (std::size_t f = 0; f < chosen.size(); ++f) EXPECT_EQ(chosen[f], f < first.size() / 3) << f;
  const SmoothSurface smooth(surface, sheets, 2, chosen);
  EXPECT_EQ(smooth.surface().triangle_count(), 17 * first.size() / 3);
  const auto places = smooth.places(sheets.frames[1].base, sheets.frames[1].base);
  for (std::uint32_t v = count; v < 2 * count; ++v) EXPECT_EQ(places[v], sheets.frames[1].base[v]);
  // Its waves are those of the square that is left.
  SolvedClip::Frame frame = sheets.frames[1];
  frame.amplitude.assign(2 * count, 0);
  for (std::uint32_t v = 0; v < count; ++v) frame.amplitude[v] = 0.01;
  frame.phase.assign(sheets.faces.size(), {0.5, 0.5, 0.5});
  const SmoothSurface::Refined fine = smooth.refined(frame);
  EXPECT_EQ(fine.clip.faces.size(), smooth.surface().triangle_count());
  for (std::size_t f = 0; f < fine.clip.faces.size(); ++f)
    if (f < 16 * first.size() / 3) {
      EXPECT_NEAR(fine.clip.frames.front().phase[f][0], 0.5, 1e-12);
    } else {
      EXPECT_EQ(fine.clip.frames.front().amplitude[fine.clip.faces[f][0]], 0);
    }
}

// A roof: two slopes that meet at a right angle. Beside the ridge its faces stay as they are modelled, with
// waves that are linear on them and go on without a step into the smooth faces; faces that hang together only
// at a vertex are no obstacle.
TEST(SmoothSurface, HardEdgesStayAndKeepTheirWaves) {
  Surface surface = square(6);
  for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
    const double x = surface.rest[v].x - 0.5;  // columns are at sixths, moved by less than a tenth of that
    surface.rest[v].z = -std::abs(std::abs(x) < 0.05 ? 0.0 : x);
    if (std::abs(x) < 0.05) surface.rest[v].x = 0.5;
  }
  surface.bind = surface.rest;
  const RestFrames frames = rest_frames(surface);
  for (std::size_t v = 0; v < surface.vertex_count(); ++v)
    surface.render_vertices[v].normal = glm::vec3(frames.normal[v]);
  const SolvedClip sheets = sheets_of(surface, [](std::uint32_t) { return true; });
  std::vector<bool> chosen = smooth_at_rest(sheets, surface);
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    bool ridge = false;
    for (const std::uint32_t v : sheets.faces[f]) ridge = ridge || surface.rest[v].x == 0.5;
    EXPECT_EQ(chosen[f], !ridge);
  }
  chosen[0] = chosen[1] = chosen[14] = chosen[15] = true;   // in two cells that share a corner,
  chosen[2] = chosen[3] = chosen[12] = chosen[13] = false;  // but no side
  const SmoothSurface smooth(surface, sheets, 2, chosen);
  const auto phase = [](const glm::dvec3& x) { return 7 * x.x + 5 * x.y - 4 * x.z; };
  SolvedClip::Frame frame;
  frame.base = surface.rest;
  for (const glm::dvec3& x : surface.rest) frame.amplitude.push_back(0.01 + 0.002 * x.y);
  for (const auto& face : sheets.faces) {
    auto& own = frame.phase.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) own[c] = phase(surface.rest[face[c]]);
  }
  const SmoothSurface::Refined fine = smooth.refined(frame);
  const SolvedClip::Frame& now = fine.clip.frames.front();
  std::vector<bool> seen(smooth.surface().triangle_count(), false);
  for (std::size_t f = 0; f < fine.clip.faces.size(); ++f) {
    EXPECT_FALSE(seen[fine.clip.triangle[f]]);
    seen[fine.clip.triangle[f]] = true;
    for (std::size_t c = 0; c < 3; ++c) {
      // On the roof's planes everything is linear, on either side of a face's edges.
      const std::uint32_t v = fine.clip.faces[f][c];
      const glm::dvec3 x = smooth.surface().rest[fine.clip.welded[v]];
      EXPECT_LT(glm::distance(now.base[v], x), 1e-12);
      EXPECT_NEAR(now.phase[f][c], phase(x), 1e-9);
      EXPECT_NEAR(now.amplitude[v], 0.01 + 0.002 * x.y, 1e-12);
    }
  }
  for (const bool s : seen) EXPECT_TRUE(s);  // none without its waves
}

TEST(SmoothSurface, SaysWhatIsNoSheet) {
  Surface surface = square(2);
  // A third triangle at the diagonal.
  surface.rest.emplace_back(0.5, 0.5, 1);
  surface.render_vertices.push_back({static_cast<std::uint32_t>(surface.rest.size() - 1)});
  for (const std::uint32_t v : {surface.triangles[0], surface.triangles[2], 9U})
    surface.triangles.push_back(v);
  surface.bind = surface.rest;
  surface.bind_normal.assign(surface.rest.size(), glm::dvec3(0, 0, 1));
  surface.parts[0].triangle_count = 9;
  build_adjacency(surface);
  const auto sheets = sheets_of(surface, [](std::uint32_t) { return true; });
  EXPECT_THROW(SmoothSurface(surface, sheets, 2), Error);
}

}  // namespace
}  // namespace plisse
