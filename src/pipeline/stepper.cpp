#include "pipeline/stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"

namespace plisse::pipeline {

passes::RelaxOptions relax_options(const config::RelaxSettings& settings) {
  passes::RelaxOptions options;
  options.rounds = settings.rounds;
  options.epsilon = settings.epsilon;
  options.onset = settings.mode == config::RelaxMode::smooth;
  options.onset_rounds = settings.onset_rounds;
  options.smoothing_rounds = settings.smoothing_rounds;
  return options;
}

Stepper::Stepper(LoadedScene& scene, gpu::StageTimer& timer, const std::string& shader_folder)
    : scene_(scene),
      settings_(scene.settings.relax),
      timer_(timer),
      surface_(scene.surface(), scene.rest, scene.waves, scene.units, scene.settings.wrinkles.seed),
      skin_(scene.pose(1).palette.size(), scene.surface().target_count, shader_folder),
      crush_(shader_folder),
      relax_(shader_folder),
      remembered_phases_(surface_.phases.bytes()),
      remembered_states_(surface_.states.bytes()) {}

bool Stepper::crush_runs_at(int step) const {
  return (scene_.frame_of_step(step) - 1) % settings_.interval == 0;
}

void Stepper::skin(const scene::Pose& pose) {
  timer_.begin("skin");
  if (!pose.cache.empty()) {
    std::vector<glm::vec4> positions;
    positions.reserve(pose.cache.size());
    for (const auto& x : pose.cache) positions.emplace_back(glm::vec3(scene_.units.world(x)), 1.0F);
    skin_.run_cache(surface_, positions);
  } else {
    std::vector<glm::dmat4> palette;
    palette.reserve(pose.palette.size());
    for (const auto& m : pose.palette) palette.push_back(scene_.units.matrix(m));
    skin_.run(surface_, palette, pose.morph_weights);
  }
  timer_.end();
}

void Stepper::crush() {
  timer_.begin("crush");
  crush_.run(surface_, scene_.settings.wrinkles.dead_zone, settings_.mode == config::RelaxMode::descent,
             scene_.waves.unstrained);
  timer_.end();
}

void Stepper::relax() {
  timer_.begin("relax");
  descended_ = !relax_.idle(surface_);
  if (descended_)
    relax_.run(surface_, relax_options(settings_));
  else
    ++idle_relaxations_;
  timer_.end();
}

void Stepper::leave_out_masked() {
  all_masked_ = std::ranges::none_of(scene_.waves.mask, [](double mask) { return mask > 0; });
  const std::uint32_t any_height = 0;
  if (all_masked_) surface_.counter.write(&any_height, sizeof any_height, 2 * sizeof any_height);
}

double Stepper::last_round_moved() const {
  const auto now = surface_.phases.read<glm::vec2>(), before = surface_.phases_next.read<glm::vec2>();
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (now[v].y != 1) continue;  // set
    const double turn = std::remainder(static_cast<double>(now[v].x) - before[v].x, 2 * glm::pi<double>());
    sum += turn * turn;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

void Stepper::observe(Stage stage) const {
  if (observer) observer(stage);
}

bool Stepper::advance_to(int step) {
  double told = wall_seconds();
  while (step_ < step) {
    if (interrupted()) return false;
    if (const double now = wall_seconds(); now - told > 2) {
      log::notice(fmt::format("stepping through the frames before: {} of {}", step_, step));
      told = now;
    }
    const scene::Pose& pose = scene_.pose(step_ + 1);
    ++step_;
    const double share = scene_.lead_at(step_);
    const bool moved = !last_pose_ || *last_pose_ != pose;
    // With an interval, a pose that does not change may differ from the last one that was crushed.
    const bool crushes =
        crush_runs_at(step_) && (scene_.has_bias_a_frame() || !crushed_pose_ || *crushed_pose_ != pose);
    if (moved) {
      skin(pose);
      observe(Stage::posed);
      last_pose_ = pose;
    }
    descended_ = false;
    if (crushes && all_masked_) {
      ++masked_steps_;
      crushed_pose_ = pose;
    } else if (crushes) {
      if (scene_.has_bias_a_frame()) {
        const RestFrames posed = scene_.take_bias(step_);
        surface_.take_bias(scene_.waves, scene_.rest, posed, scene_.units);
      }
      crush();
      observe(Stage::crushed);
      if (share > 0) relax_.begin_as(surface_, remembered_phases_, remembered_states_);
      observe(Stage::begun);
      relax();
      observe(Stage::relaxed);
      crushed_pose_ = pose;
    }
    if (share > 0) {
      relax_.lead(surface_, remembered_phases_, remembered_states_, share);
      observe(Stage::led);
      descended_ = false;
    }
    field_due_ = field_due_ || moved || !scene_.carries_one_field();
    unchanged_ = !moved && !crushes && !(share > 0);
    if (unchanged_) ++unchanged_steps_;
    if (scene_.remembers_at(step_)) {
      remembered_phases_.write(surface_.phases.read<std::uint8_t>());
      remembered_states_.write(surface_.states.read<std::uint8_t>());
    }
    scene_.drop_poses_before(step_);
  }
  if (scene_.has_field_a_frame() && field_due_) {
    scene_.take_field(step_);
    surface_.carry(scene_.waves.field, scene_.units);
    field_due_ = unchanged_ = false;
  }
  return true;
}

namespace {
constexpr char magic[8] = {'p', 'l', 'i', 's', 's', 'e', 's', '1'};

struct StateHeader {
  char magic[8];
  std::int32_t step;
  std::uint32_t vertices;
  char key[32];    // of everything that the state depends on
  char check[32];  // of the bytes that follow
};

Hash keyed(Hash history, const Hash& driver) {
  return history.add(driver.hex());
}
}  // namespace

void Stepper::write_state(const std::filesystem::path& path, const Hash& driver) {
  std::vector<std::uint8_t> content;
  for (const gpu::Buffer* buffer :
       {&surface_.states, &surface_.waves, &surface_.phases, &surface_.world_waves, &surface_.positions,
        &surface_.frames, &remembered_phases_, &remembered_states_}) {
    const auto bytes = buffer->read<std::uint8_t>();
    content.insert(content.end(), bytes.begin(), bytes.end());
  }
  StateHeader header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.step = step_;
  header.vertices = static_cast<std::uint32_t>(surface_.vertex_count);
  std::memcpy(header.key, keyed(scene_.state_hash(step_), driver).hex().data(), 32);
  Hash check;
  check.add_bytes(content);
  std::memcpy(header.check, check.hex().data(), 32);
  std::vector<std::uint8_t> file(sizeof header + content.size());
  std::memcpy(file.data(), &header, sizeof header);
  std::memcpy(file.data() + sizeof header, content.data(), content.size());
  write_whole_file(path, file);
}

bool Stepper::read_state(const std::filesystem::path& path, const Hash& driver, int last_usable_step) {
  if (!std::filesystem::exists(path)) return false;
  const auto refuse = [&](const std::string& why) {
    log::warn(fmt::format("{}: {}; stepping from the clip's start instead", path.string(), why));
    return false;
  };
  const auto file = read_whole_file(path);
  StateHeader header{};
  if (file.size() < sizeof header) return refuse("not a state file of plisse");
  std::memcpy(&header, file.data(), sizeof header);
  if (std::memcmp(header.magic, magic, sizeof magic) != 0)
    return refuse("not a state file of this version of plisse");
  const std::span<const std::uint8_t> content(file.data() + sizeof header, file.size() - sizeof header);
  Hash check;
  check.add_bytes(content);
  if (check.hex() != std::string(header.check, 32)) return refuse("damaged (its check sum is wrong)");
  if (header.vertices != surface_.vertex_count || header.step < 1 ||
      header.step > scene_.step_of_frame(scene_.animation.timeline().frame_count)) {
    return refuse("made from another model");
  }
  if (header.step > last_usable_step) return refuse("made after the first frame that is wanted");
  if (std::string(header.key, 32) != keyed(scene_.state_hash(header.step), driver).hex()) {
    return refuse("made with other settings, another model or another driver");
  }
  std::size_t at = 0;
  for (gpu::Buffer* buffer :
       {&surface_.states, &surface_.waves, &surface_.phases, &surface_.world_waves, &surface_.positions,
        &surface_.frames, &remembered_phases_, &remembered_states_}) {
    if (at + buffer->bytes() > content.size()) return refuse("too short");
    buffer->write(content.data() + at, buffer->bytes());
    at += buffer->bytes();
  }
  // Other results of crush.
  const auto waves = surface_.waves.read<glm::vec4>();
  const std::uint32_t any_height =
      std::ranges::any_of(waves, [](const glm::vec4& wave) { return wave.z > 0; });
  surface_.counter.write(&any_height, sizeof any_height, 2 * sizeof any_height);
  step_ = header.step;
  field_due_ = true;
  last_pose_ = scene_.pose(step_);
  int crushed = step_;
  while (!crush_runs_at(crushed)) --crushed;
  crushed_pose_ = scene_.pose(crushed);
  unchanged_ = false;
  scene_.drop_poses_before(step_);
  return true;
}

}  // namespace plisse::pipeline
