#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "base/error.h"
#include "io/picture/image.h"
#include "mesh/uv_raster.h"
#include "paint/bias_file.h"
#include "paint/uv_frames.h"

namespace plisse::paint {
namespace {

constexpr int widened_by = 8;  // texels
using Texel = std::array<std::uint8_t, 3>;
constexpr Texel ground{128, 128, 0};

std::uint8_t byte(double x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
}

// p in an orthonormal frame.
Texel encoded(const glm::dvec2& p) {
  const double length = glm::length(p), doubled = 2 * std::atan2(p.y, p.x);
  if (length < 0.5 / 255) return ground;
  return {byte(0.5 + 0.5 * std::cos(doubled)), byte(0.5 + 0.5 * std::sin(doubled)), byte(length)};
}

glm::dvec2 decoded(const Texel& texel) {
  const double length = texel[2] / 255.0;
  const double angle = 0.5 * std::atan2(texel[1] / 127.5 - 1, texel[0] / 127.5 - 1);
  return length * glm::dvec2(std::cos(angle), std::sin(angle));
}

glm::dvec3 on_the_side_of(const glm::dvec3& b, const glm::dvec3& p) {
  return glm::dot(b, p) < 0 ? -p : p;
}

class Texture {
 public:
  explicit Texture(int size)
      : size_(size),
        texels_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), ground),
        taken_(texels_.size()) {}

  // Rows from top to bottom, v upward; u = 1 and v = 1 belong to the last texel.
  std::size_t index(const glm::dvec2& uv) const {
    const auto place = [&](double x) {
      return std::clamp(static_cast<int>(std::floor(x * size_)), 0, size_ - 1);
    };
    return at(place(uv.x), size_ - 1 - place(uv.y));
  }
  int size() const { return size_; }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
  }
  Texel& operator[](std::size_t i) { return texels_[i]; }
  void set(std::size_t i, const Texel& texel) {
    texels_[i] = texel;
    taken_[i] = 1;
  }

  void widen() {
    for (int round = 0; round < widened_by; ++round) {
      const auto taken = taken_;
      for (int y = 0; y < size_; ++y) {
        for (int x = 0; x < size_; ++x) {
          if (!taken[at(x, y)]) take_from_beside(x, y, taken);
        }
      }
    }
  }
  io::Image image() const {
    io::Image image{size_, size_, {}};
    for (const Texel& texel : texels_)
      image.rgba.insert(image.rgba.end(), {texel[0], texel[1], texel[2], 255});
    return image;
  }

 private:
  void take_from_beside(int x, int y, const std::vector<std::uint8_t>& taken) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= size_ || y + dy >= size_ || !taken[at(x + dx, y + dy)])
          continue;
        return set(at(x, y), texels_[at(x + dx, y + dy)]);
      }
    }
  }
  int size_;
  std::vector<Texel> texels_;
  std::vector<std::uint8_t> taken_;
};

}  // namespace

namespace {

// Where each render vertex of a part with uv is in a texture, and its frame there; decided by the model and
// the size alone, so that who reads a texture finds what was written.
struct Places {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  UvSquare square;
  std::vector<UvFrame> frames;     // where triangles have no area in uv, the rest pose's own
  std::vector<std::size_t> texel;  // or none
  std::size_t moved = 0;           // that are not at their own uv
};

UvSquare square_of(const Surface& surface) {
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (const Part& part : surface.parts) {
    if (!part.has_uv) continue;
    for (std::size_t i = 3 * part.first_triangle; i < 3 * (part.first_triangle + part.triangle_count); ++i) {
      const glm::dvec2 uv(surface.render_vertices[surface.triangles[i]].uv);
      low = glm::min(low, uv), high = glm::max(high, uv);
    }
  }
  if (!(low.x <= high.x))
    throw Error(ExitCode::bad_input, "the model has no uv; what is painted fits into no texture");
  return uv_square(low, high, "move the islands closer together");
}

// The nearest texel to `start` that is not taken, by rings; `ring`: the first that may have one.
std::size_t free_texel(const Texture& texture, std::size_t start, int& ring,
                       const std::unordered_map<std::size_t, std::uint32_t>& owner) {
  const int size = texture.size(), x = static_cast<int>(start) % size, y = static_cast<int>(start) / size;
  for (; ring < size; ++ring) {
    for (int dy = -ring; dy <= ring; ++dy) {
      const bool edge = std::abs(dy) == ring;
      for (int dx = -ring; dx <= ring; dx += edge ? 1 : 2 * ring) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= size || y + dy >= size) continue;
        const std::size_t at = texture.at(x + dx, y + dy);
        if (!owner.contains(at)) return at;
      }
    }
  }
  return Places::none;
}

Places places_in(const Surface& surface, const RestFrames& rest, const Texture& texture) {
  Places places;
  places.square = square_of(surface);
  places.frames = uv_frames(surface, rest);
  places.texel.assign(surface.render_vertices.size(), Places::none);
  std::unordered_map<std::size_t, std::uint32_t> owner;
  std::unordered_map<std::size_t, int> rings;
  const auto take = [&](std::uint32_t i) {
    const RenderVertex& vertex = surface.render_vertices[i];
    UvFrame& frame = places.frames[i];
    if (!frame.valid()) {
      frame.along_u = rest.tangent[vertex.welded];
      frame.along_v = glm::cross(rest.normal[vertex.welded], frame.along_u);
    }
    const std::size_t start = texture.index(places.square.place(vertex.uv));
    const auto [found, first] = owner.try_emplace(start, i);
    places.texel[i] = start;
    if (first) return;
    const UvFrame& its = places.frames[found->second];
    constexpr double same = 1e-4;  // of unit vectors: a hundredth of a degree
    if (surface.render_vertices[found->second].welded == vertex.welded &&
        glm::distance(its.along_u, frame.along_u) < same && glm::distance(its.along_v, frame.along_v) < same)
      return;
    int& ring = rings.try_emplace(start, 1).first->second;
    places.texel[i] = free_texel(texture, start, ring, owner);
    if (places.texel[i] == Places::none)
      throw Error(
          ExitCode::bad_input,
          fmt::format("{0} vertices need a texel each; a texture of {1}×{1} has too few: raise texture_size",
                      surface.render_vertices.size(), texture.size()));
    owner.emplace(places.texel[i], i);
    ++places.moved;
  };
  for (const Part& part : surface.parts) {
    if (!part.has_uv) continue;
    for (std::size_t c = 3 * part.first_triangle; c < 3 * (part.first_triangle + part.triangle_count); ++c)
      if (places.texel[surface.triangles[c]] == Places::none) take(surface.triangles[c]);
  }
  return places;
}

}  // namespace

io::Image encode_bias(const Surface& surface, const RestFrames& rest, const std::vector<glm::dvec3>& bias,
                      int size, std::size_t* moved) {
  Texture texture(size);
  const Places places = places_in(surface, rest, texture);
  for (const Part& part : surface.parts) {
    if (!part.has_uv) continue;
    for (std::size_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      std::array<glm::dvec2, 3> uv;
      std::array<const UvFrame*, 3> frame;
      std::array<glm::dvec3, 3> p;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t id = surface.triangles[3 * t + c];
        uv[c] = places.square.place(surface.render_vertices[id].uv);
        frame[c] = &places.frames[id];
        p[c] = on_the_side_of(p[0], bias[surface.render_vertices[id].welded]);
        if (c == 0) p[0] = bias[surface.render_vertices[id].welded];
      }
      const glm::dvec2 e1 = uv[1] - uv[0], e2 = uv[2] - uv[0];
      const double area = e1.x * e2.y - e1.y * e2.x;
      if (area == 0) continue;
      const auto range = [&](double a, double b, double c) {
        const auto clamped = [&](double x) {
          return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size)));
        };
        return std::pair(clamped(std::floor(std::min({a, b, c}) * size)),
                         clamped(std::ceil(std::max({a, b, c}) * size)));
      };
      const auto [left, right] = range(uv[0].x, uv[1].x, uv[2].x);
      const auto [low, high] = range(uv[0].y, uv[1].y, uv[2].y);
      for (int y = low; y < high; ++y) {
        for (int x = left; x < right; ++x) {
          const glm::dvec2 d = glm::dvec2((x + 0.5) / size, (y + 0.5) / size) - uv[0];
          const double b = (d.x * e2.y - d.y * e2.x) / area, c = (e1.x * d.y - e1.y * d.x) / area,
                       a = 1 - b - c;
          if (a < 0 || b < 0 || c < 0) continue;
          const glm::dvec3 here = a * p[0] + b * p[1] + c * p[2];
          const glm::dvec3 u = a * frame[0]->along_u + b * frame[1]->along_u + c * frame[2]->along_u;
          const glm::dvec3 v = a * frame[0]->along_v + b * frame[1]->along_v + c * frame[2]->along_v;
          const glm::dvec2 q(glm::dot(here, u), glm::dot(here, v));
          const double length = glm::length(q);
          texture.set(texture.at(x, size - 1 - y),
                      encoded(length > 0 ? q * (glm::length(here) / length) : q));
        }
      }
    }
  }
  // Last the texels of vertices, with their exact vectors.
  for (std::size_t i = 0; i < places.texel.size(); ++i) {
    if (places.texel[i] == Places::none) continue;
    const glm::dvec3 p = bias[surface.render_vertices[i].welded];
    texture.set(places.texel[i],
                encoded({glm::dot(p, places.frames[i].along_u), glm::dot(p, places.frames[i].along_v)}));
  }
  texture.widen();
  if (moved) *moved = places.moved;
  return texture.image();
}

std::vector<glm::dvec3> decode_bias(const Surface& surface, const RestFrames& rest, const io::Image& image,
                                    const std::string& name) {
  if (image.width != image.height) {
    throw Error(ExitCode::bad_input,
                fmt::format("{}: is {}x{} pixels; a texture of painted wrinkles is square", name, image.width,
                            image.height));
  }
  Places places;
  try {
    places = places_in(surface, rest, Texture(image.width));
  } catch (const Error& error) {
    throw Error(error.code, fmt::format("{}: is a picture in uv, but {}", name, error.what()));
  }
  std::vector<glm::dvec3> bias(surface.vertex_count(), glm::dvec3(0));
  std::vector<int> counts(surface.vertex_count(), 0);
  for (std::size_t i = 0; i < places.texel.size(); ++i) {
    if (places.texel[i] == Places::none) continue;
    const std::uint8_t* rgba = &image.rgba[4 * places.texel[i]];
    const glm::dvec2 q = decoded({rgba[0], rgba[1], rgba[2]});
    const std::uint32_t v = surface.render_vertices[i].welded;
    bias[v] += on_the_side_of(bias[v], q.x * places.frames[i].along_u + q.y * places.frames[i].along_v);
    ++counts[v];
  }
  for (std::size_t v = 0; v < bias.size(); ++v) {
    if (counts[v] > 0) bias[v] /= counts[v];
    if (glm::length(bias[v]) > 0.99) bias[v] *= 0.99 / glm::length(bias[v]);
  }
  return bias;
}

namespace {

constexpr double octaves = 12;  // of wavelengths

double diagonal_of(const Surface& surface) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::dvec3& x : surface.rest) low = glm::min(low, x), high = glm::max(high, x);
  return glm::distance(low, high);
}

// p at a texel of the texture of bias, in the rest pose.
glm::dvec3 read_at(const Places& places, std::size_t i, const Texel& texel) {
  const glm::dvec2 q = decoded(texel);
  return q.x * places.frames[i].along_u + q.y * places.frames[i].along_v;
}

}  // namespace

io::Image encode_waves(const Surface& surface, const RestFrames& rest, const Painting& painting, int size) {
  Texture texture(size);
  const Places places = places_in(surface, rest, texture);
  const double diagonal = diagonal_of(surface);
  for (std::size_t i = 0; i < places.texel.size(); ++i) {
    if (places.texel[i] == Places::none) continue;
    const std::uint32_t v = surface.render_vertices[i].welded;
    const glm::dvec3 &p = painting.bias[v], &g = painting.gradient[v];
    Texel texel = ground;
    if (p != glm::dvec3(0) && g != glm::dvec3(0)) {
      const glm::dvec3 read = read_at(
          places, i, encoded({glm::dot(p, places.frames[i].along_u), glm::dot(p, places.frames[i].along_v)}));
      const double phase = glm::dot(read, p) < 0 ? -painting.phase[v] : painting.phase[v],
                   part = 2 * std::numbers::pi / glm::length(g) / diagonal;
      texel = {byte(0.5 + 0.5 * std::cos(phase)), byte(0.5 + 0.5 * std::sin(phase)),
               std::max<std::uint8_t>(1, byte((std::log2(part) + octaves) / octaves))};
    }
    texture.set(places.texel[i], texel);
  }
  texture.widen();
  return texture.image();
}

void decode_waves(const Surface& surface, const RestFrames& rest, const io::Image& bias,
                  const io::Image& waves, const std::string& name, Painting& painting) {
  if (waves.width != bias.width || waves.height != bias.height)
    throw Error(ExitCode::bad_input, fmt::format("{}: is {}×{} pixels, the texture that it belongs to {}×{}",
                                                 name, waves.width, waves.height, bias.width, bias.height));
  const Places places = places_in(surface, rest, Texture(waves.width));
  const double diagonal = diagonal_of(surface);
  std::vector<bool> done(surface.vertex_count(), false);
  for (std::size_t i = 0; i < places.texel.size(); ++i) {
    if (places.texel[i] == Places::none) continue;
    const std::uint32_t v = surface.render_vertices[i].welded;
    const std::uint8_t *wave = &waves.rgba[4 * places.texel[i]], *p = &bias.rgba[4 * places.texel[i]];
    if (done[v] || wave[2] == 0 || painting.bias[v] == glm::dvec3(0)) continue;
    done[v] = true;
    const glm::dvec3 read = read_at(places, i, {p[0], p[1], p[2]});
    if (read == glm::dvec3(0)) continue;
    painting.bias[v] = on_the_side_of(read, painting.bias[v]);
    const double length = diagonal * std::exp2(octaves * (wave[2] / 255.0 - 1));
    painting.gradient[v] = 2 * std::numbers::pi / length * glm::normalize(painting.bias[v]);
    painting.phase[v] = std::atan2(wave[1] / 127.5 - 1, wave[0] / 127.5 - 1);
  }
}

std::filesystem::path waves_beside(const std::filesystem::path& bias) {
  return bias.parent_path() / (bias.stem().string() + "_waves.png");
}

Painting read_bias(const std::filesystem::path& path, const Surface& surface, const RestFrames& rest) {
  if (path.extension() == ".ply" || path.extension() == ".PLY") return read_bias_ply(path, surface);
  const io::Image image = io::load_image(path);
  Painting painting(surface.vertex_count());
  painting.bias = decode_bias(surface, rest, image, path.string());
  if (const auto beside = waves_beside(path); std::filesystem::exists(beside))
    decode_waves(surface, rest, image, io::load_image(beside), beside.string(), painting);
  return painting;
}

}  // namespace plisse::paint
