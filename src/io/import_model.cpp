// The one door for models: picks a reader by kind, then checks what it brought, whichever it was.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "base/error.h"
#include "io/import.h"
#include "io/import_assimp.h"
#include "io/import_gltf.h"
#include "io/import_obj.h"
#include "io/obj_sequence.h"

namespace plisse::io {
namespace {

using Reader = Model (*)(const std::filesystem::path&, const ImportOptions&);

Model import_sequence(const std::filesystem::path& path, const ImportOptions& options) {
  return import_obj_sequence(sequence_files(path), options);
}

Reader reader_for(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 7> with_assimp{".fbx", ".dae", ".x",  ".bvh",
                                                               ".ply", ".stl", ".3ds"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::filesystem::is_directory(path)) return import_sequence;
  if (std::filesystem::exists(path)) {
    if (extension == ".obj") return import_obj;
    if (extension == ".glb" || extension == ".gltf") return import_gltf;
    if (std::find(with_assimp.begin(), with_assimp.end(), extension) != with_assimp.end())
      return import_assimp;
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: not a kind of model this program reads; it reads glb, gltf, fbx, dae, x, ply, stl, "
                    "3ds, obj and numbered sequences of obj",
                    path.string()));
  }
  if (is_sequence_pattern(path)) {
    if (extension == ".obj") return import_sequence;
    throw Error(ExitCode::bad_input,
                fmt::format("{}: sequences are read from OBJ files only", path.string()));
  }
  throw Error(ExitCode::bad_input, fmt::format("{}: no such file", path.string()));
}

}  // namespace

Model import_model(const std::filesystem::path& path, const ImportOptions& options) {
  Model model = reader_for(path)(path, options);
  validate(model);
  return model;
}

}  // namespace plisse::io
