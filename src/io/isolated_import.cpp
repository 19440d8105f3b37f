// The caller's half: starts the child, listens to it, judges its end, takes over what it made.
// importer_process.cpp is the child's.
//
// Why a fork alone will not do: a child of fork() has the threads' locks but not the threads, and may only
// call what is safe in signal handlers. A program that uses the library may well have threads (OpenGL drivers
// do), and then a reader would sooner or later wait for a lock that nobody holds any more. So the child
// executes a program: the very one that it came from, /proc/self/exe, whose copy of this library notices
// before main() that it has been called as importer. That leaves nothing to install or find, and the two
// halves are always of one version. Only where the library was loaded at run time (a plug-in), the program is
// not ours to start, and `plisse` of the PATH takes the part; and where a loader was started by hand with the
// program as its argument (tools/bundle does it), /proc/self/exe is the loader, and PLISSE_IMPORTER names
// what to start instead.
//
// What goes between them: the order and the model through one file in memory, which has no size that matters
// until it is used; notes, warnings and errors through a pipe, whose end says that the child is done. The
// model is decoded only after that, when nobody can write into the file any more, and trusted no further than
// bytes of a file are.
#include "io/isolated_import.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>
#include <utility>

#include "base/clock.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "io/importer_process.h"
#include "io/model_bytes.h"

extern char** environ;

namespace plisse::io {
namespace {

class File {
 public:
  explicit File(int descriptor = -1) : descriptor_(descriptor) {}
  File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int get() const { return descriptor_; }

  // A copy that file actions below cannot run over: they fill the lowest numbers.
  static File above_standard(int descriptor) {
    const File original(descriptor);
    return File(descriptor < 0 ? -1 : ::fcntl(descriptor, F_DUPFD_CLOEXEC, importer_pipe + 1));
  }

 private:
  int descriptor_;
};

class Mapping {
 public:
  Mapping(int file, std::size_t size)
      : size_(size), start_(::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0)) {}
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping() {
    if (start_ != MAP_FAILED) ::munmap(start_, size_);
  }
  bool good() const { return start_ != MAP_FAILED; }
  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(start_), size_}; }

 private:
  std::size_t size_;
  void* start_;
};

// Whether this code is part of the program itself and not of a library loaded into it.
bool part_of_the_program() {
  Dl_info info{};
  link_map* map = nullptr;
  const auto here = reinterpret_cast<void*>(&part_of_the_program);
  return ::dladdr1(here, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0 && map != nullptr &&
         (map->l_name == nullptr || *map->l_name == '\0');
}

class Child {
 public:
  Child(const std::filesystem::path& path, const ImportOptions& options)
      : path_(path), limits_(options.limits) {
    file_ = File::above_standard(::memfd_create("plisse model", MFD_CLOEXEC));
    int ends[2] = {-1, -1};
    const bool piped = ::pipe2(ends, O_CLOEXEC) == 0;
    pipe_ = File(ends[0]);
    const File child_end = File::above_standard(ends[1]);
    const std::string order = order_text(path, options);
    if (file_.get() < 0 || !piped || child_end.get() < 0 ||
        ::write(file_.get(), order.data(), order.size()) != static_cast<ssize_t>(order.size()))
      cannot_start(errno);
    start(child_end.get());
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { end(); }

  Model run() {
    listen();
    const int status = end();
    if (error_) throw *error_;
    if (!done_) fail_with(status);
    struct stat state {};
    if (::fstat(file_.get(), &state) != 0 || state.st_size <= 0) fail_with(status);
    const Mapping mapping(file_.get(), static_cast<std::size_t>(state.st_size));
    if (!mapping.good())
      throw Error(ExitCode::try_again,
                  fmt::format("{}: there is no memory for the model that was read from it", path_.string()));
    try {
      return model_from_bytes(mapping.bytes());
    } catch (const std::runtime_error& error) {
      throw Error(ExitCode::bad_input, fmt::format("{}: its reader was led astray ({}); {}", path_.string(),
                                                   error.what(), what_to_do));
    }
  }

 private:
  static constexpr const char* what_to_do =
      "the file is damaged, or of a kind that this reader does not know: export it anew, best as glTF (.glb)";

  [[noreturn]] void cannot_start(int reason) const {
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: the process that reads models cannot be started: {}{}", path_.string(),
                    std::strerror(reason),
                    reason == ENOENT ? "; /proc must be mounted, or 'plisse' stand in the PATH" : ""));
  }

  void start(int child_end) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
#ifndef __SANITIZE_ADDRESS__  // whose reports are wanted
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
#endif
    posix_spawn_file_actions_adddup2(&files, file_.get(), importer_file);
    posix_spawn_file_actions_adddup2(&files, child_end, importer_pipe);
    posix_spawn_file_actions_addclosefrom_np(&files, importer_pipe + 1);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::string name = importer_name;
    char* arguments[] = {name.data(), nullptr};
    int failure = ENOENT;
    if (const char* program = std::getenv("PLISSE_IMPORTER"))
      failure = ::posix_spawn(&id_, program, &files, &attributes, arguments, environ);
    if (failure != 0 && part_of_the_program())
      failure = ::posix_spawn(&id_, "/proc/self/exe", &files, &attributes, arguments, environ);
    if (failure != 0) failure = ::posix_spawnp(&id_, "plisse", &files, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) {
      id_ = -1;
      cannot_start(failure);
    }
  }

  // Until the child has closed its end, is out of time or memory, or the user has had enough.
  void listen() {
    const double deadline = wall_seconds() + static_cast<double>(limits_.with_factor(limits_.seconds));
    constexpr int glance_ms = 50;
    std::string heard;
    std::array<char, 4096> buffer;
    while (true) {
      pollfd waiting{pipe_.get(), POLLIN, 0};
      const int ready = ::poll(&waiting, 1, glance_ms);
      if (interrupted())
        throw Error(static_cast<ExitCode>(128 + signal_number()),
                    fmt::format("{}: interrupted", path_.string()));
      if (ready > 0) {
        const ssize_t size = ::read(pipe_.get(), buffer.data(), buffer.size());
        closed_ = size == 0;
        if (closed_ || (size < 0 && errno != EINTR)) return;
        if (size > 0) heard.append(buffer.data(), static_cast<std::size_t>(size));
        while (take_message(heard)) {
        }
        constexpr std::size_t longest = std::size_t{1} << 20;
        if (heard.size() > longest) return;
      }
      if (wall_seconds() > deadline)
        throw Error(
            ExitCode::bad_input,
            fmt::format("{}: {} has not finished reading it after {} s; {}; a file that needs so long raises "
                        "'seconds' under [limits] of a scene, or all limits with --limits 2",
                        path_.string(), reader(), limits_.with_factor(limits_.seconds), what_to_do));
      if (resident_mib() > limits_.with_factor(limits_.memory_mib)) {
        out_of_memory_ = true;
        return;
      }
    }
  }

  // The child cannot be held to an address space under sanitizers, so what it really uses is looked at as
  // well.
  std::uint64_t resident_mib() const {
    std::ifstream file(fmt::format("/proc/{}/statm", id_));
    std::uint64_t size = 0, resident = 0;
    file >> size >> resident;
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) >> 20;
  }

  // Takes the first whole message off the front; false where there is none.
  bool take_message(std::string& heard) {
    ImporterMessage head{};
    if (heard.size() < sizeof head) return false;
    std::memcpy(&head, heard.data(), sizeof head);
    const std::size_t whole = sizeof head + std::size_t{head.key_size} + head.text_size;
    if (heard.size() < whole) return false;
    const std::string key = heard.substr(sizeof head, head.key_size);
    const std::string text = heard.substr(sizeof head + head.key_size, head.text_size);
    heard.erase(0, whole);
    switch (head.kind) {
      case ImporterMessage::reader:
        reader_ = text;
        break;
      case ImporterMessage::warning:
        key.empty() ? log::warn(text) : log::warn_once(key, text);
        break;
      case ImporterMessage::error:
        error_ = Error(ExitCode::bad_input, text);
        break;
      case ImporterMessage::out_of_memory:
        out_of_memory_ = true;
        break;
      case ImporterMessage::done:
        done_ = true;
        break;
    }
    return true;
  }

  // Ends the child where it still runs; its status, or 0 where the program has its own way with children
  // (SIGCHLD ignored, or a wait() for any of them).
  int end() {
    if (id_ < 0) return 0;
    int status = 0;
    pid_t ended = 0;
    // One that has closed its pipe is at its end; any other is not waited for.
    if (closed_) {
      const double patience = wall_seconds() + 1;
      while ((ended = ::waitpid(id_, &status, WNOHANG)) == 0 && wall_seconds() < patience) ::usleep(1000);
    }
    // Not yet waited for, so the number is still this child's.
    if (ended == 0) {
      ::kill(id_, SIGKILL);
      while ((ended = ::waitpid(id_, &status, 0)) < 0 && errno == EINTR) {
      }
    }
    id_ = -1;
    return ended > 0 ? status : 0;
  }

  std::string reader() const {
    return reader_.empty() ? "plisse's own reader" : fmt::format("the importer ({})", reader_);
  }

  [[noreturn]] void fail_with(int status) const {
    std::string what;
    if (out_of_memory_)
      throw Error(
          ExitCode::bad_input,
          fmt::format(
              "{}: reading it takes more memory than the limit of {} MiB; {}; a file that needs so much "
              "raises 'memory_mib' under [limits] of a scene, or all limits with --limits 2",
              path_.string(), limits_.with_factor(limits_.memory_mib), what_to_do));
    if (WIFSIGNALED(status))
      what = fmt::format("crashed reading it ({})", ::strsignal(WTERMSIG(status)));
    else
      what = "ended without a word reading it";
    throw Error(ExitCode::bad_input,
                fmt::format("{}: {} {}; {}", path_.string(), reader(), what,
                            reader_.empty() ? "that is an error of plisse's, please report it with "
                                              "the file"
                                            : what_to_do));
  }

  std::filesystem::path path_;
  Limits limits_;
  File file_, pipe_;
  pid_t id_ = -1;
  std::string reader_;
  std::optional<Error> error_;
  bool closed_ = false, done_ = false, out_of_memory_ = false;
};

}  // namespace

Model isolated_import(const std::filesystem::path& path, const ImportOptions& options) {
  return Child(path, options).run();
}

}  // namespace plisse::io
