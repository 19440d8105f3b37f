#include "config/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "mesh/wave_profiles.h"

namespace plisse::config {
namespace {

// Shorthand for the table below: each reaches the members of one group.
template <typename Value>
auto model(Value ModelSettings::*value) {
  return member(&SceneSettings::model, value);
}
template <typename Value>
auto wrinkles(Value WrinkleSettings::*value) {
  return member(&SceneSettings::wrinkles, value);
}
template <typename Value>
auto bias(Value BiasSettings::*value) {
  return member(&SceneSettings::bias, value);
}
template <typename Value>
auto relax(Value RelaxSettings::*value) {
  return member(&SceneSettings::relax, value);
}
template <typename Value>
auto camera(Value CameraSettings::*value) {
  return member(&SceneSettings::camera, value);
}
template <typename Value>
auto light(Value LightSettings::*value) {
  return member(&SceneSettings::light, value);
}
template <typename Value>
auto shading(Value ShadingSettings::*value) {
  return member(&SceneSettings::shading, value);
}
template <typename Value>
auto output(Value OutputSettings::*value) {
  return member(&SceneSettings::output, value);
}

template <typename Value>
auto limits(Value Limits::*value) {
  return member(&SceneSettings::limits, value);
}

constexpr int most = std::numeric_limits<int>::max();
constexpr Range azimuths{-360, 360};
constexpr Range elevations{-90, 90};
constexpr std::string_view degrees = "degrees";

}  // namespace

const std::vector<Table>& tables() {
  static const std::vector<Table> all = {
      {"model", "What moves, and when."},
      {"wrinkles", "How large the wrinkles are and where they may be."},
      {"bias",
       "Wrinkles that are there in the rest pose already, and deepen as the cloth is squeezed; at most one "
       "key."},
      {"relax", "How neighbouring waves come to fit together, and what is carried from frame to frame."},
      {"camera",
       "A camera of the model by name; or one placed round it and fitted to the whole clip; or eye and "
       "target."},
      {"light",
       "Three lights that turn with the camera: azimuths to the right of the view, elevations above it."},
      {"shading", "What the cloth looks like."},
      {"output", "The pictures."},
      {"limits",
       "What a model's file may ask for, so that a damaged one ends in an error instead of a machine that "
       "swaps."},
  };
  return all;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> all = {
      {"model", "path", model_path(model(&ModelSettings::path)),
       "The model: a file, a numbered sequence or its folder."},
      {"model", "garment", file_path(model(&ModelSettings::garment), {".toml", ".json"}),
       "In place of 'path': a panel file (docs/sizing.md) or GarmentCode pattern, meshed here as fine as its "
       "fabrics ask for; a 'cache' that plisse drape wrote of it moves it."},
      {"model", "pieces", names(model(&ModelSettings::pieces)),
       "Panels of the garment, by name, and the seams between them; none named: all."},
      {"model", "fabric", fabric(model(&ModelSettings::fabric)),
       "The fabric of all the garment's panels, in place of their own; GarmentCode patterns have none."},
      {"model", "clip", name_or_index(model(&ModelSettings::clip), "the first"), "The animation to play.",
       "--clip", "NAME|INDEX"},
      {"model", "fps",
       number(model(&ModelSettings::frames_per_second), {0.01, 1000, "24, or a sequence's own"}),
       "Frames per second; frame n stands at (n − 1)/fps seconds.", "--fps", "N"},
      {"model", "frames", frame_selection(model(&ModelSettings::frames)),
       "The frames to write; those before them are stepped all the same, so a frame does not depend on the "
       "choice.",
       "--frames", "1-48x2,60"},
      {"model", "loop", truth(model(&ModelSettings::loop)),
       "Replay one period of the clip before its first frame, so that the end meets the beginning."},
      {"model", "units", length(model(&ModelSettings::metres_per_unit), {1e-9, 1e9, "the file's own"}),
       "Length of the file's unit.", "--units", "METRES"},
      {"model", "up", word(model(&ModelSettings::up), {"x", "y", "z"}, "the file's own"),
       "The axis that points up.", "--up", "x|y|z"},
      {"model", "rest", rest_pose(model(&ModelSettings::rest)),
       "The pose without wrinkles: a skin's bind pose, a frame, or a model with the same vertices; auto "
       "takes the bind "
       "pose, else frame 1.",
       "--rest", "bind|frame:N|FILE"},
      {"model", "cache", file_path(model(&ModelSettings::cache), {".mdd", ".pc2"}),
       "A point cache that moves the model's vertices; its positions are in the model's own unit and axes.",
       "--cache", "FILE"},

      {"wrinkles", "wavelength", length(wrinkles(&WrinkleSettings::wavelength), {1e-9, 1e9, "from the mesh"}),
       "Length of a wave in the rest pose.", "--wavelength", "L"},
      {"wrinkles", "wavelength_map", file_path(wrinkles(&WrinkleSettings::wavelength_map)),
       "Wavelengths that vary over the cloth: a picture in uv, white where they are 'wavelength' and black "
       "where they are 'wavelength_low'; or a PLY over the rest pose with x, y, z and wavelength for every "
       "vertex, in "
       "the model's unit."},
      {"wrinkles", "wavelength_low",
       length(wrinkles(&WrinkleSettings::wavelength_low), {1e-9, 1e9, "half the wavelength"}),
       "Length of a wave where the picture is black."},
      {"wrinkles", "fine", whole(wrinkles(&WrinkleSettings::fine), 0, 32),
       "Finer wrinkles on the waves, so many to each of them; 0: none."},
      {"wrinkles", "fine_share", number(wrinkles(&WrinkleSettings::fine_share), {0, 4}),
       "How steep the finer wrinkles are, over the coarse ones; together they take the cloth's length."},
      {"wrinkles", "strength", number(wrinkles(&WrinkleSettings::strength), {0, 10}),
       "Factor on the height of all waves.", "--strength", "S"},
      {"wrinkles", "profile", word_or_file(wrinkles(&WrinkleSettings::profile), wave_profile_names()),
       "The shape of a wave.", "--profile", fmt::format("{}|FILE", fmt::join(wave_profile_names(), "|"))},
      {"wrinkles", "only", names(wrinkles(&WrinkleSettings::only)),
       "Meshes or materials that wrinkle; none named: all.", "--only", "MESH|MATERIAL"},
      {"wrinkles", "exclude", names(wrinkles(&WrinkleSettings::exclude)),
       "Meshes or materials that do not wrinkle.", "--exclude", "MESH|MATERIAL"},
      {"wrinkles", "dead_zone", number(wrinkles(&WrinkleSettings::dead_zone), {1e-4, 0.5}),
       "Compression 1 − r below which there is no wave yet; waves ease in across it."},
      {"wrinkles", "irregularity", number(wrinkles(&WrinkleSettings::irregularity), {0, 1}),
       "Seeded noise on wavelength, place and height, ±25 % of a wave at 1."},
      {"wrinkles", "seed", whole(wrinkles(&WrinkleSettings::seed)),
       "Seed of the noise and of the first phases."},

      {"bias", "paint", file_path(bias(&BiasSettings::paint)),
       "A paint file (docs/paint.md), painted when the scene is loaded."},
      {"bias", "file", file_path(bias(&BiasSettings::file)),
       "What 'plisse paint' wrote: bias.ply, or the uv texture bias.png."},
      {"bias", "field", file_or_pattern(bias(&BiasSettings::field)),
       "A solved wrinkle field over the rest pose: a PLY with amplitude and phase, or "
       "NAME_amplitude_REST.txt with "
       "NAME_phi_REST.txt and NAME_dphi_REST.txt beside it (then the model is their OBJ). A pattern names "
       "one "
       "for "
       "every frame, over the surface of that frame; it goes with use = \"direct\"."},
      {"bias", "use",
       enumeration<FieldUse>(bias(&BiasSettings::use),
                             {{"bias", FieldUse::bias}, {"direct", FieldUse::direct}}),
       "How a field is used: its waves start and are then crush's and relax's (bias), or amplitude times "
       "cosine as it was "
       "solved, carried by the surface, with the animation's own waves on top (direct)."},

      {"relax", "mode",
       enumeration<RelaxMode>(relax(&RelaxSettings::mode),
                              {{"smooth", RelaxMode::smooth}, {"descent", RelaxMode::descent}}),
       "How a wave gets its first phase: from its neighbours (smooth), or at random as in the paper "
       "(descent).",
       "--relax", "descent|smooth"},
      {"relax", "rounds", whole(relax(&RelaxSettings::rounds), 0, 1000), "Descent rounds in a frame.",
       "--rounds", "N"},
      {"relax", "epsilon", number(relax(&RelaxSettings::epsilon), {0, 19.7}),
       "Step ε of the descent (eq. 6); below 2π² it is stable on any mesh."},
      {"relax", "interval", whole(relax(&RelaxSettings::interval), 1, 1000),
       "Crush and relax run in every n-th frame and hold between.", "--interval", "N"},
      {"relax", "onset_rounds", whole(relax(&RelaxSettings::onset_rounds), 0, 1000),
       "Rounds in which new waves take their phase from the waves beside them."},
      {"relax", "smoothing_rounds", whole(relax(&RelaxSettings::smoothing_rounds), 0, 100000),
       "Rounds of complex smoothing where many waves begin at once."},

      {"camera", "name", name_or_index(camera(&CameraSettings::name), "the camera below"),
       "A camera of the model."},
      {"camera", "focal_length",
       number(camera(&CameraSettings::focal_length), {5, 2000}, "mm on film 36 mm wide"), "Focal length."},
      {"camera", "azimuth", number(camera(&CameraSettings::azimuth), azimuths, degrees),
       "Angle round the up axis; 0 looks along −z at the front."},
      // 89: straight up or down leaves the picture's own up direction undefined.
      {"camera", "elevation",
       number(camera(&CameraSettings::elevation),
              {-89, 89, "15, up to 50 for what lies flat", CameraSettings::from_the_shape}, degrees),
       "Angle above the horizon."},
      {"camera", "distance",
       length(camera(&CameraSettings::distance), {1e-9, 1e9, "fitted over the whole clip"}),
       "Distance from the middle of the clip's bounds."},
      {"camera", "margin", number(camera(&CameraSettings::margin), {0.1, 10}),
       "Factor on the fitted distance."},
      {"camera", "eye", point(camera(&CameraSettings::eye)), "Where the camera stands; goes with 'target'."},
      {"camera", "target", point(camera(&CameraSettings::target)), "What it looks at; goes with 'eye'."},

      {"light", "key_azimuth", number(light(&LightSettings::key_azimuth), azimuths, degrees),
       "Key light, angle to the right of the view."},
      {"light", "key_elevation", number(light(&LightSettings::key_elevation), elevations, degrees),
       "Key light, angle above the view; light along the waves hides them."},
      {"light", "key_intensity", number(light(&LightSettings::key_intensity), {0, 100}),
       "Key light, intensity."},
      {"light", "key_colour", colour(light(&LightSettings::key_colour)), "Key light, colour."},
      {"light", "fill_azimuth", number(light(&LightSettings::fill_azimuth), azimuths, degrees),
       "Fill light, angle to the right of the view."},
      {"light", "fill_elevation", number(light(&LightSettings::fill_elevation), elevations, degrees),
       "Fill light, angle above the view."},
      {"light", "fill_ratio", number(light(&LightSettings::fill_ratio), {0, 10}),
       "Fill light, intensity as a share of the key light's."},
      {"light", "fill_colour", colour(light(&LightSettings::fill_colour)), "Fill light, colour."},
      {"light", "rim_azimuth", number(light(&LightSettings::rim_azimuth), azimuths, degrees),
       "Rim light, angle to the right of the view."},
      {"light", "rim_elevation", number(light(&LightSettings::rim_elevation), elevations, degrees),
       "Rim light, angle above the view."},
      {"light", "rim_intensity", number(light(&LightSettings::rim_intensity), {0, 100}),
       "Rim light, intensity."},
      {"light", "ambient", number(light(&LightSettings::ambient), {0, 10}), "Light from all around."},
      {"light", "shadows", truth(light(&LightSettings::shadows)),
       "The key light casts shadows on model and ground."},

      {"shading", "blend",
       enumeration<Blend>(shading(&ShadingSettings::blend),
                          {{"smooth", Blend::smooth}, {"linear", Blend::linear}}),
       "Weights of a triangle's three waves: without creases along edges (smooth), or as in the paper "
       "(linear)."},
      {"shading", "gradient",
       enumeration<Gradient>(shading(&ShadingSettings::gradient),
                             {{"full", Gradient::full}, {"paper", Gradient::paper}}),
       "Slope of the waves: with the gradient of the weights (full), or eq. 8 as printed (paper)."},
      {"shading", "roughness", number(shading(&ShadingSettings::roughness), {0, 1}),
       "Width of the highlight."},
      {"shading", "sheen", number(shading(&ShadingSettings::sheen), {0, 1}),
       "Fuzz that shows at grazing angles."},
      {"shading", "cavity", number(shading(&ShadingSettings::cavity), {0, 4}),
       "Darkness of the valleys: 1 is what the groove itself hides of the sky, 0 none."},
      {"shading", "parallax", number(shading(&ShadingSettings::parallax), {0, 4}),
       "Factor on the shift of the texture over a wave's height; 0 none."},
      {"shading", "wireframe", truth(shading(&ShadingSettings::wireframe)), "Draw the triangles' edges."},
      {"shading", "colour", colour(shading(&ShadingSettings::colour)),
       "Colour where a material has neither texture nor colour."},

      {"output", "path", frame_pattern(output(&OutputSettings::path)),
       "Where the frames go: a folder, or a PNG name with ####, %04d or {frame:04} in it.", "--output",
       "DIR|PATTERN"},
      {"output", "size", size(output(&OutputSettings::width), output(&OutputSettings::height)),
       "Width and height.", "--size", "WxH"},
      {"output", "samples", one_of(output(&OutputSettings::samples), {1, 4}), "Samples in a pixel.",
       "--samples", "1|4"},
      {"output", "background",
       background(output(&OutputSettings::background), output(&OutputSettings::transparent)), "The backdrop.",
       "--background", "#rrggbb|transparent"},
      {"output", "ground", truth(output(&OutputSettings::ground)),
       "A floor with a contact shadow that runs into the backdrop."},

      {"limits", "factor", number(limits(&Limits::factor), {1e-6, 1e6}), "Factor on all limits below.",
       "--limits", "FACTOR"},
      {"limits", "file_mib", whole(limits(&Limits::file_mib), 1, most), "Size of a file, MiB."},
      {"limits", "memory_mib", whole(limits(&Limits::memory_mib), 64, most),
       "Memory while a file is read, MiB."},
      {"limits", "seconds", whole(limits(&Limits::seconds), 1, most), "Time while a file is read."},
      {"limits", "vertices", whole(limits(&Limits::vertices), 3, most),
       "Vertices of all meshes, as the file splits them."},
      {"limits", "triangles", whole(limits(&Limits::triangles), 1, most), "Triangles of all meshes."},
      {"limits", "bones", whole(limits(&Limits::bones), 0, most), "Bones of all skins."},
      {"limits", "keys", whole(limits(&Limits::keys), 0, most), "Keys of all clips."},
      {"limits", "texture_pixels", whole(limits(&Limits::texture_pixels), 0, most),
       "Pixels of all textures."},
  };
  return all;
}

const Key* find_key(std::string_view table, std::string_view name) {
  for (const Key& key : keys()) {
    if (key.table == table && key.name == name) return &key;
  }
  return nullptr;
}

}  // namespace plisse::config
