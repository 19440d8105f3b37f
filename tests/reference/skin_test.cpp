// Reference skin against closed forms: affine maps of a mesh, a cylinder bent by hand, degenerate corners.
#include "reference/skin.h"

#include <gtest/gtest.h>

#include "meshes.h"
#include "reference/functions.h"

namespace plisse::reference {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Matrix4d;
using Eigen::Vector3d;

// A bowl: a jittered grid lifted onto a paraboloid, so that normals differ.
test::Grid bowl() {
  test::Grid grid = test::grid(6, 0.2, 3);
  for (auto point : grid.points.colwise()) point.z() = 0.08 * point.head<2>().squaredNorm();
  grid.topology = test::topology_of(grid.points, grid.triangles);
  return grid;
}

SkinModel model_of(const Matrix3Xd& bind) {
  SkinModel model;
  model.bind = bind;
  model.bind_normal = Vector3d::UnitZ().replicate(1, bind.cols());
  Influences one;
  one.weight[0] = 1;
  model.influences.assign(static_cast<std::size_t>(bind.cols()), one);
  return model;
}

Matrix4d affine(const Matrix3d& linear, const Vector3d& translation) {
  Matrix4d matrix = Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = linear;
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

double angle_defect(const Matrix3Xd& a, const Matrix3Xd& b) {
  return (a - b).colwise().norm().maxCoeff();
}

// |double rounding| of sums and products of numbers up to about 10.
constexpr double rounding = 1e-13;

TEST(ReferenceSkin, BlendsMatricesAndMorphs) {
  SkinModel model = model_of(Vector3d(1, 2, 3));
  model.influences[0].entry = {1, 0};
  model.influences[0].weight = {0.75, 0.25};
  model.deltas = {Vector3d(0, 0, 1), Vector3d(4, 0, 0)};
  Matrix3d quarter_turn;  // about z
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const SkinPose pose{{affine(Matrix3d::Identity(), {10, 0, 0}), affine(quarter_turn, {0, 0, 5})},
                      {2, -0.25}};
  // The morphed point is (0, 2, 5); a quarter turn and the shift give (−2, 0, 10), the other bone (10, 2, 5).
  const Vector3d expected = 0.75 * Vector3d(-2, 0, 10) + 0.25 * Vector3d(10, 2, 5);
  EXPECT_LT((skin_positions(model, pose).col(0) - expected).norm(), rounding);
}

TEST(ReferenceSkin, NormalsFollowAnyAffineMapAsCofactorsDo) {
  // Area normals are sums of cross products, and Au × Av = cof(A)(u × v) holds for each: shears, non-uniform
  // scale, and a mirror, which turns them over.
  const test::Grid grid = bowl();
  const Frames rest = rest_frames(grid.topology, model_of(grid.points).bind_normal);
  Matrix3d shear, mirror;
  shear << 2, 0.3, -0.5, 0.1, 0.4, 0.2, 0, 0.7, 1.5;
  mirror = shear * Vector3d(-1, 1, 1).asDiagonal();
  for (const Matrix3d& A : {shear, mirror}) {
    const SkinPose pose{{affine(A, {1, 2, 3})}, {}};
    const SkinResult posed =
        skin(grid.topology, model_of(grid.points), pose, tangent_neighbours(grid.topology, rest.normal));
    const Matrix3Xd expected =
        (A.determinant() * A.inverse().transpose() * rest.normal).colwise().normalized();
    EXPECT_LT(angle_defect(posed.frames.normal, expected), rounding);
    EXPECT_LT(posed.frames.normal.cwiseProduct(posed.frames.tangent).colwise().sum().cwiseAbs().maxCoeff(),
              rounding);
    EXPECT_LT((posed.frames.tangent.colwise().norm().array() - 1).abs().maxCoeff(), rounding);
  }
}

TEST(ReferenceSkin, FallbackNormalAgreesWithTheAreaRule) {
  // The same bowl, once with its triangles and once without any: then the fallback has to give what areas
  // gave.
  const test::Grid grid = bowl();
  SkinModel model = model_of(grid.points);
  model.bind_normal = rest_frames(grid.topology, model.bind_normal).normal;
  Topology bare = grid.topology;
  bare.corners.items.clear();
  bare.corners.offsets.assign(grid.topology.corners.offsets.size(), 0);
  Matrix3d A;
  A << -2, 0.3, -0.5, 0.1, 0.4, 0.2, 0, 0.7, 1.5;
  ASSERT_LT(A.determinant(), 0);
  const std::vector<Matrix3d> linear(static_cast<std::size_t>(grid.points.cols()), A);
  const Matrix3Xd moved = A * grid.points;
  EXPECT_LT(angle_defect(skin_normals(grid.topology, moved, linear, model.bind_normal),
                         skin_normals(bare, moved, linear, model.bind_normal)),
            rounding);
}

TEST(ReferenceSkin, CollapsedVerticesKeepUnitFrames) {
  // Everything falls onto a line, then onto a point: areas vanish, then the cofactors vanish as well.
  const test::Grid grid = bowl();
  const SkinModel model = model_of(grid.points);
  const auto neighbours = tangent_neighbours(grid.topology, model.bind_normal);
  for (const Vector3d& scale : {Vector3d(1, 0, 0), Vector3d(0, 0, 0)}) {
    const SkinPose pose{{affine(scale.asDiagonal(), {0.1, 0.2, 0.3})}, {}};
    const SkinResult posed = skin(grid.topology, model, pose, neighbours);
    EXPECT_LT(angle_defect(posed.frames.normal, model.bind_normal), rounding);
    EXPECT_LT((posed.frames.tangent.colwise().norm().array() - 1).abs().maxCoeff(), rounding);
    EXPECT_LT(posed.frames.tangent.row(2).cwiseAbs().maxCoeff(), rounding);
  }
  // Onto a plane through the normal: areas vanish or turn into the plane's own normal, all stays finite and
  // unit.
  const SkinPose flat{{affine(Vector3d(0, 1, 1).asDiagonal(), {0, 0, 0})}, {}};
  const Frames frames = skin(grid.topology, model, flat, neighbours).frames;
  EXPECT_LT((frames.normal.colwise().norm().array() - 1).abs().maxCoeff(), rounding);
}

TEST(ReferenceSkin, NormalsOfACylinderPointOutward) {
  // A grid rolled round an axis: by symmetry inner vertices of regular rings have exactly radial normals.
  const int side = 9;
  test::Grid grid = test::grid(side, 0, 0);
  for (auto point : grid.points.colwise())
    point = Vector3d(std::sin(0.3 * point.x()), point.y(), std::cos(0.3 * point.x()));
  grid.topology = test::topology_of(grid.points, grid.triangles);
  const Frames frames = rest_frames(grid.topology, Vector3d::UnitZ().replicate(1, grid.points.cols()));
  for (int j = 1; j + 1 < side; ++j)
    for (int i = 1; i + 1 < side; ++i) {
      const Index v = j * side + i;
      const Vector3d radial(grid.points(0, v), 0, grid.points(2, v));
      // Both diagonals lie the same way, so the six corners are symmetric under a half turn about the radius.
      EXPECT_LT((frames.normal.col(v) - radial).norm(), rounding) << v;
    }
}

TEST(ReferenceSkin, TangentPointsToTheNeighbourLongestInTheTangentPlane) {
  // Neighbour 1 is far along the normal, 2 and 3 are equally far in the plane: the smaller id wins.
  Matrix3Xd points(3, 4);
  points << 0, 0.1, 1, 0, 0, 0, 0, 1, 0, 9, 0, 0;
  const Topology topology = test::topology_of(points, {{0, 2, 3}, {0, 3, 1}});
  const auto chosen = tangent_neighbours(topology, Vector3d::UnitZ().replicate(1, 4));
  EXPECT_EQ(chosen[0], 2U);
  const Matrix3Xd tangents = skin_tangents(points, Vector3d::UnitZ().replicate(1, 4), chosen);
  EXPECT_LT((tangents.col(0) - Vector3d::UnitX()).norm(), rounding);
  // A neighbour along the normal but for 1e-7 is no direction to rely on: the axis least along n, here x; nor
  // is none.
  Matrix3Xd upright(3, 2);
  upright << 0, 0, 0, 1e-7, 0, 1;
  const Matrix3Xd axes = skin_tangents(upright, Vector3d::UnitZ().replicate(1, 2), {1, 1});
  EXPECT_LT((axes.colwise() - Vector3d::UnitX()).norm(), rounding);
}

}  // namespace
}  // namespace plisse::reference
