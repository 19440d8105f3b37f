// Waves as shading on the coarse mesh against the same waves as geometry, from the mesh's own triangles to a
// thousand times as many.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "bench/film.h"
#include "bench/suite.h"
#include "io/picture/flip.h"
#include "passes/displacement.h"
#include "pipeline/look.h"

namespace plisse::bench {
namespace {

struct Shot {
  io::Image picture;
  std::vector<float> normals;  // rgba of the aov; alpha 0 where nothing is seen
};

// Geometry of the rig's waves, edges halved `levels` times.
class Geometry {
 public:
  Geometry(Film& film, int levels)
      : film_(film),
        mesh_(subdivide(film.scene.surface(), 1 << levels)),
        buffers_(film.scene.surface(), mesh_),
        displacement_(mesh_, film.scene.profile, pipeline::look_of(film.scene).smooth_blend,
                      pipeline::look_of(film.scene).field, pipeline::look_of(film.scene).cavity, "") {
    passes::Look look = pipeline::look_of(film.scene);
    look.displaced = true;
    auto parts = pipeline::draw_parts(film.scene);
    for (passes::DrawPart& part : parts) {
      const auto small = mesh_.small_triangles(part.first_triangle, part.triangle_count);
      part.first_triangle = small.first;
      part.triangle_count = small.count;
    }
    pass_.emplace(look, film.scene.profile, parts, pipeline::texture_levels(film.scene), "");
  }
  // A frame of it: moved and drawn.
  void draw() {
    displacement_.run(film_.rig.surface(), buffers_);
    pass_->draw(buffers_, film_.view, film_.target, film_.software);
    finish();
  }
  Shot shot() {
    draw();
    Shot result{{film_.target.width(), film_.target.height(), film_.target.read_rgba8()}, {}};
    pass_->draw_aov(buffers_, film_.view, film_.floats, passes::Aov::normal);
    result.normals = film_.floats.read_rgba32f();
    return result;
  }

 private:
  Film& film_;
  Subdivision mesh_;
  passes::SurfaceBuffers buffers_;
  passes::DisplacementPass displacement_;
  std::optional<passes::RenderPass> pass_;
};

Shot shaded(Film& film) {
  Shot result{film.picture(), {}};
  film.pass.draw_aov(film.rig.surface(), film.view, film.floats, passes::Aov::normal);
  result.normals = film.floats.read_rgba32f();
  return result;
}

struct Difference {
  double flip = 0, degrees = 0;  // means over the pixels where both show the surface
};

Difference difference(const Shot& truth, const Shot& test) {
  std::vector<std::uint8_t> both(truth.normals.size() / 4);
  double angle = 0, count = 0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const float *a = &truth.normals[4 * i], *b = &test.normals[4 * i];
    if (!(a[3] > 0 && b[3] > 0)) continue;
    both[i] = 1;
    const glm::dvec3 n(a[0], a[1], a[2]), m(b[0], b[1], b[2]);
    angle += std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m));
    count += 1;
  }
  return {io::flip(truth.picture, test.picture, both).mean,
          count > 0 ? angle / count * 180 / std::numbers::pi : 0};
}

}  // namespace

SuiteReport measure_shading(const Setup& setup) {
  const std::string name = "sleeve";
  const int densest = setup.pick(1, 5, 5);  // 1024 times the triangles
  SuiteReport report;
  report.name = "shading";
  report.title = "Shading against displaced geometry";
  report.note = fmt::format(
      "One frame of the sleeve's clip: its waves as shading on the coarse mesh that they live on, and as "
      "geometry of 1 to {} "
      "times as many triangles. The truth is geometry of {} times as many. "
      "Normals and "
      "pictures are compared where both show the surface.",
      1 << (2 * (densest - 1)), 1 << (2 * densest));

  const gpu::Context context(setup.device);
  const Clock clock = fair_clock(context.info());
  Film film(setup.scene(name, setup.pick(64, 640, 1280), setup.pick(52, 512, 1024)), name,
            context.info().software);
  film.rig.step_to_middle();

  const std::string triangles_of_truth = fmt::format("{}×", 1 << (2 * densest));
  const Shot truth = Geometry(film, densest).shot();
  setup.save(report, "shading_truth", truth.picture, "geometry, " + triangles_of_truth);

  std::vector<std::string> series{"shading"}, labels{"1×"};
  std::vector<Difference> errors;
  const Shot shading = shaded(film);
  errors.push_back(difference(truth, shading));
  setup.save(report, "shading_shaded", shading.picture,
             fmt::format("shading, FLIP {:.3f}", errors.back().flip));
  std::vector<Case> cases{{"shading", [&] { film.draw(film.rig.surface()); }}};
  std::vector<std::unique_ptr<Geometry>> geometries;
  for (int levels = 0; levels < densest; ++levels) {
    geometries.push_back(std::make_unique<Geometry>(film, levels));
    Geometry* geometry = geometries.back().get();
    const Shot shot = geometry->shot();
    errors.push_back(difference(truth, shot));
    series.emplace_back("geometry");
    labels.push_back(fmt::format("{}×", 1 << (2 * levels)));
    cases.push_back({labels.back(), [geometry] { geometry->draw(); }});
    if (levels == 0 || levels == 2 || levels + 1 == densest)
      setup.save(report, fmt::format("shading_geometry_{}", levels), shot.picture,
                 fmt::format("geometry, {}, FLIP {:.3f}", labels.back(), errors.back().flip));
  }
  const auto samples = take_turns(cases, {setup.turns().samples, 0});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Row row{"shading", name, series[i], labels[i], samples[i].of(clock), clock, "a picture"};
    row.truth = "geometry of " + triangles_of_truth + " the triangles";
    row.error_of = "picture";
    row.error = errors[i].flip;
    row.error_unit = "mean FLIP over the surface";
    report.rows.push_back(row);
    row.error_of = "normals";
    row.error = errors[i].degrees;
    row.error_unit = "degrees, mean over the surface";
    report.rows.push_back(row);
  }
  return report;
}

}  // namespace plisse::bench
