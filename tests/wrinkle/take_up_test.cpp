// What waves take up, against its closed form: plane waves on a sheet that is pressed one way.
#include "wrinkle/take_up.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

TEST(TakeUp, PlaneWavesTakeHalfTheirSquaredSlope) {
  const test::Grid grid(1, 1, 10, 10);
  const shell::Material cloth{1e6, 0.3, 1e-3, 0};
  const double pressed = 0.9, squeeze = 1 - pressed * pressed, frequency = 2 * M_PI / 0.2;
  const BaseSurface surface =
      test::moved(grid, [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(pressed * x.x(), x.y(), 0); });
  const auto forms = face_forms(surface);
  CoarseField field;
  const auto count = static_cast<Eigen::Index>(surface.topology.vertex_count);
  for (const double share : {0.0, 0.5, 1.0, 3.0}) {
    field.amplitude = Eigen::VectorXd::Constant(count, std::sqrt(2 * share * squeeze) / frequency);
    field.phase.clear();
    for (std::size_t f = 0; f < forms.size(); ++f) {
      std::array<double, 3> phase{};
      for (std::size_t c = 0; c < 3; ++c)
        phase[c] = frequency / pressed * surface.positions(0, surface.topology.faces[f][c]);
      field.phase.push_back(phase);
    }
    const TakeUp taken = take_up(surface.topology, forms, cloth, field);
    EXPECT_NEAR(taken.compression, squeeze, 1e-12);
    EXPECT_NEAR(taken.untaken, std::max(1 - share, 0.0), 1e-12) << share;  // no more than there is
    EXPECT_NEAR(taken.wavelength, share > 0 ? 0.2 : 0, 1e-12);
    EXPECT_NEAR(taken.crest_angle, 0, 1e-7);  // an arc cosine near 1
    EXPECT_EQ(taken.where_compressed, 1);
  }
  // Waves that travel 20 degrees off the compression; and a third of the area where there is none.
  auto turned_forms = forms;
  const double turn = 20 * M_PI / 180;
  double calm = 0, all = 0;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto x = surface.positions.col(surface.topology.faces[f][c]);
      field.phase[f][c] = frequency * (std::cos(turn) * x.x() / pressed + std::sin(turn) * x.y());
    }
    all += forms[f].rest.area;
    if (f % 3 != 0) continue;
    turned_forms[f].strain = Eigen::Matrix2d::Identity() * 0.01;
    turned_forms[f].strain(1, 1) = 0.02;  // so that it has directions
    calm += forms[f].rest.area;
  }
  const TakeUp turned = take_up(surface.topology, turned_forms, cloth, field);
  EXPECT_NEAR(turned.crest_angle, turn, 1e-9);
  EXPECT_NEAR(turned.where_compressed, 1 - calm / all, 1e-12);
}

// What is compressed along the crests no wave takes up.
TEST(TakeUp, CompressionAlongCrestsIsLeft) {
  const test::Grid grid(1, 1, 4, 4);
  const BaseSurface surface = test::moved(
      grid, [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(0.8 * x.x(), 0.9 * x.y(), 0); });
  const auto forms = face_forms(surface);
  CoarseField none;
  none.amplitude = Eigen::VectorXd::Zero(surface.topology.vertex_count);
  none.phase.assign(forms.size(), {0, 0, 0});
  const TakeUp taken = take_up(surface.topology, forms, {1e6, 0.3, 1e-3, 0}, none);
  EXPECT_NEAR(taken.compression, (1 - 0.8 * 0.8) + (1 - 0.9 * 0.9), 1e-12);
  EXPECT_EQ(taken.untaken, 1);
}

}  // namespace
}  // namespace plisse::wrinkle
