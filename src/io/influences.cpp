// See influences.h.
#include "io/influences.h"

#include <algorithm>

namespace plisse::io {

Influences strongest(std::vector<BoneWeight>& weights, std::uint32_t unbound) {
  std::stable_sort(weights.begin(), weights.end(),
                   [](const BoneWeight& a, const BoneWeight& b) { return a.weight > b.weight; });
  const std::size_t count = std::min<std::size_t>(weights.size(), max_influences);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += weights[i].weight;
  Influences result;
  if (count == 0) {
    result.bone[0] = unbound;
    result.weight[0] = 1;
    return result;
  }
  for (std::size_t i = 0; i < count; ++i) {
    result.bone[i] = weights[i].bone;
    result.weight[i] = static_cast<float>(weights[i].weight / sum);
  }
  return result;
}

}  // namespace plisse::io
