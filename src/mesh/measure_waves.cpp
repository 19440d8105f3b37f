#include "mesh/measure_waves.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <queue>
#include <utility>

#include "base/eigen_glm.h"
#include "mesh/triangle_tree.h"

namespace plisse {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using std::numbers::pi;
using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr int moments = 1024;      // resolution in k: k_max π/2 over this
constexpr int grid = 4 * moments;  // sample points of the density
constexpr int most_waves = 4;
constexpr int bin_count = 64;

struct Laplacian {
  Sparse stiffness;  // L, positive semi-definite
  VectorXd mass;     // lumped: a third of the areas around
};

glm::dvec3 at(const std::vector<glm::dvec3>& x, const std::vector<std::uint32_t>& triangles, std::size_t i) {
  return x[triangles[i]];
}

Laplacian laplacian(const std::vector<glm::dvec3>& x, const std::vector<std::uint32_t>& triangles) {
  Laplacian result;
  const auto n = static_cast<Index>(x.size());
  result.mass = VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const double twice = glm::length(glm::cross(at(x, triangles, t + 1) - at(x, triangles, t),
                                                at(x, triangles, t + 2) - at(x, triangles, t)));
    if (!(twice > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t a = t + (c + 1) % 3, b = t + (c + 2) % 3;
      const glm::dvec3 corner = at(x, triangles, t + c);
      // Obtuse corners would make weights negative and the operator indefinite.
      const double half_cotangent =
          std::max(0.0, 0.5 * glm::dot(at(x, triangles, a) - corner, at(x, triangles, b) - corner) / twice);
      const auto i = static_cast<Index>(triangles[a]), j = static_cast<Index>(triangles[b]);
      entries.emplace_back(i, i, half_cotangent);
      entries.emplace_back(j, j, half_cotangent);
      entries.emplace_back(i, j, -half_cotangent);
      entries.emplace_back(j, i, -half_cotangent);
      result.mass[static_cast<Index>(triangles[t + c])] += twice / 6;
    }
  }
  result.stiffness.resize(n, n);
  result.stiffness.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// x̃ = 1 − 2 M^(-1/2) L M^(-1/2)/λ_max, whose eigenvalues cos θ lie in −1…1: k = √λ_max sin(θ/2).
struct Scaled {
  Sparse matrix;
  double longest = 0;  // √λ_max
};

Scaled scaled(const Laplacian& laplacian) {
  const VectorXd root = laplacian.mass.unaryExpr([](double m) { return m > 0 ? 1 / std::sqrt(m) : 0.0; });
  const Sparse a = root.asDiagonal() * laplacian.stiffness * root.asDiagonal();
  // Gershgorin's bound: rows of L sum to 0, so it is at most twice the largest diagonal entry's share.
  double largest = 0;
  for (Index i = 0; i < a.rows(); ++i) {
    double sum = 0;
    for (Sparse::InnerIterator it(a, i); it; ++it) sum += std::abs(it.value());
    largest = std::max(largest, sum);
  }
  Scaled result;
  result.longest = std::sqrt(largest);
  Sparse one(a.rows(), a.cols());
  one.setIdentity();
  result.matrix = largest > 0 ? Sparse(one - 2 / largest * a) : one;
  return result;
}

// Calls work(m, T_m v) for m = 0 … count − 1.
template <typename Work>
void chebyshev(const Sparse& x, const VectorXd& v, int count, const Work& work) {
  VectorXd before = v, now = x * v;
  work(0, before);
  for (int m = 1; m < count; ++m) {
    work(m, now);
    VectorXd next = 2 * (x * now) - before;
    before = std::move(now);
    now = std::move(next);
  }
}

// Jackson's kernel: the density stays positive and a line gets the width π/moments in θ.
double jackson(int m) {
  const double n = moments + 1, q = pi / n;
  return ((n - m) * std::cos(q * m) + std::sin(q * m) / std::tan(q)) / n;
}

// Power per θ at θ_j = π (j + ½)/grid, its sum the square of v's length.
std::vector<double> density(const Sparse& x, const VectorXd& v) {
  std::vector<double> mu(moments, 0.0);
  VectorXd last;
  mu[0] = v.squaredNorm();
  chebyshev(x, v, moments / 2, [&](int m, const VectorXd& t) {
    // T_2m = 2 T_m² − T_0, T_2m−1 = 2 T_m T_m−1 − T_1: two moments a product.
    if (m == 1) mu[1] = t.dot(v);
    if (m >= 1) {
      mu[static_cast<std::size_t>(2 * m)] = 2 * t.squaredNorm() - mu[0];
      if (m > 1) mu[static_cast<std::size_t>(2 * m - 1)] = 2 * t.dot(last) - mu[1];
    }
    last = t;
  });
  // The last odd moment is not computed; the kernel's weight there is 0 anyway.
  std::vector<double> result(grid);
  tbb::parallel_for(0, grid, [&](int j) {
    const double theta = pi * (j + 0.5) / grid;
    double sum = mu[0];
    for (int m = 1; m < moments; ++m)
      sum += 2 * jackson(m) * mu[static_cast<std::size_t>(m)] * std::cos(m * theta);
    result[static_cast<std::size_t>(j)] = std::max(0.0, sum / grid);
  });
  return result;
}

struct Peak {
  int low = 0, top = 0, high = 0;  // grid indices: the peak and the minima on both sides
  double power = 0;
};

// On a surface with a boundary, modes are up to π over the shorter side apart in k. A wave that is not one of
// the modes appears as several narrow peaks, in the worst case at every second mode; smoothing with a bell of
// that width in k joins them to one peak. A wave across that side has k of at least 2π times the number of
// waves over it; so with four or more waves a bell of .15 k is wide enough, or the bell for a square of the
// same area. Then different waves along a ribbon are not joined to one.
std::vector<double> smoothed(const std::vector<double>& power, double longest, double narrowest,
                             double widest) {
  std::vector<double> result(power.size(), 0.0);
  const auto wavenumber = [&](int j) { return longest * std::sin(0.5 * pi * (j + 0.5) / grid); };
  tbb::parallel_for(0, grid, [&](int j) {
    const double k = wavenumber(j), width = std::min(widest, std::max(narrowest, 0.15 * k));
    const auto add = [&](int step) {
      for (int i = j + step; i >= 0 && i < grid; i += step) {
        const double apart = (wavenumber(i) - k) / width;
        if (std::abs(apart) > 4) break;
        result[static_cast<std::size_t>(j)] +=
            std::exp(-0.5 * apart * apart) * power[static_cast<std::size_t>(i)];
      }
    };
    result[static_cast<std::size_t>(j)] = power[static_cast<std::size_t>(j)];
    add(-1);
    add(1);
  });
  return result;
}

// Peaks of `hills`, each from minimum to minimum, with their share of `power`.
std::vector<Peak> peaks(const std::vector<double>& power, const std::vector<double>& hills) {
  std::vector<Peak> found;
  const auto h = [&](int j) { return hills[static_cast<std::size_t>(j)]; };
  for (int j = 1; j + 1 < grid; ++j) {
    if (!(h(j) > h(j - 1) && h(j) >= h(j + 1))) continue;
    Peak peak{j, j, j, 0};
    while (peak.low > 0 && h(peak.low - 1) <= h(peak.low)) --peak.low;
    while (peak.high + 1 < grid && h(peak.high + 1) <= h(peak.high)) ++peak.high;
    for (int i = peak.low; i <= peak.high; ++i) peak.power += power[static_cast<std::size_t>(i)];
    found.push_back(peak);
  }
  std::sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.power > b.power; });
  // A tenth of the strongest wave's amplitude.
  while (!found.empty() && (found.size() > most_waves || found.back().power < 0.01 * found.front().power))
    found.pop_back();
  return found;
}

// The part of v between two angles: Chebyshev series of a step up and a step down.
std::vector<VectorXd> filtered(const Sparse& x, const VectorXd& v, const std::vector<Peak>& peaks) {
  std::vector<VectorXd> parts(peaks.size(), VectorXd::Zero(v.size()));
  chebyshev(x, v, moments, [&](int m, const VectorXd& t) {
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      const double low = pi * peaks[i].low / grid, high = pi * (peaks[i].high + 1) / grid;
      const double c = m == 0 ? (high - low) / pi : 2 / pi * (std::sin(m * high) - std::sin(m * low)) / m;
      parts[i] += jackson(m) * c * t;
    }
  });
  return parts;
}

struct Rim {
  double length = 0;
  std::vector<double> distance;  // of each vertex, along edges; infinite where there is no boundary
};

// Edges of one triangle only, and the distance of all vertices from them (Dijkstra).
Rim rim_of(const HeightField& field) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> edges;
  edges.reserve(field.triangles.size());
  for (std::size_t i = 0; i < field.triangles.size(); ++i)
    edges.push_back(std::minmax(field.triangles[i], field.triangles[i % 3 == 2 ? i - 2 : i + 1]));
  std::sort(edges.begin(), edges.end());
  Rim rim;
  rim.distance.assign(field.base.size(), INFINITY);
  std::vector<std::vector<std::uint32_t>> neighbours(field.base.size());
  using Place = std::pair<double, std::uint32_t>;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> queue;
  for (auto first = edges.begin(); first != edges.end();) {
    const auto [a, b] = *first;
    const auto last = std::find_if(first, edges.end(), [&](const Edge& edge) { return edge != *first; });
    const bool on_rim = last - first == 1;
    first = last;
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
    if (!on_rim) continue;
    rim.length += glm::distance(field.base[a], field.base[b]);
    for (const auto v : {a, b}) {
      if (rim.distance[v] > 0) queue.emplace(0, v);
      rim.distance[v] = 0;
    }
  }
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > rim.distance[v]) continue;
    for (const auto other : neighbours[v]) {
      const double there = distance + glm::distance(field.base[v], field.base[other]);
      if (there >= rim.distance[other]) continue;
      rim.distance[other] = there;
      queue.emplace(there, other);
    }
  }
  return rim;
}

// The shorter side of the rectangle with this area and boundary length; the root of the area where the
// boundary is too short for a rectangle: a hole in a closed surface, or no boundary.
double shorter_side(double area, double rim) {
  const double square = rim * rim / 16 - area;
  return square > 0 ? 0.25 * rim - std::sqrt(square) : std::sqrt(area);
}

// The wavelength of f, one wave, from ∫w|∇f|² = k² ∫w f². The weight w falls to zero at the boundary over one
// wavelength, `guess`, because the filter distorts f there. Nothing where most of f is that close to the
// boundary.
std::optional<double> wavelength_away_from(const Rim& rim, double guess, const HeightField& field,
                                           const VectorXd& f) {
  double slopes = 0, heights = 0, all = 0, inmost = 0;
  for (const double distance : rim.distance)
    if (std::isfinite(distance)) inmost = std::max(inmost, distance);
  const double fall = inmost > 0 ? std::min(guess, inmost) : guess;
  for (std::size_t t = 0; t + 2 < field.triangles.size(); t += 3) {
    const auto x = [&](std::size_t c) { return field.base[field.triangles[t + c]]; };
    const auto value = [&](std::size_t c) { return f[static_cast<Index>(field.triangles[t + c])]; };
    const glm::dvec3 b = x(1) - x(0), c = x(2) - x(0), normal = glm::cross(b, c);
    const double square = glm::dot(normal, normal);
    if (!(square > 0)) continue;
    const glm::dvec3 slope =
        ((value(1) - value(0)) * glm::cross(c, normal) + (value(2) - value(0)) * glm::cross(normal, b)) /
        square;
    // Linear interpolation of a wave is less steep than the wave: for e^(ik·x), a triangle with edges e and
    // cotangents c gives Σ c 2(1 − cos k·e) instead of Σ c (k·e)².
    double steeper = 1;
    if (const double steep = glm::length(slope); steep > 0) {
      const glm::dvec3 k = 2 * pi / (guess * steep) * slope;
      double truth = 0, shown = 0;
      for (const auto& [edge, cotangent] :
           {std::pair{b, glm::dot(c, c - b)}, std::pair{c, glm::dot(b, b - c)},
            std::pair{c - b, glm::dot(b, c)}}) {
        const double turn = glm::dot(k, edge);
        truth += cotangent * turn * turn;
        shown += cotangent * 2 * (1 - std::cos(turn));
      }
      if (shown > 0.4 * truth) steeper = truth / shown;
    }
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const double near = std::min(1.0, rim.distance[field.triangles[t + corner]] / fall);
      const double weight = std::sqrt(square) * std::pow(std::sin(0.5 * pi * near), 2);
      slopes += weight * steeper * glm::dot(slope, slope);
      heights += weight * value(corner) * value(corner);
      all += std::sqrt(square) * value(corner) * value(corner);
    }
  }
  if (!(heights > 0.25 * all && slopes > 0)) return std::nullopt;
  return 2 * pi * std::sqrt(heights / slopes);
}

glm::dvec3 direction_of(const HeightField& field, const VectorXd& f) {
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t + 2 < field.triangles.size(); t += 3) {
    const auto x = [&](std::size_t c) { return to_eigen(field.base[field.triangles[t + c]]); };
    const auto value = [&](std::size_t c) { return f[static_cast<Index>(field.triangles[t + c])]; };
    const Eigen::Vector3d b = x(1) - x(0), c = x(2) - x(0), normal = b.cross(c);
    const double square = normal.squaredNorm();
    if (!(square > 0)) continue;
    const Eigen::Vector3d slope =
        ((value(1) - value(0)) * c.cross(normal) + (value(2) - value(0)) * normal.cross(b)) / square;
    tensor += std::sqrt(square) * slope * slope.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
  // Around a tube the slopes have all directions: no direction is twice as strong as the next.
  if (!(solver.eigenvalues()[2] > 2 * solver.eigenvalues()[1])) return glm::dvec3(0);
  Eigen::Vector3d d = solver.eigenvectors().col(2);
  Index largest = 0;
  d.cwiseAbs().maxCoeff(&largest);
  if (d[largest] < 0) d = -d;
  return {d.x(), d.y(), d.z()};
}

// Connected regions where f is above 0. Regions smaller than a sixteenth of a squared wavelength, and regions
// that are nowhere higher than a tenth of the wave, are left out: they are crests cut by the boundary, and
// rounding errors.
int crests(const HeightField& field, const VectorXd& f, const VectorXd& mass, const MeshWave& wave) {
  std::vector<std::uint32_t> parent(field.base.size());
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = v;
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (std::size_t i = 0; i < field.triangles.size(); ++i) {
    const std::uint32_t a = field.triangles[i], b = field.triangles[i % 3 == 2 ? i - 2 : i + 1];
    if (f[static_cast<Index>(a)] > 0 && f[static_cast<Index>(b)] > 0) parent[root(a)] = root(b);
  }
  struct Region {
    double area = 0, top = 0;
  };
  std::map<std::uint32_t, Region> regions;
  for (std::uint32_t v = 0; v < parent.size(); ++v) {
    const double height = f[static_cast<Index>(v)];
    if (!(height > 0)) continue;
    Region& region = regions[root(v)];
    region.area += mass[static_cast<Index>(v)];
    region.top = std::max(region.top, height);
  }
  return static_cast<int>(std::count_if(regions.begin(), regions.end(), [&](const auto& region) {
    return region.second.area > wave.wavelength * wave.wavelength / 16 &&
           region.second.top > 0.1 * wave.amplitude;
  }));
}

std::vector<glm::dvec3> vertex_normals(const std::vector<glm::dvec3>& x,
                                       const std::vector<std::uint32_t>& triangles) {
  std::vector<glm::dvec3> normals(x.size(), glm::dvec3(0));
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const glm::dvec3 area = glm::cross(at(x, triangles, t + 1) - at(x, triangles, t),
                                       at(x, triangles, t + 2) - at(x, triangles, t));
    for (std::size_t c = 0; c < 3; ++c) normals[triangles[t + c]] += area;
  }
  for (auto& n : normals) {
    const double length = glm::length(n);
    n = length > 0 ? n / length : glm::dvec3(0);
  }
  return normals;
}

}  // namespace

MeshSpectrum measure_waves(const HeightField& field) {
  MeshSpectrum spectrum;
  const Laplacian l = laplacian(field.base, field.triangles);
  const double area = l.mass.sum();
  if (!(area > 0)) return spectrum;
  VectorXd f = Eigen::Map<const VectorXd>(field.height.data(), static_cast<Index>(field.height.size()));
  f.array() -= l.mass.dot(f) / area;
  const VectorXd root = l.mass.cwiseSqrt(), v = root.cwiseProduct(f);
  // Rounding errors of positions are not waves.
  if (!(v.squaredNorm() > 1e-18 * area * area)) return spectrum;
  const Scaled x = scaled(l);
  std::vector<double> power = density(x.matrix, v);
  const auto wavenumber = [&](double j) { return x.longest * std::sin(0.5 * pi * (j + 0.5) / grid); };
  for (int j = 0; j < grid; ++j) {
    const double sk = field.smoothing * wavenumber(j) * wavenumber(j);
    // If more than half of a wave is in the base, its amplitude cannot be determined.
    if (field.smoothing > 0) power[static_cast<std::size_t>(j)] *= sk < 1 ? 0 : std::pow((1 + sk) / sk, 2);
  }

  const Rim rim = rim_of(field);
  const std::vector<double> hills =
      smoothed(power, x.longest, 1.1 * pi / std::sqrt(area), 1.1 * pi / shorter_side(area, rim.length));
  const std::vector<Peak> found = peaks(power, hills);
  std::vector<VectorXd> parts = filtered(x.matrix, v, found);
  // Where the boundary cuts a wave, a little of its power is spread over the whole spectrum. If the power
  // outside all peaks is only that little, it is given to the strongest wave; without it, that wave's crests
  // would be distorted at the boundary and counted wrongly.
  if (!parts.empty()) {
    VectorXd rest = v;
    for (const VectorXd& part : parts) rest -= part;
    if (rest.norm() < 0.3 * parts[0].norm()) parts[0] += rest;
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    // The middle of the range above half of the peak.
    double sum = 0, mean = 0;
    for (int j = found[i].low; j <= found[i].high; ++j) {
      const double p = hills[static_cast<std::size_t>(j)];
      if (p < 0.5 * hills[static_cast<std::size_t>(found[i].top)]) continue;
      sum += p;
      mean += p * wavenumber(j);
    }
    MeshWave wave;
    wave.wavelength = 2 * pi * sum / mean;
    wave.amplitude = std::sqrt(2 * found[i].power / area);
    const VectorXd part = root.unaryExpr([](double r) { return r > 0 ? 1 / r : 0.0; }).cwiseProduct(parts[i]);
    wave.wavelength = wavelength_away_from(rim, wave.wavelength, field, part).value_or(wave.wavelength);
    wave.direction = direction_of(field, part);
    wave.count = crests(field, part, l.mass, wave);
    spectrum.waves.push_back(wave);
  }
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::dvec3& p : field.base) low = glm::min(low, p), high = glm::max(high, p);
  const double longest = glm::distance(low, high), shortest = 2 * pi / x.longest;
  const double step = std::log(longest / shortest) / bin_count;
  for (int b = 0; b < bin_count; ++b) spectrum.bins.push_back({longest * std::exp(-(b + 0.5) * step), 0});
  for (int j = 0; j < grid; ++j) {
    const double place = std::log(longest * wavenumber(j) / (2 * pi)) / step;
    const auto bin = static_cast<std::size_t>(std::clamp(place, 0.0, bin_count - 1.0));
    spectrum.bins[bin].power += power[static_cast<std::size_t>(j)] / area;
  }
  return spectrum;
}

HeightField height_over_own_shape(const std::vector<glm::dvec3>& positions,
                                  const std::vector<std::uint32_t>& triangles) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::dvec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  HeightField field{positions, std::vector<double>(positions.size(), 0.0), triangles,
                    std::pow(glm::distance(low, high) / (6 * pi), 2)};
  // Lengths are measured on the base; the first round uses the mesh itself as an estimate of it.
  for (int round = 0; round < 3; ++round) {
    const Laplacian l = laplacian(field.base, triangles);
    const VectorXd mass = l.mass.cwiseMax(1e-300);
    Sparse system = field.smoothing * l.stiffness;
    for (Index i = 0; i < system.rows(); ++i) system.coeffRef(i, i) += mass[i];
    Eigen::ConjugateGradient<Sparse, Eigen::Lower | Eigen::Upper> solver(system);
    solver.setTolerance(1e-8);
    std::vector<glm::dvec3> smooth(positions.size());
    for (int axis = 0; axis < 3; ++axis) {
      VectorXd x(static_cast<Index>(positions.size()));
      for (std::size_t i = 0; i < positions.size(); ++i) x[static_cast<Index>(i)] = positions[i][axis];
      const VectorXd solved = solver.solveWithGuess(mass.cwiseProduct(x), x);
      for (std::size_t i = 0; i < positions.size(); ++i) smooth[i][axis] = solved[static_cast<Index>(i)];
    }
    const auto normals = vertex_normals(smooth, triangles);
    // Smoothing shrinks a tube as a whole; this is not a wave, and would make lengths on the base too short.
    double mean = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      field.height[i] = glm::dot(positions[i] - smooth[i], normals[i]);
      mean += field.height[i] * l.mass[static_cast<Index>(i)] / l.mass.sum();
    }
    for (std::size_t i = 0; i < positions.size(); ++i) {
      field.height[i] -= mean;
      field.base[i] = positions[i] - field.height[i] * normals[i];
    }
  }
  return field;
}

HeightField height_over_base(const std::vector<glm::dvec3>& positions,
                             const std::vector<std::uint32_t>& triangles, const std::vector<glm::dvec3>& base,
                             const std::vector<std::uint32_t>& base_triangles) {
  const auto normals = vertex_normals(base, base_triangles);
  std::vector<TriangleTree::Triangle> faces;
  for (std::size_t t = 0; t + 2 < base_triangles.size(); t += 3)
    faces.push_back({base_triangles[t], base_triangles[t + 1], base_triangles[t + 2]});
  const TriangleTree tree(points_to_eigen(base), std::move(faces));
  HeightField field{positions, std::vector<double>(positions.size(), 0.0), triangles, 0};
  if (base_triangles.empty()) return field;
  tbb::parallel_for(std::size_t{0}, positions.size(), [&](std::size_t i) {
    const glm::dvec3 x = positions[i];
    const TriangleTree::Nearest near = tree.nearest(to_eigen(x));
    glm::dvec3 n(0);
    for (std::size_t c = 0; c < 3; ++c)
      n += near.weights[static_cast<Index>(c)] * normals[tree.triangles()[near.triangle][c]];
    field.base[i] = to_glm(near.point);
    field.height[i] = glm::dot(x - field.base[i], n) < 0 ? -near.distance : near.distance;
  });
  return field;
}

}  // namespace plisse
