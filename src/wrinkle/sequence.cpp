#include "wrinkle/sequence.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>

#include "base/clock.h"
#include "base/interrupt.h"
#include "wrinkle/start.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;

// From key to key: δ, and frames.
constexpr double key_change = 0.2;
constexpr int key_frames = 12;
// δ is over the frame's own strain, or over this share of the clip's largest: a calm frame is no key only
// because its little strain is all new.
constexpr double calm = 0.1;
// A base whose forms change by less, relative to their root mean square, is the same: fields change about as
// much, and nobody sees a ten-thousandth of a wave.
constexpr double same = 1e-4;

// The tether's stiffness: of the energy that waves take up. The first is taken with which the energy is low
// enough: the more, the smoother in time.
constexpr std::array<double, 6> tethers{0.03, 0.0075, 0.002, 0.0005, 0.0001, 0};
// The first to try beside a frame that needed this one.
std::size_t stiffer(std::size_t tether) {
  return tether > 0 ? tether - 1 : 0;
}

// Rule of energy: of a key and the frames beside it not more than so many times that of the frame solved
// alone, above the relaxed one, and this share of the clip's largest (density of waves between .8 and 1.25).
// A span goes on beyond that, up to `worst`, since a change costs more: for some frames unlike fields are
// shown at once.
constexpr double most_excess = 1.08, worst = 1.5, most_share = 1e-3;
// Of the clip's largest energy: what rounding makes of it.
constexpr double nothing = 1e-14;

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

bool flat(const CoarseField& field) {
  return field.amplitude.size() == 0 || !(field.amplitude.maxCoeff() > 0);
}

CoarseField flat_field(const shell::Topology& topology) {
  return {Eigen::VectorXd::Zero(static_cast<Index>(topology.vertex_count)),
          std::vector<std::array<double, 3>>(topology.faces.size(), {0, 0, 0})};
}

Eigen::VectorXd one_form_of(const shell::Topology& topology, const CoarseField& field) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Index>(topology.edges.size()));
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (!has_waves(field, topology.faces[f])) continue;
    for (std::size_t side = 0; side < 3; ++side)
      result[side_edge(topology, f, side)] =
          side_sign(topology, f, side) * (field.phase[f][(side + 1) % 3] - field.phase[f][side]);
  }
  return result;
}

// ∫ s₀ − s_crit of the faces' own waves, where positive, m².
double developed(const Problem& problem) {
  double sum = 0;
  for (std::size_t f = 0; f < problem.live().size(); ++f) {
    if (!problem.live()[f]) continue;
    const LocalWaves& own = problem.own_waves()[f];
    const double above = own.compression - own.critical(problem.model(), own.gradient.norm());
    if (above > 0) sum += problem.forms()[f].rest.area * above;
  }
  return sum;
}

// Less amplitude everywhere, where that has less energy: c₀ + c₂t² + c₄t⁴ at t times it.
void lower(const Problem& problem, Waves& waves) {
  const auto energy = [&](double t) {
    return problem.energy(problem.pack({t * waves.amplitude, waves.phase, waves.period}));
  };
  const double none = energy(0), half = energy(0.5) - none, whole = energy(1) - none;
  const double c4 = (whole - 4 * half) * 4 / 3, c2 = whole - c4;
  constexpr double least = 0.1;  // where c₂ says none at all, which single vertices can be the reason of
  const double squared = c4 > 0 ? std::max(-c2 / (2 * c4), least * least) : 1;
  if (squared < 1) waves.amplitude *= std::sqrt(squared);
}

// Root mean squares over the faces.
struct Size {
  double strain = 0, second_form = 0;
};
Size size_of(const std::vector<FaceForms>& a, const std::vector<FaceForms>* b = nullptr) {
  Size sum;
  double area = 0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    const double weight = a[f].rest.area;
    area += weight;
    sum.strain += weight * (b ? a[f].strain - (*b)[f].strain : a[f].strain).squaredNorm();
    sum.second_form += weight * (b ? a[f].second_form - (*b)[f].second_form : a[f].second_form).squaredNorm();
  }
  if (area == 0) return {};
  return {std::sqrt(sum.strain / area), std::sqrt(sum.second_form / area)};
}

}  // namespace

FieldSequence::FieldSequence(Clip clip, const SequenceOptions& options,
                             const std::function<void(int, int)>& progress)
    : clip_(std::move(clip)), options_(options) {
  measure();
  place_keys();
  solve_alone(progress);
  if (interrupted()) return;
  find_spans();
  find_changes();
}

void FieldSequence::measure() {
  const auto count = static_cast<std::size_t>(clip_.frames);
  developed_.resize(count);
  change_.resize(count, 0);
  moved_.resize(count, 0);
  std::vector<Size> sizes(count), steps(count);
  std::vector<char> other_faces(count, 0);
  constexpr std::size_t block = 32;
  std::vector<ClipFrame> frames(block + 1);  // the last of the block before comes first
  for (std::size_t begin = 0; begin < count && !interrupted(); begin += block) {
    const std::size_t in_block = std::min(block, count - begin);
    tbb::parallel_for(std::size_t{0}, in_block, [&](std::size_t i) {
      ClipFrame& frame = frames[i + 1] = clip_.frame(static_cast<int>(begin + i));
      developed_[begin + i] =
          developed(Problem(clip_.topology, frame.forms, clip_.model, frame.wrinkle_free, clip_.clamped));
      sizes[begin + i] = size_of(frame.forms);
    });
    for (std::size_t i = 0; i < in_block; ++i) {
      if (begin + i == 0) continue;
      steps[begin + i] = size_of(frames[i + 1].forms, &frames[i].forms);
      other_faces[begin + i] = frames[i + 1].wrinkle_free != frames[i].wrinkle_free;
    }
    frames[0] = std::move(frames[in_block]);
  }
  Size most;
  for (const Size& size : sizes) {
    most.strain = std::max(most.strain, size.strain);
    most.second_form = std::max(most.second_form, size.second_form);
  }
  double drift = 0, bending = 0;  // since the last frame that moved, or a slow clip would never move
  for (std::size_t n = 1; n < count; ++n) {
    const double strain = std::max({sizes[n - 1].strain, sizes[n].strain, calm * most.strain});
    change_[n] = strain > 0 ? steps[n].strain / strain : 0;
    const double bent = calm * most.second_form;
    drift += change_[n];
    bending += steps[n].second_form;
    const bool moves = drift > same || bending > same * bent || other_faces[n];
    if (moves) drift = bending = 0;
    moved_[n] = moved_[n - 1] + moves;
  }
  way_.resize(count, 0);
  std::partial_sum(change_.begin(), change_.end(), way_.begin());
}

// Outward from the most developed frame of all, so that a reversed clip has the same keys.
void FieldSequence::place_keys() {
  const int top =
      static_cast<int>(std::max_element(developed_.begin(), developed_.end()) - developed_.begin());
  const auto next = [&](int from, int step) {
    const int end = step > 0 ? clip_.frames - 1 : 0;
    int n = from + step;
    while (n != end && std::abs(n + step - from) <= key_frames &&
           std::abs(way_[static_cast<std::size_t>(n + step)] - way_[static_cast<std::size_t>(from)]) <=
               key_change)
      n += step;
    return n;
  };
  key_frames_ = {top};
  for (int n = top; n > 0;) key_frames_.push_back(n = next(n, -1));
  std::reverse(key_frames_.begin(), key_frames_.end());
  for (int n = top; n < clip_.frames - 1;) key_frames_.push_back(n = next(n, 1));
}

bool FieldSequence::still(int a, int b) const {
  return moved_[static_cast<std::size_t>(a)] == moved_[static_cast<std::size_t>(b)];
}

FieldSequence::Alone FieldSequence::solved_alone(int frame, const FieldOptions& options) const {
  const ClipFrame forms = clip_.frame(frame);
  const Problem problem(clip_.topology, forms.forms, clip_.model, forms.wrinkle_free, clip_.clamped);
  if (!(developed_[static_cast<std::size_t>(frame)] > 0))
    return {flat_field(clip_.topology), problem.energy(Eigen::VectorXd::Zero(problem.size())), 0};
  const Field field =
      solve_field(clip_.topology, forms.forms, clip_.model, forms.wrinkle_free, clip_.clamped, options);
  return {{field.whole.waves.amplitude, field.phase},
          field.whole.energy - problem.relaxed_energy(),
          field.iterations};
}

void FieldSequence::solve_alone(const std::function<void(int, int)>& progress) {
  alone_.resize(key_frames_.size());
  FieldOptions options = options_.field;
  // What is compared needs no more.
  options.solve.kkt = std::max(options.solve.kkt, 1e-3);
  options.solve.energy = std::max(options.solve.energy, 1e-4);
  int done = 0, of = 1;
  for (std::size_t k = 1; k < key_frames_.size(); ++k) of += !still(key_frames_[k - 1], key_frames_[k]);
  std::mutex mutex;
  tbb::parallel_for(std::size_t{0}, alone_.size(), [&](std::size_t k) {
    if (interrupted()) return;
    const int frame = key_frames_[k];
    if (k > 0 && still(key_frames_[k - 1], frame)) return;  // below
    alone_[k] = solved_alone(frame, options);
    const std::lock_guard lock(mutex);
    if (progress) progress(++done, of);
  });
  for (std::size_t k = 1; k < alone_.size(); ++k)
    if (still(key_frames_[k - 1], key_frames_[k])) alone_[k] = alone_[k - 1];
  for (const Alone& alone : alone_) most_ = std::max(most_, alone.excess);
}

double FieldSequence::limit(double alone, double times) const {
  return times * alone + most_share * most_;
}

FieldSequence::Key FieldSequence::nearest(const ClipFrame& frame, const CoarseField& near, double alone,
                                          std::size_t stiffest) const {
  Key key;
  const Problem problem(clip_.topology, frame.forms, clip_.model, frame.wrinkle_free, clip_.clamped);
  key.energy = problem.relaxed_energy();
  key.reason = "stationary";
  key.field = flat_field(clip_.topology);
  if (problem.size() == 0 || flat(near)) {
    if (problem.size() > 0) key.excess = problem.energy(Eigen::VectorXd::Zero(problem.size()));
    key.energy += key.excess;
    return key;
  }
  SolveOptions options = options_.field.solve;
  options.fixed_periods = true;
  options.trust = 1e-3;
  options.kkt = std::max(options.kkt, 1e-3);
  options.energy = std::max(options.energy, 1e-5);
  // What is little beside the clip's energy need not be exact for itself.
  if (alone < most_share * most_) {
    const double little = alone > 0 ? std::min(most_share * most_ / alone, 1e3) : 1e3;
    options.kkt *= little;
    options.energy *= little;
  }
  Solution solution;
  solution.waves = carried(problem, near);
  const Eigen::VectorXd to = problem.pack(solution.waves), stiffness = problem.taken_up(to);
  const double most = limit(alone, most_excess);
  for (key.tether = stiffest; key.tether < tethers.size(); ++key.tether) {
    const Tether tether{to, tethers[key.tether] * stiffness, nothing * most_};
    // Where the next softer tether is needed in any case there is no use in the end of this search.
    if (tethers[key.tether] > 0) options.target = problem.relaxed_energy() + most;
    Waves start = std::move(solution.waves);
    start.amplitude = seeded(problem, start);
    lower(problem, start);
    solution = wrinkle::solve(problem, start, options, tether);
    key.iterations += solution.iterations;
    key.excess = solution.energy - problem.relaxed_energy();
    if (key.excess <= most || tethers[key.tether] == 0) break;
    options.target = std::numeric_limits<double>::infinity();
  }
  key.energy = solution.energy;
  key.converged = solution.converged;
  key.reason = solution.reason;
  key.field = {solution.waves.amplitude, corner_phases(problem, solution.waves)};
  const WaveCount count = count_waves(clip_.topology, problem.forms(), problem.live(),
                                      solution.waves.amplitude, problem.one_form(solution.waves));
  key.waves = count.round ? std::round(count.waves) : count.waves;  // whole up to rounding
  align(clip_.topology, frame.forms, near, key.field);
  return key;
}

FieldSequence::Key FieldSequence::next_key(int key, int from, const Key& before) const {
  const int frame = key_frames_[static_cast<std::size_t>(key)];
  if (still(frame, key_frames_[static_cast<std::size_t>(from)])) {
    Key same_field = before;
    same_field.still = true;
    same_field.iterations = 0;
    return same_field;
  }
  return nearest(clip_.frame(frame), before.field, alone_[static_cast<std::size_t>(key)].excess,
                 stiffer(before.tether));
}

FieldSequence::Span FieldSequence::span_from(int anchor, const std::vector<int>& owner) const {
  const auto frame_of = [&](int k) { return key_frames_[static_cast<std::size_t>(k)]; };
  // Its topology is that of all others: solved to the end.
  const Alone alone = solved_alone(frame_of(anchor), options_.field);
  Key first = nearest(clip_.frame(frame_of(anchor)), alone.field, alone.excess, 0);
  first.iterations += alone.iterations;
  // Keys from the anchor on, it left out; and how many of them are covered.
  const auto walk = [&](int step, std::vector<Key>& keys, int& covered) {
    Key before = first;
    bool covers = true;
    int edge = 0;  // the first key that is not covered
    for (int k = anchor + step; k >= 0 && k < static_cast<int>(owner.size()) && !interrupted(); k += step) {
      if (flat(before.field)) break;
      if (!covers && std::abs(frame_of(k - step) - frame_of(edge)) > options_.fade / 2) break;
      keys.push_back(next_key(k, k - step, before));
      before = keys.back();
      if (covers && (owner[static_cast<std::size_t>(k)] >= 0 ||
                     before.excess > limit(alone_[static_cast<std::size_t>(k)].excess, worst))) {
        covers = false;
        edge = k;
      }
      if (covers) covered = static_cast<int>(keys.size());
    }
  };
  std::vector<Key> back, forth;
  int covered_back = 0, covered_forth = 0;
  tbb::parallel_invoke([&] { walk(-1, back, covered_back); }, [&] { walk(1, forth, covered_forth); });
  Span span;
  span.anchor = anchor;
  span.first = anchor - covered_back;
  span.last = anchor + covered_forth;
  span.begin = anchor - static_cast<int>(back.size());
  span.keys.assign(back.rbegin(), back.rend());
  span.keys.push_back(first);
  span.keys.insert(span.keys.end(), forth.begin(), forth.end());
  return span;
}

void FieldSequence::find_spans() {
  owner_.assign(key_frames_.size(), -1);
  const auto developed_at = [&](std::size_t k) {
    return developed_[static_cast<std::size_t>(key_frames_[k])];
  };
  while (!interrupted()) {
    int anchor = -1;
    for (std::size_t k = 0; k < owner_.size(); ++k) {
      if (owner_[k] < 0 && !flat(alone_[k].field) &&
          (anchor < 0 || developed_at(k) > developed_at(static_cast<std::size_t>(anchor))))
        anchor = static_cast<int>(k);
    }
    if (anchor < 0) return;
    Span span = span_from(anchor, owner_);
    // In the phases of a span that was there before.
    for (const int step : {-1, 1}) {
      const int k = step < 0 ? span.begin : span.end() - 1;
      const int other = owner_[static_cast<std::size_t>(k)];
      if (other < 0) continue;
      const Span& known = spans_[static_cast<std::size_t>(other)];
      const CoarseField* reference = &known.keys[static_cast<std::size_t>(k - known.begin)].field;
      for (int at = k; at >= span.begin && at < span.end(); at -= step) {
        Key& key = span.keys[static_cast<std::size_t>(at - span.begin)];
        align(clip_.topology, clip_.frame(key_frames_[static_cast<std::size_t>(at)]).forms, *reference,
              key.field);
        reference = &key.field;
      }
      break;
    }
    for (int k = span.first; k <= span.last; ++k)
      if (owner_[static_cast<std::size_t>(k)] < 0)
        owner_[static_cast<std::size_t>(k)] = static_cast<int>(spans_.size());
    spans_.push_back(std::move(span));
  }
}

void FieldSequence::find_changes() {
  for (std::size_t k = 1; k < owner_.size(); ++k) {
    if (owner_[k] == owner_[k - 1]) continue;
    Change change;
    change.from = owner_[k - 1];
    change.to = owner_[k];
    // Half way between two frames; of one in the middle the span that was found first has more.
    const int sum = key_frames_[k - 1] + key_frames_[k];
    const bool before = change.to < 0 || (change.from >= 0 && change.from < change.to);
    change.at = sum % 2 != 0 ? sum / 2.0 : sum / 2 + (before ? 0.5 : -0.5);
    change.half = (options_.fade + 1) / 2.0;
    const auto reach = [&](double frame) {
      change.half = std::min(change.half, std::abs(frame - change.at));
    };
    const auto key_frame = [&](int key) { return key_frames_[static_cast<std::size_t>(key)]; };
    // Flat and waves do not mix: waves come up, or go, by themselves.
    if (change.from < 0 || change.to < 0) change.half = 0;
    if (change.from >= 0) reach(key_frame(spans_[static_cast<std::size_t>(change.from)].end() - 1) + 1);
    if (change.to >= 0) reach(key_frame(spans_[static_cast<std::size_t>(change.to)].begin) - 1);
    if (!changes_.empty()) {
      const double room = (change.at - changes_.back().at) / 2;
      change.half = std::min(change.half, room);
      changes_.back().half = std::min(changes_.back().half, room);
    }
    changes_.push_back(change);
  }
}

SequenceFrame FieldSequence::of_span(int number, int n) const {
  SequenceFrame result;
  result.field = flat_field(clip_.topology);
  result.reason = "stationary";
  if (number < 0) return result;
  const Span& span = spans_[static_cast<std::size_t>(number)];
  const auto frame_of = [&](int k) { return key_frames_[static_cast<std::size_t>(k)]; };
  const auto key_at = [&](int k) -> const Key& {
    return span.keys[static_cast<std::size_t>(k - span.begin)];
  };
  // The last key up to the frame, or the span's first.
  int k =
      static_cast<int>(std::upper_bound(key_frames_.begin(), key_frames_.end(), n) - key_frames_.begin()) - 1;
  k = std::clamp(k, span.begin, span.end() - 1);
  const auto of_key = [&](int at, FrameKind kind) {
    const Key& key = key_at(at);
    result.field = key.field;
    result.kind = kind;
    result.energy = key.energy;
    const double alone = alone_[static_cast<std::size_t>(at)].excess;
    if (alone > 0) result.excess = key.excess / alone;
    result.waves = key.waves;
    result.converged = key.converged;
    result.reason = key.reason;
    if (kind != FrameKind::still) result.iterations = key.iterations;
    return result;
  };
  if (frame_of(k) == n)
    return of_key(k, k == span.anchor  ? FrameKind::anchor
                     : key_at(k).still ? FrameKind::still
                                       : FrameKind::key);
  if (still(frame_of(k), n)) return of_key(k, FrameKind::still);
  const bool alone = k + 1 == span.end() || n < frame_of(k);  // beyond its keys
  if (!alone && still(n, frame_of(k + 1))) return of_key(k + 1, FrameKind::still);
  // From the key that is nearer to the anchor, so that a reversed clip has the same fields.
  const bool forward = k >= span.anchor;
  const int near = alone || forward ? k : k + 1, far = alone ? k : forward ? k + 1 : k;
  const auto way = [&](int frame) { return way_[static_cast<std::size_t>(frame)]; };
  const double whole = std::abs(way(frame_of(far)) - way(frame_of(near)));
  const double share = alone       ? 0
                       : whole > 0 ? std::abs(way(n) - way(frame_of(near))) / whole
                                   : static_cast<double>(std::abs(n - frame_of(near))) /
                                         std::abs(frame_of(far) - frame_of(near));
  const CoarseField between =
      alone ? key_at(k).field : interpolated(clip_.topology, key_at(near).field, key_at(far).field, share);
  const ClipFrame forms = clip_.frame(n);
  result.kind = FrameKind::between;
  if (options_.quality == Quality::draft) {
    result.field = between;
    const std::vector<bool> pinned =
        Problem(clip_.topology, forms.forms, clip_.model, forms.wrinkle_free, clip_.clamped).pinned();
    for (std::size_t v = 0; v < pinned.size(); ++v)
      if (pinned[v]) result.field.amplitude[static_cast<Index>(v)] = 0;
    for (std::size_t f = 0; f < forms.forms.size(); ++f)
      for (std::size_t c = 0; c < 3; ++c) {
        double& height = result.field.amplitude[static_cast<Index>(clip_.topology.faces[f][c])];
        height = std::min(height, forms.forms[f].room[c]);
      }
    result.waves = key_at(share < 0.5 ? near : far).waves;
    return result;
  }
  const auto alone_at = [&](int key) { return alone_[static_cast<std::size_t>(key)].excess; };
  Key solved = nearest(forms, between, (1 - share) * alone_at(near) + share * alone_at(far),
                       stiffer(std::min(key_at(near).tether, key_at(far).tether)));
  result.field = std::move(solved.field);
  result.waves = solved.waves;
  result.energy = solved.energy;
  result.iterations = solved.iterations;
  result.converged = solved.converged;
  result.reason = solved.reason;
  return result;
}

SequenceFrame FieldSequence::solve(int n) const {
  const double began = wall_seconds();
  int own = owner_.front();
  const Change* last = nullptr;
  for (const Change& change : changes_) {
    if (n < change.at) break;
    own = change.to;
    last = &change;
  }
  SequenceFrame result = of_span(own, n);
  for (const Change& change : changes_) {
    if (!(std::abs(n - change.at) < change.half)) continue;
    const double share = smooth((n - change.at) / (2 * change.half) + 0.5);
    const bool before = own == change.from;
    const SequenceFrame other = of_span(before ? change.to : change.from, n);
    result.field = before ? cross_faded(clip_.topology.faces, result.field, other.field, share)
                          : cross_faded(clip_.topology.faces, other.field, result.field, share);
    result.share = before ? 1 - share : share;
    result.iterations += other.iterations;
    if (!other.converged && result.converged) {
      result.converged = false;
      result.reason = other.reason;
    }
  }
  if (last && n - 1 < last->at) {
    result.waves_before = 0;
    if (last->from >= 0) {
      const Span& before = spans_[static_cast<std::size_t>(last->from)];
      result.waves_before = before.keys[static_cast<std::size_t>(before.last - before.begin)].waves;
    }
  }
  result.one_form = one_form_of(clip_.topology, result.field);
  result.change = change_[static_cast<std::size_t>(n)];
  result.solve_s = wall_seconds() - began;
  return result;
}

}  // namespace plisse::wrinkle
