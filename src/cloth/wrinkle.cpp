#include "cloth/wrinkle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/units.h"
#include "cloth/cached_solves.h"
#include "cloth/drape.h"
#include "cloth/wrinkle_files.h"
#include "io/ply.h"
#include "io/wrinkle_field.h"
#include "shell/carry.h"
#include "wrinkle/base_check.h"
#include "wrinkle/facets.h"

namespace plisse::cloth {
namespace {

namespace fs = std::filesystem;

Error bad(const fs::path& file, const std::string& what) {
  return {ExitCode::bad_input, fmt::format("{}: {}", file.string(), what)};
}

// "young 1e7" among a PLY's comments.
std::optional<double> value_in(const io::Ply& ply, const std::string& name) {
  for (const std::string& comment : ply.comments) {
    if (!comment.starts_with(name + " ")) continue;
    if (const auto value = parse_number(comment.substr(name.size() + 1))) return *value;
  }
  return std::nullopt;
}
double needed_in(const io::Ply& ply, const std::string& name) {
  if (const auto value = value_in(ply, name)) return *value;
  throw bad(ply.file,
            fmt::format("has no comment '{} VALUE'; a base surface of 'plisse drape' is wanted", name));
}

}  // namespace

wrinkle::Model model_of(const WrinkleRequest& request) {
  return {request.scene.material,
          request.v1,
          request.v2,
          request.curvature_factor,
          request.crest_compression,
          request.relaxed_integrability};
}

std::vector<wrinkle::FaceForms> forms_of(const WrinkleRequest& request) {
  const wrinkle::BaseSurface& surface = request.scene.surface;
  auto forms = wrinkle::face_forms(surface, request.curvature);
  wrinkle::limit_tension(forms, request.scene.material, request.scene.tension_limit);
  const bool chords = request.chords && request.scene.chords;
  if (chords) wrinkle::correct_chords(forms);
  if (request.noise) wrinkle::find_noise(forms, surface, request.scene.material, chords);
  if (!request.scene.room.empty())
    for (std::size_t f = 0; f < forms.size(); ++f)
      for (std::size_t c = 0; c < 3; ++c) forms[f].room[c] = request.scene.room[surface.topology.faces[f][c]];
  return forms;
}

WrinkleScene read_base(const fs::path& file) {
  const io::Ply ply = io::read_ply(
      file, {"x", "y", "z", "held", "room", "vertex_indices", "vertex_index", "rest", "texcoord"});
  for (const std::string& comment : ply.comments)
    if (comment.starts_with("not converged")) log::warn(fmt::format("{}: {}", file.string(), comment));
  WrinkleScene scene;
  scene.name = file.stem().string();
  scene.chords = std::find(ply.comments.begin(), ply.comments.end(), "chords none") == ply.comments.end();
  std::vector<shell::Face> faces = ply.triangles(io::Ply::Polygons::refused);
  scene.surface.positions = points_to_eigen(ply.vectors("vertex"));
  if (!ply.element("face").find("rest"))
    throw bad(file, "has no list 'rest' of its faces; a base surface of 'plisse drape' is wanted");
  const std::vector<double>& flat = ply.lists("face", "rest", 6);
  scene.material = {needed_in(ply, "young"), needed_in(ply, "poisson"), needed_in(ply, "thickness"), 0};
  scene.tension_limit = value_in(ply, "tension_limit").value_or(0);
  if (!(scene.tension_limit >= 0 && scene.tension_limit <= 1e6))
    throw bad(file, fmt::format("tension_limit is {}, and not from 0 to 1e6", scene.tension_limit));
  shell::check(scene.material);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Eigen::Matrix<double, 2, 3> rest = Eigen::Map<const Eigen::Matrix<double, 2, 3>>(&flat[6 * f]);
    scene.surface.rest.push_back(shell::rest_face(rest, f));
  }
  if (ply.element("face").find("texcoord")) {
    const std::vector<double>& uv = ply.lists("face", "texcoord", 6);
    auto look = std::make_shared<ClothLook>();
    for (std::size_t f = 0; f < faces.size(); ++f) {
      auto& corners = look->uv.emplace_back();
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = Eigen::Vector2d(uv[6 * f + 2 * c], uv[6 * f + 2 * c + 1]);
    }
    scene.look = std::move(look);
  }
  const std::size_t count = ply.element("vertex").count;
  scene.surface.topology = shell::build_topology(std::move(faces), count);
  scene.held.assign(count, false);
  if (ply.element("vertex").find("held")) {
    const std::vector<double>& held = ply.numbers("vertex", {"held"});
    for (std::size_t v = 0; v < count; ++v) scene.held[v] = held[v] != 0;
  }
  if (ply.element("vertex").find("room")) {
    scene.room = ply.numbers("vertex", {"room"});
    for (const double room : scene.room)
      if (!(room >= 0)) throw bad(file, fmt::format("a vertex has a room of {}, and none is below 0", room));
  }
  return scene;
}

WrinkleScene base_of(const DrapeScene& scene, const fs::path& cache) {
  shell::Shell shell = shell_of(scene);
  const shell::Conditions conditions = scene.conditions(1);
  WrinkleScene result{scene.name, {}, scene.material, {}, scene.chords};
  result.surface.positions = scene.start;
  if (!scene.solved) {
    const SolvedCache answers(cache);
    Reuse reuse;
    DrapeState state(scene);
    for (int n = 1; n <= scene.frames; ++n) {  // the load's steps
      const shell::Equilibrium drape =
          solve_frame(scene, shell, n, state, answers, reuse,
                      [](const shell::NewtonStep&, const shell::Positions&) { return !interrupted(); });
      if (!drape.converged && (n == scene.frames || interrupted()))
        throw Error(ExitCode::check_failed,
                    fmt::format("{}: the base surface did not converge: {}", scene.name, drape.reason));
      if (!drape.converged)
        log::info(fmt::format("{}: frame {} on the way did not converge: {}", scene.name, n, drape.reason));
      log::info(fmt::format("{}: frame {} of the base surface in {} steps", scene.name, n, drape.iterations));
    }
    result.surface.positions = state.positions;
  }
  for (Eigen::Index v = 0; v < conditions.held.cols(); ++v)
    result.held.push_back(conditions.held.col(v).all());
  result.held.resize(shell.topology.vertex_count, false);
  result.surface.topology = std::move(shell.topology);
  result.surface.rest = std::move(shell.rest);
  return result;
}

WrinkleReport wrinkle_field(const WrinkleRequest& request) {
  const double began = wall_seconds();
  check_outputs(request);
  const wrinkle::BaseSurface& surface = request.scene.surface;
  const auto forms = forms_of(request);
  for (const wrinkle::BaseFault& fault : wrinkle::base_faults(surface.topology, forms))
    log::warn(fmt::format("{}: {}", request.scene.name, fault.text));
  const auto free = wrinkle::wrinkle_free_faces(forms, surface.topology, request.rule);
  WrinkleReport report;
  report.vertices = surface.topology.vertex_count;
  report.faces = surface.topology.faces.size();
  report.wrinkle_free_faces = static_cast<std::size_t>(std::count(free.begin(), free.end(), true));
  Reuse reuse;
  report.field =
      cached_field(SolvedCache(request.cache), reuse, surface.topology, forms, model_of(request), free,
                   request.pin_held ? request.scene.held : std::vector<bool>{}, request.options);
  report.from_cache = reuse.answers > 0;
  report.saved_s = reuse.saved_s;
  report.released_faces =
      static_cast<std::size_t>(std::count(report.field.released.begin(), report.field.released.end(), true));
  const Eigen::VectorXd& amplitude = report.field.whole.waves.amplitude;
  if (!amplitude.allFinite() || !report.field.one_form.allFinite())
    throw Error(ExitCode::check_failed, fmt::format("{}: the field is not finite", request.scene.name));
  report.max_amplitude = amplitude.size() > 0 ? amplitude.maxCoeff() : 0;
  report.wrinkled_vertices =
      static_cast<std::size_t>((amplitude.array() > 0.01 * report.max_amplitude).count());
  if (!request.output.empty()) {
    const wrinkle::Solution& last = report.field.real.converged ? report.field.whole : report.field.real;
    write_field(request.output, surface, {amplitude, report.field.phase}, report.field.one_form,
                last.converged ? "" : last.reason);
    report.outputs.push_back({request.output, "field"});
  }
  if (!request.mesh.empty()) {
    const double upsampling = wall_seconds();
    const WrinkleMesh mesh = mesh_of(request, forms, {amplitude, report.field.phase});
    report.levels = mesh.levels;
    report.upsample_s = wall_seconds() - upsampling;
    io::write_mesh(request.mesh, mesh.file);
    report.outputs.push_back({request.mesh, "mesh"});
  }
  report.wall_s = wall_seconds() - began;
  return report;
}

WrinkleEvaluation evaluate_field(const WrinkleRequest& request, const fs::path& amplitude,
                                 const fs::path& one_form) {
  const wrinkle::BaseSurface& surface = request.scene.surface;
  const auto read = [](const fs::path& path, std::size_t count, std::string_view what) {
    const auto numbers = io::read_numbers(path, count, what);
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(count)));
  };
  const Eigen::VectorXd a = read(amplitude, surface.topology.vertex_count, "vertices"),
                        omega = read(one_form, surface.topology.edges.size(), "edges");
  for (Eigen::Index v = 0; v < a.size(); ++v)
    if (a[v] < 0)
      throw bad(amplitude, fmt::format("line {}: {:g} is below 0, which no amplitude is", v + 1, a[v]));
  const auto forms = wrinkle::face_forms(surface, request.curvature);
  const wrinkle::Problem problem(surface.topology, forms, model_of(request),
                                 wrinkle::wrinkle_free_faces(forms, surface.topology, request.rule),
                                 request.pin_held ? request.scene.held : std::vector<bool>{});
  Eigen::VectorXd first;
  WrinkleEvaluation result;
  const double excess = problem.one_form_energy(a, omega, first);
  result.energy = excess + problem.relaxed_energy();
  if (!std::isfinite(result.energy))
    throw bad(amplitude,
              "the field's energy is not finite: its numbers are out of all proportion to the surface");
  const wrinkle::Waves waves{a, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.complex().vertices)),
                             Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.complex().periods))};
  result.kkt = wrinkle::kkt_residual(problem, problem.pack(waves), excess, first);
  for (std::size_t f = 0; f < surface.topology.faces.size(); ++f) {
    if (!problem.complex().live[f]) continue;  // need not close
    double round = 0;
    for (std::size_t side = 0; side < 3; ++side)
      round += wrinkle::side_sign(surface.topology, f, side) *
               omega[wrinkle::side_edge(surface.topology, f, side)];
    result.curl_max = std::max(result.curl_max, std::abs(round));
  }
  return result;
}

}  // namespace plisse::cloth
