// Hard cases of whole scenes: file contents that must not reach the passes.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "bench/bench.h"
#include "bench/hard.h"
#include "config/scene_file.h"
#include "gpu/context.h"
#include "gpu/timer.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/reference_scene.h"
#include "pipeline/stepper.h"

namespace plisse::bench {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() : path_(fs::temp_directory_path() / fmt::format("plisse-hard-{}", ::getpid())) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

std::uint32_t word_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

// A GLB of floats whose first turning bone has a key that is none; its number.
std::size_t spoil_a_key(std::vector<std::uint8_t>& glb) {
  const std::size_t text_size = word_at(glb, 12), binary = 20 + text_size + 8;
  const auto json =
      nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + static_cast<std::ptrdiff_t>(text_size));
  const auto& animation = json.at("animations").at(0);
  for (const auto& channel : animation.at("channels")) {
    if (channel.at("target").at("path") != "rotation") continue;
    const auto& sampler = animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
    const auto& accessor = json.at("accessors").at(sampler.at("output").get<std::size_t>());
    const auto& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const std::size_t key = accessor.at("count").get<std::size_t>() / 2;
    const std::size_t at = binary + view.value("byteOffset", std::size_t{0}) +
                           accessor.value("byteOffset", std::size_t{0}) +
                           key * view.value("byteStride", 4 * sizeof(float)) + sizeof(float);
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(glb.data() + at, &nothing, sizeof nothing);
    return key;
  }
  throw Error(ExitCode::bad_input, "sleeve.glb: no bone turns");
}

// The sleeve with one key of its elbow gone.
Verdict nan_in_a_key() {
  const TemporaryFolder folder;
  auto glb = read_whole_file(find_assets() / "sleeve.glb");
  const std::size_t key = spoil_a_key(glb);
  write_whole_file(folder / "spoiled.glb", glb);
  config::SceneSettings settings = config::load_scene((find_assets() / "sleeve.toml").string());
  settings.model.path = (folder / "spoiled.glb").string();
  settings.model.loop = false;
  const gpu::Context context;
  gpu::StageTimer timer(true);
  pipeline::LoadedScene scene(settings);
  pipeline::Stepper stepper(scene, timer, "");
  const int frames = scene.animation.timeline().frame_count;
  Eigen::Matrix3Xd before;
  int held = 0;
  for (int frame = 1; frame <= frames; ++frame) {
    stepper.advance_to(scene.step_of_frame(frame));
    const auto now = pipeline::read_snapshot(stepper.surface());
    if (!now.positions.allFinite() || !now.heights.allFinite() || !now.phases.allFinite())
      return {false, fmt::format("frame {} is not finite", frame)};
    held += before.cols() > 0 && before == now.positions ? 1 : 0;
    before = now.positions;
  }
  // Two keys meet in the one between them, and nothing else stands still for longer than that.
  return {held >= 1 && held <= frames / 4,
          fmt::format("key {} is not a number: all {} frames finite, {} of them as the one before", key,
                      frames, held)};
}

}  // namespace

std::vector<HardCase> hard_scenes() {
  return {{"passes", "NaN in one key of an animation",
           "finite frames; the last good pose is held, and only as long", true, nan_in_a_key}};
}

}  // namespace plisse::bench
