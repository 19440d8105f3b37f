// What a scene decides about its model and its wrinkles, each table's settings above the keys that set them:
// a new key is a member here and a row below it. Lengths are metres.
//
// The rows are templates so that only config/keys.cpp, which uses them, pays for compiling them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "config/kinds.h"
#include "mesh/wave_profiles.h"

namespace plisse::config {

inline constexpr std::int64_t most_seed = std::numeric_limits<std::uint32_t>::max();

struct ModelSettings {
  std::filesystem::path path;       // resolved against the scene file's folder; empty: `garment`
  std::filesystem::path garment;    // a panel file or GarmentCode pattern, which is meshed here
  std::vector<std::string> pieces;  // panels of it, by name; none: all
  std::string fabric;               // in place of the panels' own, as parse_fabric takes it; empty: theirs
  std::string clip;                 // name, index, list or all; empty: first with a length
  double frames_per_second = 0;     // 0: 24, a sequence's own
  std::string frames;               // selection "1-48x2,60"; empty: all
  bool loop = false;                // replays one period first
  double metres_per_unit = 0;       // 0: the file's own
  std::string up;                   // x | y | z; empty: the file's own
  std::string rest = "auto";        // auto | bind | frame:N | uv | uv:LENGTH | FILE
  std::filesystem::path cache;      // an MDD or PC2 file over the model's mesh; empty: none
};

template <typename Row>
void model_keys(Row& row) {
  using S = ModelSettings;
  row("path", &S::path, model_path(), "The model: a file, a numbered sequence or its folder.");
  row("garment", &S::garment, file_path({".toml", ".json"}),
      "In place of 'path': a panel file (docs/sizing.md) or GarmentCode pattern, meshed here as fine as its "
      "fabrics ask for; a 'cache' that plisse drape wrote of it moves it.");
  row("pieces", &S::pieces, names(),
      "Panels of the garment, by name, and the seams between them; none named: all.");
  row("fabric", &S::fabric, fabric_text("the panels' own"),
      "The fabric of all the garment's panels, in place of their own; GarmentCode patterns have none.");
  row("clip", &S::clip, name_or_index("the first that has a length"),
      "The animation to play: several with commas between, or all, are played together.",
      {"--clip", "NAME|INDEX|all"});
  row("fps", &S::frames_per_second, number({0.01, 1000, "24, or a sequence's own"}),
      "Frames per second; frame n stands at (n − 1)/fps seconds.", {"--fps", "N"});
  row("frames", &S::frames, frame_selection(),
      "The frames to write; those before them are stepped all the same, so a frame does not depend on the "
      "choice.",
      {"--frames", "1-48x2,60"});
  row("loop", &S::loop, truth(),
      "Replay one period of the clip before its first frame, so that the end meets the beginning.");
  row("units", &S::metres_per_unit, length({1e-9, 1e9, "the file's own"}), "Length of the file's unit.",
      {"--units", "METRES"});
  row("up", &S::up, word({"x", "y", "z"}, "the file's own"), "The axis that points up.", {"--up", "x|y|z"});
  row("rest", &S::rest, rest_pose(),
      "The pose without wrinkles: a skin's bind pose, a frame, or a model with the same vertices; auto takes "
      "the bind pose, else frame 1. Of solved wrinkles also uv: flat panels, cut where the texture "
      "coordinates are; without a length they get the size of the model at rest.",
      {"--rest", "bind|frame:N|uv|FILE"});
  row("cache", &S::cache, file_path({".mdd", ".pc2"}),
      "A point cache that moves the model's vertices; its positions are in the model's own unit and axes.",
      {"--cache", "FILE"});
}

struct WrinkleSettings {
  double wavelength = 0;                   // metres of the rest pose; 0: from the mesh
  std::filesystem::path wavelength_map;    // a picture in uv, or a PLY with a wavelength a vertex; or none
  double wavelength_low = 0;               // metres: where the picture is black; 0: half the wavelength
  double strength = 1;                     // multiplies h
  std::string profile = "sinusoid";        // of mesh/wave_profiles.h, or FILE
  std::vector<std::string> only, exclude;  // names of meshes or materials
  double dead_zone = 0.005;                // of 1 − r, ≥ 1e-4
  double irregularity = 0;                 // 0…1: seeded noise, ±25 % of wavelength, phase and height at 1
  std::uint32_t seed = 1;
  int fine = 0;             // finer waves along each of these; 0: none
  double fine_share = 0.5;  // their steepness over that of the coarse ones
};

template <typename Row>
void wrinkle_keys(Row& row) {
  using S = WrinkleSettings;
  row("wavelength", &S::wavelength, length({1e-9, 1e9, "from the mesh"}),
      "Length of a wave in the rest pose.", {"--wavelength", "L"});
  row("wavelength_map", &S::wavelength_map, file_path(),
      "Wavelengths that vary over the cloth: a picture in uv, white where they are 'wavelength' and black "
      "where they are 'wavelength_low'; or a PLY over the rest pose with x, y, z and wavelength for every "
      "vertex, in the model's unit.");
  row("wavelength_low", &S::wavelength_low, length({1e-9, 1e9, "half the wavelength"}),
      "Length of a wave where the picture is black.");
  row("fine", &S::fine, whole(0, 32), "Finer wrinkles on the waves, so many to each of them; 0: none.");
  row("fine_share", &S::fine_share, number({0, 4}),
      "How steep the finer wrinkles are, over the coarse ones; together they take the cloth's length.");
  row("strength", &S::strength, number({0, 10}), "Factor on the height of all waves.", {"--strength", "S"});
  row("profile", &S::profile, word_or_file(wave_profile_names()), "The shape of a wave.",
      {"--profile", either(wave_profile_names(), "|", "|") + "|FILE"});
  row("only", &S::only, names(), "Meshes or materials that wrinkle; none named: all.",
      {"--only", "MESH|MATERIAL"});
  row("exclude", &S::exclude, names(), "Meshes or materials that do not wrinkle.",
      {"--exclude", "MESH|MATERIAL"});
  row("dead_zone", &S::dead_zone, number({1e-4, 0.5}),
      "Compression 1 − r below which there is no wave yet; waves ease in across it.");
  row("irregularity", &S::irregularity, number({0, 1}),
      "Seeded noise on wavelength, place and height, ±25 % of a wave at 1.");
  row("seed", &S::seed, whole(0, most_seed), "Seed of the noise and of the first phases.");
}

enum class FieldUse { bias, direct };  // docs/passes.md, "Fields"

// Wrinkles of the rest pose; at most one of the paths is given.
struct BiasSettings {
  std::filesystem::path paint;  // a paint file, whose strokes are painted when the scene is loaded
  std::filesystem::path file;   // what `plisse paint` wrote: PLY or uv texture
  // A solved wrinkle field: PLY, or the amplitudes of a set of text files; or a pattern for one a frame.
  std::filesystem::path field;
  FieldUse use = FieldUse::bias;
};

template <typename Row>
void bias_keys(Row& row) {
  using S = BiasSettings;
  row("paint", &S::paint, file_path(), "A paint file (docs/paint.md), painted when the scene is loaded.");
  row("file", &S::file, file_path(), "What 'plisse paint' wrote: bias.ply, or the uv texture bias.png.");
  row("field", &S::field, file_or_pattern(),
      "A solved wrinkle field over the rest pose: a PLY with amplitude and phase, or NAME_amplitude_REST.txt "
      "with NAME_phi_REST.txt and NAME_dphi_REST.txt beside it (then the model is their OBJ). A pattern "
      "names one for every frame, over the surface of that frame; it goes with use = \"direct\".");
  row("use", &S::use, enumeration<FieldUse>({{"bias", FieldUse::bias}, {"direct", FieldUse::direct}}),
      "How a field is used: its waves start and are then crush's and relax's (bias), or amplitude times "
      "cosine as it was solved, carried by the surface: deeper where it is pressed along the waves, flat "
      "where "
      "it is pulled, with the animation's own waves across them (direct).");
}

enum class SolveMethod { direct, bias, passes };
enum class SolveQuality { draft, final };

// Wrinkles that are solved for (docs/wrinkle.md, "Any moving mesh"): a scene with this table is solved before
// it is drawn.
struct SolveSettings {
  bool on = false;  // the scene has the table, or --solve is given
  SolveMethod method = SolveMethod::direct;
  SolveQuality quality = SolveQuality::final;
  std::string fabric;               // as parse_fabric takes it; empty: one whose waves have the wavelength
  double follow = -1;               // Λ, metres; −1: from the mesh; 0: nothing is handed to waves
  double tension_limit = 0.05;      // of λ₁, twice the Green strain; 0: none
  std::vector<std::string> bodies;  // meshes or materials of the model, or models' files
  double gap = -1;                  // metres between cloth and bodies; −1: half the cloth's thickness
};

template <typename Row>
void solve_keys(Row& row) {
  using S = SolveSettings;
  row("method", &S::method,
      enumeration<SolveMethod>(
          {{"direct", SolveMethod::direct}, {"bias", SolveMethod::bias}, {"passes", SolveMethod::passes}}),
      "What is drawn on the base surface that follows the model: its solved field (direct); the waves of "
      "crush "
      "and relax, with the field of each frame's base as its bias, so that heights, directions and lengths "
      "are "
      "the field's, and relax evens the phases out (bias); or the waves of crush and relax against the rest "
      "pose, which "
      "cost less (passes).",
      {"--method", "direct|bias|passes"});
  row("quality", &S::quality,
      enumeration<SolveQuality>({{"draft", SolveQuality::draft}, {"final", SolveQuality::final}}),
      "Fields between the clip's keys are interpolated (draft), or solved as well (final).",
      {"--quality", "draft|final"});
  row("fabric", &S::fabric, fabric_text("one is chosen"),
      "The cloth; without it one is chosen whose waves have the 'wavelength' of [wrinkles], in the median; "
      "without that, three mean edges of the rest pose.",
      {"--fabric", "B,E|NAME"});
  row("follow", &S::follow,
      length({0, 1e9, "8 mean edges of sequences and caches, 4 of skins and morphs", -1}),
      "What is shorter than this in the model's motion is handed to the waves; 0: nothing.",
      {"--follow", "LENGTH"});
  row("tension_limit", &S::tension_limit, number({0, 1e6}),
      "How far stretch counts as the cloth's tension, as twice the Green strain: what a rig stretches beyond "
      "is none; 0: all counts.",
      {"--tension-limit", "X"});
  row("bodies", &S::bodies, names_or_files(),
      "What the cloth stays outside of, base surface and waves: meshes or materials of the model, or files "
      "of "
      "models that move with it; each must be closed.",
      {"--body", "MESH|MATERIAL|FILE"});
  row("gap", &S::gap, length({0, 1e9, "half the fabric's thickness, at least 1/50 of an edge", -1}),
      "How far the base surface stays from the bodies.");
}

enum class RelaxMode { descent, smooth };  // state over time, rule 3

struct RelaxSettings {
  RelaxMode mode = RelaxMode::smooth;
  int rounds = 1;              // descent rounds per stepped frame
  double epsilon = 13.2;       // ε of eq. 6; stable below 19.7 on any mesh
  int interval = 1;            // crush and relax every n-th frame
  int onset_rounds = 8;        // P of rule 3
  int smoothing_rounds = 300;  // S of rule 3
};

template <typename Row>
void relax_keys(Row& row) {
  using S = RelaxSettings;
  row("mode", &S::mode,
      enumeration<RelaxMode>({{"smooth", RelaxMode::smooth}, {"descent", RelaxMode::descent}}),
      "How a wave gets its first phase: from its neighbours (smooth), or at random as in the paper "
      "(descent).",
      {"--relax", "descent|smooth"});
  row("rounds", &S::rounds, whole(0, 1000), "Descent rounds in a frame.", {"--rounds", "N"});
  row("epsilon", &S::epsilon, number({0, 19.7}),
      "Step ε of the descent (eq. 6); below 2π² it is stable on any mesh.");
  row("interval", &S::interval, whole(1, 1000), "Crush and relax run in every n-th frame and hold between.",
      {"--interval", "N"});
  row("onset_rounds", &S::onset_rounds, whole(0, 1000),
      "Rounds in which new waves take their phase from the waves beside them.");
  row("smoothing_rounds", &S::smoothing_rounds, whole(0, 100000),
      "Rounds of complex smoothing where many waves begin at once.");
}

}  // namespace plisse::config
