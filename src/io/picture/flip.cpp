// Section numbers are the paper's. The colour pipeline (4.1) and the feature pipeline (4.2) meet in 4.3.
#include "io/picture/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "base/error.h"

namespace plisse::io {
namespace {

using std::numbers::pi;

// 4.1.3, 4.2 and 4.3: the constants the authors chose.
constexpr double colour_exponent = 0.7;   // q_c
constexpr double colour_knee = 0.4;       // p_c: this share of the largest colour difference …
constexpr double error_at_knee = 0.95;    // p_t: … is mapped to this error
constexpr double feature_width = 0.082;   // w, degrees of visual angle
constexpr double feature_exponent = 0.5;  // q_f

// --- colour spaces; D65 white is linear RGB (1, 1, 1)
// -------------------------------------------------------------

// Rows of sRGB → XYZ (IEC 61966-2-1 primaries, exact fractions); glm wants columns.
const glm::dmat3 rgb_to_xyz =
    glm::transpose(glm::dmat3(10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,  //
                              2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,    //
                              1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382));
const glm::dmat3 xyz_to_rgb = glm::inverse(rgb_to_xyz);
const glm::dvec3 white = rgb_to_xyz * glm::dvec3(1);

double linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Linearised L*a*b*, in which 4.1.1 filters.
glm::dvec3 ycxcz(glm::dvec3 xyz) {
  const glm::dvec3 c = xyz / white;
  return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

glm::dvec3 xyz_of_ycxcz(glm::dvec3 v) {
  const double y = (v.x + 16) / 116;
  return glm::dvec3(y + v.y / 500, y, y - v.z / 200) * white;
}

glm::dvec3 lab(glm::dvec3 xyz) {
  const auto f = [](double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const glm::dvec3 c = xyz / white;
  return {116 * f(c.y) - 16, 500 * (f(c.x) - f(c.y)), 200 * (f(c.y) - f(c.z))};
}

// 4.1.2: colours of dark pixels differ less to the eye (Hunt).
glm::dvec3 hunt(glm::dvec3 lab_colour) {
  const double scale = 0.01 * lab_colour.x;
  return {lab_colour.x, scale * lab_colour.y, scale * lab_colour.z};
}

// 4.1.3: city-block in lightness, Euclidean in chroma; made for large differences.
double hyab(glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 d = a - b;
  return std::abs(d.x) + std::hypot(d.y, d.z);
}

// --- filters
// -----------------------------------------------------------------------------------------------------

struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;
  Plane(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
  const float* row(int y) const { return const_cast<Plane*>(this)->row(y); }
};

using Kernel = std::vector<float>;  // odd length, the middle entry at the pixel itself

// Adds the separable filter of `plane` to `sum`. Both kernels have the same radius.
void add_filtered(const Plane& plane, const Kernel& across, const Kernel& down, Plane& sum) {
  const int radius = static_cast<int>(across.size() / 2);
  Plane half(plane.width, plane.height);
  std::vector<float> padded(static_cast<std::size_t>(plane.width + 2 * radius));
  for (int y = 0; y < plane.height; ++y) {
    const float* in = plane.row(y);
    float* out = half.row(y);
    for (int x = -radius; x < plane.width + radius; ++x) {
      padded[static_cast<std::size_t>(x + radius)] = in[std::clamp(x, 0, plane.width - 1)];
    }
    for (int k = 0; k <= 2 * radius; ++k) {
      const float weight = across[static_cast<std::size_t>(k)];
      for (int x = 0; x < plane.width; ++x) out[x] += weight * padded[static_cast<std::size_t>(x + k)];
    }
  }
  for (int y = 0; y < plane.height; ++y) {
    float* out = sum.row(y);
    for (int k = 0; k <= 2 * radius; ++k) {
      const float weight = down[static_cast<std::size_t>(k)];
      const float* in = half.row(std::clamp(y + k - radius, 0, plane.height - 1));
      for (int x = 0; x < plane.width; ++x) out[x] += weight * in[x];
    }
  }
}

// 4.1.1: contrast sensitivity as a sum of Gaussians, Σ a √(π/b) exp(−π² z²/b), z in degrees (table 1).
struct Gaussian {
  double a, b;
};
constexpr std::array<Gaussian, 1> achromatic{{{1, 0.0047}}};
constexpr std::array<Gaussian, 1> red_green{{{1, 0.0053}}};
constexpr std::array<Gaussian, 2> blue_yellow{{{34.1, 0.04}, {13.5, 0.025}}};

Plane contrast_filtered(const Plane& plane, std::span<const Gaussian> gaussians, double pixels_per_degree) {
  // Three standard deviations of the widest of all.
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
  std::vector<std::vector<double>> profiles;
  double total = 0;
  for (const auto& [a, b] : gaussians) {
    auto& profile = profiles.emplace_back();
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
      const double z = i / pixels_per_degree;
      sum += profile.emplace_back(std::exp(-pi * pi * z * z / b));
    }
    total += a * std::sqrt(pi / b) * sum * sum;
  }
  Plane filtered(plane.width, plane.height);
  for (std::size_t g = 0; g < gaussians.size(); ++g) {
    const auto [a, b] = gaussians[g];
    Kernel across, down;
    for (const double value : profiles[g]) {
      across.push_back(static_cast<float>(value));
      down.push_back(static_cast<float>(a * std::sqrt(pi / b) * value / total));
    }
    add_filtered(plane, across, down, filtered);
  }
  return filtered;
}

// 4.2: first (edges) and second (points) derivatives of a Gaussian in x; turned by swapping the two. Their
// positive weights sum to 1, their negative ones to −1, over the whole square.
struct FeatureKernels {
  Kernel smooth, edge, point;
};

FeatureKernels feature_kernels(double pixels_per_degree) {
  const double sigma = 0.5 * feature_width * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  double smooth_sum = 0, edge_sum = 0, point_positive = 0, point_negative = 0;
  const auto gauss = [&](int i) { return std::exp(-i * i / (2 * sigma * sigma)); };
  const auto edge = [&](int i) { return -i * gauss(i); };
  const auto point = [&](int i) { return (i * i / (sigma * sigma) - 1) * gauss(i); };
  for (int i = -radius; i <= radius; ++i) {
    smooth_sum += gauss(i);
    edge_sum += std::max(0.0, edge(i));
    point_positive += std::max(0.0, point(i));
    point_negative += std::max(0.0, -point(i));
  }
  FeatureKernels kernels;
  for (int i = -radius; i <= radius; ++i) {
    kernels.smooth.push_back(static_cast<float>(gauss(i) / smooth_sum));
    kernels.edge.push_back(static_cast<float>(edge(i) / edge_sum));
    kernels.point.push_back(static_cast<float>(point(i) / (point(i) > 0 ? point_positive : point_negative)));
  }
  return kernels;
}

Plane magnitude(const Plane& plane, const Kernel& derivative, const Kernel& smooth) {
  Plane x(plane.width, plane.height), y(plane.width, plane.height);
  add_filtered(plane, derivative, smooth, x);
  add_filtered(plane, smooth, derivative, y);
  for (std::size_t i = 0; i < x.values.size(); ++i) x.values[i] = std::hypot(x.values[i], y.values[i]);
  return x;
}

// --- one image through both pipelines
// ----------------------------------------------------------------------------

struct Seen {
  std::vector<glm::vec3> colour;  // filtered, L*a*b* with Hunt's adjustment
  Plane edges, points;
};

Seen see(const Image& image, double pixels_per_degree) {
  std::array<double, 256> decoded{};
  for (std::size_t i = 0; i < decoded.size(); ++i) decoded[i] = linear(static_cast<double>(i) / 255);

  Plane y(image.width, image.height), cx(image.width, image.height), cz(image.width, image.height);
  Plane grey(image.width, image.height);
  const std::size_t count = y.values.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* rgb = &image.rgba[4 * i];
    const glm::dvec3 v = ycxcz(rgb_to_xyz * glm::dvec3(decoded[rgb[0]], decoded[rgb[1]], decoded[rgb[2]]));
    y.values[i] = static_cast<float>(v.x);
    cx.values[i] = static_cast<float>(v.y);
    cz.values[i] = static_cast<float>(v.z);
    grey.values[i] = static_cast<float>((v.x + 16) / 116);
  }

  const FeatureKernels kernels = feature_kernels(pixels_per_degree);
  Seen seen{
      {}, magnitude(grey, kernels.edge, kernels.smooth), magnitude(grey, kernels.point, kernels.smooth)};
  y = contrast_filtered(y, achromatic, pixels_per_degree);
  cx = contrast_filtered(cx, red_green, pixels_per_degree);
  cz = contrast_filtered(cz, blue_yellow, pixels_per_degree);
  seen.colour.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 rgb = xyz_to_rgb * xyz_of_ycxcz({y.values[i], cx.values[i], cz.values[i]});
    seen.colour.emplace_back(hunt(lab(rgb_to_xyz * glm::clamp(rgb, 0.0, 1.0))));
  }
  return seen;
}

// 4.1.3: the largest difference is that of green and blue; the knee leaves most of the range to smaller ones.
double colour_error(glm::dvec3 a, glm::dvec3 b) {
  static const double largest =
      std::pow(hyab(hunt(lab(rgb_to_xyz * glm::dvec3(0, 1, 0))), hunt(lab(rgb_to_xyz * glm::dvec3(0, 0, 1)))),
               colour_exponent);
  const double difference = std::pow(hyab(a, b), colour_exponent);
  const double knee = colour_knee * largest;
  if (difference < knee) return error_at_knee / knee * difference;
  return std::min(1.0, error_at_knee + (difference - knee) / (largest - knee) * (1 - error_at_knee));
}

void check_sizes(const Image& reference, const Image& test, std::size_t mask, double pixels_per_degree) {
  const auto refuse = [](const std::string& what) { throw Error(ExitCode::bad_input, "FLIP: " + what); };
  const auto bytes = [](const Image& i) {
    return 4 * static_cast<std::size_t>(i.width) * static_cast<std::size_t>(i.height);
  };
  if (reference.width != test.width || reference.height != test.height || reference.width < 1 ||
      reference.height < 1 || reference.rgba.size() != bytes(reference) || test.rgba.size() != bytes(test)) {
    refuse(fmt::format("images of {} × {} and {} × {} pixels cannot be compared; the same size is needed",
                       reference.width, reference.height, test.width, test.height));
  }
  if (mask != 0 && 4 * mask != reference.rgba.size()) {
    refuse(fmt::format("a mask of {} entries does not fit {} × {} pixels", mask, reference.width,
                       reference.height));
  }
  if (!(pixels_per_degree > 0) || pixels_per_degree > 1000) {
    refuse(fmt::format("{} pixels per degree; more than 0 and up to 1000 are allowed", pixels_per_degree));
  }
}

}  // namespace

FlipResult flip(const Image& reference, const Image& test, std::span<const std::uint8_t> mask,
                double pixels_per_degree) {
  check_sizes(reference, test, mask.size(), pixels_per_degree);
  const Seen a = see(reference, pixels_per_degree);
  const Seen b = see(test, pixels_per_degree);

  FlipResult result;
  result.error.reserve(a.colour.size());
  double sum = 0;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < a.colour.size(); ++i) {
    const double colour = colour_error(a.colour[i], b.colour[i]);
    const double features = std::max(std::abs(a.edges.values[i] - b.edges.values[i]),
                                     std::abs(a.points.values[i] - b.points.values[i]));
    const double feature = std::pow(std::min(1.0, features / std::numbers::sqrt2), feature_exponent);
    const double error = std::pow(colour, 1 - feature);  // 4.3: a feature that comes or goes amplifies
    result.error.push_back(static_cast<float>(error));
    if (mask.empty() || mask[i] != 0) {
      sum += error;
      ++counted;
    }
  }
  result.mean = counted == 0 ? 0 : sum / static_cast<double>(counted);
  return result;
}

}  // namespace plisse::io
