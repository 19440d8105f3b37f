// glTF accessors: every component type, normalised or not, strided and sparse (glTF 2.0, 3.6.2).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/gltf/import_gltf_parts.h"

namespace plisse::io {
namespace {

struct Component {
  std::size_t size;
  double largest;  // that a normalised integer divides by
  double (*read)(const std::byte*);
};

template <typename Number>
double read_as(const std::byte* from) {
  Number value;
  std::memcpy(&value, from, sizeof value);  // little endian, as glTF is
  return static_cast<double>(value);
}

Component component_of(const GltfValue& type) {
  switch (type.count()) {
    case 5120:
      return {1, 127, read_as<std::int8_t>};
    case 5121:
      return {1, 255, read_as<std::uint8_t>};
    case 5122:
      return {2, 32767, read_as<std::int16_t>};
    case 5123:
      return {2, 65535, read_as<std::uint16_t>};
    case 5125:
      return {4, 4294967295.0, read_as<std::uint32_t>};
    case 5126:
      return {4, 1, read_as<float>};
    default:
      type.fail(fmt::format("is {}, no type of glTF", type.count()));
  }
}

std::size_t width_of(const GltfValue& type) {
  const std::string name = type.text("");
  if (name == "SCALAR") return 1;
  if (name == "VEC2") return 2;
  if (name == "VEC3") return 3;
  if (name == "VEC4") return 4;
  if (name == "MAT4") return 16;
  type.fail(fmt::format("'{}' is not one that is read here", name));
}

// Elements of `width` components lie `stride` bytes apart from `offset` on: all of them within the view?
void check_range(const GltfValue& at, std::size_t view, std::uint64_t offset, std::uint64_t stride,
                 std::uint64_t element, std::uint64_t count) {
  if (count == 0) return;
  if (offset > view || element > view - offset || count - 1 > (view - offset - element) / stride)
    at.fail(fmt::format("{} elements of {} bytes, {} apart from byte {}, do not fit into a view of {} bytes",
                        count, element, stride, offset, view));
}

}  // namespace

double gltf_normaliser(const GltfValue& component_type) {
  return component_of(component_type).largest;
}

GltfArray read_gltf_accessor(GltfFile& file, const GltfValue& at,
                             std::initializer_list<std::string_view> types) {
  const GltfValue source = file.list("accessors").at(at.index(file.list("accessors")));
  const std::string type = source["type"].text("");
  if (std::find(types.begin(), types.end(), type) == types.end())
    source["type"].fail(fmt::format("is '{}', must be {}", type, fmt::join(types, " or ")));
  const Component component = component_of(source["componentType"]);
  const double scale = source["normalized"].truth(false) ? 1 / component.largest : 1;
  // A normalised signed integer has one value below −1.
  const auto number = [&](const std::byte* from) {
    const double value = component.read(from) * scale;
    return scale != 1 && value < -1 ? -1.0 : value;
  };

  GltfArray array;
  array.width = width_of(source["type"]);
  const std::uint64_t count = source["count"].count();
  const std::size_t element = component.size * array.width;
  const GltfValue view = source["bufferView"];
  std::span<const std::byte> bytes;
  std::size_t stride = element, offset = 0;
  if (view) {
    bytes = file.view(view);
    const GltfValue view_source = file.list("bufferViews").at(view.index(file.list("bufferViews")));
    const std::uint64_t stated = view_source["byteStride"].count(element);
    if (stated < element || stated > 256)
      view_source["byteStride"].fail(fmt::format("is {} for elements of {} bytes", stated, element));
    stride = static_cast<std::size_t>(stated);
    const std::uint64_t first = source["byteOffset"].count(0);
    check_range(source, bytes.size(), first, stride, element, count);
    offset = static_cast<std::size_t>(first);
  } else {
    if (count > (std::uint64_t{1} << 32)) source["count"].fail(fmt::format("is {}", count));
    file.spend(count * element, source);
  }
  array.count = static_cast<std::size_t>(count);
  array.values.assign(array.count * array.width, 0);
  if (view)
    for (std::size_t i = 0; i < array.count; ++i)
      for (std::size_t c = 0; c < array.width; ++c)
        array.values[i * array.width + c] = number(bytes.data() + offset + i * stride + c * component.size);

  const GltfValue sparse = source["sparse"];
  if (!sparse) return array;
  const std::uint64_t replaced = sparse["count"].count();
  const Component index = component_of(sparse["indices"]["componentType"]);
  const auto indices = file.view(sparse["indices"]["bufferView"]),
             values = file.view(sparse["values"]["bufferView"]);
  const std::uint64_t index_offset = sparse["indices"]["byteOffset"].count(0);
  const std::uint64_t value_offset = sparse["values"]["byteOffset"].count(0);
  check_range(sparse["indices"], indices.size(), index_offset, index.size, index.size, replaced);
  check_range(sparse["values"], values.size(), value_offset, element, element, replaced);
  for (std::uint64_t i = 0; i < replaced; ++i) {
    const double target = index.read(indices.data() + index_offset + i * index.size);
    if (!(target >= 0 && target < static_cast<double>(array.count)))
      sparse["indices"].fail(fmt::format("entry {} is {}, of {} elements", i, target, array.count));
    for (std::size_t c = 0; c < array.width; ++c)
      array.values[static_cast<std::size_t>(target) * array.width + c] =
          number(values.data() + value_offset + i * element + c * component.size);
  }
  return array;
}

}  // namespace plisse::io
