#include "support/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <thread>

#include "support/files.h"

namespace plisse::test {
namespace {

// The child of a fork: becomes the program, or ends with 127.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments,
                         const Environment& environment, const std::filesystem::path& folder,
                         const std::filesystem::path& out, const std::filesystem::path& err) {
  const auto redirect = [](int to, const std::filesystem::path& path, int flags) {
    const int file = open(path.c_str(), flags, 0600);
    if (file < 0 || dup2(file, to) < 0) _exit(127);
  };
  redirect(0, "/dev/null", O_RDONLY);
  redirect(1, out, O_WRONLY | O_CREAT | O_TRUNC);
  redirect(2, err, O_WRONLY | O_CREAT | O_TRUNC);
  // What an earlier run solved would hide what this one does.
  setenv("PLISSE_CACHE", "none", 1);
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  if (chdir(folder.c_str()) != 0) _exit(127);
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

int code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

Outcome run_until(const std::string& program, const std::vector<std::string>& arguments,
                  const Environment& environment, const std::filesystem::path& folder, int signal,
                  const std::function<bool(const std::string&)>& is_time) {
  const TemporaryFolder streams;
  const auto out = streams / "out", err = streams / "err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become(program, arguments, environment, folder, out, err);
  int status = 0;
  if (signal == 0) {
    waitpid(child, &status, 0);
  } else {
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (is_time(read_text(err))) {
        kill(child, signal);
        waitpid(child, &status, 0);
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  return {code_of(status), read_text(out), read_text(err)};
}

}  // namespace

Outcome run_program(const std::string& program, const std::vector<std::string>& arguments,
                    const Environment& environment, const std::filesystem::path& folder) {
  return run_until(program, arguments, environment, folder, 0, {});
}

Outcome interrupt_program(const std::string& program, const std::vector<std::string>& arguments, int signal,
                          const std::filesystem::path& sign) {
  return run_until(program, arguments, {}, ".", signal,
                   [&](const std::string&) { return std::filesystem::exists(sign); });
}

Outcome interrupt_program_saying(const std::string& program, const std::vector<std::string>& arguments,
                                 int signal, const std::string& words) {
  return run_until(program, arguments, {}, ".", signal,
                   [&](const std::string& err) { return err.find(words) != std::string::npos; });
}

}  // namespace plisse::test
