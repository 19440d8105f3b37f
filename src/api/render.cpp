// <plisse/render.h>: scenes of files, texts and meshes become requests of pipeline/.
#include "plisse/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "api/convert.h"
#include "base/error.h"
#include "base/log.h"
#include "cloth/solve_scene.h"
#include "config/options.h"
#include "config/paint_file.h"
#include "config/scene_file.h"
#include "config/suggest.h"
#include "io/import.h"
#include "mesh/subdivide.h"
#include "pipeline/bake.h"
#include "pipeline/export.h"
#include "pipeline/paint.h"
#include "pipeline/render.h"
#include "pipeline/verify.h"

namespace plisse {
namespace {

constexpr const char* in_memory = "frames in memory";  // for messages, in place of the model's file

// A mesh a part, with the vertices that the part uses: those of a file, which corners split.
io::Model model_of(const std::vector<Mesh>& frames, double frames_per_second) {
  const Mesh& first = frames.front();
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const std::string who = fmt::format("frame {}", f + 1);
    api::check_mesh(who, frames[f]);
    api::check_count(who, "vertices", frames[f].positions.size(), first.positions.size());
    if (frames[f].triangles != first.triangles)
      throw Error(ExitCode::bad_input, fmt::format("{}: has other triangles than frame 1", who));
  }
  if (!(frames_per_second > 0 && frames_per_second <= 1e6))
    throw Error(ExitCode::bad_input,
                fmt::format("scene: {} frames a second; there have to be more than 0, at most 1e6",
                            frames_per_second));
  const io::MeshFile file = api::file_of(first);
  io::Model model;
  model.path = in_memory;
  model.file_vertex_count = first.positions.size();
  io::Node& node = model.nodes.emplace_back();
  node.name = "frames";
  std::vector<std::uint32_t> places;  // of the vertices of all meshes
  for (const io::MeshFile::Part& part : file.parts) {
    io::Mesh& mesh = model.meshes.emplace_back();
    mesh.name = part.mesh;
    if (!part.material.empty()) {
      const auto known = std::find_if(model.materials.begin(), model.materials.end(),
                                      [&](const io::Material& m) { return m.name == part.material; });
      mesh.material = static_cast<int>(known - model.materials.begin());
      if (known == model.materials.end()) model.materials.emplace_back().name = part.material;
    }
    std::vector<std::uint32_t> number(file.vertices.size(), ~std::uint32_t{0});
    for (std::size_t i = 3 * part.first_triangle; i < 3 * (part.first_triangle + part.triangle_count); ++i) {
      const std::uint32_t v = file.triangles[i];
      if (number[v] == ~std::uint32_t{0}) {
        const io::MeshFile::Vertex& vertex = file.vertices[v];
        number[v] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(file.positions[vertex.position]);
        if (!first.normals.empty()) mesh.normals.emplace_back(file.normals[vertex.normal]);
        if (!first.uv.empty()) mesh.uvs.push_back(vertex.uv);
        mesh.file_vertices.push_back(vertex.position);
        places.push_back(vertex.position);
      }
      mesh.triangles.push_back(number[v]);
    }
    node.meshes.push_back(static_cast<int>(model.meshes.size()) - 1);
  }
  if (frames.size() > 1) {
    std::vector<std::vector<glm::dvec3>> cache;
    for (const Mesh& frame : frames) {
      auto& positions = cache.emplace_back();
      for (const std::uint32_t v : places) positions.push_back(api::to_glm(frame.positions[v]));
    }
    model.cache = io::VertexCache(std::move(cache), frames_per_second);
  }
  return model;
}

// An option that is given several times has several values, as on the command line.
void apply(config::SceneSettings& settings, const std::vector<std::pair<std::string, std::string>>& given) {
  std::vector<std::string> known;
  for (const config::SceneOption& option : config::scene_options()) known.push_back(option.name);
  config::GivenOptions options;
  for (const auto& [name, value] : given) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ExitCode::bad_input,
                  fmt::format("scene: there is no option '{}'{}", name, config::did_you_mean(name, known)));
    const auto same = std::find_if(options.begin(), options.end(),
                                   [&](const auto& option) { return option.first == name; });
    if (same == options.end())
      options.push_back({name, {value}});
    else
      same->second.push_back(value);
  }
  config::apply_options(settings, options);
}

config::SceneSettings settings_of(const Scene& scene) {
  const bool model = !scene.frames.empty();
  if (int(!scene.file.empty()) + int(!scene.text.empty() || model) != 1)
    throw Error(ExitCode::bad_input,
                "scene: give one of file, text and frames; a text may stand beside frames");
  config::SceneSettings settings;
  if (!scene.text.empty()) {
    settings = (model ? config::parse_scene_of_any_model : config::parse_scene)(scene.text,
                                                                                scene.folder / "scene.toml");
  } else if (!model) {
    settings = config::open_scene(scene.file);
  }
  if (model) {
    if (!settings.model.path.empty() || !settings.model.garment.empty())
      throw Error(ExitCode::bad_input,
                  "scene: its model is in `frames`; leave path and garment out of [model]");
    settings.model.path = in_memory;
  }
  apply(settings, scene.options);
  if (!scene.fields.empty()) {
    settings.bias = {};
    settings.bias.use = config::FieldUse::direct;
  }
  return settings;
}

// Fills what all requests of pipeline/ have.
template <typename Request>
void take_scene(Request& request, const Scene& scene) {
  request.scene = settings_of(scene);
  if (!scene.frames.empty()) {
    request.memory.model = std::make_shared<const io::Model>(model_of(scene.frames, scene.frames_per_second));
    io::validate(*request.memory.model, request.scene.limits);
  }
  if (!scene.fields.empty()) {
    std::vector<io::WrinkleField> fields;
    for (std::size_t f = 0; f < scene.fields.size(); ++f)
      fields.push_back(api::to_io(scene.fields[f], fmt::format("wrinkle field {}", f + 1)));
    request.memory.fields = std::make_shared<const std::vector<io::WrinkleField>>(std::move(fields));
  }
  if (!request.scene.solve.on) return;
  if (!scene.frames.empty() || !scene.fields.empty())
    throw Error(ExitCode::bad_input,
                "scene: [solve] reads its model from a file; leave frames and fields out, or [solve]");
  cloth::SolvedScene solved = cloth::solve_scene({request.scene, cloth::SolvedCache::user_folder(), {}});
  for (const cloth::SolvedFrame& frame : solved.frames)
    if (!frame.converged)
      log::warn(fmt::format("frame {}: NOT CONVERGED: {}", frame.followed.frame, frame.reason));
  request.memory = std::move(solved.memory);
}

std::optional<int> checked(std::optional<int> levels) {
  if (levels && (*levels < 0 || *levels > most_levels))
    throw Error(ExitCode::bad_input, fmt::format("{} levels; allowed: 0 … {}", *levels, most_levels));
  return levels;
}

pipeline::RenderRequest to_pipeline(const RenderRequest& request) {
  pipeline::RenderRequest ours;
  take_scene(ours, request.scene);
  if (!request.displace && (request.draw.levels || !request.draw.outside.empty()))
    throw Error(ExitCode::bad_input, "render: levels and outside are for waves as geometry: set displace");
  ours.displace = request.displace;
  ours.levels = checked(request.draw.levels);
  ours.outside = request.draw.outside;
  ours.device = request.draw.device;
  return ours;
}

}  // namespace

RenderReport render(const RenderRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  pipeline::RenderRequest ours = to_pipeline(request);
  if (request.on_picture)
    ours.on_picture = [&](const pipeline::FrameReport& frame, const io::Image& image) {
      request.on_picture(frame.frame, {image.width, image.height, image.rgba});
    };
  const pipeline::RenderReport found = pipeline::render(ours, {});
  if (found.outcome != ExitCode::fine) throw Error(found.outcome, found.failure);
  RenderReport report;
  report.device = fmt::format("{}, {}, OpenGL {}", found.gl.renderer, found.gl.vendor, found.gl.version);
  report.vertices = found.welded_vertices;
  report.triangles = found.triangles;
  report.wavelength = found.wavelength_m;
  for (const pipeline::FrameReport& frame : found.frames) {
    report.frames.push_back(frame.frame);
    if (!frame.path.empty()) report.files.push_back(frame.path);
  }
  return report;
}

VerifyReport verify(const RenderRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  const pipeline::VerifyReport found = pipeline::verify(to_pipeline(request), {});
  VerifyReport report;
  report.ok = found.ok;
  for (const auto& [name, pass] : found.passes)
    report.passes.push_back({name, pass.max_abs, pass.tolerance, pass.unit, pass.ok});
  report.failures = found.failures;
  return report;
}

int export_meshes(const ExportRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  if (!request.on_mesh)
    throw Error(ExitCode::bad_input, "export_meshes: nobody takes the meshes: set on_mesh");
  pipeline::ExportRequest ours;
  take_scene(ours, request.scene);
  ours.levels = checked(request.draw.levels);
  ours.outside = request.draw.outside;
  ours.device = request.draw.device;
  ours.on_mesh = [&](int frame, const io::MeshFile& mesh) { request.on_mesh(frame, api::mesh_of(mesh)); };
  return pipeline::export_geometry(ours, {}).levels;
}

void bake(const BakeRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  if (!request.on_maps) throw Error(ExitCode::bad_input, "bake: nobody takes the maps: set on_maps");
  if (request.size < 16 || request.size > 16384)
    throw Error(ExitCode::bad_input,
                fmt::format("bake: maps of {} texels; allowed: 16 … 16384", request.size));
  if (request.draw.levels) throw Error(ExitCode::bad_input, "bake: maps have no levels");
  pipeline::BakeRequest ours;
  take_scene(ours, request.scene);
  ours.texture_size = request.size;
  ours.outside = request.draw.outside;
  ours.device = request.draw.device;
  ours.on_maps = [&](const pipeline::BakedMaps& maps) {
    BakedMaps result{maps.size, {maps.corner.x, maps.corner.y}, maps.side, maps.height, {}};
    for (const glm::dvec3& n : maps.normals)
      result.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    request.on_maps(maps.frame, result);
  };
  pipeline::bake_maps(ours, {});
}

PaintedWrinkles paint_wrinkles(const PaintRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  if (request.file.empty() == request.text.empty())
    throw Error(ExitCode::bad_input, "paint_wrinkles: give either a file or a text");
  const pipeline::PaintedSurface found = pipeline::paint_in_memory(
      request.file.empty() ? config::parse_paint(request.text, request.folder / "paint.toml")
                           : config::load_paint(request.file));
  return {api::points_from(found.positions), api::points_from(found.bias)};
}

}  // namespace plisse
