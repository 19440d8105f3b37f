// Runs the finished program as a user would.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/files.h"

extern char** environ;

namespace plisse::test {

class Program : public testing::Test {
 protected:
  struct Outcome {
    int code = -1;  // 128 + signal where one ended it
    std::string out, err;
  };

  // What the program writes goes to files: `out`, or one of the folder's own, and .err.
  pid_t start(const std::vector<std::string>& arguments, const std::string& out = "",
              bool closed_error = false) {
    const std::string program = program_path();
    out_ = out.empty() ? path(".out") : out;
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);

    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out_.c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, path(".err").c_str(), flags, 0600);
    if (closed_error) posix_spawn_file_actions_addclose(&files, STDERR_FILENO);
    pid_t child = -1;
    EXPECT_EQ(posix_spawn(&child, program.c_str(), &files, nullptr, argv.data(), environ), 0)
        << program << " is not built";
    posix_spawn_file_actions_destroy(&files);
    return child;
  }

  Outcome wait(pid_t child) const {
    Outcome outcome;
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) return outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (std::filesystem::is_regular_file(out_)) outcome.out = read_text(out_);
    outcome.err = read_text(path(".err"));
    return outcome;
  }

  Outcome run(const std::vector<std::string>& arguments, const std::string& out = "",
              bool closed_error = false) {
    return wait(start(arguments, out, closed_error));
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;

 private:
  std::string out_;
};

}  // namespace plisse::test
