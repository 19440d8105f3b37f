// plisse wrinkle: a base surface → its forms → amplitude and phase → field files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cloth/cloth_look.h"
#include "cloth/drape_scene.h"
#include "wrinkle/field.h"
#include "wrinkle/wrinkle_free.h"

namespace plisse::cloth {

// The surface of the solve, metres.
struct WrinkleScene {
  std::string name;
  wrinkle::BaseSurface surface;
  shell::Material material;
  std::vector<bool> held;  // one a vertex: held while draping
  // Its facets are chords of a smooth surface that was solved for (wrinkle::correct_chords); not so of the
  // TFW authors' set-ups, whose own program takes their strain as it is.
  bool chords = true;
  double tension_limit = 0;  // of λ₁: what is beyond is no tension (wrinkle/facets.h); 0: none
  // m, one a vertex: the largest amplitude that a body leaves there; empty: no body is near.
  std::vector<double> room = {};
  std::shared_ptr<const ClothLook> look =
      nullptr;  // of the model that it was made of; null: nothing is known
};

// A base.ply of `plisse drape`, with rest triangles and material. Throws Error(bad_input).
WrinkleScene read_base(const std::filesystem::path& file);
// The scene's last frame; drapes it first where it is not solved. Throws Error(check_failed) where that does
// not converge. `cache`: as DrapeRequest's.
WrinkleScene base_of(const DrapeScene& scene, const std::filesystem::path& cache = {});

struct WrinkleRequest {
  WrinkleScene scene;
  wrinkle::WrinkleFreeRule rule = wrinkle::WrinkleFreeRule::paper;
  wrinkle::CurvatureFit curvature;
  bool v1 = true, v2 = true, relaxed_integrability = true;  // ablations, see wrinkle::Model
  double curvature_factor = 1;
  bool crest_compression = false;
  bool chords = true;    // take the facets' part out of the compression, where the scene says so too
  bool noise = true;     // compression that is nothing but noise seeds no waves (wrinkle::find_noise)
  bool pin_held = true;  // no amplitude where the surface is held
  wrinkle::FieldOptions options;
  std::filesystem::path
      output;  // field.ply, or NAME_amplitude_REST.txt for the authors' three text files; empty: none
  std::filesystem::path mesh;  // the waves as geometry: .ply, .obj or .glb; empty: none
  std::optional<int> levels;   // how often edges are halved for it; see wrinkle_mesh
  bool mesh_v1 = false;        // its waves have the tangential displacement v₁
  std::filesystem::path
      cache;  // folder of fields that were found before (pipeline/solved_cache.h); empty: none
};

struct WrinkleOutput {
  std::filesystem::path path;
  std::string kind;  // "field", "mesh"
};

struct WrinkleReport {
  std::size_t vertices = 0, faces = 0, wrinkle_free_faces = 0, released_faces = 0;
  wrinkle::Field field;
  double max_amplitude = 0;           // metres
  std::size_t wrinkled_vertices = 0;  // amplitude above a hundredth of the largest
  std::vector<WrinkleOutput> outputs;
  int levels = 0;  // of the mesh
  double upsample_s = 0, wall_s = 0;
  bool from_cache = false;
  double saved_s = 0;  // time of the field's solve, less that of looking it up
};

WrinkleReport wrinkle_field(const WrinkleRequest& request);

// What its base surface is to the solver: the forms of each face, chords and noise seen to.
std::vector<wrinkle::FaceForms> forms_of(const WrinkleRequest& request);

// Material and ablations, for the solver.
wrinkle::Model model_of(const WrinkleRequest& request);

struct WrinkleEvaluation {
  double energy = 0;  // J, as the solver's
  double kkt = 0;     // scaled residual
  // Radians: the largest |sum of dφ round a face| where it has to be 0: on faces with waves, and on all of
  // them where integrability is not relaxed.
  double curl_max = 0;
};

// The energy of a field from another program: text files with one amplitude per vertex and one dφ per edge.
WrinkleEvaluation evaluate_field(const WrinkleRequest& request, const std::filesystem::path& amplitude,
                                 const std::filesystem::path& one_form);

}  // namespace plisse::cloth
