// POSIX calls rather than streams: streams lose errno, and a full disk may be reported only by close.
#include "base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace plisse {
namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

[[noreturn]] void fail_write(const std::filesystem::path& path, int error) {
  throw Error(ExitCode::no_output, fmt::format("{}: cannot be written: {}", path.string(), reason(error)));
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  int number() const { return number_; }
  // 0 or errno; network file systems report a full disk only here.
  int close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0 ? 0 : errno;
  }

 private:
  int number_;
};

// 0 or errno.
int write_piece(int file, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

int write_all(Descriptor& file, std::span<const std::uint8_t> bytes) {
  const int error = write_piece(file.number(), bytes);
  return error != 0 ? error : file.close();
}

// Short whatever the final name is, so that a name of the longest length allowed still has room for it.
std::filesystem::path temporary_name(const std::filesystem::path& folder) {
  static std::atomic<unsigned> counter{0};
  return folder / fmt::format(".plisse-{}-{}.tmp", ::getpid(), counter++);
}

// The target of a path; a folder is an error.
std::filesystem::path target_of(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto target = std::filesystem::is_symlink(path, ignored) && std::filesystem::exists(path, ignored)
                          ? std::filesystem::canonical(path, ignored)
                          : path;
  if (std::filesystem::is_directory(target, ignored)) fail_write(path, EISDIR);
  return target;
}

bool is_device(const std::filesystem::path& target) {
  std::error_code ignored;
  const auto kind = std::filesystem::status(target, ignored).type();
  return kind != std::filesystem::file_type::regular && kind != std::filesystem::file_type::not_found &&
         kind != std::filesystem::file_type::none;
}

// An empty file beside the target, in a folder that is made where it is missing.
std::filesystem::path new_temporary(const std::filesystem::path& path, const std::filesystem::path& target) {
  const auto folder = target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
  std::error_code made;
  std::filesystem::create_directories(folder, made);
  if (made) fail_write(path, made.value());
  // O_EXCL: skips a name that a killed process left, or that another machine uses on the same disk.
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const auto temporary = temporary_name(folder);
    if (Descriptor(temporary, O_WRONLY | O_CREAT | O_EXCL).number() >= 0) return temporary;
    if (errno != EEXIST) fail_write(path, errno);
  }
  fail_write(path, EEXIST);
}

template <typename Bytes>
Bytes read_whole(const std::filesystem::path& path) {
  const auto fail = [&](int error) {
    throw Error(ExitCode::bad_input, fmt::format("{}: cannot be read: {}", path.string(), reason(error)));
  };
  Descriptor file(path, O_RDONLY);
  struct stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) fail(errno);
  Bytes bytes;
  // The size is only a first guess: pipes and files under /proc have none.
  std::size_t used = 0;
  bytes.resize(static_cast<std::size_t>(status.st_size) + 1);
  for (;;) {
    const ssize_t count = ::read(file.number(), bytes.data() + used, bytes.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
    if (used == bytes.size()) bytes.resize(2 * bytes.size());
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

void write_whole_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  const auto target = target_of(path);
  if (is_device(target)) {
    Descriptor device(target, O_WRONLY);
    const int error = device.number() < 0 ? errno : write_all(device, bytes);
    if (error != 0) fail_write(path, error);
    return;
  }
  const auto temporary = new_temporary(path, target);
  Descriptor file(temporary, O_WRONLY);
  int error = file.number() < 0 ? errno : write_all(file, bytes);
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(temporary.c_str());
  fail_write(path, error);
}

WholeFile::WholeFile(const std::filesystem::path& path) : path_(path), target_(target_of(path)) {
  if (!is_device(target_)) temporary_ = new_temporary(path, target_);
  file_ = ::open((temporary_.empty() ? target_ : temporary_).c_str(), O_WRONLY | O_CLOEXEC);
  if (file_ >= 0) return;
  const int error = errno;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  fail_write(path, error);
}

WholeFile::~WholeFile() {
  if (file_ >= 0) ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void WholeFile::append(std::span<const std::uint8_t> bytes) {
  if (const int error = write_piece(file_, bytes); error != 0) fail_write(path_, error);
}

void WholeFile::commit() {
  if (::close(std::exchange(file_, -1)) != 0) fail_write(path_, errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail_write(path_, errno);
  temporary_.clear();
}

void check_writable(const std::filesystem::path& path) {
  const auto target = target_of(path);
  if (!is_device(target))
    ::unlink(new_temporary(path, target).c_str());
  else if (::access(target.c_str(), W_OK) != 0)
    fail_write(path, errno);
}

void write_whole_file(const std::filesystem::path& path, std::string_view text) {
  write_whole_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::vector<std::uint8_t> read_whole_file(const std::filesystem::path& path) {
  return read_whole<std::vector<std::uint8_t>>(path);
}

std::string read_whole_text(const std::filesystem::path& path) {
  return read_whole<std::string>(path);
}

}  // namespace plisse
