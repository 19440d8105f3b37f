#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <utility>

#include "base/message_scope.h"
#include "base/progress.h"

namespace plisse::log {

struct Receiver {
  Sink sink;
  std::mutex mutex;  // one message at a time
  std::set<std::string> said;
};

namespace {

thread_local std::shared_ptr<Receiver> current_receiver;

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

void print(spdlog::level::level_enum level, std::string_view text) {
  if (!logger().should_log(level)) return;
  Progress::wipe();
  logger().log(level, "{}", text);
}

// Every warning that was printed, or would have been but for -q, once, in order, whatever its thread.
struct Warnings {
  std::mutex mutex;
  std::vector<std::string> texts;
};
Warnings& printed() {
  static Warnings instance;
  return instance;
}

void print_warning(std::string_view text) {
  {
    Warnings& all = printed();
    const std::lock_guard lock(all.mutex);
    if (std::find(all.texts.begin(), all.texts.end(), text) == all.texts.end()) all.texts.emplace_back(text);
  }
  print(spdlog::level::warn, fmt::format("warning: {}", text));
}

WarningReceiver& redirected() {
  static WarningReceiver instance;
  return instance;
}

// Whether a scope of this thread takes the message.
bool heard(Kind kind, std::string_view text, const std::string* key = nullptr) {
  if (!current_receiver) return false;
  Receiver& receiver = *current_receiver;
  std::lock_guard lock(receiver.mutex);
  if (receiver.sink && (!key || receiver.said.insert(*key).second)) receiver.sink(kind, text);
  return true;
}

}  // namespace

Scope::Scope(Sink sink) : Scope(std::make_shared<Receiver>()) {
  current_receiver->sink = std::move(sink);
}

Scope::Scope(std::shared_ptr<Receiver> receiver)
    : before_(std::exchange(current_receiver, std::move(receiver))) {}

Scope::~Scope() {
  current_receiver = std::move(before_);
}

std::shared_ptr<Receiver> Scope::current() {
  return current_receiver;
}

void set_level(Level level) {
  logger().set_level(level == Level::quiet     ? spdlog::level::err
                     : level == Level::verbose ? spdlog::level::debug
                                               : spdlog::level::info);
}

void info(std::string_view text) {
  if (!heard(Kind::info, text)) print(spdlog::level::debug, text);
}
void notice(std::string_view text) {
  if (!heard(Kind::notice, text)) print(spdlog::level::info, text);
}
void warn(std::string_view text) {
  if (heard(Kind::warning, text)) return;
  if (redirected()) return redirected()("", text);
  print_warning(text);
}

std::vector<std::string> warnings() {
  Warnings& all = printed();
  const std::lock_guard lock(all.mutex);
  return all.texts;
}

void warn_once(const std::string& key, std::string_view text) {
  if (heard(Kind::warning, text, &key)) return;
  static std::mutex mutex;
  static std::set<std::string> said;
  {
    std::lock_guard lock(mutex);
    if (!said.insert(key).second) return;
  }
  if (redirected()) return redirected()(key, text);
  print_warning(text);
}

void redirect_warnings(WarningReceiver to) {
  redirected() = std::move(to);
}

}  // namespace plisse::log
