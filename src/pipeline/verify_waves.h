// Compares skin, crush and relax on the GPU with the reference, whose passes have the inputs of the GPU's
// passes (docs/contract.md, "State over time", rule 6); the error of all passes together is computed
// separately.
#pragma once

#include <map>
#include <string>

#include "pipeline/reference_scene.h"
#include "pipeline/stepper.h"
#include "pipeline/tally.h"

namespace plisse::pipeline {

class WaveComparison {
 public:
  // Compares what `stepper` does. All three outlive this.
  WaveComparison(LoadedScene& scene, ReferenceScene& reference, Stepper& stepper,
                 const std::string& shader_folder);

  // To be called before a step; `looking`: whether its passes are compared.
  void before_step(int step, bool looking);
  // Within a step: the stepper's observer.
  void observe(Stepper::Stage stage);
  // After every step, compared or not.
  void after_step(int step);

  // The same moment with all passes in double precision from the clip's start.
  const WaveSnapshot& chain() const { return chain_.now(); }
  // Of the phases of the chain against those of `gpu`: radians, root mean square over wrinkled vertices.
  double chain_phase_difference(const WaveSnapshot& gpu) const;

  void report(std::map<std::string, PassComparison>& passes) const;

 private:
  void compare_skin(const WaveSnapshot& gpu);
  void compare_crush(const WaveSnapshot& gpu);
  void compare_relax(const WaveSnapshot& before, const WaveSnapshot& after,
                     const reference::RelaxSettings& settings, Tally& tally);
  void compare_ten_rounds();
  void compare_lead(const WaveSnapshot& before, const WaveSnapshot& after, reference::Status which,
                    double share);

  LoadedScene& scene_;
  ReferenceScene& reference_;
  Stepper& stepper_;
  ReferenceChain chain_;
  passes::RelaxPass scratch_relax_;

  scene::Pose pose_;
  bool looking_ = false;
  double share_ = 0;                      // of the difference by which this step moves a loop's phases
  WaveSnapshot before_, crushed_, last_;  // before the step; after crush; at the last stage seen
  WaveSnapshot remembered_;               // the target of a closing loop
  Tally skin_, frame_;
  Tally r_, height_, easing_, weight_, wave_vector_, status_;
  Tally relax_, ten_rounds_, lead_, begun_;  // begun_: phases after crush
};

}  // namespace plisse::pipeline
