// Reading pictures: the smallest files of three formats written out by hand from their specifications, and
// refusals.
#include "io/picture/image.h"

#include <gtest/gtest.h>

#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/picture/png.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

void expect_refused(const Bytes& bytes, const std::string& what) {
  try {
    decode_image(bytes, "texture 3 of hat.glb");
    FAIL() << "was read: " << what;
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::bad_input);
    const std::string text = error.what();
    EXPECT_NE(text.find("texture 3 of hat.glb"), std::string::npos) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  }
}

TEST(ReadImage, PnmFillsAlphaAndKeepsRowsFromTheTop) {
  const Image image = decode_image(bytes_of("P6 2 2 255\n"
                                            "abcdefghijkl"),
                                   "test");
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 2);
  const std::string expected =
      "abc\xff"
      "def\xff"
      "ghi\xff"
      "jkl\xff";
  EXPECT_EQ(image.rgba, bytes_of(expected));
}

TEST(ReadImage, GreyIsSpread) {
  const Image image = decode_image(bytes_of("P5 1 1 255\nA"), "test");
  EXPECT_EQ(image.rgba, (Bytes{'A', 'A', 'A', 255}));
}

TEST(ReadImage, BmpIsBottomUpAndBlueFirst) {
  Bytes bmp(54, 0);
  const auto put = [&](std::size_t at, std::uint32_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bmp[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
  };
  bmp[0] = 'B', bmp[1] = 'M';
  put(2, 54 + 8, 4), put(10, 54, 4), put(14, 40, 4), put(18, 1, 4), put(22, 2, 4), put(26, 1, 2),
      put(28, 24, 2);
  for (const int value : {1, 2, 3, 0, 4, 5, 6, 0})
    bmp.push_back(static_cast<std::uint8_t>(value));  // rows padded to 4
  EXPECT_EQ(decode_image(bmp, "test").rgba, (Bytes{6, 5, 4, 255, 3, 2, 1, 255}));
}

TEST(ReadImage, RefusesWithNameAndReason) {
  expect_refused({}, "is empty");
  expect_refused(bytes_of("hello, I am no picture at all"), "PNG, JPEG");
  expect_refused(bytes_of("P6 20000 2 255\n"), "large image");
  Bytes png = encode_png({8, 8, Bytes(256, 77)});
  png.resize(png.size() / 2);
  expect_refused(png, "no picture");
}

TEST(ReadImage, RefusesHugeHeadersBeforeDecoding) {
  // A BMP header alone that asks for 20000 × 20000 pixels.
  Bytes bmp(54, 0);
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bmp[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
  };
  bmp[0] = 'B', bmp[1] = 'M';
  put(10, 54), put(14, 40), put(18, 20000), put(22, 20000), bmp[26] = 1, bmp[28] = 24;
  expect_refused(bmp, "large image");
}

TEST(ReadImage, FilesAreNamed) {
  const test::TemporaryFolder folder;
  const auto path = folder / "image.pgm";
  write_whole_file(path, "P5 1 1 255\nA");
  EXPECT_EQ(load_image(path).width, 1);
  std::filesystem::remove(path);
  EXPECT_THROW(load_image(path), Error);
}

}  // namespace
}  // namespace plisse::io
