// The one door for models: picks a reader by kind, keeps it apart, then checks what it brought, whichever it
// was.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/text.h"
#include "io/assimp/import_assimp.h"
#include "io/gltf/import_gltf.h"
#include "io/import.h"
#include "io/import_obj.h"
#include "io/import_ply.h"
#include "io/isolated_import.h"
#include "io/point_cache.h"
#include "io/read_model.h"
#include "io/sequence.h"

namespace plisse::io {
namespace {

using Reader = Model (*)(const std::filesystem::path&, const ImportOptions&);

// nullptr where there is none.
Reader reader_for(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 6> with_assimp{".fbx", ".dae", ".x", ".bvh", ".stl", ".3ds"};
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".glb" || extension == ".gltf") return import_gltf;
  if (extension == ".obj") return import_obj;
  if (extension == ".ply") return import_ply;
  if (std::find(with_assimp.begin(), with_assimp.end(), extension) != with_assimp.end()) return import_assimp;
  return nullptr;
}

ReaderNotice notice = nullptr;

}  // namespace

void check_model_file(const std::filesystem::path& path, const Limits& limits) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure))
    throw Error(ExitCode::bad_input, fmt::format("{}: no such file", path.string()));
  if (reader_for(path) == nullptr)
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: not a kind of model this program reads; it reads glb, gltf, fbx, dae, x, ply, stl, "
                    "3ds, obj and numbered sequences of obj or ply",
                    path.string()));
  if (!std::filesystem::is_regular_file(path, failure))
    throw Error(ExitCode::bad_input, fmt::format("{}: not a file", path.string()));
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure)
    throw Error(ExitCode::bad_input, fmt::format("{}: cannot be read: {}", path.string(), failure.message()));
  const std::string wrong = over_limit(limits, &Limits::file_mib, "file_mib", (size >> 20), "MiB");
  if (!wrong.empty()) throw Error(ExitCode::bad_input, fmt::format("{}: {}", path.string(), wrong));
}

Model read_model(const std::filesystem::path& path, const ImportOptions& options) {
  return reader_for(path)(path, options);
}

void note_reader(const char* who) {
  if (notice != nullptr) notice(who);
}

void on_note_reader(ReaderNotice to) {
  notice = to;
}

Model import_model(const std::filesystem::path& path, const ImportOptions& options) {
  std::error_code ignored;
  const bool is_sequence = std::filesystem::is_directory(path, ignored) ||
                           (!std::filesystem::exists(path, ignored) && is_sequence_pattern(path));
  const std::vector<std::filesystem::path> frames =
      is_sequence ? sequence_files(path) : std::vector<std::filesystem::path>{path};
  check_model_file(frames.front(), options.limits);
  if (is_sequence && reader_for(frames.front()) != import_obj && reader_for(frames.front()) != import_ply)
    throw Error(ExitCode::bad_input, fmt::format("{}: a sequence is of OBJ or PLY files", path.string()));
  Model model = isolated_import(frames.front(), options);
  validate(model, options.limits);
  if (is_sequence && !options.cache.empty())
    throw Error(ExitCode::bad_input,
                fmt::format("{}: a sequence moves by itself; the point cache {} goes over a single model",
                            path.string(), options.cache.string()));
  if (is_sequence) model.cache = sequence_cache(model, frames, options.limits);
  if (!options.cache.empty()) model.cache = read_point_cache(options.cache, model);
  if (!model.cache.empty()) validate(model, options.limits);
  return model;
}

}  // namespace plisse::io
