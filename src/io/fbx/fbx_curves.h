// Animation curves of FBX files, evaluated as they are: constant, linear, and cubic Béziers with the slopes
// and weights of their keys; and animation stacks, which say what the curves move.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/fbx/fbx_scene.h"

namespace plisse::io {

class FbxCurve {
 public:
  // Of an AnimationCurve. Throws std::runtime_error where its lists are damaged.
  FbxCurve(const FbxScene& scene, const FbxObject& object);

  bool empty() const { return keys_.empty(); }
  // The value at a time in seconds; from_left: the limit from earlier times, where a constant key ends.
  double at(double time, bool from_left) const;
  double first() const { return keys_.front().time; }
  double last() const { return keys_.back().time; }
  void add_times(std::vector<double>& times) const;
  // Before its first or after its last key it does not stay as it is there.
  bool goes_on() const { return goes_on_; }

 private:
  enum class Mode { constant, constant_next, linear, cubic };
  struct Key {
    double time = 0, value = 0;
    Mode mode = Mode::linear;
    // To the next key: slopes per second at both ends, and the parts of the way that their handles take.
    double right_slope = 0, next_left_slope = 0, right_weight = 1.0 / 3, next_left_weight = 1.0 / 3;
  };
  struct Attribute;
  void set(std::size_t key, const Attribute& attribute);
  void solve_slopes(const std::vector<Attribute>& attributes);
  double automatic_slope(std::size_t key, std::int64_t flags) const;

  std::vector<Key> keys_;
  bool goes_on_ = false;
};

// A property with one curve a component.
struct FbxTrack {
  std::array<std::shared_ptr<const FbxCurve>, 3> curves;  // null: the component stays as it is in `still`
  glm::dvec3 still{0};

  bool moves() const { return curves[0] || curves[1] || curves[2]; }
  glm::dvec3 at(double time, bool from_left) const;
  void add_times(std::vector<double>& times) const;
};

// An animation stack ("take"): what it moves, over which time.
class FbxTake {
 public:
  FbxTake(const FbxScene& scene, const FbxObject& stack);

  const std::string& name() const { return name_; }
  double start() const { return start_; }  // seconds
  double stop() const { return stop_; }
  // The curves of an object's property; null where the take does not move it.
  const FbxTrack* track(std::int64_t object, std::string_view property) const;
  std::size_t layers_used() const { return layers_used_; }  // that move anything; the first is read
  bool goes_on() const { return goes_on_; }

 private:
  void read_layer(const FbxScene& scene, const FbxObject& layer);

  std::string name_;
  double start_ = 0, stop_ = 0;
  std::size_t layers_used_ = 0;
  bool goes_on_ = false;
  std::map<std::pair<std::int64_t, std::string_view>, FbxTrack> tracks_;
};

// Cubic Hermite pieces, as Keys of model.h have them.
struct FittedKeys {
  std::vector<double> times;
  std::vector<std::vector<double>> values, in_tangents, out_tangents;
};

// Pieces that stay within `tolerance` of a function of time, which is smooth between the knots (ascending)
// and may jump at them. `normalised`: of unit quaternions, which are compared after normalisation, and whose
// signs may be any.
using FunctionOfTime = std::function<std::vector<double>(double time, bool from_left)>;
FittedKeys fit_keys(const FunctionOfTime& function, const std::vector<double>& knots, double tolerance,
                    bool normalised = false);

}  // namespace plisse::io
