// The energy of a face: against the paper's W¹…W⁴ and W²_b summed up by quadrature from 2×2 matrices, its
// ablations against the strain of the displaced surface, its derivatives against finite differences.
#include "wrinkle/energy.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Case {
  FaceForms forms;
  LocalVector x;
};

// Triangles of 1 cm, strains of 5 %, waves of 2 mm amplitude and 1 cm length, curvatures of 10/m.
Case random_case(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto symmetric = [&](double size) {
    Matrix2d m;
    m << normal(random), normal(random), 0, normal(random);
    m(1, 0) = m(0, 1);
    return Matrix2d(size * m);
  };
  Eigen::Matrix<double, 2, 3> corners;
  corners << 0, 0.01, 0.003, 0, 0.001, 0.012;
  Case c{{shell::rest_face(corners, 0), symmetric(0.05), symmetric(10)}, {}};
  c.forms.strain -= 0.1 * Matrix2d::Identity();  // so that w means something
  for (int i = 0; i < 3; ++i) c.x[i] = 0.002 * std::abs(normal(random));
  for (int i = 3; i < 5; ++i) c.x[i] = 600 * normal(random);
  return c;
}

double squared(const shell::Material& m, const Matrix2d& matrix) {
  return m.alpha() / 2 * matrix.trace() * matrix.trace() + m.beta() * (matrix * matrix).trace();
}

double whole(const FaceEnergy& energy, const LocalVector& x) {
  return energy.value(x) + energy.relaxed();
}

// Gauss–Legendre with three points each way on the collapsed square: exact to degree 4 in a.
template <typename Function>
double integral(double area, Function&& f) {
  const double node[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)},
               weight[3] = {5. / 18, 8. / 18, 5. / 18};
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double u = node[i], v = node[j] * (1 - u);
      sum += 2 * area * weight[i] * weight[j] * (1 - u) * f(Vector3d(1 - u - v, u, v));
    }
  }
  return sum;
}

TEST(WrinkleEnergy, IsThePapersSumOfTerms) {
  Model model = test::model(1e7, 0.3, 1e-3);
  model.crest_compression = true;  // (21) as it stands
  const double h = model.material.thickness;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Case c = random_case(seed);
    const Vector3d corners = c.x.head<3>();
    const Vector2d p = c.x.tail<2>(), g = c.forms.rest.gradients * corners;
    const PrincipalStrain principal = principal_strain(c.forms);
    const double bent = principal.crest.dot(c.forms.second_form * principal.crest);
    const double expected = integral(c.forms.rest.area, [&](const Vector3d& place) {
      const double a = place.dot(corners);
      const Matrix2d pg = p * g.transpose();
      const double w1 =
          squared(model.material, c.forms.strain + 0.5 * g * g.transpose() + 0.5 * a * a * p * p.transpose());
      const double w2 = model.material.young * a * a * bent * bent;
      const double w3 = a * a / 32 * squared(model.material, pg + pg.transpose());
      const double w4 = squared(model.material, g * g.transpose()) / 8;
      const double wb = a * a / 2 * squared(model.material, p * p.transpose());
      return h / 4 * (w1 + w2 + w3 + w4) + h * h * h / 12 * wb;
    });
    EXPECT_NEAR(whole(FaceEnergy(c.forms, model), c.x) / expected, 1, 1e-13);  // both exact: rounding
  }
}

// With a and the forms constant, the energy is the mean over a period of the StVK density of the strain that
// (11) gives for whatever v₁ and v₂ are: so the ablations, and the optimal v₁, can be found by trying.
TEST(WrinkleEnergy, AblationsAreMeansOverAPeriod) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    Case c = random_case(seed);
    c.x.head<3>().setConstant(0.001);
    const double a = 0.001, h = 1e-3;
    // dφ along w, as the energy takes it for W².
    const PrincipalStrain principal = principal_strain(c.forms);
    const Vector2d p = 700 * principal.wave;
    c.x.tail<2>() = p;
    const Matrix2d ppt = p * p.transpose();
    Model model = test::model(1e7, 0.3, h);
    model.crest_compression = true;
    const auto mean = [&](const Vector2d& v1, double v2) {  // v₂ = v2 dφ; I_b ≈ I_u in the corrections
      double sum = 0;
      const int count = 16;  // trigonometric polynomials of degree 4: exact from 5 on
      for (int i = 0; i < count; ++i) {
        const double phi = 2 * std::numbers::pi * i / count;
        const Matrix2d v1p = v1 * p.transpose();
        const Matrix2d strain = c.forms.strain + 0.5 * a * a * ppt +
                                std::cos(phi) * (-2 * a * c.forms.second_form + v1p + v1p.transpose()) +
                                std::cos(2 * phi) * (-0.5 * a * a + 4 * v2) * ppt;
        sum += squared(model.material, strain) / count;
      }
      return c.forms.rest.area * (h / 4 * sum + h * h * h / 24 * a * a * squared(model.material, ppt));
    };
    model.v1 = model.v2 = false;
    EXPECT_NEAR(whole(FaceEnergy(c.forms, model), c.x) / mean({0, 0}, 0), 1, 1e-12);
    model.v2 = true;
    EXPECT_NEAR(whole(FaceEnergy(c.forms, model), c.x) / mean({0, 0}, a * a / 8), 1, 1e-12);
    model.v1 = true;
    // The mean is a convex quadratic in v₁: Newton from differences finds its minimum.
    const double step = 1e-3;
    const auto f = [&](double x, double y) { return mean({x * step, y * step}, a * a / 8); };
    const double f0 = f(0, 0);
    Vector2d gradient((f(1, 0) - f(-1, 0)) / 2, (f(0, 1) - f(0, -1)) / 2);
    Matrix2d hessian;
    hessian << f(1, 0) - 2 * f0 + f(-1, 0), 0, 0, f(0, 1) - 2 * f0 + f(0, -1);
    hessian(0, 1) = hessian(1, 0) = (f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / 4;
    const Vector2d best = -hessian.inverse() * gradient;
    EXPECT_NEAR(whole(FaceEnergy(c.forms, model), c.x) / f(best.x(), best.y()), 1,
                1e-9);  // differences cancel
  }
}

// Compressed both ways, waves of one direction can take all of it up that counts.
TEST(WrinkleEnergy, CompressionAlongTheCrestsCostsNothing) {
  Case c = random_case(1);
  c.forms.strain << -0.02, 0.01, 0.01, -0.05;
  c.forms.second_form.setZero();
  const PrincipalStrain principal = principal_strain(c.forms);
  ASSERT_LT(principal.tension, 0);
  Model model = test::model(1e7, 0.3, 1e-9);  // and hardly bends
  const double a = 1e-3;
  c.x << a, a, a, std::sqrt(-2 * principal.compression) / a * principal.wave;
  const double flat = FaceEnergy(c.forms, model).value(LocalVector::Zero());
  // What is left is bending and W²_b, by (h|ω|)² less.
  EXPECT_NEAR(whole(FaceEnergy(c.forms, model), c.x) / flat, 0, 1e-6);
  model.crest_compression = true;
  EXPECT_GT(whole(FaceEnergy(c.forms, model), c.x) / flat, 0.01);
}

TEST(WrinkleEnergy, DerivativesAreThoseOfDifferences) {
  const LocalVector unit{1e-3, 1e-3, 1e-3, 500, 500};  // typical sizes
  for (const bool v2 : {true, false}) {
    Model model = test::model(1e7, 0.44, 1e-4);
    model.v2 = v2;
    for (unsigned seed = 0; seed < 3; ++seed) {
      const Case c = random_case(seed);
      const FaceEnergy energy(c.forms, model);
      LocalVector first, up, down;
      LocalMatrix second;
      const double value = energy.hessian(c.x, first, second);
      ASSERT_DOUBLE_EQ(value, energy.value(c.x));
      LocalVector alone;
      energy.gradient(c.x, alone);
      EXPECT_EQ(alone, first);
      const LocalMatrix scaled = unit.asDiagonal() * second * unit.asDiagonal();
      for (const double step : {1e-2, 1e-3, 1e-4}) {
        for (int i = 0; i < 5; ++i) {
          LocalVector d = LocalVector::Zero();
          d[i] = step * unit[i];
          const double difference = (energy.value(c.x + d) - energy.value(c.x - d)) / (2 * step);
          energy.gradient(c.x + d, up);
          energy.gradient(c.x - d, down);
          // Central differences of a polynomial of low degree: an error of step² times its size, and rounding
          // over the step.
          const double size = scaled.cwiseAbs().maxCoeff(), tolerance = 10 * step * step + 1e-12 / step;
          EXPECT_NEAR(difference, first[i] * unit[i], tolerance * size) << step << ' ' << i;
          const LocalVector column = unit.asDiagonal() * (up - down) / (2 * step);
          EXPECT_LT((column - scaled.col(i)).cwiseAbs().maxCoeff(), tolerance * size) << step << ' ' << i;
        }
      }
    }
  }
}

TEST(WrinkleEnergy, TensionHasNoCurvatureTerm) {
  Case c = random_case(1);
  c.forms.strain = test::diagonal(0.02, 0.01);
  const Model model = test::model(1e7, 0.3, 1e-3);
  const double bent = FaceEnergy(c.forms, model).value(c.x);
  c.forms.second_form.setZero();
  EXPECT_EQ(FaceEnergy(c.forms, model).value(c.x), bent);  // section 4.2: W² is left out where λ₂ ≥ 0
}

}  // namespace
}  // namespace plisse::wrinkle
