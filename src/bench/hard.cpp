#include "bench/hard.h"

#include <fmt/format.h>

#include "base/error.h"
#include "bench/timing.h"

namespace plisse::bench {

const std::vector<HardCase>& hard_cases() {
  static const std::vector<HardCase> all = [] {
    std::vector<HardCase> cases = hard_passes();
    for (const auto& part : {hard_scenes(), hard_sizing(), hard_shells()})
      cases.insert(cases.end(), part.begin(), part.end());
    return cases;
  }();
  return all;
}

HardRow judge(const HardCase& hard) {
  HardRow row{hard.area, hard.name, hard.must, {}, 0};
  const Sample began = now();
  try {
    row.verdict = hard.run();
  } catch (const Error& error) {
    if (error.code == ExitCode::no_opengl || error.code == ExitCode::no_output) throw;
    row.verdict = {false, error.what()};
  } catch (const std::exception& error) {
    row.verdict = {false, fmt::format("an exception: {}", error.what())};
  }
  row.seconds = (now() - began).wall_s;
  return row;
}

std::string hard_markdown(const std::vector<HardRow>& rows) {
  std::string text = "| area | case | must | found | holds | s |\n|---|---|---|---|---|---|\n";
  for (const HardRow& row : rows)
    text += fmt::format("| {} | {} | {} | {} | {} | {:.2f} |\n", row.area, row.name, row.must,
                        row.verdict.found, row.verdict.holds ? "yes" : "**no**", row.seconds);
  return text;
}

}  // namespace plisse::bench
