// The data of the reference's render pass, and the shading of a pixel (Loviscach 2006, section 6;
// docs/passes.md, "Render"). Colours are linear. World vectors and lengths are in one unit, wavenumbers in
// turns per that unit.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "reference/waves.h"

namespace plisse::reference {

struct Triangle {
  WaveTriangle waves;
  std::optional<CarriedField> field = std::nullopt;
  Eigen::Matrix3d normals;  // posed normals of the corners, columns, unit
  Eigen::Matrix<double, 2, 3> uv{Eigen::Matrix<double, 2, 3>::Zero()};
  Eigen::Matrix<double, 2, 3> normal_uv{Eigen::Matrix<double, 2, 3>::Zero()};  // of the normal map
  Eigen::Matrix<double, 4, 3> colours{Eigen::Matrix<double, 4, 3>::Ones()};    // of the corners, linear
  std::array<std::uint32_t, 3> welded{};  // equal ids = the same vertex of the surface
  int material = 0;
};

// Levels of a texture, finest first, each half the last (rounded down, at least 1). Texel (column, row) of a
// level is entry row·width + column, linear red, green, blue and alpha; row 0 is at v = 0. Repeats in both
// directions.
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<Eigen::Vector4f> texels;
};
struct Texture {
  std::vector<TextureLevel> levels;
};
// Trilinear, at a level of detail clamped to the levels there are.
Eigen::Vector4d sample(const Texture& texture, const Eigen::Vector2d& uv, double level);

struct Material {
  Eigen::Vector3d base_colour{1, 1, 1};
  double base_alpha = 1;
  int texture = -1;          // −1 none
  int normal_texture = -1;   // likewise; its channels, 0…1, are the normal's components, −1…1
  double normal_scale = 1;   // of the normal map's x and y
  double alpha_cutoff = -1;  // pixels with less alpha are cut; negative: none
  bool blended = false;      // blended with what is behind it by its alpha; else opaque
  bool two_sided = true;     // false: triangles seen from behind are not drawn
};

struct Light {
  Eigen::Vector3d direction{0, 1, 0};  // L: unit, toward the light
  Eigen::Vector3d colour{0, 0, 0};     // C: intensity included
};

// The key light's depth map.
struct ShadowMap {
  Eigen::Matrix4d matrix;    // world → clip space; NDC −1…1 become 0…1 in x, y and depth
  int size = 0;              // texels a side
  std::vector<float> depth;  // size², entry row·size + column, row 0 at y = 0; outside all is lit
  double texel_size = 0;     // of the world
};

struct Shading {
  Blend blend = Blend::smooth;
  Gradient gradient = Gradient::full;
  double roughness = 0.75, sheen = 0.15, cavity = 1.2, parallax = 1;
};

struct Lighting {
  std::array<Light, 3> lights;       // key, fill, rim
  Eigen::Vector3d ambient{0, 0, 0};  // A
  Eigen::Vector3d up{0, 1, 0};       // unit
  std::optional<ShadowMap> shadow;
};

struct Camera {
  Eigen::Matrix4d view_projection;  // world → clip space as in OpenGL, −w ≤ z ≤ w
  Eigen::Vector3d eye;
};

struct Scene {
  std::vector<Triangle> triangles;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  Camera camera;
  Lighting lighting;
  Shading shading;
  Profile profile;
};

// 1 lit … 0 in shadow at x' of a surface whose side toward the viewer has normal n_s.
double shadow_factor(const ShadowMap& map, const Eigen::Vector3d& position, const Eigen::Vector3d& n_s);

// A pixel of a triangle: barycentric coordinates with perspective, and their exact derivatives by the pixel
// coordinates (columns: to the right, downward).
struct Fragment {
  Eigen::Vector3d barycentric;
  Eigen::Matrix<double, 3, 2> per_pixel;
};
struct Shaded {
  Eigen::Vector3d colour{0, 0, 0};  // after the tone curve's shoulder, linear, before sRGB encoding
  double alpha = 1;                 // of base colour and texture
  bool visible = true;              // false: cut by alpha, or the back of a single-sided material
};
Shaded shade(const Scene& scene, const Triangle& triangle, const Fragment& fragment);

// The normal of the triangle's plane, of any length, on the side of its corners' normals: the triangle is
// seen from the front where this points to the eye.
Eigen::Vector3d front_of(const Triangle& triangle);

// "Cavity": the share of the sky that is visible from a point of a groove, on the side of positive heights; 1
// where the amplitude is 0.
double groove_occlusion(double cavity, double amplitude, double height, double longest_wavenumber);

// Eq. 10 with (v·n)², for unit v and n_s and the height along n_s, without strength, fade-out and limit.
Eigen::Vector3d parallax_shift(const Eigen::Vector3d& v, const Eigen::Vector3d& n_s, double height);

// The whole Δx of docs/passes.md; `longest_wavenumber` = max |κ_j|.
Eigen::Vector3d limited_parallax_shift(const Eigen::Vector3d& v, const Eigen::Vector3d& n_s, double height,
                                       double strength, double longest_wavenumber);

// IEC 61966-2-1, of one channel in 0…1.
double srgb_encode(double linear);

}  // namespace plisse::reference
