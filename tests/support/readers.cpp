#include "support/readers.h"

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/paint_file.h"
#include "config/panel_file.h"
#include "config/scene_file.h"
#include "io/import.h"
#include "io/point_cache.h"
#include "io/read_model.h"
#include "io/wrinkle_field.h"
#include "mesh/cut_polygon.h"
#include "support/files.h"

namespace plisse::test {

namespace fs = std::filesystem;

void read_as_model(std::string_view bytes, const fs::path& folder) {
  const char* name = bytes.starts_with("glTF")  ? "m.glb"
                     : bytes.starts_with("{")   ? "m.gltf"
                     : bytes.starts_with("ply") ? "m.ply"
                                                : "m.obj";
  write_text(folder / name, bytes);
  io::validate(io::read_model(folder / name, {}));
}

void read_as_point_cache(std::string_view bytes, const fs::path& folder) {
  write_text(folder / "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  io::Model model = io::read_model(folder / "triangle.obj", {});
  const char* name = bytes.starts_with("POINTCACHE2") ? "c.pc2" : "c.mdd";
  write_text(folder / name, bytes);
  model.cache = io::read_point_cache(folder / name, model);
  io::validate(model);
  for (std::size_t f = 0; f < model.cache.size() && f < 8; ++f) model.cache.frame(f);
}

void read_as_scene(std::string_view bytes, const fs::path& folder) {
  std::optional<Error> refused;
  int taken = 0;
  const auto attempt = [&](auto parse, const char* name) {
    try {
      parse(bytes, folder / name);
      ++taken;
    } catch (const Error& error) {
      refused = error;
    }
  };
  attempt(config::parse_scene, "scene.toml");
  attempt(config::parse_paint, "paint.toml");
  attempt([](std::string_view text, const fs::path& file) { return config::parse_panels(text, file); },
          "panels.toml");
  if (taken == 0 && refused) throw Error(*refused);
}

void read_as_field(std::string_view bytes, const fs::path& folder) {
  if (bytes.starts_with("ply")) {
    write_text(folder / "field.ply", bytes);
    io::read_wrinkle_field(folder / "field.ply", {});
    return;
  }
  write_text(folder / "q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  for (const char* name : {"q_amplitude_s.txt", "q_phi_s.txt", "q_dphi_s.txt"}) {
    constexpr std::string_view mark = "\n#\n";
    const std::size_t end = bytes.find(mark);
    write_text(folder / name, bytes.substr(0, end));
    bytes = end == std::string_view::npos ? std::string_view{} : bytes.substr(end + mark.size());
  }
  io::read_wrinkle_field(folder / "q_amplitude_s.txt", folder / "q.obj");
}

void read_as_polygon(std::string_view bytes, const fs::path&) {
  // Small whole numbers, so that corners often fall together or onto a line.
  std::vector<glm::dvec3> corners;
  for (std::size_t i = 0; i + 2 < bytes.size() && corners.size() < 64; i += 3)
    corners.emplace_back(bytes[i] % 8, bytes[i + 1] % 8, (bytes[i + 2] % 8) / 7);
  if (corners.size() < 3) return;
  const auto triangles = cut_polygon(corners);
  bool sound = triangles.size() + 2 == corners.size();
  for (const auto& triangle : triangles)
    for (const std::uint32_t corner : triangle) sound &= corner < corners.size();
  if (!sound) throw std::logic_error("a polygon was cut into other triangles than it has");
}

}  // namespace plisse::test
