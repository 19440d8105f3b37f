// What the model is without its parts: integrability that is not relaxed, a local law in place of the solve.
#include <gtest/gtest.h>

#include <numbers>

#include "base/error.h"
#include "wrinkle/field.h"
#include "wrinkle/local_law.h"
#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;
using test::Grid;

// A flat disk, squeezed round its middle outside half its radius and stretched inside, where no wave can be:
// crests are rays, as those of cloth that hangs over a ball (fig. 5).
struct Disk {
  Grid grid{2, 2, 24, 24};
  shell::Topology topology;
  std::vector<FaceForms> forms;
  std::vector<bool> free;

  Disk() {
    for (Eigen::Index v = 0; v < grid.rest.cols(); ++v) {  // the square becomes a disk of radius 1
      const Vector2d p(grid.rest(0, v) - 1, grid.rest(1, v) - 1);
      const double square = p.cwiseAbs().maxCoeff(), round = p.norm();
      grid.rest.col(v) << (round > 0 ? square / round : 1) * p, 0;
    }
    topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
    forms = test::prescribed(
        grid,
        [](const Vector3d& x) {
          const Vector2d ray = x.head<2>().normalized(), round(-ray.y(), ray.x());
          const double across = x.norm() > 0.5 ? -0.02 : 0.02;
          return Eigen::Matrix2d(0.02 * ray * ray.transpose() + across * round * round.transpose());
        },
        test::no_form);
    for (const shell::Face& f : grid.faces) free.push_back(grid.centre(f).norm() <= 0.5);
  }
  Field solve(bool relaxed) const {
    Model model = test::model(1e6, 0.3, 4e-3);
    model.relaxed_integrability = relaxed;
    return solve_field(topology, forms, model, free);
  }
  // Waves met on the rim, and the largest turn back on the way, in waves.
  double round(const Field& field) const {
    double sum = 0;
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
      const auto& edge = topology.edges[e];
      if (edge.face[1] != shell::none) continue;
      const Vector3d from = grid.rest.col(edge.vertex[0]), to = grid.rest.col(edge.vertex[1]);
      sum += (from.cross(to).z() > 0 ? 1 : -1) * field.one_form[static_cast<Eigen::Index>(e)];
    }
    return std::abs(sum) / (2 * pi);
  }
};

TEST(WithoutRelaxation, WavesCannotGoRound) {
  const Disk disk;
  const Field relaxed = disk.solve(true), closed = disk.solve(false);
  EXPECT_TRUE(relaxed.real.converged && relaxed.whole.converged) << relaxed.real.reason;
  EXPECT_TRUE(closed.real.converged && closed.whole.converged) << closed.real.reason;
  EXPECT_EQ(relaxed.whole.waves.period.size(), 1);
  EXPECT_GT(disk.round(relaxed), 5);
  EXPECT_NEAR(disk.round(relaxed), std::round(disk.round(relaxed)), 1e-9);
  // A form that closes on a disk has no turns round it: waves come and go back again.
  EXPECT_EQ(closed.whole.waves.period.size(), 0);
  EXPECT_NEAR(disk.round(closed), 0, 1e-9);
  // Fig. 5's zigzag costs energy; both count from the same relaxed one.
  EXPECT_GT(closed.real.energy, relaxed.real.energy);
  EXPECT_EQ(std::count(closed.released.begin(), closed.released.end(), true), 0);
}

TEST(LocalLaw, WavelengthIsThatOfItsTension) {
  const shell::Material material = test::model(1e6, 0.3, 1e-4).material;
  const double bending = 1e6 * 1e-12 / (12 * (1 - 0.09));
  for (const double x : {0.01, 0.1}) {
    // Under tension: 2√π (B/T)^¼ √x, T = ½Yhλ₁.
    const double heavy = vandeparre_wavelength(material, x, 0.1, 0);
    EXPECT_NEAR(heavy / (2 * std::sqrt(pi * x) * std::pow(bending / (0.5 * 1e6 * 1e-4 * 0.1), 0.25)), 1,
                1e-12);
    // Without: the same of the tension that its own waves make, which are √(2s₀) λ/2π high.
    const double s0 = 0.01, light = vandeparre_wavelength(material, x, 0, s0),
                 amplitude = std::sqrt(2 * s0) * light / (2 * pi),
                 own = 0.5 * 1e6 * 1e-4 * std::pow(amplitude / x, 2);
    EXPECT_NEAR(light / (2 * std::sqrt(pi * x) * std::pow(bending / own, 0.25)), 1, 1e-12);
    EXPECT_EQ(vandeparre_wavelength(material, x, 0.1, s0), std::min(heavy, light));
  }
  // λ ∝ x^½ and x^⅔.
  EXPECT_NEAR(vandeparre_wavelength(material, 0.2, 0.1, 0) / vandeparre_wavelength(material, 0.05, 0.1, 0), 2,
              1e-12);
  EXPECT_NEAR(vandeparre_wavelength(material, 0.4, 0, 0.01) / vandeparre_wavelength(material, 0.05, 0, 0.01),
              4, 1e-12);
  EXPECT_TRUE(std::isinf(vandeparre_wavelength(material, 0.1, 0, 0)));
}

// Waves of a tube whose ends are held crowd towards them (figs. 8 and 10), where the solve has the same ones
// all along.
TEST(LocalLaw, WavesCrowdAtClampedEdges) {
  const test::Tube tube(0.02);
  const Model model = test::model(1e6, 0.3, 1e-4);
  const std::vector<bool> none(tube.forms.size(), false);
  const Problem problem(tube.topology, tube.forms, model, none, tube.ends);
  const Waves waves = vandeparre_waves(problem, tube.ends);
  FieldOptions options;
  options.local_law = true;
  const Field law = solve_field(tube.topology, tube.forms, model, none, tube.ends, options),
              solved = tube.solve(model);
  EXPECT_GT(law.real.energy, solved.real.energy);
  EXPECT_EQ(law.real.energy, law.real.start_energy);
  EXPECT_EQ(law.real.waves.amplitude, waves.amplitude);
  // Amplitude over √(2s₀)/2π is the wavelength of the faces round a vertex: a quarter of the height from an
  // end, and in the middle. Twice as far, √2 times as long.
  const Eigen::Index quarter = 3 * 24 + 5, middle = 6 * 24 + 5;
  // Faces are means of their corners' distances, and the middle's lie a third of a row nearer on both sides.
  EXPECT_NEAR(waves.amplitude[middle] / waves.amplitude[quarter], std::sqrt((6 - 0.5) / 3), 0.05);
  EXPECT_THROW(vandeparre_waves(problem, {}), Error);
}

}  // namespace
}  // namespace plisse::wrinkle
