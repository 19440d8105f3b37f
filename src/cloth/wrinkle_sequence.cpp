#include "cloth/wrinkle_sequence.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <set>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "cloth/wrinkle_files.h"
#include "config/frames.h"
#include "io/import.h"
#include "io/sequence.h"
#include "wrinkle/base_check.h"

namespace plisse::cloth {
namespace {

namespace fs = std::filesystem;

// Not from the waves of each frame, as all frames have the same mesh.
constexpr int sequence_levels = 3;

// Base surfaces one after the other.
class Bases {
 public:
  explicit Bases(const WrinkleSequenceRequest& request)
      : poses_(request.poses), room_(request.room), from_(request.first) {
    if (!poses_.empty()) {
      first_ = request.each.scene;
    } else if (config::is_frame_pattern(request.bases.string())) {
      if (!request.cache.empty())
        throw Error(ExitCode::bad_input, "--cache moves one base.ply, not a sequence of them");
      files_ = io::sequence_files(request.bases);
      first_ = read_base(files_.front());
    } else {
      first_ = read_base(request.bases);
      io::ImportOptions options;
      options.cache = request.cache;
      const io::Model model = io::import_model(request.bases, options);
      cache_ = model.cache;
      for (const io::Mesh& mesh : model.meshes)
        file_vertex_.insert(file_vertex_.end(), mesh.file_vertices.begin(), mesh.file_vertices.end());
    }
  }

  int from() const { return from_; }  // number of the first
  int last() const {
    const std::size_t count = !poses_.empty()  ? poses_.size()
                              : files_.empty() ? cache_.size()
                                               : files_.size();
    return from_ + static_cast<int>(count) - 1;
  }
  const WrinkleScene& first() const { return first_; }
  const std::vector<fs::path>& files() const { return files_; }

  WrinkleScene read(int frame) const {
    const auto index = static_cast<std::size_t>(frame - from_);
    if (!poses_.empty()) {
      WrinkleScene scene = first_;
      scene.surface.positions = poses_[index];
      if (!room_.empty()) scene.room = room_[index];
      return scene;
    }
    if (!files_.empty()) {
      WrinkleScene scene = read_base(files_[index]);
      if (scene.surface.topology.faces != first_.surface.topology.faces ||
          scene.surface.positions.cols() != first_.surface.positions.cols())
        throw Error(ExitCode::bad_input, fmt::format("{}: has another mesh than {}", files_[index].string(),
                                                     files_.front().string()));
      if (scene.held != first_.held)
        throw Error(ExitCode::bad_input, fmt::format("{}: holds other vertices than {}",
                                                     files_[index].string(), files_.front().string()));
      return scene;
    }
    WrinkleScene scene = first_;
    // A model's vertices are split where uv are; the base's are the file's.
    const auto places = cache_.frame(index);
    for (std::size_t v = 0; v < places->size(); ++v)
      scene.surface.positions.col(file_vertex_.at(v)) = to_eigen((*places)[v]);
    return scene;
  }

 private:
  const std::vector<shell::Positions>& poses_;
  const std::vector<std::vector<double>>& room_;
  int from_;
  std::vector<fs::path> files_;
  io::VertexCache cache_;
  std::vector<std::uint32_t> file_vertex_;  // of each of its places
  WrinkleScene first_;
};

void check_pattern(const fs::path& path, std::size_t frames) {
  if (!path.empty() && frames > 1 && !config::is_frame_pattern(path.string()))
    throw Error(ExitCode::bad_input,
                fmt::format("{}: one file for {} frames; give it a place for the number: '{}'", path.string(),
                            frames, path.stem().string() + "_####" + path.extension().string()));
}

fs::path numbered(const fs::path& pattern, int frame) {
  return pattern.empty() ? pattern : fs::path(config::numbered_path(pattern.string(), frame));
}

// Each kind of fault is told once, or long clips would drown in them.
class ToldFaults {
 public:
  void tell(int frame, const shell::Topology& topology, const std::vector<wrinkle::FaceForms>& forms) {
    for (const wrinkle::BaseFault& fault : wrinkle::base_faults(topology, forms))
      if (kinds_.insert(fault.kind).second) log::warn(fmt::format("frame {}: {}", frame, fault.text));
  }

 private:
  std::set<std::string> kinds_;
};

}  // namespace

void warn_of_bases(const WrinkleScene& first, const std::vector<shell::Positions>& poses, int last) {
  WrinkleRequest each;
  each.scene = first;
  ToldFaults told;
  for (int n = 1; n <= last; ++n) {
    each.scene.surface.positions = poses[static_cast<std::size_t>(n - 1)];
    told.tell(n, first.surface.topology, forms_of(each));
  }
}

WrinkleSequenceReport wrinkle_sequence(const WrinkleSequenceRequest& request) {
  const double began = wall_seconds();
  const Bases bases(request);
  const std::vector<int> picked = config::select_frames(request.frames, bases.last());
  WrinkleRequest each = request.each;
  for (const fs::path& pattern : {each.output, each.mesh}) check_pattern(pattern, picked.size());
  each.output = numbered(request.each.output, picked.front());
  each.mesh = numbered(request.each.mesh, picked.front());
  check_outputs(each);

  if (!each.levels) each.levels = sequence_levels;
  const shell::Topology& topology = bases.first().surface.topology;
  each.scene = bases.first();
  wrinkle::SequenceOptions options;
  options.field = each.options;
  options.fade = request.fade;
  options.quality = request.quality;
  WrinkleSequenceReport report;
  ToldFaults told;
  report.vertices = topology.vertex_count;
  report.faces = topology.faces.size();
  const auto request_of = [&](int n) {
    WrinkleRequest one = each;
    one.scene = bases.read(n);
    return one;
  };
  const auto clip_frame = [&](const WrinkleRequest& one) {
    wrinkle::ClipFrame frame{forms_of(one), {}};
    frame.wrinkle_free = wrinkle::wrinkle_free_faces(frame.forms, topology, one.rule);
    return frame;
  };
  wrinkle::Clip clip{topology, model_of(each), each.pin_held ? each.scene.held : std::vector<bool>{},
                     bases.last() - bases.from() + 1,
                     [&](int index) { return clip_frame(request_of(bases.from() + index)); }};
  const wrinkle::FieldSequence sequence(std::move(clip), options, [&](int done, int of) {
    if (request.progress) request.progress(true, done, of);
  });
  for (const int key : sequence.keys()) report.keys.push_back(bases.from() + key);
  report.spans = sequence.spans();

  // Solved some at a time on all cores, written in order.
  constexpr std::size_t block = 16;
  struct Ready {
    WrinkleRequest request;
    wrinkle::ClipFrame forms;
    WrinkleSequenceFrame frame;
  };
  wrinkle::CoarseField before;
  for (std::size_t begin = 0; begin < picked.size() && !report.interrupted; begin += block) {
    std::vector<Ready> ready(std::min(block, picked.size() - begin));
    tbb::parallel_for(std::size_t{0}, ready.size(), [&](std::size_t i) {
      if (interrupted()) return;
      const int n = picked[begin + i];
      ready[i].request = request_of(n);
      ready[i].forms = clip_frame(ready[i].request);
      ready[i].frame.frame = n;
      ready[i].frame.solved = sequence.solve(n - bases.from());
    });
    report.interrupted = interrupted();
    for (std::size_t i = 0; i < ready.size() && !report.interrupted; ++i) {
      const auto& [one, forms, solved_frame] = ready[i];
      WrinkleSequenceFrame frame = solved_frame;
      const int n = frame.frame;
      told.tell(n, topology, forms.forms);
      frame.wrinkle_free_faces =
          static_cast<std::size_t>(std::count(forms.wrinkle_free.begin(), forms.wrinkle_free.end(), true));
      wrinkle::CoarseField field = std::move(frame.solved.field);
      if (!field.amplitude.allFinite() || !frame.solved.one_form.allFinite())
        throw Error(ExitCode::check_failed, fmt::format("frame {}: the field is not finite", n));
      frame.max_amplitude = field.amplitude.maxCoeff();
      frame.taken = wrinkle::take_up(topology, forms.forms, one.scene.material, field);
      report.converged = report.converged && frame.solved.converged;
      if (!report.frames.empty() && report.frames.back().frame == n - 1)
        frame.phase_step = wrinkle::phase_step(topology, forms.forms, before, field);
      if (request.on_field) request.on_field(frame, field);
      if (!request.each.output.empty()) {
        const fs::path path = numbered(request.each.output, n);
        write_field(path, one.scene.surface, field, frame.solved.one_form,
                    frame.solved.converged ? "" : frame.solved.reason);
        report.outputs.push_back({{path, "field"}, n});
      }
      if (!request.each.mesh.empty()) {
        const double upsampling = wall_seconds();
        const WrinkleMesh mesh = mesh_of(one, forms.forms, field);
        report.levels = mesh.levels;
        frame.upsample_s = wall_seconds() - upsampling;
        const fs::path path = numbered(request.each.mesh, n);
        io::write_mesh(path, mesh.file);
        report.outputs.push_back({{path, "mesh"}, n});
      }
      before = std::move(field);
      report.frames.push_back(std::move(frame));
      if (request.progress)
        request.progress(false, static_cast<int>(report.frames.size()), static_cast<int>(picked.size()));
    }
  }
  report.wall_s = wall_seconds() - began;
  return report;
}

}  // namespace plisse::cloth
