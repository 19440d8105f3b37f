// The scenes of Z. Chen et al., Fine Wrinkling on Coarsely Meshed Thin Shells, 2021, from example to waves:
// docs/wrinkle.md, "Scenes", has the numbers beside the paper's. Each takes seconds of one core.
#include <algorithm>
#include <cmath>
#include <functional>

#include "io/wrinkle_field.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

class WrinkleScenesSlow : public ::testing::Test {
 protected:
  nlohmann::json solved(std::vector<std::string> more) {
    std::vector<std::string> arguments{"wrinkle", "-o",     (folder_ / "field.ply").string(),
                                       "--json",  report(), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(read_text(folder_ / "report.json"));
  }
  io::WrinkleField field() const { return io::read_wrinkle_field(folder_ / "field.ply", {}); }
  // Mean of a quantity of places by amplitude squared.
  static double mean(const io::WrinkleField& field, const std::function<double(const glm::dvec3&)>& of) {
    double sum = 0, weight = 0;
    for (std::size_t v = 0; v < field.positions.size(); ++v) {
      const double a = field.amplitude[v] * field.amplitude[v];
      sum += a * of(field.positions[v]);
      weight += a;
    }
    return weight > 0 ? sum / weight : 0;
  }

  TemporaryFolder folder_;

 private:
  std::string report() const { return (folder_ / "report.json").string(); }
};

// Paper, fig. 21: 46, 46, 47, 46, 45 on irregular meshes of these sizes; the one-dimensional optimum is 44.
// (Meshes of 180 lie below: six rows of vertices do not show how steeply amplitudes rise at the clamps.)
TEST_F(WrinkleScenesSlow, TwistedCylinderWhateverTheMesh) {
  for (const std::string vertices : {"180", "344", "688", "1309", "2543"}) {
    for (const std::string seed : {"1", "2", "3"}) {
      // Fine ones differ by nothing, and take longest.
      if (vertices.size() > 3 && seed != "1") continue;
      const auto json = solved({"--example", "twisted-cylinder", "--vertices", vertices, "--seed", seed});
      // The number asked for: sides hold whole edges, so that the coarsest can miss by a row.
      EXPECT_NEAR(json["vertices"].get<double>(), std::stod(vertices),
                  std::max(4.0, .015 * std::stod(vertices)));
      // 41 to 45 but for one of the coarsest, which has 40 (docs/wrinkle.md says why).
      EXPECT_NEAR(std::round(json["waves"].get<double>()), 43, vertices == "180" ? 3 : 2)
          << vertices << " " << seed;
    }
  }
}

// The paper's own drop on regular meshes is 17 %; 20 % are asked for.
TEST_F(WrinkleScenesSlow, TwistedCylinderOnRegularMeshes) {
  for (const char* example : {"twisted-cylinder-rising", "twisted-cylinder-falling"})
    EXPECT_NEAR(solved({"--example", example})["waves"].get<double>(), 44, 0.2 * 44) << example;
}

// Paper: 25; experiment (Wong and Pellegrino 2006): 19; ARCSim: 26. A way from one end to the other meets the
// fans in the corners as well, hence one more than a level line does (docs/wrinkle.md).
TEST_F(WrinkleScenesSlow, ShearedRectangle) {
  // Draped frame by frame: in one step its base surface does not come to rest to the last digit.
  const std::string base = (folder_ / "base.ply").string();
  ASSERT_EQ(plisse({"drape", "--example", "sheared-rectangle", "-o", base, "-q"}).code, 0);
  const auto json = solved({base});
  EXPECT_GE(json["waves"].get<double>(), 14);
  EXPECT_LE(json["waves"].get<double>(), 30);
}

// Waves run round the ball, which needs phases that do not close at its pole.
TEST_F(WrinkleScenesSlow, SphereDrape) {
  const auto json = solved({"--example", "sphere-drape"});
  EXPECT_GT(json["wrinkle_free_faces"].get<int>(), 0);
  EXPECT_TRUE(json["waves_round"].get<bool>());
  EXPECT_EQ(json["periods"], 1);
  EXPECT_GE(json["waves"].get<double>(), 12);
  EXPECT_LE(json["waves"].get<double>(), 40);
  const double energy = json["energy_J"];
  // With integrability everywhere they cannot (fig. 5), and cost more.
  const auto closed = solved({"--example", "sphere-drape", "--without", "relaxation"});
  EXPECT_LT(closed["waves"].get<double>(), 12);
  EXPECT_GT(closed["energy_J"].get<double>(), 2 * energy);
}

// Fig. 11: fine wrinkles round the outer equator, whose radius is .1 m less what the sewn rings draw in.
TEST_F(WrinkleScenesSlow, TorusAndBalloon) {
  const auto radius = [](const glm::dvec3& x) { return std::hypot(x.x, x.z); };
  for (const char* example : {"torus", "disk-balloon"}) {
    const auto json = solved({"--example", example});
    EXPECT_TRUE(json["waves_round"].get<bool>()) << example;
    EXPECT_GE(json["waves"].get<double>(), 30) << example;
    const io::WrinkleField waves = field();
    double outer = 0, middle = 0;
    for (const auto& x : waves.positions) {
      outer = std::max(outer, radius(x));
      middle += radius(x) / static_cast<double>(waves.positions.size());
    }
    // Farther out than the surface is on the whole.
    EXPECT_GT(mean(waves, radius), middle) << example;
    EXPECT_GT(mean(waves, radius), 0.75 * outer) << example;
  }
}

// Fig. 13: fine wrinkles round the boundary, none in the middle.
TEST_F(WrinkleScenesSlow, Teabag) {
  const auto json = solved({"--example", "teabag"});
  EXPECT_GE(json["waves"].get<double>(), 10);
  const io::WrinkleField waves = field();
  glm::dvec3 low(1e9), high(-1e9);
  for (const auto& x : waves.positions) {
    low = glm::min(low, x);
    high = glm::max(high, x);
  }
  const double most = *std::max_element(waves.amplitude.begin(), waves.amplitude.end());
  for (std::size_t v = 0; v < waves.positions.size(); ++v) {
    const glm::dvec3 x = (waves.positions[v] - low) / (high - low);  // panels lie in x and z
    if (std::abs(x.x - 0.5) < 0.1 && std::abs(x.z - 0.5) < 0.1) {
      EXPECT_LT(waves.amplitude[v], 0.1 * most) << v;
    }
  }
}

}  // namespace
}  // namespace plisse::test
