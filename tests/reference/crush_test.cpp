// Reference crush against closed forms: affine maps of jittered grids, the numbers of Loviscach 2006 as
// tabulated in docs/passes.md's sources, and invariances.
#include "reference/crush.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meshes.h"
#include "reference/functions.h"
#include "reference/skin.h"

namespace plisse::reference {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Rotation2Dd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double rounding = 1e-12;  // of a 2 × 2 inverse and decomposition of numbers near 1

Matrix2d matrix(double a, double b, double c, double d) {
  Matrix2d M;
  M << a, b, c, d;
  return M;
}

Frames flat_frames(Index count, const Vector3d& tangent = Vector3d::UnitX()) {
  return {Vector3d::UnitZ().replicate(1, count), tangent.replicate(1, count)};
}

CrushResult fresh(const Matrix2d& M, double W = 1) {
  return crush_vertex(M, W, 1, {}, {});
}

std::vector<CrushResult> crush_grid(const test::Grid& grid, const Matrix3Xd& posed, const Frames& rest,
                                    const Frames& frames, double W = 1) {
  const Index count = grid.points.cols();
  return crush(grid.topology, rest, posed, frames, VectorXd::Constant(count, W), VectorXd::Ones(count), {},
               std::vector<CrushState>(static_cast<std::size_t>(count)));
}

TEST(ReferenceCrush, RegressionOfAnAffineMapIsItUpToTheRegularisation) {
  const test::Grid grid = test::grid(7, 0.3, 1);
  const Matrix2d F = matrix(0.5, 0.2, -0.1, 0.9);
  Matrix3Xd posed = grid.points;
  posed.topRows<2>() = F * grid.points.topRows<2>();
  const auto crushed = crush_grid(grid, posed, flat_frames(posed.cols()), flat_frames(posed.cols()));
  for (Index v = 0; v < posed.cols(); ++v) {
    Matrix2d S = Matrix2d::Zero();
    for (const std::uint32_t i : row(grid.topology.neighbours, v)) {
      const Vector2d e = (grid.points.col(i) - grid.points.col(v)).head<2>();
      S += e * e.transpose();
    }
    // v' = Fv makes M = (FS + μE)(S + μE)⁻¹ = F + μ(E − F)(S + μE)⁻¹.
    const double mu = 1e-6 * S.trace();
    const Matrix2d E = Matrix2d::Identity();
    const Matrix2d expected = F + mu * (E - F) * (S + mu * E).inverse();
    const Matrix2d& M = crushed[static_cast<std::size_t>(v)].M;
    EXPECT_LT((M - expected).norm(), rounding) << v;
    // |μ(E − F)(S + μE)⁻¹| ≤ 1e-6 |E − F| trace S/λ_min(S).
    const double least = Eigen::SelfAdjointEigenSolver<Matrix2d>(S).eigenvalues()[0];
    EXPECT_LE((M - F).norm(), 1e-6 * (E - F).norm() * S.trace() / least + rounding) << v;
  }
}

TEST(ReferenceCrush, RegressionMinimisesThePapersSquaredError) {
  // Eq. 1 for edges that no matrix maps exactly: any change of M by 1e-3 costs, except what μ = 1e-6 trace
  // allows.
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Matrix2Xd v(2, 6), posed(2, 6);
  for (double& x : v.reshaped()) x = normal(random);
  for (double& x : posed.reshaped()) x = normal(random);
  const Matrix2d M = regression(v, posed);
  const double error = (posed - M * v).squaredNorm();
  for (int entry = 0; entry < 4; ++entry)
    for (const double change : {-1e-3, 1e-3}) {
      Matrix2d other = M;
      other.reshaped()[entry] += change;
      EXPECT_GT((posed - other * v).squaredNorm(), error);
    }
}

TEST(ReferenceCrush, HalfWidth) {
  // wrinkle-passes.md: M = diag(.5, 1) → k' = (2, 0), r = .5, h = .21651 W, |k'| = 1/r.
  const CrushResult half = fresh(matrix(0.5, 0, 0, 1), 0.1);
  EXPECT_NEAR(half.r, 0.5, rounding);
  EXPECT_NEAR(std::abs(half.wave_vector.x()), 2, rounding);
  EXPECT_NEAR(half.wave_vector.y(), 0, rounding);
  EXPECT_NEAR(half.wavenumber.norm(), 20, 100 * rounding);
  EXPECT_NEAR(half.height, 0.1 * 0.21651, 0.1 * 5e-6);  // the table's five digits
  EXPECT_NEAR(half.gap, (1 - 0.25) / (1 + 0.25), rounding);
  EXPECT_EQ(half.status, Status::fresh);
  EXPECT_EQ(half.weight, 1);
}

TEST(ReferenceCrush, HeightsOfAccordionPleats) {
  const double table[][2] = {{0.99, 0.03527}, {0.9, 0.10897},  {0.75, 0.16536},
                             {0.5, 0.21651},  {0.25, 0.24206}, {0.1, 0.24875}};
  for (const auto& [r, h] : table) EXPECT_NEAR(relative_height(r, 0.005), h, 5e-6) << r;  // five digits
  EXPECT_EQ(relative_height(1, 0.005), 0);
  EXPECT_EQ(relative_height(1.5, 0.005), 0);
  // Zero up to half the dead zone, whole from its end, between them a share of eq. 2.
  EXPECT_EQ(relative_height(1 - 0.002499, 0.005), 0);
  EXPECT_NEAR(relative_height(1 - 0.00375, 0.005), 0.5 * 0.25 * std::sqrt(0.00375 * 1.99625), rounding);
  EXPECT_NEAR(relative_height(1 - 0.005, 0.005), 0.25 * std::sqrt(0.005 * 1.995), 1e-9);
  // Five digits of h/W need the accordion's geometry (fig. 5): legs of length W/4 over rW/4.
  for (const double r : {0.2, 0.6, 0.95})
    EXPECT_NEAR(std::hypot(relative_height(r, 0.005), r / 4), 0.25, rounding);
}

TEST(ReferenceCrush, RigidMotionGivesNoWrinkles) {
  test::Grid grid = test::grid(6, 0.3, 2);
  for (auto point : grid.points.colwise()) point.z() = 0.1 * std::sin(point.x()) * point.y();
  grid.topology = test::topology_of(grid.points, grid.triangles);
  const Matrix3Xd fallback = Vector3d::UnitZ().replicate(1, grid.points.cols());
  const Frames rest = rest_frames(grid.topology, fallback);
  const Matrix3d R = Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Matrix3Xd posed = (R * grid.points).colwise() + Vector3d(3, -7, 11);
  const Frames frames{R * rest.normal, R * rest.tangent};
  for (const CrushResult& vertex : crush_grid(grid, posed, rest, frames)) {
    EXPECT_NEAR(vertex.r, 1, rounding);
    EXPECT_EQ(vertex.height, 0);
    EXPECT_EQ(vertex.weight, 0);
    EXPECT_EQ(vertex.status, Status::idle);
    EXPECT_TRUE(vertex.direction.isZero(0));
  }
}

TEST(ReferenceCrush, TurningTheFramesChangesNothing) {
  // The same angle at rest and in the pose: r and h stay, κ as a world vector stays up to its sign.
  const test::Grid grid = test::grid(6, 0.3, 4);
  Matrix3Xd posed = grid.points;
  posed.topRows<2>() = matrix(0.6, 0.3, -0.2, 1.1) * grid.points.topRows<2>();
  posed.row(2) = 0.05 * grid.points.row(0).array().sin();  // not affine any more
  const Index count = posed.cols();
  const auto before = crush_grid(grid, posed, flat_frames(count), flat_frames(count));
  for (double angle = 0.1; angle < 2 * pi; angle += 0.7) {
    const Frames turned = flat_frames(count, {std::cos(angle), std::sin(angle), 0});
    const auto after = crush_grid(grid, posed, turned, turned);
    for (Index v = 0; v < count; ++v) {
      const CrushResult &a = before[static_cast<std::size_t>(v)], &b = after[static_cast<std::size_t>(v)];
      EXPECT_NEAR(a.r, b.r, rounding);
      EXPECT_NEAR(a.height, b.height, rounding);
      const Vector3d ka = flat_frames(count).basis(v) * a.wavenumber, kb = turned.basis(v) * b.wavenumber;
      // Directions carry the rounding of M divided by the gap of the eigenvalues, here above 0.1.
      EXPECT_LT(std::min((ka - kb).norm(), (ka + kb).norm()), 100 * rounding);
    }
  }
}

TEST(ReferenceCrush, ChoiceOfTangentNeighbourMattersOnlyByTheRegularisation) {
  // Another neighbour turns t and t' by different angles, as the map shears: μE then stands askew, by
  // μ/λ_min(S) of its size 1e-6 trace S: about 1e-5 on this grid, whose S is never worse than 1 : 10.
  const test::Grid grid = test::grid(5, 0.2, 6);
  Matrix3Xd posed = grid.points;
  posed.topRows<2>() = matrix(0.6, 0.3, -0.2, 1.1) * grid.points.topRows<2>();
  const Matrix3Xd up = Vector3d::UnitZ().replicate(1, posed.cols());
  std::vector<std::uint32_t> first, last;
  for (Index v = 0; v < posed.cols(); ++v) {
    first.push_back(*row(grid.topology.neighbours, v).begin());
    last.push_back(*(row(grid.topology.neighbours, v).end() - 1));
  }
  std::vector<std::vector<CrushResult>> results;
  std::vector<Frames> frames;
  for (const auto& choice : {first, last}) {
    frames.push_back({up, skin_tangents(posed, up, choice)});
    results.push_back(crush_grid(grid, posed, {up, skin_tangents(grid.points, up, choice)}, frames.back()));
  }
  for (Index v = 0; v < posed.cols(); ++v) {
    const CrushResult &a = results[0][static_cast<std::size_t>(v)],
                      &b = results[1][static_cast<std::size_t>(v)];
    EXPECT_NEAR(a.r, b.r, 2e-5);
    EXPECT_NEAR(a.height, b.height, 2e-5);
    const Vector3d ka = frames[0].basis(v) * a.wavenumber, kb = frames[1].basis(v) * b.wavenumber;
    EXPECT_LT(std::min((ka - kb).norm(), (ka + kb).norm()), 1e-4);
  }
}

TEST(ReferenceCrush, ScaleDoesNotMatter) {
  const test::Grid grid = test::grid(5, 0.3, 7);
  Matrix3Xd posed = grid.points;
  posed.topRows<2>() = matrix(0.7, 0.1, 0.2, 0.9) * grid.points.topRows<2>();
  const auto unit = crush_grid(grid, posed, flat_frames(posed.cols()), flat_frames(posed.cols()), 0.5);
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    test::Grid scaled = grid;
    scaled.topology.rest *= scale;
    const auto result =
        crush_grid(scaled, scale * posed, flat_frames(posed.cols()), flat_frames(posed.cols()), 0.5 * scale);
    for (std::size_t v = 0; v < unit.size(); ++v) {
      EXPECT_NEAR(result[v].r, unit[v].r, rounding);
      EXPECT_NEAR(result[v].height / scale, unit[v].height, rounding);
      EXPECT_NEAR(result[v].wavenumber.norm() * scale, unit[v].wavenumber.norm(), 10 * rounding);
      EXPECT_NEAR(result[v].weight, unit[v].weight, rounding);
    }
  }
}

TEST(ReferenceCrush, UnknownDirectionsReadNotStretched) {
  EXPECT_EQ(regression(Matrix2Xd(2, 0), Matrix2Xd(2, 0)), Matrix2d::Identity());
  EXPECT_EQ(regression(Matrix2Xd::Zero(2, 3), Matrix2Xd::Ones(2, 3)), Matrix2d::Identity());
  const Vector2d e(0.6, 0.8);
  Matrix2Xd one(2, 1), two(2, 2);
  one << e;
  two << e, -3 * e;              // collinear
  const double singular = 1e-9;  // S + μE has condition 1e6: some 1e6 roundings
  for (const Matrix2Xd& v : {one, two}) {
    EXPECT_NEAR(fresh(regression(v, v)).r, 1, singular);
    EXPECT_NEAR(fresh(regression(v, 1.7 * v)).r, 1, singular);
    // What is known to be compressed is: (r S + μ)/(S + μ) along e, off by at most 1e-6.
    EXPECT_NEAR(fresh(regression(v, 0.5 * v)).r, 0.5, 1e-6);
    EXPECT_NEAR(std::abs(fresh(regression(v, 0.5 * v)).minimum.dot(e)), 1, singular);
  }
}

TEST(ReferenceCrush, WaveVectorIsDualToTheMap) {
  // k'·(Mv) = k·v for every v where no singular value is floored (eq. 4), mirrors included.
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    const Matrix2d M = matrix(normal(random), normal(random), normal(random), normal(random));
    const double least = Eigen::JacobiSVD<Matrix2d>(M).singularValues()[1];
    if (least < 0.05) continue;
    const Vector2d k = Vector2d(normal(random), normal(random)).normalized(),
                   v(normal(random), normal(random));
    EXPECT_NEAR(wave_vector(M, k).dot(M * v), k.dot(v), rounding * M.norm() * v.norm() / least);
  }
  // With a floor: the direction of least stretch counts as .05.
  EXPECT_LT((wave_vector(matrix(0.01, 0, 0, 1), {1, 0}) - Vector2d(20, 0)).norm(), 20 * rounding);
  EXPECT_TRUE(wave_vector(Matrix2d::Zero(), {0.6, 0.8}).allFinite());
}

TEST(ReferenceCrush, LeastStretchIsTheMinimumOverAllDirections) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix2d M = matrix(normal(random), normal(random), normal(random), normal(random));
    const CrushResult result = fresh(M);
    EXPECT_NEAR((M * result.minimum).norm(), result.r, rounding);
    for (double angle = 0; angle < pi; angle += 0.01)
      EXPECT_GE((M * Vector2d(std::cos(angle), std::sin(angle))).norm(), result.r - rounding);
  }
}

TEST(ReferenceCrush, DirectionMovesByAsMuchAsTheGapIsWorth) {
  // Squeeze along x by s: g = (1 − s²)/(1 + s²); k̂ = ±x.
  const Vector2d k = Vector2d(1, 1).normalized();
  for (const double g : {0.002, 0.006, 0.01, 0.5}) {
    const double s = std::sqrt((1 - g) / (1 + g));
    const CrushResult result = crush_vertex(matrix(s, 0, 0, 1), 1, 1, {}, {k, Status::set});
    EXPECT_NEAR(result.gap, g, rounding);
    const double share = std::min(g / 0.01, 1.0);
    const Vector2d expected = ((1 - share) * k + share * Vector2d(1, 0)).normalized();  // sign aligned with k
    EXPECT_LT((result.direction - expected).norm(), rounding / g);
    const CrushResult opposite = crush_vertex(matrix(s, 0, 0, 1), 1, 1, {}, {-k, Status::set});
    EXPECT_LT((opposite.direction + expected).norm(), rounding / g);
    // Unset: nothing up to .01, then the whole.
    const CrushResult first = crush_vertex(matrix(s, 0, 0, 1), 1, 1, {}, {});
    const bool taken = g > 0.01 + 1e-9;  // .01 itself is not more than .01, up to rounding
    if (taken || g < 0.01 - 1e-9) {
      EXPECT_NEAR(first.direction.norm(), g > 0.01 ? 1 : 0, rounding);
    }
  }
}

TEST(ReferenceCrush, StatusHasHysteresis) {
  const CrushSettings smooth{0.01, true}, descent{0.01, false};
  const Vector2d x(1, 0);
  const auto status = [&](double shortening, double mask, Vector2d k, Status before,
                          const CrushSettings& settings) {
    return crush_vertex(matrix(1 - shortening, 0, 0, 1), 1, mask, settings, {k, before}).status;
  };
  EXPECT_EQ(status(0.011, 1, x, Status::idle, smooth), Status::fresh);
  EXPECT_EQ(status(0.009, 1, x, Status::idle, smooth), Status::idle);
  EXPECT_EQ(status(0.009, 1, x, Status::set, smooth), Status::set);
  EXPECT_EQ(status(0.0051, 1, x, Status::set, smooth), Status::set);
  EXPECT_EQ(status(0.0049, 1, x, Status::set, smooth), Status::idle);
  EXPECT_EQ(status(0.2, 0, x, Status::set, smooth), Status::idle);
  EXPECT_EQ(status(0.2, 0, x, Status::idle, smooth), Status::idle);
  EXPECT_EQ(status(0, 0, {0, 0}, Status::idle, descent), Status::set);
  // Squeezed the same all round there is no direction, and so no wave.
  EXPECT_EQ(crush_vertex(0.5 * Matrix2d::Identity(), 1, 1, smooth, {}).status, Status::idle);
}

TEST(ReferenceCrush, MaskScalesHeightAlone) {
  const Matrix2d M = matrix(0.8, 0.1, 0, 1);
  const CrushResult whole = crush_vertex(M, 2, 1, {}, {}), half = crush_vertex(M, 2, 0.5, {}, {});
  EXPECT_NEAR(half.height, whole.height / 2, rounding);
  EXPECT_EQ(half.r, whole.r);
  EXPECT_EQ(half.wavenumber, whole.wavenumber);
  // The paper's weight at W = 4: min(max(4h − .2, 0), 1).
  const double h = 4 * relative_height(whole.r, 0.005) * 0.3;
  EXPECT_NEAR(crush_vertex(M, 4, 0.3, {}, {}).weight, std::clamp(4 * h - 0.2, 0.0, 1.0), rounding);
}

// Loviscach 2006, section 7: cloth of a vector p is shortened by |p|² along it before M acts.
TEST(Crush, BiasShortensBeforeTheAnimation) {
  Eigen::Matrix<double, 3, 2> basis;  // some rest frame
  basis.col(0) = Eigen::Vector3d(1, 2, -1).normalized();
  basis.col(1) = Eigen::Vector3d(1, 0, 1).normalized();
  const Matrix2d M = (Matrix2d() << 0.9, 0.2, -0.1, 1.1).finished();
  const Vector2d q(0.3, 0.6);
  const Eigen::Vector3d p = basis * q + 5 * basis.col(0).cross(basis.col(1));  // a normal part means nothing
  const Matrix2d result = biased(M, basis, p);
  const Vector2d across(-q.y(), q.x());
  EXPECT_LT((result * q - (1 - q.squaredNorm()) * M * q).norm(), 1e-14);  // roundings of numbers about 1
  EXPECT_LT((result * across - M * across).norm(), 1e-14);
  EXPECT_NEAR(biased(Matrix2d::Identity(), basis, 30 * p).determinant(), 1 - 0.99 * 0.99, 1e-12);
}

}  // namespace
}  // namespace plisse::reference
