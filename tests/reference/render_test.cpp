// The reference's rasteriser and shading against ray casting, counting by hand, and closed forms of each
// term.
#include "reference/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/colour.h"
#include "reference/functions.h"

namespace plisse::reference {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

Matrix4d perspective(double vertical_angle, double aspect, double near, double far) {
  const double f = 1 / std::tan(vertical_angle / 2);
  Matrix4d P;
  P << f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), 2 * far * near / (near - far), 0,
      0, -1, 0;
  return P;
}

Camera camera_at(const Vector3d& eye, const Vector3d& target, double aspect = 1) {
  const Vector3d back = (eye - target).normalized(), right = Vector3d::UnitY().cross(back).normalized();
  Matrix4d view = Matrix4d::Identity();
  view.topLeftCorner<3, 3>() << right.transpose(), back.cross(right).transpose(), back.transpose();
  view.topRightCorner<3, 1>() = -view.topLeftCorner<3, 3>() * eye;
  return {perspective(0.8, aspect, 0.1, 100) * view, eye};
}

// A flat triangle without waves.
Triangle plain(const Vector3d& a, const Vector3d& b, const Vector3d& c, std::array<std::uint32_t, 3> welded) {
  Triangle t;
  t.waves.corners << a, b, c;
  t.waves.wavenumbers.setZero();
  t.waves.heights.setZero();
  t.waves.phases.setZero();
  t.normals = Vector3d((b - a).cross(c - a).normalized()).replicate(1, 3);
  t.welded = welded;
  return t;
}

// Only ambient light, white material: what is seen is what is tested.
Scene plain_scene() {
  Scene scene;
  scene.materials.resize(1);
  scene.camera = {Matrix4d::Identity(), {0, 0, 10}};
  scene.lighting.ambient = Vector3d::Constant(0.5);
  scene.lighting.up = Vector3d::UnitZ();
  scene.shading.sheen = 0;
  scene.shading.cavity = 0;
  scene.profile = sinusoid();
  return scene;
}

// A point of a picture of width × height pixels to NDC.
Vector3d at_pixel(double x, double y, int width, int height) {
  return {2 * x / width - 1, 1 - 2 * y / height, 0};
}

int covered(const Picture& picture) {
  int count = 0;
  for (const int triangle : picture.triangle) count += triangle >= 0;
  return count;
}

TEST(ReferenceRaster, CoversTheCentresInside) {
  // Legs of 8 pixels from (.2, .2): centres with column + row + 1 < 8.4, so column + row ≤ 7: 36 of them.
  Scene scene = plain_scene();
  const auto p = [](double x, double y) { return at_pixel(x, y, 16, 12); };
  scene.triangles = {plain(p(0.2, 0.2), p(8.2, 0.2), p(0.2, 8.2), {0, 1, 2})};
  const Picture picture = render(scene, 16, 12);
  EXPECT_EQ(covered(picture), 36);
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 16; ++column)
      EXPECT_EQ(picture.triangle[static_cast<std::size_t>(row * 16 + column)] == 0, column + row <= 7);
}

TEST(ReferenceRaster, SharedEdgesLeaveNoGapAndNoSilhouette) {
  // A square whose diagonal runs exactly through pixel centres; its outline runs between them.
  Scene scene = plain_scene();
  const auto p = [](double x, double y) { return at_pixel(x, y, 20, 20); };
  scene.triangles = {plain(p(2, 18), p(18, 18), p(18, 2), {0, 1, 2}),
                     plain(p(2, 18), p(18, 2), p(2, 2), {0, 2, 3})};
  const Picture joined = render(scene, 20, 20);
  EXPECT_EQ(covered(joined), 256);
  int silhouettes = 0;
  for (const auto flag : joined.silhouette) silhouettes += flag;
  // The outline's 60 pixels inside and 64 outside.
  EXPECT_EQ(silhouettes, 60 + 64);
  // The same with vertices that are not the same vertex: now the diagonal is the end of two surfaces.
  scene.triangles[1].welded = {4, 5, 6};
  const Picture apart = render(scene, 20, 20);
  silhouettes = 0;
  for (const auto flag : apart.silhouette) silhouettes += flag;
  EXPECT_EQ(silhouettes, 60 + 64 + 14);  // 16 centres on the diagonal, two of them already in the outline
}

TEST(ReferenceRaster, SilhouetteWhereDepthsOrEdgesAreTooClose) {
  Scene scene = plain_scene();
  const auto p = [](double x, double y, double z) {
    Vector3d point = at_pixel(x, y, 20, 20);
    point.z() = z;
    return point;
  };
  const auto flag = [&](double edge, double gap) {
    // A large triangle, and over its left part one that ends at x = edge and lies `gap` in front.
    scene.triangles = {
        plain(p(-50, -50, 0.1), p(-50, 90, 0.1), p(90, -50, 0.1), {0, 1, 2}),
        plain(p(edge, -500, 0.1 - gap), p(edge, 500, 0.1 - gap), p(-500, 0, 0.1 - gap), {3, 4, 5})};
    const Picture picture = render(scene, 20, 20);
    return std::pair(picture.silhouette[5 * 20 + 10], picture.triangle[5 * 20 + 10]);
  };
  EXPECT_EQ(flag(10.6, 0.01), std::pair(std::uint8_t{0}, 1));    // well inside the front one
  EXPECT_EQ(flag(10.4, 0.01), std::pair(std::uint8_t{0}, 0));    // well outside
  EXPECT_EQ(flag(10.505, 0.01), std::pair(std::uint8_t{1}, 1));  // its edge within .01 pixel
  EXPECT_EQ(flag(10.495, 0.01), std::pair(std::uint8_t{1}, 0));
  EXPECT_EQ(flag(10.505, -0.01).first, 0);  // behind: cannot show
  EXPECT_EQ(flag(15, 1e-7).first, 1);       // the two depths cannot be told apart
}

TEST(ReferenceRaster, SeesWhatRaysSee) {
  // A soup of triangles, some of which cross the plane of the eye, against Möller–Trumbore from the eye
  // through each centre: the same triangle and depth wherever the picture is not marked.
  const int width = 64, height = 48;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-2, 2);
  Scene scene = plain_scene();
  scene.camera = camera_at({0.3, 0.4, 2.5}, {0, 0, 0}, static_cast<double>(width) / height);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const auto point = [&] { return Vector3d(place(random), place(random), 1.8 * place(random)); };
    const Vector3d a = point(), b = point(), c = point();
    scene.triangles.push_back(plain(a, b, c, {3 * i, 3 * i + 1, 3 * i + 2}));
  }
  const Picture picture = render(scene, width, height);
  int marked = 0, hits = 0, crossing = 0;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row * width + column);
      marked += picture.silhouette[pixel];
      Vector4d near = at_pixel(column + 0.5, row + 0.5, width, height).homogeneous();
      near.z() = -1;
      const Vector3d start = (scene.camera.view_projection.inverse() * near).hnormalized();
      const Vector3d direction = (start - scene.camera.eye).normalized();
      int nearest = -1;
      double distance = 1e30;
      for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Matrix3d& corners = scene.triangles[i].waves.corners;
        Matrix3d system;
        system << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0), -direction;
        const Vector3d hit = system.inverse() * (start - corners.col(0));
        if (hit[0] >= 0 && hit[1] >= 0 && hit[0] + hit[1] <= 1 && hit[2] >= 0 && hit[2] < distance) {
          distance = hit[2];
          nearest = static_cast<int>(i);
        }
      }
      if (picture.silhouette[pixel]) continue;
      ASSERT_EQ(picture.triangle[pixel], nearest) << column << " " << row;
      if (nearest < 0) continue;
      ++hits;
      const Vector4d clip = scene.camera.view_projection * (start + distance * direction).homogeneous();
      EXPECT_NEAR(picture.depth[pixel], clip.z() / clip.w(), 1e-9);
      const Matrix3d& corners = scene.triangles[static_cast<std::size_t>(nearest)].waves.corners;
      crossing += corners.row(2).maxCoeff() > scene.camera.eye.z();
    }
  EXPECT_GT(hits, width * height / 2);
  EXPECT_GT(crossing, 50);
  EXPECT_LT(marked, width * height / 3);
}

TEST(ReferenceRaster, TextureLevelFollowsThePixelsFootprint) {
  // Level n is painted n/10. A tilted plane: its footprint from finite differences of rays is the
  // reference's.
  const int size = 32;
  Scene scene = plain_scene();
  scene.camera = camera_at({0, 1.2, 3}, {0, 0, 0});
  Triangle floor = plain({-20, 0, 8}, {20, 0, 8}, {0, 0, -30}, {0, 1, 2});
  floor.uv = floor.waves.corners(std::array{0, 2}, Eigen::all) * 0.7;
  floor.uv.row(1) *= 0.3;
  scene.triangles = {floor};
  scene.lighting.up = Vector3d::UnitY();
  Texture texture;
  for (int level = 0, side = 512; side >= 1; ++level, side /= 2)
    texture.levels.push_back(
        {side, side,
         std::vector<Eigen::Vector4f>(static_cast<std::size_t>(side) * side,
                                      Eigen::Vector4f::Constant(0.1F * static_cast<float>(level)))});
  scene.textures = {texture};
  scene.materials[0].texture = 0;
  const Picture picture = render(scene, size, size);
  const Matrix4d inverse = scene.camera.view_projection.inverse();
  const auto uv_at = [&](double x, double y) {
    Vector4d ndc = at_pixel(x, y, size, size).homogeneous();
    const Vector3d direction = (inverse * ndc).hnormalized() - scene.camera.eye;
    const Vector3d point = scene.camera.eye - direction * scene.camera.eye.y() / direction.y();
    return Vector2d(0.7 * point.x(), 0.21 * point.z());
  };
  int checked = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row * size + column);
      if (picture.triangle[pixel] < 0) continue;
      const double x = column + 0.5, y = row + 0.5, h = 1e-4;
      const double right = 512 * (uv_at(x + h, y) - uv_at(x - h, y)).norm() / (2 * h);
      const double down = 512 * (uv_at(x, y + h) - uv_at(x, y - h)).norm() / (2 * h);
      const double level = std::clamp(std::log2(std::max(right, down)), 0.0, 9.0);
      // colour = texel · A(.6 + .4); floats of the texture: 1e-7.
      EXPECT_NEAR(picture.colour[pixel].x(), 0.5 * 0.1 * level, 1e-6) << column << " " << row;
      ++checked;
    }
  EXPECT_GT(checked, 300);
}

TEST(ReferenceRaster, AlphaCutsAndBacksVanish) {
  Scene scene = plain_scene();
  const Triangle front = plain({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 1, 2});
  const Triangle back = plain({-1, -1, 0.5}, {1, -1, 0.5}, {0, 1, 0.5}, {3, 4, 5});
  scene.triangles = {front, back};
  scene.materials.resize(2);
  scene.triangles[1].material = 1;
  // In these NDC the smaller z is nearer, while the eye stands at z = +10: normals toward +z are its side.
  scene.materials[0].alpha_cutoff = 0.5;
  scene.materials[0].base_alpha = 0.4;
  EXPECT_EQ(render(scene, 8, 8).triangle[4 * 8 + 4], 1);
  scene.materials[0].base_alpha = 0.6;
  EXPECT_EQ(render(scene, 8, 8).triangle[4 * 8 + 4], 0);
  scene.materials[0].two_sided = false;
  EXPECT_EQ(render(scene, 8, 8).triangle[4 * 8 + 4], 0);
  scene.triangles[0].normals *= -1;
  EXPECT_EQ(render(scene, 8, 8).triangle[4 * 8 + 4], 1);
}

// Blended triangles: after the others, in the order of the list, hidden by nearer opaque ones only.
TEST(ReferenceRaster, BlendedTrianglesCompositeInDrawOrder) {
  Scene scene = plain_scene();
  const auto at = [](double z, std::array<std::uint32_t, 3> ids) {
    return plain({-1, -1, z}, {1, -1, z}, {0, 1, z}, ids);
  };
  scene.triangles = {at(0, {0, 1, 2}), at(-0.2, {3, 4, 5}), at(-0.4, {6, 7, 8}), at(0.5, {9, 10, 11})};
  scene.materials.resize(4);
  const double alphas[] = {1, 0.25, 0.5, 0.75};
  for (int i = 0; i < 4; ++i) {
    auto& material = scene.materials[static_cast<std::size_t>(i)];
    scene.triangles[static_cast<std::size_t>(i)].material = i;
    material.base_colour = Vector3d::Constant(0.2 * (i + 1));
    material.base_alpha = alphas[i];
    material.blended = i > 0;
  }
  const std::size_t middle = 4 * 8 + 4;
  // ½ of the light: the floor .1, over it ¼ of .2 and ½ of .3; the last is behind the first.
  const Picture all = render(scene, 8, 8);
  EXPECT_NEAR(all.colour[middle].x(), 0.5 * 0.3 + 0.5 * (0.25 * 0.2 + 0.75 * 0.1), 1e-14);
  EXPECT_EQ(all.alpha[middle], 1);
  EXPECT_EQ(all.triangle[middle], 2);
  EXPECT_EQ(all.silhouette[middle], 0);
  // Drawn the other way round, the farther lies on the nearer: they do not hide each other.
  std::swap(scene.materials[1], scene.materials[2]);
  std::swap(scene.triangles[1], scene.triangles[2]);
  std::swap(scene.triangles[1].material, scene.triangles[2].material);
  EXPECT_NEAR(render(scene, 8, 8).colour[middle].x(), 0.25 * 0.2 + 0.75 * (0.5 * 0.3 + 0.5 * 0.1), 1e-14);
  // Over nothing colours stay premultiplied.
  scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + 2);
  const Picture veil = render(scene, 8, 8);
  EXPECT_NEAR(veil.alpha[middle], 0.75 + 0.25 * 0.25, 1e-14);
  EXPECT_NEAR(veil.colour[middle].x(), 0.75 * 0.4 + 0.25 * 0.25 * 0.2, 1e-14);
  // An opaque one of the same colour says nothing of alpha.
  scene.materials[3].blended = false;
  EXPECT_NEAR(render(scene, 8, 8).alpha[middle], 1, 1e-14);
}

// Within a part, what is seen from behind comes first, however it is listed: the far wall of a tube.
TEST(ReferenceRaster, TheFarWallOfAVeilIsBlendedFirst) {
  Scene scene = plain_scene();
  scene.triangles = {plain({-1, -1, -0.4}, {1, -1, -0.4}, {0, 1, -0.4}, {0, 1, 2}),
                     plain({1, -1, 0.2}, {-1, -1, 0.2}, {0, 1, 0.2}, {3, 4, 5})};
  scene.triangles[0].colours *= 0.8;
  scene.triangles[1].colours *= 0.2;
  for (auto& triangle : scene.triangles) triangle.colours.row(3).setOnes();
  scene.materials[0].base_alpha = 0.5;
  scene.materials[0].blended = true;
  // ½ of the light.
  EXPECT_NEAR(render(scene, 8, 8).colour[4 * 8 + 4].x(), 0.5 * (0.5 * 0.8 + 0.5 * 0.5 * 0.2), 1e-14);
}

// --- shading
// --------------------------------------------------------------------------------------------------

// One fragment at the middle of a triangle in the plane z = 0, seen from `eye`; the pixel is very small.
struct OneFragment {
  Scene scene = plain_scene();
  Triangle triangle = plain({-1, -1, 0}, {1, -1, 0}, {0, 2, 0}, {0, 1, 2});
  Fragment fragment{Vector3d::Constant(1.0 / 3), Eigen::Matrix<double, 3, 2>::Zero()};
  Shaded shaded() const { return shade(scene, triangle, fragment); }
};

OneFragment wavy(double phase) {
  OneFragment one;
  for (int j = 0; j < 3; ++j) {
    one.triangle.waves.wavenumbers.col(j) = Vector3d(1.5, 0, 0);
    one.triangle.waves.heights[j] = 0.1;
    one.triangle.waves.phases[j] = 2 * pi * 1.5 * one.triangle.waves.corners(0, j) + phase;
  }
  return one;
}

TEST(ReferenceShading, HeadOnLightInClosedForm) {
  // N = L = v: d = 1, H = N, LH = NH = 1, fresnel .04, distribution 1/(π a₂).
  OneFragment one;
  one.scene.camera.eye = {0, 0, 5};
  one.scene.lighting.ambient.setZero();
  one.scene.materials[0].base_colour = {0.2, 0.3, 0.4};
  one.scene.lighting.lights[1] = {Vector3d::UnitZ(), {0.5, 1, 0.25}};
  const double a2 = std::pow(0.75, 4);
  const Vector3d expected = one.scene.lighting.lights[1].colour.cwiseProduct(
      (one.scene.materials[0].base_colour.array() + 0.04 / (4 * pi * a2)).matrix());
  EXPECT_LT((one.shaded().colour - expected).norm(), 1e-14);
  // Sheen adds (1 − N·v)³ = 0 here, and all of itself at a right angle.
  one.scene.shading.sheen = 0.15;
  EXPECT_LT((one.shaded().colour - expected).norm(), 1e-14);
  one.scene.lighting.ambient.setConstant(0.5);
  one.scene.lighting.lights[1].colour.setZero();
  one.scene.camera.eye = {1e9, 0, 1};
  EXPECT_LT((one.shaded().colour - 0.5 * Vector3d(0.35, 0.45, 0.55)).norm(), 1e-8);
}

TEST(ReferenceShading, ObliqueLightInClosedForm) {
  // Light and eye 30° to either side of N: H = N, L·H = cos 30°; the sheen sees cos 30° as well.
  OneFragment one;
  one.scene.camera.eye = 5 * Vector3d(0.5, 0, std::sqrt(0.75));
  one.scene.lighting.ambient.setZero();
  one.scene.shading.sheen = 0.2;
  one.scene.lighting.lights[0] = {{-0.5, 0, std::sqrt(0.75)}, {0.4, 0.4, 0.4}};
  const double c = std::sqrt(0.75), d = (c + 0.15) / 1.15;
  const double fresnel = 0.04 + 0.96 * std::pow(1 - c, 5);
  const double specular = fresnel / (pi * std::pow(0.75, 4)) / (4 * 0.75);
  const double expected = 0.4 * d * (1 + 0.2 * std::pow(1 - c, 3) + specular);
  EXPECT_NEAR(one.shaded().colour.x(), expected, 1e-14);
}

TEST(ReferenceShading, ShoulderStartsSmoothlyAndEndsBelowOne) {
  const auto out = [](double x) {
    OneFragment one;
    one.scene.lighting.ambient.setConstant(x);
    return one.shaded().colour.x();
  };
  EXPECT_NEAR(out(0.5), 0.5, 1e-15);
  EXPECT_NEAR(out(0.8), 0.8, 1e-15);
  EXPECT_NEAR((out(0.8 + 1e-6) - out(0.8)) / 1e-6, 1, 1e-5);
  EXPECT_NEAR(out(1.0), 0.9, 1e-15);
  EXPECT_LE(out(100), 1);
}

TEST(ReferenceShading, NormalOfAWaveIsItsSlopes) {
  // A wave cos along x at its steepest: N tilts by atan(2π h|κ|); seen through the hemisphere's light, up =
  // x.
  OneFragment one = wavy(0.5 * pi);
  one.scene.lighting.up = Vector3d::UnitX();
  const double slope = 2 * pi * 0.1 * 1.5;  // h' = −h sin(φ) 2πκ = −slope, so N leans to +x
  EXPECT_NEAR(one.shaded().colour.x(), 0.5 * (0.6 + 0.4 * slope / std::hypot(1, slope)), 1e-13);
}

// A normal map of one texel that says (x, y, z).
void map_normal(OneFragment& one, const Vector3d& m, const Eigen::Matrix2d& uv_of_place) {
  one.triangle.normal_uv = uv_of_place * one.triangle.waves.corners.topRows<2>();
  TextureLevel level{1, 1, {Eigen::Vector4f::Ones()}};
  level.texels[0].head<3>() = (0.5 * m.array() + 0.5).matrix().cast<float>();
  one.scene.textures = {{{level}}};
  one.scene.materials[0].normal_texture = 0;
}
// The component of N along an axis, seen through the hemisphere's light.
double component(OneFragment one, const Vector3d& axis) {
  one.scene.lighting.up = axis;
  return (one.shaded().colour.x() / 0.5 - 0.6) / 0.4;
}

TEST(ReferenceShading, NormalMapsTiltAlongTheirCoordinates) {
  // Texels are floats, 6e-8 of a half.
  constexpr double single = 1e-6;
  OneFragment one;
  one.scene.camera.eye = {0, 0, 5};
  const Vector3d m = Vector3d(0.3, -0.2, 0.8).normalized();
  // u along x, v along y, whatever their scale: N is m itself.
  map_normal(one, m, Eigen::Vector2d(7, 0.01).asDiagonal());
  EXPECT_NEAR(component(one, Vector3d::UnitX()), m.x(), single);
  EXPECT_NEAR(component(one, Vector3d::UnitY()), m.y(), single);
  EXPECT_NEAR(component(one, Vector3d::UnitZ()), m.z(), single);
  // A map turned a quarter and mirrored: u grows along −y, v along x.
  map_normal(one, m, (Eigen::Matrix2d() << 0, -1, 1, 0).finished());
  EXPECT_NEAR(component(one, Vector3d::UnitX()), m.y(), single);
  EXPECT_NEAR(component(one, Vector3d::UnitY()), -m.x(), single);
  // The scale takes x and y.
  map_normal(one, m, Eigen::Matrix2d::Identity());
  one.scene.materials[0].normal_scale = 0.5;
  const Vector3d half = Vector3d(0.5 * m.x(), 0.5 * m.y(), m.z()).normalized();
  EXPECT_NEAR(component(one, Vector3d::UnitX()), half.x(), single);
  // From behind everything turns round with the side.
  one.scene.camera.eye = {0, 0, -5};
  EXPECT_NEAR(component(one, Vector3d::UnitZ()), -half.z(), single);
  // Coordinates that do not change say nothing of a direction: only the surface's own normal is left.
  map_normal(one, m, Eigen::Matrix2d::Zero());
  EXPECT_NEAR(component(one, Vector3d::UnitZ()), -1, single);
}

TEST(ReferenceShading, SlopesOfMapAndWaveAdd) {
  // A wave of slope s leans N to +x as in NormalOfAWaveIsItsSlopes; a map of slope −a/c along x, −b/c along
  // y.
  OneFragment one = wavy(0.5 * pi);
  one.scene.shading.parallax = 0;
  const Vector3d m = Vector3d(-0.4, 0.2, 0.9).normalized();
  map_normal(one, m, Eigen::Matrix2d::Identity());
  const Vector3d expected = Vector3d(2 * pi * 0.1 * 1.5 + m.x() / m.z(), m.y() / m.z(), 1).normalized();
  EXPECT_NEAR(component(one, Vector3d::UnitX()), expected.x(), 1e-6);
  EXPECT_NEAR(component(one, Vector3d::UnitY()), expected.y(), 1e-6);
}

TEST(ReferenceShading, VertexColoursMultiply) {
  OneFragment one;
  one.scene.materials[0].base_colour = {0.5, 1, 0.8};
  one.scene.materials[0].base_alpha = 0.5;
  one.triangle.colours << 0.3, 0, 0, 0, 0.6, 0, 0, 0, 0.9, 1, 1, 0.1;
  one.fragment.barycentric = {0.5, 0.25, 0.25};
  one.scene.lighting.up = -Vector3d::UnitZ();
  // The hemisphere's light is 0.5 (0.6 − 0.4) = 0.1 from below.
  EXPECT_NEAR(one.shaded().colour.x(), 0.1 * 0.5 * 0.15, 1e-14);
  EXPECT_NEAR(one.shaded().colour.y(), 0.1 * 0.15, 1e-14);
  EXPECT_NEAR(one.shaded().colour.z(), 0.1 * 0.8 * 0.225, 1e-14);
  EXPECT_NEAR(one.shaded().alpha, 0.5 * 0.775, 1e-14);
}

TEST(ReferenceShading, CavityIsTheGroovesOwnAtItsBottom) {
  // cavity 1: the bottom sees cos ψ of the sky, tan ψ = 2πh|κ|; the crest sees all of it.
  OneFragment bottom = wavy(pi), crest = wavy(0);
  bottom.scene.shading.cavity = crest.scene.shading.cavity = 1;
  const double slope = 2 * pi * 0.1 * 1.5;
  EXPECT_NEAR(bottom.shaded().colour.x(), 0.5 * std::cos(std::atan(slope)), 1e-13);
  EXPECT_NEAR(crest.shaded().colour.x(), 0.5, 1e-13);
  // Key light: half of it is occluded, fill: all.
  for (const std::size_t light : {0, 1}) {
    bottom.scene.lighting.ambient.setZero();
    bottom.scene.lighting.lights[0].colour.setZero();
    bottom.scene.lighting.lights[light] = {Vector3d::UnitZ(), Vector3d::Constant(0.5)};
    OneFragment flat = bottom;
    flat.triangle.waves.heights.setZero();
    const double o = std::cos(std::atan(slope));
    EXPECT_NEAR(bottom.shaded().colour.x() / flat.shaded().colour.x(), light == 0 ? (1 + o) / 2 : o, 1e-13);
  }
}

TEST(ReferenceShading, FadedWavesWidenTheHighlightByTheirSlope) {
  // Over half a turn a pixel nothing is left of the wave but σ² = ½(2πh|κ|)² m: the same as more roughness.
  OneFragment waves = wavy(1.0), rough = wavy(1.0);
  for (OneFragment* one : {&waves, &rough}) {
    one->scene.lighting.lights[2] = {Vector3d(0.6, 0, 0.8), Vector3d::Constant(0.6)};
    one->scene.shading.cavity = 1;
  }
  // τ's change a pixel: κ·∂x/∂pixel = 1.5 · .4 = .6 turns.
  waves.fragment.per_pixel.col(0) = Vector3d(-0.2, 0.2, 0);
  waves.scene.profile.slope_power = 0.7;
  rough.triangle.waves.heights.setZero();
  const double sigma2 = 0.5 * std::pow(2 * pi * 0.1 * 1.5, 2) * 0.7;
  rough.scene.shading.roughness = std::pow(std::pow(0.75, 4) + sigma2, 0.25);
  EXPECT_NEAR(waves.shaded().colour.x(), rough.shaded().colour.x(), 1e-13);
  // At three eighths of a turn half the height is left, smoothstep's middle: with cavity off and eye above,
  // the ambient light shows the halved slope.
  OneFragment half = wavy(0.5 * pi);
  half.scene.lighting.up = Vector3d::UnitX();
  half.fragment.per_pixel.col(1) = Vector3d(-0.125, 0.125, 0);
  const double slope = pi * 0.1 * 1.5;
  EXPECT_NEAR(half.shaded().colour.x(), 0.5 * (0.6 + 0.4 * slope / std::hypot(1, slope)), 1e-13);
}

TEST(ReferenceShading, ParallaxShiftHasThePapersNumbers) {
  const auto shift = [](double degrees, double strength, double longest) {
    const double a = degrees * pi / 180;
    return limited_parallax_shift({std::sin(a), 0, std::cos(a)}, Vector3d::UnitZ(), 1, strength, longest);
  };
  double largest = 0, where = 0;
  for (double degrees = 0; degrees < 78; degrees += 0.01)  // above 78.5° the fade-out acts
    if (shift(degrees, 1, 0).x() > largest) {
      largest = shift(degrees, 1, 0).x();
      where = degrees;
    }
  EXPECT_NEAR(largest, 1.5076, 5e-5);  // four digits
  EXPECT_NEAR(where, 73.22, 0.02);
  EXPECT_NEAR(shift(45, 1, 0).x(), 1 / 1.2, 1e-14);  // .8333 of eq. 9, which gives 1 at 45°
  EXPECT_EQ(shift(45, 1, 0).y(), 0);
  EXPECT_NEAR(shift(89.999, 1, 0).norm(), 0, 1e-8);
  EXPECT_EQ(shift(100, 1, 0).norm(), 0);
  EXPECT_NEAR(shift(45, 0.5, 0).x(), 0.5 / 1.2, 1e-14);
  EXPECT_NEAR(shift(45, 1, 4).x(), 1.0 / 16, 1e-14);  // λ/4
  // v·n = .1 stands in the middle of the fade-out.
  EXPECT_NEAR(shift(std::acos(0.1) * 180 / pi, 1, 0).x(), 0.5 * std::sqrt(0.99) * 0.1 / 0.11, 1e-13);
}

TEST(ReferenceShading, ParallaxMovesTheTextureTowardTheEyeOnACrest) {
  // A crest of height h seen at 45°: the ray meets it 1/1.2 h nearer the eye. The texture is a ramp along x.
  OneFragment one = wavy(0);
  for (int j = 0; j < 3; ++j) one.triangle.waves.heights[j] = 0.01;
  one.scene.camera.eye = {10, 0, 10};
  one.triangle.uv =
      one.triangle.waves.corners.topRows<2>() * 0.1 + Eigen::Matrix<double, 2, 3>::Constant(0.5);
  TextureLevel level{64, 1, {}};
  for (int i = 0; i < 64; ++i)
    level.texels.push_back(Eigen::Vector4f::Constant((static_cast<float>(i) + 0.5F) / 64));
  one.scene.textures = {{{level}}};
  one.scene.materials[0].texture = 0;
  EXPECT_NEAR(one.shaded().colour.x(), 0.5 * (0.5 + 0.1 * 0.01 / 1.2), 1e-7);  // texels are floats
  one.scene.shading.parallax = 0;
  EXPECT_NEAR(one.shaded().colour.x(), 0.5 * 0.5, 1e-7);
}

TEST(ReferenceShading, WindingAndSideDoNotMatter) {
  OneFragment front = wavy(0.7);
  front.fragment.barycentric = {0.2, 0.5, 0.3};
  front.scene.camera.eye = {1, 2, 3};
  front.scene.shading = {.sheen = 0.1, .cavity = 1};
  front.scene.lighting.lights[0] = {Vector3d(1, 1, 1).normalized(), {0.4, 0.3, 0.2}};
  OneFragment wound = front;
  const std::array<int, 3> order{0, 2, 1};
  wound.triangle.waves.corners = front.triangle.waves.corners(Eigen::all, order);
  wound.triangle.waves.phases = front.triangle.waves.phases(order);
  wound.fragment.barycentric = front.fragment.barycentric(order);
  EXPECT_LT((front.shaded().colour - wound.shaded().colour).norm(), 1e-14);
  // Normals turned over and the wave as well (half a turn of a cosine): the same surface described from
  // behind.
  OneFragment behind = front;
  behind.triangle.normals *= -1;
  behind.triangle.waves.phases.array() += pi;
  EXPECT_LT((front.shaded().colour - behind.shaded().colour).norm(), 1e-14);
  // But the same wave with normals turned over is another surface.
  behind.triangle.waves.phases = front.triangle.waves.phases;
  EXPECT_GT((front.shaded().colour - behind.shaded().colour).norm(), 1e-3);
}

TEST(ReferenceShading, ShadowsAreFilteredComparisons) {
  // A map over the unit square, left half occupied at depth .3, the rest empty.
  ShadowMap map;
  map.matrix = Matrix4d::Identity();
  map.size = 8;
  map.texel_size = 0.25;
  for (int i = 0; i < 64; ++i) map.depth.push_back(i % 8 < 4 ? 0.3F : 1.0F);
  const Vector3d n_s = Vector3d::Zero();
  EXPECT_EQ(shadow_factor(map, {-0.6, 0, 0}, n_s), 0);  // depth .5 behind .3
  EXPECT_EQ(shadow_factor(map, {0.6, 0, 0}, n_s), 1);
  EXPECT_NEAR(shadow_factor(map, {0, 0, 0}, n_s), 0.5, 1e-14);
  // A quarter texel to the right: of nine columns of samples the middle ones shift by ¼, each of weight ⅓.
  EXPECT_NEAR(shadow_factor(map, {0.0625, 0, 0}, n_s), 0.5 + 0.25 / 3, 1e-14);
  EXPECT_EQ(shadow_factor(map, {-0.6, 0, -0.5}, n_s), 1);          // in front of the occluder
  EXPECT_EQ(shadow_factor(map, {-0.6, 0, -0.4 + 0.001}, n_s), 1);  // within the depth offset of 1e-3
  EXPECT_EQ(shadow_factor(map, {-0.6, 0, -0.4 + 0.003}, n_s), 0);
  EXPECT_EQ(shadow_factor(map, {-3, 0, 0}, n_s), 1);  // off the map
  EXPECT_EQ(shadow_factor(map, {-0.6, 0, 0}, Vector3d(0, 0, -2)),
            1);  // 1.5 texels along the normal: z = −.75
}

TEST(ReferenceShading, TexturesRepeatAndBlendLevels) {
  Texture texture;
  texture.levels.push_back({2, 1, {Eigen::Vector4f::Constant(0), Eigen::Vector4f::Constant(1)}});
  texture.levels.push_back({1, 1, {Eigen::Vector4f::Constant(0.25F)}});
  EXPECT_EQ(sample(texture, {0.25, 0}, 0).x(), 0);
  EXPECT_EQ(sample(texture, {0.75, 3}, 0).x(), 1);
  EXPECT_EQ(sample(texture, {-0.25, -2.1}, -5).x(), 1);
  EXPECT_EQ(sample(texture, {0, 0}, 0).x(), 0.5);  // halfway between the last and the first
  EXPECT_EQ(sample(texture, {0.375, 0}, 0).x(), 0.25);
  EXPECT_EQ(sample(texture, {0.75, 0}, 0.5).x(), 0.5 * 1 + 0.5 * 0.25);
  EXPECT_EQ(sample(texture, {0.75, 0}, 9).x(), 0.25);
}

TEST(ReferenceShading, SrgbRoundTrip) {
  // The standard's two branches meet to 1e-7.
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(srgb_to_linear(srgb_encode(i / 1000.0)), i / 1000.0, 1e-7);
  for (int i = 0; i < 256; ++i) EXPECT_EQ(std::lround(255 * srgb_encode(srgb_to_linear(i / 255.0))), i);
  EXPECT_NEAR(srgb_encode(0.5), 0.735357, 1e-6);  // IEC 61966-2-1
  EXPECT_EQ(srgb_encode(-1), 0);
  EXPECT_NEAR(srgb_encode(2), 1, 1e-15);
}

}  // namespace
}  // namespace plisse::reference
