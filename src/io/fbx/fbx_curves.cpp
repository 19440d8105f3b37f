// Curves and takes of FBX files (see fbx_curves.h).
//
// Between two keys a cubic curve is a Bézier: its control points lie at the parts w and 1 − w' of the way
// from key to key in time (a third each unless weighted), and off the keys' values by slope · time. Slopes of
// the user are stored. Those of "auto" tangents are not: they follow from the neighbouring keys, as those of
// TCB tangents do from tension, continuity and bias.
#include "io/fbx/fbx_curves.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>

namespace plisse::io {
namespace {

// Bits of KeyAttrFlags.
constexpr std::int64_t is_constant = 0x2, is_linear = 0x4, is_cubic = 0x8;
constexpr std::int64_t constant_next = 0x100;
constexpr std::int64_t tangent_auto = 0x100, tangent_tcb = 0x200, tangent_user = 0x400;
constexpr std::int64_t clamp = 0x1000, time_independent = 0x2000, clamp_progressive = 0x4000;
constexpr std::int64_t weighted_right = 0x01000000, weighted_next_left = 0x02000000;

std::vector<double> numbers_of(const FbxObject& object, std::string_view name) {
  const FbxElement* list = object.element->child(name);
  return list == nullptr ? std::vector<double>() : list->numbers();
}

// Solves x(u) = x for the Bézier with control points 0, x1, x2, 1 in time, which lie within 0 … 1, so that
// it ascends.
double bezier_parameter(double x, double x1, double x2) {
  if (std::abs(x1 - 1.0 / 3) < 1e-12 && std::abs(x2 - 2.0 / 3) < 1e-12) return x;
  double low = 0, high = 1, u = x;
  for (int step = 0; step < 80; ++step) {
    const double v = 1 - u;
    const double error = 3 * v * v * u * x1 + 3 * v * u * u * x2 + u * u * u - x;
    if (std::abs(error) < 1e-15) break;
    (error > 0 ? high : low) = u;
    const double slope = 3 * v * v * x1 + 6 * v * u * (x2 - x1) + 3 * u * u * (1 - x2);
    const double newton = slope > 1e-9 ? u - error / slope : -1;
    const double next = newton > low && newton < high ? newton : (low + high) / 2;
    if (next == u) break;
    u = next;
  }
  return u;
}

bool constant_extrapolation(const FbxObject& object, std::string_view name) {
  const FbxElement* element = object.element->child(name);
  const FbxElement* type = element == nullptr ? nullptr : element->child("Type");
  if (type == nullptr) return true;
  return type->text(0) == "C" || type->text(0) == "Constant" || type->integer(0) == 'C';
}

}  // namespace

struct FbxCurve::Attribute {
  std::int64_t flags = is_linear;
  double data[3] = {0, 0, 0};  // right slope, next left slope, weights; of TCB: tension, continuity, bias
};

FbxCurve::FbxCurve(const FbxScene& scene, const FbxObject& object) {
  const FbxElement* time_list = object.element->child("KeyTime");
  const FbxElement* value_list = object.element->child("KeyValueFloat");
  if (time_list == nullptr || value_list == nullptr) return;
  const std::vector<std::int64_t> times = time_list->integers();
  const std::vector<double> values = value_list->numbers();
  const std::vector<double> flags = numbers_of(object, "KeyAttrFlags");
  const std::vector<double> data = numbers_of(object, "KeyAttrDataFloat");
  const std::vector<double> counts = numbers_of(object, "KeyAttrRefCount");
  if (times.size() != values.size()) throw std::runtime_error("a curve has other counts of times and values");

  // An attribute serves as many keys as its count says.
  std::vector<Attribute> attributes;
  std::vector<Attribute> of_keys;
  for (std::size_t a = 0; a < flags.size(); ++a) {
    Attribute& one = attributes.emplace_back();
    one.flags = static_cast<std::int64_t>(flags[a]);
    for (std::size_t d = 0; d < 3 && 4 * a + d < data.size(); ++d)
      if (std::isfinite(data[4 * a + d])) one.data[d] = data[4 * a + d];
  }
  std::size_t attribute = 0;
  double left = counts.empty() ? 1 : counts[0];
  for (std::size_t k = 0; k < times.size(); ++k) {
    while (left < 1 && attribute + 1 < attributes.size()) {
      ++attribute;
      left = attribute < counts.size() ? counts[attribute] : 1;
    }
    left -= 1;
    const double time = static_cast<double>(times[k]) / scene.ticks_per_second();
    if (!std::isfinite(values[k])) continue;
    if (!keys_.empty() && time < keys_.back().time) continue;
    if (!keys_.empty() && time == keys_.back().time) {
      keys_.pop_back();
      of_keys.pop_back();
    }
    keys_.emplace_back();
    keys_.back().time = time;
    keys_.back().value = values[k];
    of_keys.push_back(attribute < attributes.size() ? attributes[attribute] : Attribute{});
  }
  for (std::size_t k = 0; k < keys_.size(); ++k) set(k, of_keys[k]);
  solve_slopes(of_keys);
  goes_on_ = !constant_extrapolation(object, "Pre-Extrapolation") ||
             !constant_extrapolation(object, "Post-Extrapolation");
}

void FbxCurve::set(std::size_t k, const Attribute& attribute) {
  Key& key = keys_[k];
  if ((attribute.flags & is_constant) != 0) {
    key.mode = (attribute.flags & constant_next) != 0 ? Mode::constant_next : Mode::constant;
    return;
  }
  if ((attribute.flags & is_cubic) == 0) {
    key.mode = Mode::linear;
    return;
  }
  key.mode = Mode::cubic;
  if ((attribute.flags & tangent_tcb) != 0) return;
  // Two whole numbers of 16 bits in the bits of a float, each in ten-thousandths. ASCII files have the
  // number that these bits are as a whole one, binary ones as a float.
  std::uint32_t bits = 0;
  const double packed = attribute.data[2];
  if (packed >= 1 && packed < 4294967296.0 && packed == std::floor(packed)) {
    bits = static_cast<std::uint32_t>(packed);
  } else {
    const auto single = static_cast<float>(packed);
    std::memcpy(&bits, &single, sizeof bits);
  }
  const auto weight = [](std::uint32_t part) { return std::clamp(part / 10000.0, 0.0001, 1.0); };
  if ((attribute.flags & weighted_right) != 0) key.right_weight = weight(bits & 0xFFFF);
  if ((attribute.flags & weighted_next_left) != 0) key.next_left_weight = weight(bits >> 16);
}

// The slope of an automatic tangent, the same on both sides of the key.
double FbxCurve::automatic_slope(std::size_t k, std::int64_t flags) const {
  if (k == 0 || k + 1 >= keys_.size()) return 0;
  const Key &before = keys_[k - 1], &key = keys_[k], &after = keys_[k + 1];
  const double left = key.time - before.time, right = after.time - key.time;
  const double rise_left = key.value - before.value, rise_right = after.value - key.value;
  double slope = (rise_left + rise_right) / (left + right);
  if ((flags & (time_independent | clamp_progressive)) == 0) {
    // Keys that are near in time count for more.
    const double part = left / (left + right);
    slope = 0.5 * slope + 0.5 * ((1 - part) * rise_left / left + part * rise_right / right);
  }
  if ((flags & clamp) != 0 && std::min(std::abs(rise_left), std::abs(rise_right)) < 1e-9) return 0;
  if ((flags & clamp_progressive) == clamp_progressive) {
    // No handle reaches beyond the value of the key next to it.
    const double sign = slope < 0 ? -1 : 1;
    const double most_left = std::max(0.0, sign * rise_left / (before.next_left_weight * left));
    const double most_right = std::max(0.0, sign * rise_right / (key.right_weight * right));
    slope = sign * std::min({std::abs(slope), most_left, most_right});
  }
  return slope;
}

void FbxCurve::solve_slopes(const std::vector<Attribute>& attributes) {
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const Attribute& own = attributes[k];
    const bool computed = (own.flags & (tangent_auto | tangent_tcb)) != 0 && (own.flags & tangent_user) == 0;
    if (keys_[k].mode != Mode::cubic) continue;
    if (!computed || ((own.flags & tangent_auto) != 0 && (own.data[0] != 0 || own.data[1] != 0))) {
      keys_[k].right_slope = own.data[0];
      keys_[k].next_left_slope = own.data[1];
    }
  }
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const Attribute& own = attributes[k];
    if ((own.flags & is_cubic) == 0 || (own.flags & is_constant) != 0 || (own.flags & tangent_user) != 0)
      continue;
    double left = 0, right = 0;
    if ((own.flags & tangent_tcb) != 0) {
      const auto secant = [&](std::size_t from) {
        return (keys_[from + 1].value - keys_[from].value) / (keys_[from + 1].time - keys_[from].time);
      };
      if (keys_.size() < 2) continue;
      const double in = k > 0 ? secant(k - 1) : secant(k);
      const double out = k + 1 < keys_.size() ? secant(k) : secant(k - 1);
      const double t = own.data[0], c = own.data[1], b = own.data[2];
      left = 0.5 * (1 - t) * ((1 + b) * (1 - c) * in + (1 - b) * (1 + c) * out);
      right = 0.5 * (1 - t) * ((1 + b) * (1 + c) * in + (1 - b) * (1 - c) * out);
    } else if ((own.flags & tangent_auto) != 0 && own.data[0] == 0 && own.data[1] == 0) {
      left = right = automatic_slope(k, own.flags);
    } else {
      continue;
    }
    keys_[k].right_slope = right;
    if (k > 0) keys_[k - 1].next_left_slope = left;
  }
}

double FbxCurve::at(double time, bool from_left) const {
  const auto after = from_left ? std::lower_bound(keys_.begin(), keys_.end(), time,
                                                  [](const Key& key, double t) { return key.time < t; })
                               : std::upper_bound(keys_.begin(), keys_.end(), time,
                                                  [](double t, const Key& key) { return t < key.time; });
  if (after == keys_.begin()) return keys_.front().value;
  if (after == keys_.end()) {
    // From the left, the last key's value is that of the piece before it: above.
    return keys_.back().value;
  }
  const Key &from = *(after - 1), &to = *after;
  const double length = to.time - from.time;
  const double part = (time - from.time) / length;
  switch (from.mode) {
    case Mode::constant:
      return from.value;
    case Mode::constant_next:
      return part > 0 ? to.value : from.value;
    case Mode::linear:
      return from.value + (to.value - from.value) * part;
    case Mode::cubic:
      break;
  }
  // Handles that overlap in time would make the curve go back in it.
  const double u = bezier_parameter(part, from.right_weight, 1 - from.next_left_weight);
  const double v = 1 - u;
  const double first = from.value + from.right_slope * from.right_weight * length;
  const double second = to.value - from.next_left_slope * from.next_left_weight * length;
  return v * v * v * from.value + 3 * v * v * u * first + 3 * v * u * u * second + u * u * u * to.value;
}

void FbxCurve::add_times(std::vector<double>& times) const {
  for (const Key& key : keys_) times.push_back(key.time);
}

glm::dvec3 FbxTrack::at(double time, bool from_left) const {
  glm::dvec3 value = still;
  for (int axis = 0; axis < 3; ++axis)
    if (const FbxCurve* curve = curves[static_cast<std::size_t>(axis)].get())
      value[axis] = curve->at(time, from_left);
  return value;
}

void FbxTrack::add_times(std::vector<double>& times) const {
  for (const auto& curve : curves)
    if (curve) curve->add_times(times);
}

FbxTake::FbxTake(const FbxScene& scene, const FbxObject& stack) : name_(stack.name) {
  for (const FbxObject* layer : scene.sources(stack.id, "AnimationLayer")) read_layer(scene, *layer);
  start_ = scene.number(stack, "LocalStart", 0) / scene.ticks_per_second();
  stop_ = scene.number(stack, "LocalStop", 0) / scene.ticks_per_second();
  std::vector<double> times;
  for (const auto& [of, track] : tracks_) {
    track.add_times(times);
    for (const auto& curve : track.curves) goes_on_ |= curve && curve->goes_on();
  }
  if (start_ == 0 && stop_ == 0 && !times.empty()) {
    start_ = *std::min_element(times.begin(), times.end());
    stop_ = *std::max_element(times.begin(), times.end());
  }
}

void FbxTake::read_layer(const FbxScene& scene, const FbxObject& layer) {
  bool used = false;
  for (const FbxObject* node : scene.sources(layer.id, "AnimationCurveNode")) {
    FbxTrack track;
    for (const FbxScene::Connection& one : scene.connections_to(node->id)) {
      const FbxObject* source = scene.object(one.source);
      if (source == nullptr || source->kind != "AnimationCurve" || one.property.empty()) continue;
      auto curve = std::make_shared<const FbxCurve>(scene, *source);
      if (curve->empty()) continue;
      const std::size_t axis = one.property.ends_with("|Y") ? 1 : one.property.ends_with("|Z") ? 2 : 0;
      track.curves[axis] = std::move(curve);
    }
    if (!track.moves()) continue;
    used = true;
    if (layers_used_ > 0) continue;
    for (const auto& [target, property] : scene.properties_of(node->id)) {
      const FbxObject* object = scene.object(target);
      if (object == nullptr) continue;
      FbxTrack own = track;
      own.still = scene.vector(*object, property, glm::dvec3{property == "Lcl Scaling" ? 1.0 : 0.0});
      own.still = {scene.number(*node, "d|X", own.still.x), scene.number(*node, "d|Y", own.still.y),
                   scene.number(*node, "d|Z", own.still.z)};
      tracks_.emplace(std::pair(target, property), std::move(own));
    }
  }
  layers_used_ += used ? 1 : 0;
}

const FbxTrack* FbxTake::track(std::int64_t object, std::string_view property) const {
  const auto found = tracks_.find({object, property});
  return found == tracks_.end() ? nullptr : &found->second;
}

namespace {

// Fits pieces one after the other (see fit_keys).
class Fitter {
 public:
  Fitter(const FunctionOfTime& function, double tolerance, bool normalised)
      : function_(function), tolerance_(tolerance), normalised_(normalised) {}

  FittedKeys run(const std::vector<double>& knots) {
    if (knots.size() < 2) {
      const double time = knots.empty() ? 0 : knots.front();
      add(time, value(time, false), {}, {});
      return std::move(keys_);
    }
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      reference_ = value(knots[k], false);
      pieces_ = 0;
      piece(knots[k], knots[k + 1], 0);
    }
    // What a constant key leaves for the very end.
    add(knots.back(), value(knots.back(), false), {}, {});
    drop_still();
    return std::move(keys_);
  }

 private:
  // Of the two signs of a quaternion that which is nearer to the one before.
  std::vector<double> value(double time, bool from_left) {
    std::vector<double> result = function_(time, from_left);
    if (!normalised_ || reference_.empty()) return result;
    double dot = 0;
    for (std::size_t i = 0; i < result.size(); ++i) dot += result[i] * reference_[i];
    if (dot < 0)
      for (double& x : result) x = -x;
    return result;
  }

  void piece(double from, double to, int depth) {
    const double length = to - from;
    const double h = length / 64;
    reference_ = keys_.values.empty() ? reference_ : keys_.values.back();
    const std::vector<double> a = value(from, false);
    reference_ = a;
    const std::vector<double> b = value(to, true);
    // One-sided differences that are exact for cubics.
    std::vector<double> out(a.size()), in(a.size());
    {
      const auto a1 = value(from + h, false), a2 = value(from + 2 * h, false),
                 a3 = value(from + 3 * h, false);
      const auto b1 = value(to - h, false), b2 = value(to - 2 * h, false), b3 = value(to - 3 * h, false);
      for (std::size_t i = 0; i < a.size(); ++i) {
        out[i] = (-11 * a[i] + 18 * a1[i] - 9 * a2[i] + 2 * a3[i]) / (6 * h);
        in[i] = (11 * b[i] - 18 * b1[i] + 9 * b2[i] - 2 * b3[i]) / (6 * h);
      }
    }
    constexpr int deepest = 24;
    constexpr int most_pieces = 4096;  // from knot to knot: more are of damaged numbers
    if (depth < deepest && length > 1e-7 && pieces_ < most_pieces && !close(from, length, a, b, out, in)) {
      const double middle = (from + to) / 2;
      piece(from, middle, depth + 1);
      piece(middle, to, depth + 1);
      return;
    }
    ++pieces_;
    add(from, a, {}, out);
    add(to, b, in, {});
  }

  bool close(double from, double length, const std::vector<double>& a, const std::vector<double>& b,
             const std::vector<double>& out, const std::vector<double>& in) {
    for (const double s : {0.17, 0.5, 0.79, 0.95}) {
      const std::vector<double> right = value(from + s * length, false);
      const double s2 = s * s, s3 = s2 * s;
      std::vector<double> found(a.size());
      double size = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        found[i] = (2 * s3 - 3 * s2 + 1) * a[i] + (s3 - 2 * s2 + s) * length * out[i] +
                   (3 * s2 - 2 * s3) * b[i] + (s3 - s2) * length * in[i];
        size += found[i] * found[i];
      }
      size = normalised_ ? std::sqrt(size) : 1;
      for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(found[i] / size - right[i]) <= tolerance_)) return false;
    }
    return true;
  }

  // Adds a key, or joins it with the one that is there already; before a jump the older one moves a little
  // back.
  void add(double time, const std::vector<double>& value, const std::vector<double>& in,
           const std::vector<double>& out) {
    const std::vector<double> flat(value.size(), 0);
    if (!keys_.times.empty() && keys_.times.back() >= time) {
      double jump = 0;
      for (std::size_t i = 0; i < value.size(); ++i)
        jump = std::max(jump, std::abs(value[i] - keys_.values.back()[i]));
      if (jump <= 1e-3 * tolerance_) {
        if (!out.empty()) keys_.out_tangents.back() = out;
        return;
      }
      const double back = time - std::max(1e-9, 4 * (time - std::nextafter(time, -1e300)));
      if (keys_.times.size() > 1 && keys_.times[keys_.times.size() - 2] >= back) return;
      keys_.times.back() = back;
      keys_.out_tangents.back() = flat;
      keys_.times.push_back(time);
      keys_.values.push_back(value);
      keys_.in_tangents.push_back(flat);
      keys_.out_tangents.push_back(out.empty() ? flat : out);
      return;
    }
    keys_.times.push_back(time);
    keys_.values.push_back(value);
    keys_.in_tangents.push_back(in.empty() ? flat : in);
    keys_.out_tangents.push_back(out.empty() ? flat : out);
  }

  // One key is enough where nothing moves.
  void drop_still() {
    for (const auto& value : keys_.values)
      for (std::size_t i = 0; i < value.size(); ++i)
        if (std::abs(value[i] - keys_.values.front()[i]) > 1e-3 * tolerance_) return;
    for (const auto& slope : keys_.out_tangents)
      for (const double x : slope)
        if (std::abs(x) > tolerance_) return;
    for (auto* list : {&keys_.values, &keys_.in_tangents, &keys_.out_tangents}) list->resize(1);
    keys_.times.resize(1);
  }

  const FunctionOfTime& function_;
  double tolerance_;
  bool normalised_;
  std::vector<double> reference_;
  int pieces_ = 0;  // since the last knot
  FittedKeys keys_;
};

}  // namespace

FittedKeys fit_keys(const FunctionOfTime& function, const std::vector<double>& knots, double tolerance,
                    bool normalised) {
  return Fitter(function, tolerance, normalised).run(knots);
}

}  // namespace plisse::io
