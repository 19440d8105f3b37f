// Everything a scene decides, checked and with defaults filled in, and the tables of its file. Made from a
// scene file and the command line by config/scene_file.h; used by the pipeline.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "base/limits.h"
#include "config/cloth_settings.h"
#include "config/picture_settings.h"

namespace plisse::config {

struct SceneSettings {
  std::filesystem::path file;                 // the scene file, empty for a bare model
  std::map<std::string, std::string> places;  // "bias.field" → "scene.toml:6:1", of the keys that stand in it
  ModelSettings model;
  WrinkleSettings wrinkles;
  BiasSettings bias;
  SolveSettings solve;
  RelaxSettings relax;
  CameraSettings camera;
  LightSettings light;
  ShadingSettings shading;
  OutputSettings output;
  Limits limits;
};

template <typename Row>
void limit_keys(Row& row) {
  using S = Limits;
  constexpr int most = std::numeric_limits<int>::max();
  row("factor", &S::factor, number({1e-6, 1e6}), "Factor on all limits below.", {"--limits", "FACTOR"});
  row("file_mib", &S::file_mib, whole(1, most), "Size of a file, MiB.");
  row("memory_mib", &S::memory_mib, whole(64, most), "Memory while a file is read, MiB.");
  row("seconds", &S::seconds, whole(1, most), "Time while a file is read.");
  row("vertices", &S::vertices, whole(3, most), "Vertices of all meshes, as the file splits them.");
  row("triangles", &S::triangles, whole(1, most), "Triangles of all meshes.");
  row("bones", &S::bones, whole(0, most), "Bones of all skins.");
  row("keys", &S::keys, whole(0, most), "Keys of all clips.");
  row("texture_pixels", &S::texture_pixels, whole(0, most), "Pixels of all textures.");
}

// The tables in the order in which they are documented: table(name, member, what it is about, its rows).
template <typename Table>
void scene_tables(Table& table) {
  using S = SceneSettings;
  table("model", &S::model, "What moves, and when.", [](auto& row) { model_keys(row); });
  table("wrinkles", &S::wrinkles, "How large the wrinkles are and where they may be.",
        [](auto& row) { wrinkle_keys(row); });
  table("bias", &S::bias,
        "Wrinkles that are there in the rest pose already, and deepen as the cloth is squeezed; at most one "
        "key.",
        [](auto& row) { bias_keys(row); });
  table("solve", &S::solve,
        "A scene with this table, even an empty one, is solved before it is drawn (docs/wrinkle.md).",
        [](auto& row) { solve_keys(row); });
  table("relax", &S::relax,
        "How neighbouring waves come to fit together, and what is carried from frame to frame.",
        [](auto& row) { relax_keys(row); });
  table("camera", &S::camera,
        "A camera of the model by name; or one placed round it and fitted to the whole clip; or eye and "
        "target.",
        [](auto& row) { camera_keys(row); });
  table("light", &S::light,
        "Three lights that turn with the camera: azimuths to the right of the view, elevations above it.",
        [](auto& row) { light_keys(row); });
  table("shading", &S::shading, "What the cloth looks like.", [](auto& row) { shading_keys(row); });
  table("output", &S::output, "The pictures.", [](auto& row) { output_keys(row); });
  table("limits", &S::limits,
        "What a model's file may ask for, so that a damaged one ends in an error instead of a machine that "
        "swaps.",
        [](auto& row) { limit_keys(row); });
}

}  // namespace plisse::config
