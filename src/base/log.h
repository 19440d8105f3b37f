// Messages to people, on stderr: warnings always, information with -v, neither with -q. spdlog does the work.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>

namespace plisse::log {

enum class Level { quiet, normal, verbose };
void set_level(Level level);

void info(std::string_view text);    // shown with -v
void notice(std::string_view text);  // shown unless -q
void warn(std::string_view text);    // shown unless -q, prefixed "warning:"
// A warning that concerns many elements alike is said once per process and key.
void warn_once(const std::string& key, std::string_view text);

// From now on warnings of this process go there instead, each once for its key (empty for those of `warn`): a
// process that works for another hands them over. To be called before other threads are.
using WarningReceiver = std::function<void(const std::string& key, std::string_view text)>;
void redirect_warnings(WarningReceiver receiver);

}  // namespace plisse::log
