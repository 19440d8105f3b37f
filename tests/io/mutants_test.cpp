// More than 2000 damaged files, the same in every run: whatever a reader makes of them, it ends in an Error
// or in a model that validates; without a crash, in less than 5 seconds each and 1 GiB in all. Our own
// readers run right here, where sanitizers look on; assimp's formats in a child that takes one after the
// other and is started again when assimp has crashed. libFuzzer goes further from here (tests/fuzz).
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>

#include "base/error.h"
#include "base/log.h"
#include "io/read_model.h"
#include "support/files.h"
#include "support/mutants.h"
#include "support/readers.h"

namespace plisse::io {
namespace {

using test::mutant_of;

class Mutants : public testing::Test {
 protected:
  void SetUp() override { log::set_level(log::Level::quiet); }
  void TearDown() override {
    log::set_level(log::Level::normal);
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 1 << 20) << "KiB";
  }

  // The file is read as it is, and then damaged in `count` ways; only an Error may come of those.
  using Reader = void (*)(std::string_view bytes, const std::filesystem::path& folder);
  void survive(const std::string& original, int count, Reader read) const {
    ASSERT_NO_THROW(read(original, folder_.path())) << "the file is to be sound before it is damaged";
    int refused = 0;
    for (int seed = 0; seed < count; ++seed) {
      const auto start = std::chrono::steady_clock::now();
      try {
        read(mutant_of(original, static_cast<std::uint32_t>(seed)), folder_.path());
      } catch (const Error&) {
        ++refused;
      } catch (const std::exception& error) {
        ADD_FAILURE() << "mutant " << seed << ": " << error.what();
      }
      EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << "mutant " << seed;
    }
    EXPECT_GT(refused, count / 10) << "the damage is too small to test anything";
  }

  test::TemporaryFolder folder_;
};

TEST_F(Mutants, Obj) {
  test::write_text(folder_ / "m.mtl", "newmtl cloth\nKd 1 0 0\nmap_Kd t.png\n");
  survive(
      "mtllib m.mtl\nv 0 0 0\nv 2 0 0\nv 2 1 0.5\nv 0 1 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\no sheet\n"
      "usemtl cloth\nf 1/1/1 2/2/1 3/3/1 4/1/1\ng more\nf -4 -3 -2\nf 1//1 3//1 4//1\n",
      400, test::read_as_model);
}

template <typename Number>
void append(std::string& bytes, std::initializer_list<Number> numbers) {
  for (const Number number : numbers) bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

TEST_F(Mutants, Ply) {
  const std::string header =
      " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  survive("ply\nformat ascii" + header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 400, test::read_as_model);
  std::string binary = "ply\nformat binary_little_endian" + header;
  append<float>(binary, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  append<std::uint8_t>(binary, {3});
  append<std::int32_t>(binary, {0, 1, 2});
  survive(binary, 400, test::read_as_model);
}

TEST_F(Mutants, Gltf) {
  survive(test::read_text(test::asset("square.glb")), 400, test::read_as_model);
}

TEST_F(Mutants, PointCaches) {
  std::string pc2("POINTCACHE2\0", 12);
  append<std::int32_t>(pc2, {1, 3});  // version, vertices
  append<float>(pc2, {0, 1});         // first frame, frames a sample
  append<std::int32_t>(pc2, {2});
  for (int f = 0; f < 2; ++f) append<float>(pc2, {0, 0, 0, 1, 0, 0, 0, 1, 0.5});
  survive(pc2, 200, test::read_as_point_cache);
  std::string mdd;
  append<std::uint32_t>(mdd,
                        {0x01000000, 0x03000000, 0});  // one frame, three vertices, at time 0: big-endian
  append<float>(mdd, {0, 0, 0, 0, 0, 0, 0, 0, 0});
  survive(mdd, 200, test::read_as_point_cache);
}

TEST_F(Mutants, Scenes) {
  test::write_text(folder_ / "sleeve.glb", "not read here");
  survive(test::read_text(test::asset("sleeve.toml")), 400, test::read_as_scene);
}

TEST_F(Mutants, Fields) {
  survive(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
      "property double amplitude\nelement face 1\nproperty list uchar int vertex_indices\n"
      "property list uchar double phase\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2 3 0 1 2\n",
      400, test::read_as_field);
  survive("0.1\n0.1\n0\n0.2\n#\n0\n1\n2\n3\n#\n1\n2\n3\n1\n1\n", 400, test::read_as_field);
}

const std::string x_file =
    "xof 0303txt 0032\nAnimTicksPerSecond {\n 24;\n}\nFrame Root {\n FrameTransformMatrix {\n"
    "  1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,5.0,0.0,0.0,1.0;;\n }\n Mesh Sheet {\n  4;\n  "
    "0.0;0.0;0.0;,\n"
    "  2.0;0.0;0.0;,\n  2.0;1.0;0.5;,\n  0.0;1.0;0.5;;\n  2;\n  3;0;1;2;,\n  3;0;2;3;;\n  SkinWeights {\n   "
    "\"Root\";\n"
    "   2;\n   0,\n   1;\n   1.0,\n   1.0;\n"
    "   1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;;\n  }\n }\n}\n"
    "AnimationSet Walk {\n Animation {\n  { Root }\n  AnimationKey {\n   2;\n   2;\n   0;3;0.0,0.0,0.0;;,\n"
    "   24;3;1.0,0.0,0.0;;;\n  }\n }\n}\n";

const std::string collada =
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\">"
    "<asset><unit meter=\"0.01\" name=\"cm\"/><up_axis>Z_UP</up_axis></asset><library_geometries>"
    "<geometry id=\"g\" name=\"sheet\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"9\">0 0 0 1 0 0 "
    "0 1 0"
    "</float_array><technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\" "
    "type=\"float\"/>"
    "<param name=\"Y\" type=\"float\"/><param name=\"Z\" "
    "type=\"float\"/></accessor></technique_common></source>"
    "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\">"
    "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>"
    "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\" name=\"n\">"
    "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
    "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";

// What the child says, a byte each: a mutant begins, assimp is at work, our own code is.
int said_to = -1;
void say(char what) {
  if (::write(said_to, &what, 1) != 1) ::_exit(1);
}

// Reads mutants `first` to `count` − 1 in a child that may die on the way; its words come back.
std::string words_of_child(const std::filesystem::path& path, const std::string& original, int first,
                           int count, int& status) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();  // the test has one thread
  if (child == 0) {
    ::close(ends[0]);
    said_to = ends[1];
    // A crash of assimp is what this is for; no report about each.
    for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE}) ::signal(number, SIG_DFL);
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
#ifndef __SANITIZE_ADDRESS__
    const rlimit memory{rlim_t{1} << 30, rlim_t{1} << 30};
    ::setrlimit(RLIMIT_AS, &memory);
#endif
    on_note_reader([](const char* who) { say(*who == '\0' ? 'o' : 'a'); });
    for (int seed = first; seed < count; ++seed) {
      say('m');
      ::alarm(5);
      try {
        test::write_text(path, mutant_of(original, static_cast<std::uint32_t>(seed)));
        validate(read_model(path, {}));
      } catch (const std::exception&) {
      }
    }
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string words;
  char buffer[4096];
  for (ssize_t size; (size = ::read(ends[0], buffer, sizeof buffer)) > 0;)
    words.append(buffer, static_cast<std::size_t>(size));
  ::close(ends[0]);
  ::waitpid(child, &status, 0);
  return words;
}

class AssimpMutants : public Mutants,
                      public testing::WithParamInterface<std::pair<const char*, const std::string*>> {};

TEST_P(AssimpMutants, CrashOnlyInAssimp) {
  const auto& [name, original] = GetParam();
  test::write_text(folder_ / name, *original);
  ASSERT_NO_THROW(validate(read_model(folder_ / name, {}))) << "the file is to be sound before it is damaged";
  constexpr int count = 300;
  int crashes = 0;
  for (int seed = 0; seed < count;) {
    int status = 0;
    const std::string words = words_of_child(folder_ / name, *original, seed, count, status);
    seed += static_cast<int>(std::count(words.begin(), words.end(), 'm'));
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
    ++crashes;
    ASSERT_FALSE(words.empty()) << "the child died before it began";
    EXPECT_EQ(words.back(), 'a') << "mutant " << seed - 1 << " brought our own code down, status " << status;
    EXPECT_FALSE(WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
        << "mutant " << seed - 1 << " takes over 5 s";
  }
  RecordProperty("crashes_of_assimp", crashes);
}

INSTANTIATE_TEST_SUITE_P(Of, AssimpMutants,
                         testing::Values(std::pair("m.x", &x_file), std::pair("m.dae", &collada)),
                         [](const auto& format) { return std::string(format.param.first + 2); });

}  // namespace
}  // namespace plisse::io
