// MDD (LightWave) and PC2 (3ds Max) point caches: positions of a mesh's vertices, frame by frame, without the
// mesh.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "base/atomic_file.h"
#include "io/model.h"

namespace plisse::io {

// The frames of a cache for a model that was read already, a frame at a time. The cache counts vertices as
// the model's file does: OBJ and PLY by their own numbers, other formats by the vertices that they are read
// with. Positions are in the model's own unit and axes and go where its nodes put the meshes. Throws
// Error(bad_input) where the file is cut off or longer than it says, is neither MDD nor PC2, or has another
// number of vertices; and where a mesh stands in several places. Frames a second: MDD's times; PC2's step in
// frames of 24 a second.
VertexCache read_point_cache(const std::filesystem::path& path, const Model& model);

// Writes a cache frame by frame, MDD or PC2 by the name's ending; positions as they are given, in single
// precision. Stands under its name from `commit` on. Errors: (bad_input) another ending, times that are not
// evenly spaced in a PC2; (no_output) what cannot be written, a frame too many or too few, or of another
// number of points, or a position that is not finite.
class PointCacheWriter {
 public:
  // `times`: of the frames, seconds from the clip's start, rising. PC2 has them in frames of 24 a second, as
  // read_point_cache takes them.
  PointCacheWriter(const std::filesystem::path& path, std::size_t points, std::vector<double> times);
  void add(std::span<const glm::dvec3> positions);
  void commit();

 private:
  std::filesystem::path path_;
  std::size_t points_, frames_, added_ = 0;
  bool big_endian_;
  WholeFile file_;
};

}  // namespace plisse::io
