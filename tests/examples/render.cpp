// A sheet that is pushed together, three frames in memory, drawn with its wrinkles: pictures, geometry and
// maps.
#include <plisse/error.h>
#include <plisse/render.h>

#include <algorithm>
#include <cmath>
#include <iostream>

int run() {
  constexpr std::uint32_t n = 12;
  plisse::Scene scene;
  for (int frame = 0; frame < 3; ++frame) {
    plisse::Mesh& sheet = scene.frames.emplace_back();
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i <= n; ++i)
        sheet.positions.push_back({(1 - 0.1 * frame) * i / n, double(j) / n, 0});
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
        for (const plisse::Triangle& t : {plisse::Triangle{a, b, c}, plisse::Triangle{a, c, d}}) {
          sheet.triangles.push_back(t);
          auto& uv = sheet.uv.emplace_back();
          for (int k = 0; k < 3; ++k) uv[k] = {double(t[k] % (n + 1)) / n, double(t[k] / (n + 1)) / n};
        }
      }
  }
  scene.options = {{"--size", "160x128"}, {"--wavelength", "15cm"}};
  const auto say = [](plisse::MessageLevel, std::string_view text) { std::cout << text << '\n'; };

  plisse::RenderRequest pictures;
  pictures.scene = scene;
  pictures.messages = say;
  std::vector<plisse::Picture> drawn;
  pictures.on_picture = [&](int, const plisse::Picture& picture) { drawn.push_back(picture); };
  const plisse::RenderReport report = plisse::render(pictures);
  std::cout << drawn.size() << " pictures, drawn by " << report.device << '\n';
  if (drawn.size() != 3 || drawn[0].rgba.size() != 160 * 128 * 4 || drawn[0].rgba == drawn[2].rgba) return 1;

  plisse::ExportRequest geometry;
  geometry.scene = scene;
  double highest = 0;  // the sheet is in the plane z = 0
  geometry.on_mesh = [&](int, const plisse::Mesh& mesh) {
    for (const plisse::Vector3& x : mesh.positions) highest = std::max(highest, x[2]);
  };
  plisse::export_meshes(geometry);
  std::cout << "waves as geometry, " << 1000 * highest << " mm high\n";

  plisse::BakeRequest maps;
  maps.scene = scene;
  maps.scene.options.push_back({"--frames", "3"});
  maps.size = 128;
  float baked = 0;
  maps.on_maps = [&](int, const plisse::BakedMaps& map) {
    for (const float height : map.height) baked = std::max(baked, height);
  };
  plisse::bake(maps);
  std::cout << "waves as a map, " << 1000 * baked << " mm high\n";
  // Both are of the same waves; a map's texels and a mesh's vertices miss their crests by less than a fifth.
  return highest > 0 && std::abs(baked - highest) < 0.2 * highest ? 0 : 1;
}

int main() {
  try {
    return run();
  } catch (const plisse::Error& error) {
    std::cout << error.what() << '\n';
    return error.code == plisse::ExitCode::no_opengl ? 0 : 1;
  }
}
