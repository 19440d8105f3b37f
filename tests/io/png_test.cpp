// PNG frames: read back by an independent decoder (stb_image), chunk by chunk against the specification, and
// every single damaged byte must be noticed.
#include "io/picture/png.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/picture/image.h"
#include "support/files.h"

namespace plisse::io {
namespace {

namespace fs = std::filesystem;

Image picture(int width, int height, bool transparent) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.rgba.push_back(static_cast<std::uint8_t>(5 * x + y));
      image.rgba.push_back(static_cast<std::uint8_t>(x * y));
      image.rgba.push_back(static_cast<std::uint8_t>(200 - 3 * y));
      image.rgba.push_back(static_cast<std::uint8_t>(transparent ? 7 * x : 255));
    }
  }
  return image;
}

class Png : public testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(Png, ComesBackPixelForPixel) {
  for (const bool transparent : {false, true}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {37, 23}, {256, 3}}) {
      for (const PngLevel level : {PngLevel::stored, PngLevel::quick, PngLevel::small}) {
        const Image image = picture(width, height, transparent);
        const Image back = decode_image(encode_png(image, {level, "abc"}), "test");
        ASSERT_EQ(back.width, width);
        ASSERT_EQ(back.height, height);
        EXPECT_EQ(back.rgba, image.rgba) << width << " × " << height << ", level " << static_cast<int>(level);
      }
    }
  }
}

TEST_F(Png, ChunksAreThoseOfTheContract) {
  // Positions by ISO/IEC 15948: signature 8, then length 4, type 4, data, CRC 4.
  const auto file = encode_png(picture(40, 30, false), {.hash = "00ff"});
  std::vector<std::string> types;
  std::string text;
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t length =
        std::size_t{file[at]} << 24 | file[at + 1] << 16 | file[at + 2] << 8 | file[at + 3];
    types.emplace_back(file.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                       file.begin() + static_cast<std::ptrdiff_t>(at) + 8);
    if (types.back() == "tEXt") {
      text += std::string(reinterpret_cast<const char*>(&file[at + 8]), length) + "|";
    }
    if (types.back() == "IHDR") {
      EXPECT_EQ(file[at + 8 + 8], 8) << "bits a channel";
      EXPECT_EQ(file[at + 8 + 9], 2) << "colour type of an opaque image: RGB";
    }
    at += 12 + length;
  }
  EXPECT_EQ(types, (std::vector<std::string>{"IHDR", "sRGB", "tEXt", "tEXt", "IDAT", "IEND"}));
  EXPECT_EQ(text.rfind(std::string("Software\0plisse ", 16), 0), 0U);
  EXPECT_NE(text.find(std::string("plisse-hash\0", 12) + "00ff|"), std::string::npos);
}

TEST_F(Png, SamePixelsSameBytesOnAnyThread) {
  const Image image = picture(64, 48, true);
  const auto expected = encode_png(image, {PngLevel::small, "h"});
  std::vector<std::thread> threads;
  std::vector<int> equal(8, 0);
  for (std::size_t t = 0; t < equal.size(); ++t) {
    threads.emplace_back([&, t] {
      // Every other thread uses another level in between: it must not leak into the rest.
      for (int i = 0; i < 10; ++i) {
        if (t % 2 == 1) encode_png(image, {PngLevel::stored, "h"});
        equal[t] += encode_png(image, {PngLevel::small, "h"}) == expected ? 1 : 0;
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(equal, std::vector<int>(8, 10));
}

TEST_F(Png, WholeOnlyWithTheRightHash) {
  const auto path = folder_ / "frame.png";
  write_png(path, picture(20, 10, true), {.hash = "0123abcd"});
  EXPECT_TRUE(png_is_whole(path, "0123abcd"));
  EXPECT_FALSE(png_is_whole(path, "0123abce"));
  EXPECT_FALSE(png_is_whole(path, "0123abc"));
  EXPECT_FALSE(png_is_whole(path, ""));
  EXPECT_FALSE(png_is_whole(folder_ / "missing.png", "0123abcd"));
  EXPECT_FALSE(png_is_whole(folder_, "0123abcd"));
  write_png(path, picture(20, 10, true));
  EXPECT_FALSE(png_is_whole(path, "")) << "a file without a hash";
}

TEST_F(Png, AnyDamageIsNoticed) {
  const auto path = folder_ / "frame.png";
  const auto file = encode_png(picture(12, 9, false), {.hash = "0123abcd"});
  for (std::size_t i = 0; i < file.size(); ++i) {
    auto damaged = file;
    damaged[i] ^= 0x10;
    write_whole_file(path, damaged);
    EXPECT_FALSE(png_is_whole(path, "0123abcd")) << "byte " << i << " of " << file.size();
  }
  for (std::size_t size = 0; size < file.size(); ++size) {
    write_whole_file(path, std::span(file).first(size));
    EXPECT_FALSE(png_is_whole(path, "0123abcd")) << "cut to " << size << " of " << file.size();
  }
  auto longer = file;
  longer.push_back(0);
  write_whole_file(path, longer);
  EXPECT_FALSE(png_is_whole(path, "0123abcd")) << "a byte after IEND";
  auto twice = file;
  twice.insert(twice.end(), file.end() - 12, file.end());
  write_whole_file(path, twice);
  EXPECT_FALSE(png_is_whole(path, "0123abcd")) << "a second IEND";
  write_whole_file(path, file);
  EXPECT_TRUE(png_is_whole(path, "0123abcd")) << "the file itself";
}

TEST_F(Png, RefusesWhatIsNoImage) {
  for (const Image& image : {Image{}, Image{0, 4, {}}, Image{2, 2, std::vector<std::uint8_t>(15)},
                             Image{20000, 1, std::vector<std::uint8_t>(80000)}}) {
    try {
      encode_png(image);
      FAIL() << image.width << " × " << image.height << " was encoded";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::no_output);
    }
  }
}

}  // namespace
}  // namespace plisse::io
