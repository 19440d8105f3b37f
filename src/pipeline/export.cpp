// plisse export: a scene's frames as geometry with wrinkles.
#include "pipeline/export.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/clock.h"
#include "base/error.h"
#include "base/message_scope.h"
#include "base/text.h"
#include "config/frames.h"
#include "io/mesh_file.h"
#include "io/point_cache.h"
#include "pipeline/displace.h"
#include "pipeline/look.h"
#include "pipeline/outside.h"
#include "pipeline/render.h"
#include "pipeline/visit_frames.h"

namespace plisse::pipeline {
namespace {

bool is_cache(const std::string& ending) {
  return ending == ".pc2" || ending == ".mdd";
}

void check_output(const std::string& pattern, const std::vector<int>& frames) {
  if (pattern.empty()) throw Error(ExitCode::bad_input, "plisse export: name the output with -o");
  const std::filesystem::path path(pattern);
  const std::string ending = lower_case(path.extension().string());
  const bool cache = is_cache(ending);
  if (!cache && ending != ".ply" && ending != ".obj" && ending != ".glb") {
    throw Error(ExitCode::bad_input,
                fmt::format("-o {}: geometry is written as .ply, .obj or .glb, point caches as .pc2 or .mdd",
                            pattern));
  }
  if (cache && config::is_frame_pattern(pattern))
    throw Error(ExitCode::bad_input, fmt::format("-o {}: a point cache is one file for all frames", pattern));
  if (!cache && frames.size() > 1 && !config::is_frame_pattern(pattern)) {
    const auto better = path.parent_path() / (path.stem().string() + "_####" + path.extension().string());
    throw Error(ExitCode::bad_input,
                fmt::format("-o {}: one file for {} frames; give it a place for the number: '{}'", pattern,
                            frames.size(), better.string()));
  }
}

// Data that is the same for all frames.
io::MeshFile mesh_of(const pipeline::LoadedScene& scene, const Subdivision& fine) {
  const Surface& surface = scene.surface();
  io::MeshFile mesh;
  mesh.vertices.resize(fine.vertices.size());
  for (std::size_t v = 0; v < fine.vertices.size(); ++v) {
    mesh.vertices[v].position = fine.vertices[v].position;
    mesh.vertices[v].normal = fine.vertices[v].normal;
  }
  fine.for_each_point([&](std::size_t t, const FinePoint& point) {
    const std::uint32_t* corners = &surface.triangles[3 * t];
    const glm::vec3 b(point.barycentric());
    auto& vertex = mesh.vertices[point.vertex];
    vertex.uv = glm::vec2(0);
    vertex.colour = glm::vec4(0);
    for (int c = 0; c < 3; ++c) {
      vertex.uv += b[c] * surface.render_vertices[corners[c]].uv;
      vertex.colour += b[c] * surface.render_vertices[corners[c]].colour;
    }
  });
  mesh.triangles = fine.triangles;
  const auto draws = draw_parts(scene);
  for (std::size_t p = 0; p < draws.size(); ++p) {
    const Part& part = surface.parts[p];
    const auto [first, count] = fine.small_triangles(part.first_triangle, part.triangle_count);
    mesh.parts.push_back({part.mesh, part.material_name, draws[p].base_colour, draws[p].two_sided,
                          part.has_uv, part.has_colours, first, count});
  }
  return mesh;
}

}  // namespace

void check(const ExportRequest& request) {
  const log::Scope unheard(log::Sink{});  // the run itself tells
  const pipeline::LoadedScene scene(request.scene, request.memory, 0);
  const auto frames =
      config::select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  if (!request.on_mesh) check_output(request.output, frames);
}

ExportReport export_geometry(const ExportRequest& request, const FrameCallback& on_frame) {
  const double started = wall_seconds();
  // Smooth surfaces are halved as part of the levels.
  pipeline::LoadedScene scene(request.scene, request.memory, smooth_levels_within(request.levels));
  const auto frames =
      config::select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  if (!request.on_mesh) check_output(request.output, frames);
  const int levels = request.levels ? *request.levels : pipeline::levels_for(scene);
  const pipeline::Displacement displacement(
      scene, subdivide(scene.surface(), 1 << (levels - scene.smooth_levels())));
  std::optional<pipeline::Outside> outside;
  if (!request.outside.empty()) outside.emplace(scene, request.outside);
  io::MeshFile mesh = mesh_of(scene, displacement.mesh());

  ExportReport report;
  report.levels = levels;
  report.positions = displacement.mesh().position_count;
  report.triangles = displacement.mesh().triangle_count();
  std::optional<io::PointCacheWriter> cache;
  if (is_cache(lower_case(std::filesystem::path(request.output).extension().string()))) {
    std::vector<double> times;
    for (const int frame : frames) times.push_back(scene.animation.timeline().time(frame));
    cache.emplace(request.output, displacement.mesh().position_count, times);
  }
  report.interrupted =
      !pipeline::visit_frames(scene, frames, {request.device, request.shader_folder}, on_frame,
                              [&](int frame, const passes::SurfaceBuffers& surface) {
                                DisplacedSurface displaced = displacement.at(surface);
                                if (outside) outside->hold(frame, displacement.mesh(), displaced);
                                for (glm::dvec3& x : displaced.positions) x = displacement.metres(x);
                                const std::string path = config::numbered_path(request.output, frame);
                                if (cache) {
                                  cache->add(displaced.positions);
                                  return path;
                                }
                                mesh.positions = std::move(displaced.positions);
                                mesh.normals = std::move(displaced.normals);
                                if (request.on_mesh) {
                                  request.on_mesh(frame, mesh);
                                  return std::string();
                                }
                                io::write_mesh(path, mesh);
                                report.outputs.push_back({path, "mesh", frame});
                                return path;
                              });
  if (cache && !report.interrupted) {
    cache->commit();
    report.outputs.push_back({request.output, "cache", 0});
  }
  report.wall_s = wall_seconds() - started;
  return report;
}

}  // namespace plisse::pipeline
