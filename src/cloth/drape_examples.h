// The built-in scenes of `plisse drape --example`: the figures of Chen et al. 2021 and cases with known
// answers. docs/drape.md has a table of them, with what the paper leaves open.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cloth/drape_scene.h"

namespace plisse::cloth {

struct DrapeExample {
  std::string name;
  std::string what;  // one line for --help
  int vertices;      // where none are asked for
};

const std::vector<DrapeExample>& drape_examples();

// About `vertices` vertices (0: the example's own number); the same seed gives the same mesh. Throws
// Error(bad_input) for an unknown name, with the nearest known one.
DrapeScene drape_example(const std::string& name, int vertices = 0, std::uint32_t seed = 1);

}  // namespace plisse::cloth
