// The picture in linear light and the parts' numbers, as EXR beside a frame.
#include <gmock/gmock.h>
#include <tinyexr.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "base/colour.h"
#include "config/scene_file.h"
#include "io/image.h"
#include "pipeline/render.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse {
namespace {

class Aovs : public test::DriverTest {
 protected:
  pipeline::RenderReport drawn(bool transparent) const {
    pipeline::RenderRequest request;
    request.scene = config::load_scene(test::asset("sleeve.toml"));
    request.scene.model.loop = false;
    request.scene.model.frames = "20";
    request.scene.output.width = 96;
    request.scene.output.height = 80;
    request.scene.output.transparent = transparent;
    request.scene.output.path = (folder_ / "f_##.png").string();
    request.aovs = {"beauty", "object", "depth"};
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

}  // namespace
}  // namespace plisse
