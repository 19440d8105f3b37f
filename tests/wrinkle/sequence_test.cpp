// Fields over time: nothing tears, a frame depends on its keys alone, energies stay near those of frames
// solved alone.
#include "wrinkle/sequence.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "wrinkle/meshes.h"
#include "wrinkle/wrinkle_free.h"

namespace plisse::wrinkle {
namespace {

using Complex = std::complex<double>;
using test::Grid;
using test::Tube;
constexpr double turn = 2 * std::numbers::pi;

const Model material = test::model(1e6, 0.3, 1e-4);

std::vector<bool> no_face(const Tube& tube) {
  return std::vector<bool>(tube.forms.size(), false);
}

// A sheet of .6 × .3 m under tension along y; a stripe of compression along x wanders over it, grows and
// goes, with faces free of wrinkles outside.
struct Sheet {
  Grid grid{0.6, 0.3, 24, 12};
  shell::Topology topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));

  ClipFrame at(double time) const {  // 0 … 1
    const auto strain = [&](const Eigen::Vector3d& x) {
      const double from_middle = (x.x() - 0.15 - 0.3 * time) / 0.15;
      const double most = 0.04 * std::sin(std::numbers::pi * std::clamp(time, 0.0, 1.0));
      return test::diagonal(most * std::exp(-from_middle * from_middle) * -1 + 0.004, 0.05);
    };
    ClipFrame frame{test::prescribed(grid, strain, test::no_form), {}};
    frame.wrinkle_free = wrinkle_free_faces(frame.forms, topology, WrinkleFreeRule::paper);
    return frame;
  }
  Clip clip(int frames, bool reversed = false) const {
    return {topology, material, {}, frames, [=, this](int n) {
              const double time = n / (frames - 1.0);
              // A little slower at first: no frame is like another one of the way back.
              return at(std::pow(reversed ? 1 - time : time, 1.1));
            }};
  }
};

Clip tube_clip(int frames, const std::function<Tube(int)>& at) {
  const Tube first = at(0);
  return {first.topology, material, first.ends, frames, [=](int n) {
            return ClipFrame{at(n).forms, no_face(first)};
          }};
}

// a exp(iφ) of each vertex; corners must agree on it.
std::vector<Complex> complex_amplitudes(const shell::Topology& topology, const CoarseField& field) {
  std::vector<Complex> result(topology.vertex_count, 0);
  std::vector<double> phase(topology.vertex_count, 0);
  std::vector<bool> set(topology.vertex_count, false);
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = topology.faces[f][c];
      if (!(field.amplitude[v] > 0)) continue;
      EXPECT_LT(set[v] ? std::abs(std::remainder(field.phase[f][c] - phase[v], turn)) : 0, 1e-6) << v;
      set[v] = true;
      phase[v] = field.phase[f][c];
      result[v] = std::polar(field.amplitude[v], phase[v]);
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

double excess(const Clip& clip, int n, const CoarseField& field) {
  const ClipFrame frame = clip.frame(n);
  double sum = 0;
  for (std::size_t f = 0; f < frame.forms.size(); ++f) {
    if (frame.wrinkle_free[f]) continue;
    LocalVector x;
    for (int c = 0; c < 3; ++c) x[c] = field.amplitude[clip.topology.faces[f][static_cast<std::size_t>(c)]];
    const auto& phase = field.phase[f];
    x.tail<2>() = frame.forms[f].rest.gradients * Eigen::Vector3d(phase[0], phase[1], phase[2]);
    sum += FaceEnergy(frame.forms[f], clip.model).value(x);
  }
  return sum;
}

double excess_alone(const Clip& clip, int n) {
  const ClipFrame frame = clip.frame(n);
  const Field field = solve_field(clip.topology, frame.forms, clip.model, frame.wrinkle_free, clip.clamped);
  return excess(clip, n, {field.whole.waves.amplitude, field.phase});
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

// Waves come, move with the stripe through free edges, and go; in both qualities no corner ever disagrees,
// and the energy stays near that of each frame alone.
TEST(Sequence, NothingTearsAndEnergiesStayLow) {
  constexpr int frames = 33;
  const Sheet sheet;
  for (const Quality quality : {Quality::final, Quality::draft}) {
    SequenceOptions options;
    options.quality = quality;
    const Clip clip = sheet.clip(frames);
    const FieldSequence sequence(clip, options);
    std::vector<double> alone;
    for (int n = 0; n < frames; ++n) alone.push_back(excess_alone(clip, n));
    const double most = *std::max_element(alone.begin(), alone.end());
    int waved = 0, between = 0, low = 0;
    for (int n = 0; n < frames; ++n) {
      const SequenceFrame frame = sequence.solve(n);
      EXPECT_TRUE(frame.converged) << n << ": " << frame.reason;
      complex_amplitudes(sheet.topology, frame.field);  // corners agree
      const std::vector<bool> free = clip.frame(n).wrinkle_free;
      for (std::size_t f = 0; f < free.size(); ++f)
        for (const std::uint32_t v : sheet.topology.faces[f])
          EXPECT_EQ(free[f] ? frame.field.amplitude[v] : 0, 0) << n;
      waved += frame.field.amplitude.maxCoeff() > 0;
      between += frame.kind == FrameKind::between;
      // A span goes on up to 1.5; frames between two such keys have some more. Draft does not know where the
      // stripe's edge lies between keys.
      const double over = excess(clip, n, frame.field) - 1e-3 * most;
      if (quality == Quality::draft) continue;
      EXPECT_LE(over, 2 * alone[static_cast<std::size_t>(n)]) << n;
      low += over <= 1.1 * alone[static_cast<std::size_t>(n)];
    }
    EXPECT_GT(waved, frames / 2);
    EXPECT_GT(between, 3);
    EXPECT_GT(low, quality == Quality::final ? frames - frames / 4 : -1);  // but for coming and going
    EXPECT_EQ(sequence.spans(), 1U);
  }
}

// The same bytes, whichever frames are asked for, in whichever order and by how many threads.
TEST(Sequence, AFrameDependsOnTheClipAlone) {
  constexpr int frames = 17;
  const Sheet sheet;
  const FieldSequence whole(sheet.clip(frames));
  std::vector<SequenceFrame> all;
  for (int n = 0; n < frames; ++n) all.push_back(whole.solve(n));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const FieldSequence again(sheet.clip(frames));
  for (const int n : {16, 3, 9, 8}) {
    const SequenceFrame frame = again.solve(n);
    EXPECT_EQ(frame.field.amplitude, all[static_cast<std::size_t>(n)].field.amplitude) << n;
    EXPECT_EQ(frame.field.phase, all[static_cast<std::size_t>(n)].field.phase) << n;
  }
}

TEST(Sequence, AReversedClipHasTheSameFields) {
  constexpr int frames = 17;
  const Sheet sheet;
  const FieldSequence forth(sheet.clip(frames)), back(sheet.clip(frames, true));
  for (int n = 0; n < frames; ++n) {
    const SequenceFrame frame = forth.solve(n);
    CoarseField other = back.solve(frames - 1 - n).field;
    if (frame.field.amplitude.isZero()) {
      EXPECT_TRUE(other.amplitude.isZero());
      continue;
    }
    align(sheet.topology, sheet.clip(frames).frame(n).forms, frame.field, other);
    // Times of both clips differ by rounding.
    EXPECT_LT(largest_change(sheet.topology, frame.field, other), 1e-5) << n;
  }
}

// What does not move is solved once.
TEST(Sequence, AStillSurfaceKeepsItsField) {
  const Tube tube(0.02);
  const FieldSequence sequence(tube_clip(30, [&](int) { return tube; }));
  const SequenceFrame first = sequence.solve(0);
  ASSERT_TRUE(first.converged) << first.reason;
  EXPECT_EQ(first.kind, FrameKind::anchor);
  EXPECT_EQ(first.change, 0);
  const Field alone = tube.solve(material);
  EXPECT_NEAR(first.waves, alone.waves, 1e-9);  // rounded in the sequence alone
  EXPECT_NEAR(first.energy / alone.whole.energy, 1, 1e-6);
  for (const int n : {1, 7, 12, 29}) {
    const SequenceFrame next = sequence.solve(n);
    EXPECT_EQ(next.kind, FrameKind::still);
    EXPECT_EQ(next.iterations, 0);
    EXPECT_EQ(next.field.amplitude, first.field.amplitude);
    EXPECT_EQ(next.field.phase, first.field.phase);
  }
}

// Two plane waves of slightly different direction and height: half way there is the plane wave between. Whole
// turns that corners differ by, and a vertex without amplitude in one of them, change nothing.
TEST(Sequence, BetweenPlaneWavesIsThePlaneWaveBetween) {
  const Sheet sheet;
  const auto wave = [&](double kx, double ky, double phase, double height, int seed) {
    CoarseField field{Eigen::VectorXd::Constant(sheet.grid.rest.cols(), height), {}};
    for (std::size_t f = 0; f < sheet.topology.faces.size(); ++f) {
      auto& corners = field.phase.emplace_back();
      const double turns = turn * static_cast<double>((7 * f + static_cast<std::size_t>(seed)) % 5);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto x = sheet.grid.rest.col(sheet.topology.faces[f][c]);
        corners[c] = kx * x.x() + ky * x.y() + phase + turns;
      }
    }
    return field;
  };
  CoarseField from = wave(80, 0, 0.3, 1, 0), to = wave(84, 9, 1.1, 3, 2);
  to.amplitude[100] = from.amplitude[200] = 0;  // their corners need not agree
  for (std::size_t f = 0; f < sheet.topology.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (sheet.topology.faces[f][c] == 100) to.phase[f][c] += 0.5 * static_cast<double>(f % 3);
      if (sheet.topology.faces[f][c] == 200) from.phase[f][c] += 0.5 * static_cast<double>(f % 3);
    }
  }
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const CoarseField mixed = interpolated(sheet.topology, from, to, share);
    const auto z = complex_amplitudes(sheet.topology, mixed);
    const auto expected = complex_amplitudes(
        sheet.topology, wave(80 + 4 * share, 9 * share, 0.3 + 0.8 * share, 1 + 2 * share, 1));
    for (std::size_t v = 0; v < z.size(); ++v) {
      // The phases at the origin, vertex 0, differ by .8, by less than a turn everywhere.
      EXPECT_LT(v == 100 || v == 200 ? 0 : std::abs(z[v] - expected[v]), 1e-9) << v << " " << share;
    }
    EXPECT_NEAR(std::abs(z[100]), 1 - share, 1e-12);
    EXPECT_NEAR(std::abs(z[200]), 3 * share, 1e-12);
    // Gradients are those of the wave between, too: whole turns are right in every face.
    for (std::size_t f = 0; f < mixed.phase.size(); ++f) {
      const shell::Face& t = sheet.topology.faces[f];
      const auto lone = [](std::uint32_t v) { return v == 100 || v == 200; };
      const Eigen::Vector3d side = sheet.grid.rest.col(t[1]) - sheet.grid.rest.col(t[0]);
      // Beside those two, the difference that goes on from a neighbour is off by what its corners are.
      EXPECT_NEAR(mixed.phase[f][1] - mixed.phase[f][0], (80 + 4 * share) * side.x() + 9 * share * side.y(),
                  lone(t[0]) || lone(t[1]) ? 1 : 1e-9);
    }
  }
}

// With a tether the sum of both is stationary: by finite differences along directions of all unknowns. The
// tether is of the size of the energy that waves take up, and holds phases alone.
TEST(Sequence, TetheredSolvesAreStationary) {
  const Tube tube(0.02);
  const Problem problem(tube.topology, tube.forms, material, no_face(tube), tube.ends);
  Waves start = with_whole_periods(problem, initial_waves(problem));
  for (Eigen::Index i = 0; i < start.phase.size(); ++i)
    start.phase[i] += 0.2 * std::sin(0.8 * static_cast<double>(i));  // nowhere stationary
  const Eigen::VectorXd to = problem.pack(start);
  const Eigen::VectorXd taken_up = problem.taken_up(to);
  const auto phases = problem.period_begin() - problem.phase_begin();
  EXPECT_EQ(taken_up.head(problem.amplitude_count()).cwiseAbs().sum(), 0);
  EXPECT_EQ(taken_up.tail(problem.size() - problem.period_begin()).cwiseAbs().sum(), 0);
  const double gained = problem.energy(Eigen::VectorXd::Zero(problem.size())) - problem.energy(to);
  // M's stress is twice the sum of what the base has along the waves, what they take up and what they ought
  // to, where the energy is half the first.
  EXPECT_GT(taken_up.segment(problem.phase_begin(), phases).sum(), 4 * gained);
  EXPECT_LT(taken_up.segment(problem.phase_begin(), phases).sum(), 16 * gained);

  const Tether tether{to, 0.3 * taken_up};
  SolveOptions options;
  options.fixed_periods = true;
  const Solution solution = solve(problem, start, options, tether);
  ASSERT_TRUE(solution.converged) << solution.reason;
  const Eigen::VectorXd x = problem.pack(solution.waves);
  EXPECT_NEAR(solution.energy / (problem.energy(x) + problem.relaxed_energy()), 1, 1e-12);  // without it
  const auto tied = [&](const Eigen::VectorXd& at) {
    return 0.5 * tether.stiffness.dot((at - tether.to).cwiseAbs2());
  };
  double of_energy = 0;
  for (int seed = 1; seed <= 8; ++seed) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(problem.size());
    for (Eigen::Index i = 0; i < problem.period_begin(); ++i)
      if (i >= problem.amplitude_count() || x[i] > 1e-3)
        direction[i] = std::sin(static_cast<double>(seed) * (static_cast<double>(i) + 0.7));
    constexpr double h = 1e-5;
    const Eigen::VectorXd up = x + h * direction, down = x - h * direction;
    const double energy = (problem.energy(up) - problem.energy(down)) / (2 * h),
                 both = energy + (tied(up) - tied(down)) / (2 * h);
    of_energy = std::max(of_energy, std::abs(energy));
    // 300 unknowns of either sign, each with less than 1e-6 of the energy.
    EXPECT_LT(std::abs(both), 1e-4 * problem.energy(x)) << seed;
  }
  EXPECT_GT(of_energy, 1e-3 * problem.energy(x));  // E alone is not
}

// Tension grows 20-fold, so that a tube's whole number of waves ought to double: the number changes seldom,
// only where it costs much, both fields are shown meanwhile, and nothing tears.
TEST(Sequence, TubesChangeTheirNumberSeldom) {
  constexpr int frames = 49;
  const auto tube_at = [](int n) { return Tube(0.02, 0.3, 0.01 * std::pow(1.09, n)); };
  const Clip clip = tube_clip(frames, tube_at);
  const FieldSequence sequence(clip);
  int changes = 0;
  double smooth = 0, settled = 0;
  std::optional<SequenceFrame> before;
  for (int n = 0; n < frames; ++n) {
    SequenceFrame frame = sequence.solve(n);
    ASSERT_TRUE(frame.converged) << n << ": " << frame.reason;
    EXPECT_EQ(frame.waves, std::round(frame.waves)) << n;
    EXPECT_LT(frame.excess.value_or(0), 1.5 + 0.01) << n;
    if (before) {
      EXPECT_EQ(frame.waves_before.value_or(frame.waves), before->waves) << n;
      changes += frame.waves_before.has_value();
      const double change = largest_change(clip.topology, before->field, frame.field);
      (frame.share < 1 || before->share < 1 ? smooth : settled) =
          std::max(frame.share < 1 || before->share < 1 ? smooth : settled, change);
    }
    before = std::move(frame);
  }
  EXPECT_GE(changes, 1);
  EXPECT_LE(changes, 2);
  EXPECT_EQ(sequence.spans(), static_cast<std::size_t>(changes + 1));
  // Unlike waves differ by up to twice their height; the steepest step of the fade is .21 of that.
  EXPECT_LT(smooth, 0.42);
  EXPECT_LT(settled, 0.05);  // tension rises by 9 % a frame, amplitudes fall by half of a fourth of that
  SequenceOptions at_once;
  at_once.fade = 0;
  const FieldSequence sudden(clip, at_once);
  double jump = 0;
  for (int n = 1; n < frames; ++n) {
    EXPECT_EQ(sudden.solve(n).share, 1);
    jump = std::max(jump, largest_change(clip.topology, sudden.solve(n - 1).field, sudden.solve(n).field));
  }
  EXPECT_GT(jump, 1.5 * smooth);
}

// Two patches grow together: what was flat between them gets waves that belong to both.
TEST(Sequence, FacesThatBecomeCompressedFollowTheirNeighbours) {
  const Tube tube(0.02);
  std::vector<bool> free = no_face(tube);
  for (std::size_t f = 0; f < free.size(); ++f) free[f] = f / 48 == 5 || f / 48 == 6;
  const Clip clip{tube.topology, material, tube.ends, 2, [&](int n) {
                    return ClipFrame{Tube(0.02 + 0.004 * n).forms, n == 0 ? no_face(tube) : free};
                  }};
  // The most developed frame is the second, with two patches, or the first, with one: carried either way.
  const FieldSequence sequence(clip);
  const SequenceFrame together = sequence.solve(0), apart = sequence.solve(1);
  complex_amplitudes(tube.topology, together.field);  // corners agree
  EXPECT_EQ(apart.field.amplitude.segment(24 * 6, 24).maxCoeff(), 0);
  EXPECT_GT(together.field.amplitude.segment(24 * 6, 24).minCoeff(),
            0.5 * together.field.amplitude.maxCoeff());
}

TEST(Sequence, WavesRiseFromNothingAndGo) {
  const Tube tense(-0.2), tube(0.02);
  const auto tube_at = [&](int n) { return n == 0 || n == 9 ? tense : tube; };
  Clip clip = tube_clip(11, tube_at);
  const auto frames = clip.frame;
  clip.frame = [=, &tube](int n) {
    ClipFrame frame = frames(n);
    if (n == 10) frame.wrinkle_free.assign(tube.forms.size(), true);
    return frame;
  };
  const FieldSequence sequence(clip);
  for (const int n : {0, 9, 10}) {
    const SequenceFrame frame = sequence.solve(n);
    EXPECT_TRUE(frame.field.amplitude.isZero()) << n;
    EXPECT_TRUE(frame.one_form.allFinite()) << n;
  }
  for (const int n : {1, 5, 8})
    EXPECT_NEAR(
        sequence.solve(n).field.amplitude.maxCoeff() / tube.solve(material).whole.waves.amplitude.maxCoeff(),
        1, 1e-2)
        << n;
}

}  // namespace
}  // namespace plisse::wrinkle
