// One list of fields serves counting, writing and reading, so that the three cannot differ. The structured
// bindings name every member: a member that is added to a struct of model.h stops the compiler here until it
// travels too.
#include "io/model_bytes.h"

#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace plisse::io {
namespace {

class Counter {
 public:
  void raw(const void*, std::size_t size) { size_ += size; }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_ = 0;
};

class Writer {
 public:
  explicit Writer(std::span<std::byte> bytes) : bytes_(bytes) {}
  void raw(const void* from, std::size_t size) {
    if (size > bytes_.size()) throw std::logic_error("a model grew while it was written");
    if (size > 0) std::memcpy(bytes_.data(), from, size);
    bytes_ = bytes_.subspan(size);
  }

 private:
  std::span<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  void raw(void* to, std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("the bytes of a model end early");
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
};

template <typename Archive>
constexpr bool reads = std::is_same_v<Archive, Reader>;

// Wholes of plain numbers, which a memcpy moves and every bit pattern of which is a value.
template <typename Value>
constexpr bool is_plain =
    std::is_trivially_copyable_v<Value> && !std::is_enum_v<Value> && !std::is_same_v<Value, bool>;

// The last value of each enumeration: a bit pattern beyond it is damage.
constexpr Texture::Use last(Texture::Use) {
  return Texture::Use::normals;
}
constexpr Material::Alpha last(Material::Alpha) {
  return Material::Alpha::blend;
}
constexpr Interpolation last(Interpolation) {
  return Interpolation::cubic_spline;
}

template <typename Archive, typename Value>
void put(Archive& archive, Value& value);

template <typename Archive, typename... Values>
void put_all(Archive& archive, Values&... values) {
  (put(archive, values), ...);
}

template <typename Archive, typename Item>
void put_list(Archive& archive, std::vector<Item>& items) {
  std::uint64_t count = items.size();
  archive.raw(&count, sizeof count);
  if constexpr (reads<Archive>) {
    // Every item takes at least a byte, so a count beyond what is left is damage, and allocates nothing.
    if (count > archive.left() / (is_plain<Item> ? sizeof(Item) : 1))
      throw std::runtime_error("a list in the bytes of a model is longer than they are");
    items.resize(static_cast<std::size_t>(count));
  }
  if constexpr (is_plain<Item>) {
    archive.raw(items.data(), items.size() * sizeof(Item));
  } else {
    for (Item& item : items) put(archive, item);
  }
}

template <typename Archive>
void put_text(Archive& archive, std::string& text) {
  std::uint64_t count = text.size();
  archive.raw(&count, sizeof count);
  if constexpr (reads<Archive>) {
    if (count > archive.left())
      throw std::runtime_error("a text in the bytes of a model is longer than they are");
    text.resize(static_cast<std::size_t>(count));
  }
  archive.raw(text.data(), text.size());
}

template <typename Archive>
void fields(Archive& archive, Image& of) {
  auto& [width, height, rgba] = of;
  put_all(archive, width, height, rgba);
}
template <typename Archive>
void fields(Archive& archive, Texture& of) {
  auto& [name, image, use] = of;
  put_all(archive, name, image, use);
}
template <typename Archive>
void fields(Archive& archive, Material& of) {
  auto& [name, base_colour, base_colour_texture, normal_texture, normal_scale, alpha, alpha_cutoff,
         two_sided] = of;
  put_all(archive, name, base_colour, base_colour_texture, normal_texture, normal_scale, alpha, alpha_cutoff,
          two_sided);
}
template <typename Archive>
void fields(Archive& archive, MorphTarget& of) {
  auto& [name, position_deltas] = of;
  put_all(archive, name, position_deltas);
}
template <typename Archive>
void fields(Archive& archive, Mesh& of) {
  auto& [name, material, positions, normals, flat, uvs, normal_uvs, colours, triangles, bones, influences,
         targets, file_max_influences, file_vertices] = of;
  put_all(archive, name, material, positions, normals, flat, uvs, normal_uvs, colours, triangles, bones,
          influences, targets, file_max_influences, file_vertices);
}
template <typename Archive>
void fields(Archive& archive, Node& of) {
  auto& [name, parent, local, meshes, morph_weights] = of;
  put_all(archive, name, parent, local, meshes, morph_weights);
}
template <typename Archive, typename Value>
void fields(Archive& archive, Keys<Value>& of) {
  auto& [interpolation, times, values, in_tangents, out_tangents] = of;
  put_all(archive, interpolation, times, values, in_tangents, out_tangents);
}
template <typename Archive>
void fields(Archive& archive, Channel& of) {
  auto& [node, translation, rotation, scale, morph_weights] = of;
  put_all(archive, node, translation, rotation, scale, morph_weights);
}
template <typename Archive>
void fields(Archive& archive, Clip& of) {
  auto& [name, duration, channels] = of;
  put_all(archive, name, duration, channels);
}
template <typename Archive>
void fields(Archive& archive, Camera& of) {
  auto& [name, node, vertical_field_of_view, half_height] = of;
  put_all(archive, name, node, vertical_field_of_view, half_height);
}
template <typename Archive>
void fields(Archive& archive, Model& of) {
  auto& [path, metres_per_unit, up, file_vertex_count, nodes, meshes, materials, textures, clips, cameras,
         cache] = of;
  if constexpr (!reads<Archive>) {
    if (!cache.empty()) throw std::logic_error("a vertex cache does not travel");
  }
  std::string path_text = path.string();
  put_all(archive, path_text, metres_per_unit, up, file_vertex_count, nodes, meshes, materials, textures,
          clips, cameras);
  if constexpr (reads<Archive>) path = path_text;
}

template <typename Value>
constexpr bool is_list = false;
template <typename Item>
constexpr bool is_list<std::vector<Item>> = true;

template <typename Archive, typename Value>
void put(Archive& archive, Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    put_text(archive, value);
  } else if constexpr (is_list<Value>) {
    put_list(archive, value);
  } else if constexpr (std::is_enum_v<Value> || std::is_same_v<Value, bool>) {
    auto number = static_cast<std::uint8_t>(value);
    archive.raw(&number, sizeof number);
    if constexpr (reads<Archive>) {
      std::uint8_t most = 1;
      if constexpr (std::is_enum_v<Value>) most = static_cast<std::uint8_t>(last(Value{}));
      if (number > most) throw std::runtime_error("the bytes of a model hold a choice that does not exist");
      value = static_cast<Value>(number);
    }
  } else if constexpr (is_plain<Value>) {
    archive.raw(&value, sizeof value);
  } else {
    fields(archive, value);
  }
}

template <typename Archive>
void traverse(Archive& archive, const Model& model) {
  // Counter and Writer change nothing; the one list of fields serves Reader as well, which does.
  fields(archive, const_cast<Model&>(model));
}

}  // namespace

std::size_t byte_count(const Model& model) {
  Counter counter;
  traverse(counter, model);
  return counter.size();
}

void write_bytes(const Model& model, std::span<std::byte> bytes) {
  Writer writer(bytes);
  traverse(writer, model);
}

Model model_from_bytes(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  Model model;
  fields(reader, model);
  if (reader.left() > 0) throw std::runtime_error("bytes are left over after a model");
  return model;
}

}  // namespace plisse::io
