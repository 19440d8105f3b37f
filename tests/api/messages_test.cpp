// Messages of a request go to its own sink: from all of its threads, and from requests that run at the same
// time.
#include <gmock/gmock.h>

#include <thread>

#include "plisse/render.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class Sinks : public test::DriverTest {
 protected:
  // A triangle whose material library is missing, which the reader warns of.
  std::filesystem::path model(const std::string& library) const {
    const auto path = folder_ / (library + ".obj");
    test::write_text(path, "mtllib " + library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return path;
  }

  test::TemporaryFolder folder_;
};

struct Heard {
  std::vector<std::string> warnings, others;
  MessageSink sink() {
    return [this](MessageLevel level, std::string_view text) {
      (level == MessageLevel::warning ? warnings : others).emplace_back(text);
    };
  }
};

RenderRequest drawing(const std::filesystem::path& model, Heard& heard) {
  RenderRequest request;
  request.scene.file = model;
  request.scene.options = {{"--size", "32x32"}};
  request.on_picture = [](int, const Picture&) {};
  request.messages = heard.sink();
  return request;
}

// The scene is read on a thread of its own while the driver starts on the caller's.
TEST_F(Sinks, HearWhatAnyThreadOfTheirRequestSaysAndNobodyElse) {
  Heard one, other;
  const auto first = model("first.mtl"), second = model("second.mtl");
  testing::internal::CaptureStderr();
  std::thread beside([&] {
    for (int i = 0; i < 5; ++i) render(drawing(second, other));
  });
  for (int i = 0; i < 5; ++i) render(drawing(first, one));
  beside.join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(one.warnings, SizeIs(5));
  EXPECT_THAT(one.warnings, Each(HasSubstr("'first.mtl' not found")));
  EXPECT_THAT(other.warnings, SizeIs(5));
  EXPECT_THAT(other.warnings, Each(HasSubstr("'second.mtl' not found")));
  // Details, such as the device's name, come to the sink as well.
  EXPECT_THAT(one.others, Not(SizeIs(0)));
}

TEST_F(Sinks, AnEmptySinkDropsAll) {
  LoadOptions options;
  const auto path = model("third.mtl");
  testing::internal::CaptureStderr();
  load_mesh(path, options);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  Heard heard;
  options.messages = heard.sink();
  load_mesh(path, options);
  EXPECT_THAT(heard.warnings, SizeIs(1));
}

}  // namespace
}  // namespace plisse
