// Welding over a hash grid whose cells are a few tolerances wide, so that nearly every vertex looks into one
// cell.
#include "mesh/weld.h"

#include <cmath>
#include <unordered_map>

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

struct Cell {
  std::int64_t x, y, z;
  bool operator==(const Cell&) const = default;
};

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    // Large odd multipliers (Teschner et al. 2003, "Optimized Spatial Hashing") in 64 bits.
    const auto mix = static_cast<std::uint64_t>(cell.x) * 0x9E3779B97F4A7C15ULL ^
                     static_cast<std::uint64_t>(cell.y) * 0xC2B2AE3D27D4EB4FULL ^
                     static_cast<std::uint64_t>(cell.z) * 0x165667B19E3779F9ULL;
    return static_cast<std::size_t>(mix ^ (mix >> 29));
  }
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
  std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> grid;  // welded ids
  for (std::size_t v = 0; v < count; ++v) {
    const glm::dvec3 place = (input.positions[v] - origin) / cell_size;
    const glm::dvec3 reach{tolerance / cell_size};
    const glm::dvec3 low = glm::floor(place - reach);
    const glm::dvec3 high = glm::floor(place + reach);
    std::uint32_t found = static_cast<std::uint32_t>(result.representative.size());
    for (double x = low.x; x <= high.x; ++x)
      for (double y = low.y; y <= high.y; ++y)
        for (double z = low.z; z <= high.z; ++z) {
          const auto cell = grid.find(Cell{std::llround(x), std::llround(y), std::llround(z)});
          if (cell == grid.end()) continue;
          // The smallest id wins, whichever cell it stands in.
          for (const std::uint32_t id : cell->second)
            if (id < found && same(result.representative[id], v)) found = id;
        }
    if (found == result.representative.size()) {
      const glm::dvec3 home = glm::floor(place);
      grid[Cell{std::llround(home.x), std::llround(home.y), std::llround(home.z)}].push_back(found);
      result.representative.push_back(static_cast<std::uint32_t>(v));
    }
    result.welded[v] = found;
  }
  return result;
}

}  // namespace plisse
