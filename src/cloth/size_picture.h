// Pictures of sizing maps and their meshes, with their scale.
#pragma once

#include <array>
#include <cstdint>

#include "io/model.h"
#include "sizing/mesh_panel.h"

namespace plisse::cloth {

// Colours for sizes: fine is light, coarse is dark (viridis, whose lightness is even).
class SizeScale {
 public:
  explicit SizeScale(const sizing::SizedPanel& panel);
  std::array<std::uint8_t, 3> colour(double size) const;  // size in m
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 0, high_ = 0;  // m
};

// The sizing map, its lines and a scale in millimetres.
io::Image draw_size_map(const sizing::Panel& panel, const sizing::SizedPanel& sized, const SizeScale& scale);
// The mesh, tinted by the map.
io::Image draw_size_mesh(const sizing::Panel& panel, const sizing::SizedPanel& sized, const SizeScale& scale);

}  // namespace plisse::cloth
