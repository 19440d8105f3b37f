// Numbers that the corners of faces have, subdivided with the surface they are on: phases, whose values at
// one vertex differ by whole turns from face to face; texture coordinates, which have seams; both may be
// unknown on some faces.
//
// Masks reach over several faces. All values that one needs are brought to the branch of one face, across the
// sides where the two faces' numbers agree up to a multiple of the period; what cannot be reached that way is
// continued linearly from what can. So a field that is linear in space stays so, whatever its jumps, seams
// and holes.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "mesh/loop.h"

namespace plisse {

class CornerField {
 public:
  // One value a corner of every face of `level`; known: one flag a face. period: what values of one vertex
  // may differ by, times a whole number; 0: not at all. At which end of a side that is looked up `trust` says
  // (one number a vertex): where it is larger; both ends where it is empty.
  CornerField(const LoopLevel& level, std::vector<std::array<double, 3>> values, std::vector<bool> known,
              double period, const std::vector<double>& trust = {});

  const std::vector<std::array<double, 3>>& values() const { return values_; }
  const std::vector<bool>& known() const { return known_; }

  // The field on the next level, `fine`. positions: of this level's vertices.
  CornerField refined(const LoopLevel& coarse, const LoopLevel& fine,
                      const std::vector<glm::dvec3>& positions) const;

  // On the limit surface: each corner's value and its change along both tangents; 0 on faces that are not
  // known. positions: of the last level.
  struct Limit {
    double value = 0;
    std::array<double, 2> along{};
  };
  std::vector<std::array<Limit, 3>> limits(const LoopSubdivision& surface,
                                           const std::vector<glm::dvec3>& positions) const;

 private:
  CornerField() = default;

  struct Vertex {
    std::uint32_t vertex;
    double value;
  };
  struct Face {
    std::uint32_t face;
    std::size_t place;  // what the point is there
    double shift;       // to be added to its values
  };
  // What can be reached of the faces round a point of a face: a corner's are all round it, those of a side's
  // middle on both sides. Values are in the branch of the first face.
  struct Neighbourhood {
    std::vector<Vertex> vertices;
    std::vector<Face> faces;
  };
  void look_around(const LoopLevel& level, std::size_t face, std::size_t place, Neighbourhood& near) const;
  double value(const Neighbourhood& near, std::uint32_t vertex, const LoopLevel& level,
               const std::vector<glm::dvec3>& positions) const;
  // Σ weight · value over a row of masks.
  double sum(const Neighbourhood& near, const Rows<LoopWeight>& masks, std::uint32_t row,
             const LoopLevel& level, const std::vector<glm::dvec3>& positions) const;

  std::vector<std::array<double, 3>> values_;
  std::vector<bool> known_;
  // What to add to the values of the neighbour beyond a side for the branch of the face; none where they have
  // nothing in common.
  std::vector<std::array<std::optional<double>, 3>> shift_;
  double period_ = 0;
};

}  // namespace plisse
