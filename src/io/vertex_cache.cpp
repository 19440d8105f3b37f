// Frames on demand, the least recently used forgotten first (see vertex_cache.h).
#include "io/vertex_cache.h"

#include <algorithm>
#include <list>
#include <mutex>
#include <unordered_map>

namespace plisse::io {
namespace {

class FramesInMemory : public FrameSource {
 public:
  explicit FramesInMemory(std::vector<std::vector<glm::dvec3>> frames) : frames_(std::move(frames)) {}
  std::size_t count() const override { return frames_.size(); }
  std::vector<glm::dvec3> read(std::size_t frame) const override { return frames_.at(frame); }

 private:
  std::vector<std::vector<glm::dvec3>> frames_;
};

}  // namespace

struct VertexCache::Kept {
  std::shared_ptr<const FrameSource> source;
  std::size_t keep_bytes = 0;
  std::mutex mutex;
  std::list<std::size_t> used;  // latest first
  struct Entry {
    Frame frame;
    std::list<std::size_t>::iterator place;
  };
  std::unordered_map<std::size_t, Entry> entries;
  std::size_t bytes = 0;
};

VertexCache::VertexCache(std::shared_ptr<const FrameSource> source, double frames_per_second,
                         std::size_t keep_bytes)
    : kept_(std::make_shared<Kept>()), frames_per_second_(frames_per_second) {
  kept_->source = std::move(source);
  kept_->keep_bytes = keep_bytes;
}

VertexCache::VertexCache(std::vector<std::vector<glm::dvec3>> frames, double frames_per_second)
    : VertexCache(std::make_shared<FramesInMemory>(std::move(frames)), frames_per_second) {}

std::size_t VertexCache::size() const {
  return kept_ ? kept_->source->count() : 0;
}

VertexCache::Frame VertexCache::frame(std::size_t index) const {
  Kept& kept = *kept_;
  std::lock_guard lock(kept.mutex);
  if (const auto known = kept.entries.find(index); known != kept.entries.end()) {
    kept.used.splice(kept.used.begin(), kept.used, known->second.place);
    return known->second.frame;
  }
  auto frame = std::make_shared<const std::vector<glm::dvec3>>(kept.source->read(index));
  kept.used.push_front(index);
  kept.entries[index] = {frame, kept.used.begin()};
  kept.bytes += frame->size() * sizeof(glm::dvec3);
  while (kept.bytes > kept.keep_bytes && kept.used.size() > 2) {
    const auto oldest = kept.entries.find(kept.used.back());
    kept.bytes -= oldest->second.frame->size() * sizeof(glm::dvec3);
    kept.entries.erase(oldest);
    kept.used.pop_back();
  }
  return frame;
}

}  // namespace plisse::io
