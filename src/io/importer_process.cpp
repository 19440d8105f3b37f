// The child's half of an isolated import: a program that was started under the importer's name by
// isolated_import.cpp reads one file, hands it over and ends, before its main() begins.
#include "io/importer_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "base/error.h"
#include "base/log.h"
#include "io/model_bytes.h"
#include "io/read_model.h"

namespace plisse::io {
namespace {

void write_all(const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = ::write(importer_pipe, from, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);  // the reading process has ended
    from += written;
    size -= static_cast<std::size_t>(written);
  }
}

void say(ImporterMessage::Kind kind, std::string_view text = {}, std::string_view key = {}) {
  constexpr std::size_t longest = 65536;  // a file may hold names of any length
  text = text.substr(0, longest);
  key = key.substr(0, longest);
  const ImporterMessage head{kind, static_cast<std::uint32_t>(key.size()),
                             static_cast<std::uint32_t>(text.size())};
  write_all(&head, sizeof head);
  write_all(key.data(), key.size());
  write_all(text.data(), text.size());
}

void limit_self(const Limits& limits) {
  const auto set = [](auto resource, rlim_t value) {
    rlimit limit{};
    ::getrlimit(resource, &limit);
    limit.rlim_cur = std::min(value, limit.rlim_max);
    ::setrlimit(resource, &limit);
  };
  set(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__  // whose shadow takes terabytes of address space; the caller watches what is
                              // used
  set(RLIMIT_AS, limits.with_factor(limits.memory_mib) << 20);
#endif
  // The caller's clock comes first; this one is for a caller that is stopped.
  set(RLIMIT_CPU, 2 * limits.with_factor(limits.seconds) + 1);
}

ImportOrder read_order() {
  std::string text;
  std::array<char, 4096> buffer;
  ::lseek(importer_file, 0, SEEK_SET);
  for (ssize_t size; (size = ::read(importer_file, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(size));
  return order_of(text);
}

void hand_over(const Model& model) {
  const std::size_t size = byte_count(model);
  if (::ftruncate(importer_file, static_cast<off_t>(size)) != 0) throw std::bad_alloc();
  void* const start = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, importer_file, 0);
  if (start == MAP_FAILED) throw std::bad_alloc();
  write_bytes(model, {static_cast<std::byte*>(start), size});
  say(ImporterMessage::done);
}

void serve() {
  // The caller decides what an interrupt means, and this process ends with it.
  ::signal(SIGINT, SIG_IGN);
  ::signal(SIGTERM, SIG_IGN);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    const ImportOrder order = read_order();
    limit_self(order.options.limits);
    log::redirect_warnings(
        [](const std::string& key, std::string_view text) { say(ImporterMessage::warning, text, key); });
    on_note_reader([](const char* who) { say(ImporterMessage::reader, who); });
    hand_over(read_model(order.path, order.options));
  } catch (const Error& error) {
    say(ImporterMessage::error, error.what());
  } catch (const std::bad_alloc&) {
    say(ImporterMessage::out_of_memory);
  } catch (const std::length_error&) {  // a size beyond what a container can ever hold
    say(ImporterMessage::out_of_memory);
  } catch (const std::exception& error) {
    say(ImporterMessage::error, error.what());
  }
}

// Runs before main() of every program that holds this library; glibc hands arguments to constructors. Nothing
// of the program has been made yet, and nothing of it will be: _exit leaves out what would run at its end.
[[gnu::constructor]] void become_importer(int count, char** arguments) {
  if (count != 1 || arguments == nullptr || std::strcmp(arguments[0], importer_name) != 0) return;
  if (::fcntl(importer_file, F_GETFD) < 0 || ::fcntl(importer_pipe, F_GETFD) < 0) ::_exit(2);
  serve();
  ::_exit(0);
}

}  // namespace

namespace {

// In front of the up axis and the path.
struct OrderHead {
  Limits limits;
  double metres_per_unit = 0;
  bool has_unit = false;
  std::uint32_t up_size = 0;
};
static_assert(std::is_trivially_copyable_v<OrderHead>);

}  // namespace

std::string order_text(const std::filesystem::path& path, const ImportOptions& options) {
  OrderHead head{options.limits, options.metres_per_unit.value_or(0), options.metres_per_unit.has_value(),
                 static_cast<std::uint32_t>(options.up.size())};
  return std::string(reinterpret_cast<const char*>(&head), sizeof head) + options.up + path.string();
}

ImportOrder order_of(std::string_view text) {
  OrderHead head;
  if (text.size() < sizeof head) throw std::runtime_error("the order for an import is cut off");
  std::memcpy(&head, text.data(), sizeof head);
  text.remove_prefix(sizeof head);
  ImportOrder order;
  order.options.limits = head.limits;
  if (head.has_unit) order.options.metres_per_unit = head.metres_per_unit;
  order.options.up = text.substr(0, head.up_size);
  order.path = text.substr(std::min<std::size_t>(head.up_size, text.size()));
  return order;
}

}  // namespace plisse::io
