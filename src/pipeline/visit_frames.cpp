#include "pipeline/visit_frames.h"

#include "base/interrupt.h"
#include "pipeline/stepper.h"

namespace plisse::pipeline {

bool visit_frames(LoadedScene& scene, const std::vector<int>& frames, const Device& device,
                  const FrameCallback& on_frame,
                  const std::function<std::string(int, const passes::SurfaceBuffers&)>& work) {
  const gpu::Context context(device.number);
  gpu::StageTimer timer(context.info().software);
  Stepper stepper(scene, timer, device.shader_folder);
  int done = 0;
  for (const int frame : frames) {
    if (interrupted() || !stepper.advance_to(scene.step_of_frame(frame))) return false;
    FrameReport report;
    report.frame = frame;
    report.time_s = scene.animation.timeline().time(frame);
    report.path = work(frame, stepper.surface());
    if (on_frame) on_frame(++done, static_cast<int>(frames.size()), report);
  }
  return true;
}

}  // namespace plisse::pipeline
