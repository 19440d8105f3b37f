// Facets of curved surfaces, noise, and what is no base surface at all.
#include "wrinkle/facets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "wrinkle/base_check.h"
#include "wrinkle/meshes.h"
#include "wrinkle/wrinkle_free.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Vector3d;
using test::Grid;
using ::testing::HasSubstr;

const shell::Material cloth{1e6, 0.3, 1e-4, 0};

// A panel on a cylinder of radius 1, which runs along y: of its full length, `pressed` along the arc.
// Vertices lie on the cylinder, so that edges are chords.
BaseSurface on_cylinder(const Grid& grid, double pressed = 0) {
  return test::moved(grid, [&](const Vector3d& x) {
    const double angle = x.x() * (1 - pressed);
    return Vector3d(std::sin(angle), x.y(), std::cos(angle));
  });
}

double largest_compression(const std::vector<FaceForms>& forms) {
  double most = 0;
  for (const FaceForms& face : forms) most = std::max(most, -principal_strain(face).compression);
  return most;
}

std::size_t wrinkling(const std::vector<FaceForms>& forms, const BaseSurface& surface) {
  const auto free = wrinkle_free_faces(forms, surface.topology, WrinkleFreeRule::paper);
  return static_cast<std::size_t>(std::count(free.begin(), free.end(), false));
}

// chord² = l²(1 − (κl)²/12) to fourth order in κl.
TEST(Facets, ChordsAreNoCompression) {
  for (const int columns : {6, 12, 24}) {
    const Grid grid(1.2, 0.6, columns, columns / 2);
    const BaseSurface surface = on_cylinder(grid);
    auto forms = face_forms(surface);
    const double side = 1.2 / columns, before = largest_compression(forms);
    EXPECT_NEAR(before / (side * side / 12), 1, 0.05) << columns;  // else this shows nothing
    correct_chords(forms);
    // What is left: of fourth order, and what the fit of the curvature is off by at the rim.
    EXPECT_LT(largest_compression(forms), 0.15 * before) << columns;
    find_noise(forms, surface, cloth, true);
    EXPECT_EQ(wrinkling(forms, surface), 0U) << columns;
  }
}

TEST(Facets, RealCompressionIsKept) {
  const Grid grid(1.2, 0.6, 24, 12);
  const BaseSurface surface = on_cylinder(grid, 0.05);
  auto forms = face_forms(surface);
  const double before = largest_compression(forms);
  correct_chords(forms);
  find_noise(forms, surface, cloth, true);
  EXPECT_EQ(wrinkling(forms, surface), forms.size());
  // Twice the Green strain of a length of 95 %.
  for (const FaceForms& face : forms)
    EXPECT_NEAR(principal_strain(face).compression, 0.95 * 0.95 - 1, 0.1 * before);
}

// A flat sheet somewhere far from the origin, its places in single precision.
TEST(Facets, RoundingSeedsNothing) {
  const Grid grid(1, 1, 20, 20);
  for (const bool single : {false, true}) {
    const BaseSurface surface = test::moved(grid, [&](const Vector3d& x) {
      const Vector3d moved = x + Vector3d(11.1, -7.3, 0.7);
      return single ? Vector3d(moved.cast<float>().cast<double>()) : moved;
    });
    auto forms = face_forms(surface);
    EXPECT_GT(largest_compression(forms), 0);  // else this shows nothing
    EXPECT_GT(wrinkling(forms, surface), 0U);
    find_noise(forms, surface, cloth, false);
    EXPECT_EQ(wrinkling(forms, surface), 0U) << single;
  }
}

// A rig's stretch of 96 % counts as the limit's 5 % of tension; the compression across stays, and so does
// what is within the limit, to the last bit.
TEST(Facets, TensionBeyondTheLimitIsNone) {
  const Grid grid(1, 1, 6, 6);
  const auto pulled = [&](double along, double across) {
    return face_forms(
        test::moved(grid, [&](const Vector3d& x) { return Vector3d(along * x.x(), across * x.y(), 0); }));
  };
  auto forms = pulled(1.4, 0.9);
  limit_tension(forms, cloth, 0.05);
  for (const FaceForms& face : forms) {
    const PrincipalStrain strain = principal_strain(face);
    EXPECT_NEAR(strain.tension, 0.05, 1e-14);
    EXPECT_NEAR(strain.compression, 0.9 * 0.9 - 1, 1e-14);
  }
  const auto within = pulled(1.02, 0.9);
  forms = within;
  limit_tension(forms, cloth, 0.05);
  for (std::size_t f = 0; f < forms.size(); ++f) EXPECT_EQ(forms[f].strain, within[f].strain);
}

TEST(BaseCheck, AnotherUnit) {
  const Grid grid(1, 1, 8, 8);
  EXPECT_TRUE(base_faults(on_cylinder(grid).topology, face_forms(on_cylinder(grid, 0.05))).empty());
  for (const double factor : {1000.0, 0.001}) {
    const BaseSurface surface = test::moved(grid, [&](const Vector3d& x) { return Vector3d(factor * x); });
    const auto faults = base_faults(surface.topology, face_forms(surface));
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].kind, "unit");
    EXPECT_THAT(faults[0].text, HasSubstr(factor > 1 ? "1e+03 times" : "0.001 times"));
  }
}

TEST(BaseCheck, CompressionAlongCrests) {
  const Grid grid(1, 1, 8, 8);
  const auto forms = test::prescribed(
      grid, [](const Vector3d& x) { return test::diagonal(-0.2, x.x() < 0.25 ? -0.05 : 0.05); },
      test::no_form);
  const auto topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  const auto faults = base_faults(topology, forms);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].kind, "crest compression");
  EXPECT_THAT(faults[0].text, HasSubstr("25.0 % of the area"));
}

// Crests that turn by a right angle from one face to the next.
TEST(BaseCheck, Kinks) {
  const Grid grid(1, 1, 8, 8);
  const auto forms = test::prescribed(
      grid,
      [](const Vector3d& x) { return x.x() < 0.5 ? test::diagonal(-0.1, 0.01) : test::diagonal(0.01, -0.1); },
      test::no_form);
  const auto topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  const auto faults = base_faults(topology, forms);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].kind, "kinks");
  EXPECT_THAT(faults[0].text,
              HasSubstr("12.5 % of the area"));  // one triangle of a cell on either side, 8 rows
}

}  // namespace
}  // namespace plisse::wrinkle
