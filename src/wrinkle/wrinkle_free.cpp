#include "wrinkle/wrinkle_free.h"

namespace plisse::wrinkle {
namespace {

std::vector<bool> by_paper(const std::vector<double>& compression, const shell::Topology& topology) {
  const std::size_t count = compression.size();
  std::vector<bool> tense(count);
  for (std::size_t f = 0; f < count; ++f) {
    double sum = compression[f];
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t n = across(topology, f, side);
      if (n != shell::none) sum += compression[n];
    }
    tense[f] = sum > 0;
  }
  std::vector<bool> result = tense;
  for (std::size_t f = 0; f < count; ++f) {
    int with = 0, without = 0;
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t n = across(topology, f, side);
      if (n != shell::none) ++(tense[n] ? with : without);
    }
    if (with == 0 && without > 0) result[f] = false;
    if (without == 0 && with > 0) result[f] = true;
  }
  return result;
}

std::vector<bool> by_authors(const std::vector<double>& compression, const shell::Topology& topology) {
  std::vector<bool> result(compression.size());
  std::vector<bool> tense(topology.vertex_count, false);
  for (std::size_t f = 0; f < result.size(); ++f) {
    result[f] = compression[f] >= 0;
    if (!result[f]) continue;
    for (const std::uint32_t v : topology.faces[f]) tense[v] = true;
  }
  for (std::size_t f = 0; f < result.size(); ++f) {
    const shell::Face& t = topology.faces[f];
    if (tense[t[0]] && tense[t[1]] && tense[t[2]]) result[f] = true;
  }
  return result;
}

}  // namespace

std::vector<bool> wrinkle_free_faces(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                     WrinkleFreeRule rule) {
  std::vector<double> compression;
  for (const FaceForms& f : forms) compression.push_back(principal_strain(f).compression + f.noise);
  return rule == WrinkleFreeRule::paper ? by_paper(compression, topology) : by_authors(compression, topology);
}

}  // namespace plisse::wrinkle
