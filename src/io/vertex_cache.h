// Positions frame by frame in place of bones: a numbered sequence of files or a point cache. Frames are read
// when they are asked for and only the last used stay in memory, so that a cache may hold thousands.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <utility>
#include <vector>

namespace plisse::io {

// Where frames come from.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual std::size_t count() const = 0;
  // Frame f, from 0: positions in the world (metres, y up) of the vertices of all meshes of the model, one
  // mesh after the other. Throws Error(bad_input) with the file's name where the frame is damaged or has
  // another mesh.
  virtual std::vector<glm::dvec3> read(std::size_t frame) const = 0;
};

class VertexCache {
 public:
  using Frame = std::shared_ptr<const std::vector<glm::dvec3>>;

  VertexCache() = default;  // none
  // Keeps at most `keep_bytes` of frames in memory, but at least two.
  VertexCache(std::shared_ptr<const FrameSource> source, double frames_per_second,
              std::size_t keep_bytes = std::size_t{256} << 20);
  // Of frames in memory.
  VertexCache(std::vector<std::vector<glm::dvec3>> frames, double frames_per_second);

  bool empty() const { return size() == 0; }
  std::size_t size() const;
  double frames_per_second() const { return frames_per_second_; }
  // When the frames are, in seconds from the first, increasing: of point caches, which keep their times at
  // any rate of playing. Empty: of sequences, whose frames are one picture each.
  const std::vector<double>& times() const { return times_; }
  void set_times(std::vector<double> times) { times_ = std::move(times); }
  // May be called from several threads; the frame stays alive with what is returned.
  Frame frame(std::size_t index) const;

 private:
  struct Kept;
  std::shared_ptr<Kept> kept_;  // shared by copies: they are of one content
  double frames_per_second_ = 24;
  std::vector<double> times_;
};

}  // namespace plisse::io
