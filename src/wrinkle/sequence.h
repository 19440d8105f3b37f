// Wrinkle fields over time: a whole clip without history. On a moving base surface the waves move
// continuously with it.
//
// The energy (27) of a frame has many minima and soft valleys, and does not know the frame before. So some
// frames, the *keys*, are chosen by how far the strain of the base has changed; the most developed one is
// solved alone, an *anchor*, and its topology (periods, rounded there) is carried from key to key, forward
// and backward, as long as no other topology has a clearly lower energy: its *span*. The keys left get
// anchors of their own. A frame between two keys of a span has their amplitudes and phases interpolated, and
// its energy minimised with a tether to that. It depends on its keys only, and they on the whole clip, so it
// is the same whichever frames are asked for. Where spans meet, both are shown for some frames. (Chen et al.
// 2021, section 7, leave all of this open.)
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wrinkle/between.h"
#include "wrinkle/field.h"

namespace plisse::wrinkle {

struct ClipFrame {
  std::vector<FaceForms> forms;
  std::vector<bool> wrinkle_free;
};

struct Clip {
  shell::Topology topology;
  Model model;
  std::vector<bool> clamped;  // as for solve_field
  int frames = 0;
  // Of frames from 0 on; called from many threads at once, and more than once for a frame.
  std::function<ClipFrame(int)> frame;
};

enum class Quality {
  draft,  // frames between keys are interpolated
  final   // and their energy minimised
};

struct SequenceOptions {
  FieldOptions field;
  int fade = 6;  // frames that show both of two spans, ≥ 0
  Quality quality = Quality::final;
};

enum class FrameKind {
  flat,     // nothing wrinkles
  anchor,   // solved alone
  key,      // carried from an anchor
  between,  // two keys
  still     // has a key's field, since the strain is a key's
};

struct SequenceFrame {
  CoarseField field;         // the field to show
  Eigen::VectorXd one_form;  // its differences of phase, radians, one an edge
  FrameKind kind = FrameKind::flat;
  double waves = 0;   // of the nearest key of its span, see Field
  double change = 0;  // δ: of the strain since the frame before, over its root mean square
  // 0 … 1: weight of its own span in `field`; less where another one is shown as well.
  double share = 1;
  std::optional<double> waves_before;  // on the first frame of a span that follows another: that one's
  // J, see Solution: of its own span, where it was minimised; else 0.
  double energy = 0;
  // Of keys: the energy above the relaxed one over that of the frame solved alone.
  std::optional<double> excess;
  int iterations = 0;
  bool converged = true;
  std::string reason;
  double solve_s = 0;
};

class FieldSequence {
 public:
  // Finds the keys and solves them, on all cores. `progress`: keys done, of how many.
  FieldSequence(Clip clip, const SequenceOptions& options = {},
                const std::function<void(int, int)>& progress = {});

  // The field of a frame (from 0 on). May be called from many threads.
  SequenceFrame solve(int frame) const;

  const std::vector<int>& keys() const { return key_frames_; }
  std::size_t spans() const { return spans_.size(); }

 private:
  struct Alone {
    CoarseField field;
    double excess = 0;  // J, above the relaxed energy
    int iterations = 0;
  };
  struct Key {
    CoarseField field;
    double waves = 0, energy = 0, excess = 0;
    int iterations = 0;
    std::size_t tether = 0;  // its number: the softer, the higher
    bool converged = true, still = false;
    std::string reason;
  };
  struct Span {
    int anchor = 0;           // numbers of keys
    int first = 0, last = 0;  // that it covers
    int begin = 0;            // of the first of `keys`: some beyond those covered, to cross-fade
    std::vector<Key> keys;
    int end() const { return begin + static_cast<int>(keys.size()); }
  };
  struct Change {
    double at = 0, half = 0;  // frames; both spans are shown less than `half` from `at`
    int from = 0, to = 0;     // spans, −1 where flat
  };

  void measure();
  void place_keys();
  void solve_alone(const std::function<void(int, int)>& progress);
  Alone solved_alone(int frame, const FieldOptions& options) const;
  void find_spans();
  void find_changes();
  Span span_from(int anchor, const std::vector<int>& owner) const;
  // The least energy with the topology of `near`, by the stiffest tether to it, from number `stiffest` on,
  // that keeps it within its limit; `alone`: about what the frame has alone, J above the relaxed energy.
  Key nearest(const ClipFrame& frame, const CoarseField& near, double alone, std::size_t stiffest) const;
  Key next_key(int key, int from, const Key& before) const;
  double limit(double alone, double times) const;  // J, of the energy above the relaxed one
  bool still(int a, int b) const;                  // whether the base is the same in all frames from a to b
  SequenceFrame of_span(int span, int frame) const;

  Clip clip_;
  SequenceOptions options_;
  std::vector<double> developed_;  // of every frame: ∫ compression above what waves need, m²
  std::vector<double> change_;     // of every frame: δ to the one before
  std::vector<double> way_;        // their sum
  std::vector<int> moved_;         // how often the base has changed at all
  std::vector<int> key_frames_;    // in order
  std::vector<Alone> alone_;       // of every key
  double most_ = 0;                // the largest energy above the relaxed one among them, J
  std::vector<Span> spans_;
  std::vector<int> owner_;  // span of every key, −1: flat
  std::vector<Change> changes_;
};

}  // namespace plisse::wrinkle
