#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "benchmark/sections.h"
#include "io/import.h"
#include "scene/animation.h"
#include "support/files.h"

namespace plisse::benchmark {
namespace {

constexpr int bones = 100;

// The parts of a GLB: views of one buffer, an accessor each.
class Glb {
 public:
  template <typename Number>
  int add(const std::vector<Number>& values, int component, const char* type, std::size_t count) {
    const std::size_t bytes = values.size() * sizeof(Number), start = buffer_.size();
    buffer_.resize(start + (bytes + 3) / 4 * 4);
    std::memcpy(&buffer_[start], values.data(), bytes);
    views_ += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})", views_.empty() ? "" : ",",
                          start, bytes);
    accessors_ += fmt::format(R"({}{{"bufferView":{},"componentType":{},"count":{},"type":"{}"}})",
                              accessors_.empty() ? "" : ",", accessor_count_, component, count, type);
    return accessor_count_++;
  }
  std::string file(const std::string& rest) const {
    std::string json = fmt::format(
        R"({{"asset":{{"version":"2.0"}},{},"accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}})",
        rest, accessors_, views_, buffer_.size());
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string all;
    const auto number = [&](std::size_t value) {
      const auto bits = static_cast<std::uint32_t>(value);
      all.append(reinterpret_cast<const char*>(&bits), 4);
    };
    all += "glTF", number(2), number(28 + json.size() + buffer_.size());
    number(json.size()), all += "JSON" + json;
    number(buffer_.size()), all.append("BIN\0", 4) += buffer_;
    return all;
  }

 private:
  std::string buffer_, views_, accessors_;
  int accessor_count_ = 0;
};

// A sheet of side² vertices on a chain of a hundred bones that bend.
std::string skinned_sheet(int side) {
  std::vector<float> place, weight, inverse;
  std::vector<std::uint8_t> joint;
  std::vector<std::uint32_t> index;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(side - 1);
      place.insert(place.end(),
                   {u, static_cast<float>(y) / static_cast<float>(side - 1), 0.01F * std::sin(9 * u)});
      const float at = u * (bones - 1);
      const int bone = std::min(static_cast<int>(at), bones - 2);
      const auto id = static_cast<std::uint8_t>(bone), next = static_cast<std::uint8_t>(bone + 1);
      joint.insert(joint.end(), {id, next, 0, 0});
      const float part = at - static_cast<float>(bone);
      weight.insert(weight.end(), {1 - part, part, 0, 0});
      if (x + 1 == side || y + 1 == side) continue;
      const auto a = static_cast<std::uint32_t>(y * side + x), up = a + static_cast<std::uint32_t>(side);
      index.insert(index.end(), {a, a + 1, up + 1, a, up + 1, up});
    }
  std::string nodes = R"({"mesh":0,"skin":0})", joints, channels;
  for (int b = 0; b < bones; ++b) {
    inverse.insert(inverse.end(),
                   {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -static_cast<float>(b) / bones, 0, 0, 1});
    nodes += fmt::format(R"(,{{"translation":[{},0,0]{}}})", b > 0 ? 1.0 / bones : 0.0,
                         b + 1 < bones ? fmt::format(R"(,"children":[{}])", b + 2) : "");
    joints += fmt::format("{}{}", b > 0 ? "," : "", b + 1);
    channels +=
        fmt::format(R"({}{{"sampler":0,"target":{{"node":{},"path":"rotation"}}}})", b > 0 ? "," : "", b + 1);
  }
  Glb glb;
  constexpr int floats = 5126, bytes = 5121, integers = 5125;
  const std::size_t n = place.size() / 3;
  const int p = glb.add(place, floats, "VEC3", n), w = glb.add(weight, floats, "VEC4", n);
  const int j = glb.add(joint, bytes, "VEC4", n), i = glb.add(index, integers, "SCALAR", index.size());
  const int m = glb.add(inverse, floats, "MAT4", bones);
  const int t = glb.add<float>({0, 1}, floats, "SCALAR", 2);
  const int r = glb.add<float>({0, 0, 0, 1, 0, std::sin(0.02F), 0, std::cos(0.02F)}, floats, "VEC4", 2);
  return glb.file(fmt::format(
      R"("scene":0,"scenes":[{{"nodes":[0,1]}}],"nodes":[{}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{},
"WEIGHTS_0":{},"JOINTS_0":{}}},"indices":{}}}]}}],"skins":[{{"joints":[{}],"inverseBindMatrices":{}}}],
"animations":[{{"samplers":[{{"input":{},"output":{}}}],"channels":[{}]}}])",
      nodes, p, w, j, i, joints, m, t, r, channels));
}

}  // namespace

// One skinned sheet, finer and finer, from file to the welded surface.
void measure_import(Report& report, const Effort& effort) {
  Table table{
      "Importing a model",
      "A GLB of one skinned sheet on 100 bones. Reading: in the child process, checked, and handed over; "
      "welding: to the surface that the passes work on. Wall clock. Peak memory is the reader's. The last "
      "two "
      "columns are seconds and memory a triangle against the first row's: 1 is linear.",
      {"triangles", "file MiB", "reading s", "welding s", "peak MiB", "s / triangle", "MiB / triangle"},
      {}};
  std::array<double, 2> first{};
  for (const int side : {178, 355, 709}) {
    const double triangles = 2.0 * (side - 1) * (side - 1);
    if (triangles > 12 * static_cast<double>(effort.grid_vertices)) break;
    const test::TemporaryFolder folder;
    const std::string file = skinned_sheet(side);
    test::write_text(folder / "sheet.glb", file);
    std::vector<double> reading, welding;
    for (int run = 0; run < std::min(effort.samples, 5); ++run) {
      const Sample begin = now();
      const io::Model model = io::import_model(folder / "sheet.glb");
      const Sample read = now();
      const scene::Animation animation(model, {});
      welding.push_back((now() - read).wall_s);
      reading.push_back((read - begin).wall_s);
    }
    // Of all children so far, of which this was the largest.
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const double peak = static_cast<double>(usage.ru_maxrss) / 1024;
    const Distribution read = distribution(reading), weld = distribution(welding);
    const std::array<double, 2> each{(read.median + weld.median) / triangles, peak / triangles};
    if (first[0] == 0) first = each;
    table.rows.push_back({Cell(triangles, 0), Cell(static_cast<double>(file.size()) / (1 << 20), 1),
                          Cell(read, 3), Cell(weld, 3), Cell(peak, 0), Cell(each[0] / first[0], 2),
                          Cell(each[1] / first[1], 2)});
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
