// The search for the lowest field: starts, patches, faces that are released and won back, bounds.
#include <gtest/gtest.h>

#include <numbers>

#include "wrinkle/field.h"
#include "wrinkle/local_waves.h"
#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;
using test::diagonal;
using test::Grid;

// A fan of 270 degrees between two radii, compressed round its centre and pulled along the rays: crests are
// rays, and waves as dense at both ends as each would like do not close.
struct Fan {
  Grid grid{1.5 * pi, 1, 36, 10};  // angle, and place along the ray
  shell::Topology topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  std::vector<FaceForms> forms;
  std::vector<bool> free, ends;

  Fan(double inner, double outer, double compression) {
    for (Eigen::Index v = 0; v < grid.rest.cols(); ++v) {
      const double t = grid.rest(0, v), r = inner + (outer - inner) * grid.rest(1, v);
      ends.push_back(grid.rest(1, v) < 1e-9 || grid.rest(1, v) > 1 - 1e-9);
      grid.rest.col(v) = r * Vector3d(std::cos(t), std::sin(t), 0);
    }
    const double tension = 0.02;
    forms = test::prescribed(
        grid,
        [&](const Vector3d& x) {
          const Vector2d ray = Vector2d(x.x(), x.y()).normalized(), round(-ray.y(), ray.x());
          return Eigen::Matrix2d(tension * ray * ray.transpose() -
                                 (0.3 * tension + compression) * round * round.transpose());
        },
        test::no_form);
    free.assign(forms.size(), false);
  }
};

TEST(WrinkleStart, IsBelowTheFlatStateAndAsHighAsIsBest) {
  const Fan fan(0.2, 1, 0.01);
  const Problem problem(fan.topology, fan.forms, test::model(1e6, 0.3, 1e-4), fan.free, fan.ends);
  Waves start = initial_waves(problem);
  ASSERT_GT(start.amplitude.maxCoeff(), 0);
  const auto energy = [&](double scale) {
    Waves scaled = start;
    scaled.amplitude *= scale;
    return problem.energy(problem.pack(scaled));
  };
  // Waves close, so that near the centre they are denser than they like: with the amplitudes of waves that do
  // not they cost many times what they should gain.
  EXPECT_LT(energy(1), energy(0));
  EXPECT_LT(energy(1), energy(0.98));
  EXPECT_LT(energy(1), energy(1.02));
}

// A stiff sheet's patch beside a weak one: the weak one's compression is a hundredth.
TEST(WrinkleStart, EveryPatchForItself) {
  const Grid grid(0.2, 0.5, 8, 40);
  std::vector<bool> free, ends;
  for (const shell::Face& f : grid.faces) free.push_back(std::abs(grid.centre(f).y() - 0.25) < 0.025);
  for (Eigen::Index v = 0; v < grid.rest.cols(); ++v)
    ends.push_back(grid.rest(1, v) < 1e-9 || grid.rest(1, v) > 0.5 - 1e-9);
  const auto forms = test::prescribed(
      grid, [](const Vector3d& x) { return diagonal(-0.3 * 0.05 - (x.y() < 0.25 ? 0.02 : 1.5e-3), 0.05); },
      test::no_form);
  const shell::Topology topology = shell::build_topology(grid.faces, ends.size());
  for (const double frequency : {1.0, 0.35, 3.0}) {
    FieldOptions options;
    options.frequency = frequency;
    const Field field = solve_field(topology, forms, test::model(1e6, 0.3, 1e-4), free, ends, options);
    EXPECT_TRUE(field.real.converged) << field.real.reason;
    const VectorXd& a = field.real.waves.amplitude;
    double strong = 0, weak = 0;
    for (Eigen::Index v = 0; v < a.size(); ++v)
      (grid.rest(1, v) < 0.25 ? strong : weak) = std::max(grid.rest(1, v) < 0.25 ? strong : weak, a[v]);
    EXPECT_GT(strong, 0.2e-3) << frequency;
    EXPECT_GT(weak, 0.05e-3) << frequency;
  }
}

TEST(WrinkleSearch, ReportsEveryStartAndTakesTheLowest) {
  const Fan fan(0.2, 1, 0.01);
  FieldOptions options;
  options.all_starts = true;
  const Field field =
      solve_field(fan.topology, fan.forms, test::model(1e6, 0.3, 1e-4), fan.free, fan.ends, options);
  ASSERT_EQ(field.starts.size(), 5U);
  for (const FieldStart& start : field.starts) {
    EXPECT_LE(field.real.energy, start.energy * (1 + 1e-12)) << start.frequency;
    EXPECT_LE(start.energy, start.start_energy) << start.frequency;
  }
  ASSERT_FALSE(field.trace.empty());
  for (std::size_t i = 1; i < field.trace.size(); ++i) {
    EXPECT_LT(field.trace[i].energy, field.trace[i - 1].energy);
    EXPECT_GT(field.trace[i].iteration, field.trace[i - 1].iteration);
    EXPECT_GE(field.trace[i].seconds, field.trace[i - 1].seconds);
  }
  EXPECT_NEAR(field.trace.back().energy / field.real.energy, 1, 1e-12);
}

// A ball squeezed along its circles of latitude: waves have to close round each, and those that suit the
// equator are too dense by far near the poles. Released once and for all, whole belts stay flat.
TEST(WrinkleSearch, ABallHasNoFlatBelts) {
  constexpr int around = 32, along = 16;
  std::vector<shell::Face> faces;
  shell::Positions place(3, around * (along - 1) + 2);
  const auto vertex = [&](int i, int j) {
    if (j == 0) return static_cast<std::uint32_t>(around * (along - 1));
    if (j == along) return static_cast<std::uint32_t>(around * (along - 1) + 1);
    return static_cast<std::uint32_t>((j - 1) * around + i % around);
  };
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double polar = pi * j / along, angle = 2 * pi * i / around;
      place.col(vertex(i, j)) =
          Vector3d(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar));
      if (j == along) continue;
      if (j > 0) faces.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j)});
      if (j < along - 1) faces.push_back({vertex(i + 1, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
    }
  }
  const auto rest = shell::rest_faces(place, faces);
  const double nu = 0.3, tension = 0.005, compression = 0.02;
  std::vector<FaceForms> forms;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    // The circle of latitude in the rest face's frame, whose first axis is its first edge.
    const Vector3d e = (place.col(faces[f][1]) - place.col(faces[f][0])).normalized(),
                   n = e.cross(Vector3d(place.col(faces[f][2]) - place.col(faces[f][0]))).normalized(),
                   centre = (place.col(faces[f][0]) + place.col(faces[f][1]) + place.col(faces[f][2])) / 3;
    const Vector3d round = Vector3d(-centre.y(), centre.x(), 0).normalized();
    const Vector2d w = Vector2d(round.dot(e), round.dot(n.cross(e))).normalized(), c(-w.y(), w.x());
    forms.push_back({rest[f], tension * c * c.transpose() - (nu * tension + compression) * w * w.transpose(),
                     Eigen::Matrix2d::Identity()});
  }
  const shell::Topology topology = shell::build_topology(faces, static_cast<std::size_t>(place.cols()));
  const Model model = test::model(1e6, nu, 2e-3);
  const std::vector<bool> none(faces.size(), false);
  const Problem problem(topology, forms, model, none);
  const Field field = solve_field(topology, forms, model, none);
  EXPECT_TRUE(field.real.converged && field.whole.converged) << field.real.reason;
  // No face can do better than in waves of its own, which is what all would cost if nothing had to close.
  double own = 0;
  const auto local = local_waves(forms, topology, problem.complex().live, problem.pinned(), model);
  for (std::size_t f = 0; f < forms.size(); ++f) {
    LocalVector x;
    x.head<3>().setConstant(best_amplitude(forms[f], model, local[f], local[f].gradient));
    x.tail<2>() = local[f].gradient;
    own += FaceEnergy(forms[f], model).value(x);
  }
  const double excess = field.real.energy - problem.relaxed_energy();
  EXPECT_GT(excess, own * 0.999);
  EXPECT_LT(excess, 1.5 * own);
  // Waves between 30 degrees of the poles everywhere.
  for (int j = along / 6 + 1; j < along - along / 6; ++j)
    for (int i = 0; i < around; ++i) EXPECT_GT(field.real.waves.amplitude[vertex(i, j)], 0) << i << " " << j;
}

// Flat, free all round, compressed both ways: the longer the waves the better, and nothing says how long. One
// wave over the sheet is the most that is taken.
TEST(WrinkleSearch, BothWaysCompressedIsBounded) {
  const Grid grid(0.3, 0.2, 12, 8);
  const shell::Topology topology =
      shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  for (const double other : {-0.02, -0.05}) {
    const auto forms = test::prescribed(
        grid, [&](const Vector3d&) { return diagonal(-0.05, other); }, test::no_form);
    const Field field =
        solve_field(topology, forms, test::model(1e6, 0.3, 1e-4), std::vector<bool>(forms.size(), false));
    EXPECT_TRUE(field.real.converged) << field.real.reason;
    const VectorXd& a = field.real.waves.amplitude;
    // √(2s₀)/|ω| of one wave over the diagonal; edges follow it in two directions, at most 40 % longer.
    const double most = std::sqrt(2 * 0.05) * std::hypot(0.3, 0.2) / (2 * pi);
    EXPECT_GT(a.minCoeff(), 0);
    EXPECT_LE(a.maxCoeff(), 1.4 * most);
    // And smooth; where both are the same, nothing says which way waves should run.
    if (other > -0.05) {
      EXPECT_LT(a.maxCoeff() / a.minCoeff(), 1.1);
    }
  }
}

}  // namespace
}  // namespace plisse::wrinkle
