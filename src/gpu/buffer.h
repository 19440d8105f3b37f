// A buffer object that owns its memory on the GPU.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace plisse::gpu {

class Buffer {
 public:
  Buffer() = default;
  // `bytes` of storage, filled from `data` if given, zero otherwise. Throws Error(try_again) when there is
  // not enough memory.
  explicit Buffer(std::size_t bytes, const void* data = nullptr);
  template <typename Item>
  explicit Buffer(const std::vector<Item>& items) : Buffer(items.size() * sizeof(Item), items.data()) {}
  ~Buffer();
  Buffer(Buffer&& other) noexcept
      : id_(std::exchange(other.id_, 0)),
        items_(std::exchange(other.items_, 0)),
        bytes_(std::exchange(other.bytes_, 0)),
        fits_storage_(other.fits_storage_) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(items_, other.items_);
    std::swap(bytes_, other.bytes_);
    std::swap(fits_storage_, other.fits_storage_);
    return *this;
  }
  std::size_t bytes() const { return bytes_; }
  unsigned id() const { return id_; }
  // Binds the buffer as a samplerBuffer, from which a shader fetches items. Software renderers read textures
  // for all lanes at once, but storage buffers lane by lane, which is five times slower; so data that a
  // shader only reads is fetched in this way.
  enum class Item { vec4, vec2, uvec4, uvec2, uint };
  void bind_items(int unit, Item item) const;
  void bind_storage(int binding) const;
  void bind_uniform(int binding) const;
  void write(const void* data, std::size_t bytes, std::size_t offset = 0);
  void read(void* data, std::size_t bytes, std::size_t offset = 0) const;
  template <typename Item>
  void write(const std::vector<Item>& items) {
    write(items.data(), items.size() * sizeof(Item));
  }
  template <typename Item>
  std::vector<Item> read() const {
    std::vector<Item> items(bytes_ / sizeof(Item));
    read(items.data(), items.size() * sizeof(Item));
    return items;
  }

 private:
  unsigned id_ = 0;
  mutable unsigned items_ = 0;  // the texture over it, made when it is first bound
  std::size_t bytes_ = 0;
  mutable bool fits_storage_ = false;  // checked against the device's limit
};

}  // namespace plisse::gpu
