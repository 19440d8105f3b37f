// Files that bring assimp 5.2.5 down, take too long or too much, read from a program that has threads: each
// ends in an Error of the caller's.
#include "io/isolated_import.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <thread>

#include "base/error.h"
#include "io/importer_process.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// One triangle in the X format whose only bone weight is of this vertex. assimp 5.2.5 does not look whether
// there is one.
std::string skinned_triangle(unsigned vertex) {
  return fmt::format(
      "xof 0303txt 0032\nFrame Root {{\n Mesh Sheet {{\n  3;\n  0.0;0.0;0.0;,\n  1.0;0.0;0.0;,\n  "
      "0.0;1.0;0.0;;\n"
      "  1;\n  3;0;1;2;;\n  SkinWeights {{\n   \"Root\";\n   1;\n   {};\n   1.0;\n"
      "   1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;;\n  }}\n }}\n}}\n",
      vertex);
}

class IsolatedImport : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    test::write_text(folder_ / name, text);
    return folder_ / name;
  }
  static std::string error_of(const std::filesystem::path& path, const ImportOptions& options = {}) {
    return test::error_of([&] { import_model(path, options); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(IsolatedImport, ReadsWhatIsSound) {
  const Model model = import_model(write("sound.x", skinned_triangle(0)));
  ASSERT_EQ(model.meshes.size(), 1U);
  EXPECT_EQ(model.meshes[0].positions[1], glm::dvec3(1, 0, 0));
  EXPECT_EQ(model.meshes[0].influences.size(), 3U);
}

TEST_F(IsolatedImport, SurvivesACrash) {
  EXPECT_THAT(error_of(write("crash.x", skinned_triangle(900'000'000))),
              AllOf(HasSubstr("crash.x: the importer (assimp)"), HasSubstr("export it anew")));
}

TEST_F(IsolatedImport, EndsWhatTakesTooLong) {
  ImportOptions options;
  options.limits.seconds = 1;
  options.limits.factor = 0.5;  // no whole second is left
  EXPECT_THAT(error_of(write("slow.x", skinned_triangle(0)), options),
              AllOf(HasSubstr("not finished"), HasSubstr("'seconds' under [limits]")));
}

TEST_F(IsolatedImport, EndsWhatTakesTooMuchMemory) {
  ImportOptions options;
  options.limits.memory_mib = 8;  // less than the program itself needs, and far less than a sanitizer's
  EXPECT_THAT(error_of(write("large.x", skinned_triangle(0)), options), HasSubstr("memory_mib"));
}

TEST_F(IsolatedImport, RefusesLargeFilesUnread) {
  ImportOptions options;
  options.limits.file_mib = 1;
  options.limits.factor = 1e-3;
  const std::filesystem::path path = write("large.x", std::string(std::size_t{3} << 20, ' '));
  EXPECT_THAT(error_of(path, options), AllOf(HasSubstr("3 MiB"), HasSubstr("file_mib")));
}

// A pipe would be waited for, a folder is a sequence, a device has no end.
TEST_F(IsolatedImport, ReadsOnlyFiles) {
  std::filesystem::create_directory(folder_ / "folder.x");
  EXPECT_THAT(error_of(folder_ / "folder.x"), HasSubstr("folder without numbered"));
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.x");
  EXPECT_THAT(error_of(folder_ / "zero.x"), HasSubstr("not a file"));
}

// The way a server would call it: from several threads at once, while others allocate all the time.
TEST_F(IsolatedImport, IsSafeWithThreads) {
  const std::filesystem::path sound = write("sound.x", skinned_triangle(0));
  const std::filesystem::path crash = write("crash.x", skinned_triangle(900'000'000));
  std::atomic<bool> done = false;
  std::thread busy([&] {
    while (!done) std::string(1000, 'x').append(1000, 'y');
  });
  std::vector<std::thread> readers;
  std::atomic<int> read = 0, failed = 0;
  for (int i = 0; i < 4; ++i)
    readers.emplace_back([&, i] {
      try {
        read += import_model(i % 2 == 0 ? sound : crash).meshes.size() == 1 ? 1 : 0;
      } catch (const Error&) {
        ++failed;
      }
    });
  for (std::thread& reader : readers) reader.join();
  done = true;
  busy.join();
  EXPECT_EQ(read, 2);
  EXPECT_EQ(failed, 2);
}

// Programs that ignore SIGCHLD lose their children's statuses; then a crash is still an error, and a model a
// model.
TEST_F(IsolatedImport, NeedsNoStatusOfTheChild) {
  void (*const before)(int) = ::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(import_model(write("sound.x", skinned_triangle(0))).meshes.size(), 1U);
  EXPECT_THAT(error_of(write("crash.x", skinned_triangle(900'000'000))), HasSubstr("the importer (assimp)"));
  ::signal(SIGCHLD, before);
}

TEST_F(IsolatedImport, OrdersArriveAsTheyWereGiven) {
  ImportOptions options;
  options.metres_per_unit = 0.0254;
  options.up = "z";
  options.limits.keys = 7;
  const ImportOrder order = order_of(order_text("a folder/\xC3\xA4.fbx", options));
  EXPECT_EQ(order.path, "a folder/\xC3\xA4.fbx");
  EXPECT_EQ(order.options.metres_per_unit, 0.0254);
  EXPECT_EQ(order.options.up, "z");
  EXPECT_EQ(order.options.limits.keys, 7);
  EXPECT_EQ(order_of(order_text("x", {})).options.metres_per_unit, std::nullopt);
  EXPECT_THROW(order_of("short"), std::runtime_error);
}

// assimp 5.2.5 reads what lies behind the array in memory: garbage, other in every run, and no word of it.
TEST_F(IsolatedImport, ColladaAccessorsStayInTheirArrays) {
  const auto with = [&](const std::string& count, const std::string& stride) {
    return error_of(write("a.dae",
                          "<COLLADA><float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array>"
                          "<accessor source=\"#a\" count=\"" +
                              count + "\" stride=\"" + stride + "\"/></COLLADA>"));
  };
  EXPECT_THAT(with("3", "3"), testing::Not(HasSubstr("accessor")));
  EXPECT_THAT(with("4", "3"), HasSubstr("4 items of 3 numbers from 'a', which holds 9"));
  EXPECT_THAT(with("3", "4611686018427387905"),
              HasSubstr("accessor"));  // whose product with 3 is 3 in 64 bits
}

// Textures and material libraries: what lies outside the model's folder is not read, however it is named.
TEST_F(IsolatedImport, ReadsNothingOutsideTheFolder) {
  write("secret.mtl", "newmtl cloth\nKd 1 0 0\n");
  std::filesystem::create_directory(folder_ / "model");
  const auto colour_with = [&](const std::string& library) {
    test::write_text(folder_ / "model/m.obj",
                     fmt::format("mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl cloth\nf 1 2 3\n", library));
    return import_model(folder_ / "model/m.obj").materials.at(0).base_colour;
  };
  const glm::vec4 red(1, 0, 0, 1), none(1);
  EXPECT_EQ(colour_with("../secret.mtl"), none);
  EXPECT_EQ(colour_with((folder_ / "secret.mtl").string()), none);
  EXPECT_EQ(colour_with("%2e%2e/secret.mtl"), none);
  std::filesystem::create_symlink(folder_ / "secret.mtl", folder_ / "model/link.mtl");
  EXPECT_EQ(colour_with("link.mtl"), none);
  std::filesystem::copy(folder_ / "secret.mtl", folder_ / "model/own.mtl");
  EXPECT_EQ(colour_with("own.mtl"), red);
  // Another machine's path: the file of that name beside the model is meant.
  EXPECT_EQ(colour_with("C:\\work\\own.mtl"), red);
  // A model that is reached by a link stands where the link points.
  std::filesystem::create_directory_symlink(folder_ / "model", folder_ / "alias");
  EXPECT_EQ(import_model(folder_ / "alias/m.obj").materials.at(0).base_colour, red);
}

}  // namespace
}  // namespace plisse::io
