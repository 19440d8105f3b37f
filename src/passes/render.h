// Render: the surface with its wrinkles as shading (docs/passes.md, "Render"; Loviscach 2006, 6), the key
// light's depth map and the backdrop with its ground.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/target.h"
#include "passes/aov.h"
#include "passes/part_shapes.h"
#include "passes/profile.h"
#include "passes/profile_texture.h"
#include "passes/surface_buffers.h"
#include "passes/texture.h"

namespace plisse::passes {

struct DirectionalLight {
  glm::dvec3 direction{0, 1, 0};  // toward the light, unit
  glm::dvec3 colour{1};           // linear, intensity included
};

// One view of one moment, in model units.
struct View {
  glm::dmat4 view_projection{1};
  glm::dvec3 eye{0, 0, 1}, forward{0, 0, -1}, up{0, 1, 0};
  std::array<DirectionalLight, 3> lights;  // key, fill, rim
  glm::dvec3 ambient{0.3};
  glm::dvec3 bounds_centre{0};  // of the whole clip: the key light's map must contain it
  double bounds_radius = 1;
  double floor = 0;  // height of the ground along up
};

struct Look {
  bool smooth_blend = true, full_gradient = true;
  bool plain = false;      // no waves at all
  bool field = false;      // the surface carries a solved wrinkle field (VertexWaves::field)
  bool displaced = false;  // the surface is a displaced one (DisplacementPass); without waves of its own
  bool phong = false;      // with plain: textured Phong, for comparison in the benchmark
  bool shadows = false, ground = false, wireframe = false;
  double roughness = 0.75, cavity = 1.2, parallax = 1, sheen = 0.15;
  glm::dvec3 background{0.6};  // linear
  bool transparent = false;
};

struct DrawPart {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  glm::vec4 base_colour{1};  // linear
  int texture = -1;
  int normal_texture = -1;
  float normal_scale = 1;
  bool has_colours = false;  // of its vertices
  bool has_alpha = false;    // blended after the opaque parts
  float alpha_cutoff = 0;    // > 0: masked
  bool two_sided = true;
  bool wrinkles = true;  // some vertex of it can have waves
};

// The number of parts for which a draw left work out, without a change to the picture.
struct LeftOut {
  bool nothing_in_view = false;  // determined only on a software renderer, like the next two
  int out_of_view = 0;
  int too_fine = 0;    // every wave is shorter than two pixels: only the roughness represents them
  int flat = 0;        // no wave anywhere
  int untextured = 0;  // no parallax, as there is no texture to shift
};

class RenderPass {
 public:
  RenderPass(const Look& look, const Profile& profile, std::vector<DrawPart> parts,
             const std::vector<std::vector<TextureLevel>>& textures, const std::string& shader_folder);
  ~RenderPass();
  RenderPass(const RenderPass&) = delete;
  RenderPass& operator=(const RenderPass&) = delete;

  // Clears, draws, resolves, and puts the backdrop under the surface. The backdrop is drawn with one sample a
  // pixel, as it has no edges. On a software renderer every multisampled pixel costs time: there (`software`)
  // only the rectangle that the surface covers has four samples; the picture is the same. Returns false where
  // nothing of the surface is in view: then only the backdrop and the shadow were drawn.
  bool draw(const SurfaceBuffers& surface, const View& view, const gpu::Target& target, bool software);
  // The same picture with nothing left out, to be compared with `draw`.
  void draw_all(const SurfaceBuffers& surface, const View& view, const gpu::Target& target);
  // Of the last draw.
  const LeftOut& left_out() const { return left_out_; }
  // One quantity as floats into an rgba32f target without multisampling; alpha 1 where the surface is.
  void draw_aov(const SurfaceBuffers& surface, const View& view, const gpu::Target& target, Aov aov);

  // Sets Look::transparent from now on.
  void set_transparent(bool transparent) { look_.transparent = transparent; }

  // The maps from which the last draw took shadows (docs/passes.md, "Depth maps", "Ground"), rows from bottom
  // to top: the key light's depth map, that from below, and the shares of light and sky that the ground
  // loses.
  static constexpr int shadow_size = 1024, below_size = 512, ground_size = 256;
  std::vector<float> shadow_map() const;
  std::vector<float> map_from_below() const;
  std::vector<glm::vec2> ground_map() const;
  static constexpr double shadow_offset = 1e-3;

 private:
  void draw(const SurfaceBuffers& surface, const View& view, const gpu::Target& target,
            const gpu::Rectangle& area);
  void draw_surface(const SurfaceBuffers& surface, const View& view, const gpu::Rectangle& area);
  void write_scene(const View& view);
  void bind_surface(const SurfaceBuffers& surface);
  void draw_shadow_map(const SurfaceBuffers& surface, const View& view);
  void draw_ground_map(const View& view);
  void clear(bool with_depth);
  // `under`: behind what is drawn already. Not possible with blended parts: the remaining share of the
  // backdrop is rounded to steps of 1/255, which is visible in dark places.
  void draw_backdrop(const View& view, bool under);
  bool has_veils() const;  // parts that are blended
  // A program for every set of features that the parts' materials need (render.cpp, features_of).
  using Programs = std::map<unsigned, gpu::Program>;
  gpu::Defines surface_defines() const;  // defines of the surface's programs
  gpu::Defines picture_defines() const;  // and of programs for pictures
  Programs make_programs(const std::vector<std::string>& files, const gpu::Defines& defines) const;
  gpu::Program make_program(const std::vector<std::string>& files, gpu::Defines defines,
                            unsigned features) const;
  std::vector<std::string> surface_files() const;
  // Decides which parts are drawn in this frame, and with which detail of waves. Returns the rectangle that
  // they cover.
  gpu::Rectangle choose(const SurfaceBuffers& surface, const View& view, const gpu::Target& target,
                        bool software);
  const PartShapes& shapes_of(const SurfaceBuffers& surface);
  enum class Detail { full, faded, field_alone, none };  // of waves
  struct Shown {
    bool in_view = true;
    Detail waves = Detail::full;
  };
  // Draws opaque and masked parts, or blended ones; `as_shown`: only those that `choose` selected, with its
  // detail.
  void draw_parts(Programs& programs, bool blended, bool as_shown);
  unsigned depth_map(unsigned& framebuffer, int size);

  Look look_;
  Profile profile_;
  ProfileTexture profile_texture_;
  std::vector<DrawPart> parts_;
  std::vector<Texture> textures_;
  std::string shader_folder_;
  Programs surface_, aov_;
  gpu::Program depth_, lines_, backdrop_, ground_cast_, ground_blur_;
  gpu::Buffer scene_;
  unsigned vertex_array_ = 0;
  unsigned shadow_texture_ = 0, shadow_framebuffer_ = 0, top_texture_ = 0, top_framebuffer_ = 0;
  std::array<unsigned, 2> ground_textures_{};
  gpu::Rectangle ground_area_{0, 0, -1, -1};  // the texels that are not zero
  glm::dmat4 shadow_matrix_{1}, top_matrix_{1};
  double shadow_texel_ = 0;
  std::vector<Shown> shown_;  // one a part
  LeftOut left_out_;
  std::optional<PartShapes> shapes_;
};

}  // namespace plisse::passes
