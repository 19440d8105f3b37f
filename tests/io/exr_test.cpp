// Float images: read back by tinyexr's own reader, exactly, and OpenEXR's magic number.
#include "io/picture/exr.h"

#include <gtest/gtest.h>
#include <tinyexr.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/files.h"

namespace plisse::io {
namespace {

namespace fs = std::filesystem;

class Exr : public testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(Exr, ComesBackBitForBit) {
  constexpr int width = 33, height = 20;
  for (const int channels : {1, 3, 4}) {
    std::vector<float> values;
    for (int i = 0; i < width * height * channels; ++i) {
      values.push_back(static_cast<float>(std::sin(i) * std::pow(10.0, i % 60 - 30)));
    }
    const auto path = folder_ / "new" / (std::to_string(channels) + ".exr");
    write_exr(path, width, height, channels, values);

    float* rgba = nullptr;
    int read_width = 0, read_height = 0;
    const char* message = nullptr;
    ASSERT_EQ(LoadEXR(&rgba, &read_width, &read_height, path.c_str(), &message), TINYEXR_SUCCESS)
        << (message != nullptr ? message : "");
    const std::unique_ptr<float, void (*)(void*)> owner(rgba, std::free);
    ASSERT_EQ(read_width, width);
    ASSERT_EQ(read_height, height);
    for (int p = 0; p < width * height; ++p) {
      for (int c = 0; c < channels; ++c) {
        ASSERT_EQ(rgba[4 * p + c], values[static_cast<std::size_t>(p * channels + c)])
            << "pixel " << p << ", channel " << c << " of " << channels;
      }
    }
  }
}

TEST_F(Exr, HasTheMagicNumberOfTheFormat) {
  write_exr(folder_ / "a.exr", 1, 1, 1, std::vector<float>{2.5F});
  const auto file = read_whole_file(folder_ / "a.exr");
  ASSERT_GT(file.size(), 4U);
  EXPECT_EQ((std::vector<std::uint8_t>{file.begin(), file.begin() + 4}),
            (std::vector<std::uint8_t>{0x76, 0x2f, 0x31, 0x01}));
}

TEST_F(Exr, RefusesWhatDoesNotFit) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto refused = [&](int width, int height, int channels, const std::vector<float>& values) {
    try {
      write_exr(folder_ / "bad.exr", width, height, channels, values);
      return std::string();
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::no_output);
      return std::string(error.what());
    }
  };
  EXPECT_NE(refused(2, 1, 1, {1, nan}).find("pixel (1, 0)"), std::string::npos);
  EXPECT_NE(refused(1, 2, 1, {1, inf}).find("pixel (0, 1)"), std::string::npos);
  EXPECT_NE(refused(1, 1, 2, {1, 1}), "");
  EXPECT_NE(refused(1, 1, 1, {1, 1}), "");
  EXPECT_NE(refused(0, 1, 1, {}), "");
  EXPECT_FALSE(fs::exists(folder_ / "bad.exr"));
}

}  // namespace
}  // namespace plisse::io
