#include "cloth/wrinkle_files.h"

#include <fmt/format.h>

#include <utility>

#include "base/atomic_file.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/text.h"
#include "io/wrinkle_field.h"

namespace plisse::cloth {
namespace {

namespace fs = std::filesystem;

Error bad(const fs::path& file, const std::string& what) {
  return {ExitCode::bad_input, fmt::format("{}: {}", file.string(), what)};
}

std::vector<double> values(const Eigen::VectorXd& vector) {
  return {vector.begin(), vector.end()};
}

io::WrinkleField as_file(const wrinkle::BaseSurface& surface, const wrinkle::CoarseField& field) {
  io::WrinkleField result;
  result.positions = points_to_glm(surface.positions);
  result.amplitude = values(field.amplitude);
  result.triangles = surface.topology.faces;
  result.phase = field.phase;
  return result;
}

// A phase for every vertex, from the last of its faces that has one.
std::vector<double> vertex_phases(const wrinkle::BaseSurface& surface, const wrinkle::CoarseField& field) {
  std::vector<double> result(surface.topology.vertex_count, 0.0);
  for (std::size_t f = 0; f < field.phase.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (field.phase[f][c] != 0) result[surface.topology.faces[f][c]] = field.phase[f][c];
    }
  }
  return result;
}

}  // namespace

void write_field(const fs::path& output, const wrinkle::BaseSurface& surface,
                 const wrinkle::CoarseField& field, const Eigen::VectorXd& one_form,
                 const std::string& stopped) {
  if (output.extension() == ".txt") {
    io::write_wrinkle_texts(output, values(field.amplitude), vertex_phases(surface, field), values(one_form));
  } else {
    std::vector<std::string> comments;
    if (!stopped.empty()) comments.push_back("not converged: " + stopped);
    io::write_wrinkle_field(output, as_file(surface, field), comments);
  }
}

void check_outputs(const WrinkleRequest& request) {
  if (!request.output.empty()) {
    if (request.output.extension() != ".ply" && request.output.extension() != ".txt")
      throw bad(request.output,
                "fields are written as .ply, or as NAME_amplitude_REST.txt with phi and dphi beside it");
    check_writable(request.output);
  }
  if (!request.mesh.empty()) {
    const std::string ending = lower_case(request.mesh.extension().string());
    if (ending != ".ply" && ending != ".obj" && ending != ".glb")
      throw bad(request.mesh, "meshes are written as .ply, .obj or .glb");
    if (request.mesh == request.output) throw bad(request.mesh, "is both the field and the mesh");
    check_writable(request.mesh);
  }
}

WrinkleMesh mesh_of(const WrinkleRequest& request, const std::vector<wrinkle::FaceForms>& forms,
                    const wrinkle::CoarseField& field) {
  const WrinkleScene& scene = request.scene;
  Eigen::Matrix3Xd lean;
  if (request.mesh_v1) lean = wrinkle::leaning(scene.surface, forms, scene.material.poisson, field);
  return wrinkle_mesh(scene.name, scene.surface, field, request.levels, request.v2,
                      scene.look ? *scene.look : ClothLook{}, std::move(lean));
}

}  // namespace plisse::cloth
