// Fields over time: what stands still stands still, what changes is on the list and smooth.
#include "wrinkle/sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Complex = std::complex<double>;
using test::Tube;
constexpr double turn = 2 * std::numbers::pi;

const Model material = test::model(1e6, 0.3, 1e-4);

std::vector<bool> no_face(const Tube& tube) {
  return std::vector<bool>(tube.forms.size(), false);
}

// a exp(iφ) of each vertex; corners must agree on it.
std::vector<Complex> complex_amplitudes(const shell::Topology& topology, const CoarseField& field) {
  std::vector<Complex> result(topology.vertex_count, 0);
  std::vector<bool> set(topology.vertex_count, false);
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = topology.faces[f][c];
      const Complex z = std::polar(field.amplitude[v], field.phase[f][c]);
      EXPECT_LT(set[v] ? std::abs(z - result[v]) : 0, 1e-9 * field.amplitude.maxCoeff() + 1e-300);
      set[v] = true;
      result[v] = z;
    }
  }
  return result;
}

// The largest change of a vertex's a exp(iφ), over the larger of the two largest amplitudes.
double largest_change(const shell::Topology& topology, const CoarseField& before, const CoarseField& now) {
  const auto a = complex_amplitudes(topology, before), b = complex_amplitudes(topology, now);
  double most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, std::abs(a[v] - b[v]));
  return most / std::max(before.amplitude.maxCoeff(), now.amplitude.maxCoeff());
}

TEST(Sequence, AStillSurfaceKeepsItsField) {
  const Tube tube(0.02);
  FieldSequence sequence(tube.topology, material, tube.ends);
  const SequenceFrame first = sequence.next(tube.forms, no_face(tube));
  ASSERT_TRUE(first.converged) << first.reason;
  EXPECT_FALSE(first.waves_before);  // the first frame begins as it is
  EXPECT_EQ(first.share, 1);
  const Field alone = tube.solve(material);
  EXPECT_NEAR(first.waves, alone.waves, 1e-9);  // rounded in the sequence alone
  EXPECT_NEAR(first.energy / alone.whole.energy, 1, 1e-9);
  for (int n = 0; n < 3; ++n) {
    const SequenceFrame next = sequence.next(tube.forms, no_face(tube));
    EXPECT_FALSE(next.waves_before);
    EXPECT_EQ(next.waves, first.waves);
    // The solver stops where its steps are a thousandth of a radian or less.
    EXPECT_LT(next.phase_step, 1e-3);
    EXPECT_LT(largest_change(tube.topology, first.field, next.field), 1e-3);
  }
}

// The free phase and the sign of each patch, found again exactly.
TEST(Sequence, AlignmentIsTheClosedForm) {
  const Tube tube(0.02);
  std::vector<bool> free = no_face(tube);
  for (std::size_t f = 0; f < free.size(); ++f) free[f] = f / 48 == 5 || f / 48 == 6;  // two patches
  const Field solved = solve_field(tube.topology, tube.forms, material, free, tube.ends);
  const CoarseField field{solved.whole.waves.amplitude, solved.phase};
  ASSERT_FALSE(field.amplitude.isZero());
  CoarseField turned = field;
  for (std::size_t f = 0; f < turned.phase.size(); ++f) {
    const bool low = f / 48 < 5;
    for (double& phase : turned.phase[f]) phase = low ? phase + 1.3 : 2.1 - phase;
  }
  EXPECT_GT(largest_change(tube.topology, field, turned), 1);
  align(tube.topology, tube.forms, field, turned);
  EXPECT_LT(largest_change(tube.topology, field, turned), 1e-12);
}

// Where both amplitudes are one, the fade is that of the complex numbers, for any difference of phase; and
// always so that the phases of a face belong together.
TEST(Sequence, CrossFadeIsThatOfComplexAmplitudes) {
  const Tube tube(0.02);
  CoarseField from, to;
  from.amplitude = to.amplitude = Eigen::VectorXd::Ones(tube.topology.vertex_count);
  for (std::size_t f = 0; f < tube.forms.size(); ++f) {
    auto &a = from.phase.emplace_back(), &b = to.phase.emplace_back();
    double low = 1e9, high = -1e9;
    for (std::size_t c = 0; c < 3; ++c) low = std::min<double>(low, tube.topology.faces[f][c] % 24);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto column = static_cast<double>(tube.topology.faces[f][c] % 24);
      const double unrolled = column - low > 12 ? column - 24 : column;  // across the cut
      a[c] = turn * 9 * unrolled / 24;
      b[c] = turn * 11 * unrolled / 24 + 0.4;
      high = std::max(high, std::abs(b[c] - b[0]));
    }
    EXPECT_LT(high, 6);
  }
  const auto first = complex_amplitudes(tube.topology, from), last = complex_amplitudes(tube.topology, to);
  for (const double share : {0.0, 0.2, 0.45, 0.55, 0.9, 1.0}) {
    const CoarseField mixed = cross_faded(tube.topology.faces, from, to, share);
    const auto z = complex_amplitudes(tube.topology, mixed);
    for (std::size_t v = 0; v < z.size(); ++v)
      EXPECT_LT(std::abs(z[v] - (1 - share) * first[v] - share * last[v]), 1e-12) << share;
    const CoarseField& main = share < 0.5 ? from : to;
    for (std::size_t f = 0; f < mixed.phase.size(); ++f) {
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_LT(std::abs(mixed.phase[f][c] - main.phase[f][c]), turn / 4 + 1e-12);
    }
  }
}

// Where one field has no amplitude yet, its corners' phases do not agree, and those of the other count: no
// tear.
TEST(Sequence, CrossFadesDoNotTearWhereWavesBegin) {
  const Tube tube(0.02);
  const auto count = static_cast<Eigen::Index>(tube.topology.vertex_count);
  const auto calm = [](std::uint32_t v) { return v / 24 < 5; };  // the lower rows
  CoarseField from{Eigen::VectorXd::Constant(count, 1), {}}, to = from;
  for (std::uint32_t v = 0; v < tube.topology.vertex_count; ++v)
    if (calm(v)) from.amplitude[v] = 0;
  for (std::size_t f = 0; f < tube.topology.faces.size(); ++f) {
    auto &a = from.phase.emplace_back(), &b = to.phase.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = tube.topology.faces[f][c];
      a[c] = calm(v) ? static_cast<double>(3 * f + c) : turn * 9 * (v % 24) / 24;
      b[c] = turn * 11 * (v % 24) / 24;
    }
  }
  for (const double share : {0.2, 0.45, 0.55, 0.9}) {
    // complex_amplitudes looks whether corners agree.
    const auto z = complex_amplitudes(tube.topology, cross_faded(tube.topology.faces, from, to, share));
    EXPECT_NEAR(std::abs(z[30]), share, 1e-12);  // a vertex of the second row
    // And the other way: waves that end.
    const auto back = complex_amplitudes(tube.topology, cross_faded(tube.topology.faces, to, from, share));
    EXPECT_NEAR(std::abs(back[30]), 1 - share, 1e-12);
  }
}

// More and more tension makes more and more waves.
TEST(Sequence, ChangesOfPeriodsAreFewListedAndSmoothSlow) {
  constexpr int frames = 27;
  const auto tube_at = [](int n) { return Tube(0.02, 0.3, 0.02 * std::pow(1.08, n)); };
  const auto run = [&](int fade) {
    const Tube first = tube_at(0);
    SequenceOptions options;
    options.fade = fade;
    FieldSequence sequence(first.topology, material, first.ends, options);
    std::vector<SequenceFrame> result;
    for (int n = 0; n < frames; ++n) result.push_back(sequence.next(tube_at(n).forms, no_face(first)));
    return result;
  };
  const Tube tube = tube_at(0);
  const auto faded = run(6), sudden = run(0);
  int changes = 0, since = frames;
  double smooth = 0, jump = 0, settled = 0;
  for (int n = 0; n < frames; ++n) {
    const SequenceFrame& frame = faded[static_cast<std::size_t>(n)];
    ASSERT_TRUE(frame.converged) << n << ": " << frame.reason;
    const Field alone = tube_at(n).solve(material);
    const double real = std::abs(alone.real.waves.period[0]) / turn;
    if (frame.waves_before) {
      ++changes;
      EXPECT_GE(since, 6) << n;  // never two fades at once
      since = 0;
      // The old whole number was three quarters off or more, by energy, and the new one is the nearest.
      EXPECT_GT(std::abs(*frame.waves_before - real), 0.7) << n;
      EXPECT_LT(std::abs(frame.waves - real), 0.5 + 0.05) << n;
    }
    if (n > 0) {
      const SequenceFrame& before = faded[static_cast<std::size_t>(n - 1)];
      EXPECT_EQ(frame.waves, frame.waves_before ? frame.waves : before.waves) << n;  // none but those listed
      EXPECT_EQ(frame.waves_before ? *frame.waves_before : before.waves, before.waves) << n;
      const double change = largest_change(tube.topology, before.field, frame.field);
      smooth = std::max(smooth, change);
      if (since > 6) settled = std::max(settled, change);
      jump = std::max(jump, largest_change(tube.topology, sudden[static_cast<std::size_t>(n - 1)].field,
                                           sudden[static_cast<std::size_t>(n)].field));
    }
    EXPECT_EQ(frame.share < 1, since < 6) << n;
    ++since;
  }
  EXPECT_GE(changes, 2);
  // The steepest step of the fade is .21 of what two waves in opposite phase differ by, twice their height;
  // at once it is nearly all of it.
  EXPECT_LT(smooth, 0.6);
  EXPECT_GT(jump, 1.2);
  EXPECT_LT(settled, 0.1);  // tension rises by 8 % a frame, amplitudes fall by 2 %
}

// Two patches grow together: what was flat between them gets waves that belong to both.
TEST(Sequence, FacesThatBecomeCompressedFollowTheirNeighbours) {
  const Tube tube(0.02);
  std::vector<bool> free = no_face(tube);
  for (std::size_t f = 0; f < free.size(); ++f) free[f] = f / 48 == 5 || f / 48 == 6;
  FieldSequence sequence(tube.topology, material, tube.ends);
  const SequenceFrame apart = sequence.next(tube.forms, free);
  SequenceFrame frame = sequence.next(tube.forms, no_face(tube));
  ASSERT_TRUE(frame.converged) << frame.reason;
  complex_amplitudes(tube.topology, frame.field);  // corners agree
  EXPECT_EQ(frame.waves, std::round(frame.waves));
  EXPECT_EQ(apart.field.amplitude.segment(24 * 6, 24).maxCoeff(), 0);
  EXPECT_GT(frame.field.amplitude.segment(24 * 6, 24).minCoeff(), 0.5 * frame.field.amplitude.maxCoeff());
}

TEST(Sequence, WavesRiseFromNothingAndGo) {
  const Tube tense(-0.2), tube(0.02);
  FieldSequence sequence(tube.topology, material, tube.ends);
  EXPECT_TRUE(sequence.next(tense.forms, no_face(tube)).field.amplitude.isZero());
  SequenceFrame frame = sequence.next(tube.forms, no_face(tube));
  ASSERT_TRUE(frame.waves_before);
  EXPECT_EQ(*frame.waves_before, 0);
  double before = 0;
  for (int n = 0; n < 7; ++n) {
    const double a = frame.field.amplitude.maxCoeff();
    EXPECT_GT(a, before * (1 + 1e-9) - (n == 6 ? 1 : 0)) << n;
    before = a;
    frame = sequence.next(tube.forms, no_face(tube));
  }
  EXPECT_EQ(frame.share, 1);
  EXPECT_NEAR(before / tube.solve(material).whole.waves.amplitude.maxCoeff(), 1, 1e-3);
  frame = sequence.next(tense.forms, no_face(tube));
  EXPECT_TRUE(frame.field.amplitude.isZero());
  EXPECT_TRUE(frame.one_form.allFinite());
  // All faces free of wrinkles.
  frame = sequence.next(tense.forms, std::vector<bool>(tube.forms.size(), true));
  EXPECT_TRUE(frame.field.amplitude.isZero());
}

}  // namespace
}  // namespace plisse::wrinkle
