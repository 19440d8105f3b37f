// The OpenGL layer: context, programs, buffers, targets, and a dispatch larger than one dimension holds.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <gmock/gmock.h>

#include <numeric>
#include <thread>

#include "base/error.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/shader_source.h"
#include "gpu/target.h"
#include "gpu/timer.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::gpu {
namespace {

using test::TemporaryFolder;
using test::write_text;
using ::testing::HasSubstr;

class Gpu : public test::OpenGlTest {};
class GpuDevices : public test::DriverTest {};

// The code and the text of what a function throws; code −1 where it throws nothing.
template <typename Function>
std::pair<int, std::string> failure(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return {static_cast<int>(error.code), error.what()};
  }
  return {-1, ""};
}

TEST_F(Gpu, ContextSaysWhatItIs) {
  const Info& info = context()->info();
  EXPECT_FALSE(info.vendor.empty());
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_THAT(info.path, HasSubstr("EGL"));
  EXPECT_THAT(info.version, ::testing::StartsWith("4."));
  GLint major = 0, minor = 0, profile = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_GE(10 * major + minor, 45);
  EXPECT_TRUE(profile & GL_CONTEXT_CORE_PROFILE_BIT);
  // Timer queries say nothing useful on Mesa's software renderers.
  EXPECT_TRUE(info.software || info.renderer.find("llvmpipe") == std::string::npos);
}

TEST_F(GpuDevices, AreListedByNumber) {
  const auto lines = list_devices();
  ASSERT_FALSE(lines.empty());
  for (std::size_t i = 0; i < lines.size(); ++i)
    EXPECT_THAT(lines[i], ::testing::StartsWith(std::to_string(i) + ": "));
}

TEST_F(GpuDevices, ANumberPastTheLastIsBadInput) {
  const auto [code, text] = failure([] { const Context context(200); });
  EXPECT_EQ(code, 2);
  EXPECT_THAT(text, HasSubstr("--device 200"));
}

TEST_F(GpuDevices, ContextsFollowEachOther) {
  for (int i = 0; i < 3; ++i) {
    const Context context;
    const Buffer buffer(std::vector<int>{1, 2, 3});
    EXPECT_EQ(buffer.read<int>(), (std::vector<int>{1, 2, 3}));
  }
}

// The display is one for the whole process: a context that ends must not take it from the others.
TEST_F(GpuDevices, AContextThatEndsLeavesThoseOfOthers) {
  const Context host;
  const EGLContext current = eglGetCurrentContext();
  const Buffer buffer(std::vector<int>{1, 2, 3});
  { const Context ours; }
  EXPECT_EQ(eglGetCurrentContext(), current);
  EXPECT_EQ(buffer.read<int>(), (std::vector<int>{1, 2, 3}));
  std::thread([] { const Context of_another_thread; }).join();
  EXPECT_NE(eglQueryString(eglGetCurrentDisplay(), EGL_VERSION), nullptr);
  EXPECT_EQ(buffer.read<int>(), (std::vector<int>{1, 2, 3}));
  eglBindAPI(EGL_OPENGL_ES_API);
  { const Context ours; }
  EXPECT_EQ(eglQueryAPI(), static_cast<EGLenum>(EGL_OPENGL_ES_API));
  eglBindAPI(EGL_OPENGL_API);
}

TEST_F(Gpu, CheckNamesAPendingError) {
  glEnable(0x1234);  // no such thing
  const auto [code, text] = failure([] { check("while testing"); });
  EXPECT_EQ(code, static_cast<int>(ExitCode::try_again));
  EXPECT_THAT(text, HasSubstr("invalid enum"));
  EXPECT_THAT(text, HasSubstr("while testing"));
  EXPECT_NO_THROW(check("afterwards"));
}

// --- shaders
// ------------------------------------------------------------------------------------------------------------

TEST(ShaderSource, PutsIncludesInPlaceOnce) {
  const TemporaryFolder folder;
  write_text(folder / "common/a.glsl", "#include \"common/b.glsl\"\nint a;\n");
  write_text(folder / "common/b.glsl", "int b;\n");
  write_text(folder / "main.comp",
             "// head\n#include \"common/a.glsl\"\n#include \"common/b.glsl\"\nvoid main() {}\n");
  const std::string text = shader_source("main.comp", folder.path().string());
  const auto count = [&](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("int a;"), 1U);
  EXPECT_EQ(count("int b;"), 1U);
  EXPECT_LT(text.find("int b;"), text.find("int a;"));
  EXPECT_EQ(count("#include"), 0U);
  // Line numbers of the including file go on: what follows the second include is its line 4.
  EXPECT_THAT(text, HasSubstr("#line 4\nvoid main() {}"));
}

TEST(ShaderSource, NamesTheFileThatIsMissing) {
  const TemporaryFolder folder;
  write_text(folder / "main.comp", "#include \"common/gone.glsl\"\n");
  for (const std::string name : {"common/gone.glsl", "other.comp"}) {
    const auto [code, text] =
        failure([&] { shader_source(name == "other.comp" ? name : "main.comp", folder.path().string()); });
    EXPECT_EQ(code, 2);
    EXPECT_THAT(text, HasSubstr((folder / name).string()));
  }
  EXPECT_EQ(failure([] { shader_source("nothing.comp"); }).first, 2);
}

TEST(ShaderSource, EmbedsTheFolderAsItIs) {
  EXPECT_GE(embedded_shaders().size(), 10U);
  const std::filesystem::path folder = test::source_file("shaders");
  for (const auto& shader : embedded_shaders())
    EXPECT_EQ(shader.text, test::read_text(folder / shader.name)) << shader.name;
}

TEST_F(Gpu, CompileErrorsCarryTheCompilersWords) {
  const TemporaryFolder folder;
  write_text(folder / "broken.comp",
             "layout(local_size_x = GROUP_SIZE) in;\nvoid main() { undeclared_thing = 1; }\n");
  const auto [code, text] = failure([&] { Program({"broken.comp"}, {}, folder.path().string()); });
  EXPECT_EQ(code, static_cast<int>(ExitCode::no_opengl));
  EXPECT_THAT(text, HasSubstr("broken.comp"));
  EXPECT_THAT(text, HasSubstr("undeclared_thing"));
}

// 64 × 65,535 items are all that one dimension takes; a driver may do nothing past it and say so only in
// glGetError.
TEST_F(Gpu, DispatchReachesEveryItemPastOneDimension) {
  const TemporaryFolder folder;
  for (const auto& shader : embedded_shaders()) write_text(folder / shader.name, shader.text);
  write_text(folder / "mark.comp",
             "#include \"common/items.glsl\"\n"
             "layout(std430, binding = 0) buffer Marks { uint marks[]; };\n"
             "uniform uint item_count;\n"
             "void main() { uint i = item_index(); if (i < item_count) marks[i] += STEP + i; }\n");
  const Program program({"mark.comp"}, {{"STEP", "7u"}}, folder.path().string());
  for (const std::size_t count : {std::size_t{1}, std::size_t{64}, std::size_t{65},
                                  std::size_t{64} * 65535 + 1, std::size_t{64} * 70000 + 3}) {
    const std::size_t slack = 100;  // must stay untouched
    Buffer buffer((count + slack) * sizeof(std::uint32_t));
    buffer.bind_storage(0);
    program.use();
    glUniform1ui(program.uniform("item_count"), static_cast<GLuint>(count));
    dispatch(program, count);
    check("after a dispatch");
    const auto marks = buffer.read<std::uint32_t>();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) wrong += marks[i] != 7 + i ? 1 : 0;
    for (std::size_t i = count; i < count + slack; ++i) wrong += marks[i] != 0 ? 1 : 0;
    EXPECT_EQ(wrong, 0U) << count;
  }
  dispatch(program, 0);
  EXPECT_NO_THROW(check("after an empty dispatch"));
}

// --- buffers and targets
// ------------------------------------------------------------------------------------------------

TEST_F(Gpu, BuffersKeepWhatTheyAreGiven) {
  std::vector<float> values(1000);
  std::iota(values.begin(), values.end(), 0.5F);
  Buffer buffer(values);
  EXPECT_EQ(buffer.bytes(), 4000U);
  EXPECT_EQ(buffer.read<float>(), values);
  const std::vector<float> middle{-1, -2, -3};
  buffer.write(middle.data(), 12, 400);
  std::copy(middle.begin(), middle.end(), values.begin() + 100);
  EXPECT_EQ(buffer.read<float>(), values);
  float one = 0;
  buffer.read(&one, 4, 404);
  EXPECT_EQ(one, -2.0F);

  EXPECT_EQ(Buffer(64).read<std::uint8_t>(), std::vector<std::uint8_t>(64, 0));  // zero without data
  const Buffer empty{std::vector<float>{}};  // a mesh without neighbours is no error
  EXPECT_TRUE(empty.read<float>().empty());

  Buffer other(std::vector<int>{1, 2});
  const unsigned id = buffer.id();
  other = std::move(buffer);
  EXPECT_EQ(other.id(), id);
  EXPECT_EQ(other.read<float>(), values);
}

using Colour = std::array<float, 4>;
void paint(const Rectangle& area, const Colour& colour) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(area.x, area.y, area.width, area.height);
  glClearColor(colour[0], colour[1], colour[2], colour[3]);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

TEST_F(Gpu, TargetsReadFromTopToBottom) {
  constexpr int width = 5, height = 4;  // rows of 15 and 20 bytes: no alignment may creep in
  for (const int samples : {1, 4}) {
    const Target target(width, height, samples, Target::Format::srgb8);
    target.bind();
    glDisable(GL_FRAMEBUFFER_SRGB);
    paint({0, 0, width, height}, {0, 0, 1, 1});
    paint({0, height - 1, width, 1}, {1, 0, 0, 1});  // OpenGL counts rows from below: this is the top one
    paint({2, 0, 1, 1}, {0, 1, 0, 0});
    target.resolve({0, 0, width, height});
    const auto rgba = target.read_rgba8();
    ASSERT_EQ(rgba.size(), 4U * width * height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const bool top = y == 0, mark = y == height - 1 && x == 2;
        const std::array<int, 4> expected{top ? 255 : 0, mark ? 255 : 0, top || mark ? 0 : 255,
                                          mark ? 0 : 255};
        for (std::size_t c = 0; c < 4; ++c) {
          EXPECT_EQ(rgba[4 * static_cast<std::size_t>(y * width + x) + c], expected[c])
              << x << "," << y << " " << samples;
        }
      }
    }
  }
}

TEST_F(Gpu, ResolveKeepsTheRestOfThePicture) {
  const Target target(8, 6, 4, Target::Format::srgb8);
  target.bind();
  glDisable(GL_FRAMEBUFFER_SRGB);
  paint({0, 0, 8, 6}, {1, 1, 1, 1});
  target.resolve({0, 0, 8, 6});
  paint({0, 0, 8, 6}, {0, 0, 0, 1});
  target.resolve({2, 1, 3, 2});
  target.resolve({});
  const auto rgba = target.read_rgba8();
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      const int from_below = 5 - y;
      const bool inside = x >= 2 && x < 5 && from_below >= 1 && from_below < 3;
      EXPECT_EQ(rgba[4 * static_cast<std::size_t>(y * 8 + x)], inside ? 0 : 255) << x << "," << y;
    }
  }
}

TEST_F(Gpu, FloatTargetsKeepFloats) {
  const Target target(3, 2, 1, Target::Format::rgba32f);
  target.bind();
  paint({0, 0, 3, 2}, {-1.25F, 1e-20F, 12345.678F, 3});
  const auto rgba = target.read_rgba32f();
  EXPECT_EQ(rgba[0], -1.25F);
  EXPECT_EQ(rgba[1], 1e-20F);
  EXPECT_EQ(rgba[2], 12345.678F);
  EXPECT_EQ(rgba[3], 3.0F);
}

TEST_F(Gpu, TimerCountsEachStage) {
  StageTimer timer(context()->info().software);
  Buffer buffer(1 << 22);
  for (int i = 0; i < 2; ++i) {
    timer.begin("fill");
    glClearNamedBufferData(buffer.id(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
    timer.begin("read");  // ends the stage before
    buffer.read<float>();
    timer.end();
  }
  const auto milliseconds = timer.collect();
  ASSERT_EQ(milliseconds.size(), 2U);
  for (const auto& [stage, ms] : milliseconds) {
    EXPECT_GE(ms, 0) << stage;
    EXPECT_LT(ms, 1e4) << stage;  // garbage of a timer query would be far more
  }
  EXPECT_TRUE(timer.collect().empty());
}

}  // namespace
}  // namespace plisse::gpu
