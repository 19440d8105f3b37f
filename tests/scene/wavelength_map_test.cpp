// Wavelengths from a picture and from a table, against what was put into them.
#include "scene/wavelength_map.h"

#include <gtest/gtest.h>

#include "io/picture/png.h"
#include "io/ply.h"
#include "support/files.h"
#include "support/sheets.h"

namespace plisse {
namespace {

// A sheet over 0…0.8 with uv = (x, y).
class WavelengthMap : public ::testing::Test {
 protected:
  const std::vector<double>& taken(const std::filesystem::path& map,
                                   const glm::dmat4& to_world = glm::dmat4(1)) {
    settings_.wavelength_map = map;
    waves_ = sheet_.waves;
    scene::take_wavelengths(sheet_.surface, settings_, to_world, waves_);
    return waves_.wavelength;
  }
  test::TemporaryFolder folder_;
  test::Sheet sheet_ = test::grid(9, 9, 0.1, 0, 1, 0.04);
  config::WrinkleSettings settings_ = [] {
    config::WrinkleSettings settings;
    settings.wavelength = 0.04;
    return settings;
  }();
  VertexWaves waves_;
};

TEST_F(WavelengthMap, APictureLeadsFromLowToHigh) {
  io::Image image{2, 1, std::vector<std::uint8_t>(8, 255)};
  image.rgba[0] = image.rgba[1] = image.rgba[2] = 0;  // black, then white
  io::write_png(folder_ / "map.png", image);
  for (const double low : {0.0, 0.01, 0.1}) {  // 0: half of W
    settings_.wavelength_low = low;
    const auto& lengths = taken(folder_ / "map.png");
    for (std::size_t v = 0; v < lengths.size(); ++v) {
      const double u = sheet_.surface.rest[v].x;
      // Bilinear between the texels' middles at ¼ and ¾, and on beyond as the picture repeats.
      const double amount = u < 0.25 ? 0.5 - 2 * u : u < 0.75 ? 2 * u - 0.5 : 2.5 - 2 * u;
      const double black = low > 0 ? low : 0.02;
      EXPECT_NEAR(lengths[v], black + (0.04 - black) * amount, 1e-7);  // uv in single precision
    }
  }
}

TEST_F(WavelengthMap, ATableIsInTheModelsUnitAndAnyOrder) {
  using Type = io::PlyProperty::Type;
  io::PlyElement vertex{
      "vertex",
      sheet_.size(),
      {{"x", Type::float64}, {"y", Type::float64}, {"z", Type::float64}, {"wavelength", Type::float64}}};
  for (std::size_t i = sheet_.size(); i-- > 0;) {
    const glm::dvec3 x = 1000.0 * sheet_.surface.rest[i];  // millimetres
    const double values[] = {x.x, x.y, x.z, 10 + static_cast<double>(i)};
    for (std::size_t k = 0; k < 4; ++k) vertex.properties[k].values.push_back(values[k]);
  }
  io::write_ply(folder_ / "map.ply", {{}, {vertex}});
  glm::dmat4 millimetres(0.001);
  millimetres[3][3] = 1;
  const auto& lengths = taken(folder_ / "map.ply", millimetres);
  for (std::size_t v = 0; v < lengths.size(); ++v)
    EXPECT_NEAR(lengths[v], 0.001 * (10 + static_cast<double>(v)), 1e-15);
}

TEST_F(WavelengthMap, IrregularityStaysOnTop) {
  io::write_png(folder_ / "grey.png", {1, 1, {255, 255, 255, 255}});
  sheet_.waves.wavelength[5] = 0.05;
  EXPECT_NEAR(taken(folder_ / "grey.png")[5], 0.05, 1e-15);  // white is W itself
}

}  // namespace
}  // namespace plisse
