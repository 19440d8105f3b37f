// plisse info: what is in a model file, for people as a table and for programs as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/size_options.h"
#include "config/settings.h"
#include "io/import.h"
#include "pipeline/render.h"
#include "scene/animation.h"
#include "scene/load_model.h"
#include "scene/wrinkles.h"
#include "sizing/mesh_fit.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

// Rates and frames of the clips are told at the default rate (docs/contract.md, "Frames, time, units").
constexpr double default_frames_per_second = 24;

struct Arguments {
  explicit Arguments(CommandOptions& options)
      : scene(options,
              [](const std::string& option) {
                return option == "--units" || option == "--up" || option == "--cache" || option == "--limits";
              }),
        common(options) {
    options.add(
        "--fabric", fabric, "B,E|NAME",
        described("Tell where the meshes are finer or coarser than this fabric needs: B,E or a name, as "
                  "plisse size has it"));
  }

  SceneArguments scene;
  CommonArguments common;
  std::string fabric;
};

int frame_count(double duration, double frames_per_second) {
  // A clip that is too long to be counted is an error once it is chosen.
  constexpr double most = 1e9;
  return static_cast<int>(std::min(duration * frames_per_second + 1e-3, most)) + 1;
}

ordered_json to_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

// Welded vertices of the part that came from this mesh; null where the mesh is not part of the surface.
ordered_json welded_vertices(const Surface& surface, const io::Mesh& mesh) {
  for (const Part& part : surface.parts) {
    if (part.mesh != mesh.name || part.triangle_count != mesh.triangles.size() / 3) continue;
    std::vector<bool> has(surface.vertex_count(), false);
    for (std::size_t i = 0; i < 3 * std::size_t{part.triangle_count}; ++i) {
      const std::uint32_t vertex = surface.triangles[3 * std::size_t{part.first_triangle} + i];
      has[surface.render_vertices[vertex].welded] = true;
    }
    return std::count(has.begin(), has.end(), true);
  }
  return nullptr;
}

ordered_json meshes_of(const io::Model& model, const Surface& surface) {
  ordered_json meshes = ordered_json::array();
  for (const io::Mesh& mesh : model.meshes) {
    meshes.push_back(
        {{"name", mesh.name},
         {"material", mesh.material < 0
                          ? ordered_json(nullptr)
                          : ordered_json(model.materials[static_cast<std::size_t>(mesh.material)].name)},
         {"vertices", mesh.positions.size()},
         {"welded", welded_vertices(surface, mesh)},
         {"triangles", mesh.triangles.size() / 3},
         {"bones", mesh.bones.size()},
         {"max_influences", mesh.file_max_influences},
         {"morphs", mesh.targets.size()},
         {"uv", !mesh.uvs.empty()},
         {"colours", !mesh.colours.empty()}});
  }
  return meshes;
}

ordered_json materials_of(const io::Model& model) {
  ordered_json materials = ordered_json::array();
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const io::Material& material = model.materials[i];
    ordered_json users = ordered_json::array();
    for (const io::Mesh& mesh : model.meshes) {
      if (mesh.material == static_cast<int>(i)) users.push_back(mesh.name);
    }
    const char* const alpha = material.alpha == io::Material::Alpha::mask    ? "mask"
                              : material.alpha == io::Material::Alpha::blend ? "blend"
                                                                             : "opaque";
    const auto texture = [&](int id) {
      return id < 0 ? ordered_json(nullptr) : ordered_json(model.textures[static_cast<std::size_t>(id)].name);
    };
    materials.push_back({{"name", material.name},
                         {"meshes", users},
                         {"texture", texture(material.base_colour_texture)},
                         {"normal_map", texture(material.normal_texture)},
                         {"alpha", alpha},
                         {"two_sided", material.two_sided}});
  }
  return materials;
}

ordered_json clips_of(const io::Model& model) {
  ordered_json clips = ordered_json::array();
  for (const io::Clip& clip : model.clips) {
    clips.push_back({{"name", clip.name},
                     {"duration_s", clip.duration},
                     {"channels", clip.channels.size()},
                     {"frames", frame_count(clip.duration, default_frames_per_second)}});
  }
  return clips;
}

ordered_json to_json(const io::Model& model, const scene::Animation& animation) {
  ordered_json cameras = ordered_json::array(), textures = ordered_json::array();
  for (const io::Camera& camera : model.cameras) {
    const bool parallel = camera.half_height > 0;
    cameras.push_back(
        {{"name", camera.name},
         {"vertical_field_of_view_deg",
          parallel ? ordered_json(nullptr) : ordered_json(glm::degrees(camera.vertical_field_of_view))},
         {"half_height", parallel ? ordered_json(camera.half_height) : ordered_json(nullptr)}});
  }
  for (const io::Texture& texture : model.textures) {
    textures.push_back(
        {{"name", texture.name}, {"width", texture.image.width}, {"height", texture.image.height}});
  }
  const Surface& surface = animation.surface();
  const scene::Animation::Bounds bounds = animation.bounds();
  ordered_json sequence = nullptr;
  if (!model.cache.empty()) {
    sequence = {{"frames", model.cache.size()}, {"fps", model.cache.frames_per_second()}};
  }
  return {{"path", model.path.string()},
          {"meshes", meshes_of(model, surface)},
          {"materials", materials_of(model)},
          {"clips", clips_of(model)},
          {"sequence", sequence},
          {"cameras", cameras},
          {"textures", textures},
          {"vertices", {{"render", surface.render_vertices.size()}, {"welded", surface.vertex_count()}}},
          {"triangles", surface.triangle_count()},
          {"bounds", {{"low", to_json(bounds.low)}, {"high", to_json(bounds.high)}}},
          {"units_m", model.metres_per_unit},
          {"up", model.up},
          {"wavelength_m", scene::default_wavelength(surface)}};
}

// How each part compares with the resolution of a fabric, in the rest pose.
ordered_json fits_of(const Surface& surface, double resolution) {
  ordered_json fits = ordered_json::array();
  for (const Part& part : surface.parts) {
    std::vector<std::array<std::uint32_t, 3>> triangles(part.triangle_count);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = surface.triangles[3 * (part.first_triangle + t) + i];
        triangles[t][i] = surface.render_vertices[vertex].welded;
      }
    }
    const sizing::MeshFit fit = sizing::fit_of(surface.rest, triangles, resolution);
    fits.push_back({{"name", part.mesh},
                    {"median_edge_mm", 1e3 * fit.median_edge},
                    {"finer", fit.finer},
                    {"coarser", fit.coarser},
                    {"vertices_needed", fit.vertices_needed},
                    {"coarse_low", to_json(fit.coarse_low)},
                    {"coarse_high", to_json(fit.coarse_high)}});
  }
  return {{"resolution_mm", 1e3 * resolution}, {"meshes", fits}};
}

// --- the table
// -------------------------------------------------------------------------------------------------

std::string name_of(const ordered_json& item) {
  return item.is_null() ? "–" : item.get<std::string>();
}

// Two more than the longest name, so that columns stand.
std::size_t name_width(const ordered_json& items) {
  std::size_t width = 16;
  for (const ordered_json& item : items) width = std::max(width, letters(item["name"].get<std::string>()));
  return width + 2;
}

std::string table(const ordered_json& info) {
  const auto length = [](double metres) {
    return metres < 0.1 ? fmt::format("{:.4g} mm", metres * 1000) : fmt::format("{:.4g} m", metres);
  };
  std::string text = fmt::format("{}\n", info["path"].get<std::string>());
  text +=
      fmt::format("  {} triangles, {} vertices, {} welded; wavelength {} unless chosen\n",
                  info["triangles"].get<std::size_t>(), info["vertices"]["render"].get<std::size_t>(),
                  info["vertices"]["welded"].get<std::size_t>(), length(info["wavelength_m"].get<double>()));
  const auto low = info["bounds"]["low"].get<std::vector<double>>();
  const auto high = info["bounds"]["high"].get<std::vector<double>>();
  text += fmt::format(
      "  {:.4g} × {:.4g} × {:.4g} m over the clip, from ({:.4g}, {:.4g}, {:.4g}); unit {:g} m, {} up\n",
      high[0] - low[0], high[1] - low[1], high[2] - low[2], low[0], low[1], low[2],
      info["units_m"].get<double>(), info["up"].get<std::string>());

  text += fmt::format("\n{}", padded("meshes", name_width(info["meshes"]) + 2));
  text += "  vertices    welded  triangles  bones  infl.  morphs  uv   material\n";
  for (const ordered_json& mesh : info["meshes"]) {
    const std::string welded =
        mesh["welded"].is_null() ? "–" : std::to_string(mesh["welded"].get<std::size_t>());
    text += padded("  " + mesh["name"].get<std::string>(), name_width(info["meshes"]) + 2) +
            fmt::format("{:>10}{:>10}{:>11}{:>7}{:>7}{:>8}  {}  {}\n", mesh["vertices"].get<std::size_t>(),
                        welded, mesh["triangles"].get<std::size_t>(), mesh["bones"].get<std::size_t>(),
                        mesh["max_influences"].get<int>(), mesh["morphs"].get<std::size_t>(),
                        mesh["uv"].get<bool>() ? "yes" : "no ", name_of(mesh["material"]));
  }
  const auto section = [&](const char* title, const ordered_json& items, const auto& line) {
    if (items.empty()) return;
    text += fmt::format("\n{}\n", title);
    const std::size_t width = name_width(items);
    for (std::size_t i = 0; i < items.size(); ++i) {
      text += fmt::format("  {:>2}  {}\n", i, line(items[i], width));
    }
  };
  section("materials", info["materials"], [](const ordered_json& material, std::size_t width) {
    std::string meshes;
    for (const ordered_json& mesh : material["meshes"])
      meshes += (meshes.empty() ? "" : ", ") + mesh.get<std::string>();
    return padded(material["name"].get<std::string>(), width) +
           fmt::format("{}, {}, texture {}, normal map {}; on {}", material["alpha"].get<std::string>(),
                       material["two_sided"].get<bool>() ? "two-sided" : "single-sided",
                       name_of(material["texture"]), name_of(material["normal_map"]),
                       meshes.empty() ? "nothing" : meshes);
  });
  section("clips", info["clips"], [](const ordered_json& clip, std::size_t width) {
    return padded(clip["name"].get<std::string>(), width) +
           fmt::format("{:.3f} s, {} frames at {:g} fps, {} channels", clip["duration_s"].get<double>(),
                       clip["frames"].get<int>(), default_frames_per_second,
                       clip["channels"].get<std::size_t>());
  });
  if (!info["sequence"].is_null()) {
    text += fmt::format("\nsequence\n      {} frames at {:g} fps\n",
                        info["sequence"]["frames"].get<std::size_t>(), info["sequence"]["fps"].get<double>());
  }
  section("cameras", info["cameras"], [](const ordered_json& camera, std::size_t width) {
    return padded(camera["name"].get<std::string>(), width) +
           (camera["half_height"].is_null() ? fmt::format("{:.4g}° from bottom to top",
                                                          camera["vertical_field_of_view_deg"].get<double>())
                                            : fmt::format("parallel, {:.4g} from bottom to top",
                                                          2 * camera["half_height"].get<double>()));
  });
  section("textures", info["textures"], [](const ordered_json& texture, std::size_t width) {
    return padded(texture["name"].get<std::string>(), width) +
           fmt::format("{} × {}", texture["width"].get<int>(), texture["height"].get<int>());
  });
  if (info.contains("fabric")) {
    const ordered_json& fabric = info["fabric"];
    text += fmt::format("\nfor a fabric that needs {:.3f} mm\n", fabric["resolution_mm"].get<double>());
    for (const ordered_json& fit : fabric["meshes"]) {
      text += padded("  " + fit["name"].get<std::string>(), name_width(fabric["meshes"]) + 2) +
              fmt::format(
                  "edges {:.3g} mm; {:.0f} % of it finer than half, {:.0f} % coarser than double; {:.0f} "
                  "vertices would do\n",
                  fit["median_edge_mm"].get<double>(), 100 * fit["finer"].get<double>(),
                  100 * fit["coarser"].get<double>(), fit["vertices_needed"].get<double>());
      if (fit["coarser"].get<double>() > 0) {
        const auto from = fit["coarse_low"].get<std::vector<double>>(),
                   to = fit["coarse_high"].get<std::vector<double>>();
        text += fmt::format("    coarse between ({:.4g}, {:.4g}, {:.4g}) and ({:.4g}, {:.4g}, {:.4g}) m\n",
                            from[0], from[1], from[2], to[0], to[1], to[2]);
      }
    }
  }
  return text;
}

int run_info(Arguments& arguments) {
  arguments.common.apply();
  const config::SceneSettings scene = arguments.scene.settings();
  const io::Model model = scene::load_model(scene);
  const scene::Animation animation(model, {});
  ordered_json report = to_json(model, animation);
  if (!arguments.fabric.empty()) {
    const sizing::Fabric fabric = fabric_option(arguments.fabric);
    const sizing::ResolutionLaw law = sizing::resolution_law();
    report["fabric"] = fits_of(animation.surface(), std::min(fabric_resolution(law, fabric.weft),
                                                             fabric_resolution(law, fabric.warp)));
  }
  if (arguments.common.tables_wanted()) write_stdout(table(report));
  write_report(report, arguments.common.json());
  return 0;
}

}  // namespace

void add_info(CommandLine& line) {
  CommandOptions& options =
      line.command("info", "Tell what is in a model: meshes, materials, clips, cameras, textures",
                   "\nThe names of meshes and materials are those that --only and --exclude take.");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_info(*arguments); };
}

}  // namespace plisse::cli
