// The assimp reader: opens the file, settles units and up axis, and walks nodes and cameras.
#include "io/assimp/import_assimp.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <fmt/format.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <new>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "io/assimp/collada_arrays.h"
#include "io/assimp/collada_text.h"
#include "io/assimp/import_assimp_parts.h"
#include "io/import_place.h"
#include "io/import_texture.h"
#include "io/inside_folder.h"
#include "io/read_model.h"

namespace plisse::io {
namespace {

FileKind kind_of(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".fbx") return FileKind::fbx;
  if (extension == ".dae") return FileKind::collada;
  if (extension == ".x") return FileKind::x;
  return FileKind::other;
}

// STL states nothing. Programs that write it (CAD, slicers) have z up.
bool has_z_up(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".stl";
}

// Unit and up axis as a file states them.
struct Space {
  double metres_per_unit = 1;
  std::string up = "y";
};

// assimp 5.2.5 leaves FBX in the file's own space and hands both over as metadata; UnitScaleFactor is
// centimetres.
Space space_of_fbx(const aiScene& scene) {
  Space space;
  int axis = 1;
  if (scene.mMetaData != nullptr && scene.mMetaData->Get("UpAxis", axis) && axis >= 0 && axis <= 2)
    space.up = std::string(1, static_cast<char>('x' + axis));
  double centimetres = 1;
  float single = 1;
  if (scene.mMetaData != nullptr && !scene.mMetaData->Get("UnitScaleFactor", centimetres) &&
      scene.mMetaData->Get("UnitScaleFactor", single))
    centimetres = static_cast<double>(single);
  if (!(centimetres > 0) || !std::isfinite(centimetres)) centimetres = 1;
  space.metres_per_unit = centimetres / 100;
  return space;
}

// assimp folds COLLADA's unit into the root node and says nothing of it, so the <asset> head is read here.
Space space_of_collada(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string head(std::size_t{1} << 16, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  Space space;
  if (const std::size_t up = head.find("<up_axis>"); up != std::string::npos) {
    const std::size_t axis = head.find_first_of("XYZ<", up + 1);
    if (head.compare(axis + 1, 3, "_UP") == 0)
      space.up = std::string(1, static_cast<char>(head[axis] - 'A' + 'a'));
  }
  const std::size_t unit = head.find("<unit");
  const std::size_t meter = head.find("meter", unit);
  if (unit != std::string::npos && meter < head.find('>', unit)) {
    const std::size_t value = head.find_first_of("0123456789.", meter);
    const double metres = value == std::string::npos ? 0 : std::atof(head.c_str() + value);
    if (metres > 0 && std::isfinite(metres)) space.metres_per_unit = metres;
  }
  return space;
}

// A camera looks along −z of its node with y up; where the file's looks elsewhere a node in between turns it.
void read_cameras(const AssimpScene& from, Model& model) {
  for (unsigned c = 0; c < from.scene.mNumCameras; ++c) {
    const aiCamera& source = *from.scene.mCameras[c];
    const auto node = from.node_ids.find(source.mName.C_Str());
    if (node == from.node_ids.end()) continue;
    const glm::dvec3 look = vec3(source.mLookAt);
    const glm::dvec3 side = glm::cross(look, vec3(source.mUp));
    if (!(glm::length(look) > 0) || !(glm::length(side) > 1e-6 * glm::length(look))) continue;
    const glm::dvec3 x = glm::normalize(side);
    const glm::dvec3 z = -glm::normalize(look);
    const glm::dvec3 y = glm::cross(z, x);
    Node& turned = model.nodes.emplace_back();
    turned.name = std::string(source.mName.C_Str()) + " (view)";
    turned.parent = node->second;
    turned.local = glm::dmat4{glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0),
                              glm::dvec4(vec3(source.mPosition), 1)};

    Camera& camera = model.cameras.emplace_back();
    camera.name = source.mName.C_Str();
    camera.node = static_cast<int>(model.nodes.size()) - 1;
    // mHorizontalFOV is the whole angle in every reader of 5.2.5, whatever its comment says.
    const double aspect = source.mAspect > 0 ? static_cast<double>(source.mAspect) : 1;
    const double angle = 2 * std::atan(std::tan(static_cast<double>(source.mHorizontalFOV) / 2) / aspect);
    if (angle > 0 && angle < 3.1) camera.vertical_field_of_view = angle;
  }
}

// Opens what a model file names beside itself, and nothing elsewhere (inside_folder.h).
class FolderOnly : public Assimp::DefaultIOSystem {
 public:
  // `text`: what is read in place of the model file's own bytes; empty: those.
  FolderOnly(const std::filesystem::path& model, std::string text) : model_(model), text_(std::move(text)) {}
  bool Exists(const char* file) const override { return allowed(file) && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (!text_.empty() && file == model_)
      return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
    return allowed(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  bool allowed(const std::filesystem::path& file) const {
    std::error_code ignored;
    const std::filesystem::path absolute = std::filesystem::absolute(file, ignored);
    if (file == model_ || !inside_folder(model_.parent_path(), absolute.string()).empty()) return true;
    if (std::filesystem::exists(file, ignored)) warn_outside(model_, file);
    return false;
  }
  std::filesystem::path model_;
  std::string text_;
};

// assimp's own words, made fit to print: one line of it, and what they mean where they are a program's.
Error failure_of(const std::filesystem::path& path, std::string reason) {
  // How assimp hands on that memory is exhausted, which the caller has limited.
  if (reason.find("bad_alloc") != std::string::npos ||
      reason.find("bad array new length") != std::string::npos)
    throw std::bad_alloc();
  for (char& c : reason) c = c == '\n' || c == '\r' ? ' ' : c;
  if (reason.starts_with("No suitable reader found"))
    reason = "its content is not of the kind that its name says, or is cut off";
  return Error(ExitCode::bad_input, fmt::format("{}: cannot be read as a model: {}", path.string(),
                                                reason.empty() ? "it holds no scene" : reason));
}

}  // namespace

Model import_assimp(const std::filesystem::path& path, const ImportOptions& options) {
  Assimp::Importer importer;
  std::string text;
  if (kind_of(path) == FileKind::collada) {
    check_collada_arrays(path);
    text = collada_text(path);
  }
  importer.SetIOHandler(new FolderOnly(path, std::move(text)));  // which the importer owns
  // FBX pivots stay apart, to be put together by read_nodes: assimp's own way loses the geometric transforms
  // of skins.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  // Files with a skeleton and no mesh get a dummy body otherwise.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  note_reader("assimp");
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
  note_reader("");
  if (scene == nullptr || scene->mRootNode == nullptr) throw failure_of(path, importer.GetErrorString());

  Model model;
  model.path = path;
  AssimpScene from{*scene, kind_of(path), path, {}, {}, {}, {}, {}};
  std::unique_ptr<FbxReading> fbx;
  if (from.kind == FileKind::fbx) fbx = FbxReading::read(path, *scene);
  from.fbx = fbx.get();
  const Space space = from.kind == FileKind::fbx       ? space_of_fbx(*scene)
                      : from.kind == FileKind::collada ? space_of_collada(path)
                                                       : Space{1, has_z_up(path) ? "z" : "y"};
  model.metres_per_unit = options.metres_per_unit.value_or(space.metres_per_unit);
  model.up = options.up.empty() ? space.up : options.up;
  glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  // COLLADA's root already carries the file's own unit.
  if (from.kind == FileKind::collada) world = glm::scale(world, glm::dvec3{1 / space.metres_per_unit});

  read_nodes(from, world, model);
  read_materials(from, model);
  read_meshes(from, model);
  hang_meshes(from, model);
  read_cameras(from, model);
  read_clips(from, model);
  return model;
}

}  // namespace plisse::io
