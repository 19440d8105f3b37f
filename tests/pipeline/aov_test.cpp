// The picture in linear light and the parts' numbers, as EXR beside a frame.
#include <gmock/gmock.h>
#include <tinyexr.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <set>

#include "base/colour.h"
#include "config/scene_file.h"
#include "io/picture/image.h"
#include "pipeline/render.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse {
namespace {

class Aovs : public test::DriverTest {
 protected:
  pipeline::RenderReport drawn(bool transparent) const {
    config::SceneSettings scene = config::load_scene(test::asset("sleeve.toml"));
    scene.model.loop = false;
    scene.model.frames = "20";
    scene.output.transparent = transparent;
    return drawn(scene, {"beauty", "object", "depth"}, 96, 80);
  }
  pipeline::RenderReport drawn(const config::SceneSettings& scene, const std::vector<std::string>& aovs,
                               int width, int height, bool displaced = false) const {
    pipeline::RenderRequest request;
    request.scene = scene;
    request.scene.output.width = width;
    request.scene.output.height = height;
    request.scene.output.path = (folder_ / "f_##.png").string();
    request.aovs = aovs;
    request.displace = displaced;
    return pipeline::render(request, {});
  }
  // Four values a pixel; one channel is spread over red, green, blue.
  std::vector<float> exr(const std::string& name) const {
    float* rgba = nullptr;
    int width = 0, height = 0;
    const char* message = nullptr;
    const std::string path = folder_ / name;
    EXPECT_EQ(LoadEXR(&rgba, &width, &height, path.c_str(), &message), TINYEXR_SUCCESS);
    const std::unique_ptr<float, void (*)(void*)> owner(rgba, std::free);
    return {rgba, rgba + 4 * width * height};
  }
  test::TemporaryFolder folder_;
};

TEST_F(Aovs, BeautyIsTheFrameInLinearLight) {
  for (const bool transparent : {false, true}) {
    drawn(transparent);
    const io::Image frame = io::load_image(folder_ / "f_20.png");
    const auto linear = exr("f_20.beauty.exr");
    ASSERT_EQ(linear.size(), frame.rgba.size());
    int apart = 0, compared = 0;
    for (std::size_t i = 0; i < linear.size(); i += 4) {
      const double alpha = static_cast<double>(linear[i + 3]);
      EXPECT_NEAR(alpha, frame.rgba[i + 3] / 255.0, 0.51 / 255);
      if (frame.rgba[i + 3] == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const double straight = static_cast<double>(linear[i + c]) / alpha;
        const double shown = 255 * linear_to_srgb(std::clamp(straight, 0.0, 1.0));
        ++compared;
        // Eight bits of each sample, and with an alpha eight bits of that as well.
        apart += std::abs(shown - frame.rgba[i + c]) > (frame.rgba[i + 3] == 255 ? 1.5 : 8) ? 1 : 0;
      }
    }
    EXPECT_GT(compared, 3000);
    EXPECT_LE(apart, compared / 200) << transparent;
  }
}

TEST_F(Aovs, ObjectsAreTheReportsParts) {
  const pipeline::RenderReport report = drawn(false);
  ASSERT_EQ(report.objects.size(), 3U);
  std::set<std::string> materials;
  for (const auto& object : report.objects) materials.insert(object.material);
  EXPECT_EQ(materials, (std::set<std::string>{"cloth", "cuff", "seam"}));
  const auto objects = exr("f_20.object.exr"), depth = exr("f_20.depth.exr");
  std::set<float> seen;
  for (std::size_t i = 0; i < objects.size(); i += 4) {
    EXPECT_EQ(objects[i] > 0, depth[i] > 0);
    seen.insert(objects[i]);
  }
  EXPECT_EQ(seen, (std::set<float>{0, 1, 2, 3}));
}

// A sphere of radius R has the mean curvature 1/R everywhere.
TEST_F(Aovs, CurvatureOfASphereIsOneOverItsRadius) {
  constexpr double radius = 0.2;
  constexpr int across = 64, down = 32;
  std::ofstream file(folder_ / "sphere.obj");
  for (int i = 0; i <= down; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = std::numbers::pi * i / down, b = 2 * std::numbers::pi * j / across;
      const double x = std::sin(a) * std::cos(b), y = std::cos(a), z = -std::sin(a) * std::sin(b);
      file << "v " << radius * x << ' ' << radius * y << ' ' << radius * z << "\nvn " << x << ' ' << y << ' '
           << z << '\n';
    }
  }
  for (int i = 0; i < down; ++i) {
    for (int j = 0; j < across; ++j) {
      const int a = 1 + i * across + j, b = 1 + i * across + (j + 1) % across, c = a + across, d = b + across;
      if (i > 0) file << "f " << a << "//" << a << ' ' << c << "//" << c << ' ' << b << "//" << b << '\n';
      if (i + 1 < down)
        file << "f " << c << "//" << c << ' ' << d << "//" << d << ' ' << b << "//" << b << '\n';
    }
  }
  file.close();
  drawn(config::bare_scene((folder_ / "sphere.obj").string()), {"curvature"}, 160, 128);
  const auto values = exr("f_01.curvature.exr");
  std::vector<double> seen;
  for (std::size_t i = 0; i < values.size(); i += 4)
    if (values[i] != 0) seen.push_back(static_cast<double>(values[i]));
  ASSERT_GT(seen.size(), 3000U);
  std::ranges::sort(seen);
  // The normal turns by an edge's angle, 2π/64, along the chord in place of the arc: 1/24 of its square, .04
  // %, and unevenly, which the quartiles show. Pixels that lie across an edge of the mesh see the two halves
  // differ.
  EXPECT_NEAR(seen[seen.size() / 2] * radius, 1, 0.005);
  EXPECT_NEAR(seen[seen.size() / 4] * radius, 1, 0.03);
  EXPECT_NEAR(seen[3 * seen.size() / 4] * radius, 1, 0.03);
}

// Of a wave h cos φ the mean curvature is −½ d²h/ds², ½ k² times its height: where crests are it is greater
// than in valleys. Both ways of drawing the same waves, shaded and displaced, agree.
TEST_F(Aovs, CurvatureOfWavesGoesWithTheirHeight) {
  for (const bool displaced : {false, true}) {
    config::SceneSettings scene = config::load_scene(test::asset("sleeve.toml"));
    scene.model.loop = false;
    scene.model.frames = "20";
    drawn(scene, {"curvature", "height"}, 480, 384, displaced);
    const auto curvature = exr("f_20.curvature.exr"), height = exr("f_20.height.exr");
    std::vector<double> crests, valleys;
    for (std::size_t i = 0; i < height.size(); i += 4) {
      const double h = static_cast<double>(height[i]), least = 1e-3;  // metres; the highest are 3 mm
      if (h > least) crests.push_back(static_cast<double>(curvature[i]));
      if (h < -least) valleys.push_back(static_cast<double>(curvature[i]));
    }
    ASSERT_GT(crests.size(), 300U) << displaced;
    ASSERT_GT(valleys.size(), 300U) << displaced;
    const auto median = [](std::vector<double>& of) {
      std::ranges::nth_element(of, of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2));
      return of[of.size() / 2];
    };
    EXPECT_GT(median(crests), 10) << displaced;
    EXPECT_LT(median(valleys), -10) << displaced;
  }
}

}  // namespace
}  // namespace plisse
