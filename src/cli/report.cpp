#include "cli/report.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"

namespace plisse::cli {

void write_stdout(std::string_view text) {
  errno = 0;
  const bool whole =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!whole) {
    throw Error(ExitCode::no_output,
                "standard output could not be written: " + std::generic_category().message(errno));
  }
}

void write_report(const nlohmann::ordered_json& report, const std::string& file) {
  if (file.empty()) return;
  nlohmann::ordered_json whole = report;
  if (whole.is_object()) whole["warnings"] = log::warnings();
  const std::string text = whole.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (file == "-") {
    write_stdout(text);
  } else {
    write_whole_file(file, text);
  }
}

nlohmann::ordered_json to_json(const pipeline::GlInfo& gl) {
  return {{"vendor", gl.vendor},
          {"renderer", gl.renderer},
          {"version", gl.version},
          {"device", gl.path},
          {"software", gl.software}};
}

}  // namespace plisse::cli
