// plisse measure: wavelength, amplitude, direction and number of the waves on a mesh.

#include <fmt/format.h>

#include <memory>
#include <string>

#include "base/error.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "mesh/measure_waves.h"
#include "pipeline/measure.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options) : common(options) {
    options.add("input", mesh, "MESH", "A mesh, in any format that models are read in");
    options.add("--base", base, "MESH",
                described("The surface without its waves, over which heights count; default: the mesh made "
                          "smooth, for waves shorter than a third of it"));
    options.add("--up", up, "x|y|z", "The axis that points up in the files");
  }
  CommonArguments common;
  std::string mesh, base, up;
};

ordered_json to_json(const glm::dvec3& direction) {
  if (direction == glm::dvec3(0)) return nullptr;
  return {direction.x, direction.y, direction.z};
}

ordered_json to_json(const MeshSpectrum& spectrum) {
  ordered_json waves = ordered_json::array(), bins = ordered_json::array();
  for (const MeshWave& wave : spectrum.waves) {
    waves.push_back({{"wavelength_m", wave.wavelength},
                     {"amplitude_m", wave.amplitude},
                     {"direction", to_json(wave.direction)},
                     {"count", wave.count}});
  }
  for (const auto& bin : spectrum.bins)
    bins.push_back({{"wavelength_m", bin.wavelength}, {"power", bin.power}});
  return {{"waves", waves}, {"spectrum", bins}};
}

std::string table(const MeshSpectrum& spectrum) {
  if (spectrum.waves.empty()) return "no waves\n";
  std::string text =
      fmt::format("{:>14} {:>13}  {:>6}  {}\n", "wavelength mm", "amplitude mm", "crests", "across");
  for (const MeshWave& wave : spectrum.waves) {
    const glm::dvec3 d = wave.direction;
    text += fmt::format("{:>14.4g} {:>13.4g}  {:>6}  {}\n", 1000 * wave.wavelength, 1000 * wave.amplitude,
                        wave.count,
                        d == glm::dvec3(0) ? std::string("all ways")
                                           : fmt::format("({:.3f}, {:.3f}, {:.3f})", d.x, d.y, d.z));
  }
  return text;
}

int run_measure(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.mesh.empty())
    throw Error(ExitCode::bad_input, "plisse measure: give a MESH; see 'plisse measure --help'");
  pipeline::MeasureRequest request;
  request.mesh = arguments.mesh;
  request.base = arguments.base;
  request.options.up = arguments.up;
  const MeshSpectrum spectrum = pipeline::measure(request);
  if (arguments.common.tables_wanted()) write_stdout(table(spectrum));
  write_report(to_json(spectrum), arguments.common.json());
  return 0;
}

}  // namespace

void add_measure(CommandLine& line) {
  CommandOptions& options = line.command("measure", "Measure the waves on a mesh",
                                         "\nplisse measure fine.ply --base coarse.ply --json -");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_measure(*arguments); };
}

}  // namespace plisse::cli
