// The wanted edge length everywhere on a panel: the sizing map of D. Zhang et al., SIGGRAPH 2025, 4.3, on a
// regular grid in working coordinates (domain.h).
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "sizing/domain.h"
#include "sizing/source.h"

namespace plisse::sizing {

class SizeMap {
 public:
  // r = min(r_f, sources at their distance inside the panel), for each direction of the fabric (4.2.1); then
  // limits from the shape (narrow places, tight curves, short lines), and a gradient of at most `gradation`.
  SizeMap(const Panel& panel, const Domain& domain, const std::vector<Source>& sources,
          const SizingOptions& options);

  // Edge length wanted at a place, working coordinates.
  double size(const glm::dvec2& working) const;
  // The same in the directions of the fabric: (weft, warp), m.
  glm::dvec2 resolution(const glm::dvec2& working) const;
  // The metric tensor: an edge e has the wanted length where eᵀ M e = 1; panel coordinates, m⁻².
  glm::dmat2 metric(const glm::dvec2& working) const;
  // The finest size that features along a line of the domain need on it; the fabric's where there are none.
  double line_size(std::size_t line) const { return line_sizes_[line]; }

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double step() const { return step_; }
  glm::dvec2 node(int column, int row) const { return origin_ + step_ * glm::dvec2(column, row); }
  bool inside(int column, int row) const { return inside_[index(column, row)] != 0; }
  float node_size(int column, int row) const { return size_[index(column, row)]; }
  double least() const { return least_; }  // of all wanted sizes, working coordinates

 private:
  struct Cap {
    glm::dvec2 at{0};
    double size = 0;
  };
  std::vector<Cap> shape_caps() const;
  void lay_grid(const std::vector<Source>& sources, const std::vector<Cap>& caps);
  void mark_inside();
  void measure_clearance();
  void spread(const std::vector<const Source*>& alike);
  bool visible(glm::dvec2 from, const glm::dvec2& to) const;
  void limit_gradation();
  void extend_outside();
  double working_size(double weft, double warp) const;
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  float bilinear(const std::vector<float>& values, const glm::dvec2& working) const;

  const Domain& domain_;
  SizingOptions options_;
  glm::dmat2 fabric_axes_{1};  // rows: weft, warp
  glm::dvec2 origin_{0};
  double step_ = 0, least_ = 0;
  int columns_ = 0, rows_ = 0;
  bool obstacles_ = false;  // distances may have to go around holes or notches
  std::vector<std::uint8_t> inside_;
  std::vector<float> weft_, warp_, size_, clearance_;
  std::vector<std::vector<std::uint32_t>> near_walls_;  // by node: boundary segments that pass within a cell
  std::vector<std::pair<glm::dvec2, glm::dvec2>> walls_;
  std::vector<double> line_sizes_;
};

}  // namespace plisse::sizing
