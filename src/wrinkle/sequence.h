// Wrinkle fields over time: on a moving base surface the waves move continuously with it.
//
// The energy (27) does not depend on the frame before. The values that it does not determine are chosen so
// that they change least, for each patch: one phase (closed form) and the sign of all phases. Whole-number
// periods are kept until others have a clearly lower energy; then the old field and the new one, both solved
// on every frame, are cross-faded as the complex amplitudes a exp(iφ). (Chen et al. 2021, section 7, leave
// all of this open.)
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wrinkle/field.h"
#include "wrinkle/upsample.h"

namespace plisse::wrinkle {

struct SequenceOptions {
  FieldOptions field;
  int fade = 6;  // frames that show both of two fields, ≥ 0
  // Periods change where keeping them costs more than this many times what the new ones cost, both measured
  // above the energy of real periods: 9 means a real period that is ¾ away from the kept whole number and ¼
  // from the next. ≥ 1.
  double hysteresis = 9;
};

struct SequenceFrame {
  CoarseField field;                   // the field to show
  Eigen::VectorXd one_form;            // its differences of phase, radians, one an edge
  double waves = 0;                    // of the newest periods, see Field
  double share = 1;                    // 0 … 1: weight of the newest periods in `field`
  std::optional<double> waves_before;  // if periods change from this frame on: the number of waves before
  // Radians: change of phase since the frame before, root mean square weighted by area and both amplitudes; 0
  // where one of them has no waves.
  double phase_step = 0;
  double energy = 0, kkt = 0;  // of the newest periods, see Solution
  int iterations = 0;          // of all solves of this frame
  bool converged = true;
  std::string reason;
  double solve_s = 0;
};

class FieldSequence {
 public:
  // clamped: as for solve_field.
  FieldSequence(shell::Topology topology, const Model& model, std::vector<bool> clamped,
                const SequenceOptions& options = {});

  // The next frame; forms and wrinkle-free faces are those of its base surface.
  SequenceFrame next(const std::vector<FaceForms>& forms, const std::vector<bool>& wrinkle_free);

 private:
  // A field that is solved from frame to frame with the same periods.
  struct State {
    CoarseField field;
    double waves = 0;
  };
  Waves carried(const Problem& problem, const CoarseField& before) const;
  State state_of(const Problem& problem, const Waves& waves) const;
  std::optional<State> begun(const Problem& problem, const std::vector<FaceForms>& forms,
                             const std::vector<bool>& wrinkle_free, SequenceFrame& frame) const;
  Solution solve_on(const Problem& problem, const Waves& start, bool fixed_periods,
                    SequenceFrame& frame) const;
  std::optional<Waves> other_periods(const Problem& problem, const Solution& kept, SequenceFrame& frame);

  shell::Topology topology_;
  Model model_;
  std::vector<bool> clamped_;
  SequenceOptions options_;
  std::optional<State> now_, before_;  // with the newest periods; with those that fade out
  int faded_ = 0;                      // frames since before_ began to fade
  bool rises_ = false;                 // now_ fades in without an older field
  int checks_ = 0;                     // checks of the periods since those of now_ began
  CoarseField shown_;                  // by the last frame; empty before the first
};

// z = (1 − share) a exp(iφ) of one field + share a exp(iφ) of the other, on faces where both have phases: the
// phases of the field with the larger share, plus the change that the other one causes; never by more than
// half a turn.
CoarseField cross_faded(const std::vector<shell::Face>& faces, const CoarseField& from, const CoarseField& to,
                        double share);

// Adds to the phases of each patch (faces with waves that share sides) of `field` the one number for which it
// is nearest to `reference`, least squares of a exp(iφ) by area; before, changes their sign where the
// gradients are opposite on average.
void align(const shell::Topology& topology, const std::vector<FaceForms>& forms, const CoarseField& reference,
           CoarseField& field);

}  // namespace plisse::wrinkle
