#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <mutex>
#include <set>

#include "base/progress.h"

namespace plisse::log {
namespace {

spdlog::logger& logger() {
  static auto instance = [] {
    auto made =
        std::make_shared<spdlog::logger>("plisse", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("%v");
    made->set_level(spdlog::level::info);
    return made;
  }();
  return *instance;
}

void say(spdlog::level::level_enum level, std::string_view text) {
  if (!logger().should_log(level)) return;
  Progress::wipe();
  logger().log(level, "{}", text);
}

WarningReceiver& receiver() {
  static WarningReceiver instance;
  return instance;
}

}  // namespace

void set_level(Level level) {
  logger().set_level(level == Level::quiet     ? spdlog::level::err
                     : level == Level::verbose ? spdlog::level::debug
                                               : spdlog::level::info);
}

void info(std::string_view text) {
  say(spdlog::level::debug, text);
}
void notice(std::string_view text) {
  say(spdlog::level::info, text);
}
void warn(std::string_view text) {
  if (receiver()) return receiver()("", text);
  say(spdlog::level::warn, fmt::format("warning: {}", text));
}

void warn_once(const std::string& key, std::string_view text) {
  static std::mutex mutex;
  static std::set<std::string> said;
  {
    std::lock_guard lock(mutex);
    if (!said.insert(key).second) return;
  }
  if (receiver()) return receiver()(key, text);
  warn(text);
}

void redirect_warnings(WarningReceiver to) {
  receiver() = std::move(to);
}

}  // namespace plisse::log
