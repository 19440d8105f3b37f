// Messages to the user on stderr, by spdlog: warnings always, information with -v, neither with -q.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace plisse::log {

enum class Level { quiet, normal, verbose };
void set_level(Level level);

void info(std::string_view text);    // shown with -v
void notice(std::string_view text);  // shown unless -q
void warn(std::string_view text);    // shown unless -q, prefixed "warning:"
// All that was warned of so far in this process, in order, each text once: for reports.
std::vector<std::string> warnings();
// A warning that concerns many elements alike is said once per process and key.
void warn_once(const std::string& key, std::string_view text);

// From now on warnings of this process are passed to this function instead, each once for its key (empty for
// those of `warn`): a child process passes them to its parent. To be called before other threads start.
using WarningReceiver = std::function<void(const std::string& key, std::string_view text)>;
void redirect_warnings(WarningReceiver receiver);

}  // namespace plisse::log
