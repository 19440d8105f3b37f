// MDD: big-endian; int32 frames, int32 points, float times[frames] in seconds, then float
// xyz[frames][points]. PC2: little-endian; "POINTCACHE2\0", int32 version 1, int32 points, float first frame,
// float frames a sample, int32 samples, then float xyz[samples][points].
#include "io/point_cache.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <mutex>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "io/import_place.h"

namespace plisse::io {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr double default_frames_per_second = 24;

struct Layout {
  std::uint64_t points = 0, frames = 0;
  std::uint64_t start = 0;  // of the first position, bytes
  double frames_per_second = default_frames_per_second;
  bool big_endian = false;
  std::vector<double> times = {};  // the file's own, where it has usable ones
};

std::uint32_t word_of(const char* bytes, bool big_endian) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return big_endian ? __builtin_bswap32(word) : word;
}

float float_of(const char* bytes, bool big_endian) {
  return std::bit_cast<float>(word_of(bytes, big_endian));
}

class File {
 public:
  explicit File(const std::filesystem::path& path) : path_(path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
      throw Error(ExitCode::bad_input, fmt::format("{}: no such file", path.string()));
    size_ = std::filesystem::file_size(path, error);
    stream_.open(path, std::ios::binary);
    if (error || !stream_) throw Error(ExitCode::bad_input, fmt::format("{}: cannot be read", path.string()));
  }

  std::uint64_t size() const { return size_; }

  void read(std::uint64_t at, std::span<char> bytes) {
    std::lock_guard lock(mutex_);
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (stream_.gcount() != static_cast<std::streamsize>(bytes.size())) fail("ends early");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", path_.string(), what));
  }

 private:
  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::mutex mutex_;
};

Layout pc2_layout(File& file) {
  std::array<char, 32> head{};
  if (file.size() < head.size()) file.fail("too short for a PC2 point cache");
  file.read(0, head);
  if (std::memcmp(head.data(), "POINTCACHE2", 12) != 0)
    file.fail("not a PC2 point cache: it does not begin with POINTCACHE2");
  if (const std::uint32_t version = word_of(&head[12], false); version != 1)
    file.fail(fmt::format("a PC2 point cache of version {}; this program reads version 1", version));
  const auto step = static_cast<double>(float_of(&head[24], false));
  if (!(step > 0) || !std::isfinite(step))
    file.fail(fmt::format("a PC2 point cache with a sample every {} frames", step));
  return {word_of(&head[16], false), word_of(&head[28], false), head.size(), default_frames_per_second / step,
          false};
}

// All times of an MDD, from the first on; none where they do not increase.
void read_times(File& file, Layout& layout) {
  std::vector<char> bytes(4 * static_cast<std::size_t>(layout.frames));
  file.read(8, bytes);
  for (std::size_t f = 0; f < layout.frames; ++f) {
    const auto time = static_cast<double>(float_of(&bytes[4 * f], true));
    const double from = static_cast<double>(float_of(bytes.data(), true));
    if (!std::isfinite(time) || (f > 0 && time - from <= layout.times.back())) {
      layout.times.clear();
      return;
    }
    layout.times.push_back(time - from);
  }
}

Layout mdd_layout(File& file) {
  std::array<char, 8> head{};
  if (file.size() < head.size()) file.fail("too short for an MDD point cache");
  file.read(0, head);
  Layout layout{word_of(&head[4], true), word_of(head.data(), true), 0, default_frames_per_second, true};
  layout.start = head.size() + 4 * layout.frames;
  if (layout.frames > 1 && layout.start <= file.size()) {
    std::array<char, 4> first{}, last{};
    file.read(head.size(), first);
    file.read(layout.start - 4, last);
    const double duration =
        static_cast<double>(float_of(last.data(), true)) - static_cast<double>(float_of(first.data(), true));
    // Some writers leave the times 0: then the default rate stands.
    if (duration > 0 && std::isfinite(duration)) {
      layout.frames_per_second = static_cast<double>(layout.frames - 1) / duration;
      read_times(file, layout);
    }
  }
  return layout;
}

class PointFrames : public FrameSource {
 public:
  PointFrames(const std::filesystem::path& path, const Model& model) : file_(path) {
    const std::string ending = lower_case(path.extension().string());
    if (ending != ".mdd" && ending != ".pc2") file_.fail("not a point cache this program reads: MDD or PC2");
    layout_ = ending == ".pc2" ? pc2_layout(file_) : mdd_layout(file_);
    if (layout_.frames == 0) file_.fail("a point cache without frames");
    find_places(model);
    // After this 12·points·frames cannot run over: points is a mesh's, frames has 32 bits.
    if (layout_.points != expected_)
      file_.fail(fmt::format("{} points a frame, but {} has {} vertices", layout_.points, model.path.string(),
                             expected_));
    const std::uint64_t whole = layout_.start + 12 * layout_.points * layout_.frames;
    if (file_.size() < whole)
      file_.fail(fmt::format("cut off: {} frames of {} points take {} bytes, it has {}", layout_.frames,
                             layout_.points, whole, file_.size()));
  }

  double frames_per_second() const { return layout_.frames_per_second; }
  std::vector<double> times() const {
    std::vector<double> times = layout_.times;
    for (std::size_t f = times.size(); f < count(); ++f)
      times.push_back(static_cast<double>(f) / layout_.frames_per_second);
    return times;
  }
  std::size_t count() const override { return static_cast<std::size_t>(layout_.frames); }

  std::vector<glm::dvec3> read(std::size_t frame) const override {
    std::vector<char> bytes(12 * static_cast<std::size_t>(layout_.points));
    file_.read(layout_.start + bytes.size() * frame, bytes);
    std::vector<glm::dvec3> positions;
    positions.reserve(places_.size());
    for (const Place& place : places_) {
      const char* at = &bytes[12 * std::size_t{place.number}];
      glm::dvec4 point(0, 0, 0, 1);
      for (int axis = 0; axis < 3; ++axis)
        point[axis] = static_cast<double>(float_of(at + 4 * axis, layout_.big_endian));
      positions.emplace_back(matrices_[place.mesh] * point);
    }
    return positions;
  }

 private:
  // Where a vertex of the model comes from.
  struct Place {
    std::uint32_t number, mesh;
  };

  void find_places(const Model& model) {
    std::vector<glm::dmat4> world;
    std::vector<int> uses(model.meshes.size(), 0);
    matrices_.assign(model.meshes.size(), glm::dmat4{1});
    for (const Node& node : model.nodes) {
      world.push_back(node.parent < 0 ? node.local
                                      : world[static_cast<std::size_t>(node.parent)] * node.local);
      for (const int mesh : node.meshes) {
        matrices_[static_cast<std::size_t>(mesh)] = world.back();
        if (++uses[static_cast<std::size_t>(mesh)] > 1)
          file_.fail(fmt::format("mesh '{}' of {} stands in several places; a point cache moves one",
                                 model.meshes[static_cast<std::size_t>(mesh)].name, model.path.string()));
      }
    }
    // Whoever numbers vertices has also put them into the world (model.h).
    const bool numbered = model.file_vertex_count > 0;
    const std::string ending = lower_case(model.path.extension().string());
    if (!numbered && ending != ".glb" && ending != ".gltf")
      file_.fail(fmt::format(
          "{} does not keep the numbers that vertices had where it was exported; export the mesh as "
          "OBJ or PLY, or the animation with it",
          model.path.string()));
    expected_ = model.file_vertex_count;
    for (std::uint32_t m = 0; m < model.meshes.size(); ++m) {
      const Mesh& mesh = model.meshes[m];
      if (numbered) matrices_[m] = file_to_world(model.up, model.metres_per_unit);
      for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        places_.push_back({numbered ? mesh.file_vertices[v] : static_cast<std::uint32_t>(expected_ + v), m});
      if (!numbered) expected_ += mesh.positions.size();
    }
  }

  mutable File file_;
  Layout layout_;
  std::uint64_t expected_ = 0;
  std::vector<Place> places_;
  std::vector<glm::dmat4> matrices_;  // of each mesh: cache → world
};

void append_word(std::vector<std::uint8_t>& bytes, std::uint32_t word, bool big_endian) {
  for (int i = 0; i < 4; ++i)
    bytes.push_back(static_cast<std::uint8_t>(word >> (big_endian ? 24 - 8 * i : 8 * i)));
}

// Or a PC2, which holds one step for all. Throws Error(bad_input).
bool is_mdd(const std::filesystem::path& path, const std::vector<double>& times) {
  const std::string ending = lower_case(path.extension().string());
  if (ending == ".mdd") return true;
  if (ending != ".pc2")
    throw Error(ExitCode::bad_input,
                fmt::format("{}: point caches are written as .pc2 or .mdd", path.string()));
  for (std::size_t i = 2; i < times.size(); ++i) {
    // A thousandth of a frame: what frames_per_second itself is good for.
    if (std::abs((times[i] - times[i - 1]) - (times[1] - times[0])) > 1e-3 * (times[1] - times[0])) {
      throw Error(ExitCode::bad_input,
                  fmt::format("{}: a PC2 has one step for all frames; choose them evenly, or write an MDD",
                              path.string()));
    }
  }
  return false;
}

}  // namespace

PointCacheWriter::PointCacheWriter(const std::filesystem::path& path, std::size_t points,
                                   std::vector<double> times)
    : path_(path), points_(points), frames_(times.size()), big_endian_(is_mdd(path, times)), file_(path) {
  std::vector<std::uint8_t> head;
  const auto put = [&](std::uint32_t word) { append_word(head, word, big_endian_); };
  const auto put_float = [&](double value) { put(std::bit_cast<std::uint32_t>(static_cast<float>(value))); };
  const auto points_word = static_cast<std::uint32_t>(points),
             frames_word = static_cast<std::uint32_t>(frames_);
  if (big_endian_) {
    put(frames_word);
    put(points_word);
    for (const double time : times) put_float(time);
  } else {
    const char name[12] = "POINTCACHE2";
    head.insert(head.end(), name, name + 12);
    put(1);
    put(points_word);
    put_float(default_frames_per_second * times.front());
    put_float(times.size() > 1 ? default_frames_per_second * (times[1] - times[0]) : 1);
    put(frames_word);
  }
  file_.append(head);
}

void PointCacheWriter::add(std::span<const glm::dvec3> positions) {
  if (positions.size() != points_ || added_ == frames_) {
    throw Error(ExitCode::no_output,
                fmt::format("{}: frame {} has {} points; there are to be {} frames of {}", path_.string(),
                            added_ + 1, positions.size(), frames_, points_));
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(12 * positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<float>(positions[i][axis]);
      if (!std::isfinite(value)) {
        throw Error(ExitCode::no_output,
                    fmt::format("{}: point {} of frame {} is not finite", path_.string(), i, added_ + 1));
      }
      append_word(bytes, std::bit_cast<std::uint32_t>(value), big_endian_);
    }
  }
  file_.append(bytes);
  ++added_;
}

void PointCacheWriter::commit() {
  if (added_ != frames_) {
    throw Error(ExitCode::no_output,
                fmt::format("{}: {} of {} frames are there", path_.string(), added_, frames_));
  }
  file_.commit();
}

VertexCache read_point_cache(const std::filesystem::path& path, const Model& model) {
  const auto frames = std::make_shared<const PointFrames>(path, model);
  VertexCache cache(frames, frames->frames_per_second());
  cache.set_times(frames->times());
  return cache;
}

}  // namespace plisse::io
