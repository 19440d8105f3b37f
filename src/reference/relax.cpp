#include "reference/relax.h"

#include <cmath>

#include "reference/functions.h"

namespace plisse::reference {

using Eigen::Index;
using Eigen::Vector3d;
using Complex = std::complex<double>;

namespace {

Status status_of(const WaveField& field, Index vertex) {
  return field.status[static_cast<std::size_t>(vertex)];
}

double target_turns(const WaveField& field, Index vertex, Index neighbour) {
  const Transport t = transport(field, vertex, neighbour);
  return t.sign * field.phases[neighbour] / (2 * pi) + t.offset;
}

double set_weight(const WaveField& field, Index vertex) {
  return status_of(field, vertex) == Status::set ? field.weights[vertex] : 0;
}

}  // namespace

WaveField wave_field(const Eigen::Matrix3Xd& positions, const Frames& frames,
                     const std::vector<CrushResult>& crushed, const Eigen::VectorXd& phases) {
  WaveField field;
  field.positions = positions;
  field.wavenumbers.resize(3, positions.cols());
  field.weights.resize(positions.cols());
  field.phases = phases;
  for (Index v = 0; v < positions.cols(); ++v) {
    const CrushResult& vertex = crushed[static_cast<std::size_t>(v)];
    field.wavenumbers.col(v) = frames.basis(v) * vertex.wavenumber;
    field.weights[v] = vertex.weight;
    field.status.push_back(vertex.status);
  }
  return field;
}

Transport transport(const WaveField& field, Index vertex, Index neighbour) {
  const Vector3d k0 = field.wavenumbers.col(vertex), kn = field.wavenumbers.col(neighbour);
  const Vector3d p = (field.positions.col(vertex) + field.positions.col(neighbour)) / 2;
  Transport t;
  t.sign = kn.dot(k0) < 0 ? -1 : 1;
  t.offset = t.sign * kn.dot(p - field.positions.col(neighbour)) - k0.dot(p - field.positions.col(vertex));
  return t;
}

double phase_error(const WaveField& field, Index vertex, Index neighbour) {
  return wrap_turns(target_turns(field, vertex, neighbour) - field.phases[vertex] / (2 * pi));
}

double vertex_error(const Topology& topology, const WaveField& field, Index vertex) {
  const auto neighbours = row(topology.neighbours, vertex);
  double sum = 0;
  for (const std::uint32_t n : neighbours) {
    const double d = phase_error(field, vertex, n);
    sum += set_weight(field, n) * d * d;
  }
  return neighbours.size() > 0 ? sum / static_cast<double>(neighbours.size()) : 0;
}

void descent_round(const Topology& topology, WaveField& field, double epsilon) {
  const WaveField last = field;
  for (Index v = 0; v < topology.size(); ++v) {
    const auto neighbours = row(topology.neighbours, v);
    if (status_of(last, v) != Status::set || neighbours.size() == 0) continue;
    double sum = 0;  // Σ w_n d_n, radians
    for (const std::uint32_t n : neighbours) sum += set_weight(last, n) * 2 * pi * phase_error(last, v, n);
    const double step = epsilon / (2 * pi * pi * static_cast<double>(neighbours.size())) * sum;
    field.phases[v] = wrap_radians(last.phases[v] + step);
  }
}

int onset_round(const Topology& topology, WaveField& field) {
  const WaveField last = field;
  int count = 0;
  for (Index v = 0; v < topology.size(); ++v) {
    if (status_of(last, v) != Status::fresh) continue;
    Complex sum = 0;
    bool reached = false;
    for (const std::uint32_t n : row(topology.neighbours, v)) {
      if (status_of(last, n) != Status::set) continue;
      sum += std::polar(1.0, 2 * pi * target_turns(last, v, n));
      reached = true;
    }
    if (!reached) continue;
    field.phases[v] = wrap_radians(std::arg(sum));
    field.status[static_cast<std::size_t>(v)] = Status::set;
    ++count;
  }
  return count;
}

void smoothing_round(const Topology& topology, const WaveField& field, std::vector<Complex>& z) {
  const std::vector<Complex> last = z;
  for (Index v = 0; v < topology.size(); ++v) {
    if (status_of(field, v) != Status::fresh) continue;
    Complex sum = 0;
    int count = 0;
    for (const std::uint32_t n : row(topology.neighbours, v)) {
      if (status_of(field, n) == Status::idle) continue;
      const Transport t = transport(field, v, n);
      sum += (t.sign < 0 ? std::conj(last[n]) : last[n]) * std::polar(1.0, 2 * pi * t.offset);
      ++count;
    }
    const auto own = static_cast<std::size_t>(v);
    if (count > 0) z[own] = 0.5 * last[own] + 0.5 * sum / static_cast<double>(count);
  }
}

void relax(const Topology& topology, WaveField& field, const RelaxSettings& settings) {
  if (settings.smooth) {
    for (int round = 0; round < settings.onset_rounds && onset_round(topology, field) > 0; ++round) {
    }
    std::vector<Complex> z;
    for (const double phase : field.phases) z.push_back(std::polar(1.0, phase));
    for (int round = 0; round < settings.smoothing_rounds; ++round) smoothing_round(topology, field, z);
    for (std::size_t v = 0; v < z.size(); ++v) {
      if (field.status[v] != Status::fresh) continue;
      if (std::norm(z[v]) >= 1e-24) field.phases[static_cast<Index>(v)] = wrap_radians(std::arg(z[v]));
      field.status[v] = Status::set;
    }
  }
  for (int round = 0; round < settings.descent_rounds; ++round)
    descent_round(topology, field, settings.epsilon);
}

void lead(Eigen::VectorXd& phases, std::vector<CrushState>& states, const Eigen::VectorXd& aim_phases,
          const std::vector<CrushState>& aim_states, Status which, double share) {
  for (std::size_t v = 0; v < states.size(); ++v) {
    if (states[v].status != which || aim_states[v].status != Status::set) continue;
    const auto i = static_cast<Index>(v);
    const double sign = states[v].direction.dot(aim_states[v].direction) < 0 ? -1 : 1;
    phases[i] = wrap_radians(phases[i] + share * wrap_radians(sign * aim_phases[i] - phases[i]));
    states[v].status = Status::set;
  }
}

double misfit(const Topology& topology, const WaveField& field) {
  double sum = 0;
  std::size_t count = 0;
  for (Index v = 0; v < topology.size(); ++v)
    for (const std::uint32_t n : row(topology.neighbours, v)) {
      if (!(field.weights[v] > 0) || !(field.weights[n] > 0)) continue;
      const double d = phase_error(field, v, n);
      sum += d * d;
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

double parallelism(const WaveField& field, const Vector3d& axis) {
  double sum = 0;
  std::size_t count = 0;
  for (Index v = 0; v < field.positions.cols(); ++v) {
    const Vector3d k = field.wavenumbers.col(v);
    if (!(field.weights[v] > 0) || k.isZero(0)) continue;
    sum += std::abs(k.dot(axis)) / k.norm();
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

double mean_wavelength(const Topology& topology, const WaveField& field, const Vector3d& axis) {
  double turns_times_length = 0, length_squared = 0;
  for (Index v = 0; v < topology.size(); ++v)
    for (const std::uint32_t n : row(topology.neighbours, v)) {
      if (!(field.weights[v] > 0) || !(field.weights[n] > 0)) continue;
      const Vector3d k0 = field.wavenumbers.col(v), kn = field.wavenumbers.col(n);
      const Vector3d edge = field.positions.col(n) - field.positions.col(v);
      // Half of the edge along each wave, and the difference at the midpoint: the phases differ by exactly
      // this, modulo turns.
      const double gained =
          k0.dot(edge) / 2 + transport(field, v, n).sign * kn.dot(edge) / 2 + phase_error(field, v, n);
      const double along = edge.dot(axis);
      turns_times_length += (k0.dot(axis) < 0 ? -gained : gained) * along;
      length_squared += along * along;
    }
  return length_squared / turns_times_length;
}

}  // namespace plisse::reference
