// Values at the corners of faces, subdivided together with the surface: phases, whose values at one vertex
// differ by whole turns from face to face; texture coordinates, which have seams. Both may be unknown on some
// faces.
//
// A mask uses values of several faces. They are first shifted to the branch of one face, across sides where
// the values of the two faces agree up to a multiple of the period; values that cannot be reached in this way
// are extrapolated linearly from those that can. So a field that is linear in space stays linear, whatever
// its jumps, seams and holes.
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
  // One value a corner of every face of `level`; known: one flag a face. period: values of one vertex may
  // differ by a multiple of it; 0: they must be equal. Two faces are compared at the end of their common side
  // where `trust` (one number a vertex) is larger; at both ends if it is empty.
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
  // The reachable faces around a point of a face: for a corner all faces around it, for the middle of a side
  // the faces on both sides. Values are in the branch of the first face.
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
  // The number to add to the values of the neighbour across a side to get the branch of the face; none where
  // the values do not agree.
  std::vector<std::array<std::optional<double>, 3>> shift_;
  double period_ = 0;
};

// Sets the values of vertices to 0 (amplitudes) that a face has on which the field is unknown.
void shut(std::vector<double>& values, const LoopLevel& level, const CornerField& field);

// Whether two tangents span a plane, and the vector in it that has the limit's changes along them.
bool span(const glm::dvec3& first, const glm::dvec3& second);
glm::dvec3 gradient(const glm::dvec3& first, const glm::dvec3& second, const CornerField::Limit& limit);

}  // namespace plisse
