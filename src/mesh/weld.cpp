// Welding over a hash grid whose cells are a few tolerances wide, so that nearly every vertex looks into one
// cell. Cells are not kept apart by more than their hash: `same` looks at the places themselves.
#include "mesh/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace plisse {
namespace {

// Skin weights are stored in 8 or 16 bits or as decimal text; copies of a vertex agree far better than that.
constexpr float weight_tolerance = 1e-4F;

bool same_influences(const PaletteInfluences& a, const PaletteInfluences& b) {
  // Entries may stand in different order where weights are equal, so they are looked up, not compared in
  // place.
  const auto weight_in = [](const PaletteInfluences& influences, std::uint32_t entry) {
    float sum = 0;
    for (std::size_t i = 0; i < influences.entry.size(); ++i)
      if (influences.entry[i] == entry) sum += influences.weight[i];
    return sum;
  };
  for (std::size_t i = 0; i < a.entry.size(); ++i) {
    if (a.weight[i] > 0 && std::abs(weight_in(a, a.entry[i]) - weight_in(b, a.entry[i])) > weight_tolerance)
      return false;
    if (b.weight[i] > 0 && std::abs(weight_in(a, b.entry[i]) - weight_in(b, b.entry[i])) > weight_tolerance)
      return false;
  }
  return true;
}

constexpr std::uint32_t none = 0xFFFFFFFF;

// Lists of welded ids by cell: the newest of each bucket, and each one's elder.
class Grid {
 public:
  explicit Grid(std::size_t count) : newest_(std::bit_ceil(std::max<std::size_t>(count, 1)), none) {
    elder_.reserve(count);
  }
  std::uint32_t newest(const glm::dvec3& cell) const { return newest_[bucket(cell)]; }
  std::uint32_t elder(std::uint32_t id) const { return elder_[id]; }
  void add_next_id(const glm::dvec3& cell) {
    elder_.push_back(std::exchange(newest_[bucket(cell)], static_cast<std::uint32_t>(elder_.size())));
  }

 private:
  std::size_t bucket(const glm::dvec3& cell) const {
    // Large odd multipliers (Teschner et al. 2003, "Optimized Spatial Hashing") in 64 bits.
    const auto mix = static_cast<std::uint64_t>(std::llround(cell.x)) * 0x9E3779B97F4A7C15ULL ^
                     static_cast<std::uint64_t>(std::llround(cell.y)) * 0xC2B2AE3D27D4EB4FULL ^
                     static_cast<std::uint64_t>(std::llround(cell.z)) * 0x165667B19E3779F9ULL;
    return static_cast<std::size_t>(mix ^ (mix >> 29)) & (newest_.size() - 1);
  }
  std::vector<std::uint32_t> newest_, elder_;
};

}  // namespace

double weld_tolerance(const std::vector<glm::dvec3>& positions) {
  if (positions.empty()) return 0;
  glm::dvec3 low = positions.front();
  glm::dvec3 high = low;
  for (const glm::dvec3& p : positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return 1e-6 * glm::length(high - low);
}

Weld weld(const WeldInput& input, double tolerance,
          const std::function<bool(std::uint32_t, std::uint32_t)>& also_same) {
  const std::size_t count = input.positions.size();
  // Cells count from the first vertex, so that a small model far from the origin does not overflow them.
  const glm::dvec3 origin = count == 0 ? glm::dvec3{0} : input.positions.front();
  const double cell_size = tolerance > 0 ? 4 * tolerance : 1;
  const auto same = [&](std::uint32_t a, std::size_t b) {
    if (glm::distance(input.positions[a], input.positions[b]) > tolerance) return false;
    if (!same_influences(input.influences[a], input.influences[b])) return false;
    for (std::size_t t = 0; t < input.target_count; ++t)
      if (glm::distance(glm::dvec3(input.target_deltas[t * count + a]),
                        glm::dvec3(input.target_deltas[t * count + b])) > tolerance)
        return false;
    return !also_same || also_same(a, static_cast<std::uint32_t>(b));
  };

  Weld result;
  result.welded.resize(count);
  Grid grid(count);
  for (std::size_t v = 0; v < count; ++v) {
    const glm::dvec3 place = (input.positions[v] - origin) / cell_size;
    const glm::dvec3 reach{tolerance / cell_size};
    const glm::dvec3 low = glm::floor(place - reach);
    const glm::dvec3 high = glm::floor(place + reach);
    std::uint32_t found = static_cast<std::uint32_t>(result.representative.size());
    for (double x = low.x; x <= high.x; ++x)
      for (double y = low.y; y <= high.y; ++y)
        for (double z = low.z; z <= high.z; ++z)
          // The smallest id wins, whichever cell it stands in.
          for (std::uint32_t id = grid.newest({x, y, z}); id != none; id = grid.elder(id))
            if (id < found && same(result.representative[id], v)) found = id;
    if (found == result.representative.size()) {
      grid.add_next_id(glm::floor(place));
      result.representative.push_back(static_cast<std::uint32_t>(v));
    }
    result.welded[v] = found;
  }
  return result;
}

}  // namespace plisse
