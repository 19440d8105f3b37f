// plisse size: how fine the mesh of a fabric must be.

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/size_options.h"
#include "config/suggest.h"
#include "sizing/fabric.h"
#include "sizing/resolution.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CLI::App& app) : common(app) {
    app.add_option(
           "--fabric", fabric,
           described("A fabric by name, or bending stiffness and Young's modulus, units allowed: "
                     "\"2e-6,3e5\" (N·m, N/m²), \"0.02 gf·cm²/cm,0.3 MPa\"; four numbers: weft, then warp"))
        ->type_name("B,E|NAME");
    app.add_option("--fabric-range", range,
                   described("What a system takes for its extremes; default 1e-9,1e-3,2e3,2e6,2.5mm,50mm"))
        ->type_name("Bmin,Bmax,Emin,Emax,rmin,rmax");
    app.add_flag("--list-fabrics", list, "Print the known fabrics and end");
  }

  CommonArguments common;
  std::string fabric, range;
  bool list = false;
};

ordered_json to_json(const sizing::ResolutionLaw& law, const sizing::FabricRange& range,
                     const sizing::Stiffness& stiffness) {
  const double y = stiffness.bending / stiffness.modulus;
  return {{"resolution_mm", 1e3 * sizing::fabric_resolution(law, stiffness)},
          {"y_m3", y},
          {"c1", law.c1},
          {"c2", law.c2},
          {"in_range", y >= range.ratio_min() && y <= range.ratio_max()}};
}

std::string fabric_list(const sizing::ResolutionLaw& law) {
  std::string text = "fabric          B weft/warp, N·m   E weft/warp, N/m²  r weft/warp, mm  from\n";
  for (const sizing::Fabric& fabric : sizing::fabrics()) {
    const auto pair = [&](double weft, double warp) {
      return fabric.isotropic() ? fmt::format("{:.4g}", weft) : fmt::format("{:.4g}/{:.4g}", weft, warp);
    };
    text += padded(fabric.name, 16) + padded(pair(fabric.weft.bending, fabric.warp.bending), 19) +
            padded(pair(fabric.weft.modulus, fabric.warp.modulus), 19) +
            padded(pair(1e3 * fabric_resolution(law, fabric.weft), 1e3 * fabric_resolution(law, fabric.warp)),
                   17) +
            fabric.source + "\n";
  }
  return text;
}

int size_fabric(const Arguments& arguments, const sizing::FabricRange& range,
                const sizing::ResolutionLaw& law) {
  const sizing::Fabric fabric = fabric_option(arguments.fabric);
  ordered_json report = to_json(law, range, fabric.weft);
  if (!fabric.isotropic()) {
    report["weft"] = to_json(law, range, fabric.weft);
    report["warp"] = to_json(law, range, fabric.warp);
    if (report["warp"]["resolution_mm"] < report["weft"]["resolution_mm"]) report.update(report["warp"]);
    report["ratio"] =
        report["warp"]["resolution_mm"].get<double>() / report["weft"]["resolution_mm"].get<double>();
  }
  if (arguments.common.tables_wanted()) {
    const auto line = [&](const char* what, const ordered_json& of) {
      return fmt::format("{}r = {:.3f} mm   y = B/E = {:.4g} m³{}\n", what, of["resolution_mm"].get<double>(),
                         of["y_m3"].get<double>(),
                         of["in_range"].get<bool>() ? ""
                                                    : fmt::format("   outside the range {:.4g} to {:.4g} m³",
                                                                  range.ratio_min(), range.ratio_max()));
    };
    std::string text;
    if (fabric.isotropic()) {
      text = line("", report);
    } else {
      text = line("weft  ", report["weft"]) + line("warp  ", report["warp"]);
    }
    write_stdout(text + fmt::format("c₁ = {:.6g} m⁻³, c₂ = {:.6g} m⁻¹\n", law.c1, law.c2));
  }
  write_report(report, arguments.common.json());
  return 0;
}

int run_size(Arguments& arguments) {
  arguments.common.apply();
  const sizing::FabricRange range = range_option(arguments.range);
  const sizing::ResolutionLaw law = sizing::resolution_law(range);
  if (arguments.list) {
    write_stdout(fabric_list(law));
    return 0;
  }
  if (arguments.fabric.empty()) {
    throw Error(ExitCode::bad_input, "plisse size: give --fabric B,E; see 'plisse size --help'");
  }
  return size_fabric(arguments, range, law);
}

}  // namespace

Command add_size(CLI::App& program) {
  CLI::App* app = program.add_subcommand("size", "Tell how fine the mesh of a fabric must be");
  auto arguments = std::make_shared<Arguments>(*app);
  return {app, [arguments] { return run_size(*arguments); }};
}

}  // namespace plisse::cli
