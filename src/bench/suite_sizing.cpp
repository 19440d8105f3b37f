// What the mesh resolution paper measured (D. Zhang et al., SIGGRAPH 2025, 5.2), measured here: waves of a
// stretched sheet, the sag of a strip, and the transition of a gathered curtain, each over edge length or
// stiffness.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "bench/sizing_scenes.h"
#include "bench/suite.h"
#include "cloth/drape.h"
#include "cloth/wrinkle.h"
#include "io/picture/svg_plot.h"
#include "shell/carry.h"
#include "sizing/rules.h"

namespace plisse::bench {
namespace {

constexpr double mm = 1e3;

io::PlotPoint at(double x, double y) {
  io::PlotPoint point;
  point.x = x;
  point.y = y;
  return point;
}

struct Solved {
  shell::Equilibrium rest;
  double seconds = 0;  // of all cores
};

Solved solve(const cloth::DrapeScene& scene) {
  const shell::Shell shell = cloth::shell_of(scene);
  const shell::Conditions conditions = scene.conditions(1);
  const Sample began = now();
  Solved solved{shell::find_equilibrium(shell, conditions, scene.loads,
                                        shell::carried(shell, conditions, scene.start), scene.newton)};
  solved.seconds = (now() - began).cpu_s;
  return solved;
}

Row row_of(const std::string& scene, const std::string& series, const std::string& label, double seconds) {
  Row row{"sizing", scene, series, label, {seconds, seconds, seconds}, Clock::cpu, "an equilibrium"};
  return row;
}

void save_plot(const Setup& setup, SuiteReport& report, const std::string& name, const io::Plot& plot,
               const std::string& caption) {
  const std::string path = "pictures/sizing_" + name + ".svg";
  write_whole_file(setup.folder / path, io::svg_plot(plot));
  report.pictures.push_back({path, caption});
}

// --- the stretched sheet

void measure_sheet(const Setup& setup, SuiteReport& report) {
  const double recommended =
      sizing::fabric_resolution(sizing::resolution_law(), {sizing::bending_stiffness(1e6, 1e-4, 0.5), 1e6});
  // The finest mesh is the reference.
  std::vector<double> edges = setup.pick<std::vector<double>>(
      {0.02, 0.015}, {4.0 / 3 * recommended, recommended, 2.0 / 3 * recommended},
      {5e-3, 3.8e-3, 2.5e-3, 4.0 / 3 * recommended, recommended, 2.0 / 3 * recommended, 1.8e-3});
  std::sort(edges.rbegin(), edges.rend());
  io::Plot plot;
  plot.title = "A sheet of 25 × 10 cm, longer by 12.78 %: waves across its middle";
  plot.x = {"edges of the mesh, mm", false, false};
  plot.y = {"waves", false, false};
  plot.series = {{"St. Venant–Kirchhoff shell", {}, true}, {"tension field and solved waves", {}, true}};
  for (const bool stvk : {true, false}) {
    std::vector<std::pair<Row, Crossing>> all;
    for (const double edge : edges) {
      const cloth::DrapeScene scene = sheet_scene(edge, stvk);
      Crossing crossing;
      const Solved solved = solve(scene);
      double seconds = solved.seconds;
      bool converged = solved.rest.converged;
      if (stvk) {
        crossing = waves_across(scene, solved.rest.positions);
      } else {
        cloth::DrapeScene base = scene;
        base.start = solved.rest.positions;
        base.solved = true;
        cloth::WrinkleRequest request;
        request.scene = cloth::base_of(base);
        const Sample began = now();
        const cloth::WrinkleReport field = cloth::wrinkle_field(request);
        seconds += (now() - began).cpu_s;
        converged &= field.field.whole.converged;
        crossing = {field.field.waves, field.max_amplitude};
      }
      const std::string& series = plot.series[stvk ? 0 : 1].name;
      std::string label = fmt::format("{:.3g} mm: {:.3g} waves of {:.3f} mm, {} vertices", mm * edge,
                                      crossing.waves, mm * crossing.amplitude, scene.start.cols());
      if (!converged) label += ", not converged";
      plot.series[stvk ? 0 : 1].points.push_back(at(mm * edge, crossing.waves));
      all.emplace_back(row_of("stretched sheet", series, label, seconds), crossing);
    }
    for (auto& [row, crossing] : all) {
      const Crossing& finest = all.back().second;
      row.truth =
          fmt::format("the finest mesh: {:.3g} waves of {:.3f} mm", finest.waves, mm * finest.amplitude);
      row.error_of = "number of waves";
      row.error = finest.waves > 0 ? 100 * std::abs(crossing.waves / finest.waves - 1) : 0;
      row.error_unit = "%, of the finest mesh's waves";
      report.rows.push_back(row);
    }
  }
  plot.series.push_back({"the paper", {at(5, 4), at(3.8, 6), at(2.5, 7)}, true});
  save_plot(
      setup, report, "stretch", plot,
      fmt::format("Stretched by 12.78 %: waves across the middle. Our resolution is {:.3g} mm; the paper "
                  "says 3.8 mm, and 4, 6 and 7 waves at 5, 3.8 and 2.5 mm",
                  mm * recommended));
}

// --- the strip over a table's edge

void measure_strip(const Setup& setup, SuiteReport& report) {
  const Strip strip;
  const double truth = sag_of_beam(strip);
  const auto edges =
      setup.pick<std::vector<double>>({0.02, 0.01}, {0.02, 0.01, 6.5e-3, 4e-3},
                                      {0.02, 0.015, 0.01, 8e-3, 6.5e-3, 5e-3, 4e-3, 3.3e-3, 2.5e-3});
  struct Kind {
    const char* name;
    StripMesh mesh;
    shell::Bending bending;
  };
  const Kind kinds[] = {
      {"squares, clamped half an edge back", StripMesh::regular, shell::Bending::midedge},
      {"irregular, clamped at the edge, mid-edge bending", StripMesh::irregular, shell::Bending::midedge},
      {"irregular, clamped at the edge, quadratic bending", StripMesh::irregular, shell::Bending::quadratic}};
  io::Plot plot;
  plot.title = "A strip that hangs 60 mm over a table's edge: B 2e-6 N·m, E 1e6 N/m², 150 g/m²";
  plot.x = {"edges of the mesh, mm", false, false};
  plot.y = {"sag, mm", false, false};
  for (const Kind& kind : kinds) {
    io::PlotSeries series{kind.name, {}, true};
    for (const double edge : edges) {
      const Solved solved = solve(strip_scene(strip, edge, kind.mesh, kind.bending));
      const double sag = sag_of(solved.rest.positions);
      std::string label = fmt::format("{:.3g} mm: {:.2f} mm", mm * edge, mm * sag);
      if (!solved.rest.converged) label += ", not converged";
      series.points.push_back(at(mm * edge, mm * sag));
      Row row = row_of("strip", kind.name, label, solved.seconds);
      row.truth = fmt::format("an inextensible beam: {:.3f} mm", mm * truth);
      row.error_of = "sag";
      row.error = 100 * std::abs(sag - truth) / strip.length;
      row.error_unit = "%, of the length";
      report.rows.push_back(row);
    }
    plot.series.push_back(series);
  }
  plot.series.push_back(
      {"a beam (exact)", {at(mm * edges.front(), mm * truth), at(mm * edges.back(), mm * truth)}, true});
  save_plot(
      setup, report, "sag", plot,
      "A strip's sag against the edges of its mesh. The paper's settles at about 6.5 mm; its resolution "
      "for this cloth is 6.46 mm");
}

// --- the curtain

void measure_curtain(const Setup& setup, SuiteReport& report) {
  const auto stiffnesses =
      setup.pick<std::vector<double>>({2e-6}, {1e-6, 4e-6}, {2.5e-7, 5e-7, 1e-6, 2e-6, 4e-6, 8e-6});
  const double edge = setup.pick(2e-3, 1e-3, 0.8e-3);
  io::Plot plot;
  plot.title = "A curtain gathered to waves of 10 mm: how far down they have doubled";
  plot.x = {"bending stiffness, N·m", true, false};
  plot.y = {"below the upper edge, mm", true, false};
  plot.series = {{"measured: half of the slack in long waves", {}, true},
                 {"measured: nine tenths", {}, true},
                 {"measured: nine tenths, 64 times as heavy", {}, true},
                 {"L_w of compression, λ^1.5 (δ/h²)^¼", {}, true},
                 {"L_w of tension, λ²√(T/B)", {}, true}};
  for (const double heavier : {1.0, 64.0}) {
    for (const double bending : stiffnesses) {
      Curtain curtain;
      curtain.bending = bending;
      curtain.weight *= heavier;
      const double thickness = sizing::effective_thickness({bending, curtain.modulus}, 0.3),
                   tension = curtain.weight * 9.81 * curtain.height;
      const double by_tension = sizing::tension_transition(curtain.wavelength, tension, bending),
                   by_compression =
                       sizing::compression_transition(curtain.wavelength, curtain.compression, thickness);
      if (heavier == 1) {
        plot.series[3].points.push_back(at(bending, mm * by_compression));
        plot.series[4].points.push_back(at(bending, mm * by_tension));
      }
      const cloth::DrapeScene scene = curtain_scene(curtain, edge, 0.03);
      const Solved solved = solve(scene);
      const Transition found = transition_of(curtain, scene, solved.rest.positions);
      if (found.most < 0) continue;
      if (heavier == 1) plot.series[0].points.push_back(at(bending, mm * found.half));
      plot.series[heavier == 1 ? 1 : 2].points.push_back(at(bending, mm * found.most));
      std::string label = fmt::format(
          "B {:g}: {:.1f} mm half, {:.1f} mm nine tenths; L_w {:.1f} mm of compression, {:.1f} of tension",
          bending, mm * found.half, mm * found.most, mm * by_compression, mm * by_tension);
      if (!solved.rest.converged) label += ", not converged";
      Row row = row_of("curtain", heavier == 1 ? "150 g/m²" : "9.6 kg/m²", label, solved.seconds);
      row.truth = "the drape, where nine tenths of the slack lie in long waves";
      row.error_of = "L_w of compression";
      row.error = 100 * std::abs(by_compression / found.most - 1);
      row.error_unit = "%, of the measured distance";
      report.rows.push_back(row);
    }
  }
  std::erase_if(plot.series, [](const io::PlotSeries& series) { return series.points.empty(); });
  save_plot(
      setup, report, "curtain", plot,
      "Where waves double below a curtain's gathered edge: measured in its drape, and the two laws with "
      "prefactor 1, the longer of which 'plisse size' takes. The paper's: 26.7 mm computed, 25 measured");
}

}  // namespace

SuiteReport measure_sizing(const Setup& setup) {
  SuiteReport report;
  report.name = "sizing";
  report.title = "Sizing: what the resolution paper measured";
  report.note =
      "The three experiments of Zhang et al. 2025, section 5.2. They tell neither the sheet's size (taken: "
      "Cerda and Mahadevan's, as Chen et al. 2021 have it) nor the strip's weight and length (150 g/m², 60 "
      "mm) nor the curtain's anything (waves of 10 mm, a fifth of the width gathered, 200 mm high, E 1e6). "
      "Solvers ran once each; CPU time of all cores.";
  measure_sheet(setup, report);
  measure_strip(setup, report);
  measure_curtain(setup, report);
  return report;
}

}  // namespace plisse::bench
