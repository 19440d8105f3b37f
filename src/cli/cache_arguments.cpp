#include "cli/cache_arguments.h"

#include "cloth/solved_cache.h"

namespace plisse::cli {

CacheArguments::CacheArguments(CommandOptions& options) {
  options.add("--cache-dir", folder_, "DIR|none",
              described("Where solved answers are kept and looked up (up to 1 GiB); 'none': nowhere; "
                        "default: $PLISSE_CACHE, or plisse in $XDG_CACHE_HOME or ~/.cache"));
}

std::filesystem::path CacheArguments::folder() const {
  if (folder_.empty()) return cloth::SolvedCache::user_folder();
  return folder_ == "none" ? std::filesystem::path() : std::filesystem::path(folder_);
}

nlohmann::ordered_json reused_json(int answers, double saved_s) {
  nlohmann::ordered_json skipped = nlohmann::ordered_json::object(), saved = nlohmann::ordered_json::object();
  if (answers > 0) {
    skipped["solved before"] = answers;
    saved["solved before"] = saved_s;
  }
  return {{"skipped", skipped}, {"saved_s", saved}};
}

}  // namespace plisse::cli
