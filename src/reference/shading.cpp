#include "reference/shading.h"

#include <algorithm>
#include <cmath>

#include "reference/functions.h"

namespace plisse::reference {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

int repeat(int i, int size) {
  return ((i % size) + size) % size;
}

Vector4d bilinear(const TextureLevel& level, const Vector2d& uv) {
  const double x = uv.x() * level.width - 0.5, y = uv.y() * level.height - 0.5;
  const double left = std::floor(x), low = std::floor(y);
  const auto texel = [&](double column, double line) -> Vector4d {
    const int c = repeat(static_cast<int>(column), level.width),
              r = repeat(static_cast<int>(line), level.height);
    return level.texels[static_cast<std::size_t>(r) * level.width + c].cast<double>();
  };
  const double s = x - left, t = y - low;
  return (1 - t) * ((1 - s) * texel(left, low) + s * texel(left + 1, low)) +
         t * ((1 - s) * texel(left, low + 1) + s * texel(left + 1, low + 1));
}

// log₂ of the longer side of the pixel's footprint in texels of the finest level.
double footprint_level(const Texture& texture, const Eigen::Matrix2d& uv_per_pixel) {
  const Vector2d size(texture.levels[0].width, texture.levels[0].height);
  const double side =
      std::max(size.cwiseProduct(uv_per_pixel.col(0)).norm(), size.cwiseProduct(uv_per_pixel.col(1)).norm());
  return side > 0 ? std::log2(side) : 0;
}

// The unit direction in which a coordinate with gradient g grows along a surface of unit normal n; 0 where
// there is none.
Vector3d growth(const Vector3d& g, const Vector3d& n) {
  const Vector3d along = g - g.dot(n) * n;
  const double length = along.norm();
  return length > 1e-15 ? Vector3d(along / length) : Vector3d::Zero();
}

double shoulder(double x) {
  return x < 0.8 ? x : 0.8 + 0.2 * (x - 0.8) / (x - 0.6);
}

}  // namespace

double groove_occlusion(double cavity, double amplitude, double height, double longest_wavenumber) {
  if (!(amplitude > 0)) return 1;
  const double depth = std::clamp(0.5 * (1 - height / amplitude), 0.0, 1.0);
  const double q = 2 * pi * amplitude * longest_wavenumber;
  return std::max(0.0, 1 - cavity * depth * (1 - 1 / std::sqrt(1 + q * q)));
}

Vector4d sample(const Texture& texture, const Vector2d& uv, double level) {
  const double last = static_cast<double>(texture.levels.size() - 1);
  const double clamped = std::clamp(level, 0.0, last);
  const auto fine = static_cast<std::size_t>(clamped);
  const std::size_t coarse = std::min(fine + 1, texture.levels.size() - 1);
  const double t = clamped - static_cast<double>(fine);
  return (1 - t) * bilinear(texture.levels[fine], uv) + t * bilinear(texture.levels[coarse], uv);
}

Vector3d parallax_shift(const Vector3d& v, const Vector3d& n_s, double height) {
  const double c = v.dot(n_s);
  return (v - c * n_s) * c / (c * c + 0.1) * height;
}

Vector3d limited_parallax_shift(const Vector3d& v, const Vector3d& n_s, double height, double strength,
                                double longest_wavenumber) {
  const Vector3d shift = parallax_shift(v, n_s, height) * strength * smoothstep(0, 0.2, v.dot(n_s));
  const double length = shift.norm(), excess = 4 * longest_wavenumber * length;  // over λ/4
  return excess > 1 ? Vector3d(shift / excess) : shift;
}

double shadow_factor(const ShadowMap& map, const Vector3d& position, const Vector3d& n_s) {
  const Vector4d clip = map.matrix * Vector3d(position + 1.5 * map.texel_size * n_s).homogeneous();
  const Vector3d point = (clip.head<3>() / clip.w()).array() * 0.5 + 0.5;
  const double depth = std::clamp(point.z() - 1e-3, 0.0, 1.0);
  const auto lit = [&](int column, int line) -> double {
    if (column < 0 || line < 0 || column >= map.size || line >= map.size) return 1;
    return depth <= map.depth[static_cast<std::size_t>(line) * map.size + column] ? 1 : 0;
  };
  double sum = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const double x = point.x() * map.size - 0.5 + dx, y = point.y() * map.size - 0.5 + dy;
      // Far outside the map everything is lit; the clamp makes the conversion to int valid.
      const double left = std::floor(std::clamp(x, -2.0, map.size + 1.0));
      const double low = std::floor(std::clamp(y, -2.0, map.size + 1.0));
      const double s = std::clamp(x - left, 0.0, 1.0), t = std::clamp(y - low, 0.0, 1.0);
      const int c = static_cast<int>(left), r = static_cast<int>(low);
      sum += (1 - t) * ((1 - s) * lit(c, r) + s * lit(c + 1, r)) +
             t * ((1 - s) * lit(c, r + 1) + s * lit(c + 1, r + 1));
    }
  return sum / 9;
}

Vector3d front_of(const Triangle& triangle) {
  const auto& corners = triangle.waves.corners;
  const Vector3d plane =
      Vector3d(corners.col(1) - corners.col(0)).cross(Vector3d(corners.col(2) - corners.col(0)));
  return plane.dot(triangle.normals.rowwise().sum()) < 0 ? Vector3d(-plane) : plane;
}

Shaded shade(const Scene& scene, const Triangle& triangle, const Fragment& fragment) {
  const WaveTriangle& waves = triangle.waves;
  const Shading& shading = scene.shading;
  const Material& material = scene.materials[static_cast<std::size_t>(triangle.material)];
  const Vector3d position = waves.corners * fragment.barycentric;
  const Vector3d v = (scene.camera.eye - position).normalized();

  const Vector3d plane = front_of(triangle);
  Vector3d normal = triangle.normals * fragment.barycentric;
  normal = normal.norm() > 0 ? normal.normalized() : plane.normalized();  // n'
  const double side = plane.dot(v) < 0 ? -1 : 1;
  const Vector3d n_s = side * normal;

  // The waves, faded as they near two pixels.
  const Eigen::Matrix<double, 3, 2> turns_per_pixel = corner_turns(waves) * fragment.per_pixel;
  const Profile& profile = scene.profile;
  Vector3d fade, fine_fade, wavenumber, slope_squared;
  for (int j = 0; j < 3; ++j) {
    fade[j] = 1 - smoothstep(0.25, 0.5, turns_per_pixel.row(j).norm());
    fine_fade[j] = 1 - smoothstep(0.25, 0.5, profile.fine_waves * turns_per_pixel.row(j).norm());
    wavenumber[j] = waves.wavenumbers.col(j).norm();
    slope_squared[j] = 0.5 * std::pow(2 * pi * waves.heights[j] * wavenumber[j], 2) * profile.slope_power;
  }
  double longest_wavenumber = wavenumber.maxCoeff();
  HeightSample wave = height_and_gradient(waves, fragment.barycentric, profile, shading.blend,
                                          shading.gradient, fade, fine_fade);
  const double fine_slope = profile.fine * profile.fine_waves;
  const Vector3d lost = std::pow(profile.coarse, 2) * (1 - fade.array().square()) +
                        std::pow(fine_slope, 2) * (1 - fine_fade.array().square());
  double lost_slope = wave.weights.dot(slope_squared.cwiseProduct(lost));
  double amplitude =
      wave.weights.dot(waves.heights.cwiseProduct(profile.coarse * fade + profile.fine * fine_fade));
  if (triangle.field) {
    const CarriedField& field = *triangle.field;
    const FieldSample carried = sample(field, waves.corners, fragment.barycentric, shading.blend);
    const Vector2d per_pixel = (wave.weights.transpose() * field.turns * fragment.per_pixel).transpose();
    const double left = 1 - smoothstep(0.25, 0.5, per_pixel.norm());
    wave.height += left * carried.height;
    wave.gradient += left * carried.gradient;
    amplitude += left * carried.amplitude;
    lost_slope +=
        0.5 * std::pow(2 * pi * carried.amplitude, 2) * carried.slope.squaredNorm() * (1 - left * left);
    const Matrix3d slopes = barycentric_gradients(waves.corners) * field.turns.transpose();
    longest_wavenumber = slopes.colwise().norm().maxCoeff();
    for (int j = 0; j < 3; ++j)
      if (waves.heights[j] > 0) longest_wavenumber = std::max(longest_wavenumber, wavenumber[j]);
  }
  const double height = side * wave.height;
  const double occlusion = groove_occlusion(shading.cavity, amplitude, height, longest_wavenumber);

  // Textures, shifted by the parallax.
  const auto corner_gradients = barycentric_gradients(waves.corners);
  const Vector3d shift = limited_parallax_shift(v, n_s, height, shading.parallax, longest_wavenumber);
  const auto texel_of = [&](int id, const Eigen::Matrix<double, 2, 3>& uvs) {
    const Texture& texture = scene.textures[static_cast<std::size_t>(id)];
    const Vector2d uv = uvs * (fragment.barycentric + corner_gradients.transpose() * shift);
    return sample(texture, uv, footprint_level(texture, uvs * fragment.per_pixel));
  };
  Shaded result;
  Vector4d colour = triangle.colours * fragment.barycentric;
  colour.head<3>() = colour.head<3>().cwiseProduct(material.base_colour);
  colour.w() *= material.base_alpha;
  if (material.texture >= 0) colour = colour.cwiseProduct(texel_of(material.texture, triangle.uv));
  const Vector3d albedo = colour.head<3>();
  result.alpha = colour.w();
  Vector3d bent = normal - wave.gradient;
  if (material.normal_texture >= 0) {
    const Vector3d m = 2 * texel_of(material.normal_texture, triangle.normal_uv).head<3>().array() - 1;
    const Eigen::Matrix<double, 3, 2> uv_gradients = corner_gradients * triangle.normal_uv.transpose();
    bent = std::max(m.z(), 0.05) * bent +
           material.normal_scale *
               (m.x() * growth(uv_gradients.col(0), normal) + m.y() * growth(uv_gradients.col(1), normal));
  }
  const Vector3d N = side * bent.normalized();
  const bool cut = material.alpha_cutoff >= 0 && result.alpha < material.alpha_cutoff;
  result.visible = !cut && (material.two_sided || side > 0);

  // Light.
  const double a2 = std::clamp(std::pow(shading.roughness, 4) + lost_slope, 1e-3, 1.0);
  const Vector3d ambient = scene.lighting.ambient * (0.6 + 0.4 * N.dot(scene.lighting.up));
  const double fuzz = shading.sheen * std::pow(1 - std::max(N.dot(v), 0.0), 3);
  Vector3d diffuse = ambient * occlusion, specular = Vector3d::Zero();
  for (std::size_t i = 0; i < scene.lighting.lights.size(); ++i) {
    const Light& light = scene.lighting.lights[i];
    const Vector3d L = light.direction, H = (L + v).normalized();
    const double shadow =
        i == 0 && scene.lighting.shadow ? shadow_factor(*scene.lighting.shadow, position, n_s) : 1;
    const double d = std::max(0.0, (N.dot(L) + 0.15) / 1.15) * smoothstep(-0.15, 0.25, n_s.dot(L)) * shadow;
    const double NH = N.dot(H), LH = L.dot(H);
    const double distribution = a2 / (pi * std::pow(NH * NH * (a2 - 1) + 1, 2));
    const double fresnel = 0.04 + 0.96 * std::pow(1 - LH, 5);
    const double share = i == 0 ? (1 + occlusion) / 2 : occlusion;  // o_i
    diffuse += light.colour * d * share;
    specular += light.colour * distribution * fresnel / (4 * std::max(LH * LH, 0.1)) * d * share;
  }
  const Vector3d light = (albedo.array() + fuzz).matrix().cwiseProduct(diffuse) + specular;
  result.colour = light.unaryExpr(&shoulder);
  return result;
}

double srgb_encode(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

}  // namespace plisse::reference
